/* What the tools write against what they read: no output may be an input, by any name or link, no two outputs one file, and
 * what cannot be written is refused before the work rather than after it.
 *
 * Strategy: the real programs on a scene of every kind of input (scene file, include, mesh, MTL, texture, sky), made here. Each
 * output option is pointed at each input by its name, by a symbolic and by a hard link; whatever is refused, all inputs must
 * have the bytes that they had. That a refusal comes before the work shows by the stages that the baker prints: none may be
 * there. */
#include "test_folder.h"
#include "tool_run.h"

#include "vitrine.h"
#include <fcntl.h>

#define FOLDER VIT_BUILD_DIR "/tests/golden/outputs"
#define TOOL_COST VIT_BUILD_DIR "/vitrine-cost"
#define SCENE FOLDER "/scene.cfg"
#define PACK FOLDER "/good.vit"
#define WORK FOLDER "/good.work"
#define AS FOLDER "/link" /* the name by which an output leads to an input */

typedef struct made {
    const char *name, *text;
} made;

/* The files of the scene. The texture and the sky are PNM files, which stb reads as well. */
static const made files[] = {
    {"scene.cfg",
     "output: { width = 8; height = 8; frames = 2; };\nmeshes = ( { file = \"mesh.obj\"; } );\n@include \"part.cfg\"\n"
     "sky: { image = \"sky.ppm\"; };\nmaterials = ( { name = \"plain\"; texture = \"over.ppm\"; } );\n"
     "quality: { photons = 10; };\n"},
    {"part.cfg", "camera: { keys = ( { eye = (0.3, 0.3, 3); target = (0.3, 0.3, 0); } ); };\n"},
    {"mesh.obj", "mtllib mesh.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl painted\nf 1/1 2/2 3/3\nv 0 0 "
                 "-1\nv 1 0 -1\nv 0 1 -1\n"
                 "usemtl plain\nf 4/1 5/2 6/3\n"},
    {"mesh.mtl", "newmtl painted\nKd 1 1 1\nmap_Kd paint.ppm\nnewmtl plain\nKd 0.5 0.5 0.5\n"},
    {"paint.ppm", "P6\n2 1\n255\nabcdef"},
    {"over.ppm", "P6\n1 1\n255\nxyz"},
    {"sky.ppm", "P6\n2 1\n255\nABCDEF"},
};
enum { FILES = sizeof files / sizeof files[0] };

static tool_run r;

/* A file of the folder, in the place of what has that name. */
static void put_anew(const char *name, const char *text) {
    char path[256];
    path_join(path, sizeof path, FOLDER, name);
    (void)unlink(path);
    put(path, text);
}

static void check_inputs(void) {
    char path[256], got[1024];
    for (size_t i = 0; i < FILES; i++) {
        path_join(path, sizeof path, FOLDER, files[i].name);
        read_into(path, got, sizeof got);
        if (strcmp(got, files[i].text) != 0)
            fail_msg("%s\nhas destroyed %s", r.line, path);
    }
}

static int set_up(void **state) {
    (void)state;
    folder_make(FOLDER);
    folder_make(FOLDER "/d");
    for (size_t i = 0; i < FILES; i++)
        put_anew(files[i].name, files[i].text);
    static const char *const left[] = {AS, AS ".json", FOLDER "/one", FOLDER "/protected"}; /* by a run that failed */
    for (size_t i = 0; i < sizeof left / sizeof left[0]; i++)
        (void)unlink(left[i]);
    tool(&r, TOOL_BAKE " " SCENE " -o " PACK " --device host --quiet --strict");
    tool_succeeds(&r);
    tool(&r, TOOL_PLAY " " PACK " --device host --quiet --write-work-budget " WORK);
    tool_succeeds(&r);
    return 0;
}

/* Runs `line` with the file `as`, which it writes, leading to `input` by a link of either kind. */
static void refuses_links(const char *line, const char *as, const char *tool_name, const char *input) {
    char folder[512], target[1024];
    assert_non_null(getcwd(folder, sizeof folder));
    (void)snprintf(target, sizeof target, "%s/%s", folder, input);
    for (int hard = 0; hard < 2; hard++) {
        (void)unlink(as);
        assert_int_equal(hard ? link(target, as) : symlink(target, as), 0);
        tool(&r, "%s", line);
        tool_refuses(&r, tool_name, VIT_USAGE, "which is read");
        check_inputs();
        (void)unlink(as);
    }
}

