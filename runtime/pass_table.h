/* The frame: reading VIT_PASSES from top to bottom is reading the renderer. The one list of passes: vit_passes (passes.c) and
 * the host's calls of the kernels (host/kernels.c) are made from it.
 *
 * X(kernel, when, rounds, extent, repeat, what it writes, arguments in the order of the kernel's parameters...): see vit_pass.
 * An argument is B(buffer) or V(value), as who includes this file defines them. */
#ifndef VIT_PASS_TABLE_H
#define VIT_PASS_TABLE_H

#include "passes.h"

#define W(name) ((uint64_t)1 << (B_##name - B_FIRST_WRITTEN))
#define ARGS_SURFACE B(scene), B(triangles), B(attributes), B(materials), B(textures), B(mips), B(texels)
#define ARGS_RAYS ARGS_SURFACE, B(bvh)
#define ARGS_WORK B(work), V(pass) /* last, in passes that count on the device */
#define ARGS_ESTIMATE B(masks), B(prefix), B(list_first), B(list_count), B(list), B(photons)
/* What gathers photons reads, by list or by buckets (kernels/indirect.cl, INDIRECT_PARAMETERS). */
#define ARGS_INDIRECT                                                                                                          \
    B(scene), B(cameras), V(frame), V(max_nodes), ARGS_ESTIMATE, B(bounds), B(buckets), B(keys), B(position), B(normal),       \
        B(accept), B(inverse_area)

#define ARGS_ROUND B(cameras), V(frame), V(round), V(layers), B(active)

