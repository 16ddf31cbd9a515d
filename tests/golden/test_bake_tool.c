/* The baker as people run it: exit codes, one-line errors, what is written and what is not left behind.
 *
 * Strategy: the real programs, as a shell would run them. An error is held to three promises: the exit code says the cause,
 * stderr is one line that begins with the tool's name, stdout is empty. A tool that fails or is interrupted may leave no file
 * in the folder that it was to write to. Scenes that the baker refuses are in tests/unit/test_scene.c and
 * test_scene_mistakes.c; here only that it passes those errors on. */
#include "test_packs.h"
#define FOLDER TEST_PACKS "/bake-tool"
#include "tools_lab.h"
#include <signal.h>
#include <time.h>

#define CAMERA "camera: { keys = ( { eye = [0.0, 1.0, 3.0]; target = [0.0, 1.0, 0.0]; } ); };\n"
#define OUT " -o " FOLDER "/out.vit"

static void bake_refuses(const char *line, int code, const char *says) {
    tool(&r, TOOL_BAKE " --quiet %s", line);
    tool_refuses(&r, "vitrine-bake", code, says);
    assert_int_equal(empty(FOLDER), 0);
}

static void the_baker_refuses_options_that_it_does_not_know(void **state) {
    (void)state;
    bake_refuses("scene.cfg --bogus" OUT, VIT_USAGE, "--bogus");
    bake_refuses("scene.cfg -o", VIT_USAGE, "-o");
    bake_refuses("scene.cfg", VIT_USAGE, "where to?");
    bake_refuses("a.cfg b.cfg" OUT, VIT_USAGE, "one scene");
    bake_refuses(OUT, VIT_USAGE, "which scene");
}

static void the_baker_refuses_values_out_of_range(void **state) {
    (void)state;
    bake_refuses("scene.cfg --size 640" OUT, VIT_USAGE, "WIDTHxHEIGHT");
    bake_refuses("scene.cfg --size 4294968576x720" OUT, VIT_USAGE, "WIDTHxHEIGHT"); /* 2^32 + 1280 */
    bake_refuses("scene.cfg --size 0x10" OUT, VIT_USAGE, "WIDTHxHEIGHT");
    bake_refuses("scene.cfg --frames 0" OUT, VIT_USAGE, "--frames");
    bake_refuses("scene.cfg --photons -1" OUT, VIT_USAGE, "--photons");
    bake_refuses("scene.cfg --bounces 33" OUT, VIT_USAGE, "1 to 32");
    bake_refuses("scene.cfg --radius -2" OUT, VIT_USAGE, " m, or auto");
    bake_refuses("scene.cfg --radius nan" OUT, VIT_USAGE, " m, or auto");
    bake_refuses("scene.cfg --estimate guess" OUT, VIT_USAGE, "list or buckets");
    bake_refuses("scene.cfg --threads many" OUT, VIT_USAGE, "--threads");
    bake_refuses("scene.cfg --frames 4294967298" OUT, VIT_USAGE, "--frames");           /* 2^32 + 2 */
    bake_refuses("scene.cfg --frames 18446744073709551618" OUT, VIT_USAGE, "--frames"); /* 2^64 + 2 */
    bake_refuses("scene.cfg --frames 2x" OUT, VIT_USAGE, "--frames");
    bake_refuses("scene.cfg --frames +2" OUT, VIT_USAGE, "--frames");
    bake_refuses("scene.cfg --frames 0x2" OUT, VIT_USAGE, "--frames");
    bake_refuses("scene.cfg --frames=" OUT, VIT_USAGE, "--frames");
    bake_refuses("scene.cfg --frames --quiet" OUT, VIT_USAGE, "--frames");
    bake_refuses("scene.cfg --quiet=1" OUT, VIT_USAGE, "takes no value");
    bake_refuses("scene.cfg --radius 0x1p3" OUT, VIT_USAGE, " m, or auto");
    bake_refuses("scene.cfg --radius 0.5m" OUT, VIT_USAGE, " m, or auto");
    bake_refuses("scene.cfg --size=80x45x3" OUT, VIT_USAGE, "WIDTHxHEIGHT");
    bake_refuses("scene.cfg --size=80x4294967341" OUT, VIT_USAGE, "WIDTHxHEIGHT"); /* 2^32 + 45 */
    bake_refuses("scene.cfg -o --explain", VIT_USAGE, "-o");
    bake_refuses("scene.cfg --output=-", VIT_USAGE, "--output: a file");
    bake_refuses("-" OUT, VIT_USAGE, "standard input");
    bake_refuses(TEST_SCENES "/furnace.cfg --tile 24" OUT, VIT_USAGE, "--tile");
    bake_refuses(TEST_SCENES "/furnace.cfg --indirect-samples 2" OUT, VIT_USAGE, "--indirect-samples");
    bake_refuses(TEST_SCENES "/furnace.cfg --texture-filter cubic" OUT, VIT_USAGE, "--texture-filter");
    bake_refuses(TEST_SCENES "/furnace.cfg --vertex-bits 8" OUT, VIT_USAGE, "--vertex-bits");
    bake_refuses(TEST_SCENES "/furnace.cfg --sample-bits 8" OUT, VIT_USAGE, "--sample-bits");
    bake_refuses(TEST_SCENES "/furnace.cfg --antialias 3" OUT, VIT_USAGE, "--antialias");
    bake_refuses(TEST_SCENES "/furnace.cfg --antialias-contrast nan" OUT, VIT_USAGE, "0 to 1");
    bake_refuses(TEST_SCENES "/furnace.cfg --antialias-filter gauss" OUT, VIT_USAGE, "box or tent");
    bake_refuses(TEST_SCENES "/furnace.cfg --light-samples 0" OUT, VIT_USAGE, "--light-samples");
    bake_refuses(TEST_SCENES "/furnace.cfg --effects mirror,mirrors" OUT, VIT_USAGE, "names with commas");
    bake_refuses(TEST_SCENES "/furnace.cfg --effects photons" OUT, VIT_USAGE,
                 "names with commas"); /* not of surfaces, the sky or pixels */
    bake_refuses(TEST_SCENES "/furnace.cfg --effects" OUT, VIT_USAGE, "--effects");
}

