/* A small valid scene as plain arrays: a cube seen from inside, two materials, a 4 x 4 texture with its mips, a still spot
 * light whose photons are baked and a moving point light whose photons are traced, a point a set on area lights and in the sky,
 * which is a picture, zones and areas, gloss, mirror, glass, two copies, two frames. Photons and baked irradiance exclude each
 * other: fixture_make_basis() has receivers, splits and a basis for both lights in the photons' place, fixture_make_live()
 * patches in the basis'. Every float is exact in binary, so the packs have the same bytes with every compiler. */
#ifndef VIT_TESTS_PACK_FIXTURE_H
#define VIT_TESTS_PACK_FIXTURE_H

#include "pack/pack_write.h"

#include <string.h>

enum {
    FIXTURE_FRAMES = 2,
    FIXTURE_LIGHTS = 2,
    FIXTURE_TRIANGLES = 96,
    FIXTURE_TEXELS = 61,
    FIXTURE_BAKED = 4,
    FIXTURE_CELLS = 27, /* of zones, or of receivers */
    FIXTURE_GROUPS = 2,
    FIXTURE_RECEIVERS = FIXTURE_GROUPS * VIT_BASIS_GROUP,
    FIXTURE_SPLITS = 2,
    FIXTURE_MAP_CELLS = 30,
    FIXTURE_MAP_RECEIVERS = 40,
    FIXTURE_WORDS = VIT_BASIS_RANK * VIT_BASIS_GROUP / 2,
    FIXTURE_KNOTS = 3, /* of the second light; the first has one less */
    FIXTURE_COEFFICIENTS = VIT_BASIS_RANK * FIXTURE_KNOTS,
    FIXTURE_PATCHES = 20,
    FIXTURE_STRIDE = 32,
    FIXTURE_PATCH_POINTS = 48, /* two a patch, and eight to fill up */
    FIXTURE_COLUMNS = FIXTURE_STRIDE + FIXTURE_PATCH_POINTS,
    FIXTURE_SEEN = 3, /* words of each second receiver: three columns of weight 1, and one of another */
    FIXTURE_GATHER = FIXTURE_RECEIVERS / 2 * FIXTURE_SEEN,
    FIXTURE_LOOKED = FIXTURE_FRAMES * FIXTURE_RECEIVERS / 32, /* words: a set a frame */
    FIXTURE_RANK = 16,
    FIXTURE_SPARSE = 96, /* words: a pair of slots in each of two panels */
    FIXTURE_TRANSFER = 20 + 3 * 32 + 4 + 32 + FIXTURE_SPARSE + 2 * 256 + 96 + 32 + 3 * 256,
    FIXTURE_CACHE = 8,
    FIXTURE_SKY = 2,
    FIXTURE_POINTS = 2 * VIT_PATTERNS
};

typedef struct pack_fixture {
    vit_scene scene;
    vit_camera cameras[FIXTURE_FRAMES];
    vit_light lights[FIXTURE_FRAMES * FIXTURE_LIGHTS];
    vit_triangle triangles[FIXTURE_TRIANGLES]; /* 12 in use for the cube */
    vit_attributes attributes[FIXTURE_TRIANGLES];
    vit_bvh_node nodes[FIXTURE_TRIANGLES]; /* 5 in use for the cube */
    vit_material materials[2];
    vit_maps maps[2];
    vit_texture textures[1];
    vit_mip mips[3];
    vit_u32 texels[FIXTURE_TEXELS];
    vit_u32 sides[2 * FIXTURE_TRIANGLES]; /* 24 in use for the cube */
    vit_cell cells[FIXTURE_CELLS];
    vit_light_sample emitters[FIXTURE_POINTS];
    vit_sky_texel sky[(FIXTURE_SKY + 2) * (FIXTURE_SKY + 2)];
    vit_receiver_cell receiver_cells[FIXTURE_CELLS];
    vit_receiver_split splits[FIXTURE_SPLITS];
    vit_receiver receivers[FIXTURE_RECEIVERS];
    vit_u32 map_sides[2 * FIXTURE_TRIANGLES];
    vit_receiver_cell map_cells[FIXTURE_MAP_CELLS];
    vit_receiver_split map_splits[FIXTURE_SPLITS];
    vit_receiver map_receivers[FIXTURE_MAP_RECEIVERS];
    vit_basis_group groups[FIXTURE_GROUPS * FIXTURE_LIGHTS];
    vit_u32 words[FIXTURE_WORDS];
    vit_basis_coefficient coefficients[FIXTURE_COEFFICIENTS];
    vit_basis_frame basis_frames[FIXTURE_FRAMES * FIXTURE_LIGHTS];
    vit_patch patches[FIXTURE_PATCHES];
    vit_patch_point patch_points[FIXTURE_PATCH_POINTS];
    vit_gather_row gather_rows[FIXTURE_RECEIVERS];
    vit_u32 gather_words[FIXTURE_GATHER];
    vit_u32 looked_up[FIXTURE_LOOKED];
    vit_u32 transfer[FIXTURE_TRANSFER];
    vit_cache_cell cache[FIXTURE_CACHE], point_cells[FIXTURE_CACHE];
    vit_photon photons[FIXTURE_BAKED];
    vit_gold golds[FIXTURE_FRAMES];
} pack_fixture;

