#include "import/importer.h"
#include "common/pi.h"
#include "import/light_units.h"
#include <math.h>
#include <string.h>

void import_transform_point(const double m[12], const double v[3], double out[3]) {
    for (int i = 0; i < 3; i++)
        out[i] = m[4 * i] * v[0] + m[4 * i + 1] * v[1] + m[4 * i + 2] * v[2] + m[4 * i + 3];
}

void import_transform_vector(const double m[12], const double v[3], double out[3]) {
    for (int i = 0; i < 3; i++)
        out[i] = m[4 * i] * v[0] + m[4 * i + 1] * v[1] + m[4 * i + 2] * v[2];
}

/* False: it has no length, or is not finite. */
static bool normalise(double v[3]) {
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++)
        v[i] /= length;
    return length > 0.0 && isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

static bool finite_point(const double p[3]) {
    return isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]);
}

bool import_add_camera(importer *im, const model_camera *camera, const double forward[3], bool orthographic) {
    model *m = im->m;
    model_camera c = *camera;
    double along[3] = {forward[0], forward[1], forward[2]};
    if (!finite_point(c.eye) || !normalise(along) || !normalise(c.up)) {
        return import_not_done(im, "camera '%.100s' has no direction; it is left out", c.name);
    }
    c.fov = orthographic || !(c.fov > 1.0 && c.fov < 170.0) ? 0.0 : c.fov;
    if (c.fov == 0.0 &&
        !import_not_done(im, "camera '%.100s' %s: its view is a perspective of 60 degrees", c.name,
                         orthographic ? "is orthographic, which ours are not" : "has no field of view that ours could have"))
        return false;
    for (int k = 0; k < 3; k++)
        c.target[k] = c.eye[k] + along[k];
    size_t room = (size_t)m->camera_count;
    if (!import_room(im, &m->cameras, &room, room + 1, sizeof c))
        return false;
    m->cameras[m->camera_count++] = c;
    return true;
}

/* What is wrong with the cone, or NULL. */
static const char *settle_cone(model_light *l, double widest) {
    if (!(l->inner >= 0.0) || !(l->outer > 0.0 && l->outer <= widest))
        return "has a cone that is none";
    if (l->inner > l->outer)
        return "has a cone whose inner angle is more than its outer";
    l->outer = fmin(l->outer, 90.0);
    l->inner = fmin(l->inner, l->outer);
    return NULL;
}

/* What keeps the light from being one of ours, or NULL. */
static const char *settle_light(const importer *im, model_light *l, double widest) {
    const bool directional = l->kind == (int)VIT_LIGHT_DIRECTIONAL, spot = l->kind == (int)VIT_LIGHT_SPOT;
    if (!finite_point(l->position))
        return "stands at no finite place";
    if ((directional || spot) && !normalise(l->direction))
        return "has no direction";
    const char *fault = spot ? settle_cone(l, widest) : NULL;
    if (fault)
        return fault;
    l->states_unit = im->states_units;
    for (int i = 0; i < 3; i++) {
        l->power[i] = (directional ? 1.0 : 4.0 * PI) * l->stated[i] * light_units_of_light(im->s, im->states_units);
        if (!isfinite(l->power[i]))
            return "has an intensity that is not finite";
        if (l->power[i] < 0.0)
            return "has a negative intensity";
    }
    return NULL;
}

bool import_add_light(importer *im, const model_light *light, double widest) {
    model *m = im->m;
    model_light l = *light;
    const char *fault = settle_light(im, &l, widest);
    if (fault)
        return import_not_done(im, "light '%.100s' %s; it is left out", l.name, fault);
    size_t room = (size_t)m->light_count;
    if (!import_room(im, &m->lights, &room, room + 1, sizeof l))
        return false;
    m->lights[m->light_count++] = l;
    return true;
}

const model_camera *model_camera_named(const model *m, const char *name) {
    for (int i = 0; i < m->camera_count; i++)
        if (!strcmp(m->cameras[i].name, name))
            return &m->cameras[i];
    for (int i = 0; i < m->camera_count; i++)
        if (!strcmp(m->cameras[i].parent, name))
            return &m->cameras[i];
    return NULL;
}

const model_light *model_light_named(const model *m, const char *name) {
    for (int i = 0; i < m->light_count; i++)
        if (!strcmp(m->lights[i].name, name))
            return &m->lights[i];
    for (int i = 0; i < m->light_count; i++)
        if (!strcmp(m->lights[i].parent, name))
            return &m->lights[i];
    return NULL;
}
