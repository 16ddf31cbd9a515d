#include "scene/scene_reader.h"
#include "common/pi.h"
#include "vitrine_pack.h"
#include "common/strict_math.h"
#include <math.h>
#include <string.h>

enum { MAX_MESHES = 4096, MAX_MATERIALS = 4096 };

typedef struct mesh_placement {
    char file[SCENE_PATH];
    double scale[3], rotate[3], translate[3], unit;
    int up;
} mesh_placement;

enum { MESH_FILE };
static const config_field mesh_fields[] = {
    [MESH_FILE] = {"file", FIELD_PATH, offsetof(mesh_placement, file), NULL},
    {"scale", FIELD_SCALE, offsetof(mesh_placement, scale), COORDINATE},
    {"rotate", FIELD_VECTOR, offsetof(mesh_placement, rotate), COORDINATE},
    {"translate", FIELD_VECTOR, offsetof(mesh_placement, translate), COORDINATE},
    {"units", FIELD_AUTO, offsetof(mesh_placement, unit), "[1e-6, 1e6]"},
    {"up", FIELD_WORD, offsetof(mesh_placement, up), SCENE_UPS},
};

/* Right angles are exact: a box turned by 90 degrees keeps its vertices on the axes. */
static void sine_cosine(double degrees, double *sine, double *cosine) {
    const double turn = fmod(degrees, 360.0);
    const double quarter = turn / 90.0;
    if (quarter == floor(quarter)) {
        static const double sines[4] = {0.0, 1.0, 0.0, -1.0};
        const int q = ((int)quarter + 4) & 3;
        *sine = sines[q];
        *cosine = sines[(q + 1) & 3];
        return;
    }
    *sine = strict_sin(turn * PI / 180.0);
    *cosine = strict_cos(turn * PI / 180.0);
}

/* translate * Rz * Ry * Rx * scale, 3 x 4. */
static void place_mesh(const mesh_placement *p, double out[12]) {
    double s[3], c[3];
    for (int i = 0; i < 3; i++)
        sine_cosine(p->rotate[i], &s[i], &c[i]);
    const double r[9] = {
        c[2] * c[1],
        c[2] * s[1] * s[0] - s[2] * c[0],
        c[2] * s[1] * c[0] + s[2] * s[0],
        s[2] * c[1],
        s[2] * s[1] * s[0] + c[2] * c[0],
        s[2] * s[1] * c[0] - c[2] * s[0],
        -s[1],
        c[1] * s[0],
        c[1] * c[0],
    };
    for (int row = 0; row < 3; row++) {
        for (int k = 0; k < 3; k++)
            out[row * 4 + k] = r[row * 3 + k] * p->scale[k] + 0.0; /* + 0.0 turns -0 into 0 */
        out[row * 4 + 3] = p->translate[row];
    }
}

bool reader_meshes(reader *r, const config_setting_t *root) {
    config_setting_t *list;
    r->at.what[0] = '\0';
    if (!fields_list(&r->at, root, "meshes", MAX_MESHES, &list))
        return false;
    if (!list || config_setting_length(list) == 0)
        return fields_fail(&r->at, list ? list : root, "'meshes' must name at least one mesh");
    const int count = config_setting_length(list);
    if (!reader_allocate(r, &r->s->meshes, count, sizeof *r->s->meshes))
        return false;
    for (int i = 0; i < count; i++) {
        config_setting_t *group;
        mesh_placement p = {.scale = {1.0, 1.0, 1.0}};
        uint64_t seen;
        reader_at(r, "mesh", i);
        if (!fields_group(&r->at, list, i, &group) ||
            !fields_read(&r->at, group, mesh_fields, FIELD_COUNT(mesh_fields), &p, &seen))
            return false;
        if (!(seen & FIELD_BIT(MESH_FILE)) || !p.file[0])
            return fields_fail(&r->at, group, "needs a 'file'");
        for (int k = 0; k < 3; k++)
            if (fabs(p.scale[k]) < 1e-6)
                return fields_fail(&r->at, group, "'scale' must not be 0 (nor below 1e-6)");
        scene_mesh *mesh = &r->s->meshes[r->s->mesh_count++];
        memcpy(mesh->file, p.file, sizeof mesh->file);
        place_mesh(&p, mesh->transform);
        mesh->unit = p.unit;
        mesh->up = p.up;
        mesh->line = (int)config_setting_source_line(group);
    }
    return true;
}

