/* A lamp over a floor, seen straight from above through the real programs: every pixel's radiance is a closed form of where the
 * pixel looks and of what the scene file or the model says of the lamp, so a wrong unit, cone or falloff shows as a figure. */
#include "scene_lab.h"

#include "light/light_model.h"
#include <math.h>

#define PI 3.14159265358979323846
enum { SIDE = 48 }; /* pixels of the frame's edge */
#define FLOATS ((size_t)4 * SIDE * SIDE)
#define HEIGHT 4.0 /* of the camera, m */
#define EDGE 2.4   /* half of what it sees of the floor, m */
#define LAMP 2.0   /* height of the lamp, m */
#define ALBEDO 0.5

/* Radiant intensity, W/sr a unit, of the lamp into the direction whose cosine to straight down is `c`, times falloff at d
 * metres. */
typedef double lamp_form(double c, double d);

/* The scene: `mesh`, and `light` as one of its lights. */
static void write_scene(scene_lab *l, const char *mesh, const char *light, const char *more) {
    FILE *f = scene_lab_create(l, "scene.cfg");
    (void)fprintf(
        f,
        "output: { width = %d; height = %d; frames = 1; };\nmeshes = ( { file = \"%s\"; } );\n"
        "camera: { keys = ( { eye = [0.0, %.1f, 0.0]; target = [0.0, 0.0, 0.0]; up = [0.0, 0.0, -1.0]; fov = %.9g; } ); };\n"
        "lights = ( %s );\n%s\nquality: { photons = 0; };\n",
        SIDE, SIDE, mesh, HEIGHT, 2.0 * atan(EDGE / HEIGHT) * 180.0 / PI, light, more);
    (void)fclose(f);
}

static void write_floor(scene_lab *l) {
    FILE *f = scene_lab_create(l, "floor.mtl");
    (void)fprintf(f, "newmtl floor\nKd %g %g %g\n", ALBEDO, ALBEDO, ALBEDO);
    (void)fclose(f);
    f = scene_lab_create(l, "floor.obj");
    (void)fprintf(f, "mtllib floor.mtl\nusemtl floor\nv -5 0 5\nv 5 0 5\nv 5 0 -5\nv -5 0 -5\nf 1 2 3 4\n");
    (void)fclose(f);
}

/* Every pixel shows ALBEDO / pi times `scale` times the form times the cosine at the floor, within 1/500 of the brightest. */
static void shows(scene_lab *l, double scale, lamp_form *form) {
    static float pixels[FLOATS];
    double most = 0.0, worst = 0.0;
    scene_lab_play(l, "final", pixels, FLOATS);
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < SIDE * SIDE; i++) {
            const double x = EDGE * (2.0 * (i % SIDE + 0.5) / SIDE - 1.0), z = EDGE * (2.0 * (i / SIDE + 0.5) / SIDE - 1.0);
            const double d = sqrt(x * x + z * z + LAMP * LAMP), c = LAMP / d;
            const double due = ALBEDO / PI * scale * form(c, d) * c, is = (double)pixels[4 * i + 1];
            most = fmax(most, due);
            worst = fmax(worst, fabs(is - due));
            if (pass && fabs(is - due) > most / 500.0)
                fail_msg("pixel %d, %d, %g m from the lamp: %g, due %g (worst of all: %g off)", i % SIDE, i / SIDE, d, is, due,
                         worst);
        }
    assert_true(most > 0.0);
}

/* KHR_lights_punctual's window of a range of 2.5 m, by its letter: max(min(1 - (d / range)^4, 1), 0) / d^2. */
static double within_range(double c, double d) {
    (void)c;
    return fmax(fmin(1.0 - pow(d / 2.5, 4.0), 1.0), 0.0) / (d * d);
}

static void a_range_is_khr_lights_punctuals(void **state) {
    scene_lab *l = *state;
    write_floor(l);
    write_scene(l, "floor.obj",
                "{ type = \"point\"; range = 2.5; keys = ( { position = [0.0, 2.0, 0.0]; power = [100.0, 100.0, 100.0]; } ); }",
                "");
    scene_lab_bake(l, "scene.cfg", "");
    shows(l, 100.0 / (4.0 * PI), within_range);
}

static void the_reference_has_that_range_too(void **state) {
    (void)state;
    const vit_light lamp = {.kind = VIT_LIGHT_POINT, .inv_range2 = 1.0f / (2.5f * 2.5f)};
    for (int i = 0; i <= 11; i++) {
        const double d = 2.0 + 0.1 * i;
        assert_true(fabs((double)light_falloff(&lamp, (float)(d * d)) - within_range(1.0, d)) < 1e-6);
    }
}

