#include "report_json.h"
#include "failure.h"
#include "sinks/output.h"
#include "vitrine_pack.h" /* VIT_EFFECTS */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* Bytes of the UTF-8 character at `s`; 0: it is none. Overlong forms and surrogates are not looked for. */
static size_t utf8_length(const unsigned char *s) {
    size_t n = 0;
    if (s[0] < 0x80)
        n = 1;
    else if (s[0] >= 0xc2 && s[0] < 0xf5)
        n = s[0] < 0xe0 ? 2 : s[0] < 0xf0 ? 3 : 4;
    for (size_t i = 1; i < n; i++)
        if ((s[i] & 0xc0) != 0x80)
            return 0;
    return n;
}

/* A JSON string; bytes that are no UTF-8, as a file's name may have, become U+FFFD. */
static void put_text(const char *text, FILE *to) {
    (void)fputc('"', to);
    for (const unsigned char *s = (const unsigned char *)text; *s != '\0';) {
        size_t n = utf8_length(s);
        if (n == 0)
            (void)fputs("\\ufffd", to);
        else if (*s < 0x20 || *s == '"' || *s == '\\')
            (void)fprintf(to, "\\u%04x", *s);
        else
            (void)fwrite(s, 1, n, to);
        s += n == 0 ? 1 : n;
    }
    (void)fputc('"', to);
}

static void put_named(const char *name, const char *text, FILE *to) {
    (void)fprintf(to, "\"%s\": ", name);
    put_text(text, to);
}

static void put_times(const times *t, FILE *to) {
    (void)fprintf(to, "\"ms\": {\"p50\": %.6f, \"p95\": %.6f, \"p99\": %.6f, \"max\": %.6f, \"mad\": %.6f}", t->p50, t->p95,
                  t->p99, t->max, t->mad);
}

static void put_scene(const report_json *r, FILE *to) {
    const vit_requirements *n = r->need;
    const char *comma = "";
    (void)fprintf(to, "  \"scene\": {\"width\": %u, \"height\": %u, \"frames\": %u, \"fps\": %.6f, \"effects\": [", n->width,
                  n->height, n->frames, (double)n->fps);
#define X(bit, name, macro, why)                                                                                               \
    if (n->effects & VIT_BIT(macro)) {                                                                                         \
        (void)fprintf(to, "%s\"%s\"", comma, name);                                                                            \
        comma = ", ";                                                                                                          \
    }
    VIT_EFFECTS(X)
#undef X
    (void)fputs("]},\n", to);
}

static void put_frames(const report_json *r, FILE *to) {
    times t = report_frame_times(r->times);
    (void)fprintf(to,
                  "  \"frames\": {\"first\": %u, \"end\": %u, \"played\": %" PRIu64 ", \"timed\": %zu, \"late\": %" PRIu64 ", ",
                  r->first, r->end, r->times->frames, report_timed(r->times), r->late);
    put_times(&t, to);
    (void)fputs("},\n", to);
}

/* Kinds of a pass that it has: the sum over the frames of a round and the most of a frame. */
static void put_work(const work_counts *w, uint32_t pass, FILE *to) {
    const char *comma = "";
    (void)fputs(", \"work\": {", to);
    for (uint32_t k = 0; k < w->kinds; k++)
        if (w->sum[pass][k] > 0) {
            (void)fprintf(to, "%s\"%s\": {\"sum\": %" PRIu64 ", \"max\": %" PRIu64 "}", comma, w->kind_names[k],
                          w->sum[pass][k], w->max[pass][k]);
            comma = ", ";
        }
    (void)fputc('}', to);
}

static void put_passes(const report_json *r, FILE *to) {
    (void)fputs("  \"passes\": [\n", to);
    for (uint32_t i = 0; i < r->need->pass_count; i++) {
        times t = report_pass_times(r->times, i);
        (void)fprintf(to, "    {\"name\": \"%s\", ", r->need->passes[i]);
        put_times(&t, to);
        if (r->work != NULL)
            put_work(r->work, i, to);
        (void)fprintf(to, "}%s\n", i + 1 < r->need->pass_count ? "," : "");
    }
    (void)fputs("  ],\n", to);
}

