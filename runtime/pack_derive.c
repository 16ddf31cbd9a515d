/* pack_derive.c: the fields of the scene that follow from others, and the limits of those others. Baker and loader share it,
 * so that a pack cannot say one resolution and size its buffers by another. */
#include "vitrine_pack.h"
#include "fail.h"

#include <string.h>

/* Limits that keep every product of counts within 32 bits, and every buffer within what a device may be asked for. */
enum {
    MAX_WIDTH = 7680,
    MAX_HEIGHT = 4320,
    MAX_FRAMES = 100000,
    MAX_LIGHTS = 64,
    MAX_MATERIALS = VIT_MATERIAL_INDEX + 1,
    MAX_TEXTURES = 65536,
    MAX_MIPS = MAX_TEXTURES * 15, /* 16384 texels an edge have 15 levels */
    MAX_TEXELS = 0x7fffffff,      /* atlas words are addressed in 32-bit two's complement */
    MAX_PATHS = 1000000,
    MAX_BOUNCES = 32,
    MAX_PHOTONS = 1 << 25,
    MAX_RECEIVERS = 1 << 24,
    MAX_BASIS = 1 << 28,
    MAX_GATHER = 1 << 28, /* words: a row's first and count together within 32 bits */
    MAX_LOOKED = 1 << 28, /* words */
    MAX_TRANSFER = 1 << 30,
    MAX_SUMS = 2 * VIT_MAX_COLUMNS / VIT_TRANSFER_CHUNK + 1,
    MAX_CACHE = 1 << 26, /* words of them within 32 bits, signed */
    MAX_SLICES = 4096,
    MAX_KEY_BITS = 30, /* 2^25 mask words, 128 MiB, for the last level of the hierarchy */
    BITS_A_LEVEL = 5,  /* one 32-bit mask word tells a node's children */
    NORMAL_KEY_BITS = 6,
};

static vit_status refuse_count(vit_text *why, const char *name, uint64_t least, uint64_t most, uint64_t got) {
    return vit_fail(why, VIT_BAD_INPUT, "%s must be in %llu..%llu, got %llu", name, (unsigned long long)least,
                    (unsigned long long)most, (unsigned long long)got);
}

static vit_status check_counts(const vit_scene *s, vit_text *why) {
    const struct {
        const char *name;
        vit_u32 value, least, most;
    } counts[] = {
        {"width", s->width, 1, MAX_WIDTH},
        {"height", s->height, 1, MAX_HEIGHT},
        {"frames", s->frames, 1, MAX_FRAMES},
        {"triangles", s->triangles, 1, VIT_MAX_TRIANGLES},
        {"nodes", s->nodes, 1, s->triangles}, /* a leaf holds at least one triangle; a lone leaf still has the root */
        {"materials", s->materials, 1, MAX_MATERIALS},
        {"textures", s->textures, 0, MAX_TEXTURES},
        {"mips", s->mips, 0, MAX_MIPS},
        {"texels", s->texels, 0, MAX_TEXELS},
        {"lights", s->lights, 0, MAX_LIGHTS},
        {"paths", s->paths, 0, MAX_PATHS},
        {"baked", s->baked, 0, MAX_PHOTONS},
        {"cells", s->cells, 0, VIT_SIDE_CELL},
        {"receiver_cells", s->receiver_cells, 0, VIT_SIDE_CELL},
        {"receiver_splits", s->receiver_splits, 0, VIT_SIDE_CELL},
        {"receivers", s->receivers, 0, MAX_RECEIVERS},
        {"map_cells", s->map_cells, 0, VIT_SIDE_CELL},
        {"map_splits", s->map_splits, 0, VIT_SIDE_CELL},
        {"map_receivers", s->map_receivers, 0, MAX_RECEIVERS},
        {"basis_lights", s->basis_lights, 0, s->lights},
        {"basis_words", s->basis_words, 0, MAX_BASIS},
        {"basis_coefficients", s->basis_coefficients, 0, MAX_BASIS},
        {"patches", s->patches, 0, VIT_MAX_COLUMNS - 16},
        {"patch_points", s->patch_points, 0, VIT_MAX_COLUMNS - VIT_PATCH_STRIDE(s)},
        {"gather_words", s->gather_words, 0, MAX_GATHER},
        {"looked_frames", s->looked_frames, 0, s->frames},
        {"transfer_words", s->transfer_words, 0, MAX_TRANSFER},
        {"transfer_rank", s->transfer_rank, 0, VIT_TRANSFER_MOST_RANK},
        {"transfer_sums", s->transfer_sums, 0, MAX_SUMS},
        {"cache_cells", s->cache_cells, 0, MAX_CACHE},
        {"cache_probes", s->cache_probes, 0, VIT_CACHE_PROBES},
        {"cache_levels", s->cache_levels, 0, VIT_CACHE_LEVELS},
        {"point_levels", s->point_levels, 0, VIT_CACHE_LEVELS},
        {"bounces", s->bounces, 1, MAX_BOUNCES},
        {"area_samples", s->area_samples, 0, VIT_MAX_LIGHT_SAMPLES},
        {"sky_samples", s->sky_samples, 0, VIT_MAX_LIGHT_SAMPLES},
        {"sky_size", s->sky_size, 0, VIT_MAX_SKY},
        {"chain", s->chain, 0, VIT_MAX_CHAIN},
        {"gloss_rays", s->gloss_rays, 0, VIT_MAX_GLOSS_RAYS},
        {"copies", s->copies, 1, VIT_MAX_COPIES},
        {"slice_count", s->slice_count, 1, MAX_SLICES},
    };
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++)
        if (counts[i].value < counts[i].least || counts[i].value > counts[i].most)
            return refuse_count(why, counts[i].name, counts[i].least, counts[i].most, counts[i].value);
    if (s->copies & (s->copies - 1))
        return vit_fail(why, VIT_BAD_INPUT, "copies must be 1, 2, 4, 8 or 16, got %u", s->copies);
    if (s->receivers % VIT_BASIS_GROUP != 0)
        return vit_fail(why, VIT_BAD_INPUT, "receivers must be a multiple of %u, got %u", VIT_BASIS_GROUP, s->receivers);
    if ((uint64_t)VIT_LOOKED_SETS(s) * s->receivers > (uint64_t)MAX_LOOKED * 32)
        return vit_fail(why, VIT_BAD_INPUT, "looked_frames: %u sets of %u receivers have more than %u words",
                        VIT_LOOKED_SETS(s), s->receivers, MAX_LOOKED);
    if (s->patch_points % 16 != 0 || s->transfer_rank % VIT_TRANSFER_ROWS != 0)
        return vit_fail(why, VIT_BAD_INPUT, "patch_points and transfer_rank must be multiples of 16, got %u and %u",
                        s->patch_points, s->transfer_rank);
    if (s->cache_cells & (s->cache_cells - 1))
        return vit_fail(why, VIT_BAD_INPUT, "cache_cells must be a power of two, got %u", s->cache_cells);
    if (s->tile != 8 && s->tile != 16 && s->tile != 32 && s->tile != 64)
        return vit_fail(why, VIT_BAD_INPUT, "tile must be 8, 16, 32 or 64, got %u", s->tile);
    return VIT_OK;
}

