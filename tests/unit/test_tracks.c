/* Tracks: keys to one camera and one set of lights a frame. What is hard: a wrong basis still gives a picture, only mirrored,
 * stretched or off by half a pixel. Strategy: scenes built in memory (no files), records checked by what they are for: rays
 * through known pixels, the spot light's attenuation at its two cones, irradiance at a distance, all corners of the box in the
 * image. Curves are checked by their promise (through the keys, never beyond them), not by their formula. */
#include "motion/curves.h"
#include "motion/tracks.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>
#include <cmocka.h>

#define PI 3.14159265358979323846

/* A scene of `frames` frames at 10 a second, 200 x 100 pixels, seen from (0, 0, 5) to the origin. */
typedef struct setting {
    scene s;
    model m;
    scene_camera_key camera[3];
    scene_light lights[2];
    scene_light_key keys[2][3];
    model_camera model_cameras[1];
    model_light model_lights[1];
    tracks t;
    vit_text why;
} setting;

static void set(setting *x, int frames) {
    memset(x, 0, sizeof *x);
    x->s = (scene){.path = "test.cfg", .width = 200, .height = 100, .frames = frames, .fps = 10.0, .camera_exposure = 1.0};
    x->s.camera = x->camera;
    x->s.camera_count = 1;
    x->s.lights = x->lights;
    x->camera[0] = (scene_camera_key){.eye = {0, 0, 5}, .up = {0, 1, 0}, .fov = 60.0, .exposure = 1.0};
    for (int i = 0; i < 3; i++) {
        x->m.lo[i] = -1.0;
        x->m.hi[i] = 1.0;
    }
    x->m.cameras = x->model_cameras;
    x->m.lights = x->model_lights;
}

static void add_light(setting *x, scene_light light, scene_light_key key) {
    const int i = x->s.light_count++;
    x->keys[i][0] = key;
    light.keys = x->keys[i];
    light.key_count = 1;
    light.line = 10 + i;
    x->lights[i] = light;
}

static void evaluate(setting *x) {
    const vit_status status = tracks_evaluate(&x->s, &x->m, &x->t, &x->why);
    if (status != VIT_OK)
        print_error("%s\n", x->why.text);
    assert_int_equal(status, VIT_OK);
}

static void refuse(setting *x, const char *text) {
    assert_int_equal(tracks_evaluate(&x->s, &x->m, &x->t, &x->why), VIT_BAD_INPUT);
    assert_string_equal(x->why.text, text);
}

static double dot3(const float a[3], const float b[3]) {
    return (double)a[0] * (double)b[0] + (double)a[1] * (double)b[1] + (double)a[2] * (double)b[2];
}

static bool close3(const float got[3], double x, double y, double z) {
    return fabs((double)got[0] - x) < 1e-6 && fabs((double)got[1] - y) < 1e-6 && fabs((double)got[2] - z) < 1e-6;
}

static void ray(const vit_camera *c, double x, double y, float out[3]) {
    for (int i = 0; i < 3; i++)
        out[i] = (float)((double)c->corner[i] + (x + 0.5) * (double)c->right[i] + (y + 0.5) * (double)c->down[i]);
}

/* ---- curves ---- */

static void a_curve_goes_through_its_keys_and_not_beyond_them(void **state) {
    static const double time[9] = {0.0, 0.5, 0.75, 2.0, 2.25, 4.0, 5.0, 6.0, 7.0};
    static const double value[9] = {1.0, 1.0, 5.0, 5.25, -3.0, -2.0, -2.0, -1.0, 7.0};
    curves c;
    (void)state;
    assert_true(curves_make(&c, 9, 1));
    memcpy(c.time, time, sizeof time);
    memcpy(c.value, value, sizeof value);
    curves_smooth(&c);
    for (int k = 0; k < 9; k++) {
        double got;
        curves_at(&c, time[k], &got);
        assert_true(fabs(got - value[k]) < 1e-12);
    }
    for (int k = 0; k < 8; k++) {
        double last = value[k];
        for (int i = 1; i <= 100; i++) {
            double got;
            curves_at(&c, time[k] + (time[k + 1] - time[k]) * i / 100.0, &got);
            assert_true(value[k + 1] >= value[k] ? got >= last - 1e-12 : got <= last + 1e-12);
            last = got;
        }
        assert_true(fabs(last - value[k + 1]) < 1e-9);
    }
    curves_free(&c);
}

