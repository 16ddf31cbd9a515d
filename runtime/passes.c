#include "passes.h"
#include "pass_table.h"

#define B(name) B_##name
#define V(name) V_##name
#define X(name, when, rounds, extent, repeat, writes, ...) {#name, when, rounds, extent, repeat, writes, {__VA_ARGS__, V_END}},
const vit_pass vit_passes[] = {VIT_PASSES(X)};
#undef X
#undef B
#undef V
_Static_assert(B_COUNT <= VIT_MAX_BUFFERS && B_COUNT - B_FIRST_WRITTEN <= 64,
               "vitrine.h has room for every buffer, and vit_pass.writes a bit for each that is written");
_Static_assert(sizeof vit_passes / sizeof vit_passes[0] <= VIT_MAX_PASSES, "vitrine.h has room for every pass");
const uint32_t vit_pass_count = sizeof vit_passes / sizeof vit_passes[0];

#define X(name, when, section, bytes) #name,
const char *const vit_buffer_names[B_COUNT] = {VIT_BUFFERS(X)};
#undef X

#define X(name, when, section, bytes) VIT_SECTION_##section,
const vit_section vit_buffer_sections[B_COUNT] = {VIT_BUFFERS(X)};
#undef X

#define X(name, when, section, bytes) when,
static const uint64_t buffer_when[B_COUNT] = {VIT_BUFFERS(X)};
#undef X

int vit_pass_called(uint32_t pass, const vit_launch *l) {
    return (vit_passes[pass].when & ~l->effects) == 0;
}

int vit_buffer_called(uint32_t buffer, const vit_launch *l) {
    return buffer_when[buffer] == ALWAYS || (buffer_when[buffer] & l->effects) != 0;
}

uint32_t vit_format_bytes(vit_format format) {
    static const uint32_t bytes[] = {
#define X(name, word, size, word_bytes, meaning) size,
        VIT_FORMATS(X)
#undef X
    };
    return bytes[format];
}

uint32_t vit_format_word(vit_format format) {
    static const uint32_t bytes[] = {
#define X(name, word, size, word_bytes, meaning) word_bytes,
        VIT_FORMATS(X)
#undef X
    };
    return bytes[format];
}

size_t vit_row_bytes(const vit_scene *s, const vit_launch *l) {
    return (size_t)s->width * vit_format_bytes(l->format);
}

size_t vit_pitch_bytes(const vit_launch *l) {
    return (size_t)l->pitch * vit_format_bytes(l->format);
}

int vit_view_light(vit_view view) {
    static const int shows[] = {
#define X(name, light, meaning) light,
        VIT_VIEWS(X)
#undef X
    };
    return shows[view];
}

uint64_t vit_buffer_bytes(uint32_t buffer, const vit_scene *s, const vit_launch *l) {
    if (!vit_buffer_called(buffer, l))
        return 0;
    switch (buffer) {
#define X(name, when, section, bytes)                                                                                          \
    case B_##name:                                                                                                             \
        return bytes;
        VIT_BUFFERS(X)
#undef X
    default:
        return 0;
    }
}

uint32_t vit_buffer_word(uint32_t buffer, const vit_launch *l) {
    if (buffer == B_framebuffer)
        return vit_format_word(l->format);
    return buffer == B_position && (l->effects & ON(SMALL_SAMPLES)) ? 2 : 4;
}

const char *vit_effect_first(uint64_t effects) {
#define X(bit, name, macro, why)                                                                                               \
    if (effects & ON(macro))                                                                                                   \
        return name;
    VIT_EFFECTS(X)
#undef X
    return NULL;
}

const char *vit_buffer_effect(uint32_t buffer, const vit_launch *l) {
    const uint64_t by = buffer_when[buffer] & l->effects;
    const char *of_pack = vit_effect_first(by);
    if (buffer_when[buffer] == ALWAYS)
        return "always";
    if (of_pack)
        return of_pack;
    if (by & ON_CHAINS)
        return l->effects & ON(MIRROR) ? "mirror" : "glass";
    if (by & ON_FILM)
        return l->effects & ON(ANTIALIAS) ? "antialias" : "glass";
    if (by & ON_CELLS)
        return l->effects & ON(BASIS) ? "basis" : "radiosity";
    if (by & ON_REACH)
        return "record_reach";
    if (by & (ON_SKY_RAYS | ON_AREA_RAYS))
        return by & ON_SKY_RAYS ? "sky-light" : "area-lights";
    return by & ON_DOTS ? "view photons" : by & ON_WORK ? "count_work" : "not called for";
}

int vit_pass_in_round(const vit_pass *p, const vit_launch *l, uint32_t round) {
    switch (p->rounds) {
    case FIRST:
        return round == 0;
    case SECOND_COPY:
        return round == l->layers;
    case AT_END:
        return round + 1 == l->rounds;
    default:
        return 1;
    }
}

