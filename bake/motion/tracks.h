/* tracks.c: keyframes to one camera and one set of lights a frame. */
#ifndef VIT_BAKE_TRACKS_H
#define VIT_BAKE_TRACKS_H

#include "import/model.h"
#include "vitrine_pack.h"

typedef struct tracks {
    vit_camera *cameras; /* frames */
    vit_light *lights;   /* frames * light_count; path_first and path_count are the planner's */
    uint32_t light_count;
    bool *still;         /* a light: every frame's record is the same */
    double near;         /* metres: the scene's, or 1/1000 of the diagonal of the model's box but at most 0.1 m */
    double tan_half_fov; /* the path's largest, vertical */
} tracks;

/* Evaluates the path at times frame / fps. Positions, targets, power, fov and exposure follow monotone (Fritsch-Carlson)
 * cubics through the keys a component, constant before the first and after the last. Resolves `use` names against the model.
 * Directional lights get the disc round the model that their photons leave (vit_light).
 * A scene that is `automatic` gets a camera that turns once round the model's box, seeing all of it, and one moving light. */
vit_status tracks_evaluate(const scene *s, const model *m, tracks *out, vit_text *why);
void tracks_free(tracks *t);

#endif
