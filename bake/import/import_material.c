#include "import/importer.h"
#include "import/light_units.h"
#include <stdio.h>
#include <string.h>

#define DEFAULT_IOR 1.5f /* of glass, where nothing says it */

float import_clamp(float value, float most) {
    return value > 0.0f ? (value < most ? value : most) : 0.0f; /* NaN is 0 */
}

/* Glass is no hole: what the file says of its opacity was another way to say glass. */
void import_make_glass(model_material *m, uint32_t kind, float ior) {
    m->kind = kind;
    m->ior = ior >= VIT_MIN_IOR ? (ior < VIT_MAX_IOR ? ior : VIT_MAX_IOR) : DEFAULT_IOR;
    m->alpha = 1.0f;
    m->cutoff = 0.0f;
}

void import_emission(const importer *im, model_material *m, const float color[3], float strength) {
    for (int i = 0; i < 3; i++)
        m->emission[i] = import_clamp((float)((double)(color[i] * strength) * light_units_of_emission(im->s)), 1e9f);
    m->emits_by_file = color[0] > 0.0f || color[1] > 0.0f || color[2] > 0.0f;
    m->states_unit = im->states_units;
}

/* The first ones, as they are. A normal map of others has no place then. */
static void plain_coordinates(material_use *use) {
    if (use->uv_set != 0 || use->has_transform)
        use->m.normal_scale = 0.0f;
    use->uv_set = 0;
    use->has_transform = false;
}

/* What the scene file says beats what the mesh says. */
static void apply_override(importer *im, material_use *use) {
    for (int i = 0; i < im->s->material_count; i++) {
        const scene_material *o = &im->s->materials[i];
        if (strcmp(o->name, use->m.name) != 0)
            continue;
        im->override_used[i] = true;
        use->has_plain = use->has_plain && !o->has_color;
        for (int k = 0; k < 3 && o->has_color; k++)
            use->m.albedo[k] = import_clamp((float)o->color[k], VIT_MAX_ALBEDO);
        for (int k = 0; k < 3 && o->has_emission; k++)
            use->m.emission[k] = (float)o->emission[k];
        use->m.emits_by_file = use->m.emits_by_file && !o->has_emission;
        import_override_specular(im, &use->m, o);
        if (o->has_area_light)
            use->m.area_light = o->area_light;
        if (o->has_cutoff) {
            use->m.cutoff = (float)o->cutoff;
            use->cutoff_asked = true;
        }
        if (o->has_texture) {
            memcpy(use->image, o->texture, sizeof use->image);
            use->image_resolved = true;
            use->image_line = o->line;
            use->m.wrap_u = use->m.wrap_v = VIT_WRAP_REPEAT;
            if (o->texture[0]) /* it lies otherwise than the file's did, if that had other coordinates */
                plain_coordinates(use);
        }
        if (o->has_normal_map) {
            memcpy(use->normal, o->normal_map, sizeof use->normal);
            use->normal_resolved = true;
            use->image_line = o->line;
            use->m.normal_wrap_u = use->m.normal_wrap_v = VIT_WRAP_REPEAT;
            if (!use->image[0])
                plain_coordinates(use);
            use->m.normal_scale = o->normal_map[0] ? 1.0f : 0.0f;
        }
    }
}

/* For one more use, of material `source`. */
static bool room_for(importer *im, unsigned source) {
    const size_t had = im->use_of_room;
    if (!import_room(im, &im->use_of, &im->use_of_room, (size_t)source + 1, sizeof *im->use_of) ||
        !import_room(im, &im->uses, &im->use_room, im->use_count + 1, sizeof *im->uses))
        return false;
    memset(im->use_of + had, 0, (im->use_of_room - had) * sizeof *im->use_of);
    return true;
}

void import_forget_materials(importer *im) {
    while (im->use_count > 0)
        im->use_of[im->uses[--im->use_count].source] = 0;
}

bool import_material(importer *im, unsigned source, const float *tint, material_use **use) {
    static const float white[3] = {1.0f, 1.0f, 1.0f};
    const bool tinted = tint != NULL;
    tint = tint ? tint : white;
    for (uint32_t i = source < im->use_of_room ? im->use_of[source] : 0; i > 0; i = (*use)->before) {
        *use = &im->uses[i - 1];
        if ((*use)->tinted == tinted && !memcmp((*use)->tint, tint, sizeof(*use)->tint))
            return true;
    }
    if (!room_for(im, source))
        return false;
    *use = &im->uses[im->use_count++];
    **use = (material_use){.source = source,
                           .before = im->use_of[source],
                           .tinted = tinted,
                           .index = -1,
                           .alpha_by_letter = -1.0f,
                           .m = {.image = -1, .alpha = 1.0f, .exponent = 1.0f, .ior = 1.0f, .area_light = true}};
    im->use_of[source] = (uint32_t)im->use_count;
    memcpy((*use)->tint, tint, sizeof(*use)->tint);
    if (!im->format->material(im, *use))
        return false;
    apply_override(im, *use);
    import_settle_specular(&(*use)->m);
    import_settle_holes(im, *use);
    return true;
}

static bool has_alpha(const model_image *image, float factor, float cutoff) {
    const size_t texels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; cutoff > 0.0f && i < texels; i++)
        if ((float)image->rgba[4 * i + 3] / 255.0f * factor < cutoff)
            return true;
    return false;
}

/* What is wrong with an image that the scene file names is told of with its line. */
static bool take_texture(importer *im, const material_use *use, bool normal, int *image) {
    const char *file = im->file;
    const bool resolved = normal ? use->normal_resolved : use->image_resolved;
    char where[SCENE_PATH + 16];
    (void)snprintf(where, sizeof where, "%.*s:%d", SCENE_PATH - 1, im->s->path, use->image_line);
    im->file = resolved ? where : file;
    const bool fine = import_texture(im, normal ? use->normal : use->image, resolved, use->m.name,
                                     normal ? "done without it" : IMPORT_PLAIN_COLOR, image);
    im->file = file;
    return fine;
}

/* Where the map is missing there is none. */
static bool take_normal_map(importer *im, material_use *use) {
    int image;
    if (!MODEL_HAS_NORMAL_MAP(&use->m))
        return true;
    if (!take_texture(im, use, true, &image))
        return false;
    use->m.normal_image = image;
    use->m.normal_scale = image >= 0 ? use->m.normal_scale : 0.0f;
    return true;
}

bool import_material_index(importer *im, material_use *use, uint32_t *index) {
    model *m = im->m;
    if (use->index < 0) {
        const bool seen = use->m.albedo[0] > 0 || use->m.albedo[1] > 0 || use->m.albedo[2] > 0 || use->m.cutoff > 0;
        if ((use->image[0] && seen && !take_texture(im, use, false, &use->m.image)) || !take_normal_map(im, use))
            return false;
        if (use->m.image < 0 && use->has_plain)
            memcpy(use->m.albedo, use->plain, sizeof use->plain);
        /* Without a hole there is no cut-out to pay for. */
        if (use->m.image < 0 || !has_alpha(&m->images[use->m.image], use->m.alpha, use->m.cutoff))
            use->m.cutoff = 0.0f;
        if (!import_room(im, &m->materials, &im->material_room, (size_t)m->material_count + 1, sizeof *m->materials))
            return false;
        use->index = m->material_count++;
        m->materials[use->index] = use->m;
    }
    *index = (uint32_t)use->index;
    return true;
}