static inline void fixture_triangle(vit_triangle *t, const float a[3], const float b[3], const float c[3]) {
    float u[3], v[3];
    for (int k = 0; k < 3; k++) {
        t->v0[k] = a[k];
        t->v1[k] = b[k];
        t->v2[k] = c[k];
        u[k] = b[k] - a[k];
        v[k] = c[k] - a[k];
    }
    t->nx = u[1] * v[2] - u[2] * v[1];
    t->ny = u[2] * v[0] - u[0] * v[2];
    t->nz = u[0] * v[1] - u[1] * v[0];
}

/* The cube -1..1, two triangles a side, in the order x-, x+, y-, y+, z-, z+; a corner's bits say its x, y and z. */
static inline void fixture_cube(pack_fixture *f) {
    static const int corners[6][4] = {{0, 2, 6, 4}, {1, 5, 7, 3}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 6, 7, 5}};
    for (int side = 0; side < 6; side++) {
        float p[4][3];
        for (int i = 0; i < 4; i++)
            for (int k = 0; k < 3; k++)
                p[i][k] = corners[side][i] >> k & 1 ? 1.0f : -1.0f;
        fixture_triangle(&f->triangles[2 * side], p[0], p[1], p[2]);
        fixture_triangle(&f->triangles[2 * side + 1], p[0], p[2], p[3]);
    }
    f->scene.triangles = 12;
}

/* Box of the sides first..last of the cube: flat only if it is one side alone; grown by the pad. */
static inline void fixture_side_box(float lo[3], float hi[3], int first, int last, float pad) {
    for (int k = 0; k < 3; k++) {
        const float least = first == last && first / 2 == k && first % 2 == 1 ? 1.0f : -1.0f;
        const float most = first == last && first / 2 == k && first % 2 == 0 ? -1.0f : 1.0f;
        lo[k] = least - pad;
        hi[k] = most + pad;
    }
}

/* Depth first by hand:  0 = (1, 3)   1 = (side 0, 2)   2 = (side 1, side 2)   3 = (side 3, 4)   4 = (side 4, side 5).
 * A row: first and last side of each child, and its node or 0 for a leaf of one side. */
static inline void fixture_tree(pack_fixture *f) {
    static const struct {
        int first, last;
        vit_u32 node;
    } children[5][2] = {
        {{0, 2, 1}, {3, 5, 3}}, {{0, 0, 0}, {1, 2, 2}}, {{1, 1, 0}, {2, 2, 0}}, {{3, 3, 0}, {4, 5, 4}}, {{4, 4, 0}, {5, 5, 0}}};
    for (int i = 0; i < 5; i++) {
        vit_bvh_node *n = &f->nodes[i];
        vit_u32 words[2];
        for (int c = 0; c < 2; c++)
            words[c] = children[i][c].node ? children[i][c].node
                                           : VIT_LEAF_BIT | 1u << VIT_LEAF_SHIFT | (vit_u32)(2 * children[i][c].first);
        n->child0 = words[0];
        n->child1 = words[1];
        fixture_side_box(n->lo0, n->hi0, children[i][0].first, children[i][0].last, f->scene.box_pad);
        fixture_side_box(n->lo1, n->hi1, children[i][1].first, children[i][1].last, f->scene.box_pad);
    }
    f->scene.nodes = 5;
}

