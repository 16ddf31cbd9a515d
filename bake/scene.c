#include "scene_files.h"
#include "scene_reader.h"
#include "scene_text.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const field top_fields[] = {
    {"name", FIELD_TEXT, offsetof(scene, name), NULL},
    {"background", FIELD_VECTOR, offsetof(scene, background), RADIOMETRIC},
    {"ambient", FIELD_VECTOR, offsetof(scene, ambient), RADIOMETRIC},
    {"light_units", FIELD_WORD, offsetof(scene, light_units), SCENE_LIGHT_UNITS},
    {"sky", FIELD_OTHER, 0, NULL},
    {"output", FIELD_OTHER, 0, NULL},
    {"meshes", FIELD_OTHER, 0, NULL},
    {"camera", FIELD_OTHER, 0, NULL},
    {"lights", FIELD_OTHER, 0, NULL},
    {"materials", FIELD_OTHER, 0, NULL},
    {"quality", FIELD_OTHER, 0, NULL},
    {"effects", FIELD_OTHER, 0, NULL},
    {"check", FIELD_SWITCH, offsetof(scene, check), NULL},
};

static const field output_fields[] = {
    {"width", FIELD_WHOLE, offsetof(scene, width), "[1, 7680]"},
    {"height", FIELD_WHOLE, offsetof(scene, height), "[1, 4320]"},
    {"fps", FIELD_NUMBER, offsetof(scene, fps), "(0, 1000]"},
    {"frames", FIELD_WHOLE, offsetof(scene, frames), "[1, 100000]"},
};

enum { SKY_IMAGE, SKY_SCALE, SKY_ROTATE, SKY_LIGHT };
static const field sky_fields[] = {
    [SKY_IMAGE] = {"image", FIELD_PATH, offsetof(scene_sky, image), NULL},
    [SKY_SCALE] = {"scale", FIELD_NUMBER, offsetof(scene_sky, scale), "[0, 1e6]"},
    [SKY_ROTATE] = {"rotate", FIELD_NUMBER, offsetof(scene_sky, rotate), "[-360, 360]"},
    [SKY_LIGHT] = {"light", FIELD_SWITCH, offsetof(scene_sky, light), NULL},
};

typedef struct quality_group {
    scene_quality q;
    bool flattened, automatic;
} quality_group;

enum { QUALITY_AUTOMATIC, QUALITY_FLATTEN };
static const field quality_fields[] = {
    [QUALITY_AUTOMATIC] = {"auto", FIELD_SWITCH, offsetof(quality_group, automatic), NULL},
    [QUALITY_FLATTEN] = {"flatten", FIELD_NUMBER, offsetof(quality_group, q.flatten), "(0, 1e4]"},
    {"photons", FIELD_WHOLE, offsetof(quality_group, q.photons), "[0, 1000000]"},
    {"bounces", FIELD_WHOLE, offsetof(quality_group, q.bounces), "[1, 32]"},
    {"radius", FIELD_AUTO, offsetof(quality_group, q.radius), "[1e-12, 1e6]"},
    {"tile", FIELD_WHOLE, offsetof(quality_group, q.tile), "[8, 64]"},
    {"estimate", FIELD_CHOICE, offsetof(quality_group, q.buckets), "list|buckets"},
    {"smoothing", FIELD_CHOICE, offsetof(quality_group, q.raw), "interpolated|raw"},
    {"kernel", FIELD_CHOICE, offsetof(quality_group, flattened), "sphere|flattened"},
    {"normal_keys", FIELD_SWITCH, offsetof(quality_group, q.normal_keys), NULL},
    {"zones", FIELD_SWITCH, offsetof(quality_group, q.zones), NULL},
    {"light_zones", FIELD_SWITCH, offsetof(quality_group, q.light_zones), NULL},
    {"effective_area", FIELD_SWITCH, offsetof(quality_group, q.effective_area), NULL},
    {"guiding", FIELD_SWITCH, offsetof(quality_group, q.guiding), NULL},
    {"bounce_sequence", FIELD_SWITCH, offsetof(quality_group, q.bounce_sequence), NULL},
    {"indirect_samples", FIELD_AMONG, offsetof(quality_group, q.indirect_samples), SCENE_INDIRECT_SAMPLES},
    {"texture_filter", FIELD_WORD, offsetof(quality_group, q.texture_filter), SCENE_FILTERS},
    {"vertex_bits", FIELD_AMONG, offsetof(quality_group, q.vertex_bits), SCENE_VERTEX_BITS},
    {"normal_bits", FIELD_AMONG, offsetof(quality_group, q.normal_bits), SCENE_NORMAL_BITS},
    {"sample_bits", FIELD_AMONG, offsetof(quality_group, q.sample_bits), SCENE_SAMPLE_BITS},
    {"antialias", FIELD_AMONG, offsetof(quality_group, q.antialias), SCENE_ANTIALIAS},
    {"antialias_contrast", FIELD_NUMBER, offsetof(quality_group, q.antialias_contrast), "[0, 1]"},
    {"antialias_filter", FIELD_CHOICE, offsetof(quality_group, q.tent), "box|tent"},
    {"light_samples", FIELD_WHOLE, offsetof(quality_group, q.light_samples), "[1, 1024]"},
    {"sky_samples", FIELD_WHOLE, offsetof(quality_group, q.sky_samples), "[1, 1024]"},
    {"specular_depth", FIELD_WHOLE, offsetof(quality_group, q.specular_depth), "[1, 32]"},
    {"caustics", FIELD_SWITCH, offsetof(quality_group, q.caustics), NULL},
};

