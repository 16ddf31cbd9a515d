/* Import and bake on any bytes: a mesh file with its materials and images, through all steps that need no device. What is
 * accepted must make a pack that the loader takes. Dark sides and zones take a second whatever the mesh: one input of 64 goes
 * through them, and every seed in make test (fuzz_mesh_whole). */
#include "fuzz.h"
#include "geometry/glass_inset.h"
#include "pack_read.h"
#include "light/photons.h"
#include "pack/planner.h"
#include "zones/zones.h"

#include "pack/pack_write.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool fuzz_mesh_whole;

enum { WIDTH = 16, HEIGHT = 12, PHOTONS = 32, BOUNCES = 3, TRIANGLES = 500, TEXELS = 1 << 16 }; /* more is imported only */

typedef struct bake {
    bool whole;
    scene s;
    model m;
    tracks t;
    bvh b;
    geometry g;
    dark_sides r;
    atlas a;
    plan p;
    vit_light_sample *area_lights;
    vit_photon *photons;
    cells c;
    vit_gold gold;
} bake;

static void warned(void *user, const char *line) {
    (void)user;
    fuzz_one_line(line, 4096);
}

/* Steps in the order of pipeline.c. One frame, so that the light is still and its photons are baked. */
static vit_status make_shape(bake *k, vit_text *why) {
    vit_status status = tracks_evaluate(&k->s, &k->m, &k->t, why);
    if (status == VIT_OK && !glass_inset(&k->m, geometry_ray_offset(&k->m)))
        status = VIT_FAILED;
    if (status == VIT_OK)
        status = bvh_build(&k->m, 1, &k->b, why);
    if (status == VIT_OK)
        status = geometry_pack(&k->m, &k->b, &k->g, why);
    for (uint32_t i = 0; status == VIT_OK && i < 2 * k->m.triangles; i++)
        k->r.area += (double)side_area(&k->g, i); /* for the radius */
    if (status == VIT_OK && k->whole)
        status = dark_sides_find(&(const dark_sides_input){.model = &k->m, .tracks = &k->t, .frames = 1, .threads = 1}, &k->g,
                                 &k->r, why);
    if (status == VIT_OK)
        status = atlas_pack(&k->m, &k->a, why);
    const plan_input in = {.scene = &k->s,
                           .model = &k->m,
                           .tracks = &k->t,
                           .atlas = &k->a,
                           .bvh = &k->b,
                           .geometry = &k->g,
                           .dark_sides = &k->r,
                           .sky = &(const environment){0},
                           .threads = 1};
    return status == VIT_OK ? plan_make(&in, &k->p, why) : status;
}

static vit_status make_photons(bake *k, vit_text *why) {
    vit_scene *s = &k->p.scene;
    photons_light lights[2];
    uint32_t count = 0;
    if (k->p.baked_paths[0] > 0)
        lights[count++] = (photons_light){.light = k->t.lights[0], .paths = k->p.baked_paths[0]};
    if (k->p.area_paths > 0)
        lights[count++] = (photons_light){.paths = k->p.area_paths, .area = &k->p.area};
    const photons_input in = {.triangles = k->g.triangles,
                              .attributes = k->g.attributes,
                              .triangle_count = k->m.triangles,
                              .materials = k->p.materials,
                              .atlas = &k->a,
                              .ray_offset = k->g.ray_offset,
                              .box_pad = s->box_pad,
                              .radius = s->radius,
                              .effects = s->effects,
                              .bounces = s->bounces,
                              .cells = k->c.count ? &k->c : NULL,
                              .lights = lights,
                              .light_count = count};
    free(k->photons);
    vit_status status = photons_bake(&in, 1, &k->photons, &s->baked, why);
    if (status == VIT_OK && in.cells)
        zones_assign(&k->c, k->photons, s->baked);
    return status;
}

static vit_status make_zones(bake *k, vit_text *why) {
    static const bool gives[1] = {true};
    const zones_input in = {.geometry = &k->g,
                            .triangles = k->m.triangles,
                            .materials = k->p.materials,
                            .atlas = &k->a,
                            .tracks = &k->t,
                            .gives_photons = gives,
                            .scene = &k->p.scene,
                            .zones = true,
                            .areas = true,
                            .threads = 1};
    zones_found found;
    vit_status status = zones_bake(&in, &k->c, &found, why);
    k->p.scene.cells = k->c.count;
    return status == VIT_OK ? make_photons(k, why) : status;
}

/* Points on area lights. */
static void make_area_lights(bake *k) {
    const uint32_t samples = k->p.scene.area_samples;
    k->area_lights = malloc(((size_t)samples + 1) * VIT_PATTERNS * sizeof *k->area_lights);
    FUZZ_HOLDS(k->area_lights);
    vit_text why;
    FUZZ_HOLDS(samples == 0 || area_lights_sets(&k->p.area, samples, k->area_lights, &why) == VIT_OK);
}

