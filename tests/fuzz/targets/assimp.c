/* What is done to the text of COLLADA, X3D, OFF and AMF files before Assimp sees it, on any bytes; Assimp itself is left
 * out. */
#include "fuzz.h"
#include "import/assimp/assimp_scene.h"

#include <stdlib.h>
#include <string.h>

static void warned(void *user, const char *line) {
    (void)user;
    fuzz_one_line(line, 4096);
}

/* All of the text, as Assimp would read it. */
static void read_all(assimp_scene *a, const char *path) {
    struct aiFileIO io = assimp_files(a);
    struct aiFile *file = io.OpenProc(&io, path, "rb");
    FUZZ_HOLDS(file != NULL);
    const size_t size = file->FileSizeProc(file);
    char *text = malloc(size + 1);
    FUZZ_HOLDS(text != NULL && file->ReadProc(file, text, 1, size + 1) == size);
    free(text);
    io.CloseProc(&io, file);
}

void fuzz_assimp(const uint8_t *data, size_t size) {
    static const char *const names[] = {"mesh.x3d", "mesh.dae", "mesh.off", "mesh.amf", NULL};
    fuzz_files f = {.names = names};
    vit_text why = {""};
    model m;
    memset(&m, 0, sizeof m);
    importer im = {.m = &m, .warn = warned, .why = &why};
    assimp_scene a = {.im = &im};
    bool orthographic = false;
    fuzz_write_files(&f, data, size);
    im.file = f.main;
    read_all(&a, f.main);
    FUZZ_HOLDS(assimp_say_lost(&a));
    FUZZ_HOLDS(memchr(a.amf_unit, 0, sizeof a.amf_unit) != NULL);
    if (strstr(f.main, ".dae")) {
        const double fov = assimp_collada_fov(&im, "Camera", &orthographic);
        FUZZ_HOLDS(fov >= 0.0 && fov < 180.0);
    }
    model_free(&m);
}
