/* passes.c: the frame as a table, and the table of its buffers. Everything that needs a list of passes or buffers walks these:
 * building kernels, allocating, enqueueing, timing, tracing, --explain. */
#ifndef VIT_PASSES_H
#define VIT_PASSES_H

#include "vitrine.h"
#include "vitrine_pack.h"

#define ON(macro) VIT_BIT(macro)
/* Not effects of the pack: */
#define ON_DOTS ((uint64_t)1 << 63)      /* the view `photons` */
#define ON_WORK ((uint64_t)1 << 62)      /* vit_open_info.count_work */
#define ON_DENSE ((uint64_t)1 << 61)     /* indirect light is estimated at every sample: estimate_all */
#define ON_FILM ((uint64_t)1 << 60)      /* a pixel has more than one sample: copies for anti-aliasing, layers for glass */
#define ON_CHAINS ((uint64_t)1 << 59)    /* mirrors or glass: view rays go on from hits */
#define ON_REACH ((uint64_t)1 << 58)     /* vit_open_info.record_reach */
#define ON_SKY_RAYS ((uint64_t)1 << 57)  /* rays find the sky's light: all of it, or with a lightmap what lobes reflect, */
#define ON_AREA_RAYS ((uint64_t)1 << 56) /* and that of area lights */
#define ON_CELLS ((uint64_t)1 << 55)     /* receivers lie on surfaces, and cells of triangles' sides look them up */
#define ALWAYS ((uint64_t)0)
#define ON_RECEIVERS (ON(BASIS) | ON(RADIOSITY)) /* baked places at which indirect light is known */

/* What the sizes of buffers and passes follow from, besides the scene. */
typedef struct vit_launch {
    uint64_t effects; /* the pack's, and ON_DOTS... */
    uint32_t rounds;  /* times that the passes of a frame's view samples run: copies * layers */
    uint32_t layers;  /* view samples of a ray: 2 where glass also mirrors, else 1 */
    uint32_t max_nodes, max_list;
    vit_format format;
    vit_view view;
    uint32_t pitch;        /* of the framebuffer: pixels from one row to the next, at least the width */
    uint32_t lanes, group; /* samples per work-item, work-items a work-group of flat passes */
    uint32_t scan_group;   /* work-items of single-group passes */
    uint32_t splat_group;  /* work-items a node in splat passes */
    uint32_t run;          /* samples in a row a work-item of cluster passes; a multiple of 16 */
    uint32_t chunks;       /* work-groups that share the root's list of photons */
} vit_launch;

#define VIT_CHUNKS 64u /* chunks of the root's list, at most */
#define VIT_BUCKETS_OF(l) ((l)->effects & ON(RAW_BUCKETS) ? 54u : 8u)

/* Samples of which every one of so many is estimated: kernels/sparse.cl. */
#define VIT_COARSE(s, l) ((uint64_t)(s)->samples / ((l)->effects & ON(SPARSE_16) ? 16 : 4))

/* Bytes of a view sample's position. */
#define VIT_POSITION(l) ((l)->effects & ON(SMALL_SAMPLES) ? 6u : 12u)

/* X(name, when: any of these effects, or ALWAYS; section that fills it or NONE; bytes, an expression over scene s and limits
 * l). hit_triangle and hit_distance are of the end of the view ray's chain, where there are mirrors or glass: the distance is
 * the last ray's, that of the whole way is in `rays` (chain_length() of kernels/specular.clh). */