uint32_t vit_pass_rounds(const vit_pass *p, const vit_launch *l) {
    return p->rounds == EACH ? l->rounds : p->rounds != SECOND_COPY || l->rounds > l->layers;
}

static uint64_t written(uint32_t buffer) {
    return buffer >= B_FIRST_WRITTEN && buffer < B_COUNT ? (uint64_t)1 << (buffer - B_FIRST_WRITTEN) : 0;
}

uint64_t vit_passes_of_history(const vit_launch *l) {
    uint64_t rows = 0, buffers = written(B_cache_counts);
    for (uint32_t p = vit_pass_count; p-- > 0;) {
        const vit_pass *pass = &vit_passes[p];
        if (!vit_pass_called(p, l) || !vit_pass_in_round(pass, l, 0) || !(pass->writes & buffers))
            continue;
        rows |= (uint64_t)1 << p;
        for (int i = 0; pass->args[i] != V_END; i++)
            buffers |= written(pass->args[i]);
    }
    return rows;
}

int vit_buffer_of_history(uint32_t buffer) {
    return buffer_when[buffer] == ON(LIVE_CACHE);
}

static uint32_t level_words(const vit_scene *s, uint32_t level) {
    return (level + 1 < s->levels ? s->level_first[level + 1] : s->mask_words) - s->level_first[level];
}

static size_t round_up(size_t n, size_t to) {
    return (n + to - 1) / to * to;
}

void vit_pass_size(const vit_pass *p, const vit_scene *s, const vit_launch *l, uint32_t level, size_t *local, size_t *global) {
    size_t nodes = level_words(s, level) < l->max_nodes ? level_words(s, level) : l->max_nodes, n = 1;
    *local = l->group;
    switch (p->extent) {
    case PER_SAMPLE:
        n = s->samples / l->lanes;
        break;
    case PER_BUNDLE:
        n = s->samples / (l->lanes * VIT_BUNDLE_OF(l->lanes));
        *local = l->lanes > 1 ? 1 : l->group; /* bundles are fat, and each work-item of a group has its own memory for one */
        break;
    case PER_COARSE:
    case PER_REST:
        n = l->lanes > 1 ? s->samples / (s->tile * s->tile) : p->extent == PER_REST ? s->samples : (size_t)VIT_COARSE(s, l);
        *local = l->lanes > 1 ? 1 : l->group; /* tiles are fat */
        break;
    case PER_BLOCK:
        n = s->samples / 16;
        break;
    case PER_RUN:
        n = (s->samples + l->run - 1) / l->run;
        *local = l->run > 64 ? 1 : l->group; /* long runs: few fat work-items */
        break;
    case PER_PATH:
        n = s->paths / l->lanes;
        break;
    case PER_PHOTON:
        n = s->photons;
        break;
    case PER_RELIT:
        n = s->receivers / 2 / l->lanes;
        break;
    case PER_RECEIVER:
        n = s->receivers;
        break;
    case PER_POINT:
        n = s->patch_points / l->lanes;
        break;
    case PER_PATCH:
        n = VIT_PATCH_STRIDE(s);
        break;
    case PER_COLUMN:
        n = (size_t)VIT_PATCH_STRIDE(s) + s->patch_points;
        break;
    case PER_RANK:
        n = (size_t)VIT_TRANSFER_COLUMN_CHUNKS(s) * s->transfer_rank / l->lanes;
        break;
    case PER_MIX:
        n = 3 * (size_t)s->transfer_rank / l->lanes;
        break;
    case PER_SUM:
        n = (size_t)VIT_PATCH_STRIDE(s) / l->lanes * s->transfer_sums;
        break;
    case PER_ROW:
        n = VIT_PATCH_STRIDE(s) / l->lanes;
        break;
    case PER_CACHE_CELL:
        n = s->cache_cells;
        break;
    case PER_MASK_WORD:
        n = s->mask_words > VIT_COUNTER_COUNT ? s->mask_words : VIT_COUNTER_COUNT;
        break;
    case PER_LEVEL_NODE:
        n = nodes;
        break;
    case PER_PIXEL:
        n = (size_t)s->width * s->height;
        break;
    case GROUP_PER_LEVEL_NODE:
        *local = l->splat_group;
        n = nodes * vit_pass_chunks(p, l, level) * l->splat_group;
        break;
    case ONE_GROUP:
        *local = l->scan_group;
        n = l->scan_group;
        break;
    }
    *global = round_up(n, *local);
}

uint32_t vit_pass_chunks(const vit_pass *p, const vit_launch *l, uint32_t level) {
    return level == 0 && p->repeat == LISTED ? l->chunks : 1;
}

int vit_pass_at_level(const vit_pass *p, const vit_scene *s, const vit_launch *l, uint32_t level) {
    int last = level + 1 == s->levels;
    switch (p->repeat) {
    case ONCE:
        return level == 0;
    case UPWARD:
        return 1;
    case LISTED:
        return !last || (l->effects & ON(LIST));
    case LAST:
        return last;
    }
    return 0;
}
