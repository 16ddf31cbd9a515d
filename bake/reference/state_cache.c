#define _POSIX_C_SOURCE 200809L
#include "reference/state.h"
#include "common/fail.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define FACE_NORMALS 0x80000000u /* with METHOD: of reference_input */
#define METHOD 3u                /* raise when the same input gives other bits than before */
#define ROOM 4096                /* bytes of a path */

typedef struct cache_header {
    char magic[8];
    uint64_t key, rays, hash;
    double seconds;
    uint32_t width, height, rounds, zero;
} cache_header;

static const char magic[8] = "VITREF2";
#define KIND 6 /* bytes of it that all versions share */

/* META's part that the picture depends on, and the settings. */
typedef struct key_settings {
    uint32_t method, round, frame, every, bounces, width, height, direct_only[64];
    uint32_t filter, sky_lights;
    float ray_offset, box_pad, background[3], ambient[3], ambient_radius;
} key_settings;

static key_settings settings_of(const reference_input *in) {
    const vit_scene *s = in->sections->data[VIT_SECTION_META];
    key_settings k;
    memset(&k, 0, sizeof k); /* padding, if any, is hashed too */
    k.method = METHOD | (in->face_normals ? FACE_NORMALS : 0u);
    k.round = REFERENCE_ROUND;
    k.frame = in->frame;
    k.every = in->every;
    k.bounces = in->bounces;
    k.width = s->width;
    k.height = s->height;
    k.ray_offset = s->ray_offset;
    k.box_pad = s->box_pad;
    memcpy(k.background, s->background, sizeof k.background);
    memcpy(k.ambient, s->ambient, sizeof k.ambient);
    k.ambient_radius = s->ambient_radius;
    k.filter = paths_filter(s);
    k.sky_lights = (s->effects & VIT_BIT(SKY_LIGHT)) != 0;
    for (uint32_t i = 0; in->direct_only && i < s->lights; i++)
        k.direct_only[i % 64] = k.direct_only[i % 64] * 2 + in->direct_only[i];
    return k;
}

/* The frame's lights; who traces their photons is no matter. */
static uint64_t hash_lights(const reference_input *in) {
    const vit_scene *s = in->sections->data[VIT_SECTION_META];
    const vit_light *lights = in->sections->data[VIT_SECTION_LITE];
    uint64_t hash = 0;
    for (uint32_t i = 0; i < s->lights; i++) {
        struct {
            uint64_t before;
            vit_light light;
        } link = {hash, lights[(size_t)in->frame * s->lights + i]};
        link.light.path_first = link.light.path_count = 0;
        hash = vit_hash(&link, sizeof link);
    }
    return hash;
}

/* Without what follows from light_samples. */
static uint64_t hash_materials(const vit_material *materials, uint32_t count) {
    uint64_t parts[2] = {0, 0};
    for (uint32_t i = 0; i < count; i++) {
        vit_material m = materials[i];
        m.near2 = 0.0f;
        parts[0] = vit_hash(parts, sizeof parts);
        parts[1] = vit_hash(&m, sizeof m);
    }
    return vit_hash(parts, sizeof parts);
}

uint64_t state_key(const reference_input *in) {
    const void *const *data = in->sections->data;
    const vit_scene *s = data[VIT_SECTION_META];
    const key_settings settings = settings_of(in);
    const uint64_t parts[] = {
        vit_hash(&settings, sizeof settings),
        hash_lights(in),
        vit_hash((const vit_camera *)data[VIT_SECTION_CAMS] + in->frame, sizeof(vit_camera)),
        vit_hash(data[VIT_SECTION_GEOM], s->triangles * sizeof(vit_triangle)),
        vit_hash(data[VIT_SECTION_ATTR], s->triangles * sizeof(vit_attributes)),
        hash_materials(data[VIT_SECTION_MATL], s->materials),
        VIT_HAS_MAPS(s->effects) ? vit_hash(data[VIT_SECTION_MAPS], s->materials * sizeof(vit_maps)) : 0,
        vit_hash(data[VIT_SECTION_TEXR], s->textures * sizeof(vit_texture)),
        vit_hash(data[VIT_SECTION_MIPS], s->mips * sizeof(vit_mip)),
        vit_hash(data[VIT_SECTION_ATLS], s->texels * sizeof(vit_u32)),
        s->sky_size ? vit_hash(data[VIT_SECTION_SKYT], (s->sky_size + (size_t)2) * (s->sky_size + 2) * sizeof(vit_sky_texel))
                    : 0};
    return vit_hash(parts, sizeof parts);
}

