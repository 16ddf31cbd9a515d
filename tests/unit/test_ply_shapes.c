/* PLY's shapes: values of every type in every encoding, elements in any order, polygons and strips, and files that are wrong.
 * Strategy: small files written here in text and both byte orders by ply_lab.h, which must be the same model, and whose right
 * values stand beside them. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/ply_shapes"
#include "ply_lab.h"

static void positions_of_every_type_are_read(void **state) {
    static const char *const types[] = {"char",  "int8", "uchar",  "uint8", "short",  "int16", "ushort",  "uint16", "int",
                                        "int32", "uint", "uint32", "int64", "uint64", "float", "float32", "double", "float64"};
    (void)state;
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        char header[512];
        model m;
        (void)snprintf(header, sizeof header, "element vertex 4\nproperty %s x\nproperty %s y\nproperty float z\n" TWO_FACES,
                       types[i], types[i]);
        import_all_encodings(header, QUAD_POINTS TWO_TRIANGLES, &m);
        quad_is(&m);
        assert_string_equal(warnings, "");
        model_free(&m);
    }
}

static void values_at_the_ends_of_their_types_are_read(void **state) {
    model m;
    (void)state;
    import_all_encodings("element vertex 4\nproperty char x\nproperty short y\nproperty double z\n" TWO_FACES,
                         "-128 -32768 0.1\n127 -32768 0.1\n127 32767 -0.25\n-128 32767 3e-3\n" TWO_TRIANGLES, &m);
    assert_true(m.lo[0] == -128 && m.hi[0] == 127 && m.lo[1] == -32768 && m.hi[1] == 32767);
    assert_true(m.lo[2] == -0.25 && m.hi[2] == (double)0.1f);
    model_free(&m);
    import_all_encodings("element vertex 3\nproperty uchar x\nproperty ushort y\nproperty uint z\nelement face 1\n" INDICES,
                         "255 65535 16777215\n0 0 0\n0 65535 0\n3 0 1 2\n", &m);
    assert_true(m.hi[0] == 255 && m.hi[1] == 65535 && m.hi[2] == 16777215);
    model_free(&m);
}

static void lists_of_every_type_are_read(void **state) {
    static const char *const types[] = {"char",   "uint8", "short",  "uint16", "int",
                                        "uint32", "int64", "uint64", "float",  "double"};
    (void)state;
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        for (size_t k = 0; k < sizeof types / sizeof *types; k++) {
            char header[512];
            model m;
            (void)snprintf(header, sizeof header, QUAD_VERTICES "element face 1\nproperty list %s %s vertex_index\n", types[i],
                           types[k]);
            import_all_encodings(header, QUAD_POINTS "4 0 1 2 3\n", &m);
            quad_is(&m);
            model_free(&m);
        }
}

/* Whatever the lines end with, and whatever byte the data begin with. */
static void the_first_byte_of_the_data_may_be_any(void **state) {
    static const char *const ends[] = {"\n", "\r\n", "\r"};
    static const int bytes[] = {0x0a, 0x0d, 0x0a0a, 0x0d0d, 0x0a0d, 0x0d0a, 0, 0x20, 0x09, 0xff};
    (void)state;
    for (int e = 0; e < 3; e++)
        for (size_t i = 0; i < sizeof bytes / sizeof *bytes; i++) {
            const int first = bytes[i];
            char body[128];
            model m;
            (void)snprintf(body, sizeof body, "%d 0 0\n0 0 9\n0 9 0\n3 0 1 2\n", first);
            put_ply_ended(FILE_OF("first.ply"), LAB_LITTLE,
                          "element vertex 3\nproperty ushort x\nproperty uchar y\nproperty uchar z\nelement face 1\n" INDICES,
                          body, ends[e]);
            import_good(FILE_OF("first.ply"), &m);
            assert_true(m.triangles == 1 && m.hi[0] == (double)first && m.hi[1] == 9 && m.hi[2] == 9);
            assert_string_equal(warnings, "");
            model_free(&m);
        }
}

