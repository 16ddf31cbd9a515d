/* The loader against forged packs: a valid pack is spoilt in one place and gets right hashes again, so that the checks behind
 * the hashes are reached. Each must be refused for its own reason, in one line that names the section; the part of the line
 * stands beside the damage, so that no fault can hide behind another. Run it with config=sanitize as well. */
#include "forged_pack.h"

#include <float.h>
#include <math.h>

/* X(place, name, part of the line, damage done to `im`) */

#define CONTAINER_FAULTS(X)                                                                                                    \
    X(header, wrong_magic, "not a Vitrine pack", im->header->magic[0] = 'v')                                                   \
    X(header, newer_version, "version 13", im->header->version = 13)                                                           \
    X(header, too_few_sections, "13 sections", im->header->sections = 13)                                                      \
    X(header, huge_number_of_sections, "4294967295 sections", im->header->sections = 0xffffffff)                               \
    X(header, huge_size, "the file", im->header->size = UINT64_MAX)                                                            \
    X(header, reserved_byte, "reserved", im->header->zero[31] = 1)                                                             \
    X(CAMS, unknown_code, "not at its place", ENTRY(CAMS).code[3] = 'X')                                                       \
    X(CAMS, sections_swapped, "not at its place", swap_entries(im, VIT_SECTION_CAMS, VIT_SECTION_LITE))                        \
    X(LITE, section_twice, "not at its place", ENTRY(LITE) = ENTRY(CAMS))                                                      \
    X(GEOM, other_record_size, "records of 44 bytes", ENTRY(GEOM).record = 44)                                                 \
    X(META, offset_into_the_table, "overlaps", ENTRY(META).offset = 0)                                                         \
    X(ATTR, misaligned_offset, "multiple of 4096", ENTRY(ATTR).offset += 16)                                                   \
    X(ATTR, overlap, "overlaps", ENTRY(ATTR).offset = ENTRY(GEOM).offset)                                                      \
    X(MATL, overlap_backwards, "overlaps", ENTRY(MATL).offset = ENTRY(META).offset)                                            \
    X(BVHN, offset_beyond_the_file, "beyond the end", ENTRY(BVHN).offset += (uint64_t)1 << 40)                                 \
    X(BVHN, huge_offset, "beyond the end", ENTRY(BVHN).offset = UINT64_MAX - 4095)                                             \
    X(BVHN, huge_size_that_wraps, "beyond the end", ENTRY(BVHN).size = UINT64_MAX - ENTRY(BVHN).offset + 5)                    \
    X(GOLD, size_one_too_large, "beyond the end", ENTRY(GOLD).size += 1)                                                       \
    X(GEOM, size_short_by_a_record, "but META counts", shorten(im, VIT_SECTION_GEOM, sizeof(vit_triangle)))                    \
    X(GEOM, size_short_by_a_byte, "the gap before it", ENTRY(LITE).size -= 32, poke(im, ENTRY(GEOM).offset - 1))               \
    X(CAMS, gap_not_zero, "the gap before it", poke(im, ENTRY(CAMS).offset - 1))                                               \
    X(META, gap_not_zero_after_table, "the gap before it", poke(im, 2000))                                                     \
    X(META, too_short, "expected", shorten(im, VIT_SECTION_META, 16))

