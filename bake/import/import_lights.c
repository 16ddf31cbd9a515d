#include "import/importer.h"
#include "common/pi.h"
#include "import/light_units.h"
#include "common/strict_math.h"
#include <assimp/camera.h>
#include <assimp/cimport.h>
#include <assimp/light.h>
#include <assimp/metadata.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void transform_point(const double m[12], const struct aiVector3D *p, double out[3]) {
    for (int i = 0; i < 3; i++)
        out[i] = m[4 * i] * (double)p->x + m[4 * i + 1] * (double)p->y + m[4 * i + 2] * (double)p->z + m[4 * i + 3];
}

/* False: the direction has no length, or is not finite. */
static bool transform_direction(const double m[12], const struct aiVector3D *d, double out[3]) {
    for (int i = 0; i < 3; i++)
        out[i] = m[4 * i] * (double)d->x + m[4 * i + 1] * (double)d->y + m[4 * i + 2] * (double)d->z;
    const double length = sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
    for (int i = 0; i < 3; i++)
        out[i] /= length;
    return length > 0.0 && isfinite(out[0]) && isfinite(out[1]) && isfinite(out[2]);
}

static bool finite_point(const double p[3]) {
    return isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]);
}

static void take_names(const struct aiNode *node, char name[SCENE_NAME], char parent[SCENE_NAME]) {
    (void)snprintf(name, SCENE_NAME, "%.*s", SCENE_NAME - 1, node->mName.data);
    (void)snprintf(parent, SCENE_NAME, "%.*s", SCENE_NAME - 1, node->mParent ? node->mParent->mName.data : "");
}

/* Releases of Assimp differ in what they make of glTF's vertical angle: angle * aspect, or the true horizontal angle. So a
 * camera of known angle (1 radian, aspect 2) is sent through. */
static bool multiplies_by_aspect(void) {
    static const char probe[] = "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
                                "\"nodes\":[{\"name\":\"probe\",\"camera\":0}],\"cameras\":[{\"type\":\"perspective\","
                                "\"perspective\":{\"yfov\":1.0,\"aspectRatio\":2.0,\"znear\":0.1,\"zfar\":10.0}}]}";
    const struct aiScene *ai = aiImportFileFromMemory(probe, sizeof probe - 1, 0, "gltf");
    const bool multiplies = !ai || ai->mNumCameras != 1 || fabs((double)ai->mCameras[0]->mHorizontalFOV - 2.0) < 1e-3;
    if (ai)
        aiReleaseImport(ai);
    return multiplies;
}

/* Vertical angle in degrees; 0 if the file states none, or nothing that a camera could have. */
static double vertical_fov(const importer *im, const struct aiCamera *c) {
    const double across = (double)c->mHorizontalFOV, aspect = (double)c->mAspect;
    double up = across;
    if (aspect > 0.0)
        up = im->gltf && multiplies_by_aspect() ? across / aspect : 2.0 * strict_atan(strict_tan(0.5 * across) / aspect);
    const double degrees = up * 180.0 / PI;
    return degrees > 1.0 && degrees < 170.0 ? degrees : 0.0;
}

bool import_node_camera(importer *im, const struct aiNode *node, const double world[12]) {
    static const struct aiVector3D origin = {0.0f, 0.0f, 0.0f};
    model *m = im->m;
    for (unsigned i = 0; i < im->ai->mNumCameras; i++) {
        const struct aiCamera *c = im->ai->mCameras[i];
        model_camera camera = {.fov = vertical_fov(im, c)};
        double forward[3];
        if (strcmp(c->mName.data, node->mName.data) != 0)
            continue;
        /* A glTF camera sits at its node's origin; some releases of Assimp repeat the node's translation in mPosition. */
        transform_point(world, im->gltf ? &origin : &c->mPosition, camera.eye);
        if (!finite_point(camera.eye) || !transform_direction(world, &c->mLookAt, forward) ||
            !transform_direction(world, &c->mUp, camera.up)) {
            import_warn(im, "camera '%.100s' has no direction; it is left out", c->mName.data);
            continue;
        }
        if (c->mOrthographicWidth > 0.0f)
            import_warn(im, "camera '%.100s' is orthographic, which ours are not: its view is a perspective of 60 degrees",
                        c->mName.data);
        for (int k = 0; k < 3; k++)
            camera.target[k] = camera.eye[k] + forward[k];
        take_names(node, camera.name, camera.parent);
        size_t room = (size_t)m->camera_count;
        if (!import_room(im, &m->cameras, &room, room + 1, sizeof camera))
            return false;
        m->cameras[m->camera_count++] = camera;
    }
    return true;
}

/* Assimp keeps KHR_lights_punctual's range beside the node. */
static double light_range(const struct aiNode *node) {
    const struct aiMetadata *data = node->mMetaData;
    for (unsigned i = 0; data && i < data->mNumProperties; i++) {
        const struct aiMetadataEntry *entry = &data->mValues[i];
        if (strcmp(data->mKeys[i].data, "PBR_LightRange") != 0)
            continue;
        float single = 0.0f;
        double range = 0.0;
        if (entry->mType == AI_FLOAT) {
            memcpy(&single, entry->mData, sizeof single);
            range = (double)single;
        } else if (entry->mType == AI_DOUBLE) {
            memcpy(&range, entry->mData, sizeof range);
        }
        return isfinite(range) && range > 0.0 ? range : 0.0;
    }
    return 0.0;
}

