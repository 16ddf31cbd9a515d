/* Scenes in which little or nothing is lit, stores photons or is seen: all are right scenes, which bake with every way of
 * indirect light and play with the hashes of their packs. What must be black is black in every bit. */
#include "scene_lab.h"

#define SIDE 24
enum { FRAMES = 2 };
#define FLOATS ((size_t)4 * SIDE * SIDE * FRAMES)

#define POINT(x, y, z, w)                                                                                                      \
    "{ type = \"point\"; keys = ( { position = [" x ", " y ", " z "]; power = [" w ", " w ", " w "]; } ); }"
#define LIGHT(text) "lights = ( " text " );\n"
#define INSIDE LIGHT(POINT("0.3", "0.5", "0.2", "10.0"))
#define OUTSIDE LIGHT(POINT("9.0", "0.5", "0.2", "10.0"))
#define MATERIAL(text) "materials = ( { name = \"DefaultMaterial\"; " text " } );\n"
#define KEY(eye, target) "{ eye = [" eye "]; target = [" target "]; fov = 70.0; }"
#define VIEW KEY("0.7, 0.5, 0.7", "-0.5, -0.2, -0.5")
#define ROOM "{ file = \"room.obj\"; }"
#define FLOOR "{ file = \"floor.obj\"; }"
#define SMALL "{ file = \"room.obj\"; scale = 0.2; }"

static const struct {
    const char *name, *meshes, *camera, *rest;
    bool black;
} scenes[] = {
    {"a room of mirrors", ROOM, VIEW, INSIDE MATERIAL("kind = \"mirror\"; specular = [0.9, 0.9, 0.9];"), true},
    {"one mirror, and a light", FLOOR, KEY("0.0, 2.0, 0.0", "0.0, 0.0, 0.1"),
     INSIDE MATERIAL("kind = \"mirror\"; specular = [0.9, 0.9, 0.9];"), true},
    {"a room of glass", ROOM, VIEW, INSIDE MATERIAL("kind = \"glass\";"), true},
    {"a room of panes", ROOM, VIEW, INSIDE MATERIAL("kind = \"thin_glass\";"), true},
    {"the light is outside", ROOM, VIEW, OUTSIDE, true},
    {"the sky is outside", ROOM, VIEW, "background = [1.0, 1.0, 1.0]; sky: { light = true; };\n", true},
    {"the sun is outside", ROOM, VIEW,
     LIGHT("{ type = \"directional\"; keys = ( { position = [1.0, 3.0, 2.0]; target = [0.0, 0.0, 0.0]; irradiance = [1.0, 1.0, "
           "1.0]; } ); }"),
     true},
    {"the light is in a solid", ROOM ", " SMALL, VIEW, LIGHT(POINT("0.0", "0.0", "0.0", "10.0")), true},
    {"the camera is in a solid", ROOM ", " SMALL, KEY("0.0, 0.0, 0.0", "0.0, 0.0, -1.0"), INSIDE, true},
    {"no light", ROOM, VIEW, "", true},
    {"no power", ROOM, VIEW, LIGHT(POINT("0.3", "0.5", "0.2", "0.0")), true},
    {"no power but of a light outside", ROOM, VIEW,
     LIGHT(POINT("0.3", "0.5", "0.2", "0.0") ", " POINT("9.0", "0.5", "0.2", "1.0")), true},
    {"a light that ends before any surface", ROOM, VIEW,
     LIGHT("{ type = \"point\"; range = 0.1; keys = ( { position = [0.0, 0.0, 0.0]; power = [10.0, 10.0, 10.0]; } ); }"), true},
    {"a spot light that shines away", FLOOR, KEY("0.0, 2.0, 0.0", "0.0, 0.0, 0.1"),
     LIGHT(
         "{ type = \"spot\"; keys = ( { position = [0.0, 1.0, 0.0]; target = [0.0, 2.0, 0.0]; power = [9.0, 9.0, 9.0]; } ); }"),
     true},
    {"the camera sees nothing", FLOOR, KEY("0.0, 2.0, 0.0", "0.0, 4.0, 0.1"), LIGHT(POINT("0.0", "1.0", "0.0", "9.0")), true},
    {"all surfaces are black", ROOM, VIEW, INSIDE MATERIAL("color = [0.0, 0.0, 0.0];"), true},
    {"all photons leave", FLOOR, KEY("0.0, 2.0, 0.0", "0.0, 0.0, 0.1"), LIGHT(POINT("0.0", "1.0", "0.0", "9.0")), false},
    {"all that glows lights nothing", ROOM, VIEW, MATERIAL("emission = [1.0, 2.0, 3.0]; area_light = false;"), false},
    {"all surfaces shine", ROOM, VIEW, MATERIAL("emission = [1.0, 2.0, 3.0];"), false},
    {"all surfaces shine and are black", ROOM, VIEW, MATERIAL("color = [0.0, 0.0, 0.0]; emission = [1.0, 2.0, 3.0];"), false},
    {"ambient light alone", ROOM, VIEW, "ambient = [0.1, 0.1, 0.1];\n", false},
    {"a light in a wall", ROOM, VIEW, LIGHT(POINT("0.0", "1.0", "0.0", "10.0")), false},
    {"a light that comes in from outside", ROOM, VIEW,
     LIGHT("{ type = \"point\"; keys = ( { position = [9.0, 0.0, 0.0]; power = [9.0, 9.0, 9.0]; }, { time = 0.04; position = "
           "[0.0, 0.0, 0.0]; } ); }"),
     false},
};

