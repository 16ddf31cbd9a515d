/* scene.c: the scene file (libconfig) as plain data. Grammar: bake/README.md. */
#ifndef VIT_BAKE_SCENE_H
#define VIT_BAKE_SCENE_H

#include "common/inputs.h"
#include "scene/settings.h"
#include "scene/text_sizes.h"
#include "vitrine.h"
#include <stdbool.h>

typedef struct scene_mesh {
    char file[SCENE_PATH]; /* resolved against the scene file's folder */
    double transform[12];  /* 3 x 4, row-major: translate * rotate (x, then y, then z; degrees) * scale */
    double unit;           /* metres that 1 of the file is; 0: as the file says */
    int up;                /* SCENE_UP_*: which axis of the file is up */
    int line;              /* in the scene file, for errors */
} scene_mesh;

enum { SCENE_UP_AUTO, SCENE_UP_X, SCENE_UP_Y, SCENE_UP_Z };
#define SCENE_UPS "auto|x|y|z" /* in this order; auto: as the file says */

/* A camera or light keyframe; fields that the file leaves out repeat the key before. */
typedef struct scene_camera_key {
    double time; /* seconds */
    double eye[3], target[3], up[3];
    double fov;      /* vertical, degrees */
    double exposure; /* factor on radiance */
} scene_camera_key;

typedef struct scene_light_key {
    double time;
    double position[3];
    double target[3]; /* spot and directional lights look at it */
    double power[3];  /* W a channel, radiated into the whole sphere (a spot light's cone cuts a part out of it); of a
                       * directional  light irradiance across it, W/m2 */
} scene_light_key;

#define SCENE_LIGHT_KINDS "point|spot|directional" /* VIT_LIGHT_* in this order */

typedef struct scene_light {
    int kind;              /* VIT_LIGHT_* */
    double inner, outer;   /* degrees from the axis, spot lights */
    double range;          /* metres; 0: none */
    bool window;           /* VIT_FALLOFF_WINDOW */
    bool photons;          /* gives indirect light; default true */
    char use[SCENE_NAME];  /* name of a glTF light that gives kind, position, direction, power; "" if none */
    scene_light_key *keys; /* at least one unless `use`; times strictly increasing */
    int key_count;
    int line;
} scene_light;

/* Unit of the lights and the emission of mesh files (light_units.h). */
enum { LIGHT_UNITS_AUTO, LIGHT_UNITS_PHOTOMETRIC, LIGHT_UNITS_RADIOMETRIC };
#define SCENE_LIGHT_UNITS "auto|photometric|radiometric" /* in this order */

#define SCENE_MATERIAL_KINDS "matt|mirror|glass|thin_glass" /* VIT_MATTE and so on, in this order */

/* Overrides of the material called `name`; has_* say which. */
typedef struct scene_material {
    char name[SCENE_NAME];
    bool has_color, has_texture, has_emission, has_cutoff, has_kind, has_specular, has_exponent, has_roughness, has_ior,
        has_absorption, has_area_light, has_normal_map;
    double color[3], emission[3], cutoff;
    int kind;                                         /* VIT_MATTE, ... */
    double specular[3], exponent, ior, absorption[3]; /* as vit_material */
    double roughness;                                 /* root of vit_material.alpha */
    bool area_light;                                  /* what it emits lights others */
    char texture[SCENE_PATH];                         /* resolved; "" removes the texture */
    char normal_map[SCENE_PATH];                      /* likewise */
    int line;
} scene_material;

/* What is round the scene, besides its background. */
typedef struct scene_sky {
    char image[SCENE_PATH]; /* equirectangular, resolved; "": the background is the sky */
    double scale;           /* factor on the image's values, which are W/(m2 sr) then */
    double rotate;          /* degrees about y */
    bool light;             /* the sky lights the scene */
    int line;               /* in the scene file, for errors */
} scene_sky;

/* What `effects` of a scene file says. */
enum { EFFECTS_AUTO, EFFECTS_ALL, EFFECTS_LISTED };
#define SCENE_EFFECTS "auto|all" /* in this order */

typedef struct scene {
    char path[SCENE_PATH]; /* the scene file; or the mesh, if there was no scene file */
    char name[SCENE_NAME];
    int width, height, frames;
    double fps;
    double background[3];  /* W/(m2 sr) */
    double ambient[3];     /* radiance of white matt surfaces in no other light, W/(m2 sr) */
    double ambient_radius; /* m: surfaces nearer than that keep ambient light from each other; 0: it reaches everywhere */
    int light_units;       /* LIGHT_UNITS_* */
    scene_sky sky;
    scene_mesh *meshes;
    int mesh_count;
    char camera_use[SCENE_NAME]; /* name of a glTF camera that gives eye, target, up, fov; "" if none */
    double near;                 /* metres, nearest depth slice; 0: auto */
    double camera_exposure;      /* factor on radiance of the camera named by camera_use; the keys have their own */
    bool exposure_auto;          /* exposure_factor is to be found (exposure.h) */
    double exposure_fixed;       /* of all frames, instead of what the camera says; 0: none */
    double exposure_factor;      /* on the exposures of all frames; 0: 1 */
    scene_camera_key *camera;    /* at least one unless camera_use or `automatic` */
    int camera_count;
    scene_light *lights;
    int light_count;
    scene_material *materials;
    int material_count;
    scene_quality quality;
    bool quality_auto;     /* the baker chooses what is not stated (auto.h) */
    uint64_t quality_kept; /* SETTING_BIT()s: what is stated */
    int effects_choice;    /* EFFECTS_* */
    uint64_t effects;      /* EFFECTS_LISTED: VIT_BIT() of those named */
    inputs files;          /* the scene file, what it includes, and the files that it names */
    bool check;            /* the baker compares its picture with path tracing */
    bool automatic;        /* no scene file: camera and light are made from the model's box (tracks.c) */
} scene;

/* Reads `path`. VIT_BAD_INPUT: why->text is "file:line: what". On failure nothing is left to free. */
vit_status scene_read(const char *path, scene *out, vit_text *why);
/* A scene for a bare mesh: default output, quality, automatic camera and light. */
vit_status scene_for_mesh(const char *path, scene *out, vit_text *why);
void scene_free(scene *s);

#define SCENE_QUALITY 1536 /* bytes that a quality block takes as text */
/* Puts settings as a quality block holds them, "photons = 4000; radius = \"auto\";", over *q. VIT_BAD_INPUT, and *q is as it
 * was. */
vit_status scene_quality_apply(const char *text, scene_quality *q, vit_text *why);
/* All settings of *q in that form, in one line: applied to any block it gives *q again. */
void scene_quality_text(const scene_quality *q, char *text, size_t room);
/* Those that quality "auto" chooses and that are not the defaults. */
void scene_quality_difference(const scene_quality *q, char *text, size_t room);

#endif
