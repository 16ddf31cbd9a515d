/* Both tools with real packs: exit codes, one-line errors, what is written and what is not left behind.
 *
 * Strategy: the real programs, as a shell would run them. An error is held to three promises: the exit code says the cause,
 * stderr is one line that begins with the tool's name, stdout is empty. A tool that fails or is interrupted may leave no file
 * in the folder that it was to write to. What the player refuses before it reads a pack is in tests/unit/test_player.c, scenes
 * that the baker refuses are in tests/unit/test_scene.c; here only that the tools pass those errors on. */
#include "pack_image.h"
#include "test_packs.h"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <time.h>

#define FOLDER TEST_PACKS "/tools"
/* What is asked here is the same on every device, and this one compiles nothing. */
#define PLAY_HOST TOOL_PLAY " --device host"
#define CAMERA "camera: { keys = ( { eye = [0.0, 1.0, 3.0]; target = [0.0, 1.0, 0.0]; } ); };\n"

static tool_run r;

/* Removes what is in the folder and returns how many files that were; folders in it are left alone. */
static int empty(const char *folder) {
    int count = 0;
    DIR *d = opendir(folder);
    for (struct dirent *e; d && (e = readdir(d)) != NULL;) {
        char path[512];
        (void)snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        count += unlink(path) == 0;
    }
    if (d)
        (void)closedir(d);
    return count;
}

static int set_up(void **state) {
    (void)state;
    test_packs_begin();
    folder_make(FOLDER);
    (void)empty(FOLDER);
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    static const char *const folders[] = {FOLDER "/png", FOLDER "/ppm", FOLDER};
    for (size_t i = 0; i < sizeof folders / sizeof folders[0]; i++) {
        (void)empty(folders[i]);
        (void)rmdir(folders[i]);
    }
    return 0;
}

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