/* The least number of bits that hold 0 .. count - 1. */
static vit_u32 bits_for(vit_u32 count) {
    vit_u32 bits = 0;
    while (bits < 32 && (count - 1) >> bits != 0)
        bits++;
    return bits;
}

static vit_status derive_keys(vit_scene *s, vit_text *why) {
    s->key_bits_x = bits_for(s->tiles_x);
    s->key_bits_y = bits_for(s->tiles_y);
    s->key_bits_z = bits_for(s->slice_count);
    s->key_bits_n = s->effects & VIT_BIT(NORMAL_KEYS) ? NORMAL_KEY_BITS : 0;
    s->key_bits = s->key_bits_x + s->key_bits_y + s->key_bits_z + s->key_bits_n;
    if (s->key_bits > MAX_KEY_BITS)
        return refuse_count(why, "key_bits", 0, MAX_KEY_BITS, s->key_bits);
    return VIT_OK;
}

/* One word of level j tells the children of one node: its index is key >> 5 (levels - j). The last level's bits are the
 * clusters; the root has one word, of which fewer than 32 bits are used unless key_bits is a multiple of 5. */
static void derive_levels(vit_scene *s) {
    s->levels = s->key_bits == 0 ? 1 : (s->key_bits + BITS_A_LEVEL - 1) / BITS_A_LEVEL;
    memset(s->level_first, 0, sizeof s->level_first);
    vit_u32 words = 0;
    for (vit_u32 j = 0; j < s->levels; j++) {
        vit_u32 below = BITS_A_LEVEL * (s->levels - j);
        s->level_first[j] = words;
        words += s->key_bits > below ? 1u << (s->key_bits - below) : 1;
    }
    s->mask_words = words;
}

vit_status vit_pack_derive(vit_scene *s, vit_text *why) {
    vit_status status = check_counts(s, why);
    if (status != VIT_OK)
        return status;
    s->tiles_x = (s->width + s->tile - 1) / s->tile;
    s->tiles_y = (s->height + s->tile - 1) / s->tile;
    s->samples = s->tiles_x * s->tiles_y * s->tile * s->tile; /* < (7680 + 64) * (4320 + 64) < 2^26 */
    uint64_t photons = (uint64_t)s->paths * (s->bounces - 1) + s->baked;
    if (photons > MAX_PHOTONS)
        return refuse_count(why, "photons", 0, MAX_PHOTONS, photons);
    s->photons = (vit_u32)photons;
    status = derive_keys(s, why);
    if (status == VIT_OK)
        derive_levels(s);
    return status;
}
