/* The scene file on any bytes: files scene.cfg, and part.cfg and deep.cfg to include. What is accepted must hold the ranges
 * that bake/README.md states, say itself again as text, and give finite cameras and lights for a model. */
#include "fuzz.h"
#include "scene.h"
#include "tracks.h"

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
        in_range(l->range, 0, 1e6);
        for (int k = 0; k < l->key_count; k++)
            for (int c = 0; c < 3; c++) {
                in_range(l->keys[k].position[c], -1e6, 1e6);
                in_range(l->keys[k].power[c], 0, 1e9);
                FUZZ_HOLDS(k == 0 || l->keys[k].time > l->keys[k - 1].time);
            }
    }
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
    in_range(s->quality.photons, 0, 1000000);
    in_range(s->quality.bounces, 1, 32);
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
    static model_light light = {
        .name = "l", .kind = VIT_LIGHT_SPOT, .direction = {0, -1, 0}, .power = {1, 2, 3}, .inner = 10, .outer = 20};
    const model m = {
        .cameras = &camera, .camera_count = 1, .lights = &light, .light_count = 1, .lo = {-1, -1, -1}, .hi = {1, 2, 3}};
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
                       t.lights[i].intensity[k] >= 0);
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
