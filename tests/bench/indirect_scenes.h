/* Scenes of bench_indirect.c: boxes, lamps and models that no constant of the baker was chosen on, written as OBJ and scene
 * file into the bench's folder. Metres; a frame of `width` x `height` each, with no quality block: the baker's own choice. */
#ifndef VIT_BENCH_INDIRECT_SCENES_H
#define VIT_BENCH_INDIRECT_SCENES_H

#include "scenes.h"

#define UNTUNED_FOLDER_NAME "indirect"

/* A box with edges along the axes, turned about the vertical line through pivot[0], pivot[1] (x, z). */
typedef struct slab {
    const char *material;
    double lo[3], hi[3], pivot[2], degrees;
} slab;

#define T 0.15 /* of walls */
/* The air of a closed room: floor, ceiling and four walls around it. */
#define ROOM(floor, top, left, right, back, front, x0, x1, y, z0, z1)                                                          \
    {floor, {x0 - T, -T, z0 - T}, {x1 + T, 0, z1 + T}, {0}, 0}, {top, {x0 - T, y, z0 - T}, {x1 + T, y + T, z1 + T}, {0}, 0},   \
        {left, {x0 - T, 0, z0 - T}, {x0, y, z1 + T}, {0}, 0}, {right, {x1, 0, z0 - T}, {x1 + T, y, z1 + T}, {0}, 0},           \
        {back, {x0, 0, z0 - T}, {x1, y, z0}, {0}, 0}, {                                                                        \
        front, {x0, 0, z1}, {x1, y, z1 + T}, {0}, 0                                                                            \
    }
#define BOX(material, x0, y0, z0, x1, y1, z1)                                                                                  \
    { material, {x0, y0, z0}, {x1, y1, z1}, {0}, 0 }
/* A table of top height y over [x0, x1] x [z0, z1]. */
#define TABLE(x0, x1, y, z0, z1)                                                                                               \
    BOX("wood", x0, y - 0.04, z0, x1, y, z1), BOX("wood", x0 + 0.03, 0, z0 + 0.03, x0 + 0.09, y - 0.04, z0 + 0.09),            \
        BOX("wood", x1 - 0.09, 0, z0 + 0.03, x1 - 0.03, y - 0.04, z0 + 0.09),                                                  \
        BOX("wood", x0 + 0.03, 0, z1 - 0.09, x0 + 0.09, y - 0.04, z1 - 0.03),                                                  \
        BOX("wood", x1 - 0.09, 0, z1 - 0.09, x1 - 0.03, y - 0.04, z1 - 0.03)

/* Two rooms side by side; a door of 0.9 x 2 m in the wall between, hinged at its far end, opens into the lit one at x < 0. */
#define DOOR(angle)                                                                                                            \
    ROOM("wood", "white", "blue", "red", "grey", "grey", -4.0, 4.0, 2.8, -2.0, 2.0),                                           \
        BOX("white", -0.06, 0, -2.0, 0.06, 2.8, -0.5), BOX("white", -0.06, 0, 0.4, 0.06, 2.8, 2.0),                            \
        BOX("white", -0.06, 2.0, -0.5, 0.06, 2.8, 0.4),                                                                        \
        {"wood", {-0.1, 0.004, -0.496}, {-0.06, 1.996, 0.396}, {-0.06, -0.496}, angle}, TABLE(1.6, 3.0, 0.75, -1.7, -0.8)

static const slab door_5cm[] = {DOOR(-3.2)}, door_20[] = {DOOR(-20.0)};

/* A house of 6 x 5 m with two windows of 60 cm in the wall at z = 2.5, 25 cm thick, on a lawn. */
static const slab house[] = {BOX("lawn", -30, -0.3, -30, 30, -0.2, 30),        BOX("wood", -3.25, -0.2, -2.75, 3.25, 0, 2.75),
                             BOX("white", -3.25, 2.6, -2.75, 3.25, 2.8, 2.75), BOX("red", -3.25, 0, -2.75, -3, 2.6, 2.75),
                             BOX("white", 3, 0, -2.75, 3.25, 2.6, 2.75),       BOX("white", -3, 0, -2.75, 3, 2.6, -2.5),
                             BOX("white", -3, 0, 2.5, 3, 1.0, 2.75),           BOX("white", -3, 1.6, 2.5, 3, 2.6, 2.75),
                             BOX("white", -3, 1.0, 2.5, -1.6, 1.6, 2.75),      BOX("white", -1.0, 1.0, 2.5, 1.0, 1.6, 2.75),
                             BOX("white", 1.6, 1.0, 2.5, 3, 1.6, 2.75),        TABLE(-1.0, 0.6, 0.75, -1.2, -0.3),
                             BOX("blue", 1.6, 0, -2.4, 2.9, 0.9, -1.6)};

