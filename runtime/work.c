#include "work.h"
#include <string.h>

/* Formulas of bytes, a row a pass: X(pass, bytes). The model, which knows no caches, lanes, groups or chunks:
 *  - planes of samples, masks and records that a pass walks over count whole, padding and empty slots included;
 *  - records that are looked up count once a lookup: triangle, attributes and material at a hit, four texels a texture lookup,
 *    index and 28 bytes of a photon a test against a node, index and photon (or bucket) an evaluation, side, cell and its
 *    receivers a hit; a vector's number, of two bytes, a receiver;
 *  - a sample looks for near area lights among the points of all sets (kernels/direct.cl, lit_near);
 *  - words of receivers' rows, with the records of those that are looked up, are added up on the device;
 *  - traversal of the BVH counts nothing: its order is the packets' own. Nor do counters, the bits that samples set, the chunks
 *    of the root's list, the pixels of dots.
 * In scope: scene s, limits l, the pass's counts w, and the sizes z. Change what a pass reads or writes, and change its row. */
#define PASS_BYTES(X)                                                                                                          \
    X(find_edges, 4 * z->samples + z->samples / 4)                                                                             \
    X(activate, z->activate *(z->samples / 16))                                                                                \
    X(chains, (4 + 4 + 4 + 4 + 40) * z->samples + HITS)                                                                        \
    X(visibility, (4 + 4) * z->samples)                                                                                        \
    X(samples, (4 + 4 + z->position + 4 + 4 + 12 + z->baked + z->end + z->specular + z->indirect + z->by_rays) * z->samples +  \
                   (z->cell + z->received + z->mapped) * w[VIT_WORK_surface_points] + HITS)                                    \
    X(direct_light, LIT * z->samples + z->lights)                                                                              \
    X(lightmap_rays, (LIT + z->by_rays) * z->samples + sizeof(vit_light_sample) * w[VIT_WORK_shadow_rays])                     \
    X(area_light, (LIT + sizeof(vit_light_sample) * (VIT_PATTERNS + 1) * z->area_samples) * z->samples)                        \
    X(sky_light,                                                                                                               \
      (4 + z->position + 4 + z->face + z->view + z->specular / 2 + z->skylight + sizeof(vit_light_sample) * z->sky_samples) *  \
          z->samples)                                                                                                          \
    X(sky_filter, (z->position + 4 + 4 + z->specular / 2 + z->skylight + 12 + 12) * z->samples)                                \
    X(gloss, (4 + z->position + 4 + z->face + z->view + z->specular + 24) * z->samples + z->lights +                           \
                 (z->received + z->mapped) * w[VIT_WORK_surface_points] + HITS)                                                \
    X(gloss_filter, (z->position + 4 + z->end + z->specular + 24 + 12 + 12) * z->samples)                                      \
    X(ambient_light, (4 + z->position + 4 + 4 + z->specular / 2 + 12 + 12) * z->samples + 4 * w[VIT_WORK_evaluations])         \
    X(point_light, (4 + z->position + 4 + 4 + 12) * z->samples + (4 + 4 + 12) * w[VIT_WORK_evaluations])                       \
    X(cache_sample, (4 + z->position + 4 + z->face) * z->samples + (12 + 8) * w[VIT_WORK_shadow_rays])                         \
    X(cache_merge, 8 * (2 * 8 + 2 * 4) * z->cached)                                                                            \
    X(clear_masks, 4 * z->masks)                                                                                               \
    X(photon_paths, sizeof(vit_photon) * z->traced + z->lights + z->cell * w[VIT_WORK_surface_points] + HITS)                  \
    X(cluster_keys, (4 + z->position + 4 + 4 + 4) * z->samples + 4 * z->masks)                                                 \
    X(number_nodes, (4 + 4) * z->masks)                                                                                        \
    X(make_nodes, (4 + 4) * z->masks + (4 + 4 + BOX) * z->nodes)                                                               \
    X(cluster_bounds, (4 + z->position + 4 + z->zones) * z->samples + BOX * (z->nodes - z->inner))                             \
    X(node_bounds, (4 + 4 + BOX) * z->inner + BOX * (z->nodes - 1))                                                            \
    X(splat_count, (4 + 28) * w[VIT_WORK_node_tests] + (BOX + 4) * z->listed)                                                  \
    X(splat_place, (4 + 4 + 4) * z->listed)                                                                                    \
    X(splat_write, (4 + 28) * w[VIT_WORK_node_tests] + (BOX + 4 + 4) * z->listed + 4 * z->entries)                             \
    X(splat_buckets,                                                                                                           \
      (4 + 28) * w[VIT_WORK_node_tests] + (BOX + 4 + z->bucket) * (z->nodes - z->inner) + (12 + 16 + 16) * w[VIT_WORK_pairs])  \
    X(relight, z->relit + 2 * w[VIT_WORK_evaluations])                                                                         \
    X(patch_light, (sizeof(vit_patch_point) + 16) * z->points + z->lights)                                                     \
    X(patch_mean, sizeof(vit_patch) * z->patches + (4 + 16) * z->points + 16 * z->stride)                                      \
    X(transfer_project, z->right + 16 * z->stride + z->projected)                                                              \
    X(transfer_mix, z->mix + z->projected + z->mixed)                                                                          \
    X(transfer_partial, z->coded + 16 * z->stride + z->mixed + z->sums)                                                        \
    X(transfer_sum, z->sums + 12 * z->stride)                                                                                  \
    X(patch_reflect, 12 * z->stride + (4 + 12) * z->points + 2 * 16 * (z->stride + z->points))                                 \
    X(gather_patches, z->receivers / 8 + 16 * z->receivers + 16 * w[VIT_WORK_evaluations])                                     \
    X(estimate_all, (4 + z->position + 4 + z->baked + 12) * z->samples + z->evaluation * w[VIT_WORK_evaluations])              \
    X(estimate_sparse, (4 + z->position + 4 + z->baked + 36) * z->coarse + z->evaluation * w[VIT_WORK_evaluations])            \
    X(interpolate, (4 + z->position + 4 + z->lamps + z->baked + 12) * z->samples + 36 * z->coarse + z->samples / 4)            \
    X(estimate_rest, z->samples / 4 + z->evaluation * w[VIT_WORK_evaluations])                                                 \
    X(dots_clear, 4 * z->pixels)                                                                                               \
    X(photon_dots, sizeof(vit_photon) * z->photons)                                                                            \
    X(expose, (z->shown + 12 + 12 + 4) * z->samples)                                                                           \
    X(resolve, (z->film ? 12 : z->shown) * z->samples + z->pixel * z->pixels)                                                  \
    X(account, (4 + 4 + 4) * (uint64_t)VIT_COUNTER_COUNT)