static inline void fixture_scene(vit_scene *s) {
    *s = (vit_scene){.width = 64,
                     .height = 48,
                     .frames = FIXTURE_FRAMES,
                     .fps = 30,
                     .tile = 16,
                     .effects = VIT_BIT(SMOOTH) | VIT_BIT(NORMAL_MAPS) | VIT_BIT(LIGHTS) | VIT_BIT(SPOT) | VIT_BIT(RANGE) |
                                VIT_BIT(TEXTURES) | VIT_BIT(INDIRECT) | VIT_BIT(PHOTONS) | VIT_BIT(TRACED) | VIT_BIT(LIST) |
                                VIT_BIT(ZONES) | VIT_BIT(AREA) | VIT_BIT(SEQUENCE) | VIT_BIT(SMOOTH) | VIT_BIT(SPECULAR) |
                                VIT_BIT(MIRROR) | VIT_BIT(GLASS) | VIT_BIT(CAUSTICS) | VIT_BIT(AREA_LIGHTS) |
                                VIT_BIT(SKY_IMAGE) | VIT_BIT(SKY_LIGHT) | VIT_BIT(AMBIENT) | VIT_BIT(ANTIALIAS),
                     .materials = 2,
                     .textures = 1,
                     .mips = 3,
                     .texels = FIXTURE_TEXELS,
                     .lights = FIXTURE_LIGHTS,
                     .paths = 32,
                     .baked = FIXTURE_BAKED,
                     .bounces = 3,
                     .radius = 0.5f,
                     .ray_offset = 0x1p-12f,
                     .box_pad = 0x1p-20f,
                     .slice_count = 5,
                     .slice_near = 0.125f,
                     .slice_scale = 2,
                     .background = {0.25f, 0.5f, 1},
                     .max_nodes = 64,
                     .max_list = 1000,
                     .cells = FIXTURE_CELLS,
                     .ambient = {0.125f, 0.25f, 0.5f},
                     .area_samples = 1,
                     .sky_samples = 1,
                     .sky_size = FIXTURE_SKY,
                     .chain = 8,
                     .copies = 2,
                     .contrast = 0.0625f,
                     .offset = {{-0.25f, -0.25f}, {0.25f, 0.25f}}};
}

static inline void fixture_frames(pack_fixture *f) {
    for (vit_u32 i = 0; i < FIXTURE_FRAMES; i++) {
        f->cameras[i] = (vit_camera){.eye = {0, 0, 0.5f},
                                     .exposure = 1,
                                     .corner = {-1, 0.75f, -1},
                                     .right = {0x1p-5f, 0, 0},
                                     .down = {0, -0x1p-5f, 0},
                                     .forward = {0, 0, -1}};
        f->lights[FIXTURE_LIGHTS * i] = (vit_light){.position = {0, 0.5f, 0},
                                                    .kind = VIT_LIGHT_SPOT,
                                                    .direction = {0, -1, 0},
                                                    .cos_outer = 0.5f,
                                                    .intensity = {1, 2, 4},
                                                    .spot_scale = 2,
                                                    .spot_offset = -1,
                                                    .inv_range2 = 0.0625f};
        f->lights[FIXTURE_LIGHTS * i + 1] = (vit_light){.position = {i ? 0.5f : -0.5f, 0, 0},
                                                        .kind = VIT_LIGHT_POINT,
                                                        .cos_outer = -1,
                                                        .intensity = {8, 8, 8},
                                                        .falloff = VIT_FALLOFF_INVERSE_SQUARE,
                                                        .path_first = 0,
                                                        .path_count = 32};
        f->golds[i] = (vit_gold){
            .xrgb8888 = {i + 1, 2}, .nodes = 7, .clusters = 4, .photons = 20, .list = 60, .pairs = 60, .largest = 19};
    }
}

