/* The scene file. What is hard: a scene file is typed by hand, so nearly all of its possible contents are wrong, and each
 * wrong one has to end in a line that says where and why. Strategy: one good scene in which no field has its default, checked
 * field by field, and its defaults; then one scene a mistake, each of which differs from a good one in that mistake alone,
 * stands on a line of its own, and must give VIT_BAD_INPUT and exactly "file:line: ... what". Scenes go through real files,
 * since files (missing, folders, includes) are half of the subject. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/scene_files"
#include "scene/scene.h"
#include "vitrine_pack.h"
#include "test_folder.h"
#include <math.h>

#define NAME FOLDER "/test.cfg"
#define MESH "meshes = ( { file = \"a.obj\"; } );\n"
#define CAMERA "camera: { keys = ( { eye = (0, 1, 3); target = (0, 1, 0); } ); };\n"
#define GOOD MESH CAMERA
#define KEYS "keys = ( { position = (0, 1, 0); power = (1, 1, 1); } ); "
#define SPOT "keys = ( { position = (0, 1, 0); target = (0, 0, 0); power = (1, 1, 1); } ); "

static void read_good(const char *text, scene *s) {
    vit_text why = {{0}};
    put(NAME, text);
    const vit_status status = scene_read(NAME, s, &why);
    if (status != VIT_OK)
        print_error("%s\n", why.text);
    assert_int_equal(status, VIT_OK);
}

/* `text` is refused with one line that begins "file:line: " (or "file: " for line 0) and holds `what`. */
static void refuse(const char *text, int line, const char *what) {
    scene s;
    vit_text why = {{0}};
    char head[1200];
    put(NAME, text);
    assert_int_equal(scene_read(NAME, &s, &why), VIT_BAD_INPUT);
    (void)snprintf(head, sizeof head, line ? NAME ":%d: " : NAME ": ", line);
    if (strncmp(why.text, head, strlen(head)) != 0 || !strstr(why.text, what))
        print_error("expected '%s... %s'\ngot      '%s'\n", head, what, why.text);
    assert_int_equal(strncmp(why.text, head, strlen(head)), 0);
    assert_non_null(strstr(why.text, what));
    assert_null(strchr(why.text, '\n'));
}

#define REFUSES(name, line, what, text)                                                                                        \
    static void name(void **state) {                                                                                           \
        (void)state;                                                                                                           \
        refuse(text, line, what);                                                                                              \
    }

static void near3(const double got[3], double x, double y, double z) {
    assert_true(fabs(got[0] - x) < 1e-12 && fabs(got[1] - y) < 1e-12 && fabs(got[2] - z) < 1e-12);
}

/* ---- good scenes ---- */

static const char full[] =
    "name = \"Full\";\n"
    "output: { width = 640; height = 360; fps = 30; frames = 7; };\n"
    "background = [0.1, 0.2, 0.3];\n"
    "meshes = ( { file = \"sub/a.obj\"; scale = 2; rotate = [0.0, 90.0, 0.0]; translate = (1, 2.5, 3); },\n"
    "           { file = \"/abs/b.glb\"; scale = [1.0, -2.0, 3.0]; rotate = (90, 0, 90); } );\n"
    "camera: { near = 0.25; exposure = 2.0; keys = (\n"
    "  { time = 0.5; eye = [0.0, 1.0, 3.0]; target = (0, 1, 0); up = (0, 0.5, 0.5); fov = 45; exposure = 3; },\n"
    "  { time = 2; eye = (1, 1, 3); } ); };\n"
    "lights = ( { type = \"point\"; keys = ( { position = (0, 2, 0); power = (100, 90, 80.5); }, { time = 1; power = (0, 0, "
    "0); } ); },\n"
    "  { type = \"spot\"; inner = 20; outer = 40.0; range = 6; falloff = \"window\"; photons = false;\n"
    "    keys = ( { time = 0.25; position = (0, 3, 0); target = (1, 0, 0); power = (1, 2, 3); } ); },\n"
    "  { use = \"Lamp\"; range = 2; } );\n"
    "materials = ( { name = \"floor\"; color = (0.5, 0.25, 1); texture = \"x.png\"; emission = (1, 2, 3); cutoff = 0.75; },\n"
    "  { name = \"wall\"; texture = \"\"; } );\n"
    "quality: { photons = 1000; bounces = 7; radius = 0.5; tile = 16; estimate = \"buckets\"; smoothing = \"raw\";\n"
    "  kernel = \"flattened\"; flatten = 9.0; normal_keys = true; indirect_samples = 4;\n"
    "  texture_filter = \"trilinear\"; vertex_bits = 16; normal_bits = 8; sample_bits = 16; };\n";

