/* The scene file. What is hard: a scene file is typed by hand, so nearly all of its possible contents are wrong, and each
 * wrong one has to end in a line that says where and why. Strategy: one good scene in which no field has its default, checked
 * field by field, and its defaults; then files that are missing, folders, too large, and includes. Scenes go through real
 * files, since these are half of the subject. Mistakes in settings: test_scene_mistakes.c. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/scene_files"
#include "case_file.h"
#include "scene_file_lab.h"

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

/* ---- files and includes ---- */

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

/* Files that one release of libconfig reads otherwise than the next (../shared/cases). */
static void cases_scene_numbers(void **state) {
    static const char *const rows[][2] = {
        {"scene-numbers/octal.cfg", ":2: '010' begins with 0"},
        {"scene-numbers/wrap.cfg", ":2: '4294967298' is beyond 32 bits"},
        {"scene-numbers/comma.cfg", ":4: ',' has nothing behind it"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        scene s;
        vit_text why = {{0}};
        const char *path = case_file(rows[i][0]);
        if (!path)
            skip();
        assert_int_equal(scene_read(path, &s, &why), VIT_BAD_INPUT);
        assert_non_null(strstr(why.text, rows[i][1]));
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        T(cases_scene_numbers),
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
        T(what_looks_like_a_number_in_text_or_names_is_none),
        T(a_byte_order_mark_is_passed_over),
        T(numbers_may_say_that_they_are_long),
        T(what_an_include_holds_is_looked_at_too),
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