static void a_list_bakes_nothing(void **state) {
    (void)state;
    tool(&r, TOOL_BAKE " --list " TEST_SCENES "/cornell.cfg");
    tool_succeeds(&r);
    assert_non_null(strstr(r.out, "meshes 7\n"));
    assert_true(r.err[0] == '\0');
    tool(&r, TOOL_BAKE " --list=json " TEST_SCENES "/cornell.cfg");
    tool_succeeds(&r);
    assert_int_equal(r.out[0], '{');
    bake_refuses("--list=yaml " TEST_SCENES "/cornell.cfg", VIT_USAGE, "--list");
    bake_refuses("--json " TEST_SCENES "/cornell.cfg", VIT_USAGE, "--json");
    bake_refuses("--list " TEST_SCENES "/cornell.cfg" OUT, VIT_USAGE, "--list");
    bake_refuses("--list " FOLDER "/nowhere.glb", VIT_BAD_INPUT, "is not there");
    assert_int_equal(empty(FOLDER), 0);
}

/* A triangle that moves, in a file that says that it needs what nobody reads. */
static void a_list_says_what_is_not_done(void **state) {
    static const char file[] =
        "{\"asset\": {\"version\": \"2.0\"}, \"extensionsUsed\": [\"VENDOR_dream\", \"VENDOR_tint\"], "
        "\"extensionsRequired\": [\"VENDOR_dream\"],"
        "\"scene\": 0, \"scenes\": [{\"nodes\": [0]}], \"nodes\": [{\"mesh\": 0}],"
        "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}}]}],"
        "\"animations\": [{\"channels\": [{\"sampler\": 0, \"target\": {\"node\": 0, \"path\": \"scale\"}}]}],"
        "\"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\", "
        "\"min\": [0, 0, 0], \"max\": [1, 1, 0]}],"
        "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36}],"
        "\"buffers\": [{\"byteLength\": 36, \"uri\": "
        "\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";
    (void)state;
    put(FOLDER "/moves.gltf", file);
    tool(&r, TOOL_BAKE " --list " FOLDER "/moves.gltf");
    tool_succeeds(&r);
    assert_non_null(strstr(r.out, "\nnot done 3\n"));
    assert_non_null(strstr(r.out, "animations are left out"));
    assert_non_null(strstr(r.out, "extension 'VENDOR_dream' is required and not read"));
    assert_non_null(strstr(r.out, "extension 'VENDOR_tint' is used and not read")); /* the file can do without */
    tool(&r, TOOL_BAKE " --list=json " FOLDER "/moves.gltf");
    tool_succeeds(&r);
    assert_non_null(strstr(r.out, "'VENDOR_dream' is required and not read"));
    assert_int_equal(remove(FOLDER "/moves.gltf"), 0);
}

