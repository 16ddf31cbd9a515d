/* Cameras and lights of Assimp's tree: they hang on the node of their name. */
#include "import/assimp/assimp_scene.h"
#include "common/pi.h"
#include "common/strict_math.h"
#include <assimp/camera.h>
#include <assimp/light.h>
#include <assimp/version.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static void take(const struct aiVector3D *v, double out[3]) {
    out[0] = (double)v->x;
    out[1] = (double)v->y;
    out[2] = (double)v->z;
}

static void take_names(const struct aiNode *node, char name[SCENE_NAME], char parent[SCENE_NAME]) {
    (void)snprintf(name, SCENE_NAME, "%.*s", SCENE_NAME - 1, node->mName.data);
    (void)snprintf(parent, SCENE_NAME, "%.*s", SCENE_NAME - 1, node->mParent ? node->mParent->mName.data : "");
}

/* Vertical angle in degrees; 0 if the file states none, or nothing that a camera could have. */
static double vertical_fov(const assimp_scene *a, const struct aiCamera *c, bool *orthographic) {
    const bool fbx = strncmp(assimp_reader(a), "Autodesk FBX", 12) == 0;
    *orthographic = c->mOrthographicWidth > 0.0f;
    if (strcmp(assimp_reader(a), "Collada") == 0)
        return assimp_collada_fov(a->im, c->mName.data, orthographic);
    double across = (double)c->mHorizontalFOV;
    /* Of FBX it is the whole angle up to 5.2, half of it from 5.3 on, and 1 degree where the file states none. */
    if (fbx && (aiGetVersionMajor() > 5 || aiGetVersionMinor() > 2))
        across *= 2.0;
    const double aspect = (double)c->mAspect;
    const double up = aspect > 0.0 ? 2.0 * strict_atan(strict_tan(0.5 * across) / aspect) : across;
    const double degrees = up * 180.0 / PI;
    return !(fbx && across < 1.001 * PI / 180.0) && degrees < 170.0 ? degrees : 0.0;
}

bool assimp_cameras(assimp_scene *a, const struct aiNode *node, const double world[12]) {
    for (unsigned i = 0; i < a->ai->mNumCameras; i++) {
        const struct aiCamera *c = a->ai->mCameras[i];
        model_camera camera = {.fov = 0.0};
        double place[3], look[3], up[3], forward[3];
        bool orthographic;
        if (strcmp(c->mName.data, node->mName.data) != 0)
            continue;
        camera.fov = vertical_fov(a, c, &orthographic);
        take(&c->mPosition, place);
        take(&c->mLookAt, look);
        take(&c->mUp, up);
        import_transform_point(world, place, camera.eye);
        import_transform_vector(world, look, forward);
        import_transform_vector(world, up, camera.up);
        take_names(node, camera.name, camera.parent);
        if (!import_add_camera(a->im, &camera, forward, orthographic))
            return false;
    }
    return true;
}

/* Degrees from the axis. What half the cone's angle is of the number that Assimp gives: it hands on what the file says, and
 * formats differ. In these angles are from the axis; FBX, COLLADA (as its exporters write it), 3DS, ASE and Blender say the
 * whole cone's. */
static bool read_cone(importer *im, const struct aiLight *l, model_light *out) {
    static const char *const from_axis[] = {".x3d", ".x3dv", ".wrl", ".lws"};
    double part = 0.5 * 180.0 / PI;
    for (size_t i = 0; i < sizeof from_axis / sizeof from_axis[0]; i++)
        if (import_has_suffix(im->file, from_axis[i]))
            part = 180.0 / PI;
    out->inner = (double)l->mAngleInnerCone * part;
    out->outer = (double)l->mAngleOuterCone * part;
    /* COLLADA has one angle and an exponent, from which Assimp makes up an outer angle, often beyond a half turn; without an
     * exponent it is acos(0.1) wider. */
    const bool collada = import_has_suffix(im->file, ".dae");
    const bool soft = collada && !(fabs((double)l->mAngleOuterCone - (double)l->mAngleInnerCone - 1.4706289) < 1e-3);
    if (collada)
        out->outer = out->inner;
    if (soft && !import_not_done(im, "light '%.100s': its falloff inside the cone is left out: the cone has a hard edge",
                                 l->mName.data))
        return false;
    if (!(out->outer > 90.0))
        return true;
    const double whole = 2.0 * out->outer;
    out->outer = 90.0;
    out->inner = fmin(out->inner, out->outer);
    return whole < 180.001 || import_not_done(im, "light '%.100s': a cone of %.6g degrees is cut to 180", l->mName.data, whole);
}

/* Assimp calls a light of X3D that has no name by where it lies in memory: "PointLight_94612587020304". */
static void drop_address(const assimp_scene *a, char name[SCENE_NAME]) {
    char *digits = strstr(name, "Light_");
    if (digits && strcmp(assimp_reader(a), "Extensible 3D") == 0 && strspn(digits + 6, "0123456789") == strlen(digits + 6))
        digits[5] = '\0';
}

static bool add_light(assimp_scene *a, const struct aiNode *node, const double world[12], const struct aiLight *l) {
    importer *im = a->im;
    const double color[3] = {(double)l->mColorDiffuse.r, (double)l->mColorDiffuse.g, (double)l->mColorDiffuse.b};
    const bool directional = l->mType == aiLightSource_DIRECTIONAL, spot = l->mType == aiLightSource_SPOT;
    double place[3], along[3];
    if (!directional && !spot && l->mType != aiLightSource_POINT)
        return import_not_done(im, "light '%.100s' is no point, spot or directional light; it is left out", l->mName.data);
    model_light out = {.kind = directional ? VIT_LIGHT_DIRECTIONAL
                               : spot      ? VIT_LIGHT_SPOT
                                           : VIT_LIGHT_POINT,
                       .direction = {0.0, -1.0, 0.0}};
    take_names(node, out.name, out.parent);
    drop_address(a, out.name);
    take(&l->mPosition, place);
    take(&l->mDirection, along);
    memcpy(out.stated, color, sizeof color);
    import_transform_point(world, place, out.position);
    if (directional || spot)
        import_transform_vector(world, along, out.direction);
    if (spot && !read_cone(im, l, &out))
        return false;
    return import_add_light(im, &out, 180.001);
}

bool assimp_lights(assimp_scene *a, const struct aiNode *node, const double world[12]) {
    for (unsigned i = 0; i < a->ai->mNumLights; i++)
        if (strcmp(a->ai->mLights[i]->mName.data, node->mName.data) == 0 && !add_light(a, node, world, a->ai->mLights[i]))
            return false;
    return true;
}
