/* 3MF's looks: base materials, colours, pictures, mixtures, layers and metals, for each corner of each triangle. Strategy:
 * small files written here (threemf_lab.h); right is what the core and the materials specification say, by hand. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/threemf_looks"
#include "threemf_lab.h"
#include "common/strict_math.h"
#include <stdlib.h>

#define BUILD ITEM("objectid=\"1\"")
#define BASES                                                                                                                  \
    "<basematerials id=\"7\"><base name=\"brick\" displaycolor=\"#FF0000\"/><base name=\"moss\" "                              \
    "displaycolor=\"#00ff00FF\"/><base name=\"mist\" displaycolor=\"#0000FF40\"/></basematerials>"
#define COLORS                                                                                                                 \
    "<m:colorgroup id=\"8\"><m:color color=\"#FF0000\"/><m:color color=\"#00FF00\"/><m:color color=\"#0000FF\"/>"              \
    "<m:color color=\"#FF0000\"/><m:color color=\"#808080\"/></m:colorgroup>"
/* A square of two triangles, of which the object and each triangle say this. */
#define LOOKS(groups, object, first, second) MODEL_OF("", groups OBJECT("id=\"1\" " object, SQUARE_MESH(first, second)), BUILD)

static bool is_color(const model *m, size_t triangle, const char *name, double r, double g, double b) {
    const model_material *k = &m->materials[m->material[triangle]];
    const bool right = strcmp(k->name, name) == 0 && near3(k->albedo, r, g, b) && is_matt(k) && k->image < 0;
    if (!right)
        print_error("'%s' (%g, %g, %g)\n", k->name, (double)k->albedo[0], (double)k->albedo[1], (double)k->albedo[2]);
    return right;
}

/* ---- materials of one colour ---- */

static void triangles_have_their_base_material_or_that_of_their_object(void **state) {
    static const struct {
        const char *text, *names[2];
    } rows[] = {{LOOKS(BASES, "", "", ""), {"default", "default"}},
                {LOOKS(BASES, "pid=\"7\" pindex=\"1\"", "", ""), {"moss", "moss"}},
                {LOOKS(BASES, "pid=\"7\" pindex=\"1\"", "p1=\"0\"", ""), {"brick", "moss"}},
                {LOOKS(BASES, "", "pid=\"7\" p1=\"0\"", "pid=\"7\" p1=\"1\" p2=\"1\" p3=\"1\""), {"brick", "moss"}},
                {LOOKS(BASES, "pid=\"7\" pindex=\"0\"", "", "pid=\"7\" p1=\"1\""), {"brick", "moss"}},
                {LOOKS(BASES, "pid=\"7\"", "", "pid=\"9\""), {"brick", "brick"}}}; /* without p1 the object's (Core 4.1.4) */
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        model m;
        import_3mf(rows[i].text, &m);
        assert_int_equal(m.triangles, 2);
        for (size_t t = 0; t < 2; t++) {
            const char *name = rows[i].names[strcmp(rows[i].names[0], rows[i].names[1]) ? t : 0];
            /* Parts come in the order in which materials are first used: as the triangles do here. */
            assert_true(is_color(&m, t, name, *name == 'd' ? 0.6 : *name == 'b', *name == 'd' ? 0.6 : *name == 'm',
                                 *name == 'd' ? 0.6 : 0));
        }
        model_free(&m);
    }
}

static void colours_are_srgb(void **state) {
    model m;
    (void)state;
    import_3mf(LOOKS(COLORS, "pid=\"8\" pindex=\"4\"", "", ""), &m);
    assert_true(is_color(&m, 0, "#808080", 0.21586050, 0.21586050, 0.21586050)); /* ((128/255 + 0.055) / 1.055)^2.4 */
    model_free(&m);
}