static void lines_of_text_may_end_in_any_way(void **state) {
    static const char *const ends[] = {"\n", "\r\n", "\r"};
    static const char *const bodies[] = {QUAD_POINTS TWO_TRIANGLES,
                                         "0 0 0\r\n1\t0 0 \r\n1 1 0\r\n\r\n 0 1 0\r\n3 0 1 2\r\n3 0 2 3",
                                         "0 0 0\r1 0 0\r1 1 0\r0 1 0\r3 0 1 2\r3 0 2 3\r\r"};
    (void)state;
    for (int e = 0; e < 3; e++)
        for (int b = 0; b < 3; b++) {
            model m;
            put_ply_ended(FILE_OF("ends.ply"), LAB_TEXT, QUAD_VERTICES TWO_FACES, bodies[b], ends[e]);
            import_good(FILE_OF("ends.ply"), &m);
            quad_is(&m);
            assert_string_equal(warnings, "");
            model_free(&m);
        }
}

static void elements_may_stand_in_any_order(void **state) {
    model m;
    (void)state;
    import_all_encodings("comment faces first\nobj_info made here\nelement face 2\nproperty float quality\n" INDICES
                         "element vertex 4\nproperty list int short others\n" XYZ "property int flags\n",
                         "0.5 3 0 1 2\n0.25 3 0 2 3\n2 7 8 0 0 0 1\n0 1 0 0 2\n1 9 1 1 0 3\n0 0 1 0 4\n", &m);
    quad_is(&m);
    assert_string_equal(warnings, "");
    model_free(&m);
}

/* More than what the reader lets go of at a time, in either order. */
static void long_files_are_read_in_any_order(void **state) {
    enum { FACES = 500000, ROW = 13 };
    static const char *const vertex = "element vertex 4\n" XYZ "property float nx\nproperty float ny\nproperty float nz\n";
    static const float points[24] = {0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 1, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1};
    (void)state;
    uint8_t *bytes = calloc(FACES + 100, ROW), *at;
    assert_non_null(bytes);
    for (int first = 0; first < 2; first++) { /* faces */
        char face[128];
        model m;
        (void)snprintf(face, sizeof face, "element face %d\n" INDICES, FACES);
        at = bytes + sprintf((char *)bytes, "ply\nformat binary_little_endian 1.0\n%s%send_header\n", first ? face : vertex,
                             first ? vertex : face);
        put_floats(at, points, first ? 0 : 24);
        at += first ? 0 : 96;
        for (int i = 0; i < FACES; i++, at += ROW) {
            memset(at, 0, ROW);
            at[0] = 3;
            at[5] = (uint8_t)(1 + i % 2);
            at[9] = (uint8_t)(2 + i % 2);
        }
        put_floats(at, points, first ? 24 : 0);
        at += first ? 96 : 0;
        put_bytes(FILE_OF("long.ply"), bytes, (size_t)(at - bytes));
        import_good(FILE_OF("long.ply"), &m);
        check_promises(&m);
        assert_true(m.triangles == FACES && m.vertices == 4 && m.hi[0] == 1.0 && m.hi[1] == 1.0);
        assert_string_equal(warnings, "");
        model_free(&m);
    }
    free(bytes);
    assert_int_equal(unlink(FILE_OF("long.ply")), 0);
}

static void what_is_unknown_is_passed_over_and_said(void **state) {
    model m;
    (void)state;
    import_all_encodings(
        "element nothing 7\nelement camera 1\nproperty float view_px\nproperty list uchar double more\n" QUAD_VERTICES
        "element empty 0\nproperty int a\n" TWO_FACES "element edge 2\nproperty int vertex1\n"
        "property int vertex2\nelement last 2\nproperty list char char a\n",
        "1.5 2 3 4\n" QUAD_POINTS TWO_TRIANGLES "0 1\n1 2\n2 1 2\n0\n", &m);
    quad_is(&m);
    assert_int_equal(m.not_triangles, 2);
    assert_non_null(strstr(warnings, "a.ply: element 'nothing' is left out"));
    assert_non_null(strstr(warnings, "a.ply: element 'camera' is left out"));
    assert_non_null(strstr(warnings, "a.ply: element 'last' is left out"));
    assert_null(strstr(warnings, "edge"));
    assert_null(strstr(warnings, "empty"));
    model_free(&m);
    refuse(FILE_OF("a.ply"), true, "element 'nothing' is left out");
}