#define VIT_BUFFERS(X)                                                                                                         \
    X(scene, ALWAYS, META, sizeof(vit_scene))                                                                                  \
    X(cameras, ALWAYS, CAMS, s->frames * sizeof(vit_camera))                                                                   \
    X(lights, ON(LIGHTS), LITE, (uint64_t)s->frames * s->lights * sizeof(vit_light))                                           \
    X(triangles, ALWAYS, GEOM, s->triangles * sizeof(vit_triangle))                                                            \
    X(attributes, ALWAYS, ATTR, s->triangles * sizeof(vit_attributes))                                                         \
    X(bvh, ALWAYS, BVHN, s->nodes * sizeof(vit_bvh_node))                                                                      \
    X(materials, ALWAYS, MATL, s->materials * sizeof(vit_material))                                                            \
    X(maps, ON(NORMAL_MAPS), MAPS, s->materials * sizeof(vit_maps))                                                            \
    X(textures, ON(TEXTURES) | ON(CUTOUT), TEXR, s->textures * sizeof(vit_texture))                                            \
    X(mips, ON(TEXTURES) | ON(CUTOUT), MIPS, s->mips * sizeof(vit_mip))                                                        \
    X(texels, ON(TEXTURES) | ON(CUTOUT), ATLS, (uint64_t)s->texels * 4)                                                        \
    X(sides, ON(ZONES) | ON(AREA) | ON_CELLS, SIDE, s->triangles * (uint64_t)8)                                                \
    X(cells, ON(ZONES) | ON(AREA), CELL, s->cells * sizeof(vit_cell))                                                          \
    X(receiver_cells, ON_RECEIVERS, RCEL, s->receiver_cells * sizeof(vit_receiver_cell))                                       \
    X(receiver_splits, ON_CELLS, RSPL, s->receiver_splits * sizeof(vit_receiver_split))                                        \
    X(receivers, ON_RECEIVERS, RECV, s->receivers * sizeof(vit_receiver))                                                      \
    X(basis_groups, ON(RELIGHT), BGRP, (uint64_t)s->receivers / VIT_BASIS_GROUP * s->basis_lights * sizeof(vit_basis_group))   \
    X(basis_words, ON(RELIGHT), BWRD, (uint64_t)s->basis_words * 4)                                                            \
    X(basis_coefficients, ON(RELIGHT), BCOE, s->basis_coefficients * sizeof(vit_basis_coefficient))                            \
    X(basis_frames, ON(RELIGHT), BFRM, (uint64_t)s->frames * s->basis_lights * sizeof(vit_basis_frame))                        \
    X(patches, ON(RADIOSITY), PATC, s->patches * sizeof(vit_patch))                                                            \
    X(patch_points, ON(RADIOSITY), PPNT, s->patch_points * sizeof(vit_patch_point))                                            \
    X(gather_rows, ON(RADIOSITY), GROW, s->receivers * sizeof(vit_gather_row))                                                 \
    X(gather_words, ON(RADIOSITY), GATH, (uint64_t)s->gather_words * 4)                                                        \
    X(looked_up, ON(RADIOSITY), LOOK, (uint64_t)VIT_LOOKED_SETS(s) * (s->receivers / 32) * 4)                                  \
    X(transfer, ON(TRANSFER), XFER, (uint64_t)s->transfer_words * 4)                                                           \
    X(cache, ON(OCCLUSION), CACH, s->cache_cells * sizeof(vit_cache_cell))                                                     \
    X(map_sides, ON(LIGHTMAP), MSID, s->triangles *(uint64_t)8)                                                                \
    X(map_cells, ON(LIGHTMAP), MCEL, s->map_cells * sizeof(vit_receiver_cell))                                                 \
    X(map_splits, ON(LIGHTMAP), MSPL, s->map_splits * sizeof(vit_receiver_split))                                              \
    X(map_receivers, ON(LIGHTMAP), MREC, s->map_receivers * sizeof(vit_receiver))                                              \
    X(area_lights, ON_SKY_RAYS | ON_AREA_RAYS | ON(LIGHTMAP_RAYS), EMIT,                                                       \
      VIT_PATTERNS * ((uint64_t)s->area_samples + s->sky_samples) * sizeof(vit_light_sample))                                  \
    X(sky, ON(SKY_IMAGE), SKYT, (s->sky_size + (uint64_t)2) * (s->sky_size + 2) * sizeof(vit_sky_texel))                       \
    X(hit_triangle, ALWAYS, NONE, (uint64_t)s->samples * 4)                                                                    \
    X(hit_distance, ALWAYS, NONE, (uint64_t)s->samples * 4)                                                                    \
    X(position, ALWAYS, NONE, (uint64_t)s->samples *VIT_POSITION(l))                                                           \
    X(normal, ALWAYS, NONE, (uint64_t)s->samples * 4)                                                                          \
    X(albedo, ALWAYS, NONE, (uint64_t)s->samples * 4)                                                                          \
    X(direct, ALWAYS, NONE, (uint64_t)s->samples * 12)                                                                         \
    X(cache_counts, ON(LIVE_CACHE), NONE, (uint64_t)s->cache_cells *VIT_CACHE_POINTS * 4)                                      \
    X(cache_frame, ON(LIVE_CACHE), NONE, (uint64_t)s->cache_cells *VIT_CACHE_POINTS * 8)                                       \
    X(specular, ON(SPECULAR), NONE, (uint64_t)s->samples * 8)                                                                  \
    X(skylight, ON_SKY_RAYS, NONE, (uint64_t)s->samples *(l->effects & ON(SPECULAR) ? 24 : 12))                                \
    X(gloss, ON(GLOSS), NONE, (uint64_t)s->samples * 24)                                                                       \
    X(by_rays, ON(LIGHTMAP_RAYS), NONE, (uint64_t)s->samples * 4)                                                              \
    X(rays, ON_CHAINS, NONE, (uint64_t)s->samples * 40)                                                                        \
    X(split, ON(GLASS), NONE, s->samples / 16 * 4)                                                                             \
    X(active, ON_FILM, NONE, s->samples / 16 * 4)                                                                              \
    X(edges, ON(ANTIALIAS), NONE, s->samples / 16 * 4)                                                                         \
    X(shown, ON(ANTIALIAS), NONE, (uint64_t)s->samples * 4)                                                                    \
    X(film, ON_FILM, NONE, (uint64_t)s->samples * 12)                                                                          \
    X(accept, ON(ZONES), NONE, (uint64_t)s->samples * 4)                                                                       \
    X(inverse_area, ON(AREA), NONE, (uint64_t)s->samples * 4)                                                                  \
    X(photons, ON(PHOTONS), NONE, (uint64_t)s->photons * sizeof(vit_photon))                                                   \
    X(masks, ON(PHOTONS), NONE, (uint64_t)s->mask_words * 4)                                                                   \
    X(prefix, ON(PHOTONS), NONE, (uint64_t)s->mask_words * 4)                                                                  \
    X(keys, ON(PHOTONS), NONE, (uint64_t)s->samples * 4)                                                                       \
    X(node_first, ON(PHOTONS), NONE, (uint64_t)l->max_nodes * 4)                                                               \
    X(node_count, ON(PHOTONS), NONE, (uint64_t)l->max_nodes * 4)                                                               \
    X(bounds, ON(PHOTONS), NONE, (uint64_t)l->max_nodes *(l->effects & ON(ZONES) ? 52 : 48))                                   \
    X(list_first, ON(PHOTONS), NONE, (uint64_t)l->max_nodes * 4)                                                               \
    X(list_count, ON(PHOTONS), NONE, (uint64_t)l->max_nodes * 4)                                                               \
    X(cursor, ON(PHOTONS), NONE, (uint64_t)l->max_nodes * 4)                                                                   \
    X(chunk_count, ON(PHOTONS), NONE, VIT_CHUNKS * 32 * 4)                                                                     \
    X(list, ON(PHOTONS), NONE, (uint64_t)l->max_list * 4)                                                                      \
    X(buckets, ON(BUCKETS), NONE, (uint64_t)l->max_nodes *VIT_BUCKETS_OF(l) * 16)                                              \
    X(relit, ON(RELIGHT) | ON(RADIOSITY), NONE, (uint64_t)s->receivers * 16)                                                   \
    X(radiosity, ON(RADIOSITY), NONE, ((uint64_t)VIT_PATCH_STRIDE(s) + s->patch_points) * 16)                                  \
    X(projected, ON(LOW_RANK), NONE, (uint64_t)VIT_TRANSFER_COLUMN_CHUNKS(s) * s->transfer_rank * 12)                          \
    X(mixed, ON(LOW_RANK), NONE, (uint64_t)s->transfer_rank * 12)                                                              \
    X(sums, ON(TRANSFER), NONE, (uint64_t)s->transfer_sums *VIT_PATCH_STRIDE(s) * 12)                                          \
    X(reflected, ON(TRANSFER), NONE, (uint64_t)VIT_PATCH_STRIDE(s) * 12)                                                       \
    X(coarse, ON(SPARSE), NONE, VIT_COARSE(s, l) * 36)                                                                         \
    X(flags, ON(SPARSE), NONE, s->samples / 16 * 4)                                                                            \
    X(indirect, ON(INDIRECT), NONE, (uint64_t)s->samples * 12)                                                                 \
    X(dots, ON_DOTS, NONE, (uint64_t)s->width * s->height * 4)                                                                 \
    X(counters, ALWAYS, NONE, 3 * VIT_COUNTER_COUNT * 4)                                                                       \
    X(faults, ON(PHOTONS), NONE, VIT_FAULT_WORDS * 4)                                                                          \
    X(work, ON_WORK, NONE, VIT_MAX_PASSES *VIT_WORK_COUNT * 8)                                                                 \
    X(reached, ON_REACH, NONE, (uint64_t)VIT_REACHED_WORDS(s) * 4)                                                             \
    X(framebuffer, ALWAYS, NONE, (((uint64_t)s->height - 1) * l->pitch + s->width) * vit_format_bytes(l->format))