static void the_scene_file_names_base_materials(void **state) {
    model m;
    (void)state;
    put_3mf(LOOKS(BASES, "pid=\"7\"", "", "p1=\"1\""));
    import_scene(FILE_OF("t.3mf") + strlen(FOLDER) + 1, "materials = ( { name = \"moss\"; color = (0.1, 0.2, 0.3); } );", &m);
    assert_true(is_color(&m, 0, "brick", 1, 0, 0) && is_color(&m, 1, "moss", 0.1, 0.2, 0.3));
    model_free(&m);
}

static void alpha_of_base_materials_is_a_hole_and_of_colours_nothing(void **state) {
    model m;
    (void)state;
    put_3mf(LOOKS(BASES, "pid=\"7\"", "", "p1=\"2\""));
    import_good(FILE_OF("t.3mf"), &m);
    assert_true(m.triangles == 1 && is_color(&m, 0, "brick", 1, 0, 0));
    assert_non_null(strstr(warnings, "1 triangles of transparent materials ('mist') are left as holes"));
    model_free(&m);
    import_scene(FILE_OF("t.3mf") + strlen(FOLDER) + 1, "materials = ( { name = \"mist\"; cutoff = 0.0; } );", &m);
    assert_int_equal(m.triangles, 2);
    model_free(&m);
    put_3mf(LOOKS("<m:colorgroup id=\"8\"><m:color color=\"#FF000010\"/></m:colorgroup>", "pid=\"8\"", "", ""));
    import_good(FILE_OF("t.3mf"), &m);
    assert_true(m.triangles == 2 && is_color(&m, 0, "#ff0000", 1, 0, 0));
    assert_non_null(strstr(warnings, "alpha of colours is left out: 3MF has them opaque"));
    model_free(&m);
}

static void colours_that_are_alike_are_one_material(void **state) {
    model m;
    (void)state;
    import_3mf(LOOKS(COLORS, "pid=\"8\"", "p1=\"0\" p2=\"3\" p3=\"0\"", "p1=\"3\""), &m);
    assert_true(m.material_count == 1 && is_color(&m, 0, "#ff0000", 1, 0, 0));
    assert_true(m.vertices == 6); /* normals are made for each corner */
    model_free(&m);
}

/* Shares 1 to 3 of linear red and green; all alike where they sum up to 0. */
static void mixtures_are_means_of_reflectances(void **state) {
#define MIXED                                                                                                                  \
    BASES "<m:compositematerials id=\"9\" matid=\"7\" matindices=\"0 1\"><m:composite values=\"1 3\"/>"                        \
          "<m:composite values=\"0 0\"/><m:composite values=\"2\"/></m:compositematerials>"
    model m;
    (void)state;
    import_3mf(LOOKS(MIXED, "pid=\"9\"", "", "p1=\"1\""), &m);
    const float *first = m.materials[0].albedo, *second = m.materials[1].albedo;
    /* Colours have 8 bits, of which steps are at most 0.009 there. */
    assert_true(fabsf(first[0] - 0.25f) < 0.005f && fabsf(first[1] - 0.75f) < 0.005f && first[2] == 0.0f);
    assert_true(fabsf(second[0] - 0.5f) < 0.005f && fabsf(second[1] - 0.5f) < 0.005f);
    model_free(&m);
    import_3mf(LOOKS(MIXED, "pid=\"9\" pindex=\"2\"", "", ""), &m);
    assert_true(near3(m.materials[0].albedo, 1, 0, 0));
    model_free(&m);
}

static void the_last_layer_is_shown_and_the_others_are_said(void **state) {
    model m;
    (void)state;
    put_3mf(LOOKS(BASES COLORS "<m:multiproperties id=\"9\" pids=\"7 8\"><m:multi pindices=\"0 2\"/><m:multi pindices=\"1\"/>"
                               "</m:multiproperties>",
                  "", "pid=\"9\" p1=\"0\"", "pid=\"9\" p1=\"1\""));
    import_good(FILE_OF("t.3mf"), &m);
    assert_non_null(strstr(warnings, "the last layer is shown, and others left out"));
    assert_true(is_color(&m, 0, "#0000ff", 0, 0, 1) && is_color(&m, 1, "#ff0000", 1, 0, 0)); /* an index left out is 0 */
    model_free(&m);
    import_3mf(LOOKS(BASES "<m:multiproperties id=\"9\" pids=\"7\"><m:multi pindices=\"1\"/></m:multiproperties>",
                     "pid=\"9\" pindex=\"0\"", "", ""),
               &m);
    assert_true(is_color(&m, 0, "moss", 0, 1, 0));
    model_free(&m);
}

