/* glTF on any bytes, in this process: what is refused is our own code's doing as well, and the fuzzer sees its way through it.
 * What is accepted must be a model as model.h has it. */
#include "fuzz.h"
#include "import/model.h"
#include "vitrine_pack.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void warned(void *user, const char *line) {
    (void)user;
    fuzz_one_line(line, 4096);
}

static void check_vertices(const model *m) {
    for (size_t i = 0; i < m->vertices; i++) {
        const float *n = m->normal + 3 * i;
        for (size_t k = 0; k < 3; k++)
            FUZZ_HOLDS((double)m->position[3 * i + k] >= m->lo[k] && (double)m->position[3 * i + k] <= m->hi[k]);
        FUZZ_HOLDS(fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1.0f) < 1e-4f);
        FUZZ_HOLDS(isfinite(m->uv[2 * i]) && isfinite(m->uv[2 * i + 1]));
    }
}

static void check_materials(const model *m) {
    uint64_t uses = 0;
    for (int i = 0; i < m->material_count; i++) {
        const model_material *k = &m->materials[i];
        for (int c = 0; c < 3; c++)
            FUZZ_HOLDS(k->albedo[c] >= 0.0f && k->albedo[c] + k->specular[c] <= 1.0f + 1e-6f && k->emission[c] >= 0.0f);
        FUZZ_HOLDS(k->image >= -1 && k->image < m->image_count && k->cutoff >= 0.0f && k->cutoff <= 1.0f);
        FUZZ_HOLDS(k->ior >= VIT_MIN_IOR && k->ior <= VIT_MAX_IOR && k->exponent >= 1.0f && k->exponent <= VIT_MAX_EXPONENT);
        uses += k->triangles;
    }
    FUZZ_HOLDS(uses == m->triangles);
}

static void check_model(const model *m) {
    FUZZ_HOLDS(m->triangles >= 1 && m->vertices >= 1 && m->material_count >= 1);
    check_vertices(m);
    check_materials(m);
    for (size_t i = 0; i < m->triangles; i++) {
        FUZZ_HOLDS(m->material[i] < (uint32_t)m->material_count);
        for (size_t k = 0; k < 3; k++)
            FUZZ_HOLDS(m->index[3 * i + k] < m->vertices);
    }
    for (int i = 0; i < m->light_count; i++)
        FUZZ_HOLDS(isfinite(m->lights[i].power[0]) && isfinite(m->lights[i].position[0]) &&
                   isfinite(m->lights[i].direction[0]));
    for (int i = 0; i < m->camera_count; i++)
        FUZZ_HOLDS(isfinite(m->cameras[i].eye[0]) && isfinite(m->cameras[i].target[0]) && isfinite(m->cameras[i].fov));
}

/* glTF 1 is read by a library that is to run in a child alone. */
static bool is_old(const uint8_t *data, size_t size) {
    static const char key[] = "\"version\"";
    for (size_t i = 0; i + 5 <= size; i++)
        if (memcmp(data + i, "glTF\1", 5) == 0)
            return true;
    for (size_t i = 0; i + sizeof key - 1 < size; i++) {
        size_t at = i + sizeof key - 1;
        if (memcmp(data + i, key, sizeof key - 1) != 0)
            continue;
        while (at < size && memchr(" \t\r\n:\"0+", data[at], 8))
            at++;
        if (at < size && (data[at] == '1' || data[at] == '.'))
            return true;
    }
    return false;
}

void fuzz_gltf(const uint8_t *data, size_t size) {
    static const char *const names[] = {"mesh.gltf", "mesh.glb", "mesh.bin", "a.webp", "a.png", "a.tga", NULL};
    fuzz_files f = {.names = names};
    vit_text why = {""};
    scene s;
    model m;
    fuzz_write_files(&f, data, size);
    if (is_old(data, size) || !(strstr(f.main, ".gltf") || strstr(f.main, ".glb")))
        return;
    FUZZ_HOLDS(scene_for_mesh(f.main, &s, &why) == VIT_OK);
    const vit_status status = model_import_here(&s, MODEL_LISTS, warned, NULL, &m, &why);
    if (status == VIT_OK)
        check_model(&m);
    else
        fuzz_one_line(why.text, sizeof why.text);
    model_free(&m);
    scene_free(&s);
}
