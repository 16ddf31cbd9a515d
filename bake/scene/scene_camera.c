#include "scene/scene_reader.h"
#include <math.h>
#include <string.h>

typedef struct camera_head {
    char use[SCENE_NAME];
    double near, exposure;
} camera_head;

enum { CAMERA_USE };
static const config_field camera_fields[] = {
    [CAMERA_USE] = {"use", FIELD_TEXT, offsetof(camera_head, use), NULL},
    {"near", FIELD_NUMBER, offsetof(camera_head, near), "(0, 1e6]"},
    {"exposure", FIELD_AUTO, offsetof(camera_head, exposure), "(0, 1e9]"},
    {"keys", FIELD_OTHER, 0, NULL},
};

enum { CAMERA_EYE, CAMERA_TARGET };
static const config_field camera_key_fields[] = {
    [CAMERA_EYE] = {"eye", FIELD_VECTOR, offsetof(scene_camera_key, eye), COORDINATE},
    [CAMERA_TARGET] = {"target", FIELD_VECTOR, offsetof(scene_camera_key, target), COORDINATE},
    {"time", FIELD_NUMBER, offsetof(scene_camera_key, time), TIME},
    {"up", FIELD_VECTOR, offsetof(scene_camera_key, up), COORDINATE},
    {"fov", FIELD_NUMBER, offsetof(scene_camera_key, fov), "(1, 170)"},
    {"exposure", FIELD_NUMBER, offsetof(scene_camera_key, exposure), "(0, 1e9]"},
};

static bool same_point(const double a[3], const double b[3]) {
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* Sine of the angle between `up` and the view axis; 0 also if `up` is zero. */
static double lean(const scene_camera_key *k) {
    double d[3], n[3];
    for (int i = 0; i < 3; i++)
        d[i] = k->target[i] - k->eye[i];
    for (int i = 0; i < 3; i++)
        n[i] = d[(i + 1) % 3] * k->up[(i + 2) % 3] - d[(i + 2) % 3] * k->up[(i + 1) % 3];
    const double lengths =
        sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) * sqrt(k->up[0] * k->up[0] + k->up[1] * k->up[1] + k->up[2] * k->up[2]);
    return lengths > 0.0 ? sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / lengths : 0.0;
}

static bool read_camera_key(reader *r, config_setting_t *list, int i) {
    scene *s = r->s;
    config_setting_t *group;
    uint64_t seen;
    scene_camera_key *key = &s->camera[i];
    reader_at(r, "camera key", i);
    *key = i ? s->camera[i - 1] : (scene_camera_key){.up = {0.0, 1.0, 0.0}, .fov = 60.0, .exposure = s->camera_exposure};
    if (!fields_group(&r->at, list, i, &group) ||
        !fields_read(&r->at, group, camera_key_fields, FIELD_COUNT(camera_key_fields), key, &seen))
        return false;
    if (i == 0 && (~seen & (FIELD_BIT(CAMERA_EYE) | FIELD_BIT(CAMERA_TARGET))))
        return fields_fail(&r->at, group, "the first key needs 'eye' and 'target'");
    if (i > 0 && key->time <= key[-1].time)
        return fields_fail(&r->at, group, "'time' must be after the key before (%g s), got %g", key[-1].time, key->time);
    if (same_point(key->eye, key->target))
        return fields_fail(&r->at, group, "'eye' and 'target' are the same point");
    if (lean(key) < 1e-4)
        return fields_fail(&r->at, group, "'up' is zero or parallel to the view");
    s->camera_count = i + 1;
    return true;
}

bool reader_camera(reader *r, const config_setting_t *root) {
    scene *s = r->s;
    const config_setting_t *group = config_setting_get_member(root, "camera");
    camera_head head = {.exposure = 1.0};
    config_setting_t *list;
    uint64_t seen;
    r->at.what[0] = '\0';
    if (!group)
        return fields_fail(&r->at, root, "there is no 'camera'");
    reader_at(r, "camera", -1);
    if (!fields_read(&r->at, group, camera_fields, FIELD_COUNT(camera_fields), &head, &seen) ||
        !fields_list(&r->at, group, "keys", MAX_KEYS, &list))
        return false;
    const int count = list ? config_setting_length(list) : 0;
    if ((count > 0) == (head.use[0] != '\0'))
        return fields_fail(&r->at, group, "needs either 'keys' or 'use'");
    memcpy(s->camera_use, head.use, sizeof s->camera_use);
    s->near = head.near;
    s->exposure_auto = !(head.exposure > 0.0);
    s->camera_exposure = s->exposure_auto ? 1.0 : head.exposure;
    if (!reader_allocate(r, &s->camera, count, sizeof *s->camera))
        return false;
    for (int i = 0; i < count; i++)
        if (!read_camera_key(r, list, i))
            return false;
    return true;
}