static void every_setting_of_output_and_quality_is_read(void **state) {
    scene s;
    (void)state;
    read_good(full, &s);
    assert_string_equal(s.path, NAME);
    assert_string_equal(s.name, "Full");
    assert_true(s.width == 640 && s.height == 360 && s.frames == 7 && s.fps == 30.0);
    near3(s.background, 0.1, 0.2, 0.3);
    assert_true(s.quality.photons == 1000 && s.quality.bounces == 7 && s.quality.radius == 0.5 && s.quality.tile == 16);
    assert_true(s.quality.buckets && s.quality.raw && s.quality.flattened && s.quality.flatten == 9.0 && s.quality.normal_keys);
    assert_true(s.quality.indirect_samples == 4 && s.quality.texture_filter == FILTER_TRILINEAR);
    assert_true(s.quality.vertex_bits == 16 && s.quality.normal_bits == 8 && s.quality.sample_bits == 16);
    assert_false(s.automatic);
    scene_free(&s);
}

static void every_setting_of_a_mesh_is_read(void **state) {
    scene s;
    (void)state;
    read_good(full, &s);
    assert_int_equal(s.mesh_count, 2);
    assert_string_equal(s.meshes[0].file, VIT_BUILD_DIR "/tests/unit/scene_files/sub/a.obj");
    assert_string_equal(s.meshes[1].file, "/abs/b.glb");
    assert_true(s.meshes[0].line == 4 && s.meshes[1].line == 5);
    /* A quarter turn about y takes x to -z and z to x, exactly. */
    const double first[12] = {0, 0, 2, 1, 0, 2, 0, 2.5, -2, 0, 0, 3};
    assert_memory_equal(s.meshes[0].transform, first, sizeof first);
    /* x first, then z: x -> x -> y; y -> z -> z; z -> -y -> x. Columns times 1, -2, 3. */
    const double second[12] = {0, 0, 3, 0, 1, 0, 0, 0, 0, -2, 0, 0};
    assert_memory_equal(s.meshes[1].transform, second, sizeof second);
    scene_free(&s);
}

static void every_setting_of_the_camera_is_read_and_later_keys_repeat_earlier_ones(void **state) {
    scene s;
    (void)state;
    read_good(full, &s);
    assert_true(s.camera_count == 2 && s.near == 0.25 && s.camera_exposure == 2.0);
    assert_string_equal(s.camera_use, "");
    const scene_camera_key *k = s.camera;
    assert_true(k[0].time == 0.5 && k[0].fov == 45.0 && k[0].exposure == 3.0);
    near3(k[0].eye, 0, 1, 3);
    near3(k[0].target, 0, 1, 0);
    near3(k[0].up, 0, 0.5, 0.5);
    assert_true(k[1].time == 2.0 && k[1].fov == 45.0 && k[1].exposure == 3.0);
    near3(k[1].eye, 1, 1, 3);
    near3(k[1].target, 0, 1, 0);
    near3(k[1].up, 0, 0.5, 0.5);
    scene_free(&s);
}

static void every_setting_of_a_light_is_read(void **state) {
    scene s;
    (void)state;
    read_good(full, &s);
    assert_int_equal(s.light_count, 3);
    const scene_light *l = s.lights;
    assert_true(l[0].kind == VIT_LIGHT_POINT && l[0].range == 0.0 && !l[0].window && l[0].photons && l[0].key_count == 2 &&
                l[0].line == 9);
    assert_true(l[0].keys[0].time == 0.0 && l[0].keys[1].time == 1.0);
    near3(l[0].keys[0].power, 100, 90, 80.5);
    near3(l[0].keys[1].power, 0, 0, 0);
    near3(l[0].keys[1].position, 0, 2, 0);
    assert_true(l[1].kind == VIT_LIGHT_SPOT && l[1].inner == 20.0 && l[1].outer == 40.0 && l[1].range == 6.0 && l[1].window &&
                !l[1].photons);
    assert_true(l[1].key_count == 1 && l[1].keys[0].time == 0.25);
    near3(l[1].keys[0].target, 1, 0, 0);
    assert_string_equal(l[2].use, "Lamp");
    assert_true(l[2].key_count == 0 && l[2].range == 2.0 && l[2].photons);
    scene_free(&s);
}

static void every_setting_of_a_material_is_read(void **state) {
    scene s;
    (void)state;
    read_good(full, &s);
    assert_int_equal(s.material_count, 2);
    const scene_material *m = s.materials;
    assert_string_equal(m[0].name, "floor");
    assert_true(m[0].has_color && m[0].has_texture && m[0].has_emission && m[0].has_cutoff && m[0].cutoff == 0.75);
    near3(m[0].color, 0.5, 0.25, 1);
    near3(m[0].emission, 1, 2, 3);
    assert_string_equal(m[0].texture, VIT_BUILD_DIR "/tests/unit/scene_files/x.png");
    assert_string_equal(m[1].texture, "");
    assert_true(!m[1].has_color && m[1].has_texture && !m[1].has_emission && !m[1].has_cutoff && m[1].line == 14);
    scene_free(&s);
}