static inline void fixture_surfaces(pack_fixture *f) {
    f->materials[0] = (vit_material){.albedo = {0.5f, 0.5f, 0.5f}, .texture = VIT_NONE, .exponent = 1, .ior = 1};
    f->materials[1] = (vit_material){.albedo = {1, 1, 1}, .texture = 0, .exponent = 1, .ior = 1};
    f->maps[0] = (vit_maps){.normal = VIT_NONE, .normal_scale = 1};
    f->maps[1] = (vit_maps){.normal = 0, .normal_scale = -0.5f};
    f->textures[0] = (vit_texture){.mip_count = 3, .wrap_u = VIT_WRAP_REPEAT, .wrap_v = VIT_WRAP_CLAMP};
    vit_u32 first = 0; /* word of the mip's top left gutter corner */
    for (vit_u32 i = 0; i < 3; i++) {
        const vit_u32 edge = 4u >> i, pitch = edge + 2;
        f->mips[i] = (vit_mip){.offset = first + pitch + 1, .width = edge, .height = edge, .pitch = pitch};
        first += pitch * pitch;
    }
    for (vit_u32 i = 0; i < FIXTURE_TEXELS; i++)
        f->texels[i] = 0x80000000u | i * 0x00100401u;
    for (vit_u32 i = 0; i < FIXTURE_TRIANGLES; i++)
        f->attributes[i] =
            (vit_attributes){.normal = {0x7fff, 0x7fff, 0x7fff}, .material = i % 2, .uv = {{0, 0}, {1, 0}, {0, 1}}};
    for (int i = 0; i < FIXTURE_BAKED; i++)
        f->photons[i] = (vit_photon){.position = {0.25f * (float)i, -1, 0},
                                     .radius2 = 0.25f,
                                     .direction = {0, -1, 0},
                                     .inv_radius2 = 4,
                                     .power = {1, 0.5f, 0.25f},
                                     .zone = 1u << (31 - i)};
    f->photons[FIXTURE_BAKED - 1] = (vit_photon){.radius2 = -1}; /* an empty slot */
}

static inline void fixture_far_lights(pack_fixture *f) {
    for (int i = 0; i < FIXTURE_POINTS; i++)
        f->emitters[i] = i < VIT_PATTERNS ? (vit_light_sample){.position = {0.0625f * (float)i, 0.75f, 0},
                                                               .radius2 = 0.0625f,
                                                               .normal = {0, -1, 0},
                                                               .power = {1, 2, 3}}
                                          : (vit_light_sample){.position = {0, 1, 0}, .power = {0.5f, 0.5f, 1}};
    for (int i = 0; i < (FIXTURE_SKY + 2) * (FIXTURE_SKY + 2); i++)
        f->sky[i] = (vit_sky_texel){.radiance = {0.25f, 0.5f, (float)i}};
}

/* The first side has 2 x 2 cells, the others one each. */
static inline void fixture_cells(pack_fixture *f) {
    for (vit_u32 i = 0; i < 2 * FIXTURE_TRIANGLES; i++)
        f->sides[i] = i == 0 ? 2u << VIT_SIDE_PARTS_SHIFT : 1u << VIT_SIDE_PARTS_SHIFT | (3 + i) % FIXTURE_CELLS;
    for (vit_u32 i = 0; i < FIXTURE_CELLS; i++)
        f->cells[i] =
            (vit_cell){.accept = 0xffffffffu << i, .word = VIT_CELL_AREA_LEAST | (256 + i) << 9 | 511u << 18 | i << 27};
}

static inline void fixture_make(pack_fixture *f) {
    memset(f, 0, sizeof *f);
    fixture_scene(&f->scene);
    fixture_cube(f);
    fixture_tree(f);
    fixture_frames(f);
    fixture_surfaces(f);
    fixture_cells(f);
    fixture_far_lights(f);
    vit_pack_derive(&f->scene, NULL);
}