static const slab under_ceiling[] = {ROOM("wood", "white", "red", "green", "white", "grey", -2.0, 2.0, 2.7, -2.0, 2.0),
                                     BOX("lamp", -0.25, 2.675, -0.25, 0.25, 2.68, 0.25), /* 2 cm under the ceiling */
                                     TABLE(-0.8, 0.8, 0.75, -1.0, 0.0), BOX("blue", 1.2, 0, -1.8, 1.9, 1.6, -1.2)};

/* Four walls of 5 m about a court of 10 x 10 m, and a roofed walk on pillars along the far one. */
static const slab court[] = {BOX("stone", -5.3, -0.2, -5.3, 5.3, 0, 5.3),
                             BOX("white", -5.3, 0, -5.3, -5, 5, 5.3),
                             BOX("brick", 5, 0, -5.3, 5.3, 5, 5.3),
                             BOX("brick", -5, 0, -5.3, 5, 5, -5),
                             BOX("white", -5, 0, 5, 5, 5, 5.3),
                             BOX("white", -5, 2.8, -5, 5, 3.0, -3),
                             BOX("stone", -3.4, 0, -3.4, -3.1, 2.8, -3.1),
                             BOX("stone", -1.15, 0, -3.4, -0.85, 2.8, -3.1),
                             BOX("stone", 0.85, 0, -3.4, 1.15, 2.8, -3.1),
                             BOX("stone", 3.1, 0, -3.4, 3.4, 2.8, -3.1),
                             BOX("lawn", -1.5, 0, -0.5, 1.5, 0.4, 2.0)};

/* A leg along x that the camera looks down, and one along z with the lamp at its end. */
static const slab corridor[] = {BOX("wood", -6.15, -T, -6.15, 1.65, 0, 0.9),  BOX("white", -6.15, 2.5, -6.15, 1.65, 2.65, 0.9),
                                BOX("blue", -6.15, 0, 0.75, 1.65, 2.5, 0.9),  BOX("green", 1.5, 0, -6.15, 1.65, 2.5, 0.75),
                                BOX("white", -6.15, 0, -0.9, 0, 2.5, -0.75),  BOX("white", -0.15, 0, -6.15, 0, 2.5, -0.9),
                                BOX("white", -6.15, 0, -0.75, -6, 2.5, 0.75), BOX("red", 0, 0, -6.15, 1.5, 2.5, -6.0)};

static const slab bulb_room[] = {ROOM("wood", "white", "green", "grey", "white", "red", -1.25, 1.25, 2.4, -1.5, 1.5),
                                 TABLE(-0.9, 0.5, 0.72, -1.3, -0.6), BOX("blue", 0.7, 0, -0.7, 1.1, 0.45, -0.3),
                                 BOX("blue", 0.7, 0.45, -0.7, 1.1, 0.95, -0.66)};

static const slab show_room[] = {ROOM("stone", "white", "red", "blue", "white", "white", -3.5, 3.5, 3.2, -3.0, 4.5)};

#undef T

typedef struct untuned_scene {
    const char *name;
    const slab *slabs;
    size_t slab_count;
    bench_scene model; /* .mesh: one more, NULL: none; .camera: how it stands */
    uint32_t frames;   /* of a second, the last of which is looked at */
    double seconds;    /* that the reference may take at most; 0: none is needed */
    bool smoke;        /* among those of a short run */
    const char *text;  /* camera and lights */
} untuned_scene;

#define LAMP_AT(first, watts, more)                                                                                            \
    "lights = ( { type = \"point\"; keys = ( { position = " first "; power = " watts "; }" more " ); } );\n"