#define META_FAULTS(X)                                                                                                         \
    X(META, no_width, "width", im->scene->width = 0)                                                                           \
    X(META, huge_width, "width", im->scene->width = 0xffffffff)                                                                \
    X(META, huge_height, "height", im->scene->height = 4321)                                                                   \
    X(META, no_frames, "frames", im->scene->frames = 0)                                                                        \
    X(META, huge_frames, "frames", im->scene->frames = 0xffffffff)                                                             \
    X(META, odd_tile, "tile", im->scene->tile = 24)                                                                            \
    X(META, no_triangles, "triangles", im->scene->triangles = 0)                                                               \
    X(META, huge_triangles, "triangles", im->scene->triangles = 0xffffffff)                                                    \
    X(META, huge_nodes, "nodes", im->scene->nodes = 0xffffffff)                                                                \
    X(META, no_materials, "materials", im->scene->materials = 0)                                                               \
    X(META, huge_materials, "materials", im->scene->materials = 0xffffffff)                                                    \
    X(META, huge_textures, "textures", im->scene->textures = 0xffffffff)                                                       \
    X(META, huge_mips, "mips", im->scene->mips = 0xffffffff)                                                                   \
    X(META, huge_texels, "texels", im->scene->texels = 0xffffffff)                                                             \
    X(META, huge_cells, "cells", im->scene->cells = 0x1000000)                                                                 \
    X(META, huge_lights, "lights", im->scene->lights = 65)                                                                     \
    X(META, huge_paths, "paths", im->scene->paths = 0xffffffff)                                                                \
    X(META, huge_baked, "baked", im->scene->baked = 0xffffffff)                                                                \
    X(META, no_bounces, "bounces", im->scene->bounces = 0)                                                                     \
    X(META, huge_bounces, "bounces", im->scene->bounces = 33)                                                                  \
    X(META, too_many_photons, "photons", im->scene->paths = 1000000, im->scene->bounces = 32, im->scene->baked = 1 << 22)      \
    X(META, no_copies, "copies", im->scene->copies = 0)                                                                        \
    X(META, three_copies, "copies must be 1, 2, 4, 8 or 16", im->scene->copies = 3)                                            \
    X(META, too_many_copies, "copies", im->scene->copies = 32)                                                                 \
    X(META, one_copy_with_the_effect, "1 copies contradict", im->scene->copies = 1)                                            \
    X(META, copies_without_the_effect, "2 copies contradict", EFFECTS(0, BIT(ANTIALIAS)))                                      \
    X(META, contrast_above_1, "contrast", im->scene->contrast = 1.5f)                                                          \
    X(META, negative_contrast, "contrast", im->scene->contrast = -1)                                                           \
    X(META, offset_of_nan, "offset 15", im->scene->offset[15][1] = NAN)                                                        \
    X(META, offset_far_off, "offset 0", im->scene->offset[0][0] = 1.5f)                                                        \
    X(META, negative_ambient, "ambient green", im->scene->ambient[1] = -1)                                                     \
    X(META, ambient_of_nan, "ambient red", im->scene->ambient[0] = NAN)                                                        \
    X(META, chain_too_long, "chain", im->scene->chain = 33)                                                                    \
    X(META, no_chain_with_mirrors, "chains of 0 contradict", im->scene->chain = 0)                                             \
    X(META, chain_without_mirror_or_glass, "chains of 8 contradict", EFFECTS(0, BIT(MIRROR) | BIT(GLASS)))                     \
    X(META, too_many_area_samples, "area_samples", im->scene->area_samples = 1025)                                             \
    X(META, too_many_sky_samples, "sky_samples", im->scene->sky_samples = 0xffffffff)                                          \
    X(META, area_points_without_the_effect, "1 and 1 points", EFFECTS(0, BIT(AREA_LIGHTS)))                                    \
    X(META, no_sky_points_with_the_effect, "1 and 0 points", im->scene->sky_samples = 0)                                       \
    X(META, sky_too_large, "sky_size", im->scene->sky_size = 2049)                                                             \
    X(META, no_sky_with_the_effect, "SKY_IMAGE without a sky", im->scene->sky_size = 0)                                        \
    X(META, caustics_without_photons, "without", EFFECTS(0, BIT(PHOTONS) | BIT(TRACED)))                                       \
    X(META, directional_without_lights, "DIRECTIONAL without LIGHTS",                                                          \
      EFFECTS(BIT(DIRECTIONAL), BIT(LIGHTS) | BIT(SPOT) | BIT(RANGE) | BIT(TRACED)))                                           \
    X(META, levels_of_points, "1 levels, 0 cells and 0 splits contradict", im->scene->point_levels = 1)                        \
    X(META, reserved_words_in_use, "padding", im->scene->gloss_pad[2] = 1)                                                     \
    X(EMIT, position_is_nan, "point 3: position", im->emitters[3].position[1] = NAN)                                           \
    X(EMIT, normal_too_short, "point 0: position is not finite, or normal", im->emitters[0].normal[1] = -0.5f)                 \
    X(EMIT, direction_too_long, "point 16", im->emitters[16].position[1] = 2)                                                  \
    X(EMIT, point_without_area, "point 15: radius2", im->emitters[15].radius2 = 0)                                             \
    X(EMIT, sky_with_an_area, "point 31: radius2", im->emitters[31].radius2 = 1)                                               \
    X(EMIT, negative_power, "point 1: power", im->emitters[1].power[0] = -1)                                                   \
    X(EMIT, too_much_power, "point 17: power", im->emitters[17].power[2] = 2e15f)                                              \
    X(SKYT, radiance_is_nan, "texel 15: radiance", im->sky[15].radiance[2] = NAN)                                              \
    X(SKYT, negative_radiance, "texel 0: radiance", im->sky[0].radiance[0] = -1)                                               \
    X(MATL, unknown_kind, "material 1: unknown kind", im->materials[1].kind = 4)                                               \
    X(MATL, specular_above_1, "material 0: specular", im->materials[0].specular[1] = 1.5f)                                     \
    X(MATL, exponent_of_0, "exponent", im->materials[0].exponent = 0)                                                          \
    X(MATL, exponent_of_nan, "exponent", im->materials[1].exponent = NAN)                                                      \
    X(MATL, ior_below_1, "ior", im->materials[0].ior = 0.5f)                                                                   \
    X(MATL, negative_absorption, "absorption", im->materials[0].absorption[2] = -1)                                            \
    X(MATL, lights_of_2, "lights must be 0 or 1", im->materials[0].lights = 2)                                                 \
    X(MATL, rays_for_what_does_not_shine, "near2", im->materials[1].near2 = 1)                                                 \
    X(MATL, alpha_too_small, "alpha", im->materials[1].alpha = 0.007f)                                                         \
    X(MATL, alpha_above_1, "alpha", im->materials[1].alpha = 1.5f)                                                             \
    X(MATL, alpha_of_nan, "alpha", im->materials[1].alpha = NAN)                                                               \
    X(LITE, directional_without_its_effect, "without the effect DIRECTIONAL", im->lights[0].kind = VIT_LIGHT_DIRECTIONAL)      \
    X(LITE, directional_with_a_range, "directional light with a range", im->lights[0].kind = VIT_LIGHT_DIRECTIONAL,            \
      EFFECTS(BIT(DIRECTIONAL), 0))                                                                                            \
    X(META, no_slices, "slice_count", im->scene->slice_count = 0)                                                              \
    X(META, huge_slices, "slice_count", im->scene->slice_count = 4097)                                                         \
    X(META, too_many_key_bits, "key_bits", im->scene->slice_count = 4096, im->scene->width = 7680, im->scene->height = 4320,   \
      im->scene->tile = 8)                                                                                                     \
    X(META, wrong_tiles, "tiles_x", ADD(tiles_x, 1))                                                                           \
    X(META, wrong_samples, "samples", ADD(samples, 64))                                                                        \
    X(META, wrong_photons, "photons", ADD(photons, 1))                                                                         \
    X(META, wrong_key_bits, "key_bits", ADD(key_bits, 1))                                                                      \
    X(META, wrong_key_bits_of_z, "key_bits_z", ADD(key_bits_z, 1))                                                             \
    X(META, wrong_levels, "levels", ADD(levels, 1))                                                                            \
    X(META, wrong_mask_words, "mask_words", im->scene->mask_words = 0xffffffff)                                                \
    X(META, wrong_level_first, "level_first", im->scene->level_first[1] = 0)                                                   \
    X(META, unused_level_first, "level_first", im->scene->level_first[6] = 1)                                                  \
    X(META, fps_of_0, "fps", im->scene->fps = 0)                                                                               \
    X(META, fps_of_nan, "fps", im->scene->fps = NAN)                                                                           \
    X(META, fps_of_1001, "fps", im->scene->fps = 1001)                                                                         \
    X(META, radius_of_0_with_photons, "radius", im->scene->radius = 0)                                                         \
    X(META, infinite_radius, "radius", im->scene->radius = INFINITY)                                                           \
    X(META, negative_flatten, "flatten", im->scene->flatten = -1)                                                              \
    X(META, negative_ray_offset, "ray_offset", im->scene->ray_offset = -1)                                                     \
    X(META, nan_box_pad, "box_pad", im->scene->box_pad = NAN)                                                                  \
    X(META, slice_near_of_0, "slice_near", im->scene->slice_near = 0)                                                          \
    X(META, negative_slice_scale, "slice_scale", im->scene->slice_scale = -2)                                                  \
    X(META, infinite_background, "background green", im->scene->background[1] = INFINITY)                                      \
    X(META, unknown_effect, "unknown effects 0x8000000000000000", EFFECTS((vit_u64)1 << 63, 0))                                \
    X(META, list_and_buckets, "exclude", EFFECTS(BIT(BUCKETS), 0))                                                             \
    X(META, neither_list_nor_buckets, "without LIST or BUCKETS", EFFECTS(0, BIT(LIST)))                                        \
    X(META, photons_without_indirect_light, "PHOTONS without INDIRECT", EFFECTS(0, BIT(INDIRECT)))                             \
    X(META, indirect_light_without_a_maker, "INDIRECT without what makes", EFFECTS(0, vit_effects_upon(BIT(PHOTONS))),         \
      im->scene->paths = im->scene->baked = im->scene->cells = 0, vit_pack_derive(im->scene, NULL))                            \
    X(META, sparse_samples_without_photons, "SPARSE without PHOTONS",                                                          \
      EFFECTS(BIT(SPARSE), vit_effects_upon(BIT(PHOTONS)) & ~BIT(SPARSE)))                                                     \
    X(META, list_without_photons, "TRACED without PHOTONS", EFFECTS(0, BIT(PHOTONS)))                                          \
    X(META, raw_without_buckets, "RAW_BUCKETS without BUCKETS", EFFECTS(BIT(RAW_BUCKETS), 0))                                  \
    X(META, gloss_without_facets, "GLOSS without GGX", EFFECTS(BIT(GLOSS) | BIT(SPECULAR), 0), im->scene->gloss_rays = 8)      \
    X(META, gloss_without_rays, "0 rays of lobes contradict", EFFECTS(BIT(GLOSS) | BIT(GGX) | BIT(SPECULAR), 0))               \
    X(META, rays_of_lobes_without_gloss, "4 rays of lobes contradict", im->scene->gloss_rays = 4)                              \
    X(META, too_many_rays_of_lobes, "gloss_rays", EFFECTS(BIT(GLOSS) | BIT(GGX) | BIT(SPECULAR), 0),                           \
      im->scene->gloss_rays = 65)                                                                                              \
    X(META, facets_without_lobes, "GGX without SPECULAR", EFFECTS(BIT(GGX), BIT(SPECULAR)))                                    \
    X(META, sixteenths_without_sparse, "SPARSE_16 without SPARSE", EFFECTS(BIT(SPARSE_16), 0))                                 \
    X(META, cells_without_their_effects, "27 cells contradict", EFFECTS(0, BIT(ZONES) | BIT(AREA)))                            \
    X(META, zones_without_cells, "0 cells contradict", im->scene->cells = 0, EFFECTS(0, BIT(AREA)))                            \
    X(META, areas_without_cells, "0 cells contradict", im->scene->cells = 0, EFFECTS(0, BIT(ZONES)))                           \
    X(META, two_texture_filters, "NEAREST and TRILINEAR", EFFECTS(BIT(NEAREST) | BIT(TRILINEAR), 0))                           \
    X(META, a_grid_without_small_samples, "grid_step", im->scene->grid_step = 0.5f)                                            \
    X(META, small_samples_without_a_grid, "grid_step", EFFECTS(BIT(SMALL_SAMPLES), 0))                                         \
    X(META, a_grid_that_is_nowhere, "grid_low y", (EFFECTS(BIT(SMALL_SAMPLES), 0), im->scene->grid_low[1] = NAN))              \
    X(META, paths_without_traced, "TRACED", EFFECTS(0, BIT(TRACED)))                                                           \
    X(META, lights_without_their_effect, "SPOT without LIGHTS", EFFECTS(0, BIT(LIGHTS)))                                       \
    X(META, effect_without_lights, "0 lights", im->scene->lights = 0)                                                          \
    X(META, lights_without_any_effect, "2 lights", EFFECTS(0, 0xffffffffu | BIT(INDIRECT) | BIT(NORMAL_MAPS)),                 \
      im->scene->paths = im->scene->baked = 0, vit_pack_derive(im->scene, NULL))                                               \
    X(META, baked_photons_without_photons, "baked photons without", EFFECTS(0, vit_effects_upon(BIT(INDIRECT))),               \
      im->scene->paths = im->scene->cells = 0, vit_pack_derive(im->scene, NULL))                                               \
    X(META, no_hierarchy_nodes, "max_nodes", im->scene->max_nodes = 0)                                                         \
    X(META, huge_max_nodes, "max_nodes", im->scene->max_nodes = 0xffffffff)                                                    \
    X(META, huge_max_list, "max_list", im->scene->max_list = 0xffffffff)                                                       \
    X(META, huge_slice_first, "slice_first", im->scene->slice_first = 0xffffffff)                                              \
    X(CAMS, one_frame_more, "META counts 3 records", ADD(frames, 1))                                                           \
    X(LITE, one_light_more, "META counts 6 records", ADD(lights, 1))                                                           \
    X(GEOM, one_triangle_more, "META counts 13 records", ADD(triangles, 1))                                                    \
    X(GEOM, most_triangles, "META counts 134217728 records", im->scene->triangles = VIT_MAX_TRIANGLES)                         \
    X(BVHN, one_node_less, "META counts 4 records", im->scene->nodes--)                                                        \
    X(MATL, most_materials, "META counts 16777216 records", im->scene->materials = VIT_MATERIAL_INDEX + 1)                     \
    X(MIPS, one_mip_more, "META counts 4 records", ADD(mips, 1))                                                               \
    X(ATLS, most_texels, "META counts 2147483647 records", im->scene->texels = 0x7fffffff)                                     \
    X(CELL, one_cell_less, "META counts 26 records", im->scene->cells--)                                                       \
    X(PHOT, one_photon_more, "META counts 5 records", ADD(baked, 1), ADD(photons, 1))