static void metals_reflect(void **state) {
    model m;
    (void)state;
    import_3mf(LOOKS("<m:pbmetallicdisplayproperties id=\"3\"><m:pbmetallic name=\"a\" metallicness=\"1\" roughness=\"0.05\"/>"
                     "<m:pbmetallic name=\"b\" metallicness=\"0\" roughness=\"1\"/></m:pbmetallicdisplayproperties>"
                     "<basematerials id=\"7\" displaypropertiesid=\"3\"><base name=\"gold\" displaycolor=\"#FFFF00\"/>"
                     "<base name=\"clay\" displaycolor=\"#FFFF00\"/></basematerials>",
                     "pid=\"7\"", "", "p1=\"1\""),
               &m);
    const model_material *gold = named(&m, "gold"), *clay = named(&m, "clay");
    assert_true(gold->kind == VIT_MIRROR && near3(gold->specular, 1, 1, 0) && near3(gold->albedo, 0, 0, 0));
    assert_true(is_matt(clay) && near3(clay->albedo, 1, 1, 0));
    model_free(&m);
}

static void properties_that_are_not_there_are_grey_and_said(void **state) {
    static const char *const rows[] = {LOOKS(BASES, "", "p1=\"0\"", ""),
                                       LOOKS(BASES, "", "pid=\"7\" p1=\"3\"", ""),
                                       LOOKS(BASES, "", "pid=\"6\" p1=\"0\"", ""),
                                       LOOKS(BASES, "", "pid=\"1\" p1=\"0\"", ""),
                                       LOOKS(COLORS, "", "pid=\"8\" p1=\"0\" p2=\"0\" p3=\"5\"", ""),
                                       LOOKS("<m:texture2dgroup id=\"4\" texid=\"5\"><m:tex2coord u=\"0\" v=\"0\"/>"
                                             "</m:texture2dgroup>",
                                             "", "pid=\"4\" p1=\"0\"", "")};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        model m;
        put_3mf(rows[i]);
        import_good(FILE_OF("t.3mf"), &m);
        assert_int_equal(m.material_count, 1);
        assert_true(m.triangles == 2 && is_color(&m, 0, "default", 0.6, 0.6, 0.6));
        assert_non_null(strstr(warnings, "1 triangles have a property that is not there: they are grey"));
        model_free(&m);
    }
}

/* ---- pictures ---- */

#define PICTURE(styles)                                                                                                        \
    "<m:texture2d id=\"4\" path=\"/3D/Textures/a.tga\" contenttype=\"image/png\" " styles "/>"                                 \
    "<m:texture2dgroup id=\"5\" texid=\"4\"><m:tex2coord u=\"0\" v=\"0\"/><m:tex2coord u=\"1\" v=\"0\"/>"                      \
    "<m:tex2coord u=\"1\" v=\"1\"/><m:tex2coord u=\"0\" v=\"1\"/><m:tex2coord u=\"2\" v=\"-0.5\"/></m:texture2dgroup>"
#define TEXTURED(styles) LOOKS(PICTURE(styles), "pid=\"5\"", "p1=\"0\" p2=\"1\" p3=\"2\"", "p1=\"0\" p2=\"2\" p3=\"3\"")

static void put_textured(const char *text) {
    static uint8_t image[34];
    const lab_part more = {"3D/Textures/a.tga", image, make_image(image, 255)};
    put_3mf_with(text, &more, 1);
}

