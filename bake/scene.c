#include "scene_reader.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum {
    MAX_FILE = 16 << 20,
    MAX_DEPTH = 10,
    MAX_INCLUDES = 256
}; /* bytes a file; libconfig's own depth of includes; all of a scene */

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
    bool flattened;
} quality_group;

enum { QUALITY_FLATTEN };
static const field quality_fields[] = {
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

/* Puts the group's settings over *q. */
static bool merge_quality(const place *at, const config_setting_t *group, scene_quality *q) {
    quality_group g = {.q = *q, .flattened = q->flatten > 0};
    uint32_t seen = 0;
    if (!fields_read(at, group, quality_fields, FIELD_COUNT(quality_fields), &g, &seen))
        return false;
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
    return !group || merge_quality(&r->at, group, &r->s->quality);
}

vit_status scene_quality_apply(const char *text, scene_quality *q, vit_text *why) {
    const place at = {.path = "quality", .folder = "", .why = why};
    config_t config;
    config_init(&config);
    bool fine = config_read_string(&config, text) == CONFIG_TRUE;
    if (fine)
        fine = merge_quality(&at, config_root_setting(&config), q);
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
        if (i != QUALITY_FLATTEN || g.flattened)
            used += fields_write(&quality_fields[i], &g, text + used, room - used);
}

/* Name between the quotes of an @include line; empty if libconfig would read another one than stands there: with zero bytes,
 * escapes or line feeds in it. False if the line is no @include. */
static bool include_name(const char *line, size_t length, char *name, size_t room) {
    const char *end = line + length;
    line += strspn(line, " \t");
    if (strncmp(line, "@include", 8) != 0)
        return false;
    line += 8;
    line += strspn(line, " \t");
    if (*line != '"')
        return false;
    const size_t used = strcspn(++line, "\"\\");
    const bool plain = line + used < end && line[used] == '"' && used < room;
    (void)snprintf(name, room, "%.*s", plain ? (int)used : 0, line);
    return true;
}

/* The files of a scene. */
typedef struct sources {
    inputs *files;
    int left; /* includes that may follow: files that include the next one twice each make 2^depth of them */
} sources;

static bool check_file(const place *at, const char *path, int depth, sources *all);

/* libconfig hands includes to a scanner that ends the whole process on a folder or a device: look first. */
static bool check_includes(const place *at, const char *path, FILE *file, int depth, sources *all) {
    char *line = NULL;
    size_t size = 0;
    bool fine = true;
    ssize_t length;
    for (unsigned number = 1; fine && (length = getline(&line, &size, file)) >= 0; number++) {
        char name[SCENE_PATH], full[2 * SCENE_PATH];
        if (!include_name(line, (size_t)length, name, sizeof name))
            continue;
        struct stat st;
        const int used = snprintf(full, sizeof full, "%s%s", at->folder, name);
        const bool below = name[0] && name[0] != '/' && used > 0 && used < SCENE_PATH;
        if (!below || depth >= MAX_DEPTH || all->left == 0) {
            (void)snprintf(at->why->text, sizeof at->why->text, "%.300s:%u: %s", path, number,
                           !below               ? "@include takes a path below the scene's folder"
                           : depth >= MAX_DEPTH ? "@include goes deeper than 10 files"
                                                : "more than 256 files are included");
            fine = false;
        } else if (stat(full, &st) == 0) { /* a missing one is libconfig's to report, unless a comment holds it */
            --all->left;
            fine = check_file(at, full, depth + 1, all);
        }
    }
    free(line);
    return fine;
}

static bool check_file(const place *at, const char *path, int depth, sources *all) {
    struct stat st;
    place here = *at;
    here.path = path;
    if (stat(path, &st) != 0)
        return fields_fail(&here, NULL, "cannot be read");
    if (!S_ISREG(st.st_mode))
        return fields_fail(&here, NULL, "is not a file");
    if (st.st_size > MAX_FILE)
        return fields_fail(&here, NULL, "is larger than %d MiB", MAX_FILE >> 20);
    FILE *file = fopen(path, "r");
    if (!file)
        return fields_fail(&here, NULL, "cannot be read");
    inputs_add(all->files, path);
    const bool fine = check_includes(at, path, file, depth, all);
    (void)fclose(file);
    return fine;
}

static bool parse(const place *at, config_t *config) {
    config_set_include_dir(config, at->folder[0] ? at->folder : ".");
    if (config_read_file(config, at->path) == CONFIG_TRUE)
        return true;
    const char *text = config_error_text(config);
    const char *file = config_error_file(config);
    /* In [ ] all elements have one type, which nobody expects. */
    const bool mixed = text && strstr(text, "mismatched element type");
    (void)snprintf(at->why->text, sizeof at->why->text, "%s:%d: %s%s", file ? file : at->path, config_error_line(config),
                   text ? text : "cannot be read", mixed ? ": write [0.0, 1.0, 0.5] or (0, 1, 0.5)" : "");
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
    *s = (scene){.width = 1280, .height = 720, .frames = 48, .fps = 24.0, .camera_exposure = 1.0, .check = true, .sky = {.scale = 1.0}};
    s->quality = (scene_quality){.photons = 17000,
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
                                 .sky_samples = 16,
                                 .specular_depth = 8,
                                 .caustics = true};
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
    sources all = {&out->files, MAX_INCLUDES};
    if (!check_file(&r.at, path, 0, &all)) {
        scene_free(out);
        return VIT_BAD_INPUT;
    }
    config_t config;
    config_init(&config);
    const bool fine = parse(&r.at, &config) && read_top(&r, config_root_setting(&config));
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
