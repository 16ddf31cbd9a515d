/* Small packs that golden tests play, baked by the real baker once and kept until the baker or its kernels are newer. */
#ifndef VIT_TESTS_TEST_PACKS_H
#define VIT_TESTS_TEST_PACKS_H

#include "test_folder.h"
#include "tool_run.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#define TEST_PACKS VIT_BUILD_DIR "/test-packs"
#define TEST_SCENES VIT_BUILD_DIR "/scenes"

/* A room of five sides for cameras and lights of our own: textures, one with holes, a lamp that glows. */
static const char test_packs_room[] =
    "mtllib room.mtl\n"
    "v -1 0 -1\nv 1 0 -1\nv 1 2 -1\nv -1 2 -1\nv -1 0 1\nv 1 0 1\nv 1 2 1\nv -1 2 1\n"
    "v -0.8 0.2 -0.5\nv 0.8 0.2 -0.5\nv 0.8 1.8 -0.5\nv -0.8 1.8 -0.5\n"
    "v -0.3 1.99 -0.3\nv 0.3 1.99 -0.3\nv 0.3 1.99 0.3\nv -0.3 1.99 0.3\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "usemtl floor\nf 1/1 5/2 6/3 2/4\n"
    "usemtl wall\nf 1/1 2/2 3/3 4/4\nf 1/1 4/2 8/3 5/4\nf 2/1 6/2 7/3 3/4\nf 4/1 3/2 7/3 8/4\n"
    "usemtl leaves\nf 9/1 10/2 11/3 12/4\n"
    "usemtl lamp\nf 13/1 14/2 15/3 16/4\n";
static const char test_packs_materials[] = "newmtl floor\nKd 0.8 0.7 0.6\nmap_Kd ../scenes/wood.png\n"
                                           "newmtl wall\nKd 0.7 0.7 0.7\n"
                                           "newmtl leaves\nKd 0.9 0.9 0.9\nmap_Kd holes.tga\nmap_d holes.tga\n"
                                           "newmtl lamp\nKd 0.5 0.5 0.5\nKe 3 3 2\n";

/* Two octahedra with normals of a sphere. */
#define BODY(x)                                                                                                                \
    "v " x ".4 0.3 0.6\nv " x ".0 0.3 0.6\nv " x ".2 0.6 0.6\nv " x ".2 0.02 0.6\nv " x ".2 0.3 0.9\nv " x ".2 0.3 0.3\n"
#define FACES(name, a, b, c, d, e, f)                                                                                          \
    "usemtl " name "\nf " a "//1 " c "//3 " e "//5\nf " c "//3 " b "//2 " e "//5\nf " b "//2 " d "//4 " e "//5\nf " d "//4 " a \
    "//1 " e "//5\nf " c "//3 " a "//1 " f "//6\nf " b "//2 " c "//3 " f "//6\nf " d "//4 " b "//2 " f "//6\nf " a "//1 " d    \
    "//4 " f "//6\n"
static const char test_packs_bodies[] =
    "mtllib bodies.mtl\n" BODY("0") "v -0.1 0.3 0.6\nv -0.5 0.3 0.6\nv -0.3 0.6 0.6\nv -0.3 0.02 0.6\n"
                                    "v -0.3 0.3 0.9\nv -0.3 0.3 0.3\n"
                                    "vn 1 0 0\nvn -1 0 0\nvn 0 1 0\nvn 0 -1 0\nvn 0 0 1\nvn 0 0 -1\n" FACES(
                                        "glass", "1", "2", "3", "4", "5", "6") FACES("chrome", "7", "8", "9", "10", "11", "12");
static const char test_packs_bodies_materials[] = "newmtl glass\nKd 0.5 0.5 0.5\nnewmtl chrome\nKd 0.5 0.5 0.5\n";

/* All that a scene can call for. `walls`: more of the material of the walls. */
#define SPECULAR_SCENE(walls)                                                                                                  \
    "meshes = ( { file = \"room.obj\"; }, { file = \"bodies.obj\"; } );\nambient = [0.02, 0.03, 0.04];\n"                      \
    "ambient_radius = 0.5;\nbackground = [0.2, 0.3, 0.4];\nsky: { light = true; };\n"                                          \
    "materials = ( { name = \"lamp\"; area_light = true; },"                                                                   \
    " { name = \"floor\"; specular = [0.2, 0.2, 0.2]; exponent = 30.0; }, " walls "{ name = \"chrome\"; kind = \"mirror\";"    \
    " specular = [0.9, 0.8, 0.7]; }, { name = \"glass\"; kind = \"glass\"; ior = 1.5; absorption = [0.5, 0.2, 0.1]; } );\n"    \
    "output: { width = 96; height = 64; frames = 2; };\n"                                                                      \
    "camera: { keys = ( { eye = [0.0, 1.0, 3.0]; target = [0.0, 1.0, 0.0]; fov = 42.0; } ); };\n"                              \
    "lights = (" ROOM_STILL ", " ROOM_MOVING ", { type = \"directional\"; keys = ( { position = [0.3, 3.0, 2.0];"              \
    " target = [0.0, 0.0, 0.0]; irradiance = [1.0, 1.0, 0.8]; } ); });\n"                                                      \
    "quality: { indirect = \"photons\"; photons = 2000; radius = 0.4; tile = 16; indirect_samples = 4; antialias = 2; "        \
    "light_samples = 4; sky_samples = 4; cache_error = 0.2; };\n"