static void what_is_left_out_has_its_default(void **state) {
    scene s;
    (void)state;
    read_good(GOOD "lights = ( { type = \"spot\"; " SPOT "} );\n", &s);
    assert_string_equal(s.name, "");
    assert_true(s.width == 1280 && s.height == 720 && s.frames == 48 && s.fps == 24.0);
    near3(s.background, 0, 0, 0);
    const double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    assert_memory_equal(s.meshes[0].transform, identity, sizeof identity);
    assert_true(s.near == 0.0 && s.camera[0].time == 0.0 && s.camera[0].fov == 60.0 && s.camera[0].exposure == 1.0);
    near3(s.camera[0].up, 0, 1, 0);
    assert_true(s.lights[0].inner == 0.0 && s.lights[0].outer == 45.0 && s.lights[0].photons && !s.lights[0].window);
    assert_true(s.quality.photons == 17000 && s.quality.bounces == 4 && s.quality.radius == 0.0 && s.quality.tile == 32);
    assert_true(!s.quality.buckets && !s.quality.raw && !s.quality.flattened && !s.quality.normal_keys);
    assert_true(s.quality.indirect_samples == 16 && s.quality.texture_filter == FILTER_BILINEAR);
    assert_true(s.quality.vertex_bits == 32 && s.quality.normal_bits == 16 && s.quality.sample_bits == 32);
    scene_free(&s);
}

static void a_scene_without_lights_is_good(void **state) {
    scene s;
    (void)state;
    read_good(GOOD, &s);
    assert_int_equal(s.light_count, 0);
    scene_free(&s);
}

static void a_camera_by_name_keeps_its_exposure(void **state) {
    scene s;
    (void)state;
    read_good(MESH "camera: { use = \"Cam\"; exposure = 0.5; };\nquality: { radius = \"auto\"; kernel = \"flattened\"; };\n",
              &s);
    assert_string_equal(s.camera_use, "Cam");
    assert_true(s.camera_count == 0 && s.camera_exposure == 0.5 && s.quality.radius == 0.0 && s.quality.flatten == 15.0);
    scene_free(&s);
}

static void the_cameras_exposure_is_the_first_keys(void **state) {
    scene s;
    (void)state;
    read_good(MESH "camera: { exposure = 4; keys = ( { eye = (0, 1, 3); target = (0, 1, 0); } ); };\n", &s);
    assert_true(s.camera[0].exposure == 4.0);
    scene_free(&s);
}

static void a_bare_mesh_makes_an_automatic_scene(void **state) {
    scene s;
    vit_text why;
    (void)state;
    assert_int_equal(scene_for_mesh("some/where/duck.glb", &s, &why), VIT_OK);
    assert_true(s.automatic && s.mesh_count == 1 && s.light_count == 0 && s.width == 1280 && s.quality.photons == 17000);
    assert_string_equal(s.name, "duck.glb");
    assert_string_equal(s.meshes[0].file, "some/where/duck.glb");
    assert_true(s.meshes[0].transform[0] == 1.0 && s.meshes[0].transform[5] == 1.0 && s.meshes[0].transform[10] == 1.0);
    scene_free(&s);
}

static void includes_are_found_beside_the_scene(void **state) {
    scene s;
    (void)state;
    put(VIT_BUILD_DIR "/tests/unit/scene_files/part.cfg", CAMERA);
    read_good(MESH "@include \"part.cfg\"\n", &s);
    assert_int_equal(s.camera_count, 1);
    scene_free(&s);
}

static void what_looks_like_a_number_in_text_or_names_is_none(void **state) {
    scene s;
    (void)state;
    read_good("name = \"010, 4294967296 ,) \\\" 0x1\"; # 010 ,)\n// 4294967296\n/* 010 ,\n) */\n" GOOD
              "materials = ( { name = \"a-010\"; color = (0, 0.010, 1e-0); } );\n",
              &s);
    assert_string_equal(s.name, "010, 4294967296 ,) \" 0x1");
    assert_true(s.materials[0].color[1] == 0.01 && s.materials[0].color[2] == 1.0);
    scene_free(&s);
}

static void a_byte_order_mark_is_passed_over(void **state) {
    scene s;
    (void)state;
    read_good("\xef\xbb\xbf" GOOD "output: { width = 64; };\n", &s);
    assert_int_equal(s.width, 64);
    scene_free(&s);
    put(VIT_BUILD_DIR "/tests/unit/scene_files/part.cfg", CAMERA);
    read_good("\xef\xbb\xbf@include \"part.cfg\"\n" MESH, &s);
    assert_int_equal(s.camera_count, 1);
    scene_free(&s);
}