/* With the line that names it, before anything is imported. */
static void what_a_scene_file_names_and_is_not_there_is_named_with_its_line(void **state) {
    static const char camera[] = "camera: { keys = ({ eye = [0.0, 1.0, 3.0]; target = [0.0, 0.0, 0.0]; }); };\n";
    char text[1024];
    (void)state;
    (void)snprintf(text, sizeof text, "%smeshes = ({ file = \"here.obj\"; },\n { file = \"gone.obj\"; });\n", camera);
    put(TEST_PACKS "/names.cfg", text);
    put(TEST_PACKS "/here.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl paint\nf 1 2 3\n");
    bake_refuses(TEST_PACKS "/names.cfg" OUT, VIT_BAD_INPUT, "names.cfg:3: mesh '" TEST_PACKS "/gone.obj' is not there");
    bake_refuses("--list " TEST_PACKS "/names.cfg", VIT_BAD_INPUT, "names.cfg:3: mesh '");
    (void)snprintf(text, sizeof text, "%smeshes = ({ file = \"here.obj\"; });\nsky: {\n image = \"gone.hdr\"; };\n", camera);
    put(TEST_PACKS "/names.cfg", text);
    bake_refuses(TEST_PACKS "/names.cfg" OUT, VIT_BAD_INPUT, "names.cfg:3: sky '" TEST_PACKS "/gone.hdr' is not there");
    (void)snprintf(text, sizeof text,
                   "%smeshes = ({ file = \"here.obj\"; });\nmaterials = (\n{ name = \"paint\"; texture = \"gone.png\"; });\n",
                   camera);
    put(TEST_PACKS "/names.cfg", text);
    bake_refuses("--strict " TEST_PACKS "/names.cfg" OUT, VIT_BAD_INPUT, "names.cfg:4: material 'paint': texture '");
    assert_int_equal(remove(TEST_PACKS "/names.cfg"), 0);
    assert_int_equal(remove(TEST_PACKS "/here.obj"), 0);
}

static void an_option_and_its_value_may_be_one_word(void **state) {
    (void)state;
    tool(&r, TOOL_BAKE " --quiet --no-check --device=host --size=16x12 --frames=1 --photons=10 " TEST_SCENES
                       "/furnace.cfg --output=" FOLDER "/out.vit");
    tool_succeeds(&r);
    tool(&r, TOOL_PLAY " --quiet --device=host --explain " FOLDER "/out.vit");
    tool_succeeds(&r);
    assert_non_null(strstr(r.out, "16x12"));
    assert_int_equal(empty(FOLDER), 1);
}

static void the_baker_names_a_file_that_is_missing(void **state) {
    (void)state;
    bake_refuses(FOLDER "/nowhere.cfg" OUT, VIT_BAD_INPUT, "nowhere.cfg");
    bake_refuses(FOLDER "/nowhere.glb" OUT, VIT_BAD_INPUT, "nowhere.glb");
    bake_refuses(FOLDER OUT, VIT_BAD_INPUT, FOLDER);
}

/* A scene file with this text; `says` holds the line's number where one is to blame. */
static void scene_refused(const char *text, const char *says) {
    put_bytes(TEST_PACKS "/bad.cfg", text, strlen(text));
    bake_refuses(TEST_PACKS "/bad.cfg" OUT, VIT_BAD_INPUT, says);
    (void)unlink(TEST_PACKS "/bad.cfg");
}