/* 8 x 8 texels of blue, green, red and alpha behind a TGA header: squares of 4 x 4 are opaque or holes in turn. */
enum { HOLES_EDGE = 8, HOLES_HEADER = 18, HOLES_BYTES = HOLES_HEADER + 4 * HOLES_EDGE * HOLES_EDGE };
static inline void test_packs_holes(unsigned char out[HOLES_BYTES]) {
    static const unsigned char header[HOLES_HEADER] = {[2] = 2, [12] = HOLES_EDGE, [14] = HOLES_EDGE, [16] = 32, [17] = 8};
    memcpy(out, header, sizeof header);
    for (int i = 0; i < HOLES_EDGE * HOLES_EDGE; i++) {
        const unsigned char texel[4] = {40, (unsigned char)(120 + i), 90, (i / 4 + i / 32) % 2 ? 255 : 0};
        memcpy(out + HOLES_HEADER + 4 * i, texel, sizeof texel);
    }
}

#define ROOM_VIEW(lights)                                                                                                      \
    "materials = ( { name = \"lamp\"; area_light = false; } );\n"                                                              \
    "output: { width = 96; height = 64; frames = 2; };\n"                                                                      \
    "camera: { keys = ( { eye = [0.0, 1.0, 3.0]; target = [0.0, 1.0, 0.0]; fov = 42.0; } ); };\n"                              \
    "lights = (" lights ");\n"                                                                                                 \
    "quality: { indirect = \"photons\"; photons = 2000; radius = 0.4; tile = 16; };\n"
#define ROOM_STILL "{ type = \"point\"; range = 9.0; keys = ( { position = [0.4, 1.7, 0.5]; power = [40.0, 50.0, 60.0]; } ); }"
#define ROOM_MOVING                                                                                                            \
    "{ type = \"spot\"; inner = 30.0; outer = 60.0;"                                                                           \
    " keys = ( { position = [-0.5, 1.9, 0.3]; target = [0.0, 0.0, 0.0]; power = [60.0, 50.0, 40.0]; },"                        \
    " { time = 0.1; position = [0.5, 1.9, 0.3]; } ); }"

/* Files that packs are baked from, beside our demo scenes. */
static const struct {
    const char *name, *text;
} test_packs_files[] = {
    {"room.obj", test_packs_room},
    {"room.mtl", test_packs_materials},
    {"room.cfg", "meshes = ( { file = \"room.obj\"; } );\n" ROOM_VIEW(ROOM_STILL ", " ROOM_MOVING)},
    {"still.cfg", "meshes = ( { file = \"room.obj\"; } );\n" ROOM_VIEW(ROOM_STILL)},
    {"bodies.obj", test_packs_bodies},
    {"bodies.mtl", test_packs_bodies_materials},
    {"shine.cfg", SPECULAR_SCENE("")},
    /* Phong's lobe on the floor, microfacets and a normal map on the walls, microfacets on leaves with holes */
    {"gloss.cfg",
     SPECULAR_SCENE("{ name = \"wall\"; specular = [0.5, 0.4, 0.3]; roughness = 0.4; normal_map = \"holes.tga\"; }, "
                    "{ name = \"leaves\"; specular = [0.1, 0.1, 0.1]; roughness = 0.0; }, ")},
    {"open.cfg", "meshes = ( { file = \"room.obj\"; } );\nambient = [0.5, 0.6, 0.7]; ambient_radius = 0.8;\n"
                 "background = [0.2, 0.3, 0.4]; sky: { light = true; };\n"
                 "materials = ( { name = \"lamp\"; area_light = true; } );\noutput: { width = 48; height = 33; frames = 4; };\n"
                 "camera: { keys = ( { eye = [0.0, 1.0, 3.0]; target = [0.0, 1.0, 0.0]; fov = 42.0; },"
                 " { time = 0.2; eye = [0.3, 1.2, 2.5]; target = [0.0, 1.0, 0.0]; } ); };\n"
                 "quality: { indirect = \"photons\"; photons = 0; tile = 8; cache_error = 0.1; };\n"},
    {"lamp.cfg", "meshes = ( { file = \"room.obj\"; } );\n" ROOM_VIEW("")},
};

