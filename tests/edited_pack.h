/* A test pack with constants of its scene, cameras or lights changed in memory: for what no scene of ours asks for. */
#ifndef VIT_TESTS_EDITED_PACK_H
#define VIT_TESTS_EDITED_PACK_H

#include "open_pack.h"
#include "pack_sections.h"

/* cameras: a frame each; lights: a frame's side by side. */
typedef void pack_edit(vit_scene *s, vit_camera *cameras, vit_light *lights);

/* On the device `host`; edit NULL: as it is. */
static inline void pack_open_edited(open_pack *p, const char *name, pack_edit *edit) {
    const vit_open_info how = {.device = VIT_DEVICE_HOST};
    vit_text why = {""};
    size_t size;
    if (!edit) {
        pack_open(p, name, how);
        return;
    }
    void *old = read_file(test_pack(name), &size), *bytes = NULL;
    pack_sections sections = pack_sections_of(old);
    vit_scene s = *(const vit_scene *)sections.data[VIT_SECTION_META];
    const size_t cameras_size = s.frames * sizeof(vit_camera), lights_size = (size_t)s.frames * s.lights * sizeof(vit_light);
    vit_camera *cameras = malloc(cameras_size);
    vit_light *lights = malloc(lights_size + 1);
    assert_true(cameras && lights);
    memcpy(cameras, sections.data[VIT_SECTION_CAMS], cameras_size);
    memcpy(lights, sections.data[VIT_SECTION_LITE], lights_size);
    edit(&s, cameras, lights);
    sections.data[VIT_SECTION_CAMS] = cameras;
    sections.data[VIT_SECTION_META] = &s;
    sections.data[VIT_SECTION_LITE] = lights;
    if (vit_pack_derive(&s, &why) != VIT_OK || pack_assemble(&sections, &bytes, &size, &why) != VIT_OK)
        fail_msg("%s", why.text);
    free(cameras);
    free(lights);
    free(old);
    pack_open_bytes(p, bytes, size, how);
}

#endif
