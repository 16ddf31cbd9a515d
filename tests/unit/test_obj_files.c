/* Statements of OBJ. What is hard: it is written by hand and by hundreds of programs, each of which leaves out or adds
 * something, and a line that is read otherwise than meant moves everything behind it without a word. Strategy: files of a few
 * lines, one way of writing each, whose vertices, triangles and warnings can be told by looking. test_mtl_lines.c has the
 * materials. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/obj_files"
#include "import_lab.h"

#define FILE_OBJ FILE_OF("a.obj")
#define CORNERS "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

/* The file must be good; `words`: the warning that it gets, or "" for none. */
static void import_text(const char *text, const char *words, model *m) {
    put(FILE_OBJ, text);
    import_good(FILE_OBJ, m);
    check_promises(m);
    if (*words ? !strstr(warnings, words) : warnings[0] != '\0')
        fail_msg("'%s' is not '%s'", warnings, words);
}

static void refused(const char *text, const char *words) {
    put(FILE_OBJ, text);
    refuse(FILE_OBJ, false, words);
}

/* It is a warning, once, and an error if strict. */
static void left_out(const char *lines, const char *words) {
    char text[512];
    model m;
    (void)snprintf(text, sizeof text, CORNERS "%sf 1 2 3\n%s", lines, lines);
    import_text(text, words, &m);
    assert_ptr_equal(strchr(warnings, '\n'), warnings + strlen(warnings) - 1);
    assert_int_equal(m.triangles, 1);
    model_free(&m);
    refuse(FILE_OBJ, true, words);
}