void reader_at(reader *r, const char *group, int index) {
    if (index < 0)
        (void)snprintf(r->at.what, sizeof r->at.what, "%s", group);
    else
        (void)snprintf(r->at.what, sizeof r->at.what, "%s %d", group, index + 1);
}

bool reader_allocate(reader *r, void *block, int count, size_t size) {
    void *room = calloc((size_t)count + 1, size);
    if (!room)
        return fields_fail(&r->at, NULL, "out of memory");
    memcpy(block, &room, sizeof room);
    return true;
}

static bool read_output(reader *r, const config_setting_t *root) {
    const config_setting_t *group = config_setting_get_member(root, "output");
    uint32_t seen;
    reader_at(r, "output", -1);
    return !group || fields_read(&r->at, group, output_fields, FIELD_COUNT(output_fields), r->s, &seen);
}

static bool read_sky(reader *r, const config_setting_t *root) {
    const config_setting_t *group = config_setting_get_member(root, "sky");
    scene *s = r->s;
    scene_sky *sky = &s->sky;
    uint32_t seen;
    reader_at(r, "sky", -1);
    if (!group)
        return true;
    if (!fields_read(&r->at, group, sky_fields, FIELD_COUNT(sky_fields), sky, &seen))
        return false;
    if (!sky->image[0] && (seen & (FIELD_BIT(SKY_SCALE) | FIELD_BIT(SKY_ROTATE))))
        return fields_fail(&r->at, group, "'scale' and 'rotate' are for an 'image'");
    if (!(seen & FIELD_BIT(SKY_LIGHT)))
        sky->light = sky->image[0] != '\0';
    if (sky->light && !sky->image[0] && !(s->background[0] > 0 || s->background[1] > 0 || s->background[2] > 0))
        return fields_fail(&r->at, group, "'light' needs an 'image', or a 'background' that is not black");
    return true;
}

