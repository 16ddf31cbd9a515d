/* Unit and up axis of files that Assimp reads. Its releases differ in what they apply themselves (FBX's axes from 5.3 on, but
 * not FBX's unit, nor AMF's), so that what the file says is found here, and what a release has applied is known or taken back.
 */
#include "import/assimp/assimp_scene.h"
#include <assimp/metadata.h>
#include <string.h>

/* What the file says, and what of it stands in Assimp's tree. */
typedef struct ai_frame {
    model_frame stated;
    bool applied;    /* Assimp has turned and scaled by it */
    bool has_axes;   /* FBX: `axes` turn the file instead of stated.up */
    double axes[12]; /* 3 x 4 */
} ai_frame;

static const struct aiMetadataEntry *entry(const assimp_scene *a, const char *key) {
    const struct aiMetadata *all = a->ai->mMetaData;
    for (unsigned i = 0; all && i < all->mNumProperties; i++)
        if (!strcmp(all->mKeys[i].data, key))
            return &all->mValues[i];
    return NULL;
}

/* The suffix goes first: the name that Assimp notes may come from the file. */
const char *assimp_reader(const assimp_scene *a) {
    static const char *const by_suffix[][2] = {{".fbx", "Autodesk FBX"},
                                               {".dae", "Collada"},
                                               {".amf", "Additive manufacturing"},
                                               {".3ds", "Discreet 3DS"},
                                               {".ase", "ASE"},
                                               {".ask", "ASE"},
                                               {".dxf", "Drawing Interchange"},
                                               {".x3d", "Extensible 3D"},
                                               {".x3db", "Extensible 3D"},
                                               {".gltf", "glTF"},
                                               {".glb", "glTF"}};
    for (size_t i = 0; i < sizeof by_suffix / sizeof *by_suffix; i++)
        if (import_has_suffix(a->im->file, by_suffix[i][0]))
            return by_suffix[i][1];
    const struct aiMetadataEntry *e = entry(a, "SourceAsset_Format");
    return e && e->mType == AI_AISTRING ? ((const struct aiString *)e->mData)->data : "";
}

/* Whole numbers and others are not told apart by all releases. */
static double number(const assimp_scene *a, const char *key, double usual) {
    const struct aiMetadataEntry *e = entry(a, key);
    if (!e || !e->mData)
        return usual;
    return e->mType == AI_INT32    ? (double)*(const int32_t *)e->mData
           : e->mType == AI_FLOAT  ? (double)*(const float *)e->mData
           : e->mType == AI_DOUBLE ? *(const double *)e->mData
                                   : usual;
}

/* ---- formats ---- */

/* Rows of the axes that are right, up and to the front, each a different one. */
static bool fbx_axes(const assimp_scene *a, double axes[12], uint32_t *up) {
    static const char *const keys[3] = {"CoordAxis", "UpAxis", "FrontAxis"};
    static const char *const signs[3] = {"CoordAxisSign", "UpAxisSign", "FrontAxisSign"};
    unsigned used = 0;
    memset(axes, 0, 12 * sizeof *axes);
    for (int row = 0; row < 3; row++) {
        const double axis = number(a, keys[row], row), sign = number(a, signs[row], 1.0);
        if (!(axis == 0.0 || axis == 1.0 || axis == 2.0) || !(sign == 1.0 || sign == -1.0) || (used >> (int)axis & 1u))
            return false;
        used |= 1u << (int)axis;
        axes[4 * row + (int)axis] = sign;
        if (row == 1)
            *up = (uint32_t)axis;
    }
    return true;
}

/* The root node of FBX is the file's own space: what a release has put there is what is found here. Units are centimetres. */
static bool fbx_frame(assimp_scene *a, ai_frame *out) {
    const double factor = number(a, "UnitScaleFactor", 1.0);
    ((struct aiScene *)(uintptr_t)a->ai)->mRootNode->mTransformation =
        (struct aiMatrix4x4){.a1 = 1.0f, .b2 = 1.0f, .c3 = 1.0f, .d4 = 1.0f};
    out->stated = (model_frame){0.01, FRAME_Y, FRAME_BY_FILE, FRAME_BY_FILE};
    out->has_axes = fbx_axes(a, out->axes, &out->stated.up);
    if (factor >= 1e-6 && factor <= 1e8)
        out->stated.unit = 0.01 * factor;
    else if (!import_not_done(a->im, "a UnitScaleFactor of %g is none: 1 unit is taken as 1 cm", factor))
        return false;
    return out->has_axes || import_not_done(a->im, "its three axes are not three: y is taken as up");
}