static double area(const model *m) {
    double sum = 0.0;
    for (size_t t = 0; t < m->triangles; t++) {
        const float *a = m->position + 3 * m->index[3 * t], *b = m->position + 3 * m->index[3 * t + 1],
                    *c = m->position + 3 * m->index[3 * t + 2];
        sum += 0.5 * (double)((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    }
    return sum;
}

static void numbers_are_written_in_many_ways(void **state) {
    model m;
    (void)state;
    import_text("v .5 -.25 +1e1 # a comment\n\tv\t1.0E+0 2. 3\r\nv 0.1 16777217.0 1e-3\nf 1 2 3 #and one more\n", "", &m);
    assert_true(m.position[0] == 0.5f && m.position[1] == -0.25f && m.position[2] == 10.0f);
    assert_true(m.position[3] == 1.0f && m.position[4] == 2.0f && m.position[5] == 3.0f);
    assert_true(m.position[6] == 0.1f && m.position[7] == 16777216.0f && m.position[8] == 0.001f);
    model_free(&m);
}

static void what_has_to_be_a_number_and_is_none_ends_with_its_line(void **state) {
    (void)state;
    refused("# 1\nv 0 0 0\nv 1 \\\n0 0\nv 1,5 0 0\nf 1 2 3\n", "line 5: '1,5' is no number");
    refused("v 0 0 0\nv 1 0\n", "line 2: too few numbers");
    refused("v 0 0 0\nvt x\n", "line 2: 'x' is no number");
    refused("v 0 0 0\nvn 0 1 0x1\n", "line 2: '0x1' is no number");
    refused("v 0 0 0 1 1\n", "line 1: 'v' with 5 numbers");
    refused(CORNERS "f 1 2 c\n", "line 5: 'c' is no corner of a face");
    refused(CORNERS "f 1 2 /3\n", "line 5: '/3' is no corner of a face");
    refused(CORNERS "f 1 2 3/1/1/1\n", "line 5: '3/1/1/1' is no corner");
    refused("\xff\xfev 0", "UTF-8");
    refused("", "is empty");
}

static void lines_end_in_three_ways_and_go_on_behind_a_backslash(void **state) {
    static const char *const files[] = {"v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n", "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3",
                                        "v 0 0 0\nv 1 \\\n 0 0\nv 0 1 0\nf 1\\\n2 \\\n3\n",
                                        "\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3",
                                        "v 0 0 0\r\nv 1 \\\r\n 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n"};
    (void)state;
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        model m;
        import_text(files[i], "", &m);
        assert_true(m.triangles == 1 && m.hi[0] == 1 && m.hi[1] == 1);
        model_free(&m);
    }
}

static void corners_name_what_they_have(void **state) {
    static const char *const faces[] = {"f 1/1 2/2 3/3", "f 1/1/1 2/2/1 3/3/1", "f -4/-3 -3/-2 -2/-1",
                                        "f -4/1/-1 -3/2/-1 -2/3/-1", "f 1/1/ 2/2/ 3/3/"};
    (void)state;
    for (size_t i = 0; i < sizeof faces / sizeof *faces; i++) {
        char text[512];
        model m;
        (void)snprintf(text, sizeof text, CORNERS "vt 0 0\nvt .5 0\nvt .25 1\nvn 0 0.6 0.8\n%s\n", faces[i]);
        import_text(text, "", &m);
        uv_at(&m, 1, 0, 0.5f, 1);
        uv_at(&m, 1, 1, 0.25f, 0);
        if (strstr(faces[i], "/-1 -3") || strstr(faces[i], "/1/1"))
            normal_at(&m, 1, 0, 0, 0, 0.6f, 0.8f);
        else
            normal_at(&m, 1, 0, 0, 0, 0, 1);
        model_free(&m);
    }
    model m;
    import_text(CORNERS "vt .5 .5\nf 1 2 3\nf 1/1 3/1 4/1\n", "", &m); /* those without are at the origin */
    uv_at(&m, 1, 0, 0, 1);
    uv_at(&m, 0, 1, 0.5f, 0.5f);
    model_free(&m);
}

static void a_face_may_stand_before_its_vertices(void **state) {
    model m;
    (void)state;
    import_text("f 1//1 2//1 3//1\n" CORNERS "vn 0 0 1\n", "", &m);
    assert_int_equal(m.triangles, 1);
    model_free(&m);
}

static void faces_whose_indices_lead_nowhere_are_counted(void **state) {
    static const char *const bad[] = {"f 1 2 9",          "f 1 2 0",       "f 1 2 -5",
                                      "f 1 2 4294967297", "f 1/1 2/1 3/2", "f 1//1 2//1 3//9"};
    model m;
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char text[512];
        (void)snprintf(text, sizeof text, CORNERS "vt 0 0\nvn 0 0 1\n%s\nf 1 2 3\n", bad[i]);
        import_text(text, "1 triangles with an index out of range dropped", &m);
        assert_int_equal(m.triangles, 1);
        model_free(&m);
    }
    import_text(CORNERS "f 1 2 3 9\nf 1 2 3\n", "1 polygons with an index out of range", &m);
    model_free(&m);
    refused(CORNERS "f 7 8 9\n", "has no triangle whose indices are in range");
}

static void vertices_that_faces_share_are_one(void **state) {
    model m;
    (void)state;
    import_text(CORNERS "vt 0 0\nvt 1 1\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf 1/1/1 3/1/1 4/1/1\nf 1/2/1 2/1/1 3/1/1\n", "", &m);
    assert_int_equal(m.vertices, 5); /* the first with two coordinates */
    model_free(&m);
}

static void polygons_are_cut_whole(void **state) {
    char text[32768];
    model m;
    (void)state;
    static const uint32_t fan[6] = {0, 1, 2, 0, 2, 3};
    import_text(CORNERS "vn 0 0 1\nf 1//1 2//1 3//1 4//1\n", "", &m); /* as other readers cut it */
    assert_memory_equal(m.index, fan, sizeof fan);
    model_free(&m);
    import_text("v 0 0 0\nv 4 0 0\nv 4 4 0\nv 3 1 0\nf 1 2 3 4\n", "", &m); /* reflex at the last */
    assert_true(m.triangles == 2 && fabs(area(&m) - 4.0) < 1e-6);
    model_free(&m);
    import_text("v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 1 2 3 4 5\n", "", &m);
    assert_true(m.triangles == 3 && fabs(area(&m) - 10.0) < 1e-6);
    model_free(&m);
    for (int corners = 1024; corners <= 1025; corners++) {
        size_t used = (size_t)snprintf(text, sizeof text, "v 0 0 0\nv 512 0 0\n");
        for (int i = 2; i < corners; i++)
            used += (size_t)snprintf(text + used, sizeof text - used, "v %d %d 0\n", 512 - i / 2, 1 + i % 2);
        used += (size_t)snprintf(text + used, sizeof text - used, "f 1 2 3\nf");
        for (int i = 1; i <= corners; i++)
            used += (size_t)snprintf(text + used, sizeof text - used, " %d", i);
        assert_true(used < sizeof text);
        import_text(text, corners > 1024 ? "1 polygons with" : "", &m);
        assert_int_equal(m.triangles + m.degenerate, corners > 1024 ? 1 : 1023);
        model_free(&m);
    }
}

