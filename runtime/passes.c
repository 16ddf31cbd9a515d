/* The frame. Reading vit_passes from top to bottom is reading the renderer; arguments are in the order of the kernels' parameters. */
#include "passes.h"

#define W(name) ((uint64_t)1 << B_##name)
#define RAY_SCENE B_scene, B_triangles, B_attributes, B_materials, B_textures, B_mips, B_texels, B_bvh
#define WORK B_work, V_pass, V_END /* last, in passes that count on the device */
#define ESTIMATE B_masks, B_prefix, B_list_first, B_list_count, B_list, B_photons
#define SPARSE_INPUT B_scene, B_cameras, V_frame, V_max_nodes, ESTIMATE, B_bounds, B_buckets, B_keys, B_position, B_normal, B_accept, B_inverse_area
#define SURFACE_SCENE B_scene, B_triangles, B_attributes, B_materials, B_textures, B_mips, B_texels

const vit_pass vit_passes[] = {
    {"visibility", ALWAYS, PER_SAMPLE, ONCE, W(hit_triangle) | W(hit_distance), {RAY_SCENE, B_cameras, V_frame, B_hit_triangle, B_hit_distance, WORK}},
    {"samples",
     ALWAYS,
     PER_SAMPLE,
     ONCE,
     W(position) | W(normal) | W(albedo) | W(direct) | W(accept) | W(inverse_area),
     {SURFACE_SCENE, B_cameras, V_frame, B_hit_triangle, B_hit_distance, B_sides, B_cells, B_position, B_normal, B_albedo, B_direct, B_accept,
      B_inverse_area, WORK}},
    {"direct_light",
     ON(LIGHTS),
     PER_SAMPLE,
     ONCE,
     W(direct),
     {RAY_SCENE, B_lights, V_frame, B_hit_triangle, B_position, B_normal, B_albedo, B_direct, WORK}},
    {"clear_masks", ON(PHOTONS), PER_MASK_WORD, ONCE, W(masks) | W(counters), {B_scene, B_masks, B_counters, V_END}},
    {"photon_paths", ON(TRACED), PER_PATH, ONCE, W(photons) | W(counters), {RAY_SCENE, B_lights, V_frame, B_sides, B_cells, B_photons, B_counters, WORK}},
    {"cluster_keys",
     ON(PHOTONS),
     PER_RUN,
     ONCE,
     W(masks) | W(keys) | W(counters),
     {B_scene, B_cameras, V_frame, V_run, B_hit_triangle, B_position, B_normal, B_albedo, B_masks, B_keys, B_counters, V_END}},
    {"number_nodes", ON(PHOTONS), ONE_GROUP, ONCE, W(prefix) | W(counters), {B_scene, B_masks, B_prefix, B_counters, V_END}},
    {"make_nodes",
     ON(PHOTONS),
     PER_MASK_WORD,
     ONCE,
     W(node_first) | W(node_count),
     {B_scene, V_max_nodes, B_masks, B_prefix, B_node_first, B_node_count, B_bounds, V_END}},
    {"cluster_bounds",
     ON(PHOTONS),
     PER_RUN,
     ONCE,
     W(bounds) | W(counters),
     {B_scene, V_max_nodes, V_run, B_keys, B_position, B_normal, B_accept, B_masks, B_prefix, B_bounds, B_counters, V_END}},
    {"node_bounds",
     ON(PHOTONS),
     PER_LEVEL_NODE,
     UPWARD,
     W(bounds),
     {B_scene, V_max_nodes, V_level, B_prefix, B_node_first, B_node_count, B_bounds, B_counters, V_END}},
    {"splat_count",
     ON(PHOTONS),
     GROUP_PER_LEVEL_NODE,
     LISTED,
     W(list_count),
     {B_scene, V_max_nodes, V_level, V_chunks, B_photons, B_prefix, B_node_first, B_node_count, B_bounds, B_list_first, B_list_count, B_list,
      B_chunk_count, B_counters, WORK}},
    {"splat_place",
     ON(PHOTONS),
     ONE_GROUP,
     LISTED,
     W(list_first) | W(list_count) | W(counters),
     {B_scene, V_max_nodes, V_max_list, V_level, V_chunks, B_prefix, B_list_first, B_list_count, B_chunk_count, B_counters, V_END}},
    {"splat_write",
     ON(PHOTONS),
     GROUP_PER_LEVEL_NODE,
     LISTED,
     W(list),
     {B_scene, V_max_nodes, V_level, V_chunks, B_photons, B_prefix, B_node_first, B_node_count, B_bounds, B_list_first, B_list_count, B_list, B_cursor,
      B_chunk_count, B_counters, WORK}},
    {"splat_buckets",
     ON(BUCKETS),
     GROUP_PER_LEVEL_NODE,
     LAST,
     W(buckets) | W(list_count) | W(counters),
     {B_scene, V_max_nodes, V_level, V_chunks, B_photons, B_prefix, B_node_first, B_node_count, B_bounds, B_list_first, B_list_count, B_list, B_counters,
      B_buckets, WORK}},
    {"estimate_list",
     ON(LIST) | ON_DENSE,
     PER_SAMPLE,
     ONCE,
     W(indirect),
     {B_scene, V_max_nodes, ESTIMATE, B_keys, B_position, B_normal, B_accept, B_inverse_area, B_indirect, WORK}},
    {"estimate_buckets",
     ON(BUCKETS) | ON_DENSE,
     PER_SAMPLE,
     ONCE,
     W(indirect),
     {B_scene, B_cameras, V_frame, V_max_nodes, B_masks, B_prefix, B_bounds, B_buckets, B_keys, B_position, B_normal, B_accept, B_inverse_area, B_indirect, WORK}},
    {"estimate_sparse", ON(SPARSE), PER_COARSE, ONCE, W(coarse), {SPARSE_INPUT, B_coarse, WORK}},
    {"interpolate",
     ON(SPARSE),
     PER_BLOCK,
     ONCE,
     W(indirect) | W(flags),
     {B_scene, B_cameras, V_frame, B_keys, B_position, B_normal, B_accept, B_inverse_area, B_coarse, B_indirect, B_flags, V_END}},
    {"estimate_rest", ON(SPARSE), PER_REST, ONCE, W(indirect), {SPARSE_INPUT, B_flags, B_indirect, WORK}},
    {"dots_clear", ON_DOTS, PER_PIXEL, ONCE, W(dots), {B_scene, B_dots, V_END}},
    {"photon_dots", ON_DOTS, PER_PHOTON, ONCE, W(dots), {B_scene, B_cameras, V_frame, B_photons, B_hit_distance, B_dots, V_END}},
    {"resolve",
     ALWAYS,
     PER_SAMPLE,
     ONCE,
     W(framebuffer),
     {B_scene, B_cameras, V_frame, B_hit_triangle, B_hit_distance, B_normal, B_albedo, B_direct, V_max_nodes, B_indirect, B_keys, B_masks, B_prefix,
      B_list_count, B_dots, B_photons, B_framebuffer, V_END}},
    {"account", ON(PHOTONS), ONE_GROUP, ONCE, W(counters), {B_counters, V_END}},
};
const uint32_t vit_pass_count = sizeof vit_passes / sizeof vit_passes[0];