/* QUALITY_KEPT_* of a setting's name; 0: "auto" does not choose it. */
static uint32_t kept_bit(const char *name) {
#define X(bit, word)                                                                                                           \
    if (strcmp(name, #word) == 0)                                                                                              \
        return QUALITY_KEPT_##bit;
    SCENE_QUALITY_AUTO(X)
#undef X
    return 0;
}

/* Puts the group's settings over *q. *automatic and *kept: as in `scene`; may be NULL. */
static bool merge_quality(const place *at, const config_setting_t *group, scene_quality *q, bool *automatic, uint32_t *kept) {
    quality_group g = {.q = *q, .flattened = q->flatten > 0};
    uint32_t seen = 0;
    if (!fields_read(at, group, quality_fields, FIELD_COUNT(quality_fields), &g, &seen))
        return false;
    if (g.automatic && !automatic)
        return fields_fail(at, group, "'auto' is not for here");
    for (int i = 0; i < FIELD_COUNT(quality_fields) && kept; i++)
        *kept |= seen & FIELD_BIT(i) ? kept_bit(quality_fields[i].name) : 0;
    if (automatic)
        *automatic = g.automatic;
    if (g.q.tile & (g.q.tile - 1))
        return fields_fail(at, group, "'tile' must be 8, 16, 32 or 64, got %d", g.q.tile);
    if (g.q.raw && !g.q.buckets)
        return fields_fail(at, group, "smoothing \"raw\" needs estimate \"buckets\"");
    if ((seen & FIELD_BIT(QUALITY_FLATTEN)) && !g.flattened)
        return fields_fail(at, group, "'flatten' needs kernel \"flattened\"");
    if (g.q.light_zones && !g.q.zones)
        return fields_fail(at, group, "'light_zones' needs zones = true");
    if (!g.flattened)
        g.q.flatten = 0;
    else if (!(g.q.flatten > 0))
        g.q.flatten = 15.0;
    *q = g.q;
    return true;
}

static bool read_quality(reader *r, const config_setting_t *root) {
    const config_setting_t *group = config_setting_get_member(root, "quality");
    reader_at(r, "quality", -1);
    if (!group)
        return true;
    const char *word = config_setting_get_string(group);
    if (word)
        return strcmp(word, "auto") == 0 || fields_fail(&r->at, group, "must be \"auto\" or a group, got \"%.60s\"", word);
    return merge_quality(&r->at, group, &r->s->quality, &r->s->quality_auto, &r->s->quality_kept);
}

vit_status scene_quality_apply(const char *text, scene_quality *q, vit_text *why) {
    const place at = {.path = "quality", .folder = "", .why = why};
    config_t config;
    config_init(&config);
    bool fine = config_read_string(&config, text) == CONFIG_TRUE;
    if (fine)
        fine = merge_quality(&at, config_root_setting(&config), q, NULL, NULL);
    else
        (void)fields_fail(&at, NULL, "'%.200s': %s", text, config_error_text(&config));
    config_destroy(&config);
    return fine ? VIT_OK : VIT_BAD_INPUT;
}

void scene_quality_text(const scene_quality *q, char *text, size_t room) {
    const quality_group g = {.q = *q, .flattened = q->flatten > 0};
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; i < FIELD_COUNT(quality_fields); i++)
        if (i != QUALITY_AUTOMATIC && (i != QUALITY_FLATTEN || g.flattened))
            used += fields_write(&quality_fields[i], &g, text + used, room - used);
}

static const scene_quality default_quality = {.photons = 17000,
                                              .bounces = 4,
                                              .tile = 32,
                                              .indirect_samples = 16,
                                              .texture_filter = FILTER_BILINEAR,
                                              .vertex_bits = 32,
                                              .normal_bits = 16,
                                              .sample_bits = 32,
                                              .antialias = 1,
                                              .antialias_contrast = 0.06,
                                              .light_samples = 16,
                                              .sky_samples = 8,
                                              .specular_depth = 8,
                                              .caustics = true};

void scene_quality_difference(const scene_quality *q, char *text, size_t room) {
    const quality_group g = {.q = *q}, plain = {.q = default_quality};
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; i < FIELD_COUNT(quality_fields); i++) {
        char usual[64];
        if (!kept_bit(quality_fields[i].name))
            continue;
        const size_t written = fields_write(&quality_fields[i], &g, text + used, room - used);
        (void)fields_write(&quality_fields[i], &plain, usual, sizeof usual);
        used += strcmp(text + used, usual) != 0 ? written : 0;
        text[used] = '\0';
    }
}

/* libconfig knows no byte order mark. */
static bool read_text(config_t *config, const char *path) {
    char mark[3];
    FILE *file = fopen(path, "rb");
    if (!file)
        return false;
    if (fread(mark, 1, sizeof mark, file) != sizeof mark || memcmp(mark, SCENE_BOM, sizeof mark) != 0)
        rewind(file);
    const bool fine = config_read(config, file) == CONFIG_TRUE;
    (void)fclose(file);
    return fine;
}