static void the_baker_refuses_bad_scenes_with_file_and_line(void **state) {
    (void)state;
    scene_refused("", "meshes");
    scene_refused("meshes = (\n", "bad.cfg:");
    scene_refused("meshes = ( { file = \"room.obj\"; } );\n" CAMERA "quality: { photons = -1; };\n", "bad.cfg:3: ");
    scene_refused("meshes = ( { file = \"room.obj\"; } );\n" CAMERA "speed = 3;\n", "bad.cfg:3: ");
    scene_refused("meshes = ( { file = \"room.obj\"; } );\n" CAMERA "\nlights = ( { type = \"sun\"; } );\n",
                  "bad.cfg:4: light 1");
    scene_refused("meshes = ( { file = \"nowhere.obj\"; } );\n" CAMERA, "nowhere.obj");
    scene_refused("meshes = ( { file = \"room.mtl\"; } );\n" CAMERA, "room.mtl");
    scene_refused("meshes = ( { file = \"room.obj\"; } );\n" CAMERA
                  "materials = ( { name = \"wall\"; texture = \"nowhere.png\"; } );\noutput: { width = 0; };\n",
                  "bad.cfg:4: ");
}

static void a_missing_texture_is_an_error_only_if_strict(void **state) {
    (void)state;
    static const char text[] =
        "output: { width = 16; height = 16; frames = 1; };\nmeshes = ( { file = \"room.obj\"; } );\n" CAMERA
        "materials = ( { name = \"wall\"; texture = \"nowhere.png\"; } );\n";
    put_bytes(TEST_PACKS "/bad.cfg", text, sizeof text - 1);
    bake_refuses("--strict " TEST_PACKS "/bad.cfg" OUT, VIT_BAD_INPUT, "nowhere.png");
    tool(&r, TOOL_BAKE " --quiet --no-check " TEST_PACKS "/bad.cfg" OUT);
    tool_succeeds(&r);
    assert_non_null(strstr(r.err, "warning: "));
    assert_non_null(strstr(r.err, "nowhere.png"));
    assert_int_equal(empty(FOLDER), 1);
    (void)unlink(TEST_PACKS "/bad.cfg");
}

#define SMALL TEST_PACKS "/lamp.cfg --no-check --size 16x16 --frames 1"

/* What a file says that it cannot be understood without (glTF 2.0, 3.12). */
static void a_required_extension_that_is_not_read_is_an_error(void **state) {
    (void)state;
    static const char text[] =
        "{\"asset\": {\"version\": \"2.0\"}, \"extensionsUsed\": [\"VENDOR_x\"], \"extensionsRequired\": [\"VENDOR_x\"],"
        "\"scenes\": [{\"nodes\": [0]}], \"scene\": 0, \"nodes\": [{\"mesh\": 0}], \"meshes\": [{\"primitives\": "
        "[{\"attributes\": {\"POSITION\": 0}}]}],"
        "\"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\", \"min\": [0, 0, 0], "
        "\"max\": [1, 1, 0]}],"
        "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36}], \"buffers\": [{\"byteLength\": 36, \"uri\": "
        "\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";
    put_bytes(TEST_PACKS "/required.gltf", text, sizeof text - 1);
    bake_refuses(TEST_PACKS "/required.gltf" OUT, VIT_BAD_INPUT, "extension 'VENDOR_x' is required and not read");
    bake_refuses("--strict " TEST_PACKS "/required.gltf" OUT, VIT_BAD_INPUT, "extension 'VENDOR_x' is required and not read");
    (void)unlink(TEST_PACKS "/required.gltf");
}

static void a_pack_that_cannot_be_written_is_a_failure_and_leaves_nothing(void **state) {
    (void)state;
    bake_refuses(SMALL " -o " FOLDER "/no/such/folder/out.vit", VIT_FAILED, FOLDER "/no/such/folder/out.vit");
    bake_refuses(SMALL " -o " FOLDER, VIT_FAILED, FOLDER);
    bake_refuses(SMALL " -o /dev/full", VIT_FAILED, "/dev/full");
}

static void a_bake_that_fails_leaves_the_old_pack_alone(void **state) {
    (void)state;
    put_bytes(FOLDER "/out.vit", "old", 3);
    tool(&r, TOOL_BAKE " --quiet " FOLDER "/nowhere.cfg" OUT);
    assert_int_equal(r.code, VIT_BAD_INPUT);
    size_t size;
    char *old = read_file(FOLDER "/out.vit", &size);
    assert_int_equal(size, 3);
    assert_memory_equal(old, "old", 3);
    free(old);
    assert_int_equal(empty(FOLDER), 1);
}

