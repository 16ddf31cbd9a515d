/* The child that reads mesh files. What is hard: what it guards against are files that end foreign libraries, which differ from
 * release to release, and none of which is to lie about here. Strategy: the linker puts this file's import_file() in place of
 * the importer's (tests/test.mk), so that the child can be made to crash, loop, eat memory, fall silent or lie at will; each
 * must end in one line, VIT_BAD_INPUT and nothing to free, and this process must live. What comes back is not trusted either:
 * messages are forged byte by byte. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/import_child"
#include "import/importer.h"
#include "test_folder.h"
#include <math.h>
#include <signal.h>
#include <sys/resource.h>

#define MESH FOLDER "/mesh.obj"

bool __real_import_file(importer *im, const scene_mesh *mesh);
bool __wrap_import_file(importer *im, const scene_mesh *mesh);

static bool (*behaviour)(importer *im, const scene_mesh *mesh);

bool __wrap_import_file(importer *im, const scene_mesh *mesh) {
    return behaviour ? behaviour(im, mesh) : __real_import_file(im, mesh);
}

static int warnings;

static void count(void *user, const char *line) {
    (void)user;
    assert_null(strchr(line, '\n'));
    warnings++;
}

static vit_status import(model *m, vit_text *why) {
    scene s;
    warnings = 0;
    *why = (vit_text){{0}};
    assert_int_equal(scene_for_mesh(MESH, &s, why), VIT_OK);
    const vit_status status = model_import(&s, false, count, NULL, m, why);
    scene_free(&s);
    return status;
}

static void refuses(bool (*as)(importer *, const scene_mesh *), const char *what) {
    model m;
    vit_text why;
    behaviour = as;
    const vit_status status = import(&m, &why);
    behaviour = NULL;
    if (status != VIT_BAD_INPUT || strncmp(why.text, MESH ": ", strlen(MESH ": ")) != 0 || !strstr(why.text, what) ||
        strchr(why.text, '\n'))
        fail_msg("%d '%s', want '%s'", status, why.text, what);
    assert_null(m.position);
    assert_null(m.files.files);
}

static void mesh_file(void) {
    folder_make(FOLDER);
    put(MESH, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
}

/* ---- ends ---- */

static bool crash(importer *im, const scene_mesh *mesh) {
    (void)im;
    (void)mesh;
    (void)raise(SIGSEGV);
    return true;
}

static bool assertion(importer *im, const scene_mesh *mesh) {
    (void)im;
    (void)mesh;
    abort();
}

static bool leave(importer *im, const scene_mesh *mesh) {
    (void)im;
    (void)mesh;
    _exit(0);
}

static bool be_killed(importer *im, const scene_mesh *mesh) {
    (void)im;
    (void)mesh;
    (void)kill(getpid(), SIGKILL);
    return true;
}

static void a_reader_that_ends_is_one_line(void **state) {
    (void)state;
    refuses(crash, "breaks down");
    refuses(assertion, "breaks down");
    refuses(leave, "breaks down");
    refuses(be_killed, "memory");
}