/* All releases scale by <unit>, then turn by <up_axis>, in the root node, which has no place of its own. */
static bool collada_frame(assimp_scene *a, ai_frame *out) {
    const struct aiMatrix4x4 *m = &a->ai->mRootNode->mTransformation;
    const float unit = m->c3 > 0.0f ? m->c3 : m->a1; /* the axis that keeps its place: z, or x */
    out->stated = (model_frame){(double)unit,
                                m->b1 > 0.0f    ? FRAME_X
                                : m->b3 != 0.0f ? FRAME_Z
                                                : FRAME_Y,
                                FRAME_BY_FILE, FRAME_BY_FILE};
    out->applied = true;
    if (a->bad_unit || !(unit > 0.0f))
        return import_fail(a->im, "has a <unit> that is no positive number of metres");
    return !a->bad_axis || import_not_done(a->im, "its <up_axis> is none: y is taken as up");
}

/* Unit and axis that all files of a format have. */
static const struct {
    const char *reader; /* Assimp's name begins so */
    model_frame stated;
    bool applied;
} known[] = {
    {"Discreet 3DS", {1.0, FRAME_Z, FRAME_BY_NOBODY, FRAME_BY_FORMAT}, true},
    {"ASE", {1.0, FRAME_Z, FRAME_BY_NOBODY, FRAME_BY_FORMAT}, true},
    {"Drawing Interchange", {1.0, FRAME_Z, FRAME_BY_NOBODY, FRAME_BY_FORMAT}, true},
    {"Extensible 3D", {1.0, FRAME_Y, FRAME_BY_FORMAT, FRAME_BY_FORMAT}, false},
    {"glTF", {1.0, FRAME_Y, FRAME_BY_FORMAT, FRAME_BY_FORMAT}, false},
};

static bool begins(const char *text, const char *with) {
    return strncmp(text, with, strlen(with)) == 0;
}

static bool find_frame(assimp_scene *a, ai_frame *out) {
    const char *reader = assimp_reader(a);
    bool stated = false;
    *out = (ai_frame){.stated = {1.0, FRAME_Y, FRAME_BY_NOBODY, FRAME_BY_NOBODY}};
    if (begins(reader, "Autodesk FBX"))
        return fbx_frame(a, out);
    if (begins(reader, "Collada"))
        return collada_frame(a, out);
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (begins(reader, known[i].reader)) {
            out->stated = known[i].stated;
            out->applied = known[i].applied;
        }
    if (begins(reader, "Extensible 3D") && a->bad_unit)
        return import_fail(a->im, "has a <unit> of lengths that is no positive number of metres");
    if (begins(reader, "Extensible 3D") && a->unit > 0.0) {
        out->stated.unit = a->unit;
        out->stated.unit_by = FRAME_BY_FILE;
    }
    if (!begins(reader, "Additive manufacturing"))
        return true;
    if (a->amf_turns)
        return import_fail(a->im, "its constellation turns instances (<rx>, <ry>, <rz>), which the mesh reader takes for ways: "
                                  "save it as one object, or as 3MF, glTF or OBJ");
    if (!assimp_unit_amf(a, &out->stated.unit, &stated))
        return false;
    out->stated.unit_by = stated ? FRAME_BY_FILE : FRAME_BY_FORMAT;
    return true;
}

/* out = own^-1 of a turn times a scale. */
static void take_back(const model_frame *frame, double out[12]) {
    double own[12];
    import_frame_matrix(frame, own);
    for (int row = 0; row < 3; row++) {
        for (int k = 0; k < 3; k++)
            out[4 * row + k] = own[4 * k + row] / (frame->unit * frame->unit);
        out[4 * row + 3] = 0.0;
    }
}

bool assimp_frame(assimp_scene *a, const scene_mesh *mesh, double place[12]) {
    ai_frame f;
    double own[12], back[12], both[12];
    if (!find_frame(a, &f))
        return false;
    import_frame(a->im, mesh, &f.stated);
    const model_frame *taken = &a->im->frame;
    const bool asked = taken->unit_by == FRAME_BY_SCENE || taken->up_by == FRAME_BY_SCENE;
    memcpy(place, mesh->transform, 12 * sizeof *place);
    if (f.applied && !asked)
        return true;
    import_frame_matrix(taken, own);
    if (f.has_axes && taken->up_by != FRAME_BY_SCENE)
        for (int i = 0; i < 12; i++)
            own[i] = taken->unit * f.axes[i];
    memcpy(both, own, sizeof both);
    if (f.applied) {
        take_back(&f.stated, back);
        import_multiply(own, back, both);
    }
    import_multiply(mesh->transform, both, place);
    return true;
}