/* What half the cone's angle is of the number that Assimp gives: it hands on what the file says, and formats differ. In these
 * angles are from the axis; FBX, COLLADA (as its exporters write it), 3DS, ASE and Blender say the whole cone's. */
static double cone_part(const importer *im) {
    static const char *const from_axis[] = {".x3d", ".x3dv", ".wrl", ".lws"};
    bool half = im->gltf;
    for (size_t i = 0; i < sizeof from_axis / sizeof from_axis[0]; i++)
        half = half || import_has_suffix(im->file, from_axis[i]);
    return half ? 1.0 : 0.5;
}

/* Degrees from the axis. What is wrong with the cone, or NULL. */
static const char *read_cone(const importer *im, const struct aiLight *l, model_light *out) {
    const double part = cone_part(im) * 180.0 / PI;
    out->inner = (double)l->mAngleInnerCone * part;
    out->outer = (double)l->mAngleOuterCone * part;
    /* COLLADA has one angle and an exponent; Assimp makes up an outer angle, often beyond a half turn. */
    if (import_has_suffix(im->file, ".dae"))
        out->outer = out->inner;
    if (!(out->inner >= 0.0) || !(out->outer > 0.0 && out->outer <= (im->gltf ? 90.001 : 180.001)))
        return "has a cone that is none";
    if (out->inner > out->outer)
        return "has a cone whose inner angle is more than its outer";
    out->outer = fmin(out->outer, 90.0);
    out->inner = fmin(out->inner, out->outer);
    return NULL;
}

/* What keeps the light from being one of ours, or NULL. */
static const char *make_light(const importer *im, const struct aiNode *node, const double world[12], const struct aiLight *l,
                              model_light *out) {
    static const struct aiVector3D origin = {0.0f, 0.0f, 0.0f};
    const float color[3] = {l->mColorDiffuse.r, l->mColorDiffuse.g, l->mColorDiffuse.b};
    const bool directional = l->mType == aiLightSource_DIRECTIONAL, spot = l->mType == aiLightSource_SPOT;
    if (!directional && !spot && l->mType != aiLightSource_POINT)
        return "is no point, spot or directional light";
    *out = (model_light){.kind = directional ? VIT_LIGHT_DIRECTIONAL
                                 : spot      ? VIT_LIGHT_SPOT
                                             : VIT_LIGHT_POINT,
                         .direction = {0.0, -1.0, 0.0},
                         .states_unit = im->gltf};
    out->range = directional ? 0.0 : light_range(node);
    transform_point(world, im->gltf ? &origin : &l->mPosition, out->position); /* as with cameras */
    if (!finite_point(out->position))
        return "stands at no finite place";
    if ((directional || spot) && !transform_direction(world, &l->mDirection, out->direction))
        return "has no direction";
    const char *fault = spot ? read_cone(im, l, out) : NULL;
    if (fault)
        return fault;
    for (int i = 0; i < 3; i++) {
        out->stated[i] = (double)color[i];
        out->power[i] = (directional ? 1.0 : 4.0 * PI) * out->stated[i] * light_units_of_light(im->s, im->gltf);
        if (!isfinite(out->power[i]))
            return "has an intensity that is not finite";
        if (out->power[i] < 0.0)
            return "has a negative intensity";
    }
    return NULL;
}

bool import_node_light(importer *im, const struct aiNode *node, const double world[12]) {
    model *m = im->m;
    for (unsigned i = 0; i < im->ai->mNumLights; i++) {
        const struct aiLight *l = im->ai->mLights[i];
        model_light light;
        if (strcmp(l->mName.data, node->mName.data) != 0)
            continue;
        const char *fault = make_light(im, node, world, l, &light);
        if (fault) {
            import_warn(im, "light '%.100s' %s; it is left out", l->mName.data, fault);
            continue;
        }
        take_names(node, light.name, light.parent);
        size_t room = (size_t)m->light_count;
        if (!import_room(im, &m->lights, &room, room + 1, sizeof light))
            return false;
        m->lights[m->light_count++] = light;
    }
    return true;
}

const model_camera *model_camera_named(const model *m, const char *name) {
    for (int i = 0; i < m->camera_count; i++)
        if (!strcmp(m->cameras[i].name, name))
            return &m->cameras[i];
    for (int i = 0; i < m->camera_count; i++)
        if (!strcmp(m->cameras[i].parent, name))
            return &m->cameras[i];
    return NULL;
}

const model_light *model_light_named(const model *m, const char *name) {
    for (int i = 0; i < m->light_count; i++)
        if (!strcmp(m->lights[i].name, name))
            return &m->lights[i];
    for (int i = 0; i < m->light_count; i++)
        if (!strcmp(m->lights[i].parent, name))
            return &m->lights[i];
    return NULL;
}