/* Cell 0 of the first side is parted, and so is the last cell. */
static inline void fixture_receivers(pack_fixture *f) {
    for (vit_u32 i = 0; i < FIXTURE_CELLS; i++)
        f->receiver_cells[i] = (vit_receiver_cell){.receiver = {i, i + 1, FIXTURE_RECEIVERS - 1 - i},
                                                   .split = i == 0                   ? 0
                                                            : i == FIXTURE_CELLS - 1 ? FIXTURE_SPLITS - 1
                                                                                     : VIT_NONE};
    f->splits[0] = (vit_receiver_split){.normal = {0, 1, 0}, .offset = 0.25f, .receiver = {0, FIXTURE_RECEIVERS - 1, 5}};
    f->splits[1] = (vit_receiver_split){.normal = {0, 0, -1}, .offset = -0.5f, .receiver = {7, 6, 5}};
    for (vit_u32 i = 0; i < FIXTURE_RECEIVERS; i++)
        f->receivers[i] = (vit_receiver){.irradiance = {0.25f * (float)i, 0.5f, 0.125f * (float)i}};
}

/* Ranks of the first group 0 and 2, of the second 3 and the most that there may be; vectors are shared. The first frame lies
 * between the last knots but one and the last, the second at a knot. */
static inline void fixture_basis(pack_fixture *f) {
    f->groups[0] = (vit_basis_group){.first_word = FIXTURE_WORDS, .first_coefficient = FIXTURE_COEFFICIENTS};
    f->groups[1] = (vit_basis_group){.first_word = VIT_BASIS_GROUP, .rank = 2};
    f->groups[2] = (vit_basis_group){.rank = 3, .first_coefficient = FIXTURE_COEFFICIENTS - 3 * (FIXTURE_KNOTS - 1)};
    f->groups[3] = (vit_basis_group){.rank = VIT_BASIS_RANK};
    for (vit_u32 i = 0; i < FIXTURE_WORDS; i++)
        f->words[i] = i * 0x9e3779b1u;
    f->words[0] = 0x80008000u; /* the least numbers */
    for (vit_u32 i = 0; i < FIXTURE_COEFFICIENTS; i++)
        f->coefficients[i] = (vit_basis_coefficient){.rgb = {0x1p-16f, (float)i * 0x1p-20f, -0x1p-18f}};
    for (vit_u32 i = 0; i < FIXTURE_LIGHTS; i++) {
        f->basis_frames[i] = (vit_basis_frame){.light = i, .knot = FIXTURE_KNOTS - 3 + i, .weight = i ? 1.0f : 0.25f};
        f->basis_frames[FIXTURE_LIGHTS + i] = (vit_basis_frame){.light = i, .knot = FIXTURE_KNOTS - 2 + i};
    }
}

/* Five cells of eight records. Those of keys 7 and 15 begin at the last record, two others have one key. */
static inline void fixture_cache(pack_fixture *f) {
    static const vit_u32 keys[FIXTURE_CACHE] = {8, 15, 17, 17, VIT_CACHE_EMPTY, VIT_CACHE_EMPTY, VIT_CACHE_EMPTY, 7};
    for (vit_u32 i = 0; i < FIXTURE_CACHE; i++) {
        f->cache[i].key = keys[i];
        for (vit_u32 q = 0; q < VIT_CACHE_POINTS && keys[i] != VIT_CACHE_EMPTY; q++)
            f->cache[i].word[VIT_CACHE_WORD(q)] |= (i * 100 + q) << VIT_CACHE_SHIFT(q);
        if (keys[i] != VIT_CACHE_EMPTY)
            f->cache[i].word[2] |= i << 20;
    }
    f->scene.effects |= VIT_BIT(OCCLUSION);
    f->scene.cache_cells = FIXTURE_CACHE;
    f->scene.cache_probes = 3;
    f->scene.cache_levels = 2;
    f->scene.ambient_radius = 0.5f;
    f->scene.cache_step = 0.0625f;
    f->scene.cache_detail = 2;
}