#define X(name, when, section, bytes) #name,
const char *const vit_buffer_names[B_COUNT] = {VIT_BUFFERS(X)};
#undef X

#define X(name, when, section, bytes) VIT_SECTION_##section,
const vit_section vit_buffer_sections[B_COUNT] = {VIT_BUFFERS(X)};
#undef X

#define X(name, when, section, bytes) when,
static const uint32_t buffer_when[B_COUNT] = {VIT_BUFFERS(X)};
#undef X

int vit_pass_called(uint32_t pass, const vit_limits *l) {
    return (vit_passes[pass].when & ~l->effects) == 0;
}

int vit_buffer_called(uint32_t buffer, const vit_limits *l) {
    return buffer_when[buffer] == ALWAYS || (buffer_when[buffer] & l->effects) != 0;
}

uint32_t vit_format_bytes(vit_format format) {
    static const uint32_t bytes[] = {
#define X(name, size, meaning) size,
        VIT_FORMATS(X)
#undef X
    };
    return bytes[format];
}

uint64_t vit_buffer_bytes(uint32_t buffer, const vit_scene *s, const vit_limits *l) {
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

const char *vit_buffer_effect(uint32_t buffer, const vit_limits *l) {
    uint32_t by = buffer_when[buffer] & l->effects;
    if (buffer_when[buffer] == ALWAYS)
        return "always";
#define X(bit, name, macro, why)                                                                                               \
    if (by & ON(macro))                                                                                                        \
        return name;
    VIT_EFFECTS(X)
#undef X
    return by & ON_DOTS ? "view photons" : by & ON_WORK ? "count_work" : "not called for";
}

static uint32_t level_words(const vit_scene *s, uint32_t level) {
    return (level + 1 < s->levels ? s->level_first[level + 1] : s->mask_words) - s->level_first[level];
}

static size_t round_up(size_t n, size_t to) {
    return (n + to - 1) / to * to;
}

void vit_pass_size(const vit_pass *p, const vit_scene *s, const vit_limits *l, uint32_t level, size_t *local, size_t *global) {
    size_t nodes = level_words(s, level) < l->max_nodes ? level_words(s, level) : l->max_nodes, n = 1;
    *local = l->group;
    switch (p->extent) {
    case PER_SAMPLE:
        n = s->samples / l->lanes;
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

uint32_t vit_pass_chunks(const vit_pass *p, const vit_limits *l, uint32_t level) {
    return level == 0 && p->repeat == LISTED ? l->chunks : 1;
}

int vit_pass_at_level(const vit_pass *p, const vit_scene *s, const vit_limits *l, uint32_t level) {
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