#define RECORDS (sizeof(vit_triangle) + sizeof(vit_attributes) + sizeof(vit_material))
#define HITS ((RECORDS + z->maps) * w[VIT_WORK_surface_points] + 4 * 4 * w[VIT_WORK_texture_fetches])
/* What passes of direct light read and write a sample. */
#define LIT (4 + z->position + 4 + 4 + 12 + 12 + z->face + z->view + z->specular)
#define BOX_BYTES(zones) (48 + (zones)) /* of positions and of normals, and the zones accepted */
#define BOX BOX_BYTES(z->zones)

typedef struct sizes {
    uint64_t samples, pixels, masks, photons, traced; /* numbers of records; traced: photon slots that paths fill */
    uint64_t nodes, inner, listed; /* nodes, of those that there is room for: all, with children, with a list but the root */
    uint64_t entries;              /* list entries kept */
    uint64_t lights, bucket;       /* bytes: of a frame's lights, of a cluster's buckets */
    uint64_t position;             /* bytes: of a sample's position */
    uint64_t coarse;               /* samples of the coarse grid */
    uint64_t evaluation;           /* bytes: of an evaluation; of a bucket with its part of the box */
    uint64_t corner;               /* bytes of a cluster's box that each of its eight octants takes, smoothed */
    uint64_t shown, pixel;         /* bytes: that resolve reads a sample, writes a pixel (with dots, and reads) */
    uint64_t film;                 /* 1: a pixel has several samples */
    uint64_t activate;             /* bytes a block of samples: active, edges, split */
    uint64_t face;                 /* bytes per sample: of its triangle, for the normal; 0 without smooth normals */
    uint64_t end, view, specular;  /* bytes per sample: of a chain's end, of its direction, of the lobe */
    uint64_t area_samples, sky_samples;
    uint64_t lamps;              /* bytes per sample: whether it is an area light */
    uint64_t skylight;           /* bytes per sample: of the sky's irradiance, and of what the lobe reflects of it */
    uint64_t received, indirect; /* bytes: of side, cell and receivers that a hit looks up, per sample of the light written */
    uint64_t mapped, by_rays;    /* bytes: likewise of the lightmap, and per sample whether rays find its light */
    uint64_t relit;              /* bytes: of all receivers, read and written, and of what is read of a frame's lights */
    uint64_t cached;             /* records of the cache */
    uint64_t points, patches, stride, receivers;        /* numbers of records */
    uint64_t right, mix, coded, projected, mixed, sums; /* bytes: of the transfer matrix's parts, and of what is between */
    uint64_t maps;                                      /* bytes: of a hit's maps */
    uint64_t zones, baked,
        cell; /* bytes, 0 without zones and area: zones accepted, what is baked for a sample, side and cell looked up */
} sizes;