static void a_curve_is_smooth_at_its_keys(void **state) {
    static const double time[3] = {0.0, 1.0, 2.0}, value[3] = {0.0, 1.0, 3.0};
    double before, at, after;
    curves c;
    (void)state;
    assert_true(curves_make(&c, 3, 1));
    memcpy(c.time, time, sizeof time);
    memcpy(c.value, value, sizeof value);
    curves_smooth(&c);
    curves_at(&c, 1.0 - 1e-6, &before);
    curves_at(&c, 1.0, &at);
    curves_at(&c, 1.0 + 1e-6, &after);
    assert_true(fabs((after - at) - (at - before)) < 1e-10);
    curves_free(&c);
}

/* ---- camera ---- */

static void the_middle_of_the_image_is_the_view_axis(void **state) {
    setting x;
    float middle[3];
    (void)state;
    set(&x, 1);
    evaluate(&x);
    const vit_camera *c = &x.t.cameras[0];
    ray(c, 99.5, 49.5, middle);
    assert_true(close3(c->forward, 0, 0, -1) && close3(middle, 0, 0, -1) && close3(c->eye, 0, 0, 5));
    assert_true(c->exposure == 1.0f);
    tracks_free(&x.t);
}

static void pixels_are_square_right_is_right_and_rows_go_down(void **state) {
    setting x;
    float top[3];
    (void)state;
    set(&x, 1);
    evaluate(&x);
    const vit_camera *c = &x.t.cameras[0];
    assert_true(c->right[0] > 0.0f && fabs(dot3(c->right, c->right) - dot3(c->down, c->down)) < 1e-10);
    assert_true(fabs(dot3(c->right, c->down)) < 1e-10 && fabs(dot3(c->right, c->forward)) < 1e-7);
    ray(c, 99.5, -0.5, top); /* the upper edge: 30 degrees up */
    assert_true(close3(top, 0, tan(PI / 6.0), -1));
    assert_true(fabs(x.t.tan_half_fov - tan(PI / 6.0)) < 1e-12);
    tracks_free(&x.t);
}

static void a_frame_shows_the_time_frame_over_fps(void **state) {
    setting x;
    (void)state;
    set(&x, 31);
    x.s.camera_count = 2;
    x.camera[0].time = 1.0;
    x.camera[1] = x.camera[0];
    x.camera[1].time = 2.0;
    x.camera[1].eye[0] = 4.0;
    x.camera[1].exposure = 3.0;
    x.camera[1].fov = 90.0;
    evaluate(&x);
    assert_true(close3(x.t.cameras[0].eye, 0, 0, 5) && close3(x.t.cameras[10].eye, 0, 0, 5));
    assert_true(close3(x.t.cameras[15].eye, 2, 0, 5) && fabsf(x.t.cameras[15].exposure - 2.0f) < 1e-6f);
    assert_true(close3(x.t.cameras[20].eye, 4, 0, 5) && close3(x.t.cameras[30].eye, 4, 0, 5));
    assert_true(fabs(x.t.tan_half_fov - 1.0) < 1e-12);
    tracks_free(&x.t);
}

static void a_path_straight_over_its_target_keeps_a_basis(void **state) {
    setting x;
    (void)state;
    set(&x, 21);
    x.s.camera_count = 2;
    x.camera[0] = (scene_camera_key){.eye = {0, 5, 1}, .up = {0, 1, 0}, .fov = 60.0, .exposure = 1.0};
    x.camera[1] = x.camera[0];
    x.camera[1].time = 2.0;
    x.camera[1].eye[2] = -1.0;
    evaluate(&x);
    for (int f = 0; f < 21; f++) {
        const vit_camera *c = &x.t.cameras[f];
        const double right = dot3(c->right, c->right), down = dot3(c->down, c->down);
        assert_true(right > 1e-6 && fabs(right - down) < 1e-9 && fabs(dot3(c->right, c->forward)) < 1e-7);
    }
    tracks_free(&x.t);
}

