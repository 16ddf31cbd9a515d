#include "geometry/recentre.h"
#include <math.h>

bool scene_is_far(const model *m, double origin[3]) {
    double half = 0.0, far = 0.0, center[3];
    for (int k = 0; k < 3; k++) {
        const double edge = m->hi[k] - m->lo[k];
        center[k] = m->lo[k] + 0.5 * edge;
        half += 0.25 * edge * edge;
        far += center[k] * center[k];
    }
    half = sqrt(half);
    int exponent;
    const double step = frexp(half, &exponent) == 0.5 ? half : ldexp(1.0, exponent);
    for (int k = 0; k < 3; k++)
        origin[k] = floor(center[k] / step + 0.5) * step;
    return sqrt(far) > SCENE_FAR * half;
}

static void take(double p[3], const double origin[3]) {
    for (int k = 0; k < 3; k++)
        p[k] -= origin[k];
}

void scene_move(scene *s, const double origin[3]) {
    for (int i = 0; i < s->mesh_count; i++)
        for (int k = 0; k < 3; k++)
            s->meshes[i].transform[4 * k + 3] -= origin[k];
    for (int i = 0; i < s->camera_count; i++) {
        take(s->camera[i].eye, origin);
        take(s->camera[i].target, origin);
    }
    for (int i = 0; i < s->light_count; i++)
        for (int k = 0; k < s->lights[i].key_count; k++) {
            take(s->lights[i].keys[k].position, origin);
            take(s->lights[i].keys[k].target, origin);
        }
}