/* fixture_make() with the effects OCCLUSION, and BASIS and RELIGHT for PHOTONS and all that needs them. */
static inline void fixture_make_basis(pack_fixture *f) {
    fixture_make(f);
    f->scene.effects = (f->scene.effects & ~vit_effects_upon(VIT_BIT(PHOTONS))) | VIT_BIT(BASIS) | VIT_BIT(RELIGHT);
    f->scene.paths = f->scene.baked = f->scene.cells = 0;
    f->scene.receiver_cells = FIXTURE_CELLS;
    f->scene.receiver_splits = FIXTURE_SPLITS;
    f->scene.receivers = FIXTURE_RECEIVERS;
    f->scene.basis_lights = FIXTURE_LIGHTS;
    f->scene.basis_words = FIXTURE_WORDS;
    f->scene.basis_coefficients = FIXTURE_COEFFICIENTS;
    for (vit_u32 i = 0; i < FIXTURE_FRAMES * FIXTURE_LIGHTS; i++)
        f->lights[i].path_count = 0;
    for (vit_u32 i = 0; i < FIXTURE_FRAMES; i++)
        f->golds[i] = (vit_gold){.xrgb8888 = {i + 1, 2}};
    fixture_cache(f);
    fixture_receivers(f);
    fixture_basis(f);
    vit_pack_derive(&f->scene, NULL);
}

/* fixture_make_basis() with its receivers at points: five cells of eight records, as fixture_cache() has them. Record i has the
 * first i + 1 points, from receiver 100 i on, but record 2 is parted. */
static inline void fixture_make_points(pack_fixture *f) {
    fixture_make_basis(f);
    for (vit_u32 i = 0; i < FIXTURE_CACHE; i++) {
        f->point_cells[i] = (vit_cache_cell){.key = f->cache[i].key};
        if (f->cache[i].key == VIT_CACHE_EMPTY)
            continue;
        f->point_cells[i].word[0] = i < 5 ? 100 * i : FIXTURE_RECEIVERS - VIT_CACHE_POINTS;
        for (vit_u32 q = 0; q < VIT_CACHE_POINTS; q++)
            f->point_cells[i].word[1] |= (q <= i ? q : VIT_POINT_NONE) << VIT_POINT_BITS * q;
        f->point_cells[i].word[2] = i << 20;
    }
    f->point_cells[2] = (vit_cache_cell){17, {0x20080201u, 0xbf800000u, 2u << 20 | VIT_CACHE_PARTED}};
    f->scene.effects |= VIT_BIT(POINTS);
    f->scene.receiver_cells = FIXTURE_CACHE;
    f->scene.receiver_splits = 0;
    f->scene.point_levels = 2;
    f->scene.point_step = 0.0625f;
    f->scene.point_detail = 2;
    vit_pack_derive(&f->scene, NULL);
}

/* fixture_make() with a lightmap. Cells of the sides are 0 .. 25, one each: cell 2 is divided into 26 .. 29, rays find the
 * light of cells 5 and 28, and cells 0 and 29 are parted. */
static inline void fixture_make_lightmap(pack_fixture *f) {
    fixture_make(f);
    f->scene.effects |= VIT_BIT(LIGHTMAP) | VIT_BIT(LIGHTMAP_RAYS);
    f->scene.map_cells = FIXTURE_MAP_CELLS;
    f->scene.map_splits = FIXTURE_SPLITS;
    f->scene.map_receivers = FIXTURE_MAP_RECEIVERS;
    for (vit_u32 i = 0; i < 2 * FIXTURE_TRIANGLES; i++)
        f->map_sides[i] = 1u << VIT_SIDE_PARTS_SHIFT | i % 26;
    for (vit_u32 i = 0; i < FIXTURE_MAP_CELLS; i++)
        f->map_cells[i] = (vit_receiver_cell){.receiver = {i, i + 1, FIXTURE_MAP_RECEIVERS - 1 - i}, .split = VIT_NONE};
    f->map_cells[0].split = 0;
    f->map_cells[29].split = 1;
    f->map_cells[2] = (vit_receiver_cell){.receiver = {26}, .split = VIT_RECEIVER_DIVIDED | 2};
    f->map_cells[5] = f->map_cells[28] = (vit_receiver_cell){.split = VIT_RECEIVER_BY_RAYS};
    f->map_splits[0] = (vit_receiver_split){.normal = {1, 0, 0}, .offset = 0.5f, .receiver = {1, 2, FIXTURE_MAP_RECEIVERS - 1}};
    f->map_splits[1] = (vit_receiver_split){.normal = {0, -1, 0}, .receiver = {3, 2, 1}};
    for (vit_u32 i = 0; i < FIXTURE_MAP_RECEIVERS; i++)
        f->map_receivers[i] = (vit_receiver){.irradiance = {0.5f * (float)i, 2.0f, 0.25f}};
    vit_pack_derive(&f->scene, NULL);
}