/* The packs: what is baked, and with which options. */
static const struct {
    const char *name, *input, *options;
} test_packs[] = {
#define PLAIN "--indirect photons --zones 0 --effective-area 0 --bounce-sequence 0 --indirect-samples 1 "
#define CORNELL TEST_SCENES "/cornell.cfg", "--size 160x120 --frames 3 --photons 5000 " PLAIN
    {"list", CORNELL "--all-formats"},
    {"buckets", CORNELL "--all-formats --estimate buckets"},
    {"raw", CORNELL "--estimate buckets --smoothing raw"},
    {"flattened", CORNELL "--kernel flattened"},
    {"normal-keys", CORNELL "--normal-keys 1 --tile 8"},
    {"sparse", CORNELL "--all-formats --indirect-samples 4"},
    {"sparse-16", CORNELL "--normal-keys 1 --tile 8 --indirect-samples 16"},
    {"small", CORNELL "--all-formats --sample-bits 16"},
    {"small-sparse", CORNELL "--sample-bits 16 --indirect-samples 4"},
    {"zones-areas", CORNELL "--zones 1 --effective-area 1"},
    {"sparse-zones-areas", CORNELL "--zones 1 --effective-area 1 --indirect-samples 4"},
    {"dark", CORNELL "--photons 0"},
#undef CORNELL
#define ODD TEST_SCENES "/cornell.cfg", "--photons 5000 --frames 2 --all-formats " PLAIN
    {"1x1", ODD "--size 1x1"},
    {"17x1", ODD "--size 17x1"},
    {"33x47", ODD "--size 33x47"},
    {"sparse-17x1", ODD "--size 17x1 --indirect-samples 16"},
#undef ODD
    {"room", TEST_PACKS "/room.cfg", PLAIN},
    {"room-buckets", TEST_PACKS "/room.cfg", PLAIN "--estimate buckets"},
    {"sparse-room", TEST_PACKS "/room.cfg", PLAIN "--indirect-samples 16"},
    {"sparse-buckets", TEST_PACKS "/room.cfg", PLAIN "--estimate buckets --indirect-samples 4"},
    {"nearest", TEST_PACKS "/room.cfg", PLAIN "--texture-filter nearest"},
    {"trilinear", TEST_PACKS "/room.cfg", PLAIN "--texture-filter trilinear"},
#define BAKED "--zones 2 --effective-area 1 --bounce-sequence 1 --indirect-samples 1 "
    {"zones", TEST_PACKS "/room.cfg", BAKED},
    {"zones-buckets", TEST_PACKS "/room.cfg", BAKED "--estimate buckets --normal-keys 1"},
    {"zones-sparse", TEST_PACKS "/room.cfg", BAKED "--indirect-samples 16"},
    {"zones-sparse-buckets", TEST_PACKS "/room.cfg", BAKED "--indirect-samples 4 --estimate buckets"},
    {"zones-alone", TEST_PACKS "/room.cfg", "--zones 1 --effective-area 0 --bounce-sequence 0 --indirect-samples 1"},
    {"areas-alone", TEST_PACKS "/room.cfg", "--zones 0 --effective-area 1 --bounce-sequence 0 --indirect-samples 1"},
    {"areas-buckets", TEST_PACKS "/room.cfg",
     "--zones 0 --effective-area 1 --bounce-sequence 0 --indirect-samples 4 --estimate buckets"},
    {"sequence", TEST_PACKS "/room.cfg", "--zones 0 --effective-area 0 --bounce-sequence 1 --indirect-samples 1"},
#undef BAKED
    {"still", TEST_PACKS "/still.cfg", PLAIN},
#define BASIS "--indirect basis --receiver-rays 64 --receiver-spacing 24 "
    {"basis", TEST_PACKS "/room.cfg", PLAIN BASIS "--all-formats"},
    {"basis-still", TEST_PACKS "/still.cfg", PLAIN BASIS},
    {"basis-16", TEST_PACKS "/room.cfg", PLAIN BASIS "--indirect-samples 16 --tile 8"},
    {"basis-33x47", TEST_SCENES "/cornell.cfg", PLAIN BASIS "--size 33x47 --frames 3 --sample-bits 16"},
    {"basis-shine", TEST_PACKS "/gloss.cfg", BASIS "--all-formats"},
#define POINTS "--basis-receivers points --point-spacing 10 "
    {"points", TEST_PACKS "/room.cfg", PLAIN BASIS POINTS "--all-formats"},
    {"points-still", TEST_PACKS "/still.cfg", PLAIN BASIS POINTS},
    {"points-shine", TEST_PACKS "/shine.cfg", BASIS POINTS},
#undef POINTS
#undef BASIS
#define LIVE "--indirect radiosity --receiver-rays 64 --receiver-spacing 24 --patches 200 "
    {"live", TEST_PACKS "/room.cfg", PLAIN LIVE "--all-formats"},
    {"live-once", TEST_PACKS "/room.cfg", PLAIN LIVE "--bounces 2"},
    {"live-still", TEST_PACKS "/still.cfg", PLAIN LIVE},
    {"live-33x47", TEST_SCENES "/cornell.cfg", PLAIN LIVE "--size 33x47 --frames 3 --codec bc1"},
    {"live-shine", TEST_PACKS "/shine.cfg", LIVE "--all-formats --codec log8"},
#undef LIVE
#undef PLAIN
    {"shine", TEST_PACKS "/shine.cfg", "--all-formats"},
    {"progressive", TEST_PACKS "/open.cfg", "--cache progressive --lightmap baked"},
    {"lamp", TEST_PACKS "/lamp.cfg", ""},
    {"mesh", TEST_PACKS "/room.obj", "--indirect photons --size 96x64 --frames 2 --photons 2000"},
    {"by-default", TEST_PACKS "/room.obj", "--size 97x63 --frames 2"}, /* nothing stated */
    {"atrium", TEST_SCENES "/atrium.cfg", "--indirect photons --size 256x144 --frames 2 --indirect-samples 1"},
    {"whole-tiles", TEST_SCENES "/cornell.cfg",
     "--indirect photons --size 160x128 --frames 4 --photons 5000 --indirect-samples 1"},
};
enum { TEST_PACK_COUNT = sizeof test_packs / sizeof test_packs[0] };