/* bounds.c would measure these on a device. */
static void set_bounds(vit_scene *s) {
    s->slice_count = 16;
    s->max_nodes = 64;
    s->max_list = 64;
}

static void check_pack(bake *k) {
    const pack_sections sections = {.data = {[VIT_SECTION_META] = &k->p.scene,
                                             [VIT_SECTION_CAMS] = k->t.cameras,
                                             [VIT_SECTION_LITE] = k->t.lights,
                                             [VIT_SECTION_GEOM] = k->g.triangles,
                                             [VIT_SECTION_ATTR] = k->g.attributes,
                                             [VIT_SECTION_BVHN] = k->b.nodes,
                                             [VIT_SECTION_MATL] = k->p.materials,
                                             [VIT_SECTION_MAPS] = k->p.maps,
                                             [VIT_SECTION_TEXR] = k->a.textures,
                                             [VIT_SECTION_MIPS] = k->a.mips,
                                             [VIT_SECTION_ATLS] = k->a.texels,
                                             [VIT_SECTION_SIDE] = k->c.sides,
                                             [VIT_SECTION_CELL] = k->c.cells,
                                             [VIT_SECTION_EMIT] = k->area_lights,
                                             [VIT_SECTION_PHOT] = k->photons,
                                             [VIT_SECTION_GOLD] = &k->gold}};
    vit_text why = {""};
    void *bytes;
    size_t size;
    vit_pack pack;
    set_bounds(&k->p.scene);
    FUZZ_HOLDS(vit_pack_derive(&k->p.scene, &why) == VIT_OK && pack_assemble(&sections, &bytes, &size, &why) == VIT_OK);
    const bool taken = vit_pack_read(bytes, size, &pack, &why) == VIT_OK;
    if (!taken)
        (void)fprintf(stderr, "%s\n", why.text);
    FUZZ_HOLDS(taken);
    free(bytes);
}

static void bake_free(bake *k) {
    free(k->area_lights);
    free(k->photons);
    cells_free(&k->c);
    plan_free(&k->p);
    atlas_free(&k->a);
    geometry_free(&k->g);
    bvh_free(&k->b);
    tracks_free(&k->t);
}

static void bake_model(bake *k) {
    vit_text why = {""};
    k->s.width = WIDTH;
    k->s.height = HEIGHT;
    k->s.frames = 1;
    k->s.quality.indirect = INDIRECT_PHOTONS;
    k->s.quality.photons = PHOTONS;
    k->s.quality.bounces = BOUNCES;
    k->s.quality.zones = k->s.quality.effective_area = k->whole;
    vit_status status = make_shape(k, &why);
    if (status == VIT_OK && (k->p.scene.effects & VIT_BIT(PHOTONS)))
        status = make_photons(k, &why);
    if (status == VIT_OK && k->whole && (k->p.scene.effects & VIT_BIT(PHOTONS)))
        status = make_zones(k, &why);
    if (status == VIT_OK) {
        make_area_lights(k);
        check_pack(k);
    } else
        fuzz_one_line(why.text, sizeof why.text);
    bake_free(k);
}

static size_t texels_of(const model *m) {
    size_t texels = 0;
    for (int i = 0; i < m->image_count; i++)
        texels += (size_t)m->images[i].width * (size_t)m->images[i].height;
    return texels;
}

void fuzz_mesh(const uint8_t *data, size_t size) {
    static const char *const names[] = {"mesh.obj", "mesh.ply", "mesh.gltf", "mesh.glb",   "mesh.mtl",
                                        "mesh.bin", "a.tga",    "a.png",     "mesh.other", NULL};
    fuzz_files f = {.names = names};
    vit_text why = {""};
    bake k;
    memset(&k, 0, sizeof k);
    k.whole = fuzz_mesh_whole || vit_hash(data, size) % 64 == 0;
    fuzz_write_files(&f, data, size);
    FUZZ_HOLDS(scene_for_mesh(f.main, &k.s, &why) == VIT_OK);
    /* Files that end the reader are the child's; our own code is looked at here, where sanitizers see it. */
    vit_status status = model_import(&k.s, false, warned, NULL, &k.m, &why);
    if (status == VIT_OK) {
        model_free(&k.m);
        status = model_import_here(&k.s, false, warned, NULL, &k.m, &why);
        FUZZ_HOLDS(status == VIT_OK);
    }
    if (status != VIT_OK)
        fuzz_one_line(why.text, sizeof why.text);
    else if (k.m.triangles <= TRIANGLES && texels_of(&k.m) <= TEXELS)
        bake_model(&k);
    model_free(&k.m);
    scene_free(&k.s);
}