static inline vit_u32 fixture_bits(float x) {
    vit_u32 bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* Two slots of each place of the first panel, one of the second's; a part of rank 16. */
static inline void fixture_transfer(pack_fixture *f) {
    vit_transfer h;
    (void)vit_transfer_lay_out(VIT_TRANSFER_SPARSE_LOW_RANK, FIXTURE_PATCHES, FIXTURE_RANK, FIXTURE_SPARSE, &h);
    h.sparse_chunks = 1;
    for (vit_u32 i = h.scale; i < h.panels; i++)
        f->transfer[i] = fixture_bits(0x1p-16f);
    for (vit_u32 p = 0; p < 2; p++) {
        f->transfer[h.panels + 2 * p] = h.sparse + 48 * p;
        f->transfer[h.panels + 2 * p + 1] = 2 - p;
    }
    for (vit_u32 i = 0; i < FIXTURE_STRIDE; i++) {
        vit_u32 *pair = f->transfer + h.sparse + i / 16 * 48 + i % 16;
        f->transfer[h.places + i] = FIXTURE_STRIDE - 1 - i;
        pair[0] = i % FIXTURE_PATCHES | (i < 16 ? (i + 4) << 16 : 0);
        pair[16] = 0x12345678u;
        pair[32] = i < 16 ? 0x87654321u : 0;
    }
    for (vit_u32 i = h.left; i < h.words; i++)
        f->transfer[i] = (i >= h.left_scale && i < h.right) || i >= h.right_scale ? fixture_bits(0x1p-12f) : i * 0x9e3779b1u;
    memcpy(f->transfer, &h, sizeof h);
}

static inline void fixture_patches(pack_fixture *f) {
    for (vit_u32 i = 0; i < FIXTURE_PATCHES; i++)
        f->patches[i] = (vit_patch){.first = 2 * i, .end = 2 * i + 2};
    for (vit_u32 i = 0; i < FIXTURE_PATCH_POINTS; i++)
        f->patch_points[i] = i < 2 * FIXTURE_PATCHES ? (vit_patch_point){.position = {0.0625f * (float)(i % 16), -0.75f, 0.25f},
                                                                         .patch = i / 2,
                                                                         .normal = {0, 1, 0},
                                                                         .weight = i % 2 ? 0.75f : 0.25f,
                                                                         .albedo = {0.5f, 0.25f, 1},
                                                                         .reflect = {1, 0.5f, VIT_MAX_REFLECT}}
                                                     : (vit_patch_point){.normal = {0, 0, -1}};
    for (vit_u32 i = 0; i < FIXTURE_RECEIVERS; i++)
        f->gather_rows[i] = (vit_gather_row){
            .first = (i + 1) / 2 * FIXTURE_SEEN, .ones = i % 2 ? 0 : 3, .weighted = i % 2 ? 0 : 1, .scale = 0x1p-9f};
    for (vit_u32 i = 0; i < FIXTURE_GATHER; i++) {
        const vit_u32 high[FIXTURE_SEEN] = {(i + 7) % FIXTURE_COLUMNS, 0, 65535 - i};
        f->gather_words[i] = high[i % FIXTURE_SEEN] << 16 | i % FIXTURE_COLUMNS;
    }
    for (vit_u32 i = 0; i < FIXTURE_LOOKED; i++)
        f->looked_up[i] = i * 0x9e3779b1u;
}

/* fixture_make_basis() with live radiosity of the second light for the basis. */
static inline void fixture_make_live(pack_fixture *f) {
    fixture_make_basis(f);
    f->scene.effects =
        (f->scene.effects & ~vit_effects_upon(VIT_BIT(BASIS))) | VIT_BIT(RADIOSITY) | VIT_BIT(TRANSFER) | VIT_BIT(LOW_RANK);
    f->scene.basis_lights = f->scene.basis_words = f->scene.basis_coefficients = 0;
    f->scene.patches = FIXTURE_PATCHES;
    f->scene.patch_points = FIXTURE_PATCH_POINTS;
    f->scene.gather_words = FIXTURE_GATHER;
    f->scene.looked_frames = 1;
    f->scene.live[0] = 2;
    f->scene.transfer_words = FIXTURE_TRANSFER;
    f->scene.transfer_rank = FIXTURE_RANK;
    f->scene.transfer_sums = 2;
    f->scene.most_reflected = 0x1p40f;
    fixture_patches(f);
    fixture_transfer(f);
    vit_pack_derive(&f->scene, NULL);
}

/* Replaces the cube by `depth` + 1 triangles side by side and a tree that is a chain of `depth` inner nodes (1..95). */
static inline void fixture_make_chain(pack_fixture *f, vit_u32 depth) {
    fixture_make(f);
    const float pad = f->scene.box_pad, end = (float)depth + 0.5f;
    for (vit_u32 i = 0; i <= depth; i++) {
        const float x = (float)i, a[3] = {x, 0, 0}, b[3] = {x + 0.5f, 0, 0}, c[3] = {x, 0.5f, 0};
        fixture_triangle(&f->triangles[i], a, b, c);
    }
    for (vit_u32 i = 0; i < depth; i++) {
        const float x = (float)i;
        f->nodes[i] = (vit_bvh_node){.lo0 = {x - pad, -pad, -pad},
                                     .hi0 = {x + 0.5f + pad, 0.5f + pad, pad},
                                     .lo1 = {x + 1 - pad, -pad, -pad},
                                     .hi1 = {end + pad, 0.5f + pad, pad},
                                     .child0 = VIT_LEAF_BIT | i,
                                     .child1 = i + 1 < depth ? i + 1 : VIT_LEAF_BIT | depth};
    }
    f->scene.triangles = depth + 1;
    f->scene.nodes = depth;
}

/* Where the fixture has what goes into the sections. */
static inline pack_sections fixture_sections(const pack_fixture *f) {
    const void *receiver_cells = f->scene.point_levels > 0 ? (const void *)f->point_cells : (const void *)f->receiver_cells;
    return (pack_sections){
        .data = {
            [VIT_SECTION_META] = &f->scene,       [VIT_SECTION_CAMS] = f->cameras,       [VIT_SECTION_LITE] = f->lights,
            [VIT_SECTION_GEOM] = f->triangles,    [VIT_SECTION_ATTR] = f->attributes,    [VIT_SECTION_BVHN] = f->nodes,
            [VIT_SECTION_MAPS] = f->maps,         [VIT_SECTION_MATL] = f->materials,     [VIT_SECTION_TEXR] = f->textures,
            [VIT_SECTION_MIPS] = f->mips,         [VIT_SECTION_ATLS] = f->texels,        [VIT_SECTION_SIDE] = f->sides,
            [VIT_SECTION_CELL] = f->cells,        [VIT_SECTION_EMIT] = f->emitters,      [VIT_SECTION_SKYT] = f->sky,
            [VIT_SECTION_RCEL] = receiver_cells,  [VIT_SECTION_RSPL] = f->splits,        [VIT_SECTION_RECV] = f->receivers,
            [VIT_SECTION_BGRP] = f->groups,       [VIT_SECTION_BWRD] = f->words,         [VIT_SECTION_BCOE] = f->coefficients,
            [VIT_SECTION_BFRM] = f->basis_frames, [VIT_SECTION_PATC] = f->patches,       [VIT_SECTION_PPNT] = f->patch_points,
            [VIT_SECTION_GROW] = f->gather_rows,  [VIT_SECTION_GATH] = f->gather_words,  [VIT_SECTION_LOOK] = f->looked_up,
            [VIT_SECTION_XFER] = f->transfer,     [VIT_SECTION_MSID] = f->map_sides,     [VIT_SECTION_MCEL] = f->map_cells,
            [VIT_SECTION_MSPL] = f->map_splits,   [VIT_SECTION_MREC] = f->map_receivers, [VIT_SECTION_CACH] = f->cache,
            [VIT_SECTION_PHOT] = f->photons,      [VIT_SECTION_GOLD] = f->golds,
        }};
}

static inline vit_status fixture_assemble(const pack_fixture *f, void **bytes, size_t *size, vit_text *why) {
    const pack_sections sections = fixture_sections(f);
    return pack_assemble(&sections, bytes, size, why);
}

#endif