#define THEN(position) ", { time = 1.0; position = " position "; }"
#define LOOK(eye, at, fov) "camera: { keys = ( { eye = " eye "; target = " at "; fov = " fov "; } ); };\n"
#define OUTDOORS(sun)                                                                                                          \
    "lights = ( { type = \"directional\"; keys = ( { position = " sun "; target = [0.0, 0.0, 0.0]; irradiance = [90.0, "       \
    "84.0, 70.0]; } ); } );\nbackground = [2.4, 3.4, 5.0];\nsky: { light = true; };\n"
#define DOOR_LOOK LOOK("[3.7, 1.6, 1.7]", "[0.3, 1.1, -0.4]", "65.0")

#define SLABS(s) s, sizeof(s) / sizeof(slab)
#define NO_MODEL                                                                                                               \
    { .mesh = NULL }
#define OWN(file)                                                                                                              \
    { .mesh = file, .own = true, .camera = "" }
#define MODEL(file, stands)                                                                                                    \
    { .mesh = file, .camera = stands }

/* The atrium's lights in its second second, and the Cornell box's: still or, with a further key, not. */
#define ATRIUM(more)                                                                                                           \
    "lights = ( { type = \"point\"; keys = ( { position = [-2.4, 2.8, -2.0]; power = [1100.0, 860.0, 570.0]; }" more           \
    " ); }, { type = \"spot\"; inner = 10.0; outer = 17.0; keys = ( { position = [-8.0, 32.0, 7.0]; target = [0.5, 0.0, "      \
    "-1.0]; power = [13000.0, 20000.0, 38000.0]; } ); }, { type = \"point\"; keys = ( { position = [12.95, 3.3, 0.0]; power "  \
    "= [230.0, 165.0, 95.0]; } ); } );\n"
#define CORNELL(more)                                                                                                          \
    "lights = ( { type = \"spot\"; inner = 20.0; outer = 84.0; keys = ( { position = [-0.4, 1.94, 0.3]; target = [-0.4, 0.0, " \
    "0.3]; power = [130.0, 115.0, 85.0]; }" more " ); } );\n"

static const untuned_scene untuned_scenes[] = {
    {"door5cm", SLABS(door_5cm), NO_MODEL, 1, 240, false, DOOR_LOOK LAMP_AT("[-2.2, 2.2, 0.7]", "[160.0, 150.0, 130.0]", "")},
    {"door20", SLABS(door_20), NO_MODEL, 2, 120, true,
     DOOR_LOOK LAMP_AT("[-2.2, 2.2, 0.7]", "[160.0, 150.0, 130.0]", THEN("[-2.6, 1.8, -0.4]"))},
    {"house", SLABS(house), NO_MODEL, 1, 240, false,
     LOOK("[2.6, 1.6, -2.1]", "[-1.2, 1.0, 1.6]", "70.0") OUTDOORS("[-2.0, 3.0, 4.0]")},
    {"ceiling", SLABS(under_ceiling), NO_MODEL, 1, 60, false, LOOK("[0.3, 1.5, 1.9]", "[0.0, 1.3, 0.0]", "75.0")},
    {"court", SLABS(court), NO_MODEL, 1, 60, false,
     LOOK("[3.6, 1.7, 4.5]", "[-0.6, 1.7, -2.0]", "65.0") OUTDOORS("[3.0, 6.0, 2.0]")},
    {"corridor", SLABS(corridor), NO_MODEL, 1, 120, false,
     LOOK("[-5.6, 1.6, 0.2]", "[0.5, 1.2, -0.1]", "60.0") LAMP_AT("[0.75, 2.2, -5.4]", "[120.0, 115.0, 100.0]", "")},
    {"bulb", SLABS(bulb_room), NO_MODEL, 1, 60, false, LOOK("[1.1, 1.6, 1.4]", "[-0.3, 0.9, -0.6]", "75.0")},
    {"duck", SLABS(show_room), MODEL("gltf/Duck/Duck.gltf", "translate = [0.0, -0.099, 0.0];"), 2, 60, false,
     LOOK("[1.8, 1.7, 3.2]", "[0.0, 0.9, 0.0]", "60.0")
         LAMP_AT("[-1.8, 2.6, 1.6]", "[220.0, 210.0, 190.0]", THEN("[-1.2, 2.7, 1.8]"))},
    {"truck", SLABS(show_room), MODEL("gltf/CesiumMilkTruck/CesiumMilkTruck.gltf", "rotate = [0.0, 30.0, 0.0];"), 1, 60, false,
     LOOK("[2.9, 1.9, 4.1]", "[0.0, 1.1, 0.0]", "65.0") LAMP_AT("[-2.6, 2.9, 2.6]", "[260.0, 250.0, 230.0]", "")},
    {"kitchen", NULL, 0, MODEL("country_kitchen/country_kitchen.gltf", ""), 1, 120, false,
     LOOK("[1.211, 1.805, 3.852]", "[-0.103, 1.680, 1.158]", "45.0") LAMP_AT("[0.5, 2.8, 1.0]", "[200.0, 190.0, 170.0]", "")},
    {"cornell", NULL, 0, OWN("cornell.obj"), 1, 60, false, LOOK("[0.0, 1.0, 3.72]", "[0.0, 1.0, 0.0]", "39.6") CORNELL("")}};