/* No stage is told of while quiet; without it, one that was told of would make two lines of the error. */
#define BAKE TOOL_BAKE " " SCENE " --device host -o "
static void no_pack_is_written_over_what_it_is_made_of(void **state) {
    char path[256];
    (void)state;
    for (size_t i = 0; i < FILES; i++) {
        path_join(path, sizeof path, FOLDER, files[i].name);
        tool(&r, TOOL_BAKE " " SCENE " --device host --quiet -o %s", path);
        tool_refuses(&r, "vitrine-bake", VIT_USAGE, "is read");
        check_inputs();
        refuses_links(TOOL_BAKE " " SCENE " --device host --quiet -o " AS, AS, "vitrine-bake", path);
    }
}

static void a_bare_mesh_is_not_written_over(void **state) {
    (void)state;
    tool(&r, TOOL_BAKE " " FOLDER "/mesh.obj --device host --quiet -o " FOLDER "/mesh.obj");
    tool_refuses(&r, "vitrine-bake", VIT_USAGE, "is read");
    tool(&r, TOOL_BAKE " " FOLDER "/mesh.obj --device host --quiet -o " FOLDER "/mesh.mtl");
    tool_refuses(&r, "vitrine-bake", VIT_USAGE, "is read");
    check_inputs();
}

static void what_the_scene_names_is_known_before_any_stage(void **state) {
    static const char *const known[] = {"scene.cfg", "part.cfg", "mesh.obj", "over.ppm", "sky.ppm"};
    (void)state;
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        tool(&r, BAKE FOLDER "/%s", known[i]);
        tool_refuses(&r, "vitrine-bake", VIT_USAGE, "is read"); /* one line: not even the import was told of */
    }
    check_inputs();
}

static void no_report_is_written_over_the_scene(void **state) {
    static const char *const reports[] = {"report.csv", "report.json", "index.html"};
    char as[256], path[256];
    (void)state;
    for (size_t k = 0; k < sizeof reports / sizeof reports[0]; k++) {
        (void)snprintf(as, sizeof as, FOLDER "/d/%s", reports[k]);
        for (size_t i = 0; i < FILES; i += 3) { /* the scene, the MTL file, the sky */
            path_join(path, sizeof path, FOLDER, files[i].name);
            refuses_links(TOOL_COST " " SCENE " --device host --quiet --no-cache -o " FOLDER "/d", as, "vitrine-cost", path);
        }
    }
    refuses_links(TOOL_COST " " SCENE " --device host --quiet --no-cache --converge 5 -o " FOLDER "/d",
                  FOLDER "/d/converge.svg", "vitrine-cost", FOLDER "/mesh.obj");
    (void)snprintf(as, sizeof as, FOLDER "/d/index.html"); /* --write is read and written */
    put_anew("other.cfg", files[0].text);
    refuses_links(TOOL_COST " " SCENE " --device host --quiet --no-cache --fit 33 --write " FOLDER "/other.cfg -o " FOLDER "/d",
                  as, "vitrine-cost", FOLDER "/other.cfg");
    (void)unlink(FOLDER "/other.cfg");
}

#define PLAY TOOL_PLAY " " PACK " --device host --quiet "
static void the_player_writes_over_nothing_that_it_reads(void **state) {
    (void)state;
    static const struct {
        const char *line, *as;
    } outputs[] = {{PLAY "--out raw:" AS, AS},
                   {PLAY "--out y4m:" AS, AS},
                   {PLAY "--out png:" FOLDER "/d", FOLDER "/d/frame_00001.png"},
                   {PLAY "--out ppm:" FOLDER "/d", FOLDER "/d/frame_00000.ppm"},
                   {PLAY "--report " AS ".json", AS ".json"},
                   {PLAY "--report " AS ".json", AS ".json.part"},
                   {PLAY "--write-work-budget " AS, AS}};
    for (size_t i = 0; i < sizeof outputs / sizeof outputs[0]; i++)
        refuses_links(outputs[i].line, outputs[i].as, "vitrine-play", PACK);
    tool(&r, PLAY "--write-work-budget " PACK);
    tool_refuses(&r, "vitrine-play", VIT_USAGE, "which is read");
    tool(&r, PLAY "--work-budget " WORK " --write-work-budget " WORK);
    tool_refuses(&r, "vitrine-play", VIT_USAGE, "which is read");
    refuses_links(PLAY "--work-budget " WORK " --report " AS ".json", AS ".json", "vitrine-play", WORK);
    tool(&r, PLAY "--verify --work-budget " WORK); /* both are as they were */
    tool_succeeds(&r);
    tool(&r, PLAY "--frames 1 --out ppm:" FOLDER "/d"); /* a frame that is not played is not written */
    tool_succeeds(&r);
    (void)unlink(FOLDER "/d/frame_00001.ppm");
}