vit_status state_folder(const char *folder, vit_text *why) {
    char path[ROOM];
    if (snprintf(path, sizeof path, "%s", folder) < (int)sizeof path) {
        for (char *slash = strchr(path + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
            *slash = '\0';
            mkdir(path, 0777);
            *slash = '/';
        }
        mkdir(path, 0777);
        if (access(path, W_OK | X_OK) == 0)
            return VIT_OK;
    }
    return bake_fail(why, VIT_FAILED, "%.400s: cannot keep references in this folder: %s", folder, strerror(errno));
}

static bool file_name(const reference_state *s, const char *folder, char path[ROOM]) {
    const int length = snprintf(path, ROOM, "%s/%016llx.reference", folder, (unsigned long long)s->key);
    return length > 0 && length < ROOM;
}

/* Of the whole file. */
static uint64_t hash_file(cache_header h, const pixel_sums *sums, size_t size) {
    h.hash = 0;
    const uint64_t parts[] = {vit_hash(&h, sizeof h), vit_hash(sums, size)};
    return vit_hash(parts, sizeof parts);
}

static bool fits(const cache_header *h, const reference_state *s) {
    return memcmp(h->magic, magic, sizeof magic) == 0 && h->key == s->key && h->width == s->width && h->height == s->height &&
           h->rounds > 0 && h->rounds <= REFERENCE_MOST / REFERENCE_ROUND;
}

void state_load(reference_state *s, const char *folder) {
    char path[ROOM];
    cache_header h;
    FILE *f = file_name(s, folder, path) ? fopen(path, "rb") : NULL;
    const size_t size = s->pixels * sizeof *s->sums;
    pixel_sums *sums = malloc(size);
    if (f && sums && fread(&h, sizeof h, 1, f) == 1 && fits(&h, s) && fread(sums, 1, size, f) == size && fgetc(f) == EOF &&
        hash_file(h, sums, size) == h.hash) {
        memcpy(s->sums, sums, size);
        s->rounds = h.rounds;
        s->rays = h.rays;
        s->seconds = h.seconds;
    }
    free(sums);
    if (f)
        (void)fclose(f);
}

/* What lies there under the reference's name, and is neither by its first bytes nor by its size one that was damaged, is
 * somebody's. */
static bool is_foreign(const char *path, size_t size) {
    char start[sizeof magic];
    struct stat there;
    FILE *f = fopen(path, "rb");
    if (!f)
        return errno != ENOENT;
    const bool ours = (fread(start, 1, sizeof start, f) == sizeof start && memcmp(start, magic, KIND) == 0) ||
                      (fstat(fileno(f), &there) == 0 && there.st_size == (off_t)size);
    (void)fclose(f);
    return !ours;
}

vit_status state_save(const reference_state *s, const char *folder, vit_text *why) {
    const size_t size = s->pixels * sizeof *s->sums;
    cache_header h = {
        .key = s->key, .rays = s->rays, .seconds = s->seconds, .width = s->width, .height = s->height, .rounds = s->rounds};
    char path[ROOM];
    unsigned char *file = malloc(sizeof h + size);
    vit_status status;
    memcpy(h.magic, magic, sizeof magic);
    h.hash = hash_file(h, s->sums, size);
    if (!file || !file_name(s, folder, path))
        status = bake_fail(why, VIT_FAILED, "reference: %s", file ? "the cache's folder has too long a name" : "out of memory");
    else if (is_foreign(path, sizeof h + size))
        status = bake_fail(why, VIT_FAILED, "%.400s: is there and is no reference: it is not written over", path);
    else {
        memcpy(file, &h, sizeof h);
        memcpy(file + sizeof h, s->sums, size);
        status = pack_save(path, file, sizeof h + size, why);
    }
    free(file);
    return status;
}