#define UNTUNED_SCENES (sizeof untuned_scenes / sizeof *untuned_scenes)

/* A second of motion: the light's, the camera's there and back, or both. */
#define THERE_AND_BACK(from, to, at, fov)                                                                                      \
    "camera: { keys = ( { time = 0.0; eye = " from "; target = " at "; fov = " fov "; }, { time = 0.5; eye = " to              \
    "; }, { time = 1.0; eye = " from "; } ); };\n"
#define CORNELL_STAYS LOOK("[0.0, 1.0, 3.72]", "[0.0, 1.0, 0.0]", "39.6")
#define CORNELL_MOVES THERE_AND_BACK("[0.0, 1.0, 3.72]", "[0.4, 1.15, 3.4]", "[0.0, 1.0, 0.0]", "39.6")
#define CORNELL_LAMP CORNELL(", { time = 1.0; position = [0.4, 1.94, 0.2]; target = [0.4, 0.0, 0.2]; }")
#define ATRIUM_STAYS LOOK("[-8.8, 1.8, 1.35]", "[2.5, 3.3, -0.8]", "62.0")
#define ATRIUM_MOVES THERE_AND_BACK("[-8.8, 1.8, 1.35]", "[-8.0, 1.9, 1.0]", "[2.5, 3.3, -0.8]", "62.0")
#define ATRIUM_LAMP ATRIUM(THEN("[0.4, 4.2, -0.4]"))

static const untuned_scene untuned_motions[] = {
    {"cornell-light", NULL, 0, OWN("cornell.obj"), 24, 120, false, CORNELL_STAYS CORNELL_LAMP},
    {"cornell-camera", NULL, 0, OWN("cornell.obj"), 24, 0, false, CORNELL_MOVES CORNELL("")},
    {"cornell-both", NULL, 0, OWN("cornell.obj"), 24, 120, true, CORNELL_MOVES CORNELL_LAMP},
    {"atrium-light", NULL, 0, OWN("atrium.obj"), 24, 120, false, ATRIUM_STAYS ATRIUM_LAMP},
    {"atrium-camera", NULL, 0, OWN("atrium.obj"), 24, 0, false, ATRIUM_MOVES ATRIUM("")},
    {"atrium-both", NULL, 0, OWN("atrium.obj"), 24, 120, false, ATRIUM_MOVES ATRIUM_LAMP}};
#define UNTUNED_MOTIONS (sizeof untuned_motions / sizeof *untuned_motions)

/* A file of the bench's own. */
static inline void untuned_path(char path[BENCH_PATH], const char *name, const char *ending) {
    snprintf(path, BENCH_PATH, "%s/" UNTUNED_FOLDER_NAME "/%s%s", bench_results(), name, ending);
}

static inline FILE *untuned_create(const char *name, const char *ending) {
    char path[BENCH_PATH];
    untuned_path(path, name, ending);
    FILE *f = fopen(path, "wb");
    if (!f)
        bench_fail("%s: %s", path, strerror(errno));
    return f;
}