static void points_and_lines_are_counted(void **state) {
    model m;
    (void)state;
    import_text(CORNERS "p 1 2\nl 1 2 3 4\nf 1 2 3\nf 1 2\nf 1 3 4\n", "6 points and lines are left out", &m);
    assert_int_equal(m.not_triangles, 2 + 3 + 1);
    assert_true(m.triangles == 2 && fabs(area(&m) - 1.0) < 1e-6);
    model_free(&m);
}

static void objects_and_groups_are_meshes_by_name(void **state) {
    model m;
    (void)state;
    import_text(CORNERS "o  a table \nf 1 2 3\ng legs\nf 1 3 4\no a table\nf 1 2 4\no empty\n", "", &m);
    assert_int_equal(m.mesh_count, 2);
    assert_string_equal(m.meshes[0].name, "a table");
    assert_true(m.meshes[0].triangles == 2 && m.meshes[1].triangles == 1);
    model_free(&m);
}

/* A roof of 90 degrees whose ridge is x = z = 0, and one of 40 degrees. */
#define STEEP "v 0 0 0\nv 0 1 0\nv 1 0 -1\nv -1 0 -1\n"
#define FLAT "v 0 0 0\nv 0 1 0\nv 1 0 -.35\nv -1 0 -.35\n"
#define LEFT "f 1 2 4\n"
#define RIGHT "f 1 3 2\n"

static void smoothing_groups_part_faces_without_normals(void **state) {
    static const struct {
        const char *text;
        bool smooth;
    } rows[] = {{FLAT LEFT RIGHT, true},
                {FLAT "s 1\n" LEFT RIGHT, true},
                {FLAT "s 1\n" LEFT "s 2\n" RIGHT, false},
                {FLAT "s off\n" LEFT RIGHT, false},
                {FLAT "s 0\n" LEFT RIGHT, false},
                {FLAT LEFT "s 1\n" RIGHT, false},
                {STEEP "s 1\n" LEFT RIGHT, false}, /* as everywhere */
                {FLAT "s 2\n" LEFT "s 1\ns 2\n" RIGHT, true}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        model m;
        import_text(rows[i].text, "", &m);
        for (size_t v = 0; v < m.vertices; v++)
            if (m.position[3 * v] == 0.0f && (fabsf(m.normal[3 * v]) < 1e-6f) != rows[i].smooth)
                fail_msg("row %zu: normal %g at the ridge", i, (double)m.normal[3 * v]);
        model_free(&m);
    }
    model m;
    import_text(FLAT "vn 0 0 1\ns off\nf 1//1 2//1 4//1\n", "", &m); /* the file's own normals stay */
    normal_at(&m, 0, 0, 0, 0, 0, 1);
    model_free(&m);
    import_text(CORNERS "s smooth\nf 1 2 3\n", "line 5: 'smooth' is no smoothing group", &m);
    model_free(&m);
}

static void faces_with_and_without_normals_keep_to_themselves(void **state) {
    model m;
    (void)state;
    import_text(FLAT "vn 0 0.6 0.8\nf 1//1 2//1 4//1\nf 1 3 2\nf 1 3//1 2\n", "", &m);
    normal_at(&m, -1, 0, -0.35f, 0, 0.6f, 0.8f);
    const size_t v = vertex_at(&m, 1, 0, -0.35f);
    assert_true(m.normal[3 * v] > 0.3f && fabsf(m.normal[3 * v + 1]) < 1e-6f);
    model_free(&m);
}