#define VIT_SECTION_NONE VIT_SECTION_COUNT
#define B_FIRST_WRITTEN B_hit_triangle /* those before it are sections */
/* Chunks of columns of the transfer matrix. */
#define VIT_TRANSFER_COLUMN_CHUNKS(s) ((VIT_PATCH_STRIDE(s) + VIT_TRANSFER_CHUNK - 1) / VIT_TRANSFER_CHUNK)

typedef enum vit_buffer {
#define X(name, when, section, bytes) B_##name,
    VIT_BUFFERS(X)
#undef X
        B_COUNT,
    /* Arguments by value, in the same list of a pass's arguments. */
    V_frame = B_COUNT,
    V_round,
    V_layers,
    V_level,
    V_run,
    V_chunks,
    V_max_nodes,
    V_max_list,
    V_pitch,
    V_pass, /* row of vit_passes */
    V_END
} vit_buffer;

/* Work-items of a pass. */
typedef enum vit_extent {
    PER_SAMPLE, /* samples / lanes */
    PER_BUNDLE, /* samples / (lanes * VIT_BUNDLE_OF(lanes)) */
    PER_COARSE, /* with one lane coarse samples, else tiles */
    PER_REST,   /* with one lane samples, else tiles */
    PER_BLOCK,  /* samples / 16 */
    PER_RUN,    /* ceil(samples / run) */
    PER_PATH,   /* paths / lanes */
    PER_PHOTON,
    PER_RELIT,      /* receivers / (2 * lanes) */
    PER_RECEIVER,   /* receivers */
    PER_POINT,      /* patch_points / lanes */
    PER_PATCH,      /* VIT_PATCH_STRIDE */
    PER_COLUMN,     /* VIT_PATCH_STRIDE + patch_points */
    PER_RANK,       /* transfer_rank / lanes, of each chunk of columns */
    PER_MIX,        /* 3 * transfer_rank / lanes */
    PER_SUM,        /* VIT_PATCH_STRIDE / lanes, of each of transfer_sums */
    PER_ROW,        /* VIT_PATCH_STRIDE / lanes */
    PER_CACHE_CELL, /* cache_cells */
    PER_MASK_WORD,
    PER_LEVEL_NODE, /* nodes of the level, at most */
    PER_PIXEL,
    GROUP_PER_LEVEL_NODE, /* a work-group of splat_group for each node of the level; the root has `chunks` */
    ONE_GROUP,            /* one work-group of scan_group */
} vit_extent;