/* A triangle with a morph target, in a file that says that it needs what nobody reads. */
static void a_list_says_what_is_not_done(void **state) {
    static const char file[] =
        "{\"asset\": {\"version\": \"2.0\"}, \"extensionsUsed\": [\"VENDOR_dream\", \"VENDOR_tint\"], "
        "\"extensionsRequired\": [\"VENDOR_dream\"],"
        "\"scene\": 0, \"scenes\": [{\"nodes\": [0]}], \"nodes\": [{\"mesh\": 0}],"
        "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}, \"targets\": [{\"POSITION\": 0}]}], "
        "\"weights\": [0]}],"
        "\"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\", "
        "\"min\": [0, 0, 0], \"max\": [1, 1, 0]}],"
        "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36}],"
        "\"buffers\": [{\"byteLength\": 36, \"uri\": "
        "\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";
    (void)state;
    put(FOLDER "/morph.gltf", file);
    tool(&r, TOOL_BAKE " --list " FOLDER "/morph.gltf");
    tool_succeeds(&r);
    assert_non_null(strstr(r.out, "\nnot done 2\n"));
    assert_non_null(strstr(r.out, "morph targets are left out"));
    assert_non_null(strstr(r.out, "extension 'VENDOR_dream' is required and not read"));
    assert_null(strstr(r.out, "'VENDOR_tint' is required")); /* the file can do without */
    tool(&r, TOOL_BAKE " --list=json " FOLDER "/morph.gltf");
    tool_succeeds(&r);
    assert_non_null(strstr(r.out, "'VENDOR_dream' is required and not read"));
    assert_int_equal(remove(FOLDER "/morph.gltf"), 0);
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
    tool(&r, TOOL_BAKE " --quiet --device=host --size=16x12 --frames=1 --photons=10 " TEST_SCENES
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
    tool(&r, TOOL_BAKE " --quiet " TEST_PACKS "/bad.cfg" OUT);
    tool_succeeds(&r);
    assert_non_null(strstr(r.err, "warning: "));
    assert_non_null(strstr(r.err, "nowhere.png"));
    assert_int_equal(empty(FOLDER), 1);
    (void)unlink(TEST_PACKS "/bad.cfg");
}

#define SMALL TEST_PACKS "/lamp.cfg --no-check --size 16x16 --frames 1"

/* What a file says that it cannot be understood without (glTF 2.0, 3.12). */
static void a_required_extension_that_is_not_read_is_an_error_if_strict(void **state) {
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
    bake_refuses("--strict " TEST_PACKS "/required.gltf" OUT, VIT_BAD_INPUT, "extension 'VENDOR_x' is required and not read");
    tool(&r, TOOL_BAKE " --quiet --no-check --device host --size 16x16 --frames 1 " TEST_PACKS "/required.gltf" OUT);
    tool_succeeds(&r);
    assert_non_null(strstr(r.err, "warning: " TEST_PACKS "/required.gltf: extension 'VENDOR_x' is required and not read"));
    assert_int_equal(empty(FOLDER), 1);
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
    " " TEST_SCENES "/cornell.cfg --size 64x48 --frames 30 --device host" OUT

static void an_interrupted_bake_exits_with_1_and_leaves_no_file(void **state) {
    (void)state;
    static const struct {
        const char *done; /* a stage is told when it is done: the next one is running then */
        int number;
    } moments[] = {{"import ", SIGINT}, {"depth slices ", SIGINT}, {"depth slices ", SIGTERM}};
    for (size_t i = 0; i < sizeof moments / sizeof moments[0]; i++) {
        tool_line(&r, STOPPED_AT_RENAME, SIGSTOP);
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

/* Changes frame `index`'s golden hash of XRGB8888 and makes all of the pack's hashes right again. */
static void alter_golden(const char *from, const char *to, uint32_t index) {
    image im = {0};
    im.bytes = read_file(from, &im.size);
    im.header = im.bytes;
    im.table = (vit_pack_entry *)(im.header + 1);
    im.golds = section(&im, VIT_SECTION_GOLD);
    im.golds[index].xrgb8888[0] ^= 1;
    forge(&im);
    put_bytes(to, im.bytes, im.size);
    free(im.bytes);
}

static void verify_tells_the_first_frame_that_differs(void **state) {
    (void)state;
    alter_golden(test_pack("list"), FOLDER "/altered.vit", 1);
    tool(&r, TOOL_PLAY " --quiet --verify " FOLDER "/altered.vit");
    tool_refuses(&r, "vitrine-play", VIT_MISMATCH, "frame 1: expected ");
    assert_non_null(strstr(r.err, "1 of 3 frames differ"));
    tool(&r, PLAY_HOST " --quiet --verify --frames 2 " FOLDER "/altered.vit");
    tool_succeeds(&r);
    tool(&r, PLAY_HOST " --quiet " FOLDER "/altered.vit"); /* who does not ask is not told */
    tool_succeeds(&r);
    (void)empty(FOLDER);
}

static void verify_of_a_format_without_golden_hashes_is_a_mismatch(void **state) {
    (void)state;
    tool(&r, PLAY_HOST " --quiet --verify --format rgb565 %s", test_pack("dark"));
    tool_refuses(&r, "vitrine-play", VIT_MISMATCH, "no golden hashes");
}

static void a_pack_cut_short_or_flipped_is_bad_input(void **state) {
    (void)state;
    size_t size;
    char *bytes = read_file(test_pack("lamp"), &size);
    put_bytes(FOLDER "/bad.vit", bytes, size - 1);
    tool(&r, PLAY_HOST " --quiet --verify " FOLDER "/bad.vit");
    tool_refuses(&r, "vitrine-play", VIT_BAD_INPUT, FOLDER "/bad.vit: ");
    bytes[size / 2] ^= 1;
    put_bytes(FOLDER "/bad.vit", bytes, size);
    tool(&r, PLAY_HOST " --quiet --verify " FOLDER "/bad.vit");
    tool_refuses(&r, "vitrine-play", VIT_BAD_INPUT, FOLDER "/bad.vit: ");
    free(bytes);
    (void)empty(FOLDER);
}

static void each_view_shows_something_else(void **state) {
    (void)state;
    static const char *const views[] = {
#define X(name, light, meaning) #name,
        VIT_VIEWS(X)
#undef X
    };
    enum { COUNT = sizeof views / sizeof views[0] };
    char hashes[COUNT][64];
    for (size_t i = 0; i < COUNT; i++) {
        tool(&r, PLAY_HOST " --quiet --hash --frames 0 --view %s %s", views[i], test_pack("33x47"));
        tool_succeeds(&r);
        assert_int_equal(strlen(r.out), 24); /* "000000 0123456789abcdef\n" */
        (void)snprintf(hashes[i], sizeof hashes[0], "%.40s", r.out);
        for (size_t k = 0; k < i; k++)
            if (strcmp(hashes[i], hashes[k]) == 0)
                fail_msg("the views %s and %s are the same picture", views[i], views[k]);
    }
}

/* Bytes of a file; -1: it is not there. */
static long bytes_of(const char *path) {
    struct stat s;
    return stat(path, &s) == 0 ? (long)s.st_size : -1;
}

static void frames_in_files_have_the_right_sizes(void **state) {
    (void)state;
    const char *pack = test_pack("33x47");
    const long pixels = 33 * 47;
    char header[160];
    tool(&r, PLAY_HOST " --quiet %s --out raw:" FOLDER "/a.raw", pack);
    tool_succeeds(&r);
    assert_int_equal(bytes_of(FOLDER "/a.raw"), 2 * 4 * pixels);
    tool(&r, PLAY_HOST " --quiet %s --format rgb565 --out raw:" FOLDER "/a.raw", pack);
    tool_succeeds(&r);
    assert_int_equal(bytes_of(FOLDER "/a.raw"), 2 * 2 * pixels);
    tool(&r, PLAY_HOST " --quiet %s --format rgba32f --out raw:" FOLDER "/a.raw", pack);
    tool_succeeds(&r);
    assert_int_equal(bytes_of(FOLDER "/a.raw"), 2 * 16 * pixels);
    tool(&r, PLAY_HOST " --quiet %s --out y4m:" FOLDER "/a.y4m", pack);
    tool_succeeds(&r);
    FILE *f = fopen(FOLDER "/a.y4m", "rb");
    assert_non_null(f);
    assert_non_null(fgets(header, sizeof header, f));
    (void)fclose(f);
    assert_int_equal(strncmp(header, "YUV4MPEG2 W33 H47 F24:1 ", 24), 0);
    assert_int_equal(bytes_of(FOLDER "/a.y4m"), (long)strlen(header) + 2 * (6 + 3 * pixels));
    tool(&r, PLAY_HOST " --quiet %s --out ppm:" FOLDER "/ppm", pack);
    tool_succeeds(&r);
    assert_int_equal(bytes_of(FOLDER "/ppm/frame_00000.ppm"), 13 + 3 * pixels); /* "P6\n33 47\n255\n" */
    assert_int_equal(bytes_of(FOLDER "/ppm/frame_00001.ppm"), 13 + 3 * pixels);
    assert_int_equal(bytes_of(FOLDER "/ppm/frame_00002.ppm"), -1);
}

static void a_png_says_its_size(void **state) {
    (void)state;
    tool(&r, PLAY_HOST " --quiet %s --frames 1 --out png:" FOLDER "/png", test_pack("33x47"));
    tool_succeeds(&r);
    size_t size;
    unsigned char *png = read_file(FOLDER "/png/frame_00001.png", &size);
    static const unsigned char head[] = {0x89, 'P', 'N', 'G', 13, 10, 26, 10, 0, 0, 0,  13, 'I',
                                         'H',  'D', 'R', 0,   0,  0,  33, 0,  0, 0, 47, 8,  2};
    assert_true(size > 200);
    assert_memory_equal(png, head, sizeof head);
    assert_memory_equal(png + size - 8, "IEND", 4);
    free(png);
    assert_int_equal(bytes_of(FOLDER "/png/frame_00000.png"), -1);
}

static void a_raw_frame_is_what_is_hashed(void **state) {
    (void)state;
    char want[64];
    size_t size;
    tool(&r, PLAY_HOST " --quiet --hash %s --frames 1 --out raw:" FOLDER "/a.raw", test_pack("33x47"));
    tool_succeeds(&r);
    void *frame = read_file(FOLDER "/a.raw", &size);
    (void)snprintf(want, sizeof want, "000001 %016llx\n", (unsigned long long)vit_hash(frame, size));
    assert_string_equal(r.out, want);
    free(frame);
    (void)empty(FOLDER);
}

static void frames_beyond_the_path_are_refused_with_what_there_is(void **state) {
    (void)state;
    tool(&r, PLAY_HOST " --quiet %s --frames 2:9", test_pack("33x47"));
    tool_refuses(&r, "vitrine-play", VIT_USAGE, "frames 0 to 1");
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
        cmocka_unit_test(a_required_extension_that_is_not_read_is_an_error_if_strict),
        cmocka_unit_test(a_pack_that_cannot_be_written_is_a_failure_and_leaves_nothing),
        cmocka_unit_test(a_bake_that_fails_leaves_the_old_pack_alone),
        cmocka_unit_test(an_interrupted_bake_exits_with_1_and_leaves_no_file),
        cmocka_unit_test(explain_writes_no_file_and_names_every_buffer),
        cmocka_unit_test(options_choose_effects_as_the_scene_file_does),
        cmocka_unit_test(verify_tells_the_first_frame_that_differs),
        cmocka_unit_test(verify_of_a_format_without_golden_hashes_is_a_mismatch),
        cmocka_unit_test(a_pack_cut_short_or_flipped_is_bad_input),
        cmocka_unit_test(each_view_shows_something_else),
        cmocka_unit_test(frames_in_files_have_the_right_sizes),
        cmocka_unit_test(a_png_says_its_size),
        cmocka_unit_test(a_raw_frame_is_what_is_hashed),
        cmocka_unit_test(frames_beyond_the_path_are_refused_with_what_there_is),
        cmocka_unit_test(a_device_that_is_not_there_is_a_failure),
    };
    return cmocka_run_group_tests_name("tools", tests, set_up, tear_down);
}
