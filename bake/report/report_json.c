/* report_json.c: all of the results but the images. Strict JSON (RFC 8259): what is not finite is null. */
#include "report/report_parts.h"

#include <inttypes.h>

static void member_number(FILE *to, const char *name, double value) {
    (void)fprintf(to, "\"%s\": ", name);
    text_number(to, value, "null");
}

static void member_text(FILE *to, const char *name, const char *value) {
    (void)fprintf(to, "\"%s\": ", name);
    text_json(to, value);
}

static void print_error(FILE *to, const char *name, const cost_error *e) {
    const struct {
        const char *name;
        double value;
    } fields[] = {{"nmse", e->nmse}, {"relmse", e->relmse}, {"bias", e->bias},
                  {"psnr", e->psnr}, {"ssim", e->ssim},     {"local", e->local}};
    (void)fprintf(to, "\"%s\": {", name);
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++) {
        (void)fputs(i ? ", " : "", to);
        member_number(to, fields[i].name, fields[i].value);
    }
    (void)fputc('}', to);
}

static void print_passes(const cost_results *r, const cost_setting *s, FILE *to) {
    (void)fputs("\"passes\": [", to);
    for (uint32_t p = 0; p < s->pass_count; p++) {
        (void)fputs(p ? ",\n      {" : "\n      {", to);
        member_text(to, "name", s->pass_names[p]);
        (void)fputs(", ", to);
        member_number(to, "ms", s->pass_ms[p]);
        (void)fputs(", \"work\": [", to);
        for (uint32_t w = 0; w < r->work_count; w++)
            (void)fprintf(to, "%s%" PRIu64, w ? ", " : "", s->pass_work[p][w]);
        (void)fputs("]}", to);
    }
    (void)fputc(']', to);
}

static void print_setting(const cost_results *r, uint32_t i, FILE *to) {
    const cost_setting *s = &r->settings[i];
    (void)fprintf(to, "    {\"index\": %" PRIu32 ", ", i);
    member_text(to, "name", s->name);
    (void)fputs(", ", to);
    member_text(to, "knob", s->knob);
    (void)fputs(", ", to);
    member_text(to, "values", s->values);
    (void)fputs(",\n     ", to);
    member_number(to, "ms", s->ms);
    (void)fputs(", ", to);
    member_number(to, "ms_p95", s->ms_p95);
    (void)fputs(", ", to);
    member_number(to, "ms_mad", s->ms_mad);
    (void)fprintf(to,
                  ", \"timed\": %" PRIu32 ", \"work\": %" PRIu64 ", \"device_bytes\": %" PRIu64 ", \"pack_bytes\": %" PRIu64,
                  s->timed, s->work, s->device_bytes, s->pack_bytes);
    (void)fputs(", ", to);
    member_number(to, "bake_seconds", s->bake_seconds);
    (void)fprintf(to, ", \"front\": %s, \"front_relmse\": %s, \"elsewhere\": %s,\n     ", s->pareto ? "true" : "false",
                  s->pareto_relmse ? "true" : "false", s->elsewhere ? "true" : "false");
    member_number(to, "path_tracer_ms_at_nmse", report_equal_ms(r, s, REPORT_NMSE));
    (void)fputs(", ", to);
    member_number(to, "path_tracer_ms_at_relmse", report_equal_ms(r, s, REPORT_RELMSE));
    (void)fputs(",\n     ", to);
    print_error(to, "total", &s->total);
    (void)fputs(",\n     ", to);
    print_error(to, "indirect", &s->indirect);
    (void)fputs(",\n     ", to);
    print_error(to, "unlimited", &s->unlimited);
    (void)fputs(",\n     ", to);
    print_passes(r, s, to);
    (void)fputs(i + 1 < r->count ? "},\n" : "}\n", to);
}

static void print_reference(const reference *f, FILE *to) {
    (void)fprintf(to,
                  "  \"reference\": {\"width\": %" PRIu32 ", \"height\": %" PRIu32 ", \"samples\": %" PRIu32
                  ", \"rays\": %" PRIu64 ", ",
                  f->width, f->height, f->samples, f->rays);
    member_number(to, "error", f->error);
    (void)fputs(", ", to);
    member_number(to, "seconds", f->seconds);
    (void)fputs("},\n", to);
}

void report_json(const cost_results *r, FILE *to) {
    (void)fputs("{\n  \"format\": 1,\n  ", to);
    member_text(to, "scene", r->scene);
    (void)fputs(",\n  ", to);
    member_text(to, "device", r->device);
    (void)fputs(",\n  ", to);
    member_text(to, "cpu", r->cpu);
    (void)fprintf(to, ",\n  \"width\": %" PRIu32 ", \"height\": %" PRIu32 ", \"frame\": %" PRIu32 ", \"every\": %" PRIu32 ",\n",
                  r->width, r->height, r->frame, r->every);
    print_reference(&r->reference, to);
    (void)fputs("  ", to);
    print_error(to, "truncation", &r->truncation);
    (void)fputs(",\n  ", to);
    print_error(to, "direct", &r->direct);
    (void)fputs(", ", to);
    member_number(to, "direct_largest", r->direct_largest);
    (void)fputs(",\n  \"path_tracer\": {", to);
    member_number(to, "ms", r->path_tracer_ms);
    (void)fputs(", ", to);
    member_number(to, "nmse", r->path_tracer_nmse);
    (void)fputs(", ", to);
    member_number(to, "relmse", r->path_tracer_relmse);
    (void)fputs("},\n  \"work_names\": [", to);
    for (uint32_t w = 0; w < r->work_count; w++) {
        (void)fputs(w ? ", " : "", to);
        text_json(to, r->work_names[w]);
    }
    (void)fputs("],\n  \"settings\": [\n", to);
    for (uint32_t i = 0; i < r->count; i++)
        print_setting(r, i, to);
    (void)fputs("  ]\n}\n", to);
}