/* ---- polygons and strips ---- */

static double area_of(const model *m) {
    double area = 0.0;
    for (size_t i = 0; i < m->triangles; i++) {
        const float *a = m->position + 3 * (size_t)m->index[3 * i], *b = m->position + 3 * (size_t)m->index[3 * i + 1],
                    *c = m->position + 3 * (size_t)m->index[3 * i + 2];
        area += 0.5 * (((double)b[0] - (double)a[0]) * ((double)c[1] - (double)a[1]) -
                       ((double)b[1] - (double)a[1]) * ((double)c[0] - (double)a[0]));
    }
    return area;
}

static void polygons_are_cut_and_points_and_lines_counted(void **state) {
    model m;
    (void)state;
    /* An arrow whose notch is corner 3: a fan from corner 0 would cover it. */
    import_all_encodings("element vertex 5\n" XYZ "element face 5\n" INDICES,
                         "0 0 0\n4 0 0\n4 4 0\n2 1 0\n0 4 0\n5 0 1 2 3 4\n1 0\n2 0 1\n0\n4 1 2 3 0\n", &m);
    assert_int_equal(m.triangles, 5);
    assert_int_equal(m.not_triangles, 2);
    assert_true(fabs(area_of(&m) - (10.0 + 6.0)) < 1e-5);
    model_free(&m);
}

/* A polygon of so many corners round the unit circle. */
static void put_disc(int corners) {
    static char body[1 << 16], header[256];
    int used = 0;
    (void)snprintf(header, sizeof header,
                   "element vertex %d\n" XYZ "element face 2\nproperty list ushort uint vertex_indices\n", corners);
    for (int i = 0; i < corners; i++)
        used += snprintf(body + used, sizeof body - (size_t)used, "%.6f %.6f 0\n", cos(6.283185307 * i / corners),
                         sin(6.283185307 * i / corners));
    used += snprintf(body + used, sizeof body - (size_t)used, "3 0 1 2\n%d", corners);
    for (int i = 0; i < corners; i++)
        used += snprintf(body + used, sizeof body - (size_t)used, " %d", i);
    put_ply(FILE_OF("disc.ply"), LAB_BIG, header, body);
}

static void polygons_have_up_to_1024_corners(void **state) {
    model m;
    (void)state;
    put_disc(1024);
    import_good(FILE_OF("disc.ply"), &m);
    assert_int_equal(m.triangles + m.degenerate, 1023);
    assert_true(fabs(area_of(&m) - 3.14157) < 1e-4);
    model_free(&m);
    put_disc(1025);
    import_good(FILE_OF("disc.ply"), &m);
    assert_int_equal(m.triangles, 1);
    assert_non_null(strstr(warnings, "1 polygons with an index out of range or more than 1024 corners dropped"));
    model_free(&m);
}

static void strips_turn_every_second_triangle_and_begin_anew(void **state) {
    model m;
    (void)state;
    import_all_encodings("element vertex 6\n" XYZ "element tristrips 2\nproperty list int int vertex_indices\n",
                         "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n11 0 1 2 3 4 5 -1 1 3 2 -1\n4 -1 1 3 2\n", &m);
    assert_int_equal(m.triangles, 6);
    assert_true(fabs(area_of(&m) - 3.0) < 1e-6); /* none lies on its face */
    model_free(&m);
}

static void indices_out_of_range_are_dropped_and_counted(void **state) {
    model m;
    (void)state;
    import_all_encodings(QUAD_VERTICES "element face 5\n" INDICES,
                         QUAD_POINTS "3 0 1 2\n3 0 2 3\n3 0 1 4\n3 -1 1 2\n4 0 1 2 4\n", &m);
    quad_is(&m);
    assert_non_null(strstr(warnings, "2 triangles with an index out of range dropped"));
    assert_non_null(strstr(warnings, "1 polygons with an index out of range"));
    model_free(&m);
}