/* Writes a scene's file where it is missing or of another size: its time says when it last changed. */
static inline void test_packs_put(const char *name, const void *bytes, size_t size) {
    char path[256];
    struct stat there;
    (void)snprintf(path, sizeof path, TEST_PACKS "/%s", name);
    if (stat(path, &there) != 0 || (size_t)there.st_size != size)
        put_bytes(path, bytes, size);
}

static inline int test_packs_later(const struct stat *a, const struct stat *b) {
    return a->st_mtim.tv_sec != b->st_mtim.tv_sec ? a->st_mtim.tv_sec > b->st_mtim.tv_sec
                                                  : a->st_mtim.tv_nsec > b->st_mtim.tv_nsec;
}

/* Tests run side by side: only one at a time makes what belongs to `name`. Returns what ends it with close(). */
static inline int test_packs_lock(const char *name) {
    char path[256];
    folder_make(TEST_PACKS);
    (void)snprintf(path, sizeof path, TEST_PACKS "/%s.lock", name);
    const int file = open(path, O_RDWR | O_CREAT, 0666);
    assert_true(file >= 0);
    struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    assert_int_equal(fcntl(file, F_SETLKW, &whole), 0);
    return file;
}

/* Makes the folder and the scene files in it. */
static inline void test_packs_begin(void) {
    const int lock = test_packs_lock("files");
    for (size_t i = 0; i < sizeof test_packs_files / sizeof test_packs_files[0]; i++)
        test_packs_put(test_packs_files[i].name, test_packs_files[i].text, strlen(test_packs_files[i].text));
    unsigned char holes[HOLES_BYTES];
    test_packs_holes(holes);
    test_packs_put("holes.tga", holes, sizeof holes);
    (void)close(lock);
}

static inline size_t test_packs_find(const char *name) {
    for (size_t i = 0; i < TEST_PACK_COUNT; i++)
        if (strcmp(test_packs[i].name, name) == 0)
            return i;
    fail_msg("there is no test pack '%s'", name);
    return 0;
}

/* The pack's path; baked if it is missing or older than the baker or a file that it is made from. By the device `host`, which
 * compiles nothing: OpenCL's is then held to its hashes. */
static inline const char *test_pack(const char *name) {
    static char path[256];
    struct stat pack;
    const size_t i = test_packs_find(name);
    test_packs_begin();
    (void)snprintf(path, sizeof path, TEST_PACKS "/%s.vit", name);
    const char *const from[] = {TOOL_BAKE, test_packs[i].input, TEST_PACKS "/room.obj", TEST_PACKS "/room.mtl",
                                TEST_PACKS "/holes.tga"};
    const int lock = test_packs_lock(name);
    int fresh = stat(path, &pack) == 0;
    for (size_t k = 0; k < sizeof from / sizeof from[0]; k++) {
        struct stat s;
        assert_int_equal(stat(from[k], &s), 0);
        fresh = fresh && test_packs_later(&pack, &s);
    }
    static tool_run r;
    if (!fresh) {
        tool(&r, TOOL_BAKE " %s -o %s --quiet --no-check --device host %s", test_packs[i].input, path, test_packs[i].options);
        tool_succeeds(&r);
    }
    (void)close(lock);
    return path;
}

#endif