/* Nobody names the files of frames: what stands in their way is not followed, not replaced, and known before the first. */
static void no_frame_is_written_through_a_link(void **state) {
    struct stat s;
    (void)state;
    assert_int_equal(mkdir(FOLDER "/frames", 0777), 0);
    assert_int_equal(symlink("../over.ppm", FOLDER "/frames/frame_00001.ppm"), 0);
    tool(&r, VIT_BUILD_DIR "/vitrine-play " PACK " --quiet --device host --out ppm:" FOLDER "/frames");
    tool_refuses(&r, "vitrine-play", VIT_USAGE, "frame_00001.ppm: is there and is a link");
    check_inputs();
    assert_true(lstat(FOLDER "/frames/frame_00001.ppm", &s) == 0 && S_ISLNK(s.st_mode));
    assert_int_not_equal(lstat(FOLDER "/frames/frame_00000.ppm", &s), 0);
    assert_int_equal(unlink(FOLDER "/frames/frame_00001.ppm"), 0);
    assert_int_equal(mkfifo(FOLDER "/frames/frame_00001.ppm", 0666), 0);
    tool(&r, VIT_BUILD_DIR "/vitrine-play " PACK " --quiet --device host --out ppm:" FOLDER "/frames");
    tool_refuses(&r, "vitrine-play", VIT_USAGE, "is not a file");
    assert_int_equal(unlink(FOLDER "/frames/frame_00001.ppm"), 0);
    tool(&r, VIT_BUILD_DIR "/vitrine-play " PACK " --quiet --device host --out ppm:" FOLDER "/frames");
    tool_succeeds(&r);
    tool(&r, "rm -r " FOLDER "/frames");
}

static void two_outputs_of_a_run_are_two_files(void **state) {
    (void)state;
    tool(&r, PLAY "--report " AS ".json --out raw:" AS ".json");
    tool_refuses(&r, "vitrine-play", VIT_USAGE, "the same file");
    tool(&r, PLAY "--report " AS ".json --write-work-budget " FOLDER "/./link.json");
    tool_refuses(&r, "vitrine-play", VIT_USAGE, "the same file");
    put_anew("one", "");
    assert_int_equal(link(FOLDER "/one", AS), 0);
    tool(&r, PLAY "--out raw:" FOLDER "/one --write-work-budget " AS);
    tool_refuses(&r, "vitrine-play", VIT_USAGE, "the same file");
    (void)unlink(AS);
    (void)unlink(FOLDER "/one");
    assert_int_not_equal(access(AS ".json", F_OK), 0);
}

static void refuses_to_begin(const char *line, const char *name, int code, const char *says) {
    tool(&r, "%s", line);
    tool_refuses(&r, name, code, says);
}

static void what_cannot_be_written_is_known_before_the_work(void **state) {
    (void)state;
    put_anew("protected", "mine");
    assert_int_equal(chmod(FOLDER "/protected", 0444), 0);
    refuses_to_begin(BAKE FOLDER "/no/out.vit", "vitrine-bake", VIT_FAILED, "No such file");
    refuses_to_begin(BAKE FOLDER "/d", "vitrine-bake", VIT_FAILED, "is a folder");
    refuses_to_begin(BAKE "/dev/full", "vitrine-bake", VIT_FAILED, "not a regular file");
    refuses_to_begin(BAKE "/proc/out.vit", "vitrine-bake", VIT_FAILED, "/proc/out.vit");
    refuses_to_begin(BAKE FOLDER "/protected", "vitrine-bake", VIT_FAILED, "protected: ");
    refuses_to_begin(BAKE "-", "vitrine-bake", VIT_USAGE, "-o: a file");
    refuses_to_begin(TOOL_BAKE " " SCENE " --device 999 -o " AS, "vitrine-bake", VIT_FAILED, "999");
    refuses_to_begin(TOOL_COST " " SCENE " -o " FOLDER "/mesh.obj/d", "vitrine-cost", VIT_FAILED, "mesh.obj");
    refuses_to_begin(TOOL_COST " " SCENE " -o /proc/d", "vitrine-cost", VIT_FAILED, "/proc");
    refuses_to_begin(TOOL_COST " " SCENE " -o -", "vitrine-cost", VIT_USAGE, "-o");
    refuses_to_begin(TOOL_COST " " SCENE " --fit 33 --cache " FOLDER "/mesh.obj", "vitrine-cost", VIT_FAILED, "mesh.obj");
    refuses_to_begin(TOOL_COST " " SCENE " --fit 33 --knobs photons,none", "vitrine-cost", VIT_USAGE, "no knob 'none'");
    refuses_to_begin(TOOL_COST " " SCENE " --fit 33 --frame 2", "vitrine-cost", VIT_USAGE, "frames 0 to 1");
    refuses_to_begin(TOOL_COST " " SCENE " --device 999 --fit 33", "vitrine-cost", VIT_FAILED, "999");
    refuses_to_begin(PLAY "--out raw:" FOLDER "/no/out", "vitrine-play", VIT_FAILED, "No such file");
    refuses_to_begin(PLAY "--out y4m:" FOLDER "/d", "vitrine-play", VIT_FAILED, "is a folder");
    refuses_to_begin(PLAY "--out png:" FOLDER "/mesh.obj/d", "vitrine-play", VIT_FAILED, "mesh.obj");
    refuses_to_begin(PLAY "--out ppm:-", "vitrine-play", VIT_USAGE, "folder");
    refuses_to_begin(PLAY "--report=/proc/r.json", "vitrine-play", VIT_FAILED, "/proc/r.json");
    refuses_to_begin(PLAY "--report=-", "vitrine-play", VIT_USAGE, "--report");
    refuses_to_begin(PLAY "--write-work-budget " FOLDER "/protected", "vitrine-play", VIT_FAILED, "protected: ");
    assert_int_equal(unlink(FOLDER "/protected"), 0);
    assert_int_not_equal(access(AS, F_OK), 0);
}