/* They are sRGB: 0.5 is 0.21404114, 0.25 is 0.05087609 (IEC 61966-2-1). */
static void vertices_may_have_colours_or_weights(void **state) {
    model m;
    (void)state;
    import_text("v 0 0 0 .5 .25 1\nv 1 0 0 .5 .25 1\nv 0 1 0 .5 .25 1\nf 1 2 3\n", "", &m);
    assert_true(near3(m.materials[0].albedo, 0.21404114, 0.05087609, 1));
    model_free(&m);
    import_text("v 0 0 0 .5 .25 1 1\nv 1 0 0 .5 .25 1 1\nv 0 1 0 .5 .25 1 1\nf 1 2 3\n", "", &m);
    assert_true(near3(m.materials[0].albedo, 0.21404114, 0.05087609, 1));
    model_free(&m);
    import_text("v 0 0 0\nv 1 0 0 .5 .25 1\nv 0 1 0\nf 1 2 3\n", "vertex colours that vary", &m);
    assert_true(near3(m.materials[0].albedo, 0.6, 0.6, 0.6));
    model_free(&m);
    import_text(CORNERS "v 0 0 0 .5 .25 1\nv 1 0 0 .5 .25 1\nv 0 1 0 .5 .25 1\nf 5 6 7\n", "", &m);
    assert_true(near3(m.materials[0].albedo, 0.21404114, 0.05087609, 1));
    model_free(&m);
    put(FILE_OF("a.mtl"), "newmtl half\nKd .5 .5 .5\n");
    import_text("mtllib a.mtl\nusemtl half\nv 0 0 0 .5 .25 1\nv 1 0 0 .5 .25 1\nv 0 1 0 .5 .25 1\nf 1 2 3\n", "", &m);
    assert_true(near3(m.materials[0].albedo, 0.10702057, 0.025438045, 0.5));
    model_free(&m);
    import_text("v 0 0 0 2\nv 1 0 0 2\nv 0 1 0 2\nf 1 2 3\n", "", &m); /* a weight is none of a face's business */
    assert_true(m.hi[0] == 1);
    model_free(&m);
}

static void what_is_not_done_is_said_once(void **state) {
    model m;
    (void)state;
    left_out("cstype bezier\ncurv 0 1 1 2\nend\n", "'cstype': curves and surfaces of free form are left out");
    left_out("vp 0 1\nsurf 0 1 0 1 1 2 3\n", "'vp': curves and surfaces");
    left_out("call other.obj\n", "'call': other files' statements are left out");
    left_out("maplib a.map\nusemap a\n", "'maplib': textures beside those of materials");
    left_out("lod 3\n", "'lod': is left out");
    left_out("#MRGB ffffff\n", "'#MRGB': colours of vertices in comments are left out");
    left_out("hello world\n", "line 5: 'hello': is not known and left out");
    import_text(CORNERS "bevel off\nmg off\nlod 0\nusemap off\n# mrgb\nf 1 2 3\n", "", &m);
    model_free(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        T(numbers_are_written_in_many_ways),
        T(what_has_to_be_a_number_and_is_none_ends_with_its_line),
        T(lines_end_in_three_ways_and_go_on_behind_a_backslash),
        T(corners_name_what_they_have),
        T(a_face_may_stand_before_its_vertices),
        T(faces_whose_indices_lead_nowhere_are_counted),
        T(vertices_that_faces_share_are_one),
        T(polygons_are_cut_whole),
        T(points_and_lines_are_counted),
        T(objects_and_groups_are_meshes_by_name),
        T(smoothing_groups_part_faces_without_normals),
        T(faces_with_and_without_normals_keep_to_themselves),
        T(vertices_may_have_colours_or_weights),
        T(what_is_not_done_is_said_once),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