/* Waits until the tool has printed `text` to stderr, however long that takes: a tool that hangs is killed by its alarm. */
static void wait_for(const char *text) {
    const struct timespec pause = {0, 10000000};
    for (siginfo_t ended = {0};; (void)nanosleep(&pause, NULL)) {
        assert_int_equal(waitid(P_PID, (id_t)r.child, &ended, WEXITED | WNOHANG | WNOWAIT), 0);
        tool_text(r.to_err, r.err);
        if (strstr(r.err, text))
            return;
        if (ended.si_pid != 0)
            fail_msg("%s\nended without '%s'\n%s", r.line, text, r.err);
    }
}

/* A baker that cannot be through by the time the signal comes: it stops itself before its output gets its name. */
#define STOPPED_AT_RENAME                                                                                                      \
    "SIGNAL_FOLDER=" FOLDER " SIGNAL_AT=before-rename SIGNAL_NUMBER=%d LD_PRELOAD=" TOOL_SIGNAL_AT " " TOOL_BAKE               \
    " " TEST_SCENES "/cornell.cfg --size 64x48 --frames 30 --device host --indirect %s" OUT

static void an_interrupted_bake_exits_with_1_and_leaves_no_file(void **state) {
    (void)state;
    static const struct {
        const char *done; /* a stage is told when it is done: the next one is running then */
        const char *indirect;
        int number;
    } moments[] = {{"import ", "photons", SIGINT},
                   {"depth slices ", "photons", SIGINT},
                   {"depth slices ", "photons", SIGTERM},
                   {"atlas ", "basis", SIGINT}}; /* while light is baked */
    for (size_t i = 0; i < sizeof moments / sizeof moments[0]; i++) {
        tool_line(&r, STOPPED_AT_RENAME, SIGSTOP, moments[i].indirect);
        tool_begin(&r);
        wait_for(moments[i].done);
        assert_int_equal(kill(r.child, moments[i].number), 0);
        assert_int_equal(kill(r.child, SIGCONT), 0);
        tool_end(&r);
        assert_int_equal(r.code, VIT_FAILED);
        assert_non_null(strstr(r.err, "interrupted"));
        assert_int_equal(empty(FOLDER), 0);
    }
}

static void explain_writes_no_file_and_names_every_buffer(void **state) {
    (void)state;
    tool(&r, TOOL_BAKE " --quiet --explain " SMALL);
    tool_succeeds(&r);
    assert_int_equal(empty(FOLDER), 0);
    static const char *const words[] = {"effects  ", "work units", "buffers\n", "framebuffer", "device bytes", "emission"};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        assert_non_null(strstr(r.out, words[i]));
}

/* The line of --explain that begins with a name. */
static const char *explained(const char *name) {
    static char line[512];
    const char *at = strstr(r.out, name);
    assert_non_null(at);
    (void)snprintf(line, sizeof line, "%.*s", (int)strcspn(at, "\n"), at);
    return line;
}

static void options_choose_effects_as_the_scene_file_does(void **state) {
    (void)state;
    tool(&r, TOOL_BAKE " --quiet --explain " SMALL " --antialias 4 --antialias-filter tent");
    tool_succeeds(&r);
    assert_non_null(strstr(explained("  antialias "), " called for: quality.antialias"));
    assert_non_null(strstr(explained("  film "), "antialias"));
    tool(&r, TOOL_BAKE " --quiet --explain " SMALL " --antialias 4 --effects none");
    tool_succeeds(&r);
    assert_non_null(strstr(explained("  antialias "), "forced off"));
    assert_non_null(strstr(r.err, "warning: antialias is left out: quality.antialias is more than 1"));
    assert_null(strstr(r.out, "  film "));
    tool(&r, TOOL_BAKE " --quiet --explain " SMALL " --effects specular,mirror --specular-depth 3");
    tool_succeeds(&r);
    assert_non_null(strstr(explained("  specular "), "forced on"));
    assert_non_null(strstr(explained("  mirror "), "forced on"));
    assert_non_null(strstr(explained("  glass "), "not called for"));
}