#define RECORD_FAULTS(X)                                                                                                       \
    X(CAMS, eye_is_nan, "camera 1: a vector is not finite", im->cameras[1].eye[2] = NAN)                                       \
    X(CAMS, right_is_infinite, "camera 0: a vector is not finite", im->cameras[0].right[0] = -INFINITY)                        \
    X(CAMS, forward_too_long, "forward is not a unit", im->cameras[1].forward[2] = -1.002f)                                    \
    X(CAMS, forward_is_nan, "forward is not a unit", im->cameras[1].forward[0] = NAN)                                          \
    X(META, radius_too_small_to_square, "radius", im->scene->radius = 1e-20f)                                                  \
    X(META, background_near_the_largest_float, "background", im->scene->background[1] = 1e38f)                                 \
    X(CAMS, exposure_near_the_largest_float, "exposure", im->cameras[0].exposure = 1e38f)                                      \
    X(LITE, intensity_near_the_largest_float, "intensity", im->lights[1].intensity[2] = 1e38f)                                 \
    X(LITE, photons_that_would_be_infinite, "power over the square", im->scene->radius = 1e-14f, bright(im))                   \
    X(MATL, emission_near_the_largest_float, "emission", im->materials[0].emission[0] = 1e38f)                                 \
    X(CAMS, light_that_is_infinite_in_a_small_scene, "frame 0: light could be", im->scene->ray_offset = 1e-6f,                 \
      im->lights[0].intensity[1] = VIT_MAX_INTENSITY, im->cameras[0].exposure = VIT_MAX_EXPOSURE)                              \
    X(CAMS, photons_that_are_infinite_once_exposed, "frame 1: light could be", im->photons[0].power[2] = VIT_MAX_PHOTON,       \
      im->cameras[1].exposure = VIT_MAX_EXPOSURE)                                                                              \
    X(CAMS, area_light_that_is_infinite_in_a_small_scene, "light could be", im->scene->ray_offset = 1e-8f,                     \
      im->emitters[0].power[0] = VIT_MAX_INTENSITY, im->emitters[0].radius2 = FLT_MIN,                                         \
      im->cameras[0].exposure = VIT_MAX_EXPOSURE)                                                                              \
    X(META, lights_at_no_least_distance, "its square vanishes", im->scene->ray_offset = 0)                                     \
    X(META, lights_at_a_vanishing_distance, "its square vanishes", im->scene->ray_offset = 1e-19f)                             \
    X(PHOT, power_near_the_largest_float, "power", im->photons[0].power[1] = 1e38f)                                            \
    X(CAMS, negative_exposure, "exposure", im->cameras[0].exposure = -1)                                                       \
    X(CAMS, padding_in_use, "padding", im->cameras[1].pad3 = 1)                                                                \
    X(LITE, unknown_kind, "frame 0, light 0: unknown kind", im->lights[0].kind = 3)                                            \
    X(LITE, unknown_falloff, "frame 1, light 1: unknown falloff", im->lights[3].falloff = 2)                                   \
    X(LITE, position_is_nan, "frame 1, light 0: position", im->lights[2].position[1] = NAN)                                    \
    X(LITE, spot_without_direction, "not a unit vector", im->lights[0].direction[1] = 0)                                       \
    X(LITE, cosine_above_1, "cos_outer", im->lights[0].cos_outer = 1.5f)                                                       \
    X(LITE, spot_scale_is_infinite, "spot_scale", im->lights[0].spot_scale = INFINITY)                                         \
    X(LITE, negative_intensity, "intensity", im->lights[1].intensity[2] = -1)                                                  \
    X(LITE, negative_range, "inv_range2", im->lights[1].inv_range2 = -1)                                                       \
    X(LITE, padding_in_use, "padding", im->lights[1].pad[2] = 1)                                                               \
    X(LITE, spot_without_its_effect, "without the effect SPOT", EFFECTS(0, BIT(SPOT)))                                         \
    X(LITE, range_without_its_effect, "without the effect RANGE", EFFECTS(0, BIT(RANGE)))                                      \
    X(LITE, paths_beyond_the_last, "beyond", im->lights[1].path_first = 1)                                                     \
    X(LITE, paths_of_half_a_packet, "multiples of 16", im->lights[0].path_count = 8)                                           \
    X(LITE, path_sum_that_wraps, "beyond", im->lights[1].path_first = 0xfffffff0, im->lights[1].path_count = 32)               \
    X(LITE, paths_change_with_the_frame, "frame 1, light 1: paths differ", im->lights[3].path_count = 16)                      \
    X(LITE, paths_shared, "lights 0 and 1 share", im->lights[0].path_count = im->lights[2].path_count = 16)                    \
    X(LITE, paths_of_no_light, "16 photon paths", im->lights[1].path_count = im->lights[3].path_count = 16)                    \
    X(GEOM, vertex_is_nan, "triangle 11: vertex is not finite", im->triangles[11].v2[2] = NAN)                                 \
    X(GEOM, vertex_is_infinite, "triangle 0: vertex is not finite", im->triangles[0].v0[0] = INFINITY)                         \
    X(GEOM, normal_is_nan, "triangle 3: normal is not finite", im->triangles[3].ny = NAN)                                      \
    X(GEOM, normal_is_0, "triangle 0: normal is 0", im->triangles[0].nx = im->triangles[0].ny = im->triangles[0].nz = 0)       \
    X(ATTR, unknown_material, "triangle 2: material 2 of 2", im->attributes[2].material = 2)                                   \
    X(ATTR, huge_material, "material 16777215 of 2", im->attributes[0].material = 0xffffff)                                    \
    X(ATTR, unknown_flag, "unknown flags", im->attributes[0].material |= 0x10000000)                                           \
    X(ATTR, uv_is_nan, "triangle 11: a texture coordinate", im->attributes[11].uv[2][1] = NAN)                                 \
    X(ATTR, first_uv_is_infinite, "triangle 1: a texture coordinate", im->attributes[1].uv[0][0] = INFINITY)                   \
    X(MATL, albedo_above_1, "material 1: albedo", im->materials[1].albedo[2] = 1.5f)                                           \
    X(MATL, albedo_is_nan, "material 0: albedo", im->materials[0].albedo[0] = NAN)                                             \
    X(MATL, negative_emission, "emission", im->materials[0].emission[0] = -1)                                                  \
    X(MATL, infinite_emission, "emission", im->materials[0].emission[0] = INFINITY)                                            \
    X(MATL, unknown_texture, "texture 1 of 1", im->materials[1].texture = 1)                                                   \
    X(MATL, cutout_of_2, "cutout must be 0 or 1", im->materials[1].cutout = 2)                                                 \
    X(MATL, cut_out_by_no_texture, "cut out by no texture", im->materials[0].cutout = 1)                                       \
    X(MAPS, map_of_no_texture, "material 0: texture 1 of 1", im->maps[0].normal = 1)                                           \
    X(MAPS, scale_of_nan, "material 1: normal_scale", im->maps[1].normal_scale = NAN)                                          \
    X(MAPS, scale_too_large, "normal_scale must be in -1000..1000", im->maps[0].normal_scale = 1001)                           \
    X(MAPS, padding_in_use, "material 1: padding", im->maps[1].pad[0] = 1)                                                     \
    X(META, normal_maps_without_textures, "effect NORMAL_MAPS without TEXTURES", EFFECTS(0, BIT(TEXTURES)))                    \
    X(TEXR, no_mip, "no mip level", im->textures[0].mip_count = 0)                                                             \
    X(TEXR, mips_beyond_the_last, "beyond the 3", im->textures[0].first_mip = 1)                                               \
    X(TEXR, mip_sum_that_wraps, "beyond the 3", im->textures[0].first_mip = 0xffffffff)                                        \
    X(TEXR, unknown_wrap, "wrap", im->textures[0].wrap_v = 3)                                                                  \
    X(MIPS, no_width, "edges must be", im->mips[2].width = 0)                                                                  \
    X(MIPS, wide_and_flat, "edges must be", im->mips[0].width = 16385, im->mips[0].height = 0)                                 \
    X(MIPS, huge_height, "edges must be", im->mips[0].height = 0xffffffff)                                                     \
    X(MIPS, no_gutter_beside, "no gutter", im->mips[0].pitch = 5)                                                              \
    X(MIPS, no_gutter_above, "mip 0: runs beyond", im->mips[0].offset -= 1)                                                    \
    X(MIPS, no_gutter_below, "mip 2: runs beyond", im->mips[2].offset += 1)                                                    \
    X(MIPS, huge_pitch, "runs beyond", im->mips[1].pitch = 0xffffffff)                                                         \
    X(MIPS, huge_offset, "runs beyond", im->mips[1].offset = 0xffffffff)                                                       \
    X(PHOT, position_is_nan, "photon 2: position", im->photons[2].position[0] = NAN)                                           \
    X(PHOT, direction_is_nan, "photon 1: position, direction", im->photons[1].direction[2] = NAN)                              \
    X(PHOT, inverse_is_infinite, "photon 0: position, direction or radius", im->photons[0].inv_radius2 = INFINITY)             \
    X(PHOT, negative_power, "power", im->photons[0].power[1] = -1)                                                             \
    X(PHOT, wrong_inverse, "inv_radius2", im->photons[1].inv_radius2 = 4.001f)                                                 \
    X(PHOT, radius_of_0, "inv_radius2", im->photons[1].radius2 = 0, im->photons[1].zone = 0)                                   \
    X(PHOT, direction_too_short, "unit vector", im->photons[0].direction[1] = -0.5f)                                           \
    X(PHOT, empty_slot_with_power, "photon 3: an empty slot has power", im->photons[3].power[2] = 1)                           \
    X(PHOT, two_zones, "photon 0: zone", im->photons[0].zone = 3)                                                              \
    X(PHOT, no_zone, "photon 1: zone", im->photons[1].zone = 0)                                                                \
    X(PHOT, empty_slot_in_a_zone, "photon 3: zone", im->photons[3].zone = 1)                                                   \
    X(PHOT, zone_without_its_effect, "photon 0: zone", EFFECTS(0, BIT(ZONES)))                                                 \
    X(SIDE, no_parts, "side 23: 0 parts", im->sides[23] = 0)                                                                   \
    X(SIDE, cell_beyond_the_last, "side 5: 1 parts from cell 27 on, of 27", im->sides[5] = 1u << VIT_SIDE_PARTS_SHIFT | 27)    \
    X(SIDE, parts_beyond_the_last, "side 0: 5 parts from cell 3 on, of 27", im->sides[0] = 5u << VIT_SIDE_PARTS_SHIFT | 3)     \
    X(SIDE, everything_at_most, "side 1: 255 parts from cell 16777215", im->sides[1] = 0xffffffff)                             \
    X(CELL, first_area_of_0, "cell 26: an area is too small", im->cells[26].word &= ~511u)                                     \
    X(CELL, second_area_too_small, "cell 0: an area", im->cells[0].word = 511u | 7u << 9 | 511u << 18)                         \
    X(CELL, third_area_too_small, "cell 3: an area", im->cells[3].word = 511u | 511u << 9 | 7u << 18)                          \
    X(GOLD, padding_in_use, "frame 1: padding", im->golds[1].pad[0] = 1)