static void numbers_may_say_that_they_are_long(void **state) {
    scene s;
    (void)state;
    read_good(GOOD "output: { width = 64L; };\nquality: { indirect_samples = 4L; };\n", &s);
    assert_true(s.width == 64 && s.quality.indirect_samples == 4);
    scene_free(&s);
}

/* ---- bad scenes ---- */

static void what_an_include_holds_is_looked_at_too(void **state) {
    static const struct {
        const char *text, *says;
    } parts[] = {{"output: {\nframes = 010; };\n", "part.cfg:2: '010' begins with 0"},
                 {"\xef\xbb\xbf" CAMERA, "part.cfg: begins with a byte order mark"},
                 {"fps = 4294967320;\n", "part.cfg:1: '4294967320' is beyond 32 bits"}};
    scene s;
    vit_text why;
    (void)state;
    put(NAME, GOOD "@include \"part.cfg\"\n");
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        put(VIT_BUILD_DIR "/tests/unit/scene_files/part.cfg", parts[i].text);
        assert_int_equal(scene_read(NAME, &s, &why), VIT_BAD_INPUT);
        if (!strstr(why.text, parts[i].says))
            fail_msg("%s", why.text);
    }
    refuse(GOOD "\n@include \"lost.cfg\"\n", 4, "lost.cfg' is not there");
}

REFUSES(an_empty_file_is_refused, 0, "'meshes'", "")
REFUSES(a_scene_without_meshes_is_refused, 0, "'meshes'", CAMERA)
REFUSES(an_empty_list_of_meshes_is_refused, 1, "at least one mesh", "meshes = ( );\n" CAMERA)
REFUSES(a_mesh_without_a_file_is_refused, 2, "mesh 1: needs a 'file'", "meshes = (\n{ scale = 2.0; } );\n" CAMERA)
REFUSES(a_mesh_of_scale_0_is_refused, 1, "mesh 1: 'scale'", "meshes = ( { file = \"a\"; scale = 0; } );\n" CAMERA)
REFUSES(a_mesh_of_infinite_scale_is_refused, 1, "mesh 1: 'scale'", "meshes = ( { file = \"a\"; scale = 1e999; } );\n" CAMERA)
REFUSES(a_mesh_that_is_no_group_is_refused, 1, "mesh 1: must be a group", "meshes = ( \"a.obj\" );\n" CAMERA)
REFUSES(meshes_that_are_no_list_are_refused, 1, "must be a list of groups", "meshes = { file = \"a.obj\"; };\n" CAMERA)
REFUSES(an_unknown_setting_is_refused, 3, "unknown setting 'ligths'; there are 'lights', ", GOOD "ligths = ( );\n")
REFUSES(an_unknown_setting_of_a_group_is_refused, 3, "output: unknown setting 'widht'", GOOD "output: { widht = 640; };\n")
REFUSES(an_unknown_setting_of_a_key_is_refused, 4, "light 1, key 1: unknown setting 'colour'",
        GOOD "lights = ( { type = \"point\"; keys = (\n{ colour = (1, 1, 1); } ); } );\n")
REFUSES(a_setting_given_twice_is_refused, 3, "duplicate", GOOD "camera = 1;\n")
REFUSES(text_that_is_no_scene_is_refused, 3, "syntax error", GOOD "hello, world\n")
REFUSES(a_width_of_0_is_refused, 3, "'width' must be in [1, 7680], got 0", GOOD "output: { width = 0; };\n")
REFUSES(a_height_of_4321_is_refused, 3, "'height' must be in [1, 4320], got 4321", GOOD "output: { height = 4321; };\n")
REFUSES(a_width_beyond_32_bits_is_refused, 3, "'width'", GOOD "output: { width = 4294967297L; };\n")
REFUSES(a_width_that_32_bits_would_wrap_is_refused, 3, "'4294967456' is beyond 32 bits",
        GOOD "output: { width = 4294967456; };\n")
REFUSES(a_width_that_64_bits_would_wrap_is_refused, 3, "is beyond 64 bits",
        GOOD "output: { width = 18446744073709551776L; };\n")
