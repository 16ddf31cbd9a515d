/* All textures with their mip levels in one sheet of words. Each level is filtered straight from the image: any size of image
 * is weighted by exact area, nothing but the sheet is held in memory, and errors do not add up from level to level. */
#include "geometry/atlas.h"
#include "common/fail.h"
#include "common/strict_math.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define STBRP_STATIC
#define STBRP_LARGE_RECTS
#define STB_RECT_PACK_IMPLEMENTATION
#ifdef __GNUC__
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#endif
#include <stb/stb_rect_pack.h>
#ifdef __GNUC__
#pragma GCC diagnostic pop
#endif

#define SHEET_TRIES 64        /* widths to try */
#define SHEET_ALIGN 16        /* texels of a cache line; rows of the sheet begin on one */
#define SHEET_LIMIT (1 << 30) /* rows or columns, so that the packer's ints cannot overflow */
#define TEXELS_LIMIT 0x7fffffffu
#define VERDICT 0x80000000u

/* A texture to pack: what makes two materials' textures the same. */
typedef struct texture_key {
    int image;
    uint32_t wrap_u, wrap_v;
    uint32_t opaque_from; /* smallest alpha byte that is no hole; 0: no alpha test, 256: all holes */
    uint32_t map;         /* 1: three numbers, whose means are taken as they are */
} texture_key;

typedef struct packing {
    const model *m;
    texture_key *keys;  /* a texture */
    double linear[256]; /* of an sRGB byte */
    double byte[256];   /* of a byte of a map, 0..1 */
} packing;

static uint32_t opaque_from(const model_material *material) {
    if (!(material->cutoff > 0.0f))
        return 0;
    uint32_t a = 0;
    while (a < 256 && !((double)a / 255.0 * (double)material->alpha >= (double)material->cutoff))
        a++;
    return a;
}

/* The texture of that key, which is listed once. */
static uint32_t texture_of(const texture_key *key, texture_key *keys, atlas *out) {
    uint32_t t = 0;
    while (t < out->texture_count && memcmp(keys + t, key, sizeof *key) != 0)
        t++;
    if (t == out->texture_count)
        keys[out->texture_count++] = *key;
    return t;
}

/* Lists the textures of materials that a triangle uses. */
static void collect_textures(const model *m, const bool *used, texture_key *keys, atlas *out) {
    for (int i = 0; i < m->material_count; i++) {
        const model_material *material = m->materials + i;
        const texture_key color = {material->image, material->wrap_u, material->wrap_v, opaque_from(material), 0},
                          normal = {material->normal_image, material->normal_wrap_u, material->normal_wrap_v, 0, 1};
        out->material_texture[i] = material->image >= 0 && used[i] ? texture_of(&color, keys, out) : VIT_NONE;
        out->material_normal[i] = MODEL_HAS_NORMAL_MAP(material) && used[i] ? texture_of(&normal, keys, out) : VIT_NONE;
    }
}

static uint32_t mips_of(const model_image *image) {
    uint32_t count = 1;
    for (int size = image->width > image->height ? image->width : image->height; size > 1; size /= 2)
        count++;
    return count;
}

static uint32_t level_size(int size, uint32_t level) {
    const uint32_t s = (uint32_t)size >> level;
    return s ? s : 1;
}

/* Sizes of all levels; their places come with the sheet. */
static void list_mips(const packing *p, atlas *out) {
    uint32_t next = 0;
    for (uint32_t t = 0; t < out->texture_count; t++) {
        const texture_key *key = p->keys + t;
        const model_image *image = p->m->images + key->image;
        out->textures[t] = (vit_texture){next, mips_of(image), key->wrap_u, key->wrap_v};
        for (uint32_t level = 0; level < out->textures[t].mip_count; level++)
            out->mips[next++] = (vit_mip){.width = level_size(image->width, level), .height = level_size(image->height, level)};
    }
}

/* Places the rectangles in a sheet of `width` columns; the height used. */
static uint64_t pack_sheet(int width, stbrp_rect *rects, uint32_t count, stbrp_node *nodes) {
    stbrp_context context;
    stbrp_init_target(&context, width, SHEET_LIMIT, nodes, width);
    if (!stbrp_pack_rects(&context, rects, (int)count))
        return UINT64_MAX;
    uint64_t height = 0;
    for (uint32_t i = 0; i < count; i++) {
        /* There are rectangles: `count` is not 0. NOLINTNEXTLINE(clang-analyzer-core.NullDereference) */
        const uint64_t end = (uint64_t)rects[i].y + (uint64_t)rects[i].h;
        height = end > height ? end : height;
    }
    return height;
}

/* Tries widths from the widest level to twice a square's and keeps the smallest sheet, the narrowest of equals. The width need
 * not be a power of two: with gutters, levels of such sizes would waste up to half of it. */