/* missing: an include that is not there, "" if all are. */
static bool parse(const place *at, const char *missing, config_t *config) {
    config_set_include_dir(config, at->folder[0] ? at->folder : ".");
    if (read_text(config, at->path))
        return true;
    const char *text = config_error_text(config);
    const char *file = config_error_file(config);
    /* In [ ] all elements have one type, which nobody expects. */
    const bool mixed = text && strstr(text, "mismatched element type");
    const bool lost = missing[0] && text && strstr(text, "include");
    (void)snprintf(at->why->text, sizeof at->why->text, "%.200s:%d: %s%s%.100s%s", file ? file : at->path, config_error_line(config),
                   text ? text : "cannot be read", mixed ? ": write [0.0, 1.0, 0.5] or (0, 1, 0.5)" : lost ? ": '" : "", lost ? missing : "",
                   lost ? "' is not there" : "");
    for (char *c = at->why->text; *c; c++)
        if (iscntrl((unsigned char)*c))
            *c = '?';
    return false;
}

static bool read_top(reader *r, const config_setting_t *root) {
    uint32_t seen;
    return fields_read(&r->at, root, top_fields, FIELD_COUNT(top_fields), r->s, &seen) && read_output(r, root) &&
           read_sky(r, root) && reader_meshes(r, root) && reader_camera(r, root) && reader_lights(r, root) &&
           reader_materials(r, root) && reader_effects(r, root) && read_quality(r, root);
}

static void set_defaults(scene *s) {
    *s = (scene){.width = 1280, .height = 720, .frames = 48, .fps = 24.0, .camera_exposure = 1.0, .exposure_factor = 1.0, .check = true, .sky = {.scale = 1.0}};
    s->quality = default_quality;
    s->quality_auto = true;
}

static vit_status copy_path(scene *s, const char *path, vit_text *why) {
    if (strlen(path) < sizeof s->path) {
        memcpy(s->path, path, strlen(path) + 1);
        return VIT_OK;
    }
    (void)snprintf(why->text, sizeof why->text, "%.100s...: the path is longer than %d bytes", path, SCENE_PATH - 1);
    return VIT_BAD_INPUT;
}

/* What the mesh files in turn refer to is known when they are read. */
static void add_named_files(scene *s) {
    for (int i = 0; i < s->mesh_count; i++)
        inputs_add(&s->files, s->meshes[i].file);
    for (int i = 0; i < s->material_count; i++)
        inputs_add(&s->files, s->materials[i].texture);
    inputs_add(&s->files, s->sky.image);
}

vit_status scene_read(const char *path, scene *out, vit_text *why) {
    char folder[SCENE_PATH];
    set_defaults(out);
    if (copy_path(out, path, why) != VIT_OK)
        return VIT_BAD_INPUT;
    memcpy(folder, out->path, sizeof folder);
    char *slash = strrchr(folder, '/');
    folder[slash ? slash + 1 - folder : 0] = '\0';
    reader r = {.s = out, .at = {.path = out->path, .folder = folder, .why = why}};
    char missing[SCENE_PATH];
    if (!scene_files_check(&r.at, &out->files, missing)) {
        scene_free(out);
        return VIT_BAD_INPUT;
    }
    config_t config;
    config_init(&config);
    const bool fine = parse(&r.at, missing, &config) && read_top(&r, config_root_setting(&config));
    config_destroy(&config);
    if (fine) {
        add_named_files(out);
        return VIT_OK;
    }
    scene_free(out);
    return VIT_BAD_INPUT;
}

vit_status scene_for_mesh(const char *path, scene *out, vit_text *why) {
    set_defaults(out);
    if (copy_path(out, path, why) != VIT_OK)
        return VIT_BAD_INPUT;
    out->meshes = calloc(1, sizeof *out->meshes);
    if (!out->meshes) {
        (void)snprintf(why->text, sizeof why->text, "%.300s: out of memory", path);
        return VIT_FAILED;
    }
    const char *slash = strrchr(path, '/');
    (void)snprintf(out->name, sizeof out->name, "%.*s", SCENE_NAME - 1, slash ? slash + 1 : path);
    memcpy(out->meshes[0].file, out->path, sizeof out->path);
    for (int i = 0; i < 3; i++) {
        out->meshes[0].transform[i * 5] = 1.0;
        out->background[i] = 0.1; /* dark grey where the light shows white as 0.5: the unlit side has an outline */
    }
    out->mesh_count = 1;
    out->automatic = true;
    add_named_files(out);
    return VIT_OK;
}

void scene_free(scene *s) {
    for (int i = 0; i < s->light_count; i++)
        free(s->lights[i].keys);
    free(s->meshes);
    free(s->camera);
    free(s->lights);
    free(s->materials);
    inputs_free(&s->files);
    *s = (scene){0};
}