REFUSES(a_negative_number_beyond_32_bits_is_refused, 4, "'-2147483649' is beyond", GOOD "output: {\nwidth = -2147483649; };\n")
REFUSES(frames_beyond_32_bits_are_refused, 3, "'4294967298' is beyond", GOOD "output: { frames=4294967298; };\n")
REFUSES(a_vector_beyond_32_bits_is_refused, 3, "'4294967297' is beyond", GOOD "background = (0, 0, 4294967297);\n")
REFUSES(an_octal_number_is_refused, 3, "'010' begins with 0", GOOD "output: { frames = 010; };\n")
REFUSES(an_octal_number_of_64_bits_is_refused, 3, "'+010L' begins with 0", GOOD "output: { frames = +010L; };\n")
REFUSES(a_hexadecimal_number_is_refused, 3, "'0x10' numbers are decimal", GOOD "output: { frames = 0x10; };\n")
REFUSES(a_binary_number_is_refused, 3, "'0b10' numbers are decimal", GOOD "output: { frames = 0b10; };\n")
REFUSES(a_choice_beyond_32_bits_is_refused, 3, "'indirect_samples'", GOOD "quality: { indirect_samples = 4294967300L; };\n")
REFUSES(a_comma_behind_the_last_light_is_refused, 4, "',' has nothing behind it",
        GOOD "lights = ( { type = \"point\"; " KEYS "}\n, // last\n/* ) */ );\n")
REFUSES(a_comma_behind_the_last_number_is_refused, 3, "',' has nothing behind it", GOOD "background = [0.0, 0.0, 0.0,];\n")
REFUSES(utf_16_is_refused, 1, "UTF-8", "\xff\xfem")
REFUSES(a_width_that_is_no_whole_number_is_refused, 3, "whole number", GOOD "output: { width = 640.5; };\n")
REFUSES(no_frames_are_refused, 3, "'frames'", GOOD "output: { frames = 0; };\n")
REFUSES(an_fps_of_0_is_refused, 3, "'fps' must be in (0, 1000], got 0", GOOD "output: { fps = 0; };\n")
REFUSES(a_background_of_two_numbers_is_refused, 3, "'background' must be three numbers", GOOD "background = [0.0, 0.0];\n")
REFUSES(a_negative_background_is_refused, 3, "'background'", GOOD "background = (0, -1, 0);\n")
REFUSES(an_array_of_mixed_numbers_is_refused_with_advice, 3, "write [0.0, 1.0, 0.5]", GOOD "background = [0, 1.0, 0];\n")
REFUSES(a_scene_without_a_camera_is_refused, 0, "there is no 'camera'", MESH)
REFUSES(a_camera_without_keys_is_refused, 2, "camera: needs either 'keys' or 'use'", MESH "camera: { near = 1; };\n")
REFUSES(a_camera_with_keys_and_a_name_is_refused, 2, "camera: needs either 'keys' or 'use'",
        MESH "camera: { use = \"c\"; keys = ( { eye = (0, 1, 3); target = (0, 1, 0); } ); };\n")
REFUSES(a_first_key_without_an_eye_is_refused, 2, "camera key 1: the first key needs 'eye'",
        MESH "camera: { keys = ( { target = (0, 0, 0); } ); };\n")
REFUSES(a_field_of_view_of_170_degrees_is_refused, 2, "camera key 1: 'fov' must be in (1, 170), got 170",
        MESH "camera: { keys = ( { eye = (0, 1, 3); target = (0, 1, 0); fov = 170; } ); };\n")
REFUSES(an_eye_at_its_target_is_refused, 2, "same point",
        MESH "camera: { keys = ( { eye = (1, 2, 3); target = (1, 2, 3); } ); };\n")
REFUSES(an_up_along_the_view_is_refused, 2, "'up' is zero or parallel",
        MESH "camera: { keys = ( { eye = (0, 3, 0); target = (0, 0, 0); } ); };\n")
REFUSES(camera_keys_out_of_order_are_refused, 3, "camera key 2: 'time' must be after",
        MESH "camera: { keys = ( { time = 2; eye = (0, 1, 3); target = (0, 1, 0); },\n{ time = 1; } ); };\n")
REFUSES(a_key_without_a_time_is_refused, 3, "camera key 2: 'time' must be after",
        MESH "camera: { keys = ( { eye = (0, 1, 3); target = (0, 1, 0); },\n{ fov = 30; } ); };\n")
REFUSES(an_exposure_of_0_is_refused, 2, "camera: 'exposure'", MESH "camera: { use = \"c\"; exposure = 0; };\n")
REFUSES(a_light_with_a_cone_of_270_degrees_is_refused_with_its_line, 4, "light 2: 'outer' must be in (0, 90], got 270",
        GOOD "lights = ( { type = \"point\"; " KEYS "},\n{ type = \"spot\"; outer = 270; " SPOT "} );\n")
REFUSES(an_inner_cone_outside_the_outer_is_refused, 3, "light 1: 'inner' (60)",
        GOOD "lights = ( { type = \"spot\"; inner = 60; outer = 40; " SPOT "} );\n")