static void best_sheet(atlas *out, stbrp_rect *rects, stbrp_node *nodes, int narrowest, int widest) {
    uint64_t best = UINT64_MAX;
    for (int i = 0; i < SHEET_TRIES; i++) {
        const int step = (int)((int64_t)(widest - narrowest) * i / (SHEET_TRIES - 1));
        const int width = (narrowest + step + SHEET_ALIGN - 1) / SHEET_ALIGN * SHEET_ALIGN;
        const uint64_t height = pack_sheet(width, rects, out->mip_count, nodes);
        if (height > TEXELS_LIMIT || height * (uint64_t)width >= best || height * (uint64_t)width > TEXELS_LIMIT)
            continue;
        best = height * (uint64_t)width;
        out->width = (uint32_t)width;
        out->height = (uint32_t)height;
        for (uint32_t r = 0; r < out->mip_count; r++) {
            vit_mip *mip = out->mips + rects[r].id;
            mip->pitch = out->width;
            mip->offset = (uint32_t)(rects[r].y + 1) * out->width + (uint32_t)rects[r].x + 1;
        }
    }
}

static vit_status place_mips(atlas *out, vit_text *why) {
    uint64_t area = 0;
    int narrowest = 0;
    stbrp_rect *rects = calloc(out->mip_count, sizeof *rects);
    for (uint32_t i = 0; rects && i < out->mip_count; i++) {
        rects[i].id = (int)i;
        rects[i].w = (stbrp_coord)out->mips[i].width + 2;
        rects[i].h = (stbrp_coord)out->mips[i].height + 2;
        area += (uint64_t)rects[i].w * (uint64_t)rects[i].h;
        narrowest = rects[i].w > narrowest ? rects[i].w : narrowest;
    }
    const int square = (int)ceil(2.0 * sqrt((double)area)), widest = square > narrowest ? square : narrowest;
    stbrp_node *nodes = area <= TEXELS_LIMIT ? malloc((size_t)(widest + SHEET_ALIGN) * sizeof *nodes) : NULL;
    if (nodes)
        best_sheet(out, rects, nodes, narrowest, widest);
    free(nodes);
    free(rects);
    if (!out->width) {
        return bake_fail(why, VIT_BAD_INPUT, "textures: %u with %llu texels do not fit one sheet of %u texels",
                         out->texture_count, (unsigned long long)area, TEXELS_LIMIT);
    }
    out->texel_count = out->width * out->height;
    out->occupancy = (double)area / out->texel_count;
    return VIT_OK;
}

static uint32_t map_word(const double mean[3]) {
    uint32_t word = 0;
    for (int k = 0; k < 3; k++)
        word |= (uint32_t)(mean[k] * VIT_MAP_ONE + 0.5) << (10 * k);
    return word;
}

static uint32_t texel_word(const double linear[3]) {
    uint32_t word = 0;
    for (int k = 0; k < 3; k++)
        word |= (uint32_t)(sqrt(linear[k]) * 1023.0 + 0.5) << (10 * k);
    return word;
}

/* Which texels of the image a level's texel covers along one axis, and how much of each: in units of 1 / size of the level, so
 * that all weights are integers. */
typedef struct span {
    uint32_t first, last;
    double head, whole, tail; /* of the first, of those between, of the last */
} span;

static span span_of(uint32_t texel, uint32_t size, int image_size) {
    const uint64_t lo = (uint64_t)texel * (uint64_t)image_size, hi = lo + (uint64_t)image_size; /* image texel i: i * size .. */
    const uint64_t first = lo / size, last = (hi - 1) / size;
    const uint64_t head_end = first == last ? hi : (first + 1) * size;
    return (span){(uint32_t)first, (uint32_t)last, (double)(head_end - lo), (double)size, (double)(hi - last * size)};
}

static double span_weight(const span *s, uint32_t i) {
    return i == s->first ? s->head : i == s->last ? s->tail : s->whole;
}

/* One texel of a level: the mean of the linear colours that it covers, of cut-outs weighted by alpha. It is opaque if at least
 * half of what it covers is. Of a map the mean of its numbers, which a normal may be shorter by. Where all is transparent the
 * next coarser level gives the colour, so that bilinear filtering next to an edge finds the colour of what is opaque nearby. */
static uint32_t filter_texel(const packing *p, const texture_key *key, const span *x, const span *y, uint32_t coarser) {
    const model_image *image = p->m->images + key->image;
    const double *value = key->map ? p->byte : p->linear;
    double red = 0.0, green = 0.0, blue = 0.0, weights = 0.0, opaque = 0.0, all = 0.0;
    for (uint32_t j = y->first; j <= y->last; j++) {
        const uint8_t *row = image->rgba + 4 * (size_t)j * (size_t)image->width;
        const double wy = span_weight(y, j);
        for (uint32_t i = x->first; i <= x->last; i++) {
            const uint8_t *texel = row + 4 * (size_t)i;
            const double area = wy * span_weight(x, i), weight = key->opaque_from ? area * texel[3] : area;
            red += weight * value[texel[0]];
            green += weight * value[texel[1]];
            blue += weight * value[texel[2]];
            weights += weight;
            all += area;
            opaque += texel[3] >= key->opaque_from ? area : 0.0;
        }
    }
    const uint32_t verdict = 2.0 * opaque >= all ? VERDICT : 0;
    if (!(weights > 0.0))
        return (coarser & ~VERDICT) | verdict;
    const double mean[3] = {red / weights, green / weights, blue / weights};
    return key->map ? map_word(mean) : texel_word(mean) | verdict;
}

