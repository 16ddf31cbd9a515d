/* The scene file on any bytes: files scene.cfg, and part.cfg and deep.cfg to include. What is accepted must hold the ranges
 * that bake/README.md states, say itself again as text, and give finite cameras and lights for a model. */
#include "fuzz.h"
#include "scene/scene.h"
#include "motion/tracks.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { FRAMES = 50, LIGHTS = 8 }; /* larger scenes are not evaluated */

static void in_range(double value, double least, double most) {
    FUZZ_HOLDS(value >= least && value <= most);
}

static void check_lights(const scene *s) {
    for (int i = 0; i < s->light_count; i++) {
        const scene_light *l = &s->lights[i];
        FUZZ_HOLDS(l->use[0] || l->key_count > 0);
        in_range(l->kind, VIT_LIGHT_POINT, VIT_LIGHT_DIRECTIONAL);
        FUZZ_HOLDS(l->use[0] || l->kind != VIT_LIGHT_DIRECTIONAL || l->range == 0);
        in_range(l->range, 0, 1e6);
        for (int k = 0; k < l->key_count; k++)
            for (int c = 0; c < 3; c++) {
                in_range(l->keys[k].position[c], -1e6, 1e6);
                in_range(l->keys[k].power[c], 0, 1e9);
                FUZZ_HOLDS(k == 0 || l->keys[k].time > l->keys[k - 1].time);
            }
    }
}

static void check_materials(const scene *s) {
    for (int i = 0; i < s->material_count; i++) {
        const scene_material *m = &s->materials[i];
        if (m->has_kind)
            in_range(m->kind, VIT_MATTE, VIT_THIN_GLASS);
        if (m->has_roughness)
            in_range(m->roughness, 0, 1);
        if (m->has_exponent)
            in_range(m->exponent, 1, VIT_MAX_EXPONENT);
        if (m->has_ior)
            in_range(m->ior, VIT_MIN_IOR, VIT_MAX_IOR);
        for (int k = 0; k < 3; k++) {
            in_range(m->specular[k], 0, 1);
            in_range(m->absorption[k], 0, 1e9);
        }
    }
}

static void check_quality(const scene_quality *q) {
    in_range(q->photons, 0, 1000000);
    in_range(q->bounces, 1, 32);
    in_range(q->antialias, 1, VIT_MAX_COPIES);
    FUZZ_HOLDS((q->antialias & (q->antialias - 1)) == 0);
    in_range(q->antialias_contrast, 0, 1);
    in_range(q->light_samples, 1, VIT_MAX_LIGHT_SAMPLES);
    in_range(q->sky_samples, 1, VIT_MAX_LIGHT_SAMPLES);
    in_range(q->specular_depth, 1, VIT_MAX_CHAIN);
    in_range(q->gloss_rays, 0, VIT_MAX_GLOSS_RAYS);
}

static void check_scene(const scene *s) {
    in_range(s->width, 1, 7680);
    in_range(s->height, 1, 4320);
    in_range(s->frames, 1, 100000);
    FUZZ_HOLDS(s->fps > 0 && s->fps <= 1000);
    in_range(s->mesh_count, 1, 4096);
    in_range(s->light_count, 0, 64);
    in_range(s->material_count, 0, 4096);
    FUZZ_HOLDS(s->camera_use[0] || s->camera_count > 0);
    for (int i = 0; i < s->mesh_count; i++)
        for (int k = 0; k < 12; k++)
            FUZZ_HOLDS(isfinite(s->meshes[i].transform[k]));
    for (int i = 0; i < s->camera_count; i++)
        in_range(s->camera[i].fov, 1, 170);
    in_range(s->sky.scale, 0, 1e6);
    in_range(s->sky.rotate, -360, 360);
    for (int k = 0; k < 3; k++)
        in_range(s->ambient[k], 0, 1e9);
    check_quality(&s->quality);
    check_materials(s);
    check_lights(s);
}

static void check_quality_text(const scene_quality *q) {
    char text[SCENE_QUALITY], again[SCENE_QUALITY];
    vit_text why = {""};
    scene_quality read = *q;
    scene_quality_text(q, text, sizeof text);
    FUZZ_HOLDS(scene_quality_apply(text, &read, &why) == VIT_OK);
    scene_quality_text(&read, again, sizeof again);
    FUZZ_HOLDS(strcmp(text, again) == 0);
}

static void check_tracks(const scene *s) {
    static model_camera camera = {.name = "c", .target = {0, 0, -1}, .up = {0, 1, 0}, .fov = 50};
    static model_light lights[2] = {
        {.name = "l", .kind = VIT_LIGHT_SPOT, .direction = {0, -1, 0}, .power = {1, 2, 3}, .inner = 10, .outer = 20},
        {.name = "s", .kind = VIT_LIGHT_DIRECTIONAL, .direction = {0, 0, -1}, .power = {1, 2, 3}}};
    const model m = {
        .cameras = &camera, .camera_count = 1, .lights = lights, .light_count = 2, .lo = {-1, -1, -1}, .hi = {1, 2, 3}};
    tracks t;
    vit_text why = {""};
    if (tracks_evaluate(s, &m, &t, &why) != VIT_OK) {
        fuzz_one_line(why.text, sizeof why.text);
        return;
    }
    for (int i = 0; i < s->frames; i++) {
        const vit_camera *c = &t.cameras[i];
        for (int k = 0; k < 3; k++)
            FUZZ_HOLDS(isfinite(c->eye[k]) && isfinite(c->corner[k]) && isfinite(c->right[k]) && isfinite(c->down[k]) &&
                       fabsf(c->forward[k]) <= 1.001f);
    }
    for (size_t i = 0; i < (size_t)s->frames * t.light_count; i++)
        for (int k = 0; k < 3; k++)
            FUZZ_HOLDS(isfinite(t.lights[i].position[k]) && isfinite(t.lights[i].intensity[k]) &&
                       t.lights[i].intensity[k] >= 0 && fabsf(t.lights[i].direction[k]) <= 1.001f &&
                       (t.lights[i].kind != VIT_LIGHT_DIRECTIONAL || t.lights[i].spot_scale > 0));
    tracks_free(&t);
}

void fuzz_scene(const uint8_t *data, size_t size) {
    static const char *const names[] = {"scene.cfg", "part.cfg", "deep.cfg", NULL};
    fuzz_files f = {.names = names};
    scene s;
    vit_text why;
    memset(&why, 'x', sizeof why);
    fuzz_write_files(&f, data, size);
    const vit_status status = scene_read(f.main, &s, &why);
    if (status != VIT_OK) {
        FUZZ_HOLDS(status == VIT_BAD_INPUT);
        fuzz_one_line(why.text, sizeof why.text);
        return;
    }
    check_scene(&s);
    check_quality_text(&s.quality);
    if (s.frames <= FRAMES && s.light_count <= LIGHTS)
        check_tracks(&s);
    scene_free(&s);
}
