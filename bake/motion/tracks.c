#include "motion/tracks.h"
#include "common/pi.h"
#include "motion/curves.h"
#include "common/names.h"
#include "common/strict_math.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- vectors ---- */

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* False: too short to have a direction. */
static bool normalize(double v[3]) {
    const double length = sqrt(dot(v, v));
    if (!(length > 1e-9))
        return false;
    for (int i = 0; i < 3; i++)
        v[i] /= length;
    return true;
}

static vit_status refuse(const scene *s, int line, vit_text *why, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
static vit_status refuse(const scene *s, int line, vit_text *why, const char *format, ...) {
    va_list args;
    int used = line > 0 ? snprintf(why->text, sizeof why->text, "%.200s:%d: ", s->path, line)
                        : snprintf(why->text, sizeof why->text, "%.200s: ", s->path);
    if (used < 0)
        used = 0;
    va_start(args, format);
    (void)vsnprintf(why->text + used, sizeof why->text - (size_t)used, format, args);
    va_end(args);
    return VIT_BAD_INPUT;
}

/* ---- camera ---- */

typedef struct view {
    double eye[3], target[3], up[3], fov, exposure; /* as scene_camera_key */
} view;

/* The view as the kernels take it. `up` is the last frame's image-up axis, or zero before the first: it stands in where the
 * path passes straight over its target and the keys' own up says nothing. */
static bool make_camera(const scene *s, const view *v, double up[3], vit_camera *out) {
    double forward[3], right[3], wanted[3];
    for (int i = 0; i < 3; i++)
        forward[i] = v->target[i] - v->eye[i];
    if (!normalize(forward))
        return false;
    memcpy(wanted, v->up, sizeof wanted);
    (void)normalize(wanted);
    cross(forward, wanted, right);
    if (dot(right, right) < 1e-8) {
        double axis[3] = {0.0, 0.0, 0.0};
        axis[fabs(forward[1]) < 0.5 ? 1 : 2] = 1.0;
        cross(forward, dot(up, up) > 0.0 ? up : axis, right);
        if (dot(right, right) < 1e-8)
            cross(forward, axis, right);
    }
    (void)normalize(right);
    cross(right, forward, up);
    const double pixel = 2.0 * strict_tan(v->fov * PI / 360.0) / (double)s->height; /* at distance 1 */
    const double exposure = s->exposure_fixed > 0.0 ? s->exposure_fixed : v->exposure;
    *out = (vit_camera){.exposure = (float)(s->exposure_factor > 0.0 ? exposure * s->exposure_factor : exposure)};
    for (int i = 0; i < 3; i++) {
        out->eye[i] = (float)v->eye[i];
        out->right[i] = (float)(pixel * right[i]);
        out->down[i] = (float)(-pixel * up[i]);
        out->corner[i] =
            (float)(forward[i] - 0.5 * (double)s->width * pixel * right[i] + 0.5 * (double)s->height * pixel * up[i]);
        out->forward[i] = (float)forward[i];
    }
    return true;
}

enum { CAMERA_COMPONENTS = 11 };

static bool camera_curves(const scene *s, curves *c) {
    if (!curves_make(c, s->camera_count, CAMERA_COMPONENTS))
        return false;
    for (int k = 0; k < s->camera_count; k++) {
        const scene_camera_key *key = &s->camera[k];
        double *value = c->value + (size_t)k * CAMERA_COMPONENTS;
        c->time[k] = key->time;
        memcpy(value, key->eye, sizeof key->eye);
        memcpy(value + 3, key->target, sizeof key->target);
        memcpy(value + 6, key->up, sizeof key->up);
        value[9] = key->fov;
        value[10] = key->exposure;
    }
    curves_smooth(c);
    return true;
}

static void view_at(const curves *c, double t, view *v) {
    double value[CAMERA_COMPONENTS];
    curves_at(c, t, value);
    memcpy(v->eye, value, sizeof v->eye);
    memcpy(v->target, value + 3, sizeof v->target);
    memcpy(v->up, value + 6, sizeof v->up);
    v->fov = value[9];
    v->exposure = value[10];
}

static const char *camera_name(const void *list, int index) {
    return ((const model *)list)->cameras[index].name;
}

static bool used_view(const scene *s, const model *m, view *v) {
    const model_camera *c = model_camera_named(m, s->camera_use);
    if (!c)
        return false;
    *v = (view){.fov = c->fov > 0.0 ? c->fov : 60.0, .exposure = s->camera_exposure > 0.0 ? s->camera_exposure : 1.0};
    memcpy(v->eye, c->eye, sizeof v->eye);
    memcpy(v->target, c->target, sizeof v->target);
    memcpy(v->up, c->up, sizeof v->up);
    return true;
}

/* ---- the automatic scene: once round the model, lit from above ---- */

static const double automatic_fov = 45.0, automatic_irradiance = 10.0; /* degrees; W/m2 of a white surface at the centre */

static double box_center(const model *m, double center[3]) {
    double square = 0.0;
    for (int i = 0; i < 3; i++) {
        center[i] = 0.5 * (m->lo[i] + m->hi[i]);
        square += 0.25 * (m->hi[i] - m->lo[i]) * (m->hi[i] - m->lo[i]);
    }
    return sqrt(square);
}

/* At a distance from which the box's bounding sphere fits the narrower side of the image, 20 degrees up. */
static void automatic_view(const scene *s, const model *m, int frame, view *v) {
    const double radius = box_center(m, v->target);
    const double tall = strict_tan(automatic_fov * PI / 360.0), wide = tall * (double)s->width / (double)s->height;
    const double least = tall < wide ? tall : wide;
    const double distance = radius * sqrt(1.0 + least * least) / least;
    const double angle = 2.0 * PI * (double)frame / (double)s->frames, rise = 20.0 * PI / 180.0;
    v->eye[0] = v->target[0] + distance * strict_cos(rise) * strict_sin(angle);
    v->eye[1] = v->target[1] + distance * strict_sin(rise);
    v->eye[2] = v->target[2] + distance * strict_cos(rise) * strict_cos(angle);
    v->up[0] = v->up[2] = 0.0;
    v->up[1] = 1.0;
    v->fov = automatic_fov;
    v->exposure = 0.5 * PI / automatic_irradiance; /* white there shows as 0.5 */
}

/* The automatic light would be stronger than a pack holds. */
static bool too_large_for_automatic(const model *m) {
    double center[3];
    const double radius = box_center(m, center);
    return !(automatic_irradiance * (1.6 * 1.6 + 1.1 * 1.1) * radius * radius <= (double)VIT_MAX_INTENSITY);
}

/* Above the box and before it as the camera sees it, 36 degrees ahead on its way round: what the camera looks at is lit. */
static void automatic_light(const scene *s, const model *m, int frame, scene_light_key *key) {
    const double radius = box_center(m, key->position);
    const double angle = 2.0 * PI * (double)frame / (double)s->frames + PI / 5.0;
    const double offset[3] = {1.6 * radius * strict_sin(angle), 1.1 * radius, 1.6 * radius * strict_cos(angle)};
    for (int i = 0; i < 3; i++) {
        key->target[i] = key->position[i];
        key->position[i] += offset[i];
        key->power[i] = 4.0 * PI * automatic_irradiance * dot(offset, offset);
    }
}

static vit_status make_cameras(const scene *s, const model *m, tracks *out, vit_text *why) {
    curves path = {0};
    view v = {.fov = 60.0};
    double up[3] = {0.0, 0.0, 0.0};
    if (s->camera_use[0] && !used_view(s, m, &v)) {
        char names[NAMES_TEXT];
        names_offer(s->camera_use, camera_name, m, m->camera_count, names);
        return refuse(s, 0, why, "camera: no mesh has a camera '%.60s'%s", s->camera_use, names);
    }
    if (!s->camera_use[0] && !s->automatic) {
        if (s->camera_count < 1)
            return refuse(s, 0, why, "camera: there is no key");
        if (!camera_curves(s, &path)) {
            (void)refuse(s, 0, why, "out of memory");
            return VIT_FAILED;
        }
    }
    if (s->automatic && too_large_for_automatic(m))
        return refuse(s, 0, why, "the mesh is more than 1e7 m across: place it with a 'scale' in a scene file");
    vit_status status = VIT_OK;
    for (int f = 0; f < s->frames && status == VIT_OK; f++) {
        if (s->automatic)
            automatic_view(s, m, f, &v);
        else if (path.keys)
            view_at(&path, (double)f / s->fps, &v);
        if (!(v.fov > 1.0 && v.fov < 170.0))
            status = refuse(s, 0, why, "camera: 'fov' must be in (1, 170), got %g in frame %d", v.fov, f);
        else if (!make_camera(s, &v, up, &out->cameras[f]))
            status = refuse(s, 0, why, "camera: 'eye' and 'target' meet in frame %d", f);
        out->tan_half_fov = fmax(out->tan_half_fov, strict_tan(v.fov * PI / 360.0));
    }
    curves_free(&path);
    return status;
}

/* ---- lights ---- */

enum { LIGHT_COMPONENTS = 9 };

static bool light_curves(const scene_light *light, curves *c) {
    if (!curves_make(c, light->key_count, LIGHT_COMPONENTS))
        return false;
    for (int k = 0; k < light->key_count; k++) {
        const scene_light_key *key = &light->keys[k];
        double *value = c->value + (size_t)k * LIGHT_COMPONENTS;
        c->time[k] = key->time;
        memcpy(value, key->position, sizeof key->position);
        memcpy(value + 3, key->target, sizeof key->target);
        memcpy(value + 6, key->power, sizeof key->power);
    }
    curves_smooth(c);
    return true;
}

/* Parallel light leaves a disc outside the model, as large as the model's bounding sphere. */
static void place_disc(const model *m, const double direction[3], vit_light *out) {
    double center[3];
    const double radius = box_center(m, center) * 1.001; /* all of the sphere, however directions and planes are rounded */
    *out = (vit_light){.kind = VIT_LIGHT_DIRECTIONAL, .cos_outer = 1.0f, .spot_scale = (float)radius};
    for (int i = 0; i < 3; i++)
        out->position[i] = (float)(center[i] - direction[i] * radius);
}

/* False: a light that looks at itself. */
static bool make_light(const model *m, const scene_light *light, const scene_light_key *key, vit_light *out) {
    double direction[3] = {0.0, -1.0, 0.0}; /* of no use to a point light, but a unit vector */
    for (int i = 0; i < 3 && light->kind != VIT_LIGHT_POINT; i++)
        direction[i] = key->target[i] - key->position[i];
    if (!normalize(direction))
        return false;
    if (light->kind == VIT_LIGHT_DIRECTIONAL) {
        place_disc(m, direction, out);
        for (int i = 0; i < 3; i++) {
            out->direction[i] = (float)direction[i];
            out->intensity[i] = (float)key->power[i];
        }
        return true;
    }
    *out = (vit_light){.kind = VIT_LIGHT_POINT, .cos_outer = -1.0f, .spot_offset = 1.0f};
    out->falloff = light->window ? VIT_FALLOFF_WINDOW : VIT_FALLOFF_INVERSE_SQUARE;
    if (light->range > 0.0)
        out->inv_range2 = (float)(1.0 / (light->range * light->range));
    if (light->kind == VIT_LIGHT_SPOT) {
        const double inner = strict_cos(light->inner * PI / 180.0);
        const double outer = light->outer < 90.0 ? strict_cos(light->outer * PI / 180.0) : 0.0;
        const double scale = 1.0 / fmax(0.001, inner - outer); /* KHR_lights_punctual */
        out->kind = VIT_LIGHT_SPOT;
        out->cos_outer = (float)outer;
        out->spot_scale = (float)scale;
        out->spot_offset = (float)(-outer * scale);
    }
    for (int i = 0; i < 3; i++) {
        out->position[i] = (float)key->position[i];
        out->direction[i] = (float)direction[i];
        out->intensity[i] = (float)(key->power[i] / (4.0 * PI));
    }
    return true;
}

/* `light` and one key, from the model's light that it names. */
static const char *light_name(const void *list, int index) {
    return ((const model *)list)->lights[index].name;
}

static bool used_light(const model *m, const scene_light *wish, scene_light *light, scene_light_key *key) {
    const model_light *l = model_light_named(m, wish->use);
    if (!l)
        return false;
    *light = *wish;
    light->kind = l->kind;
    light->inner = l->inner;
    light->outer = l->outer;
    light->range = wish->range > 0.0 ? wish->range : l->range;
    *key = (scene_light_key){0};
    for (int k = 0; k < 3; k++) {
        key->position[k] = l->position[k];
        key->target[k] = l->position[k] + l->direction[k];
        key->power[k] = l->power[k];
    }
    return true;
}

/* One light, all frames. */
static vit_status make_track(const scene *s, const model *m, int index, tracks *out, vit_text *why) {
    /* From 1.94 radii away, 31 degrees hold the whole model: no photon is wasted on the void round it. */
    static const scene_light lamp = {.kind = VIT_LIGHT_SPOT, .inner = 31.0, .outer = 33.0, .photons = true};
    scene_light light = s->automatic ? lamp : s->lights[index];
    scene_light_key key = {0};
    curves path = {0};
    if (light.use[0] && !used_light(m, &s->lights[index], &light, &key)) {
        char names[NAMES_TEXT];
        names_offer(light.use, light_name, m, m->light_count, names);
        return refuse(s, light.line, why, "light %d: no mesh has a point, spot or directional light '%.60s'%s", index + 1,
                      light.use, names);
    }
    if (light.kind == VIT_LIGHT_DIRECTIONAL && (light.window || s->lights[index].range > 0.0))
        return refuse(s, light.line, why, "light %d: 'range' and 'falloff' are for point and spot lights", index + 1);
    if (light.window && !(light.range > 0.0))
        return refuse(s, light.line, why, "light %d: falloff \"window\" needs a 'range'", index + 1);
    if (!light.use[0] && !s->automatic && !light_curves(&light, &path)) {
        (void)refuse(s, 0, why, "out of memory");
        return VIT_FAILED;
    }
    vit_status status = VIT_OK;
    out->still[index] = true;
    for (int f = 0; f < s->frames && status == VIT_OK; f++) {
        vit_light *record = &out->lights[(size_t)f * out->light_count + (size_t)index];
        double value[LIGHT_COMPONENTS];
        if (s->automatic)
            automatic_light(s, m, f, &key);
        if (path.keys) {
            curves_at(&path, (double)f / s->fps, value);
            memcpy(key.position, value, sizeof key.position);
            memcpy(key.target, value + 3, sizeof key.target);
            memcpy(key.power, value + 6, sizeof key.power);
        }
        if (!make_light(m, &light, &key, record))
            status = refuse(s, light.line, why, "light %d: 'position' and 'target' meet in frame %d", index + 1, f);
        if (memcmp(record, &out->lights[index], sizeof *record) != 0)
            out->still[index] = false;
    }
    curves_free(&path);
    return status;
}

vit_status tracks_evaluate(const scene *s, const model *m, tracks *out, vit_text *why) {
    *out = (tracks){.light_count = s->automatic ? 1 : (uint32_t)s->light_count};
    double center[3];
    const double diagonal = 2.0 * box_center(m, center);
    out->near = s->near > 0.0 ? s->near : fmin(0.1, diagonal / 1000.0);
    out->cameras = calloc((size_t)s->frames, sizeof *out->cameras);
    out->lights = calloc((size_t)s->frames * out->light_count + 1, sizeof *out->lights);
    out->still = calloc((size_t)out->light_count + 1, sizeof *out->still);
    vit_status status = VIT_FAILED;
    if (out->cameras && out->lights && out->still)
        status = make_cameras(s, m, out, why);
    else
        (void)refuse(s, 0, why, "out of memory");
    for (uint32_t i = 0; status == VIT_OK && i < out->light_count; i++)
        status = make_track(s, m, (int)i, out, why);
    if (status != VIT_OK)
        tracks_free(out);
    return status;
}

void tracks_free(tracks *t) {
    free(t->cameras);
    free(t->lights);
    free(t->still);
    *t = (tracks){0};
}