#define TREE_FAULTS(X)                                                                                                         \
    X(BVHN, cycle, "node 4: child 1 is node 0", im->nodes[4].child1 = 0)                                                       \
    X(BVHN, node_is_its_own_child, "node 1: child 1 is node 1", im->nodes[1].child1 = 1)                                       \
    X(BVHN, child_beyond_the_last, "child 1 is node 5 of 5", im->nodes[3].child1 = 5)                                          \
    X(BVHN, huge_child, "is node 2147483647 of 5", im->nodes[0].child0 = 0x7fffffff)                                           \
    X(BVHN, node_twice, "leaf begins at triangle 0, expected 6", im->nodes[0].child1 = 1,                                      \
      copy_box(im->nodes[0].lo1, im->nodes[0].lo0))                                                                            \
    X(BVHN, node_in_no_tree, "4 nodes of 5", graft(im))                                                                        \
    X(BVHN, leaf_beyond_the_last, "leaf of triangles 11..12 of 12", im->nodes[4].child1 += 1)                                  \
    X(BVHN, huge_leaf, "leaf of triangles 268435455", im->nodes[2].child0 = 0xffffffff)                                        \
    X(BVHN, leaf_twice, "leaf begins at triangle 2, expected 4", im->nodes[2].child1 = im->nodes[2].child0)                    \
    X(BVHN, leaves_out_of_order, "leaf begins at triangle 4, expected 2", swap_children(&im->nodes[2]))                        \
    X(BVHN, triangle_in_no_leaf, "leaves hold 11 triangles of 12", im->nodes[4].child1 -= 1u << VIT_LEAF_SHIFT)                \
    X(BVHN, triangle_in_two_leaves, "does not hold triangle", im->nodes[1].child0 += 1u << VIT_LEAF_SHIFT)                     \
    X(BVHN, box_too_small, "node 4: box does not hold triangle 10",                                                            \
      im->nodes[4].lo1[2] = nextafterf(im->nodes[4].lo1[2], 2.0f))                                                             \
    X(BVHN, box_without_its_pad, "does not hold triangle 0", im->nodes[1].hi0[0] = -1)                                         \
    X(BVHN, box_leaves_its_parent, "node 2: box of child 0 leaves its parent's", im->nodes[2].hi0[0] = 1.5f)                   \
    X(BVHN, box_is_nan, "node 0: box of child 1", im->nodes[0].lo1[1] = NAN)                                                   \
    X(BVHN, box_is_infinite, "node 0: box of child 0", im->nodes[0].hi0[0] = INFINITY)                                         \
    X(BVHN, box_partly_inside_out, "node 2: box of child 1", im->nodes[2].lo1[0] = 2)                                          \
    X(BVHN, box_inside_out_in_z, "node 2: box of child 1", im->nodes[2].lo1[2] = 2)                                            \
    X(BVHN, box_inside_out_but_for_x, "node 2: box of child 1", empty_box(im->nodes[2].lo1, im->nodes[2].hi1),                 \
      im->nodes[2].lo1[0] = im->nodes[2].hi1[0])                                                                               \
    X(BVHN, inner_box_inside_out, "node 0: box of child 1", empty_box(im->nodes[0].lo1, im->nodes[0].hi1))                     \
    X(BVHN, missing_child_hides_triangles, "leaves hold 10 triangles of 12", empty_box(im->nodes[4].lo1, im->nodes[4].hi1))    \
    X(BVHN, padding_in_use, "node 4: padding", im->nodes[4].pad[1] = 1)