static void a_check_leaves_nothing_behind(void **state) {
    (void)state;
    (void)unlink(FOLDER "/d/out.vit");
    refuses_to_begin(TOOL_BAKE " " SCENE " --device 999 -o " FOLDER "/d/out.vit", "vitrine-bake", VIT_FAILED, "999");
    refuses_to_begin(PLAY "--report " FOLDER "/d/r.json --out raw:" FOLDER "/d/r.raw --write-work-budget " FOLDER "/no/w",
                     "vitrine-play", VIT_FAILED, "No such file");
    assert_int_equal(rmdir(FOLDER "/d"), 0); /* it is empty */
    assert_int_equal(mkdir(FOLDER "/d", 0777), 0);
}

/* A cache is the tool's own: what else lies there under a reference's name is not written over. */
static void the_cache_keeps_what_is_no_reference(void **state) {
    char name[512] = "";
    (void)state;
    tool(&r,
         TOOL_COST " " SCENE " --device host --quiet --fit-work 1e9 --settings 1 --max-samples 16 --cache " FOLDER "/cache");
    tool_succeeds(&r);
    FILE *list = popen("ls " FOLDER "/cache/*.reference", "r");
    assert_non_null(list);
    assert_non_null(fgets(name, sizeof name, list));
    (void)pclose(list);
    name[strcspn(name, "\n")] = '\0';
    put(name, "somebody's letter");
    tool(&r,
         TOOL_COST " " SCENE " --device host --quiet --fit-work 1e9 --settings 1 --max-samples 16 --cache " FOLDER "/cache");
    tool_refuses(&r, "vitrine-cost", VIT_FAILED, "is no reference");
    assert_int_equal(unlink(name), 0);
    (void)rmdir(FOLDER "/cache");
}

/* make-scenes reads scene files and writes others of the same names. */
static void the_sources_of_our_scenes_are_not_written_over(void **state) {
    (void)state;
    if (access(VIT_BUILD_DIR "/make-scenes", X_OK) != 0)
        skip();
    folder_make(FOLDER "/s");
    put_anew("s/cornell.cfg", "mine");
    tool(&r, VIT_BUILD_DIR "/make-scenes " FOLDER "/s " FOLDER "/./s");
    tool_refuses(&r, "make-scenes", VIT_USAGE, "which is read");
    assert_int_equal(access(FOLDER "/s/cornell.obj", F_OK), -1);
    assert_int_equal(link(FOLDER "/s/cornell.cfg", FOLDER "/d/atrium.obj"), 0);
    tool(&r, VIT_BUILD_DIR "/make-scenes " FOLDER "/s " FOLDER "/d");
    tool_refuses(&r, "make-scenes", VIT_USAGE, "which is read");
    struct stat s;
    assert_true(stat(FOLDER "/s/cornell.cfg", &s) == 0 && s.st_size == 4);
    (void)unlink(FOLDER "/d/atrium.obj");
    (void)unlink(FOLDER "/s/cornell.cfg");
    (void)rmdir(FOLDER "/s");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_pack_is_written_over_what_it_is_made_of),
        cmocka_unit_test(a_bare_mesh_is_not_written_over),
        cmocka_unit_test(what_the_scene_names_is_known_before_any_stage),
        cmocka_unit_test(no_report_is_written_over_the_scene),
        cmocka_unit_test(the_player_writes_over_nothing_that_it_reads),
        cmocka_unit_test(no_frame_is_written_through_a_link),
        cmocka_unit_test(two_outputs_of_a_run_are_two_files),
        cmocka_unit_test(what_cannot_be_written_is_known_before_the_work),
        cmocka_unit_test(a_check_leaves_nothing_behind),
        cmocka_unit_test(the_cache_keeps_what_is_no_reference),
        cmocka_unit_test(the_sources_of_our_scenes_are_not_written_over),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