REFUSES(a_light_without_a_type_is_refused, 3, "light 1: needs a 'type'", GOOD "lights = ( { " KEYS "} );\n")
REFUSES(a_light_of_unknown_type_is_refused, 3, "'type' must be \"point\", \"spot\" or \"directional\", got \"sun\"",
        GOOD "lights = ( { type = \"sun\"; " KEYS "} );\n")
REFUSES(a_light_without_keys_is_refused, 3, "light 1: needs either", GOOD "lights = ( { type = \"point\"; } );\n")
REFUSES(a_spot_light_without_a_target_is_refused, 3, "needs a 'target'", GOOD "lights = ( { type = \"spot\"; " KEYS "} );\n")
REFUSES(a_point_light_with_a_target_is_refused, 3, "'target' is for spot and directional lights",
        GOOD "lights = ( { type = \"point\"; " SPOT "} );\n")
REFUSES(a_point_light_with_a_cone_is_refused, 3, "for spot lights",
        GOOD "lights = ( { type = \"point\"; outer = 20; " KEYS "} );\n")
REFUSES(a_window_without_a_range_is_refused, 3, "needs a 'range'",
        GOOD "lights = ( { type = \"point\"; falloff = \"window\"; " KEYS "} );\n")
REFUSES(a_negative_power_is_refused, 3, "light 1, key 1: 'power'",
        GOOD "lights = ( { type = \"point\"; keys = ( { position = (0, 1, 0); power = (1, -1, 1); } ); } );\n")
REFUSES(a_position_that_is_text_is_refused, 3, "'position' must be three numbers",
        GOOD "lights = ( { type = \"point\"; keys = ( { position = (\"a\", 0, 0); power = (1, 1, 1); } ); } );\n")
REFUSES(photons_that_are_no_truth_value_are_refused, 3, "'photons' must be true or false",
        GOOD "lights = ( { type = \"point\"; photons = 1; " KEYS "} );\n")
REFUSES(a_material_without_a_name_is_refused, 3, "material 1: needs a 'name'", GOOD "materials = ( { cutoff = 0.5; } );\n")
REFUSES(a_material_given_twice_is_refused, 4, "material 2: 'a' was already given",
        GOOD "materials = ( { name = \"a\"; },\n{ name = \"a\"; } );\n")
REFUSES(a_reflectance_above_1_is_refused, 3, "'color' must have its numbers in [0, 1], got 1.5",
        GOOD "materials = ( { name = \"a\"; color = (1.5, 0, 0); } );\n")
REFUSES(a_million_and_one_photons_are_refused, 3, "quality: 'photons'", GOOD "quality: { photons = 1000001; };\n")
REFUSES(zero_bounces_are_refused, 3, "quality: 'bounces' must be in [1, 32], got 0", GOOD "quality: { bounces = 0; };\n")
REFUSES(a_tile_of_24_pixels_is_refused, 3, "'tile' must be 8, 16, 32 or 64, got 24", GOOD "quality: { tile = 24; };\n")
REFUSES(one_sample_in_2_is_refused, 3, "'indirect_samples' must be 1, 4 or 16, got 2",
        GOOD "quality: { indirect_samples = 2; };\n")
REFUSES(an_unknown_filter_is_refused, 3, "'texture_filter' must be \"nearest\", \"bilinear\" or \"trilinear\", got \"cubic\"",
        GOOD "quality: { texture_filter = \"cubic\"; };\n")
REFUSES(a_filter_that_is_a_number_is_refused, 3, "'texture_filter' must be \"nearest\"",
        GOOD "quality: { texture_filter = 2; };\n")
REFUSES(vertices_of_17_bits_are_refused, 3, "'vertex_bits' must be 32 or 16, got 17", GOOD "quality: { vertex_bits = 17; };\n")
REFUSES(samples_of_8_bits_are_refused, 3, "'sample_bits' must be 32 or 16, got 8", GOOD "quality: { sample_bits = 8; };\n")
REFUSES(normals_of_a_word_are_refused, 3, "'normal_bits' must be 16 or 8", GOOD "quality: { normal_bits = \"few\"; };\n")
REFUSES(one_sample_in_none_is_refused, 3, "'indirect_samples'", GOOD "quality: { indirect_samples = 0; };\n")
REFUSES(a_radius_that_is_a_word_is_refused, 3, "or \"auto\"", GOOD "quality: { radius = \"big\"; };\n")
REFUSES(raw_lists_are_refused, 3, "needs estimate \"buckets\"", GOOD "quality: { smoothing = \"raw\"; };\n")
REFUSES(light_zones_without_zones_are_refused, 3, "needs zones", GOOD "quality: { light_zones = true; };\n")
REFUSES(a_flattening_of_a_sphere_is_refused, 3, "needs kernel", GOOD "quality: { flatten = 3; };\n")
REFUSES(an_error_with_a_line_feed_in_it_stays_one_line, 3, "got \"a?b\"", GOOD "lights = ( { type = \"a\\nb\"; " KEYS "} );\n")