/* ---- lights of glTF files ---- */

#define LUMENS 683.0 /* a watt */
/* cos of the angles of CONE, radians from the axis */
#define CONE "\"spot\":{\"innerConeAngle\":0.3,\"outerConeAngle\":0.6}"
#define COS_INNER 0.955336489
#define COS_OUTER 0.825335615

/* A floor of albedo 0.5 and, LAMP m over it, node "Lamp" with `light`, which shines straight down. */
static void write_gltf(scene_lab *l, const char *light, const char *material) {
    FILE *f = scene_lab_create(l, "lamp.gltf");
    (void)fprintf(f,
                  "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],\"extensionsUsed\":[\"KHR_"
                  "lights_punctual\"],"
                  "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{%s}]}},\"nodes\":[{\"mesh\":0},{\"name\":\"Lamp\","
                  "\"translation\":[0,%g,0],"
                  "\"rotation\":[-0.70710678,0,0,0.70710678],\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}],"
                  "\"materials\":[{\"name\":\"floor\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[%g,%g,%g,1],"
                  "\"metallicFactor\":0}%s}],"
                  "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,\"material\":0}]}],"
                  "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"min\":[-5,0,-5],"
                  "\"max\":[5,0,5]},"
                  "{\"bufferView\":1,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}],"
                  "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":12}],"
                  "\"buffers\":[{\"byteLength\":60,\"uri\":\"data:application/octet-stream;base64,"
                  "AACgwAAAAAAAAKBAAACgQAAAAAAAAKBAAACgQAAAAAAAAKDAAACgwAAAAAAAAKDAAAABAAIAAAACAAMA\"}]}",
                  light, LAMP, ALBEDO, ALBEDO, ALBEDO, material);
    (void)fclose(f);
}

/* Bakes the floor under the glTF light; what the baker says is then in the laboratory. */
static void bake_gltf(scene_lab *l, const char *light, const char *material, const char *more) {
    char line[256];
    write_gltf(l, light, material);
    write_scene(l, "lamp.gltf", "{ use = \"Lamp\"; }", more);
    (void)snprintf(line, sizeof line, "%s", scene_lab_path(l, "scene.cfg"));
    (void)snprintf(line + strlen(line), sizeof line - strlen(line), " -o %s --device host", scene_lab_path(l, "scene.vit"));
    scene_lab_run(l, "vitrine-bake", line);
}

static double everywhere(double c, double d) {
    (void)c;
    return 1.0 / (d * d);
}

/* By the letter of the extension. */
static double in_cone(double c, double d) {
    const double a = fmin(fmax((c - COS_OUTER) / (COS_INNER - COS_OUTER), 0.0), 1.0);
    return a * a / (d * d);
}

static double from_above(double c, double d) {
    (void)d;
    return 1.0 / c; /* shows() multiplies by the cosine to the lamp; here it is 1 */
}

static void candela_and_lux_are_watts_by_683(void **state) {
    scene_lab *l = *state;
    bake_gltf(l, "\"type\":\"point\",\"intensity\":5435.14", "", "");
    assert_true(scene_lab_said(l, "light 'Lamp': 5435.14 cd = 7.96 W/sr"));
    shows(l, 5435.14 / LUMENS, everywhere);
    bake_gltf(l, "\"type\":\"point\",\"intensity\":5435.14,\"range\":2.5", "", "");
    shows(l, 5435.14 / LUMENS, within_range);
    bake_gltf(l, "\"type\":\"spot\",\"intensity\":5435.14," CONE, "", "");
    shows(l, 5435.14 / LUMENS, in_cone);
    bake_gltf(l, "\"type\":\"directional\",\"intensity\":2000", "", "");
    assert_true(scene_lab_said(l, "light 'Lamp': 2000 lx = 2.93 W/m2"));
    shows(l, 2000.0 / LUMENS, from_above);
}

static void a_scene_file_may_say_that_they_are_watts(void **state) {
    scene_lab *l = *state;
    bake_gltf(l, "\"type\":\"point\",\"intensity\":8", "", "light_units = \"radiometric\";");
    assert_true(scene_lab_said(l, "light 'Lamp': 8 taken as W/sr"));
    shows(l, 8.0, everywhere);
    bake_gltf(l, "\"type\":\"point\",\"intensity\":8", "", "light_units = \"photometric\";");
    shows(l, 8.0 / LUMENS, everywhere);
}

