/* STL as many programs write it, text and binary: each file is made here of the same three facets, and right is known. What is
 * odd about a file must change nothing, or be said, or be refused in one line. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/stl"
#include "import_lab.h"
#include "import/import_format.h"

#define FACET(n, a, b, c) "facet normal " n "\nouter loop\nvertex " a "\nvertex " b "\nvertex " c "\nendloop\nendfacet\n"
#define FIRST FACET("0 0 1", "0 0 0", "1 0 0", "0 1 0")
#define SECOND FACET("0 0 0", "1 0 0", "1 1 0", "0 1 0")
#define THIRD FACET("0 0 -1", "2 0 0", "3 0 0", "2 1 0")
#define THREE FIRST SECOND THIRD

enum { BINARY = 84 + 3 * 50 };

/* The three facets as a binary file; `header` has `length` bytes. */
static void make_binary(uint8_t out[BINARY], const char *header, size_t length, uint32_t count, const uint16_t attribute[3]) {
    static const float facets[3][12] = {
        {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, {0, 0, -1, 2, 0, 0, 3, 0, 0, 2, 1, 0}};
    memset(out, 0, BINARY);
    memcpy(out, header, length);
    for (size_t k = 0; k < 4; k++)
        out[80 + k] = (uint8_t)(count >> (8 * k));
    for (size_t i = 0; i < 3; i++) {
        put_floats(out + 84 + 50 * i, facets[i], 12);
        out[84 + 50 * i + 48] = (uint8_t)attribute[i];
        out[84 + 50 * i + 49] = (uint8_t)(attribute[i] >> 8);
    }
}

static void put_binary(const char *header, size_t length, uint32_t count, const uint16_t attribute[3]) {
    uint8_t bytes[BINARY];
    make_binary(bytes, header, length, count, attribute);
    put_bytes(FILE_OF("t.stl"), bytes, sizeof bytes);
}

/* What all these files are, whatever their normals say: flat, up z. */
static void three_are(const model *m) {
    check_promises(m);
    assert_int_equal(m->triangles, 3);
    for (int k = 0; k < 3; k++)
        assert_true(m->lo[k] == 0.0 && m->hi[k] == (k == 0 ? 3.0 : k == 1 ? 1.0 : 0.0));
    for (size_t i = 0; i < m->vertices; i++)
        assert_true(m->normal[3 * i] == 0.0f && m->normal[3 * i + 1] == 0.0f && m->normal[3 * i + 2] == 1.0f);
}

/* t.stl: it is the three facets, and `said` is said, an error if strict; NULL: nothing is. */
static void is_three(const char *said) {
    model m;
    import_good(FILE_OF("t.stl"), &m);
    three_are(&m);
    model_free(&m);
    if (said ? !strstr(warnings, said) : warnings[0] != '\0')
        fail_msg("'%s' is not '%s'", warnings, said ? said : "");
    if (said)
        refuse(FILE_OF("t.stl"), true, said);
}

static void text_of_many_hands_is_read(void **state) {
    static const struct {
        const char *text, *said;
    } rows[] = {
        {"solid a\n" THREE "endsolid a\n", NULL},
        {"\xef\xbb\xbf\r\n  solid\r\n" THREE "endsolid", NULL},
        {"solid facet endsolid vertex\n" THREE "endsolid facet\n", NULL},
        {"SOLID A\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVERTEX 0 1 0\nEND LOOP\nEND FACET\n" SECOND THIRD
         "End Solid A\n",
         NULL},
        {"solid a facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1.0E+000 -0 0. vertex 0 +1 .0e5 endloop endfacet " SECOND
             THIRD "endsolid a",
         NULL},
        {"solid a\n" FACET("nan(ind) -1.#IND x", "0 0 0", "1 0 0", "0 1 0") SECOND THIRD "endsolid", NULL},
        {"solid a\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n" SECOND THIRD "endsolid",
         NULL},
        {"solid a\n" FIRST "color 1 0 0\n" SECOND THIRD "endsolid a\n", "line 9: 'color' and perhaps others are left out"},
        {"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\ncolor 1 1 1\n"
         "endfacet\n" SECOND THIRD "endsolid a\n",
         "line 8: 'color' and perhaps others"},
        {"solid a\n" THREE, "ends without 'endsolid'"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        put(FILE_OF("t.stl"), rows[i].text);
        is_three(rows[i].said);
    }
    put_bytes(FILE_OF("t.stl"), "solid \xff\xfe\n" THREE "endsolid\n\0\0\0",
              sizeof "solid \xff\xfe\n" THREE "endsolid\n\0\0\0");
    is_three(NULL); /* padded with zeros, named in some old code page */
}

static void line_ends_do_not_matter(void **state) {
    static char text[4096];
    (void)state;
    for (int cr_lf = 0; cr_lf < 2; cr_lf++) {
        size_t size = 0;
        for (const char *c = "solid a\n" THREE "color\nendsolid\n"; *c; c++) {
            if (*c == '\n')
                text[size++] = '\r';
            if (*c != '\n' || cr_lf)
                text[size++] = *c;
        }
        text[size] = '\0';
        put(FILE_OF("t.stl"), text);
        is_three("line 23: 'color'");
    }
}

/* Two facets with an edge of 45 degrees between them, which normals that are made would round. */
static void facets_are_flat(void **state) {
    model m;
    (void)state;
    put(FILE_OF("t.stl"),
        "solid a\n" FACET("0 0 1", "0 0 0", "1 0 0", "0 1 0") FACET("0 0 1", "1 0 0", "0 0 0", "0 -1 1") "endsolid\n");
    import_good(FILE_OF("t.stl"), &m);
    for (size_t k = 0; k < 6; k++) {
        const float *n = m.normal + 3 * (size_t)m.index[k];
        assert_true(n[0] == 0.0f && (k < 3 ? n[2] == 1.0f : fabsf(n[1] - n[2]) < 1e-6f && n[2] > 0.7f));
    }
    model_free(&m);
}

static void each_solid_is_a_mesh_of_its_name(void **state) {
    model m;
    (void)state;
    put(FILE_OF("t.stl"),
        "solid left one\n" FIRST SECOND "endsolid left one\nsolid\nendsolid\nsolid right\n" THIRD "endsolid\n");
    import_good(FILE_OF("t.stl"), &m);
    three_are(&m);
    assert_int_equal(m.mesh_count, 3);
    assert_string_equal(m.meshes[0].name, "left one");
    assert_string_equal(m.meshes[1].name, "t"); /* the file's */
    assert_string_equal(m.meshes[2].name, "right");
    assert_true(m.meshes[0].triangles == 2 && m.meshes[1].triangles == 0 && m.meshes[2].triangles == 1);
    model_free(&m);
}

static void text_that_is_wrong_is_refused_with_its_line(void **state) {
    static const char *const rows[][2] = {
        {"solid a\n" FACET("0 0 1", "0 0 0", "1,5 0 0", "0 1 0") "endsolid", "line 5: a value is no number: '1,5'"},
        {"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\n",
         "line 7: 'vertex' where 'endloop' should be"},
        {"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\n",
         "line 6: 'endloop' where 'vertex' should be"},
        {"solid a\n" FIRST "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0", "is cut short in line 12"},
        {"solid a\n" FIRST "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n" SECOND,
         "line 15: 'facet' where 'endfacet' should be"},
        {"solid a\nendsolid a\n", "has no triangle"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        put(FILE_OF("t.stl"), rows[i][0]);
        refuse(FILE_OF("t.stl"), false, rows[i][1]);
    }
}

static const uint16_t plain[3] = {0, 0, 0};

static void binary_files_are_read_whatever_their_header_says(void **state) {
    static const char *const headers[] = {"", "solid made by some CAD", "solid facet normal outer loop vertex 0 0 0", "PK"};
    (void)state;
    for (size_t i = 0; i < sizeof headers / sizeof *headers; i++) {
        put_binary(headers[i], strlen(headers[i]), 3, plain);
        is_three(NULL);
    }
}

static void numbers_of_facets_that_are_wrong_are_said(void **state) {
    uint8_t bytes[BINARY + 12];
    model m;
    (void)state;
    put_binary("solid", 5, 0, plain);
    is_three("has no number of facets (0): there are 3");
    put_binary("", 0, UINT32_MAX, plain);
    is_three("has no number of facets (4294967295): there are 3");
    put_binary("", 0, 4, plain);
    refuse(FILE_OF("t.stl"), false, "is cut short: 4 facets are announced, 3 are there");
    memset(bytes, ' ', sizeof bytes);
    make_binary(bytes, "solid", 5, 3, plain);
    put_bytes(FILE_OF("t.stl"), bytes, sizeof bytes);
    is_three("12 bytes behind the last of 3 facets are left out");
    put_bytes(FILE_OF("t.stl"), bytes, BINARY - 1);
    refuse(FILE_OF("t.stl"), false, "is cut short: 3 facets are announced, 2 are there");
    put_bytes(FILE_OF("t.stl"), bytes, 83);
    refuse(FILE_OF("t.stl"), false, "is cut short");
    put_binary("", 0, 1, plain);
    import_good(FILE_OF("t.stl"), &m);
    assert_int_equal(m.triangles, 1);
    assert_non_null(strstr(warnings, "100 bytes behind the last of 1 facets"));
    model_free(&m);
}

/* The albedo of the facet whose corner is at x. */
static const float *albedo_at(const model *m, float x) {
    for (size_t t = 0; t < m->triangles; t++)
        for (size_t k = 0; k < 3; k++)
            if (m->position[3 * (size_t)m->index[3 * t + k]] == x && m->position[3 * (size_t)m->index[3 * t + k] + 1] == 0.0f)
                return m->materials[m->material[t]].albedo;
    fail();
    return NULL;
}

static bool is_color(const float *a, double r, double g, double b) {
    return fabs((double)a[0] - r) < 1e-6 && fabs((double)a[1] - g) < 1e-6 && fabs((double)a[2] - b) < 1e-6;
}

#define MID 0.22927477 /* sRGB 16 / 31 */
#define EIGHTH 0.05416457
#define FIRST_STEP 0.00249675

static void colours_of_facets_are_of_the_way_their_header_tells(void **state) {
    static const uint16_t viscam[3] = {0x8000 | 31 << 10 | 16, 0x8000 | 31 << 10 | 16, 0}, magics[3] = {31, 31, 0x8000};
    static const char green[] = "made COLOR=\x00\xff\x00\xff";
    model m;
    (void)state;
    put_binary("", 0, 3, viscam);
    import_good(FILE_OF("t.stl"), &m);
    three_are(&m);
    assert_int_equal(m.material_count, 2);
    assert_true(is_color(albedo_at(&m, 0), 1, 0, MID) && is_color(albedo_at(&m, 2), 1, 1, 1));
    model_free(&m);
    put_binary(green, sizeof green - 1, 3, magics);
    import_good(FILE_OF("t.stl"), &m);
    three_are(&m);
    assert_true(is_color(albedo_at(&m, 0), 1, 0, 0) && is_color(albedo_at(&m, 2), 0, 1, 0));
    assert_string_equal(warnings, "");
    model_free(&m);
}

static void what_is_not_done_of_colours_is_said(void **state) {
    static const uint16_t none[3] = {0x8000, 0x8000, 0x8000}, odd[3] = {7, 0, 0};
    static const char clear[] = "COLOR=\x00\xff\x00\x80", shiny[] = "COLOR=\x00\xff\x00\xff,MATERIAL=............";
    (void)state;
    put_binary(clear, sizeof clear - 1, 3, none);
    is_three("alpha of its colour is left out");
    put_binary(shiny, sizeof shiny - 1, 3, none);
    is_three("MATERIAL of its header is left out");
    put_binary("", 0, 3, odd);
    is_three("attributes of facets that are no colours are left out");
}

/* Facets in a row, each of a colour of its own. */
static void colours_of_facets_are_at_most_256(void **state) {
    static uint8_t bytes[84 + 257 * 50];
    (void)state;
    for (unsigned count = 256; count <= 257; count++) {
        model m;
        bytes[80] = (uint8_t)count;
        bytes[81] = (uint8_t)(count >> 8);
        for (unsigned i = 0; i < count; i++) {
            const float f = (float)i, facet[12] = {0, 0, 1, f, 0, 0, f + 0.5f, 0, 0, f, 1, 0};
            const uint16_t attribute = (uint16_t)(0x8000 | (256 - i));
            put_floats(bytes + 84 + 50 * (size_t)i, facet, 12);
            bytes[84 + 50 * i + 48] = (uint8_t)attribute;
            bytes[84 + 50 * i + 49] = (uint8_t)(attribute >> 8);
        }
        put_bytes(FILE_OF("t.stl"), bytes, 84 + 50 * (size_t)count);
        import_good(FILE_OF("t.stl"), &m);
        check_promises(&m);
        assert_int_equal(m.triangles, count);
        assert_int_equal(m.material_count, count == 256 ? 256 : 1);
        assert_true(count == 256 ? warnings[0] == '\0'
                                 : strstr(warnings, "colours of facets, of which there are more than 256") != NULL);
        assert_true(count > 256 ||
                    (is_color(albedo_at(&m, 0), 0, EIGHTH, 0) && is_color(albedo_at(&m, 255), 0, 0, FIRST_STEP)));
        model_free(&m);
    }
}

static void stl_in_text_is_known_by_its_words(void **state) {
    model m;
    (void)state;
    put(FILE_OF("t.txt"), "solid a\n" THREE "endsolid a\n");
    import_good(FILE_OF("t.txt"), &m);
    three_are(&m);
    assert_string_equal(import_formats[m.formats[0].reader]->name, "STL");
    model_free(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        T(text_of_many_hands_is_read),
        T(line_ends_do_not_matter),
        T(facets_are_flat),
        T(each_solid_is_a_mesh_of_its_name),
        T(text_that_is_wrong_is_refused_with_its_line),
        T(binary_files_are_read_whatever_their_header_says),
        T(numbers_of_facets_that_are_wrong_are_said),
        T(colours_of_facets_are_of_the_way_their_header_tells),
        T(what_is_not_done_of_colours_is_said),
        T(colours_of_facets_are_at_most_256),
        T(stl_in_text_is_known_by_its_words),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