/* For which levels of the hierarchy a pass runs. Neighbouring rows that are not ONCE are repeated together, level by level. */
typedef enum vit_repeat {
    ONCE,
    UPWARD, /* last level to first */
    LISTED, /* first to last; with buckets all but the last, whose photons go into buckets instead */
    LAST,   /* the last level only */
} vit_repeat;

/* In which rounds of a frame a pass runs. A round takes one view sample a pixel: copy round / layers, layer round % layers. */
typedef enum vit_rounds {
    EACH,
    FIRST,       /* the first only */
    SECOND_COPY, /* the first of the second copy */
    AT_END,      /* the last only */
} vit_rounds;

#define VIT_MAX_ARGS 40

typedef struct vit_pass {
    const char *name; /* also the kernel's */
    uint64_t when;    /* all of these effects; ALWAYS */
    vit_rounds rounds;
    vit_extent extent;
    vit_repeat repeat;
    uint64_t writes;            /* bits of vit_buffer, B_FIRST_WRITTEN's the lowest */
    uint8_t args[VIT_MAX_ARGS]; /* vit_buffer, up to V_END; a buffer that is not called for is passed as NULL, but
                                 * WORK at the end is no parameter of kernels that do not count */
} vit_pass;

extern const vit_pass vit_passes[];
extern const uint32_t vit_pass_count;
extern const char *const vit_buffer_names[B_COUNT];
extern const vit_section vit_buffer_sections[B_COUNT];