/* What resolve reads a sample: the hit, and what the view shows. */
static uint64_t shown_bytes(const vit_launch *l) {
    const int light = vit_view_light(l->view), photons = (l->effects & ON(PHOTONS)) != 0,
              indirect = (l->effects & ON(INDIRECT)) != 0;
    switch (l->view) {
    case VIT_VIEW_final:
    case VIT_VIEW_direct:
    case VIT_VIEW_indirect:
    case VIT_VIEW_photons: /* with light that comes indirectly goes the albedo */
        return 4 + (light & VIT_SHOWS_DIRECT ? 12u : 0u) + (indirect && (light & VIT_SHOWS_INDIRECT) ? 4u + 12u : 0u);
    case VIT_VIEW_clusters: /* key, normal */
        return photons ? 4 + 4 + 4 : 4;
    case VIT_VIEW_heat: /* key; the cluster's mask, prefix and count */
        return photons ? 4 + 4 + 12 : 4;
    case VIT_VIEW_normals:
    case VIT_VIEW_depth:
    case VIT_VIEW_albedo:
        return 4 + 4;
    }
    return 0;
}

_Static_assert(VIT_WORK_COUNT <= VIT_MAX_WORKS, "vitrine.h has room for every kind of work");

static uint64_t least(uint64_t a, uint64_t b) {
    return a < b ? a : b;
}

/* Live radiosity. Of the coded matrix what is not of low rank is read once, and of that its left part. */
static void of_patches(sizes *z, const vit_scene *s) {
    const uint64_t rank = s->transfer_rank;
    z->points = s->patch_points;
    z->patches = s->patches;
    z->stride = VIT_PATCH_STRIDE(s);
    z->receivers = s->receivers;
    z->right = rank ? (rank / 2 + 1) * 4 * z->stride : 0;
    z->mix = 3 * rank * rank * 4;
    z->coded = (uint64_t)s->transfer_words * 4 - z->right - z->mix;
    z->projected = (uint64_t)VIT_TRANSFER_COLUMN_CHUNKS(s) * rank * 12;
    z->mixed = rank * 12;
    z->sums = (uint64_t)s->transfer_sums * z->stride * 12;
}