static void refuse_path(const char *path, const char *what) {
    scene s;
    vit_text why = {{0}};
    assert_int_equal(scene_read(path, &s, &why), VIT_BAD_INPUT);
    if (!strstr(why.text, what))
        print_error("%s\n", why.text);
    assert_non_null(strstr(why.text, what));
}

static void a_missing_scene_is_refused(void **state) {
    (void)state;
    refuse_path("no/such/scene.cfg", "no/such/scene.cfg: is not there");
}

static void a_folder_is_refused(void **state) {
    (void)state;
    refuse_path(FOLDER, "is a folder");
}

static void an_endless_device_is_refused(void **state) {
    (void)state;
    refuse_path("/dev/zero", "is not a file");
}

static void a_scene_of_17_megabytes_is_refused(void **state) {
    (void)state;
    put(NAME, GOOD);
    assert_int_equal(truncate(NAME, 17 << 20), 0);
    refuse_path(NAME, "is larger than 16 MiB");
}

static void a_path_beyond_all_bounds_is_refused(void **state) {
    static char path[4000];
    scene s;
    vit_text why;
    (void)state;
    memset(path, 'a', sizeof path - 1);
    refuse_path(path, "longer than");
    assert_int_equal(scene_for_mesh(path, &s, &why), VIT_BAD_INPUT);
}

static void an_included_folder_is_refused(void **state) {
    (void)state;
    put(NAME, GOOD "@include \".\"\n");
    refuse_path(NAME, "is a folder");
}

static void a_missing_include_is_refused_with_its_line(void **state) {
    (void)state;
    refuse(GOOD "@include \"nowhere.cfg\"\n", 3, "include");
}

static void an_include_of_an_absolute_path_is_refused(void **state) {
    (void)state;
    refuse(GOOD "@include \"/etc/hostname\"\n", 3, "@include");
}

static void a_scene_that_includes_itself_is_refused(void **state) {
    (void)state;
    put(NAME, "@include \"test.cfg\"\n");
    refuse_path(NAME, "@include goes deeper than 10 files");
}

/* Files that include each other several times: what they make together doubles with every level. */
static void more_than_256_included_files_are_refused(void **state) {
    char text[2048] = "";
    (void)state;
    for (int i = 0; i < 20; i++)
        strcat(text, "@include \"part.cfg\"\n");
    put(NAME, text);
    for (char *c = strstr(text, "part"); c; c = strstr(c, "part"))
        memcpy(c, "deep", 4);
    put(VIT_BUILD_DIR "/tests/unit/scene_files/part.cfg", text);
    put(VIT_BUILD_DIR "/tests/unit/scene_files/deep.cfg", "\n");
    refuse_path(NAME, "more than 256 files are included");
}

static void a_mistake_in_an_include_names_the_include(void **state) {
    (void)state;
    put(VIT_BUILD_DIR "/tests/unit/scene_files/part.cfg", "\noutput: { width = 0; };\n");
    put(NAME, GOOD "@include \"part.cfg\"\n");
    refuse_path(NAME, "part.cfg:2: output: 'width'");
}

/* Any prefix of a good scene is refused or read, but never more than that (run under sanitizers). */
static void no_prefix_of_a_scene_does_harm(void **state) {
    static char text[sizeof full];
    (void)state;
    for (size_t n = 0; n < sizeof full; n += 3) {
        scene s;
        vit_text why = {{0}};
        memcpy(text, full, n);
        text[n] = '\0';
        put(NAME, text);
        if (scene_read(NAME, &s, &why) == VIT_OK)
            scene_free(&s);
        else
            assert_int_equal(strncmp(why.text, NAME ":", sizeof NAME), 0);
    }
}

#define T(name) cmocka_unit_test(name)