static void an_eye_that_meets_its_target_is_refused_with_its_frame(void **state) {
    setting x;
    (void)state;
    set(&x, 21);
    x.s.camera_count = 2;
    x.camera[1] = x.camera[0];
    x.camera[1].time = 2.0;
    x.camera[1].eye[2] = -5.0;
    refuse(&x, "test.cfg: camera: 'eye' and 'target' meet in frame 10");
}

static void near_is_a_thousandth_of_the_box_unless_given(void **state) {
    setting x;
    (void)state;
    set(&x, 1);
    evaluate(&x);
    assert_true(fabs(x.t.near - 2.0 * sqrt(3.0) / 1000.0) < 1e-12);
    tracks_free(&x.t);
    x.m.hi[0] = 1000.0;
    evaluate(&x);
    assert_true(x.t.near == 0.1);
    tracks_free(&x.t);
    x.s.near = 0.25;
    evaluate(&x);
    assert_true(x.t.near == 0.25);
    tracks_free(&x.t);
}

static void a_camera_may_come_from_the_mesh(void **state) {
    setting x;
    (void)state;
    set(&x, 2);
    x.s.camera_count = 0;
    strcpy(x.s.camera_use, "Cam");
    x.s.camera_exposure = 2.0;
    refuse(&x, "test.cfg: camera: no mesh has a camera 'Cam'; there is none");
    x.m.camera_count = 1;
    x.model_cameras[0] = (model_camera){.name = "Other", .eye = {1, 2, 3}, .target = {1, 2, 2}, .up = {0, 1, 0}, .fov = 90.0};
    refuse(&x, "test.cfg: camera: no mesh has a camera 'Cam'; there is 'Other'");
    strcpy(x.model_cameras[0].name, "Cam");
    evaluate(&x);
    assert_true(close3(x.t.cameras[1].eye, 1, 2, 3) && close3(x.t.cameras[1].forward, 0, 0, -1));
    assert_true(x.t.cameras[1].exposure == 2.0f && fabs(x.t.tan_half_fov - 1.0) < 1e-12);
    tracks_free(&x.t);
}

/* ---- lights ---- */

static void a_point_light_spreads_its_power_over_the_sphere(void **state) {
    setting x;
    (void)state;
    set(&x, 2);
    add_light(&x, (scene_light){.range = 4.0}, (scene_light_key){.position = {1, 2, 3}, .power = {4.0 * PI, 0, 8.0 * PI}});
    evaluate(&x);
    const vit_light *l = &x.t.lights[1];
    assert_true(x.t.light_count == 1 && l->kind == VIT_LIGHT_POINT && l->falloff == VIT_FALLOFF_INVERSE_SQUARE);
    assert_true(close3(l->position, 1, 2, 3) && close3(l->intensity, 1, 0, 2) && l->inv_range2 == 0.0625f);
    assert_true(l->cos_outer == -1.0f && l->spot_scale == 0.0f && l->spot_offset == 1.0f);
    assert_true(l->path_first == 0 && l->path_count == 0);
    tracks_free(&x.t);
}

static void a_spot_light_is_full_at_its_inner_cone_and_dark_at_its_outer(void **state) {
    setting x;
    (void)state;
    set(&x, 1);
    add_light(&x, (scene_light){.kind = VIT_LIGHT_SPOT, .inner = 20.0, .outer = 40.0, .window = true, .range = 2.0},
              (scene_light_key){.position = {0, 3, 0}, .target = {0, 1, 0}, .power = {1, 1, 1}});
    add_light(&x, (scene_light){.kind = VIT_LIGHT_SPOT, .inner = 40.0, .outer = 40.0},
              (scene_light_key){.position = {0, 3, 0}, .target = {3, 3, 0}, .power = {1, 1, 1}});
    evaluate(&x);
    const vit_light *l = x.t.lights;
    assert_true(l->kind == VIT_LIGHT_SPOT && l->falloff == VIT_FALLOFF_WINDOW && l->inv_range2 == 0.25f);
    assert_true(close3(l->direction, 0, -1, 0) && close3(l[1].direction, 1, 0, 0));
    const double scale = (double)l->spot_scale, offset = (double)l->spot_offset;
    assert_true(fabs(cos(PI / 9.0) * scale + offset - 1.0) < 1e-5 && fabs(cos(PI / 4.5) * scale + offset) < 1e-5);
    assert_true(fabs((double)l->cos_outer - cos(PI / 4.5)) < 1e-6);
    assert_true(l[1].spot_scale == 1000.0f); /* equal cones: a steep edge, not a division by 0 */
    tracks_free(&x.t);
}