/* The file's v runs upwards: its 0 is the picture's last row. The square lies in x and -z. */
static void pictures_are_where_their_coordinates_say(void **state) {
    model m;
    (void)state;
    put_textured(TEXTURED(""));
    import_good(FILE_OF("t.3mf"), &m);
    check_promises(&m);
    assert_string_equal(warnings, "");
    assert_true(m.triangles == 2 && m.material_count == 1 && m.image_count == 1 && m.images[0].width == 2);
    assert_string_equal(m.materials[0].name, "a.tga");
    assert_true(near3(m.materials[0].albedo, 1, 1, 1) && m.materials[0].image == 0 && m.materials[0].cutoff == 0.0f);
    const float corners[4][4] = {{0, 0, 0, 1}, {0.01f, 0, 1, 1}, {0.01f, -0.01f, 1, 0}, {0, -0.01f, 0, 0}};
    for (int i = 0; i < 4; i++) {
        const float *uv = m.uv + 2 * vertex_at(&m, corners[i][0], 0, corners[i][1]);
        assert_true(uv[0] == corners[i][2] && uv[1] == corners[i][3]);
    }
    model_free(&m);
}

static void pictures_repeat_as_their_tile_styles_say(void **state) {
    static const struct {
        const char *text;
        uint32_t u, v;
    } rows[] = {{TEXTURED("tilestyleu=\"wrap\" tilestylev=\"mirror\""), VIT_WRAP_REPEAT, VIT_WRAP_MIRROR},
                {TEXTURED("tilestyleu=\"clamp\""), VIT_WRAP_CLAMP, VIT_WRAP_REPEAT},
                {TEXTURED("tilestyleu=\"none\" tilestylev=\"none\" filter=\"nearest\""), VIT_WRAP_CLAMP, VIT_WRAP_CLAMP}};
    model m;
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        put_textured(rows[i].text);
        import_good(FILE_OF("t.3mf"), &m);
        assert_string_equal(warnings, "");
        assert_true(m.materials[0].wrap_u == rows[i].u && m.materials[0].wrap_v == rows[i].v);
        model_free(&m);
    }
    put_textured(LOOKS(PICTURE("tilestylev=\"none\""), "pid=\"5\"", "p1=\"0\" p2=\"4\" p3=\"2\"", ""));
    import_good(FILE_OF("t.3mf"), &m);
    assert_non_null(strstr(warnings, "tile style 'none': a texture goes on beyond its edge"));
    model_free(&m);
    put_textured(TEXTURED("tilestyleu=\"fold\""));
    refuse(FILE_OF("t.3mf"), false, "tilestyleu 'fold' is none");
}

static void a_picture_that_is_missing_is_said(void **state) {
    model m;
    (void)state;
    put_3mf(TEXTURED(""));
    import_good(FILE_OF("t.3mf"), &m);
    assert_non_null(strstr(warnings, "material 'a.tga': texture '*0' is missing"));
    assert_true(m.triangles == 2 && m.materials[0].image < 0);
    model_free(&m);
    refuse(FILE_OF("t.3mf"), true, "is missing");
}

/* ---- colours of corners ---- */

/* The picture's colour there, as filters have it: linear between texels, of linear colours. */
static void sample(const model_image *image, const float uv[2], double out[3]) {
    const double x = (double)uv[0] * image->width - 0.5, y = (double)uv[1] * image->height - 0.5;
    const int column = (int)floor(x + 1e-4), row = (int)floor(y + 1e-4);
    for (int k = 0; k < 3; k++) {
        out[k] = 0.0;
        for (int i = 0; i < 4; i++) {
            const int c = column + i % 2, r = row + i / 2;
            const double share = (i % 2 ? x - column : 1 - x + column) * (i / 2 ? y - row : 1 - y + row);
            if (c < image->width && r < image->height)
                out[k] +=
                    share * srgb_linear(image->rgba[4 * ((size_t)r * (size_t)image->width + (size_t)c) + (size_t)k] / 255.0);
        }
    }
}

