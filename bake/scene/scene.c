#include "scene/scene_files.h"
#include "common/fail.h"
#include "scene/scene_reader.h"
#include "scene/scene_text.h"
#include "scene/setting_rows.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const config_field top_fields[] = {
    {"name", FIELD_TEXT, offsetof(scene, name), NULL},
    {"background", FIELD_VECTOR, offsetof(scene, background), RADIOMETRIC},
    {"ambient", FIELD_VECTOR, offsetof(scene, ambient), RADIOMETRIC},
    {"ambient_radius", FIELD_NUMBER, offsetof(scene, ambient_radius), "[0, 1e6]"},
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

static const config_field output_fields[] = {
    {"width", FIELD_WHOLE, offsetof(scene, width), "[1, 7680]"},
    {"height", FIELD_WHOLE, offsetof(scene, height), "[1, 4320]"},
    {"fps", FIELD_NUMBER, offsetof(scene, fps), "(0, 1000]"},
    {"frames", FIELD_WHOLE, offsetof(scene, frames), "[1, 100000]"},
};

enum { SKY_IMAGE, SKY_SCALE, SKY_ROTATE, SKY_LIGHT };
static const config_field sky_fields[] = {
    [SKY_IMAGE] = {"image", FIELD_PATH, offsetof(scene_sky, image), NULL},
    [SKY_SCALE] = {"scale", FIELD_NUMBER, offsetof(scene_sky, scale), "[0, 1e6]"},
    [SKY_ROTATE] = {"rotate", FIELD_NUMBER, offsetof(scene_sky, rotate), "[-360, 360]"},
    [SKY_LIGHT] = {"light", FIELD_SWITCH, offsetof(scene_sky, light), NULL},
};

/* The settings, and beside them whether "auto" chooses the rest. */
typedef struct quality_group {
    scene_quality q;
    bool automatic;
} quality_group;

static const config_field quality_fields[] = {
#define SETTING(type, member, word, kind, usual, allowed, ...) {word, kind, offsetof(quality_group, q.member), allowed},
#include "scene/settings.inc"
#undef SETTING
    {"auto", FIELD_SWITCH, offsetof(quality_group, automatic), NULL},
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
    uint64_t seen;
    reader_at(r, "output", -1);
    return !group || fields_read(&r->at, group, output_fields, FIELD_COUNT(output_fields), r->s, &seen);
}

static bool read_sky(reader *r, const config_setting_t *root) {
    const config_setting_t *group = config_setting_get_member(root, "sky");
    scene *s = r->s;
    scene_sky *sky = &s->sky;
    uint64_t seen;
    reader_at(r, "sky", -1);
    if (!group)
        return true;
    if (!fields_read(&r->at, group, sky_fields, FIELD_COUNT(sky_fields), sky, &seen))
        return false;
    sky->line = (int)config_setting_source_line(group);
    if (!sky->image[0] && (seen & (FIELD_BIT(SKY_SCALE) | FIELD_BIT(SKY_ROTATE))))
        return fields_fail(&r->at, group, "'scale' and 'rotate' are for an 'image'");
    if (!(seen & FIELD_BIT(SKY_LIGHT)))
        sky->light = sky->image[0] != '\0';
    if (sky->light && !sky->image[0] && !(s->background[0] > 0 || s->background[1] > 0 || s->background[2] > 0))
        return fields_fail(&r->at, group, "'light' needs an 'image', or a 'background' that is not black");
    return true;
}

/* Puts the group's settings over *q. *automatic and *kept: as in `scene`; may be NULL. */
static bool merge_quality(const config_place *at, const config_setting_t *group, scene_quality *q, bool *automatic,
                          uint64_t *kept) {
    quality_group g = {.q = *q};
    vit_text fault;
    uint64_t seen = 0;
    if (!fields_read(at, group, quality_fields, FIELD_COUNT(quality_fields), &g, &seen))
        return false;
    if (g.automatic && !automatic)
        return fields_fail(at, group, "'auto' is not for here");
    if ((seen & SETTING_BIT(flatten)) && !g.q.flattened)
        return fields_fail(at, group, "'flatten' needs kernel \"flattened\"");
    if (!settings_agree(&g.q, &fault))
        return fields_fail(at, group, "%s", fault.text);
    if (kept)
        *kept |= seen & (((uint64_t)1 << SETTINGS) - 1);
    if (automatic)
        *automatic = g.automatic;
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
    const config_place at = {.path = "quality", .folder = "", .why = why};
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
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; i < SETTINGS; i++)
        if (i != SETTING_AT_flatten || q->flattened)
            used += fields_write(&setting_rows[i].field, q, text + used, room - used);
}

void scene_quality_difference(const scene_quality *q, char *text, size_t room) {
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; i < SETTINGS; i++) {
        char usual[64];
        if (!(setting_rows[i].marks & SETTING_CHOSEN))
            continue;
        const size_t written = fields_write(&setting_rows[i].field, q, text + used, room - used);
        (void)fields_write(&setting_rows[i].field, &settings_default, usual, sizeof usual);
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
static bool parse(const config_place *at, const char *missing, config_t *config) {
    config_set_include_dir(config, at->folder[0] ? at->folder : ".");
    if (read_text(config, at->path))
        return true;
    const char *text = config_error_text(config);
    const char *file = config_error_file(config);
    /* In [ ] all elements have one type, which nobody expects. */
    const bool mixed = text && strstr(text, "mismatched element type");
    const bool lost = missing[0] && text && strstr(text, "include");
    (void)bake_fail_plain(at->why, VIT_BAD_INPUT, "%.200s:%d: %s%s%.100s%s", file ? file : at->path, config_error_line(config),
                          text ? text : "cannot be read",
                          mixed  ? ": write [0.0, 1.0, 0.5] or (0, 1, 0.5)"
                          : lost ? ": '"
                                 : "",
                          lost ? missing : "", lost ? "' is not there" : "");
    return false;
}

static bool read_top(reader *r, const config_setting_t *root) {
    uint64_t seen;
    return fields_read(&r->at, root, top_fields, FIELD_COUNT(top_fields), r->s, &seen) && read_output(r, root) &&
           read_sky(r, root) && reader_meshes(r, root) && reader_camera(r, root) && reader_lights(r, root) &&
           reader_materials(r, root) && reader_effects(r, root) && read_quality(r, root);
}

static void set_defaults(scene *s) {
    *s = (scene){.width = 1280,
                 .height = 720,
                 .frames = 48,
                 .fps = 24.0,
                 .camera_exposure = 1.0,
                 .exposure_factor = 1.0,
                 .check = true,
                 .sky = {.scale = 1.0}};
    s->quality = settings_default;
    s->quality_auto = true;
}

static vit_status copy_path(scene *s, const char *path, vit_text *why) {
    if (strlen(path) < sizeof s->path) {
        memcpy(s->path, path, strlen(path) + 1);
        return VIT_OK;
    }
    return bake_fail(why, VIT_BAD_INPUT, "%.100s...: the path is longer than %d bytes", path, SCENE_PATH - 1);
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
        return bake_fail(why, VIT_FAILED, "%.300s: out of memory", path);
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