static void a_light_is_still_only_if_nothing_of_it_changes(void **state) {
    setting x;
    (void)state;
    set(&x, 11);
    add_light(&x, (scene_light){0}, (scene_light_key){.position = {0.1, 0.2, 0.3}, .power = {1, 2, 3}});
    add_light(&x, (scene_light){0}, (scene_light_key){.position = {0.1, 0.2, 0.3}, .power = {1, 2, 3}});
    for (int i = 0; i < 2; i++) {
        x.keys[i][1] = x.keys[i][0];
        x.keys[i][1].time = 1.0;
        x.lights[i].key_count = 2;
    }
    x.keys[1][1].power[2] = 4.0;
    evaluate(&x);
    assert_true(x.t.still[0] && !x.t.still[1]);
    assert_true(close3(x.t.lights[2 * 10 + 1].intensity, 0.25 / PI, 0.5 / PI, 1.0 / PI));
    tracks_free(&x.t);
}

static void a_light_may_come_from_the_mesh(void **state) {
    setting x;
    (void)state;
    set(&x, 1);
    add_light(&x, (scene_light){.use = "Lamp"}, (scene_light_key){0});
    x.lights[0].key_count = 0;
    refuse(&x, "test.cfg:10: light 1: no mesh has a point, spot or directional light 'Lamp'; there is none");
    x.m.light_count = 1;
    x.model_lights[0] = (model_light){.name = "Lamp",
                                      .kind = VIT_LIGHT_SPOT,
                                      .position = {1, 1, 1},
                                      .direction = {0, 0, 1},
                                      .power = {4.0 * PI, 0, 0},
                                      .inner = 0.0,
                                      .outer = 60.0,
                                      .range = 2.0};
    evaluate(&x);
    const vit_light *l = x.t.lights;
    assert_true(l->kind == VIT_LIGHT_SPOT && close3(l->direction, 0, 0, 1) && close3(l->intensity, 1, 0, 0));
    assert_true(fabsf(l->cos_outer - 0.5f) < 1e-6f && l->inv_range2 == 0.25f && x.t.still[0]);
    tracks_free(&x.t);
    x.model_lights[0].range = 0.0;
    x.lights[0].window = true;
    refuse(&x, "test.cfg:10: light 1: falloff \"window\" needs a 'range'");
}

static void a_spot_light_that_meets_its_target_is_refused(void **state) {
    setting x;
    (void)state;
    set(&x, 21);
    add_light(&x, (scene_light){.kind = VIT_LIGHT_SPOT, .outer = 45.0},
              (scene_light_key){.position = {0, 1, 0}, .power = {1, 1, 1}});
    x.keys[0][1] = (scene_light_key){.time = 2.0, .position = {0, -1, 0}, .power = {1, 1, 1}};
    x.lights[0].key_count = 2;
    refuse(&x, "test.cfg:10: light 1: 'position' and 'target' meet in frame 10");
}

/* ---- the automatic scene ---- */

static void set_automatic(setting *x, int width, int height) {
    set(x, 24);
    x->s.automatic = true;
    x->s.camera_count = 0;
    x->s.width = width;
    x->s.height = height;
    x->m.lo[1] = 3.0;
    x->m.hi[1] = 4.0;
}

static void sees_all(const setting *x) {
    for (int f = 0; f < x->s.frames; f++) {
        const vit_camera *c = &x->t.cameras[f];
        for (int corner = 0; corner < 8; corner++) {
            float d[3];
            for (int i = 0; i < 3; i++)
                d[i] = (float)(corner >> i & 1 ? x->m.hi[i] : x->m.lo[i]) - c->eye[i];
            const double depth = dot3(d, c->forward);
            assert_true(depth > 0.0);
            assert_true(fabs(dot3(d, c->right) / depth / dot3(c->right, c->right)) < 0.5 * x->s.width);
            assert_true(fabs(dot3(d, c->down) / depth / dot3(c->down, c->down)) < 0.5 * x->s.height);
        }
        assert_true(c->eye[1] > 3.5f);
    }
}