/* What is just inside the limits must pass: X(name, change made to `im`). */
#define LIMITS(X)                                                                                                              \
    X(fewest_hierarchy_nodes, im->scene->max_nodes = 1)                                                                        \
    X(most_hierarchy_nodes, im->scene->max_nodes = 1 << 26)                                                                    \
    X(most_list_entries, im->scene->max_list = 1 << 28)                                                                        \
    X(farthest_slice, im->scene->slice_first = 1 << 24)                                                                        \
    X(fps_of_1000, im->scene->fps = 1000)                                                                                      \
    X(no_exposure, im->cameras[0].exposure = 0)                                                                                \
    X(forward_a_little_short, im->cameras[0].forward[2] = -0.9995f)                                                            \
    X(dark_light, im->lights[0].intensity[0] = 0)                                                                              \
    X(unlimited_light_without_the_effect, im->lights[0].inv_range2 = im->lights[2].inv_range2 = 0, EFFECTS(0, BIT(RANGE)))     \
    X(paths_side_by_side, share_paths(im, 0, 16))                                                                              \
    X(paths_in_reverse, share_paths(im, 16, 0))                                                                                \
    X(no_paths_amid_paths, im->lights[0].path_first = im->lights[2].path_first = 16)                                           \
    X(all_flags, im->attributes[0].material |= VIT_SIDE_DARK_FRONT | VIT_SIDE_DARK_BACK | VIT_TRIANGLE_SMOOTH)                 \
    X(cut_out_by_a_texture, im->materials[1].cutout = 1, EFFECTS(BIT(CUTOUT), 0))                                              \
    X(most_emission, im->materials[0].emission[0] = VIT_MAX_RADIANCE)                                                          \
    X(most_intensity, im->lights[0].intensity[0] = VIT_MAX_INTENSITY)                                                          \
    X(most_exposure, im->cameras[0].exposure = VIT_MAX_EXPOSURE)                                                               \
    X(most_light_at_all, im->lights[0].intensity[0] = VIT_MAX_INTENSITY, im->cameras[0].exposure = VIT_MAX_EXPOSURE,           \
      im->materials[0].exponent = VIT_MAX_EXPONENT)                                                                            \
    X(least_radius, im->scene->radius = VIT_MIN_RADIUS, dim(im))                                                               \
    X(mirrored_texture, im->textures[0].wrap_u = im->textures[0].wrap_v = VIT_WRAP_MIRROR)                                     \
    X(parts_up_to_the_last_cell, im->sides[0] = 5u << VIT_SIDE_PARTS_SHIFT | 2)                                                \
    X(a_cell_that_accepts_nothing, im->cells[0].accept = 0)                                                                    \
    X(areas_without_zones, EFFECTS(0, BIT(ZONES)), clear_zones(im))                                                            \
    X(zones_without_areas, EFFECTS(0, BIT(AREA)))                                                                              \
    X(dark_photon, im->photons[0].power[0] = 0)                                                                                \
    X(inverse_a_little_off, im->photons[0].inv_radius2 = 4.0003f)                                                              \
    X(boxes_larger_than_needed, im->nodes[0].lo0[0] = -100)                                                                    \
    X(no_golden_records, memset(im->golds, 0, FIXTURE_FRAMES * sizeof *im->golds))