static void normals_of_the_file_are_kept(void **state) {
    model m;
    (void)state;
    import_all_encodings("element vertex 4\n" XYZ "property float nx\nproperty float ny\nproperty float nz\n" TWO_FACES,
                         "0 0 0 0 0 2\n1 0 0 3 0 4\n1 1 0 0 -1 0\n0 1 0 0 0 1\n" TWO_TRIANGLES, &m);
    assert_int_equal(m.vertices, 4);
    normal_at(&m, 0, 0, 0, 0, 0, 1);
    normal_at(&m, 1, 0, 0, 0.6f, 0, 0.8f);
    normal_at(&m, 1, 1, 0, 0, -1, 0);
    model_free(&m);
}

/* ---- what is wrong ---- */

static void refuse_text(const char *elements, const char *body, const char *what) {
    put_ply(FILE_OF("wrong.ply"), LAB_TEXT, elements, body);
    refuse(FILE_OF("wrong.ply"), false, what);
}

static void wrong_texts_are_refused_with_a_line(void **state) {
    (void)state;
    refuse_text(QUAD_VERTICES TWO_FACES, "0 0 0\n1 0 0 5\n1 1 0\n0 1 0\n" TWO_TRIANGLES,
                "line 11: element 'vertex', row 1: more values than properties");
    refuse_text(QUAD_VERTICES TWO_FACES, "0 0 0\n1 0\n1 1 0\n0 1 0\n" TWO_TRIANGLES,
                "line 12: element 'vertex', row 1: more values than properties");
    refuse_text(QUAD_VERTICES TWO_FACES, QUAD_POINTS "3 0 1 2\n2 0 2 3\n", "line 15: element 'face', row 1: more values");
    refuse_text(QUAD_VERTICES TWO_FACES, QUAD_POINTS "3 0 1 2\n4 0 2 3\n", "element 'face', row 1: is cut short");
    refuse_text(QUAD_VERTICES TWO_FACES, QUAD_POINTS "3 0 1 2\n-3 0 2 3\n", "a list has a length that cannot be");
    refuse_text(QUAD_VERTICES TWO_FACES, QUAD_POINTS "3 0 1 2\n1.5 0 2 3\n", "a list has a length that cannot be");
    refuse_text(QUAD_VERTICES TWO_FACES, "0 0 0\n1 0,5 0\n1 1 0\n0 1 0\n" TWO_TRIANGLES, "a value is no number");
    refuse_text(QUAD_VERTICES TWO_FACES, QUAD_POINTS "3 0 1 2\n", "element 'face', row 1: is cut short");
    refuse_text("element vertex 400\n" XYZ TWO_FACES, QUAD_POINTS TWO_TRIANGLES, "is cut short: 400 rows of 'vertex'");
}

static void wrong_headers_are_refused(void **state) {
    (void)state;
    refuse_text("element vertex x\n" XYZ TWO_FACES, "", "line 3: no number of rows: 'x'");
    refuse_text("element vertex -1\n" XYZ TWO_FACES, "", "line 3: no number of rows: '-1'");
    refuse_text("element vertex 1\nproperty real x\n", "", "line 4: no type of PLY: 'real'");
    refuse_text("property float x\n", "", "line 3: no element before this property");
    refuse_text("element vertex 4\nproperty float x\nproperty float y\n" TWO_FACES, "0 0\n1 0\n1 1\n0 1\n" TWO_TRIANGLES,
                "its vertices have no 'x', 'y' and 'z'");
    refuse_text(QUAD_VERTICES "element face 2\nproperty list uchar int corners\n", QUAD_POINTS TWO_TRIANGLES,
                "its faces have no list 'vertex_indices'");
    refuse_text(TWO_FACES, TWO_TRIANGLES, "has no element 'vertex'");
    refuse_text("element vertex 0\n" XYZ TWO_FACES, TWO_TRIANGLES, "has no triangle whose indices are in range");
    refuse_text(QUAD_VERTICES QUAD_VERTICES TWO_FACES, QUAD_POINTS QUAD_POINTS TWO_TRIANGLES, "has vertices twice");
    put(FILE_OF("wrong.ply"), "ply\nelement vertex 1\nend_header\n");
    refuse(FILE_OF("wrong.ply"), false, "the PLY header names no format");
    put(FILE_OF("wrong.ply"), "ply\nformat binary 1.0\nend_header\n");
    refuse(FILE_OF("wrong.ply"), false, "line 2: no format of PLY: 'binary'");
}