/* Does a pass run in this round? */
int vit_pass_in_round(const vit_pass *p, const vit_launch *l, uint32_t round);
/* Rounds that a pass runs in. */
uint32_t vit_pass_rounds(const vit_pass *p, const vit_launch *l);

/* Does the frame need the pass, the buffer? */
int vit_pass_called(uint32_t pass, const vit_launch *l);
int vit_buffer_called(uint32_t buffer, const vit_launch *l);
uint64_t vit_buffer_bytes(uint32_t buffer, const vit_scene *s, const vit_launch *l);
/* Bytes of the words that the buffer is made of: 4, or 2 where it holds half words. */
uint32_t vit_buffer_word(uint32_t buffer, const vit_launch *l);
/* Name of the first of these effects of the pack; NULL: none. */
const char *vit_effect_first(uint64_t effects);
/* Name of an effect that calls for the buffer: "always", or of the first. */
const char *vit_buffer_effect(uint32_t buffer, const vit_launch *l);
/* Bytes of a pixel, and of the words that it is made of. */
uint32_t vit_format_bytes(vit_format format);
uint32_t vit_format_word(vit_format format);
/* Bytes of a row of pixels, and from one row of the framebuffer to the next. */
size_t vit_row_bytes(const vit_scene *s, const vit_launch *l);
size_t vit_pitch_bytes(const vit_launch *l);
/* Light that the view shows: VIT_SHOWS_DIRECT, VIT_SHOWS_INDIRECT. */
int vit_view_light(vit_view view);

/* Rows, as bits, whose results later frames find in buffers of the effect live-cache: what fills them, and what that reads, in
 * the first round. */
uint64_t vit_passes_of_history(const vit_launch *l);
/* Is the buffer that effect's alone? What such buffers hold is history. */
int vit_buffer_of_history(uint32_t buffer);

/* Work-items a work-group, and in all, of a pass at a level. */
void vit_pass_size(const vit_pass *p, const vit_scene *s, const vit_launch *l, uint32_t level, size_t *local, size_t *global);
uint32_t vit_pass_chunks(const vit_pass *p, const vit_launch *l, uint32_t level);
int vit_pass_at_level(const vit_pass *p, const vit_scene *s, const vit_launch *l, uint32_t level);

#endif