static void the_automatic_camera_sees_the_whole_box_from_all_around(void **state) {
    static const int sizes[3][2] = {{200, 100}, {100, 200}, {100, 100}};
    setting x;
    (void)state;
    for (int i = 0; i < 3; i++) {
        set_automatic(&x, sizes[i][0], sizes[i][1]);
        evaluate(&x);
        sees_all(&x);
        assert_true(dot3(x.t.cameras[0].forward, x.t.cameras[12].forward) < -0.5);
        tracks_free(&x.t);
    }
}

static void a_mesh_too_large_for_a_light_that_a_pack_holds_is_refused(void **state) {
    setting x;
    (void)state;
    set_automatic(&x, 200, 100);
    x.m.hi[0] = x.m.lo[0] + 1.0e7;
    evaluate(&x);
    for (int f = 0; f < x.s.frames; f++)
        assert_true(x.t.lights[f].intensity[0] <= VIT_MAX_INTENSITY);
    tracks_free(&x.t);
    x.m.hi[0] = x.m.lo[0] + 1.1e7;
    refuse(&x, "test.cfg: the mesh is more than 1e7 m across: place it with a 'scale' in a scene file");
}

static void the_automatic_light_moves_and_gives_10_watts_a_square_metre(void **state) {
    setting x;
    (void)state;
    set_automatic(&x, 200, 100);
    evaluate(&x);
    assert_true(x.t.light_count == 1 && !x.t.still[0]);
    for (int f = 0; f < x.s.frames; f++) {
        const vit_light *l = &x.t.lights[f];
        const float d[3] = {l->position[0], l->position[1] - 3.5f, l->position[2]};
        const double irradiance = (double)l->intensity[1] / dot3(d, d);
        assert_true(fabs(irradiance - 10.0) < 1e-4 && l->position[1] > 4.0f);
        assert_true(fabs(irradiance / PI * (double)x.t.cameras[f].exposure - 0.5) < 1e-4);
    }
    tracks_free(&x.t);
}

static void evaluating_twice_gives_the_same_bytes(void **state) {
    setting a, b;
    (void)state;
    set_automatic(&a, 200, 100);
    set_automatic(&b, 200, 100);
    evaluate(&a);
    evaluate(&b);
    assert_memory_equal(a.t.cameras, b.t.cameras, 24 * sizeof *a.t.cameras);
    assert_memory_equal(a.t.lights, b.t.lights, 24 * sizeof *a.t.lights);
    tracks_free(&a.t);
    tracks_free(&b.t);
}

#define T(name) cmocka_unit_test(name)

int main(void) {
    static const struct CMUnitTest tests[] = {
        T(a_curve_goes_through_its_keys_and_not_beyond_them),
        T(a_curve_is_smooth_at_its_keys),
        T(the_middle_of_the_image_is_the_view_axis),
        T(pixels_are_square_right_is_right_and_rows_go_down),
        T(a_frame_shows_the_time_frame_over_fps),
        T(a_path_straight_over_its_target_keeps_a_basis),
        T(an_eye_that_meets_its_target_is_refused_with_its_frame),
        T(near_is_a_thousandth_of_the_box_unless_given),
        T(a_camera_may_come_from_the_mesh),
        T(a_point_light_spreads_its_power_over_the_sphere),
        T(a_spot_light_is_full_at_its_inner_cone_and_dark_at_its_outer),
        T(a_light_is_still_only_if_nothing_of_it_changes),
        T(a_light_may_come_from_the_mesh),
        T(a_spot_light_that_meets_its_target_is_refused),
        T(the_automatic_camera_sees_the_whole_box_from_all_around),
        T(a_mesh_too_large_for_a_light_that_a_pack_holds_is_refused),
        T(the_automatic_light_moves_and_gives_10_watts_a_square_metre),
        T(evaluating_twice_gives_the_same_bytes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