/* Which kinds there are, and whether they are equal on every device. */
static void put_kinds(const work_counts *w, FILE *to) {
    (void)fprintf(to, "  \"work\": {\"frames\": %" PRIu64 ", \"lanes\": %u, \"kinds\": [", w->frames, w->lanes);
    for (uint32_t k = 0; k < w->kinds; k++)
        (void)fprintf(to, "%s{\"name\": \"%s\", \"same\": %s}", k > 0 ? ", " : "", w->kind_names[k],
                      w->same[k] ? "true" : "false");
    (void)fputs("]},\n", to);
}

static void put_memory(const vit_requirements *n, FILE *to) {
    (void)fputs("  \"buffers\": [\n", to);
    for (uint32_t i = 0; i < n->buffer_count; i++)
        (void)fprintf(to, "    {\"name\": \"%s\", \"bytes\": %" PRIu64 ", \"effect\": \"%s\"}%s\n", n->buffers[i].name,
                      n->buffers[i].bytes, n->buffers[i].effect, i + 1 < n->buffer_count ? "," : "");
    (void)fprintf(to, "  ],\n  \"device_bytes\": %" PRIu64 ",\n  \"host_bytes\": %zu,\n  \"frame_bytes\": %zu,\n",
                  n->device_bytes, n->host_bytes, n->frame_bytes);
}

static void put_last(const vit_statistics *s, FILE *to) {
    const char *quote = s->indirect ? "\"" : "";
    (void)fprintf(to, "  \"indirect\": %s%s%s,\n", quote, s->indirect ? s->indirect : "null", quote);
    (void)fprintf(to,
                  "  \"last_frame\": {\"nodes\": %u, \"clusters\": %u, \"photons\": %u, \"list\": %u, \"pairs\": %u, "
                  "\"largest\": %u},\n  \"dropped\": {\"samples\": %" PRIu64 ", \"entries\": %" PRIu64 "}\n",
                  s->nodes, s->clusters, s->photons, s->list, s->pairs, s->largest, s->dropped_samples, s->dropped_entries);
}

static void put_verdict(const report_json *r, FILE *to) {
    (void)fprintf(to, "  \"verdict\": {\"exit\": %d, \"verified\": %s, \"golden\": %s, ", (int)r->verdict,
                  r->verified ? "true" : "false", r->golden ? "true" : "false");
    put_named("text", r->verdict_text, to);
    (void)fputs(", ", to);
    put_named("budget", r->noise, to);
    (void)fputs("},\n  \"hashes\": [", to);
    for (uint64_t i = 0; i < r->hash_count; i++)
        (void)fprintf(to, "%s\"%016" PRIx64 "\"", i > 0 ? ", " : "", r->hashes[i]);
    (void)fputs("],\n", to);
}

static void put_all(const report_json *r, FILE *to) {
    (void)fputs("{\n  \"tool\": \"vitrine-play " VIT_VERSION "\",\n  ", to);
    put_named("pack", r->pack, to);
    (void)fputs(",\n  ", to);
    put_named("device", r->device, to);
    (void)fprintf(to, ",\n  \"lanes\": %u,\n  \"view\": \"%s\",\n  \"format\": \"%s\",\n", r->last->lanes, r->view, r->format);
    put_verdict(r, to);
    put_scene(r, to);
    put_frames(r, to);
    put_passes(r, to);
    if (r->work != NULL)
        put_kinds(r->work, to);
    put_memory(r->need, to);
    put_last(r->last, to);
    (void)fputs("}\n", to);
}

vit_status report_json_write(const char *path, const report_json *r, vit_text *why) {
    char *text = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&text, &size);
    if (to == NULL)
        return play_fail(why, VIT_FAILED, "%s: out of memory", path);
    put_all(r, to);
    vit_status status =
        fclose(to) == 0 ? output_file(path, text, size, why) : play_fail(why, VIT_FAILED, "%s: out of memory", path);
    free(text);
    return status;
}