#define VIT_PASSES(X)                                                                                                          \
    X(find_edges, ON(ANTIALIAS), SECOND_COPY, PER_BLOCK, ONCE, W(edges), B(scene), B(shown), B(edges))                         \
    X(activate, ON_FILM, EACH, PER_BLOCK, ONCE, W(active) | W(split), B(scene), V(round), V(layers), B(edges), B(split),       \
      B(active))                                                                                                               \
    X(relight, ON(RELIGHT), FIRST, PER_RELIT, ONCE, W(relit), B(scene), V(frame), B(lights), B(basis_groups), B(basis_words),  \
      B(basis_coefficients), B(basis_frames), B(receivers), B(relit), ARGS_WORK)                                               \
    X(patch_light, ON(RADIOSITY), FIRST, PER_POINT, ONCE, W(radiosity), ARGS_RAYS, V(frame), B(lights), B(patch_points),       \
      B(radiosity), ARGS_WORK)                                                                                                 \
    X(patch_mean, ON(RADIOSITY), FIRST, PER_PATCH, ONCE, W(radiosity), B(scene), B(patches), B(patch_points), B(radiosity))    \
    X(transfer_project, ON(LOW_RANK), FIRST, PER_RANK, ONCE, W(projected), B(transfer), B(radiosity), B(projected))            \
    X(transfer_mix, ON(LOW_RANK), FIRST, PER_MIX, ONCE, W(mixed), B(transfer), B(projected), B(mixed))                         \
    X(transfer_partial, ON(TRANSFER), FIRST, PER_SUM, ONCE, W(sums), B(transfer), B(radiosity), B(mixed), B(sums))             \
    X(transfer_sum, ON(TRANSFER), FIRST, PER_ROW, ONCE, W(reflected), B(transfer), B(sums), B(reflected))                      \
    X(patch_reflect, ON(TRANSFER), FIRST, PER_COLUMN, ONCE, W(radiosity), B(scene), B(patch_points), B(reflected),             \
      B(radiosity))                                                                                                            \
    X(gather_patches, ON(RADIOSITY), FIRST, PER_RECEIVER, ONCE, W(relit), B(scene), V(frame), B(gather_rows), B(gather_words), \
      B(looked_up), B(receivers), B(radiosity), B(relit), ARGS_WORK)                                                           \
    X(visibility, ALWAYS, EACH, PER_BUNDLE, ONCE, W(hit_triangle) | W(hit_distance), ARGS_RAYS, ARGS_ROUND, B(hit_triangle),   \
      B(hit_distance), ARGS_WORK)                                                                                              \
    X(chains, ON_CHAINS, EACH, PER_SAMPLE, ONCE, W(hit_triangle) | W(hit_distance) | W(rays) | W(split), ARGS_RAYS, B(maps),   \
      ARGS_ROUND, B(hit_triangle), B(hit_distance), B(rays), B(split), B(reached), ARGS_WORK)                                  \
    X(samples, ALWAYS, EACH, PER_SAMPLE, ONCE,                                                                                 \
      W(position) | W(normal) | W(albedo) | W(direct) | W(accept) | W(inverse_area) | W(specular) | W(indirect) | W(by_rays),  \
      ARGS_SURFACE, B(maps), ARGS_ROUND, B(hit_triangle), B(hit_distance), B(rays), B(sky), B(sides), B(cells), B(position),   \
      B(normal), B(albedo), B(direct), B(accept), B(inverse_area), B(specular), B(receiver_cells), B(receiver_splits),         \
      B(receivers), B(relit), B(indirect), B(map_sides), B(map_cells), B(map_splits), B(map_receivers), B(by_rays),            \
      B(reached), ARGS_WORK)                                                                                                   \
    X(point_light, ON(POINTS), EACH, PER_SAMPLE, ONCE, W(indirect), B(scene), ARGS_ROUND, B(hit_triangle), B(position),        \
      B(normal), B(albedo), B(receiver_cells), B(receivers), B(relit), B(indirect), ARGS_WORK)                                 \
    X(cache_sample, ON(LIVE_CACHE), FIRST, PER_SAMPLE, ONCE, W(cache_frame), ARGS_RAYS, ARGS_ROUND, B(hit_triangle),           \
      B(position), B(normal), B(cache), B(cache_counts), B(cache_frame), ARGS_WORK)                                            \
    X(cache_merge, ON(LIVE_CACHE), FIRST, PER_CACHE_CELL, ONCE, W(cache_frame) | W(cache_counts), B(scene), B(cache_frame),    \
      B(cache_counts))                                                                                                         \
    X(direct_light, ON(LIGHTS), EACH, PER_BUNDLE, ONCE, W(direct), ARGS_RAYS, ARGS_ROUND, B(lights), B(hit_triangle),          \
      B(position), B(normal), B(albedo), B(rays), B(specular), B(direct), ARGS_WORK)                                           \
    X(lightmap_rays, ON(LIGHTMAP_RAYS), EACH, PER_SAMPLE, ONCE, W(direct), ARGS_RAYS, ARGS_ROUND, B(area_lights),              \
      B(hit_triangle), B(position), B(normal), B(albedo), B(rays), B(specular), B(direct), B(by_rays), ARGS_WORK)              \
    X(area_light, ON_AREA_RAYS, EACH, PER_SAMPLE, ONCE, W(direct), ARGS_RAYS, ARGS_ROUND, B(area_lights), B(hit_triangle),     \
      B(position), B(normal), B(albedo), B(rays), B(specular), B(direct), ARGS_WORK)                                           \
    X(sky_light, ON_SKY_RAYS, EACH, PER_SAMPLE, ONCE, W(skylight), ARGS_RAYS, ARGS_ROUND, B(area_lights), B(hit_triangle),     \
      B(position), B(normal), B(rays), B(specular), B(skylight), ARGS_WORK)                                                    \
    X(sky_filter, ON_SKY_RAYS, EACH, PER_SAMPLE, ONCE, W(direct), B(scene), B(position), B(normal), B(albedo), B(specular),    \
      B(skylight), B(direct))                                                                                                  \
    X(ambient_light, ON(OCCLUSION), EACH, PER_SAMPLE, ONCE, W(direct), B(scene), ARGS_ROUND, B(hit_triangle), B(position),     \
      B(normal), B(albedo), B(specular), B(cache), B(cache_counts), B(direct), ARGS_WORK)                                      \
    X(gloss, ON(GLOSS), EACH, PER_SAMPLE, ONCE, W(gloss), ARGS_RAYS, B(maps), ARGS_ROUND, B(lights), B(area_lights), B(sky),   \
      B(sides), B(receiver_cells), B(receiver_splits), B(receivers), B(relit), B(map_sides), B(map_cells), B(map_splits),      \
      B(map_receivers), B(hit_triangle), B(position), B(normal), B(rays), B(specular), B(gloss), B(reached), ARGS_WORK)        \
    X(gloss_filter, ON(GLOSS), EACH, PER_SAMPLE, ONCE, W(direct), B(scene), ARGS_ROUND, B(position), B(normal), B(rays),       \
      B(specular), B(gloss), B(direct))                                                                                        \
    X(clear_masks, ON(PHOTONS), EACH, PER_MASK_WORD, ONCE, W(masks) | W(counters), B(scene), V(round), B(masks), B(counters))  \
    X(photon_paths, ON(TRACED), FIRST, PER_PATH, ONCE, W(photons) | W(counters), ARGS_RAYS, B(maps), B(lights), V(frame),      \
      B(sides), B(cells), B(photons), B(counters), B(reached), ARGS_WORK)                                                      \
    X(cluster_keys, ON(PHOTONS), EACH, PER_RUN, ONCE, W(masks) | W(keys) | W(counters), B(scene), B(cameras), V(frame),        \
      V(run), B(hit_triangle), B(position), B(normal), B(albedo), B(masks), B(keys), B(counters))                              \
    X(number_nodes, ON(PHOTONS), EACH, ONE_GROUP, ONCE, W(prefix) | W(counters), B(scene), B(masks), B(prefix), B(counters))   \
    X(make_nodes, ON(PHOTONS), EACH, PER_MASK_WORD, ONCE, W(node_first) | W(node_count), B(scene), V(max_nodes), B(masks),     \
      B(prefix), B(node_first), B(node_count), B(bounds))                                                                      \
    X(cluster_bounds, ON(PHOTONS), EACH, PER_RUN, ONCE, W(bounds) | W(counters), B(scene), V(max_nodes), V(run), B(keys),      \
      B(position), B(normal), B(accept), B(masks), B(prefix), B(bounds), B(counters))                                          \
    X(node_bounds, ON(PHOTONS), EACH, PER_LEVEL_NODE, UPWARD, W(bounds), B(scene), V(max_nodes), V(level), B(prefix),          \
      B(node_first), B(node_count), B(bounds), B(counters))                                                                    \
    X(splat_count, ON(PHOTONS), EACH, GROUP_PER_LEVEL_NODE, LISTED, W(list_count), B(scene), V(max_nodes), V(level),           \
      V(chunks), B(photons), B(prefix), B(node_first), B(node_count), B(bounds), B(list_first), B(list_count), B(list),        \
      B(chunk_count), B(counters), ARGS_WORK)                                                                                  \
    X(splat_place, ON(PHOTONS), EACH, ONE_GROUP, LISTED, W(list_first) | W(list_count) | W(counters), B(scene), V(max_nodes),  \
      V(max_list), V(level), V(chunks), B(prefix), B(list_first), B(list_count), B(chunk_count), B(counters))                  \
    X(splat_write, ON(PHOTONS), EACH, GROUP_PER_LEVEL_NODE, LISTED, W(list), B(scene), V(max_nodes), V(level), V(chunks),      \
      B(photons), B(prefix), B(node_first), B(node_count), B(bounds), B(list_first), B(list_count), B(list), B(cursor),        \
      B(chunk_count), B(counters), ARGS_WORK)                                                                                  \
    X(splat_buckets, ON(BUCKETS), EACH, GROUP_PER_LEVEL_NODE, LAST, W(buckets) | W(list_count) | W(counters), B(scene),        \
      V(max_nodes), V(level), V(chunks), B(photons), B(prefix), B(node_first), B(node_count), B(bounds), B(list_first),        \
      B(list_count), B(list), B(counters), B(buckets), ARGS_WORK)                                                              \
    X(estimate_all, ON(PHOTONS) | ON_DENSE, EACH, PER_SAMPLE, ONCE, W(indirect), ARGS_INDIRECT, B(indirect), ARGS_WORK)        \
    X(estimate_sparse, ON(SPARSE), EACH, PER_COARSE, ONCE, W(coarse), ARGS_INDIRECT, B(coarse), ARGS_WORK)                     \
    X(interpolate, ON(SPARSE), EACH, PER_BLOCK, ONCE, W(indirect) | W(flags), B(scene), B(cameras), V(frame), B(keys),         \
      B(position), B(normal), B(albedo), B(accept), B(inverse_area), B(coarse), B(indirect), B(flags))                         \
    X(estimate_rest, ON(SPARSE), EACH, PER_REST, ONCE, W(indirect), ARGS_INDIRECT, B(flags), B(indirect), ARGS_WORK)           \
    X(dots_clear, ON_DOTS, FIRST, PER_PIXEL, ONCE, W(dots), B(scene), B(dots))                                                 \
    X(photon_dots, ON_DOTS, FIRST, PER_PHOTON, ONCE, W(dots), B(scene), B(cameras), V(frame), B(photons), B(hit_distance),     \
      B(dots))                                                                                                                 \
    X(expose, ON_FILM, EACH, PER_SAMPLE, ONCE, W(film) | W(shown), B(scene), ARGS_ROUND, B(albedo), B(direct), B(indirect),    \
      B(specular), B(rays), B(film), B(shown))                                                                                 \
    X(resolve, ALWAYS, AT_END, PER_SAMPLE, ONCE, W(framebuffer), B(scene), B(cameras), V(frame), B(bvh), B(hit_triangle),      \
      B(hit_distance), B(normal), B(albedo), B(direct), V(max_nodes), B(indirect), B(keys), B(masks), B(prefix),               \
      B(list_count), B(dots), B(photons), B(specular), B(rays), B(film), B(edges), V(pitch), B(framebuffer))                   \
    X(account, ON(PHOTONS), EACH, ONE_GROUP, ONCE, W(counters) | W(faults), B(counters), V(frame), V(round), B(faults))

#endif