static void filter_level(const packing *p, const texture_key *key, const vit_mip *mip, const vit_mip *coarser,
                         vit_u32 *texels) {
    const model_image *image = p->m->images + key->image;
    for (uint32_t y = 0; y < mip->height; y++) {
        const span rows = span_of(y, mip->height, image->height);
        for (uint32_t x = 0; x < mip->width; x++) {
            const span columns = span_of(x, mip->width, image->width);
            uint32_t above = 0;
            if (coarser) {
                const uint32_t cx = x * coarser->width / mip->width, cy = y * coarser->height / mip->height;
                above = texels[coarser->offset + cy * coarser->pitch + cx];
            }
            texels[mip->offset + y * mip->pitch + x] = filter_texel(p, key, &columns, &rows, above);
        }
    }
}

/* Coordinate -1..size of a gutter to the texel that continues the image there. A mirrored image begins with the same edge
 * again. */
static uint32_t wrapped(int64_t at, uint32_t size, uint32_t wrap) {
    const int64_t n = size;
    if (wrap == VIT_WRAP_REPEAT)
        return (uint32_t)((at + n) % n);
    return (uint32_t)(at < 0 ? 0 : at >= n ? n - 1 : at);
}

static void write_gutter(const texture_key *key, const vit_mip *mip, vit_u32 *texels) {
    const int64_t w = mip->width, h = mip->height;
    for (int64_t y = -1; y <= h; y++)
        for (int64_t x = -1; x <= w; x += (y < 0 || y == h) ? 1 : w + 1) {
            const uint32_t sx = wrapped(x, mip->width, key->wrap_u), sy = wrapped(y, mip->height, key->wrap_v);
            texels[(int64_t)mip->offset + y * mip->pitch + x] = texels[mip->offset + sy * mip->pitch + sx];
        }
}

/* Coarsest level first: finer ones look up to it where they are transparent. */
static void write_texture(const packing *p, const texture_key *key, const vit_texture *texture, atlas *out) {
    for (uint32_t i = texture->mip_count; i-- > 0;) {
        const vit_mip *mip = out->mips + texture->first_mip + i;
        filter_level(p, key, mip, i + 1 < texture->mip_count ? mip + 1 : NULL, out->texels);
        write_gutter(key, mip, out->texels);
    }
}

static vit_status out_of_memory(vit_text *why) {
    return bake_fail(why, VIT_FAILED, "textures: out of memory");
}

static vit_status pack_textures(packing *p, atlas *out, vit_text *why) {
    for (uint32_t t = 0; t < out->texture_count; t++)
        out->mip_count += mips_of(p->m->images + p->keys[t].image);
    out->textures = calloc(out->texture_count, sizeof *out->textures);
    out->mips = calloc(out->mip_count, sizeof *out->mips);
    if (!out->textures || !out->mips)
        return out_of_memory(why);
    list_mips(p, out);
    const vit_status status = place_mips(out, why);
    if (status != VIT_OK)
        return status;
    out->texels = calloc(out->texel_count, sizeof *out->texels);
    if (!out->texels)
        return out_of_memory(why);
    for (int i = 0; i < 256; i++) {
        p->linear[i] = srgb_linear(i / 255.0);
        p->byte[i] = i / 255.0;
    }
    for (uint32_t t = 0; t < out->texture_count; t++)
        write_texture(p, p->keys + t, out->textures + t, out);
    return VIT_OK;
}

vit_status atlas_pack(const model *m, atlas *out, vit_text *why) {
    *out = (atlas){0};
    const size_t materials = (size_t)m->material_count;
    packing p = {.m = m, .keys = calloc(materials, 2 * sizeof *p.keys)};
    bool *used = calloc(materials, sizeof *used);
    out->material_texture = calloc(materials, sizeof *out->material_texture);
    out->material_normal = calloc(materials, sizeof *out->material_normal);
    vit_status status = VIT_OK;
    if (p.keys && used && out->material_texture && out->material_normal) {
        for (uint32_t i = 0; i < m->triangles; i++)
            used[m->material[i]] = true;
        collect_textures(m, used, p.keys, out);
        if (out->texture_count)
            status = pack_textures(&p, out, why);
    } else
        status = out_of_memory(why);
    free(used);
    free(p.keys);
    if (status != VIT_OK)
        atlas_free(out);
    return status;
}

void atlas_free(atlas *a) {
    free(a->texels);
    free(a->textures);
    free(a->mips);
    free(a->material_texture);
    free(a->material_normal);
    *a = (atlas){0};
}