/* Radiance of the frame's middle, which a light of 1e-6 cd does not change. */
static double glow(scene_lab *l, const char *units, const char *said) {
    static float pixels[FLOATS];
    bake_gltf(l, "\"type\":\"point\",\"intensity\":1e-6", ",\"emissiveFactor\":[0.5,0.5,0.5]", units);
    assert_true(scene_lab_said(l, said));
    scene_lab_play(l, "final", pixels, FLOATS);
    return (double)pixels[4 * (SIDE / 2 * SIDE + SIDE / 2)];
}

/* Exporters scale lights, not emission; by the letter both are photometric. */
static void emission_stays_unless_it_is_said_to_be_nits(void **state) {
    scene_lab *l = *state;
    const char *watts = "emission of 1 glTF materials is taken as W/(m2 sr)";
    assert_true(fabs(glow(l, "", watts) - 0.5) < 1e-5);
    assert_true(fabs(glow(l, "light_units = \"radiometric\";", watts) - 0.5) < 1e-5);
    assert_true(fabs(glow(l, "light_units = \"photometric\";", "taken as nits: 683 nits = 1 W/(m2 sr)") - 0.5 / LUMENS) < 1e-5);
}

static void a_light_of_no_intensity_is_warned_of(void **state) {
    scene_lab *l = *state;
    static float pixels[FLOATS];
    bake_gltf(l, "\"type\":\"point\",\"intensity\":0", "", "");
    assert_true(scene_lab_said(l, "warning: light 'Lamp' has intensity 0"));
    scene_lab_play(l, "final", pixels, FLOATS);
    for (size_t i = 0; i < FLOATS; i++)
        assert_true(i % 4 == 3 || pixels[i] == 0.0f);
}

/* COLLADA: a spot of 45 degrees across, and one whose format leaves out the angle, which is half the sphere. */
#define DAE_SPOT(id, more)                                                                                                     \
    "<light id=\"" id "\"><technique_common><spot><color>4 4 4</color>" more "</spot></technique_common></light>"
static const char collada[] =
    "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
    "version=\"1.4.1\"><asset><up_axis>Y_UP</up_axis></asset>"
    "<library_lights>" DAE_SPOT("L1", "<falloff_angle>45</falloff_angle><falloff_exponent>0.15</falloff_exponent>") DAE_SPOT(
        "L2",
        "") "<light id=\"L3\"><technique_common><ambient><color>1 1 "
            "1</color></ambient></technique_common></light></library_lights>"
            "<library_effects><effect id=\"E\"><profile_COMMON><technique sid=\"t\"><lambert><diffuse><color>0.5 0.5 0.5 "
            "1</color></diffuse></lambert>"
            "</technique></profile_COMMON></effect></library_effects>"
            "<library_materials><material id=\"M\"><instance_effect url=\"#E\"/></material></library_materials>"
            "<library_geometries><geometry id=\"G\"><mesh><source id=\"P\"><float_array id=\"PA\" count=\"12\">-5 0 5 5 0 5 5 "
            "0 -5 -5 0 -5</float_array>"
            "<technique_common><accessor source=\"#PA\" count=\"4\" stride=\"3\"><param name=\"X\" type=\"float\"/><param "
            "name=\"Y\" type=\"float\"/>"
            "<param name=\"Z\" type=\"float\"/></accessor></technique_common></source><vertices id=\"V\"><input "
            "semantic=\"POSITION\" source=\"#P\"/></vertices>"
            "<triangles count=\"2\" material=\"m\"><input semantic=\"VERTEX\" source=\"#V\" offset=\"0\"/><p>0 1 2 0 2 "
            "3</p></triangles></mesh></geometry></library_geometries>"
            "<library_visual_scenes><visual_scene id=\"S\"><node id=\"floor\"><instance_geometry "
            "url=\"#G\"><bind_material><technique_common>"
            "<instance_material symbol=\"m\" target=\"#M\"/></technique_common></bind_material></instance_geometry></node>"
            "<node id=\"Narrow\"><translate>0 2 0</translate><rotate>1 0 0 -90</rotate><instance_light url=\"#L1\"/></node>"
            "<node id=\"Wide\"><translate>0 2 0</translate><rotate>1 0 0 -90</rotate><instance_light url=\"#L2\"/></node>"
            "<node id=\"Ambient\"><instance_light url=\"#L3\"/></node></visual_scene></library_visual_scenes>"
            "<scene><instance_visual_scene url=\"#S\"/></scene></COLLADA>";

/* Half of 45 degrees, and a thousandth of edge. */
static double in_narrow(double c, double d) {
    const double a = fmin(fmax((c - cos(22.5 * PI / 180.0)) / 0.001, 0.0), 1.0);
    return a * a / (d * d);
}