static sizes sizes_of(const vit_scene *s, const vit_launch *l, const uint32_t *c) {
    sizes z = {.samples = s->samples,
               .pixels = (uint64_t)s->width * s->height,
               .masks = s->mask_words,
               .photons = s->photons,
               .traced = s->photons - s->baked,
               .lights = s->lights * sizeof(vit_light),
               .bucket = VIT_BUCKETS_OF(l) * 16,
               .position = VIT_POSITION(l),
               .coarse = l->effects & ON(SPARSE) ? VIT_COARSE(s, l) : 0,
               .nodes = 1, /* before the first frame there is the root */
               .shown = shown_bytes(l),
               .pixel = vit_format_bytes(l->format) + (l->effects & ON_DOTS ? 4u : 0u)};
    z.film = (l->effects & ON_FILM) != 0;
    z.activate = 4 + (l->effects & ON(ANTIALIAS) ? 4u : 0u) + (l->effects & ON(GLASS) ? 4u : 0u);
    z.end = l->effects & ON_CHAINS ? 28 : 0;
    z.specular = l->effects & ON(SPECULAR) ? 8 : 0;
    z.maps = VIT_HAS_MAPS(l->effects) ? sizeof(vit_maps) : 0;
    z.face = l->effects & ON(SMOOTH) ? sizeof(vit_triangle) : 0;
    z.view = z.specular && z.end ? 12 : 0;
    z.shown += (l->effects & ON_CHAINS ? 12u : 0u) + (z.specular ? 4u : 0u);
    z.shown += l->effects & ON(GLOSS) && vit_view_light(l->view) == VIT_SHOWS_INDIRECT ? 12u : 0u;
    z.area_samples = s->area_samples;
    z.sky_samples = s->sky_samples;
    z.lamps = l->effects & ON(AREA_LIGHTS) ? 4 : 0;
    z.skylight = z.specular ? 24 : 12;
    z.zones = l->effects & ON(ZONES) ? 4 : 0;
    z.baked = z.zones + (l->effects & ON(AREA) ? 4u : 0u);
    z.indirect = l->effects & ON_CELLS ? 12 : 0;
    z.received = l->effects & ON_CELLS ? 4 + sizeof(vit_receiver_cell) + 3 * 12 : 0;
    z.mapped = l->effects & ON(LIGHTMAP) ? 4 + sizeof(vit_receiver_cell) + 3 * 12 : 0;
    z.by_rays = l->effects & ON(LIGHTMAP_RAYS) ? 4 : 0;
    z.cell = z.baked ? 4 + sizeof(vit_cell) : 0;
    z.corner = l->effects & ON(RAW_BUCKETS) ? 0 : BOX_BYTES(z.zones) / 8;
    z.relit = s->receivers * (sizeof(vit_receiver) + 16) + s->basis_lights * sizeof(vit_basis_frame) +
              s->receivers / VIT_BASIS_GROUP * s->basis_lights * sizeof(vit_basis_group);
    z.cached = s->cache_cells;
    of_patches(&z, s);
    z.evaluation = l->effects & ON(LIST) ? 4 + sizeof(vit_photon) : 16 + z.corner;
    if ((l->effects & ON(PHOTONS)) && c[VIT_COUNTER_nodes] > 0) {
        z.nodes = least(c[VIT_COUNTER_nodes], l->max_nodes);
        z.inner = least(c[VIT_COUNTER_nodes] - c[VIT_COUNTER_clusters], z.nodes);
        z.listed = (l->effects & ON(LIST) ? z.nodes : z.inner) - 1;
        z.entries = least(c[VIT_COUNTER_list], l->max_list);
    }
    return z;
}

/* Of a pass that runs in so many rounds, each over all samples and nodes. */
static sizes of_rounds(const sizes *z, uint64_t rounds) {
    sizes all = *z;
    uint64_t *each[] = {&all.samples, &all.masks,   &all.photons, &all.nodes, &all.inner,
                        &all.listed,  &all.entries, &all.lights,  &all.coarse};
    for (size_t i = 0; i < sizeof each / sizeof each[0]; i++)
        *each[i] *= rounds;
    return all;
}

static uint64_t pass_bytes(const char *name, const sizes *z, const uint64_t *w) {
#define X(pass, bytes)                                                                                                         \
    if (strcmp(name, #pass) == 0)                                                                                              \
        return bytes;
    PASS_BYTES(X)
#undef X
    return 0;
}

void vit_work_read(const uint32_t *words, const vit_scene *s, const vit_launch *l, const uint32_t *c, vit_statistics *out) {
    static const char *const names[] = {
#define X(name, same, what) #name,
        VIT_WORKS(X)
#undef X
    };
    static const int same[] = {
#define X(name, is_same, what) is_same,
        VIT_WORKS(X)
#undef X
    };
    const sizes z = sizes_of(s, l, c);
    uint32_t row = 0;
    out->work_count = VIT_WORK_COUNT;
    memcpy(out->work_names, names, sizeof names);
    memcpy(out->work_same, same, sizeof same);
    for (uint32_t p = 0; p < vit_pass_count; p++) {
        if (!vit_pass_called(p, l))
            continue;
        const uint32_t *at = words + (size_t)p * VIT_WORK_COUNT * 2;
        uint64_t *w = out->pass_work[row++];
        for (uint32_t k = 0; k < VIT_WORK_COUNT; k++)
            w[k] = (uint64_t)at[2 * k + 1] << 32 | at[2 * k];
        const sizes all = of_rounds(&z, vit_pass_rounds(&vit_passes[p], l));
        w[VIT_WORK_bytes] += pass_bytes(vit_passes[p].name, &all, w);
    }
}