#define FAULTS(X) CONTAINER_FAULTS(X) META_FAULTS(X) RECORD_FAULTS(X) TREE_FAULTS(X)

static void swap_entries(image *im, int a, int b) {
    vit_pack_entry e = im->table[a];
    im->table[a] = im->table[b];
    im->table[b] = e;
}

static void poke(image *im, uint64_t at) {
    ((unsigned char *)im->bytes)[at] = 1;
}

/* The bytes that leave the section become gap, so they must be 0 for the next check to be reached. */
static void shorten(image *im, int i, uint64_t by) {
    im->table[i].size -= by;
    memset((char *)section(im, i) + im->table[i].size, 0, (size_t)by);
}

/* hi follows lo in vit_bvh_node. */
static void copy_box(float *to, const float *from) {
    memcpy(to, from, 6 * sizeof(float));
}

static void empty_box(float *lo, float *hi) {
    for (int k = 0; k < 3; k++) {
        lo[k] = FLT_MAX;
        hi[k] = -FLT_MAX;
    }
}

static void bright(image *im) {
    for (int i = 0; i < FIXTURE_FRAMES * FIXTURE_LIGHTS; i++)
        im->lights[i].intensity[0] = 1e6f;
}

static void dim(image *im) {
    for (int i = 0; i < FIXTURE_FRAMES * FIXTURE_LIGHTS; i++)
        memset(im->lights[i].intensity, 0, sizeof im->lights[i].intensity);
}

static void clear_zones(image *im) {
    for (int i = 0; i < FIXTURE_BAKED; i++)
        im->photons[i].zone = 0;
}

static void swap_children(vit_bvh_node *n) {
    vit_u32 child = n->child0;
    n->child0 = n->child1;
    n->child1 = child;
}

/* Half of the 32 paths for each light. */
static void share_paths(image *im, vit_u32 first0, vit_u32 first1) {
    for (int i = 0; i < FIXTURE_FRAMES * FIXTURE_LIGHTS; i++) {
        im->lights[i].path_first = i % 2 ? first1 : first0;
        im->lights[i].path_count = 16;
    }
}

/* Node 3 gets one leaf of the triangles of sides 4 and 5, so that nothing leads to node 4. */
static void graft(image *im) {
    vit_bvh_node *n = &im->nodes[3];
    n->child1 = VIT_LEAF_BIT | 3u << VIT_LEAF_SHIFT | 8;
}

#define FORGED_KIND FIXTURE_PHOTONS
#define FORGED_NAME "forged packs"
#define FORGED_TESTS
#include "forged_main.h"