static inline void put_slab(FILE *f, const slab *s) {
    static const int face[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    const double a = s->degrees * 3.14159265358979324 / 180.0;
    fprintf(f, "usemtl %s\n", s->material);
    for (int i = 0; i < 8; i++) {
        const double x = (i & 1 ? s->hi : s->lo)[0] - s->pivot[0], z = (i & 4 ? s->hi : s->lo)[2] - s->pivot[1];
        fprintf(f, "v %.9g %.9g %.9g\n", s->pivot[0] + cos(a) * x + sin(a) * z, (i & 2 ? s->hi : s->lo)[1],
                s->pivot[1] + cos(a) * z - sin(a) * x);
    }
    for (int i = 0; i < 6; i++)
        fprintf(f, "f %d %d %d %d\n", face[i][0] - 8, face[i][1] - 8, face[i][2] - 8, face[i][3] - 8);
}

/* A ball of flat sides that shines. */
static inline void put_bulb(FILE *f, const double at[3]) {
    enum { DOWN = 6, ROUND = 12 };
    const double pi = 3.14159265358979324, radius = 0.03;
    fprintf(f, "usemtl bulb\n");
    for (int i = 0; i <= DOWN; i++)
        for (int j = 0; j < ROUND; j++) {
            const double a = pi * i / DOWN, b = 2.0 * pi * j / ROUND;
            fprintf(f, "v %.9g %.9g %.9g\n", at[0] + radius * sin(a) * cos(b), at[1] + radius * cos(a),
                    at[2] + radius * sin(a) * sin(b));
        }
    for (int i = 0; i < DOWN; i++)
        for (int j = 0; j < ROUND; j++) {
            const int a = (i - DOWN - 1) * ROUND + j, b = j + 1 < ROUND ? a + 1 : a + 1 - ROUND;
            if (i > 0)
                fprintf(f, "f %d %d %d\n", a, b, b + ROUND);
            if (i + 1 < DOWN)
                fprintf(f, "f %d %d %d\n", a, b + ROUND, a + ROUND);
        }
}

static inline void untuned_materials(void) {
    FILE *f = untuned_create("indirect", ".mtl");
    fputs("newmtl white\nKd 0.8 0.8 0.8\nnewmtl grey\nKd 0.5 0.5 0.5\nnewmtl red\nKd 0.6 0.12 0.1\nnewmtl green\nKd 0.15 0.45 "
          "0.1\nnewmtl blue\nKd 0.12 0.2 0.5\nnewmtl wood\nKd 0.45 0.3 0.18\nnewmtl stone\nKd 0.55 0.52 0.47\nnewmtl brick\nKd "
          "0.5 0.22 0.15\nnewmtl lawn\nKd 0.12 0.25 0.06\nnewmtl lamp\nKd 0.5 0.5 0.5\nKe 40 37 32\nnewmtl bulb\nKd 0.5 0.5 "
          "0.5\nKe 2000 1800 1400\n",
          f);
    fclose(f);
}

/* Writes the scene's files; false, with a message, if its model is not at hand. */
static inline bool untuned_write(const untuned_scene *s, const char *size) {
    char mesh[BENCH_PATH] = "", path[BENCH_PATH];
    bench_scene model = s->model;
    model.name = s->name;
    if (model.mesh && !scene_mesh_path(&model, mesh))
        return false;
    bench_folder(bench_results());
    untuned_path(path, "", "");
    bench_folder(path);
    untuned_materials();
    FILE *f = untuned_create(s->name, ".obj");
    fputs("mtllib indirect.mtl\n", f);
    for (size_t i = 0; i < s->slab_count; i++)
        put_slab(f, &s->slabs[i]);
    if (s->slabs == bulb_room)
        put_bulb(f, (const double[]){0.1, 1.9, 0.1});
    fclose(f);
    f = untuned_create(s->name, ".cfg");
    int width, height;
    if (sscanf(size, "%dx%d", &width, &height) != 2)
        bench_fail("no size: %s", size);
    fprintf(f, "name = \"%s\";\noutput: { width = %d; height = %d; fps = %u.0; frames = %u; };\nmeshes = ( ", s->name, width,
            height, s->frames > 1 ? s->frames - 1 : 1, s->frames);
    if (s->slab_count)
        fprintf(f, "{ file = \"%s.obj\"; }%s", s->name, model.mesh ? ", " : "");
    if (model.mesh)
        fprintf(f, "{ file = \"%s\"; %s }", mesh, model.camera);
    fprintf(f, " );\n%s", s->text);
    fclose(f);
    return true;
}

#endif
