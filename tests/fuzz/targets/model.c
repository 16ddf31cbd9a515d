/* A mesh file through the reader that it is for, in this process: what is refused is our own code's doing as well, and the
 * fuzzer sees its way through it. What is accepted must be a model as model.h has it. */
#include "fuzz.h"
#include "import/model.h"
#include "vitrine_pack.h"

#include <math.h>

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
        FUZZ_HOLDS(!MODEL_HAS_NORMAL_MAP(k) || (k->normal_image >= 0 && k->normal_image < m->image_count));
        FUZZ_HOLDS(fabsf(k->normal_scale) <= VIT_MAX_NORMAL_SCALE && k->normal_wrap_u <= VIT_WRAP_MIRROR);
        FUZZ_HOLDS(k->ior >= VIT_MIN_IOR && k->ior <= VIT_MAX_IOR && k->exponent >= 1.0f && k->exponent <= VIT_MAX_EXPONENT);
        FUZZ_HOLDS(k->lobe_alpha == 0.0f || (k->lobe_alpha >= VIT_MIN_ALPHA && k->lobe_alpha <= 1.0f));
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

void fuzz_import(const char *file) {
    vit_text why = {""};
    scene s;
    model m;
    FUZZ_HOLDS(scene_for_mesh(file, &s, &why) == VIT_OK);
    const vit_status status = model_import_here(&s, MODEL_LISTS, warned, NULL, &m, &why);
    if (status == VIT_OK)
        check_model(&m);
    else
        fuzz_one_line(why.text, sizeof why.text);
    model_free(&m);
    scene_free(&s);
}
