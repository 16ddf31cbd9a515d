/* effects.c: which of the effects that the scene's materials, lights and settings ask for its path ever meets, and why. The
 * planner asks for all that could be seen; a run over the path records what rays reach (vit_open_info.record_reach), and what
 * is never reached is dropped. No bit of any frame changes by that: only code goes that did nothing. */
#ifndef VIT_BAKE_EFFECTS_H
#define VIT_BAKE_EFFECTS_H

#include "common/effect_names.h"
#include "import/model.h"
#include "vitrine_pack.h"

#define EFFECTS_REACHED_BAKED 4u /* by a photon path that is traced while baking */
/* How and in which frames of the path rays reached something. */
typedef struct effects_reached {
    uint32_t how;         /* VIT_REACHED_*, all frames together, and EFFECTS_REACHED_BAKED */
    uint32_t first, last; /* frames that a view ray reached it in; photons' where none did */
    uint32_t frames;      /* number of these */
} effects_reached;

/* A record per material, then the triangles with interpolated normals and the sky (VIT_REACHED_MORE), then texels of cut-out
 * materials that rays were tested against. */
#define EFFECTS_RECORDS(materials) ((materials) + VIT_REACHED_MORE + 1)

/* Adds a frame: words as vit_reached() gives them, and the tests of cut-out texels. */
void effects_note(effects_reached *reached, uint32_t materials, const uint32_t *words, uint64_t cutout_tests, uint32_t frame);

#define EFFECTS_REASON 320
#define EFFECTS_FORCED_OFF "forced off: " /* before the reason of what is */
/* What was decided of each effect, by its bit. */
typedef struct effects_decided {
    uint64_t forced_on, forced_off; /* by the scene's `effects` */
    uint64_t dropped;               /* asked for, but never reached */
    uint64_t missed;                /* forced off, though frames change by it */
    char reason[64][EFFECTS_REASON];
} effects_decided;

/* Applies the scene's `effects` to what the planner asks for; the fields of META that go with an effect follow (effects_drop).
 */
void effects_force(const scene *s, vit_scene *c, effects_decided *out);
/* The pack's records of each of the model's materials. */
typedef struct effects_looks {
    const vit_material *materials;
    const vit_maps *maps;
} effects_looks;

/* Drops what is never reached, but nothing that was forced on, and writes the reasons. */
void effects_settle(vit_scene *c, const model *m, const effects_looks *looks, const effects_reached *reached,
                    effects_decided *out);

/* Takes effects, those that need them and the counts that go with them out of META; indirect light with what makes it. */
void effects_drop(vit_scene *c, uint64_t effects);

/* What a material calls for where it is met: also CAUSTICS, which needs photons, and AREA_LIGHTS. */
uint64_t effects_of_material(const vit_material *m, const vit_maps *maps);

#endif