static const char *const ways[] = {"", "--zones 2 --effective-area 1", "--zones 0 --effective-area 1 --caustics 0",
                                   "--zones 1 --estimate buckets --radius 0.3 --photons 100"};

static int set_up(void **state) {
    static const double half[3] = {1.0, 1.0, 1.0};
    scene_lab_set_up(state);
    scene_lab *l = *state;
    scene_lab_write_room(l, "room.obj", half, 0.0);
    FILE *f = scene_lab_create(l, "floor.obj");
    (void)fputs("v -1 0 -1\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nf 1 2 3 4\n", f);
    (void)fclose(f);
    return 0;
}

static void write_scene(scene_lab *l, size_t i) {
    FILE *f = scene_lab_create(l, "scene.cfg");
    (void)fprintf(f,
                  "output: { width = %d; height = %d; frames = %d; };\nmeshes = ( %s );\ncamera: { keys = ( %s ); };\n%s"
                  "quality: { photons = 2000; };\n",
                  SIDE, SIDE, FRAMES, scenes[i].meshes, scenes[i].camera, scenes[i].rest);
    (void)fclose(f);
}

static void dark_scenes_bake_in_every_way_and_are_black_where_they_should(void **state) {
    static float pixels[FLOATS];
    scene_lab *l = *state;
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i++) {
        write_scene(l, i);
        for (size_t k = 0; k < sizeof ways / sizeof ways[0]; k++) {
            char line[256];
            print_message("%s: %s\n", scenes[i].name, ways[k]);
            scene_lab_bake(l, "scene.cfg", ways[k]);
            (void)snprintf(line, sizeof line, "%s --verify --quiet --device host", scene_lab_path(l, "scene.vit"));
            scene_lab_run(l, "vitrine-play", line);
            scene_lab_play(l, "final", pixels, FLOATS);
            float most = 0.0f;
            for (size_t p = 0; p < FLOATS; p++)
                most = p % 4 < 3 && pixels[p] > most ? pixels[p] : most;
            if ((most > 0.0f) == scenes[i].black)
                fail_msg("%s, %s: the brightest pixel has %g", scenes[i].name, ways[k], (double)most);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dark_scenes_bake_in_every_way_and_are_black_where_they_should),
    };
    return cmocka_run_group_tests(tests, set_up, scene_lab_tear_down);
}
