#include "import/import_frame.h"
#include "import/importer.h"
#include <stdio.h>
#include <string.h>

void import_frame(importer *im, const scene_mesh *mesh, const model_frame *stated) {
    im->frame = *stated;
    if (mesh->unit > 0.0) {
        im->frame.unit = mesh->unit;
        im->frame.unit_by = FRAME_BY_SCENE;
    }
    if (mesh->up != SCENE_UP_AUTO) {
        im->frame.up = (uint32_t)(mesh->up - SCENE_UP_X);
        im->frame.up_by = FRAME_BY_SCENE;
    }
}

/* Turns by 90 degrees, those of COLLADA's <up_axis> (1.4.1, 5-12): x up stays right-handed with z to the viewer, z up with x to
 * the right. */
void import_frame_matrix(const model_frame *frame, double out[12]) {
    static const double turns[3][9] = {[FRAME_X] = {0, -1, 0, 1, 0, 0, 0, 0, 1},
                                       [FRAME_Y] = {1, 0, 0, 0, 1, 0, 0, 0, 1},
                                       [FRAME_Z] = {1, 0, 0, 0, 0, 1, 0, -1, 0}};
    for (int row = 0; row < 3; row++) {
        for (int k = 0; k < 3; k++)
            out[4 * row + k] = frame->unit * turns[frame->up][3 * row + k] + 0.0; /* + 0.0 turns -0 into 0 */
        out[4 * row + 3] = 0.0;
    }
}

/* ---- in words ---- */

const char *frame_text(const model_frame *f, char text[FRAME_TEXT]) {
    static const char *const by[] = {[FRAME_BY_NOBODY] = "nothing says otherwise",
                                     [FRAME_BY_FORMAT] = "its format has it so",
                                     [FRAME_BY_FILE] = "the file says so",
                                     [FRAME_BY_SCENE] = "the scene file says so"};
    const char axis = "xyz"[f->up];
    if (f->unit_by == f->up_by)
        (void)snprintf(text, FRAME_TEXT, "1 unit is %.7g m and %c is up: %s", f->unit, axis, by[f->up_by]);
    else
        (void)snprintf(text, FRAME_TEXT, "1 unit is %.7g m: %s; %c is up: %s", f->unit, by[f->unit_by], axis, by[f->up_by]);
    return text;
}

static bool is_ours(const model_frame *f) {
    return f->unit == 1.0 && f->up == FRAME_Y;
}

void frames_say(const scene *s, const model *m, progress *p) {
    char text[FRAME_TEXT];
    int unknown = 0, first = 0;
    for (int i = 0; i < m->format_count; i++) {
        const model_frame *f = &m->formats[i].frame;
        if (!is_ours(f))
            progress_line(p, false, "%.300s: %s", s->meshes[i].file, frame_text(f, text));
        else if (f->unit_by == FRAME_BY_NOBODY && unknown++ == 0)
            first = i;
    }
    if (unknown > 0)
        progress_line(p, false,
                      "%d mesh file%s of formats without a unit (%.300s%s): 1 is 1 m, y is up; 'units' and 'up' of a mesh in a "
                      "scene file say otherwise",
                      unknown, unknown > 1 ? "s" : "", s->meshes[first].file, unknown > 1 ? " is the first" : "");
}