static void lights_without_a_unit_are_watts_with_a_warning(void **state) {
    scene_lab *l = *state;
    FILE *f = scene_lab_create(l, "lamp.dae");
    (void)fputs(collada, f);
    (void)fclose(f);
    write_scene(l, "lamp.dae", "{ use = \"Narrow\"; }", "");
    scene_lab_bake(l, "scene.cfg", "");
    assert_true(scene_lab_said(l, "warning: light 'Narrow': its format states no unit: 4 taken as W/sr, inverse-square"));
    assert_true(scene_lab_said(l, "light 'Ambient' is no point, spot or directional light; it is left out"));
    shows(l, 4.0, in_narrow);
    write_scene(l, "lamp.dae", "{ use = \"Wide\"; }", "light_units = \"radiometric\";");
    scene_lab_bake(l, "scene.cfg", "");
    assert_false(scene_lab_said(l, "states no unit"));
    shows(l, 4.0, everywhere);
    write_scene(l, "lamp.dae", "{ use = \"Wide\"; }", "light_units = \"photometric\";");
    scene_lab_bake(l, "scene.cfg", "");
    shows(l, 4.0 / LUMENS, everywhere);
}

/* FBX: percents, whole angles, down -y. */
static const char fbx[] =
    "; FBX 7.3.0 project file\nFBXHeaderExtension:  {\nFBXHeaderVersion: 1003\nFBXVersion: 7300\n}\n"
    "GlobalSettings:  {\nVersion: 1000\nProperties70:  {\nP: \"UpAxis\", \"int\", \"Integer\", \"\",1\n"
    "P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",100\n}\n}\nObjects:  {\n"
    "Geometry: 1, \"Geometry::G\", \"Mesh\" {\nVertices: *12 {\na: -5,0,5,5,0,5,5,0,-5,-5,0,-5\n}\nPolygonVertexIndex: *4 "
    "{\na: 0,1,2,-4\n}\n}\n"
    "Model: 2, \"Model::floor\", \"Mesh\" {\nVersion: 232\n}\n"
    "Model: 3, \"Model::Spot\", \"Light\" {\nVersion: 232\nProperties70:  {\n"
    "P: \"Lcl Translation\", \"Lcl Translation\", \"\", \"A\",0,2,0\n}\n}\n"
    "NodeAttribute: 4, \"NodeAttribute::SpotAttr\", \"Light\" {\nProperties70:  {\nP: \"LightType\", \"enum\", \"\", \"\",2\n"
    "P: \"Color\", \"Color\", \"\", \"A\",1,0.5,0.25\nP: \"Intensity\", \"Number\", \"\", \"A\",400\n"
    "P: \"InnerAngle\", \"Number\", \"\", \"A\",30\nP: \"OuterAngle\", \"Number\", \"\", \"A\",60\n}\nTypeFlags: "
    "\"Light\"\n}\n}\n"
    "Connections:  {\nC: \"OO\",2,0\nC: \"OO\",1,2\nC: \"OO\",3,0\nC: \"OO\",4,3\n}\n";

static double in_fbx_cone(double c, double d) {
    const double inner = cos(15.0 * PI / 180.0), outer = cos(30.0 * PI / 180.0),
                 a = fmin(fmax((c - outer) / (inner - outer), 0.0), 1.0);
    return a * a / (d * d);
}

static void a_cone_of_fbx_is_a_whole_angle(void **state) {
    scene_lab *l = *state;
    FILE *f = scene_lab_create(l, "lamp.fbx");
    (void)fputs(fbx, f);
    (void)fclose(f);
    write_scene(l, "lamp.fbx", "{ use = \"Spot\"; }",
                "materials = ( { name = \"DefaultMaterial\"; color = [0.5, 0.5, 0.5]; } );");
    scene_lab_bake(l, "scene.cfg", "");
    assert_true(scene_lab_said(l, "light 'Spot': its format states no unit: (4, 2, 1) taken as W/sr, inverse-square"));
    shows(l, 2.0, in_fbx_cone); /* the channel in the middle */
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_range_is_khr_lights_punctuals),
                                       cmocka_unit_test(the_reference_has_that_range_too),
                                       cmocka_unit_test(candela_and_lux_are_watts_by_683),
                                       cmocka_unit_test(a_scene_file_may_say_that_they_are_watts),
                                       cmocka_unit_test(emission_stays_unless_it_is_said_to_be_nits),
                                       cmocka_unit_test(a_light_of_no_intensity_is_warned_of),
                                       cmocka_unit_test(lights_without_a_unit_are_watts_with_a_warning),
                                       cmocka_unit_test(a_cone_of_fbx_is_a_whole_angle)};
    return cmocka_run_group_tests_name("a lamp over a floor", tests, scene_lab_set_up, scene_lab_tear_down);
}