int main(void) {
    static const struct CMUnitTest tests[] = {
        T(every_setting_of_output_and_quality_is_read),
        T(every_setting_of_a_mesh_is_read),
        T(every_setting_of_the_camera_is_read_and_later_keys_repeat_earlier_ones),
        T(every_setting_of_a_light_is_read),
        T(every_setting_of_a_material_is_read),
        T(what_is_left_out_has_its_default),
        T(a_scene_without_lights_is_good),
        T(a_camera_by_name_keeps_its_exposure),
        T(the_cameras_exposure_is_the_first_keys),
        T(a_bare_mesh_makes_an_automatic_scene),
        T(includes_are_found_beside_the_scene),
        T(an_empty_file_is_refused),
        T(a_scene_without_meshes_is_refused),
        T(an_empty_list_of_meshes_is_refused),
        T(a_mesh_without_a_file_is_refused),
        T(a_mesh_of_scale_0_is_refused),
        T(a_mesh_of_infinite_scale_is_refused),
        T(a_mesh_that_is_no_group_is_refused),
        T(meshes_that_are_no_list_are_refused),
        T(an_unknown_setting_is_refused),
        T(an_unknown_setting_of_a_group_is_refused),
        T(an_unknown_setting_of_a_key_is_refused),
        T(a_setting_given_twice_is_refused),
        T(text_that_is_no_scene_is_refused),
        T(a_width_of_0_is_refused),
        T(a_height_of_4321_is_refused),
        T(a_width_beyond_32_bits_is_refused),
        T(a_width_that_32_bits_would_wrap_is_refused),
        T(a_width_that_64_bits_would_wrap_is_refused),
        T(a_negative_number_beyond_32_bits_is_refused),
        T(frames_beyond_32_bits_are_refused),
        T(a_vector_beyond_32_bits_is_refused),
        T(an_octal_number_is_refused),
        T(an_octal_number_of_64_bits_is_refused),
        T(a_hexadecimal_number_is_refused),
        T(a_binary_number_is_refused),
        T(a_choice_beyond_32_bits_is_refused),
        T(a_comma_behind_the_last_light_is_refused),
        T(a_comma_behind_the_last_number_is_refused),
        T(utf_16_is_refused),
        T(what_looks_like_a_number_in_text_or_names_is_none),
        T(a_byte_order_mark_is_passed_over),
        T(numbers_may_say_that_they_are_long),
        T(what_an_include_holds_is_looked_at_too),
        T(a_width_that_is_no_whole_number_is_refused),
        T(no_frames_are_refused),
        T(an_fps_of_0_is_refused),
        T(a_background_of_two_numbers_is_refused),
        T(a_negative_background_is_refused),
        T(an_array_of_mixed_numbers_is_refused_with_advice),
        T(a_scene_without_a_camera_is_refused),
        T(a_camera_without_keys_is_refused),
        T(a_camera_with_keys_and_a_name_is_refused),
        T(a_first_key_without_an_eye_is_refused),
        T(a_field_of_view_of_170_degrees_is_refused),
        T(an_eye_at_its_target_is_refused),
        T(an_up_along_the_view_is_refused),
        T(camera_keys_out_of_order_are_refused),
        T(a_key_without_a_time_is_refused),
        T(an_exposure_of_0_is_refused),
        T(a_light_with_a_cone_of_270_degrees_is_refused_with_its_line),
        T(an_inner_cone_outside_the_outer_is_refused),
        T(a_light_without_a_type_is_refused),
        T(a_light_of_unknown_type_is_refused),
        T(a_light_without_keys_is_refused),
        T(a_spot_light_without_a_target_is_refused),
        T(a_point_light_with_a_target_is_refused),
        T(a_point_light_with_a_cone_is_refused),
        T(a_window_without_a_range_is_refused),
        T(a_negative_power_is_refused),
        T(a_position_that_is_text_is_refused),
        T(photons_that_are_no_truth_value_are_refused),
        T(a_material_without_a_name_is_refused),
        T(a_material_given_twice_is_refused),
        T(a_reflectance_above_1_is_refused),
        T(a_million_and_one_photons_are_refused),
        T(zero_bounces_are_refused),
        T(a_tile_of_24_pixels_is_refused),
        T(one_sample_in_2_is_refused),
        T(one_sample_in_none_is_refused),
        T(vertices_of_17_bits_are_refused),
        T(samples_of_8_bits_are_refused),
        T(normals_of_a_word_are_refused),
        T(an_unknown_filter_is_refused),
        T(a_filter_that_is_a_number_is_refused),
        T(a_radius_that_is_a_word_is_refused),
        T(raw_lists_are_refused),
        T(light_zones_without_zones_are_refused),
        T(a_flattening_of_a_sphere_is_refused),
        T(an_error_with_a_line_feed_in_it_stays_one_line),
        T(a_missing_scene_is_refused),
        T(a_folder_is_refused),
        T(an_endless_device_is_refused),
        T(a_scene_of_17_megabytes_is_refused),
        T(a_path_beyond_all_bounds_is_refused),
        T(an_included_folder_is_refused),
        T(a_missing_include_is_refused_with_its_line),
        T(an_include_of_an_absolute_path_is_refused),
        T(a_scene_that_includes_itself_is_refused),
        T(more_than_256_included_files_are_refused),
        T(a_mistake_in_an_include_names_the_include),
        T(no_prefix_of_a_scene_does_harm),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