/* What is stated of light that a scene lacks. What is open or by default says nothing, nor where there is such light. */
static void settings_of_light_that_a_scene_lacks_are_an_error_only_if_strict(void **state) {
    (void)state;
    static const char *const idle[][2] = {
        {" --cache progressive", "'cache' does nothing: there is no ambient light of a radius"},
        {" --cache-spacing 4", "'cache_spacing' does nothing: there is no ambient light of a radius"},
        {" --cache-error 0.1", "'cache_error' does nothing: there is no ambient light of a radius"},
        {" --basis-receivers points", "'basis_receivers' does nothing: no basis makes indirect light"},
        {" --point-spacing 4", "'point_spacing' does nothing: irradiance is not baked at points"},
        {" --lightmap baked", "'lightmap' does nothing: no matt surface takes light of the sky or of area lights"},
        {" --lightmap-spacing 4", "'lightmap_spacing' does nothing: no matt surface takes"},
        {" --lightmap-error 0.1", "'lightmap_error' does nothing: no matt surface takes"},
    };
    static const char text[] =
        "output: { width = 16; height = 16; frames = 1; };\nmeshes = ( { file = \"room.obj\"; } );\n" CAMERA
        "ambient = [0.5, 0.5, 0.5]; ambient_radius = 0.5; background = [1.0, 1.0, 1.0];\n"
        "sky: { light = true; }; quality: { cache = \"baked\"; lightmap = \"baked\"; };\n";
    for (size_t i = 0; i < sizeof idle / sizeof idle[0]; i++) {
        char line[256];
        (void)snprintf(line, sizeof line, SMALL " --strict%s" OUT, idle[i][0]);
        bake_refuses(line, VIT_BAD_INPUT, idle[i][1]);
        tool(&r, TOOL_BAKE " --quiet " SMALL "%s" OUT, idle[i][0]);
        tool_succeeds(&r);
        const char *warning = strstr(r.err, "warning: ");
        assert_true(warning && strstr(warning, idle[i][1]) && !strstr(warning + 1, "warning: "));
        assert_int_equal(empty(FOLDER), 1);
    }
    tool(&r, TOOL_BAKE " --quiet " SMALL " --strict --lightmap auto --basis-receivers cells" OUT);
    tool_succeeds(&r);
    assert_null(strstr(r.err, "does nothing"));
    put_bytes(TEST_PACKS "/lit.cfg", text, sizeof text - 1);
    tool(&r, TOOL_BAKE " --quiet --no-check --strict " TEST_PACKS "/lit.cfg" OUT);
    tool_succeeds(&r);
    assert_null(strstr(r.err, "does nothing"));
    assert_int_equal(empty(FOLDER), 1);
    (void)unlink(TEST_PACKS "/lit.cfg");
}

static void a_device_that_is_not_there_is_a_failure(void **state) {
    (void)state;
    tool(&r, TOOL_PLAY " --quiet %s --device 900", test_pack("33x47"));
    tool_refuses(&r, "vitrine-play", VIT_FAILED, "no device 900");
    bake_refuses(SMALL " --device 900" OUT, VIT_FAILED, "no device 900");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_baker_refuses_options_that_it_does_not_know),
        cmocka_unit_test(the_baker_refuses_values_out_of_range),
        cmocka_unit_test(a_list_bakes_nothing),
        cmocka_unit_test(a_list_says_what_is_not_done),
        cmocka_unit_test(what_a_scene_file_names_and_is_not_there_is_named_with_its_line),
        cmocka_unit_test(an_option_and_its_value_may_be_one_word),
        cmocka_unit_test(the_baker_names_a_file_that_is_missing),
        cmocka_unit_test(the_baker_refuses_bad_scenes_with_file_and_line),
        cmocka_unit_test(a_missing_texture_is_an_error_only_if_strict),
        cmocka_unit_test(a_required_extension_that_is_not_read_is_an_error),
        cmocka_unit_test(a_pack_that_cannot_be_written_is_a_failure_and_leaves_nothing),
        cmocka_unit_test(a_bake_that_fails_leaves_the_old_pack_alone),
        cmocka_unit_test(an_interrupted_bake_exits_with_1_and_leaves_no_file),
        cmocka_unit_test(explain_writes_no_file_and_names_every_buffer),
        cmocka_unit_test(options_choose_effects_as_the_scene_file_does),
        cmocka_unit_test(settings_of_light_that_a_scene_lacks_are_an_error_only_if_strict),
        cmocka_unit_test(a_device_that_is_not_there_is_a_failure),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
