/* Scene files of a test: read, or refused with a line that says where and why. A program defines FOLDER, where they are,
 * before it includes this. */
#ifndef VIT_TESTS_SCENE_FILE_LAB_H
#define VIT_TESTS_SCENE_FILE_LAB_H

#include "scene/scene.h"
#include "test_folder.h"
#include "vitrine_pack.h"
#include <math.h>

#define NAME FOLDER "/test.cfg"
#define MESH "meshes = ( { file = \"a.obj\"; } );\n"
#define CAMERA "camera: { keys = ( { eye = (0, 1, 3); target = (0, 1, 0); } ); };\n"
#define GOOD MESH CAMERA
#define KEYS "keys = ( { position = (0, 1, 0); power = (1, 1, 1); } ); "
#define SPOT "keys = ( { position = (0, 1, 0); target = (0, 0, 0); power = (1, 1, 1); } ); "

static inline void read_good(const char *text, scene *s) {
    vit_text why = {{0}};
    put(NAME, text);
    const vit_status status = scene_read(NAME, s, &why);
    if (status != VIT_OK)
        print_error("%s\n", why.text);
    assert_int_equal(status, VIT_OK);
}

/* `text` is refused with one line that begins "file:line: " (or "file: " for line 0) and holds `what`. */
static inline void refuse(const char *text, int line, const char *what) {
    scene s;
    vit_text why = {{0}};
    char head[1200];
    put(NAME, text);
    assert_int_equal(scene_read(NAME, &s, &why), VIT_BAD_INPUT);
    (void)snprintf(head, sizeof head, line ? NAME ":%d: " : NAME ": ", line);
    if (strncmp(why.text, head, strlen(head)) != 0 || !strstr(why.text, what))
        print_error("expected '%s... %s'\ngot      '%s'\n", head, what, why.text);
    assert_int_equal(strncmp(why.text, head, strlen(head)), 0);
    assert_non_null(strstr(why.text, what));
    assert_null(strchr(why.text, '\n'));
}

#define T(name) cmocka_unit_test(name)

#endif