enum {
    MATERIAL_NAME,
    MATERIAL_COLOR,
    MATERIAL_TEXTURE,
    MATERIAL_NORMAL_MAP,
    MATERIAL_EMISSION,
    MATERIAL_CUTOFF,
    MATERIAL_KIND,
    MATERIAL_SPECULAR,
    MATERIAL_EXPONENT,
    MATERIAL_ROUGHNESS,
    MATERIAL_IOR,
    MATERIAL_ABSORPTION,
    MATERIAL_AREA_LIGHT
};
static const config_field material_fields[] = {
    [MATERIAL_NAME] = {"name", FIELD_TEXT, offsetof(scene_material, name), NULL},
    [MATERIAL_COLOR] = {"color", FIELD_VECTOR, offsetof(scene_material, color), "[0, 1]"},
    [MATERIAL_TEXTURE] = {"texture", FIELD_PATH, offsetof(scene_material, texture), NULL},
    [MATERIAL_NORMAL_MAP] = {"normal_map", FIELD_PATH, offsetof(scene_material, normal_map), NULL},
    [MATERIAL_EMISSION] = {"emission", FIELD_VECTOR, offsetof(scene_material, emission), RADIOMETRIC},
    [MATERIAL_CUTOFF] = {"cutoff", FIELD_NUMBER, offsetof(scene_material, cutoff), "[0, 1]"},
    [MATERIAL_KIND] = {"kind", FIELD_WORD, offsetof(scene_material, kind), SCENE_MATERIAL_KINDS},
    [MATERIAL_SPECULAR] = {"specular", FIELD_VECTOR, offsetof(scene_material, specular), "[0, 1]"},
    [MATERIAL_EXPONENT] = {"exponent", FIELD_NUMBER, offsetof(scene_material, exponent), "[1, 1e4]"},
    [MATERIAL_ROUGHNESS] = {"roughness", FIELD_NUMBER, offsetof(scene_material, roughness), "[0, 1]"},
    [MATERIAL_IOR] = {"ior", FIELD_NUMBER, offsetof(scene_material, ior), "[1, 10]"},
    [MATERIAL_ABSORPTION] = {"absorption", FIELD_VECTOR, offsetof(scene_material, absorption), RADIOMETRIC},
    [MATERIAL_AREA_LIGHT] = {"area_light", FIELD_SWITCH, offsetof(scene_material, area_light), NULL},
};

/* Settings that a material of the kind that it states has no use for. */
static bool check_material(const config_place *at, const config_setting_t *group, const scene_material *m, uint64_t seen) {
    static const struct {
        int setting;
        uint32_t kinds; /* a bit a kind that has it */
    } rules[] = {{MATERIAL_COLOR, 1u << VIT_MATTE},      {MATERIAL_EMISSION, 1u << VIT_MATTE},
                 {MATERIAL_EXPONENT, 1u << VIT_MATTE},   {MATERIAL_ROUGHNESS, 1u << VIT_MATTE},
                 {MATERIAL_AREA_LIGHT, 1u << VIT_MATTE}, {MATERIAL_IOR, 1u << VIT_GLASS | 1u << VIT_THIN_GLASS},
                 {MATERIAL_ABSORPTION, 1u << VIT_GLASS}};
    for (size_t i = 0; (seen & FIELD_BIT(MATERIAL_KIND)) && i < sizeof rules / sizeof *rules; i++)
        if ((seen & FIELD_BIT(rules[i].setting)) && !(rules[i].kinds & 1u << m->kind))
            return fields_fail(at, group, "'%s' does nothing for this 'kind'", material_fields[rules[i].setting].name);
    if ((seen & FIELD_BIT(MATERIAL_ROUGHNESS)) && (seen & FIELD_BIT(MATERIAL_EXPONENT)))
        return fields_fail(at, group, "'exponent' is of a Phong lobe and 'roughness' of a GGX one: state either");
    return true;
}

bool reader_materials(reader *r, const config_setting_t *root) {
    config_setting_t *list, *group;
    r->at.what[0] = '\0';
    if (!fields_list(&r->at, root, "materials", MAX_MATERIALS, &list))
        return false;
    const int count = list ? config_setting_length(list) : 0;
    if (!reader_allocate(r, &r->s->materials, count, sizeof *r->s->materials))
        return false;
    for (int i = 0; i < count; i++) {
        scene_material *material = &r->s->materials[i];
        uint64_t seen;
        reader_at(r, "material", i);
        if (!fields_group(&r->at, list, i, &group) ||
            !fields_read(&r->at, group, material_fields, FIELD_COUNT(material_fields), material, &seen))
            return false;
        if (!(seen & FIELD_BIT(MATERIAL_NAME)))
            return fields_fail(&r->at, group, "needs a 'name'");
        for (int k = 0; k < i; k++)
            if (!strcmp(r->s->materials[k].name, material->name))
                return fields_fail(&r->at, group, "'%s' was already given as material %d", material->name, k + 1);
        material->has_color = seen & FIELD_BIT(MATERIAL_COLOR);
        material->has_texture = seen & FIELD_BIT(MATERIAL_TEXTURE);
        material->has_normal_map = seen & FIELD_BIT(MATERIAL_NORMAL_MAP);
        material->has_emission = seen & FIELD_BIT(MATERIAL_EMISSION);
        if (!check_material(&r->at, group, material, seen))
            return false;
        material->has_cutoff = seen & FIELD_BIT(MATERIAL_CUTOFF);
        material->has_kind = seen & FIELD_BIT(MATERIAL_KIND);
        material->has_specular = seen & FIELD_BIT(MATERIAL_SPECULAR);
        material->has_exponent = seen & FIELD_BIT(MATERIAL_EXPONENT);
        material->has_roughness = seen & FIELD_BIT(MATERIAL_ROUGHNESS);
        material->has_ior = seen & FIELD_BIT(MATERIAL_IOR);
        material->has_absorption = seen & FIELD_BIT(MATERIAL_ABSORPTION);
        material->has_area_light = seen & FIELD_BIT(MATERIAL_AREA_LIGHT);
        material->line = (int)config_setting_source_line(group);
        r->s->material_count = i + 1;
    }
    return true;
}