/* The product's limit is seconds; one second of processor time shows the same. */
static bool loop(importer *im, const scene_mesh *mesh) {
    struct rlimit limit;
    (void)mesh;
    if (getrlimit(RLIMIT_CPU, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
        return import_fail(im, "there is no limit");
    limit.rlim_cur = 1;
    (void)setrlimit(RLIMIT_CPU, &limit);
    for (volatile unsigned i = 0;; i++)
        ;
}

static void a_reader_that_never_comes_back_is_ended(void **state) {
    (void)state;
    refuses(loop, "too long");
}

static bool eat(importer *im, const scene_mesh *mesh) {
    (void)mesh;
    for (int i = 0; i < 1024; i++)
        if (!malloc((size_t)1 << 30)) /* not touched: it takes addresses alone */
            return import_fail(im, "is full");
    return import_fail(im, "takes a TiB");
}

static void a_reader_does_not_get_all_the_memory(void **state) {
    (void)state;
#ifdef __SANITIZE_ADDRESS__
    skip();
#endif
    refuses(eat, "is full");
}

static bool warn_and_fail(importer *im, const scene_mesh *mesh) {
    (void)mesh;
    import_warn(im, "one\nline");
    return import_fail(im, "no\nmore");
}

static void warnings_and_errors_come_through_on_one_line_each(void **state) {
    (void)state;
    refuses(warn_and_fail, "no more");
    assert_int_equal(warnings, 1);
}

static void what_is_read_there_is_as_if_read_here(void **state) {
    model there, here;
    vit_text why;
    scene s;
    (void)state;
    assert_int_equal(import(&there, &why), VIT_OK);
    assert_int_equal(scene_for_mesh(MESH, &s, &why), VIT_OK);
    assert_int_equal(model_import_here(&s, false, NULL, NULL, &here, &why), VIT_OK);
    scene_free(&s);
    assert_true(there.triangles == 1 && there.vertices == here.vertices && there.material_count == here.material_count);
    assert_memory_equal(there.position, here.position, 3 * sizeof(float) * here.vertices);
    assert_memory_equal(there.normal, here.normal, 3 * sizeof(float) * here.vertices);
    assert_memory_equal(there.index, here.index, 3 * sizeof(uint32_t));
    assert_memory_equal(there.materials, here.materials, sizeof *here.materials);
    assert_true(inputs_hold(&there.files, MESH));
    model_free(&there);
    model_free(&here);
}

/* ---- lies ---- */

/* What the child is to change of the model before it sends it. */
static void (*lie)(importer *im);

static bool read_and_lie(importer *im, const scene_mesh *mesh) {
    if (!__real_import_file(im, mesh))
        return false;
    lie(im);
    return true;
}

static void index_out_of_range(importer *im) {
    im->m->index[2] = 3;
}
static void material_out_of_range(importer *im) {
    im->m->material[0] = 1;
}
static void vertex_is_nan(importer *im) {
    im->m->position[4] = nanf("");
}
static void normal_is_infinite(importer *im) {
    im->m->normal[0] = INFINITY;
}
static void albedo_is_above_one(importer *im) {
    im->m->materials[0].albedo[1] = 1.5f;
}
static void kind_is_none(importer *im) {
    im->m->materials[0].kind = 77;
}
static void image_is_none(importer *im) {
    im->m->materials[0].image = 0;
}
static void wrap_is_none(importer *im) {
    im->m->materials[0].wrap_v = 9;
}
static void switch_is_neither(importer *im) {
    memset(&im->m->materials[0].area_light, 0x55, 1);
}
static void reader_is_none(importer *im) {
    im->m->formats[0].reader = 99;
}
static void unit_is_none(importer *im) {
    im->m->formats[0].frame.unit = 0.0;
}
static void axis_is_none(importer *im) {
    im->m->formats[0].frame.up = 3;
}
static void two_readers(importer *im) {
    im->m->format_count = 2;
}
static void more_extensions_than_there_are(importer *im) {
    im->m->extension_count = 1 << 20;
}
static void more_materials_than_triangles(importer *im) {
    im->m->material_count = 1 << 30;
}
static void more_vertices_than_corners(importer *im) {
    im->m->vertices = 4;
}
static void too_many_triangles(importer *im) {
    im->m->triangles = VIT_MAX_TRIANGLES + 1;
}
static void lies_about_the_model_are_seen(void **state) {
    static void (*const lies[])(importer *) = {index_out_of_range,
                                               material_out_of_range,
                                               vertex_is_nan,
                                               normal_is_infinite,
                                               albedo_is_above_one,
                                               kind_is_none,
                                               image_is_none,
                                               wrap_is_none,
                                               switch_is_neither,
                                               reader_is_none,
                                               unit_is_none,
                                               axis_is_none,
                                               two_readers,
                                               more_extensions_than_there_are,
                                               more_materials_than_triangles,
                                               more_vertices_than_corners,
                                               too_many_triangles};
    (void)state;
    for (size_t i = 0; i < sizeof lies / sizeof lies[0]; i++) {
        lie = lies[i];
        refuses(read_and_lie, "breaks down");
    }
}

/* Messages that no child would send. */
static const void *raw;
static size_t raw_size;

static bool say_raw(importer *im, const scene_mesh *mesh) {
    (void)mesh;
    if (write(im->to_parent->fd, raw, raw_size) < 0)
        _exit(1);
    _exit(0);
}

static void messages_of_no_kind_are_seen(void **state) {
    static const wire_head heads[] = {
        {0, 0}, {99, 8}, {WIRE_MODEL, 8}, {WIRE_MODEL, UINT64_MAX}, {WIRE_FAILURE, 1 << 20}, {WIRE_WARNING, UINT64_MAX}};
    uint64_t zeros[64] = {0};
    (void)state;
    for (size_t i = 0; i < sizeof heads / sizeof heads[0]; i++) {
        raw = &heads[i];
        raw_size = sizeof heads[i];
        refuses(say_raw, "breaks down");
    }
    raw = heads;
    raw_size = 3; /* half a head */
    refuses(say_raw, "breaks down");
    raw = zeros;
    raw_size = sizeof zeros;
    refuses(say_raw, "breaks down");
}

static int set_up(void **state) {
    (void)state;
    mesh_file();
    return 0;
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_reader_that_ends_is_one_line),
        cmocka_unit_test(a_reader_that_never_comes_back_is_ended),
        cmocka_unit_test(a_reader_does_not_get_all_the_memory),
        cmocka_unit_test(warnings_and_errors_come_through_on_one_line_each),
        cmocka_unit_test(what_is_read_there_is_as_if_read_here),
        cmocka_unit_test(lies_about_the_model_are_seen),
        cmocka_unit_test(messages_of_no_kind_are_seen),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