/* At points all over triangle t, whose corners have these colours: barycentric in sRGB (Materials 1.3). */
static double worst_color(const model *m, size_t t, uint8_t colors[3][3]) {
    double worst = 0.0;
    const model_material *k = &m->materials[m->material[t]];
    for (int i = 0; i <= 12; i++)
        for (int j = 0; i + j <= 12; j++) {
            const double w[3] = {(12 - i - j) / 12.0, i / 12.0, j / 12.0};
            float uv[2] = {0, 0};
            double got[3];
            for (int c = 0; c < 3; c++)
                for (int a = 0; a < 2; a++)
                    uv[a] += (float)w[c] * m->uv[2 * m->index[3 * t + (size_t)c] + (size_t)a];
            sample(&m->images[k->image], uv, got);
            for (int a = 0; a < 3; a++) {
                const double want = srgb_linear((w[0] * colors[0][a] + w[1] * colors[1][a] + w[2] * colors[2][a]) / 255.0);
                worst = fmax(worst, fabs(got[a] - want));
            }
        }
    return worst;
}

/* Linear between texels both ways, an error of at most h^2 / 8 of each second derivative: h is a third of the way from corner
 * to corner, srgb_linear()'s second derivative 2.4 * 1.4 / 1.055^2 at most. And half a step of 8 bits, where they are coarsest.
 */
#define CHORDS (2 * (1.0 / 9) / 8 * (2.4 * 1.4 / (1.055 * 1.055)) + 2.4 / 1.055 / 510)
static void colours_run_between_corners(void **state) {
    model m;
    (void)state;
    import_3mf(LOOKS(COLORS, "pid=\"8\"", "p1=\"0\" p2=\"1\" p3=\"2\"", "p1=\"4\" p2=\"4\" p3=\"0\""), &m);
    assert_true(m.triangles == 2 && m.material_count == 1 && m.image_count == 1);
    assert_string_equal(m.materials[0].name, "colours of corners");
    assert_true(worst_color(&m, 0, (uint8_t[3][3]){{255, 0, 0}, {0, 255, 0}, {0, 0, 255}}) < CHORDS);
    assert_true(worst_color(&m, 1, (uint8_t[3][3]){{128, 128, 128}, {128, 128, 128}, {255, 0, 0}}) < CHORDS);
    for (size_t c = 0; c < 3; c++) {
        double got[3];
        sample(&m.images[0], m.uv + 2 * m.index[c], got);
        for (size_t k = 0; k < 3; k++)
            assert_true(fabs(got[k] - (k == c)) < 1e-3);
    }
    model_free(&m);
}

/* More colours than become materials: each triangle of the strip has one, all over. */
static void many_colours_are_all_there(void **state) {
    enum { COUNT = 600, KEPT = 256 };
    static char text[1 << 17];
    model m;
    (void)state;
    size_t used = (size_t)snprintf(text, sizeof text, "<model " CORE_NS " " MATERIAL_NS "><resources><m:colorgroup id=\"8\">");
    for (unsigned i = 0; i < COUNT; i++)
        used +=
            (size_t)snprintf(text + used, sizeof text - used, "<m:color color=\"#%02X%02X40\"/>", i % 251, 255 - i % 13 * 19);
    used += (size_t)snprintf(text + used, sizeof text - used, "</m:colorgroup><object id=\"1\" pid=\"8\"><mesh><vertices>");
    for (unsigned i = 0; i < COUNT + 2; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "<vertex x=\"%u\" y=\"%u\" z=\"0\"/>", i, i % 2);
    used += (size_t)snprintf(text + used, sizeof text - used, "</vertices><triangles>");
    for (unsigned i = 0; i < COUNT; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "<triangle v1=\"%u\" v2=\"%u\" v3=\"%u\" p1=\"%u\"/>", i,
                                 i + 1, i + 2, i);
    used += (size_t)snprintf(text + used, sizeof text - used,
                             "</triangles></mesh></object></resources><build><item objectid=\"1\"/></build></model>");
    assert_true(used < sizeof text);
    const lab_part parts[] = {RELATION("/3D/3dmodel.model"), LAB_TEXT_PART("3D/3dmodel.model", text)};
    put_packed_archive(FILE_OF("t.3mf"), parts, 2);
    import_good(FILE_OF("t.3mf"), &m);
    check_promises(&m);
    assert_string_equal(warnings, "");
    assert_true(m.triangles == COUNT && m.material_count == KEPT + 1);
    for (size_t t = 0; t < COUNT; t++) {
        const model_material *k = &m.materials[m.material[t]];
        const unsigned i =
            (unsigned)lround((double)fminf(fminf(m.position[3 * m.index[3 * t]], m.position[3 * m.index[3 * t + 1]]),
                                           m.position[3 * m.index[3 * t + 2]]) *
                             1000.0);
        const double want[3] = {srgb_linear(i % 251 / 255.0), srgb_linear((255 - i % 13 * 19) / 255.0),
                                srgb_linear(64 / 255.0)};
        for (size_t c = 0; c < 3 && k->image >= 0; c++) {
            double got[3];
            sample(&m.images[0], m.uv + 2 * m.index[3 * t + c], got);
            for (size_t a = 0; a < 3; a++)
                assert_true(fabs(got[a] - want[a]) < 1e-6);
        }
        assert_true(k->image >= 0 || near3(k->albedo, want[0], want[1], want[2]));
    }
    model_free(&m);
}