static void a_cloud_is_refused_with_its_points_and_edges(void **state) {
    (void)state;
    refuse_text(QUAD_VERTICES "element edge 1\nproperty int vertex1\nproperty int vertex2\nelement face 0\n" INDICES,
                QUAD_POINTS "0 1\n", "has no faces, but 4 points and 1 edges, which are not shown");
}

/* Wherever it ends, it is refused in one line that says so. */
static void files_that_are_cut_short_are_refused(void **state) {
    (void)state;
    for (int encoding = LAB_LITTLE; encoding < LAB_ENCODINGS; encoding++) {
        size_t size;
        put_ply(FILE_OF("whole.ply"), encoding, QUAD_VERTICES TWO_FACES, QUAD_POINTS TWO_TRIANGLES);
        uint8_t *bytes = read_file(FILE_OF("whole.ply"), &size);
        for (size_t cut = size - 74; cut < size; cut++) {
            put_bytes(FILE_OF("cut.ply"), bytes, cut);
            refuse(FILE_OF("cut.ply"), false, "is cut short");
        }
        put_bytes(FILE_OF("cut.ply"), bytes, size - 80);
        refuse(FILE_OF("cut.ply"), false, "the PLY header has no end");
        free(bytes);
    }
}

static void what_stands_behind_the_end_is_said(void **state) {
    model m;
    (void)state;
    put_ply(FILE_OF("more.ply"), LAB_TEXT, QUAD_VERTICES TWO_FACES, QUAD_POINTS TWO_TRIANGLES "3 0 1 2\n");
    import_good(FILE_OF("more.ply"), &m);
    quad_is(&m);
    assert_non_null(strstr(warnings, "9 bytes behind the last element are left out"));
    model_free(&m);
    refuse(FILE_OF("more.ply"), true, "bytes behind the last element are left out");
}

/* 1 + 2^-24 lies halfway between two floats; one digit more decides. */
static void numbers_of_text_are_rounded_once(void **state) {
    model m;
    (void)state;
    put_ply(
        FILE_OF("round.ply"), LAB_TEXT, "element vertex 3\n" XYZ "element face 1\n" INDICES,
        "1.00000005960464477539062 0 0\n1.000000059604644775390625000000000000000001 5e-1 .0\n-1.17549421069244e-38 1e0 +0\n"
        "3 0 1 2\n");
    import_good(FILE_OF("round.ply"), &m);
    const float *p = m.position;
    assert_true(p[0] == 1.0f && p[3] == 1.0f + 0x1p-23f && p[6] == strtof("-1.17549421069244e-38", NULL));
    model_free(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        T(positions_of_every_type_are_read),
        T(values_at_the_ends_of_their_types_are_read),
        T(lists_of_every_type_are_read),
        T(the_first_byte_of_the_data_may_be_any),
        T(lines_of_text_may_end_in_any_way),
        T(elements_may_stand_in_any_order),
        T(long_files_are_read_in_any_order),
        T(what_is_unknown_is_passed_over_and_said),
        T(polygons_are_cut_and_points_and_lines_counted),
        T(polygons_have_up_to_1024_corners),
        T(strips_turn_every_second_triangle_and_begin_anew),
        T(indices_out_of_range_are_dropped_and_counted),
        T(normals_of_the_file_are_kept),
        T(wrong_texts_are_refused_with_a_line),
        T(wrong_headers_are_refused),
        T(a_cloud_is_refused_with_its_points_and_edges),
        T(files_that_are_cut_short_are_refused),
        T(what_stands_behind_the_end_is_said),
        T(numbers_of_text_are_rounded_once),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