/* ---- wrong ---- */

static void groups_that_are_wrong_are_refused(void **state) {
    static const struct {
        const char *text, *what;
    } rows[] = {
        {LOOKS("<basematerials id=\"7\"><base name=\"a\"/></basematerials>", "", "", ""), "<base> has no displaycolor"},
        {LOOKS("<basematerials id=\"7\"><base name=\"a\" displaycolor=\"red\"/></basematerials>", "", "", ""),
         "displaycolor 'red' is not #RRGGBB or #RRGGBBAA"},
        {LOOKS("<m:colorgroup id=\"7\"><m:color color=\"#12345\"/></m:colorgroup>", "", "", ""), "color '#12345' is not"},
        {LOOKS("<m:colorgroup><m:color color=\"#123456\"/></m:colorgroup>", "", "", ""), "<colorgroup> has no id"},
        {LOOKS("<m:texture2d id=\"7\"/>", "", "", ""), "<texture2d> has no path"},
        {LOOKS("<m:texture2dgroup id=\"7\"/>", "", "", ""), "<texture2dgroup> has no texid"},
        {LOOKS("<m:texture2dgroup id=\"7\" texid=\"8\"><m:tex2coord u=\"0\"/></m:texture2dgroup>", "", "", ""),
         "<tex2coord> has not two numbers"},
        {LOOKS(BASES "<m:compositematerials id=\"9\" matid=\"7\" matindices=\"0 9\"><m:composite values=\"1 1\"/>"
                     "</m:compositematerials>",
               "", "", ""),
         "mixes a base material 9 that is not there"},
        {LOOKS("<m:compositematerials id=\"9\" matid=\"7\" matindices=\"0\"><m:composite values=\"1\"/></m:compositematerials>",
               "", "", ""),
         "mixes no base materials"},
        {LOOKS("", "pid=\"x\"", "", ""), "pid 'x' of <object> is no index"},
        {LOOKS("", "", "p1=\"x\"", ""), "p1 'x' of a triangle is no index"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        put_3mf(rows[i].text);
        refuse(FILE_OF("t.3mf"), false, rows[i].what);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        T(triangles_have_their_base_material_or_that_of_their_object),
        T(colours_are_srgb),
        T(the_scene_file_names_base_materials),
        T(alpha_of_base_materials_is_a_hole_and_of_colours_nothing),
        T(colours_that_are_alike_are_one_material),
        T(mixtures_are_means_of_reflectances),
        T(the_last_layer_is_shown_and_the_others_are_said),
        T(metals_reflect),
        T(properties_that_are_not_there_are_grey_and_said),
        T(pictures_are_where_their_coordinates_say),
        T(pictures_repeat_as_their_tile_styles_say),
        T(a_picture_that_is_missing_is_said),
        T(colours_run_between_corners),
        T(many_colours_are_all_there),
        T(groups_that_are_wrong_are_refused),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
