/* pipeline_load, once a scene: import -> tracks -> area lights' planes -> glass inset -> BVH -> geometry -> dark sides -> atlas
 * -> sky. pipeline_pack, once a setting: tracks -> shape (its own where the setting asks for fewer bits) -> plan -> photon
 * guiding -> area lights
 * -> photons; with radius "auto" a count of photons that a frame stores, the radius and, as each photon's own depends on it,
 * photons again; then zones and areas and, since a photon has the zone of the cell where it lands, photons again; then bounds
 * (the whole path is played) -> effects that rays met -> pack. */
#include "pack/pipeline.h"
#include "pack/bounds.h"
#include "common/file_trouble.h"
#include "geometry/glass_inset.h"
#include "geometry/area_light_plane.h"
#include "import/light_units.h"
#include "light/photons.h"
#include "geometry/recentre.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GUIDED_BY                                                                                                              \
    (VIT_BIT(MIRROR) | VIT_BIT(GLASS) | VIT_BIT(CAUSTICS) | VIT_BIT(SPECULAR) | VIT_BIT(AREA_LIGHTS) | VIT_BIT(SKY_LIGHT))
#define COARSE 0x1p-16 /* of the scene's size: coarser floats in its files are worth a warning */

static vit_status out_of_memory(vit_text *why) {
    snprintf(why->text, sizeof why->text, "out of memory");
    return VIT_FAILED;
}

static void warn(void *user, const char *line) {
    progress_line(user, true, "warning: %s", line);
}

static void step(void *user, double fraction) {
    progress_step(user, fraction);
}

static vit_status file_fails(const scene *s, int line, const char *what, const char *file, const char *trouble, vit_text *why) {
    snprintf(why->text, sizeof why->text, "%.200s:%d: %s '%.200s' %s", s->path, line, what, file, trouble);
    for (char *c = why->text; *c; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f)
            *c = '?';
    return VIT_BAD_INPUT;
}

/* What a scene file names can be opened: known before the first of it is imported. A missing texture is a matter of --strict.
 */
static vit_status files_are_there(const scene *s, vit_text *why) {
    for (int i = 0; i < s->mesh_count; i++) {
        const char *trouble = file_trouble(s->meshes[i].file);
        if (trouble)
            return file_fails(s, s->meshes[i].line, "mesh", s->meshes[i].file, trouble, why);
    }
    const char *trouble = s->sky.image[0] ? file_trouble(s->sky.image) : NULL;
    return trouble ? file_fails(s, s->sky.line, "sky", s->sky.image, trouble, why) : VIT_OK;
}

vit_status pipeline_read(const char *path, scene *out, vit_text *why) {
    const char *dot = strrchr(path, '.');
    if (!dot || strcmp(dot, ".cfg") != 0)
        return scene_for_mesh(path, out, why);
    vit_status status = scene_read(path, out, why);
    if (status == VIT_OK && (status = files_are_there(out, why)) != VIT_OK)
        scene_free(out);
    return status;
}

static vit_status draw_glass_in(model *m, vit_text *why) {
    return glass_inset(m, geometry_ray_offset(m)) ? VIT_OK : out_of_memory(why);
}

/* Area lights in the very plane of a ceiling come out of it. */
static vit_status part_area_lights(pipeline *p, vit_text *why) {
    const float ray_offset = geometry_ray_offset(&p->model);
    uint32_t moved;
    if (!area_light_plane(&p->model, p->tracks.cameras, (uint32_t)p->scene.frames, ray_offset, &moved))
        return out_of_memory(why);
    if (moved > 0)
        progress_line(p->progress, false,
                      "%u triangles that emit lie in the plane of others: moved by %.2g m to the camera's side", moved,
                      AREA_LIGHT_PLANE * (double)ray_offset);
    return VIT_OK;
}

/* BVH, triangles and dark sides of the model. */
static vit_status make_shape(const pipeline *p, const model *m, bvh *b, geometry *g, dark_sides *r, vit_text *why) {
    progress_stage(p->progress, "BVH");
    vit_status status = bvh_build(m, p->threads, b, why);
    if (status == VIT_OK)
        status = geometry_pack(m, b, g, why);
    if (status != VIT_OK)
        return status;
    progress_stage(p->progress, "sides that light can reach");
    return dark_sides_find(m, &p->tracks, (uint32_t)p->scene.frames, p->scene.sky.light, g, p->threads, step, p->progress, r,
                           why);
}

/* What of MTL's highlights is not what the file's letter says. */
static void say_highlights(const model *m, progress *p) {
    if (m->default_highlights > 0)
        progress_line(
            p, false,
            "the highlights of %llu materials are what exporters write unasked (%s): matt ('specular' gives them one)",
            (unsigned long long)m->default_highlights, m->default_highlight);
    if (m->principled > 0)
        progress_line(p, false,
                      "the highlights of %llu materials (Ks 0.5, "
                      "Ka grey) are Blender's Principled shader: 4 %% reflection at that level, or metal",
                      (unsigned long long)m->principled);
}

/* Imports the meshes; if they lie far from the origin, moves the scene there and imports them again. */
static vit_status import(pipeline *p, vit_text *why) {
    double origin[3];
    vit_status status = model_import(&p->scene, p->strict, warn, p->progress, &p->model, why);
    if (status == VIT_OK && scene_is_far(&p->model, origin)) {
        progress_line(p->progress, false, "the scene lies far from the origin: moved by (%g, %g, %g)", -origin[0], -origin[1],
                      -origin[2]);
        scene_move(&p->scene, origin);
        model_free(&p->model);
        status = model_import(&p->scene, p->strict, NULL, NULL, &p->model, why);
    }
    if (status != VIT_OK)
        return status;
    say_highlights(&p->model, p->progress);
    double size = 0.0;
    for (int k = 0; k < 3; k++)
        size = fmax(size, p->model.hi[k] - p->model.lo[k]);
    if (p->model.step > COARSE * size)
        progress_line(p->progress, true,
                      "warning: positions in the mesh files are %.2g m apart, 1 / %.0f of the scene: numbers far from 0",
                      p->model.step, size / p->model.step);
    return VIT_OK;
}

static vit_status load_sky(pipeline *p, vit_text *why) {
    const scene_sky *s = &p->scene.sky;
    sky_constant(p->scene.background, &p->sky);
    if (!s->image[0])
        return VIT_OK;
    progress_stage(p->progress, "sky");
    return sky_load(s->image, s->scale, s->rotate, &p->sky, why);
}

vit_status pipeline_load(pipeline *p, vit_text *why) {
    progress_stage(p->progress, "import");
    vit_status status = import(p, why);
    if (status == VIT_OK)
        status = tracks_evaluate(&p->scene, &p->model, &p->tracks, why);
    if (status != VIT_OK)
        return status;
    light_units_say(&p->scene, &p->model, p->progress);
    status = part_area_lights(p, why);
    if (status == VIT_OK)
        status = draw_glass_in(&p->model, why);
    if (status == VIT_OK)
        status = make_shape(p, &p->model, &p->bvh, &p->geometry, &p->dark_sides, why);
    p->kept = calloc(1, sizeof *p->kept);
    if (status == VIT_OK && !p->kept)
        status = out_of_memory(why);
    if (status == VIT_OK) {
        progress_stage(p->progress, "atlas");
        status = atlas_pack(&p->model, &p->atlas, why);
    }
    if (status == VIT_OK)
        status = load_sky(p, why);
    return status;
}

void pipeline_free(pipeline *p) {
    if (p->kept)
        zones_kept_free(p->kept);
    free(p->kept);
    photon_guiding_free(&p->guided.guiding);
    sky_free(&p->sky);
    atlas_free(&p->atlas);
    geometry_free(&p->geometry);
    bvh_free(&p->bvh);
    tracks_free(&p->tracks);
    model_free(&p->model);
    scene_free(&p->scene);
}

pipeline_choice pipeline_default(const pipeline *p) {
    return (pipeline_choice){.quality = p->scene.quality, .width = p->scene.width, .height = p->scene.height};
}

/* The pipeline's shape, or one of its own where the quality asks for fewer bits. */
static vit_status choose_shape(const pipeline *p, const scene_quality *q, pipeline_packed *out, vit_text *why) {
    out->model = &p->model;
    out->bvh = &p->bvh;
    out->geometry = &p->geometry;
    out->dark_sides = &p->dark_sides;
    if (q->vertex_bits != 16 && q->normal_bits != 8)
        return VIT_OK;
    pipeline_shape *c = &out->coarse;
    vit_status status = model_quantise(&p->model, q->vertex_bits, q->normal_bits, &c->model, why);
    if (status == VIT_OK && q->vertex_bits == 16) /* on the grid faces may be in one place again */
        status = draw_glass_in(&c->model, why);
    if (status != VIT_OK)
        return status;
    out->model = &c->model;
    out->bvh = &c->bvh;
    out->geometry = &c->geometry;
    out->dark_sides = &c->dark_sides;
    return make_shape(p, &c->model, &c->bvh, &c->geometry, &c->dark_sides, why);
}

/* The sky as a source of photons. */
static photons_light sky_source(const pipeline *p, const pipeline_packed *out) {
    const plan *l = &out->plan;
    return (photons_light){
        .light = {.position = {l->sky_center[0], l->sky_center[1], l->sky_center[2]}, .spot_scale = l->sky_radius},
        .paths = l->sky_paths,
        .sky = &p->sky,
        .guide = photon_guiding_of(out->guiding, out->tracks.light_count + 1),
        .around = out->guiding ? out->guiding->around : (vec3){0.0f, 0.0f, 0.0f}};
}

/* Density of guided paths over that of even ones, where they are worth something, on average: of the light's own and of its
 * share of all paths. */
static double photon_guiding_gain(const photon_guiding *g, const pipeline_packed *out) {
    const uint32_t lights = out->tracks.light_count;
    double all = 0, gain = 0;
    for (int pass = 0; pass < 2; pass++)
        for (uint32_t i = 0; i < lights + 2; i++) {
            const uint32_t paths = i == lights       ? out->plan.area_paths
                                   : i == lights + 1 ? out->plan.sky_paths
                                                     : out->plan.baked_paths[i] + out->tracks.lights[i].path_count;
            all += pass == 0 ? (double)paths : 0;
            if (pass == 1 && paths > 0)
                gain += g->worth[i] * (g->worth[i] * all / (double)paths) * (g->guide[i].nodes ? g->guide[i].gain : 1);
        }
    return gain;
}

/* Guides of the scene's lights, and the paths shared by what they are worth. Where nothing is worth anything, photons go
 * evenly. */
static vit_status guide_photons(pipeline *p, const scene *s, pipeline_packed *out, vit_text *why) {
    const vit_scene *c = &out->plan.scene;
    pipeline_guiding *kept = &p->guided;
    if (!s->quality.guiding || !(c->effects & VIT_BIT(PHOTONS)))
        return VIT_OK;
    if (kept->guiding.count == 0 || kept->width != c->width || kept->height != c->height || kept->bounces != c->bounces ||
        kept->effects != (c->effects & GUIDED_BY)) {
        bool *gives = calloc(c->lights + 1u, sizeof *gives);
        if (!gives)
            return out_of_memory(why);
        for (uint32_t i = 0; i < c->lights; i++)
            gives[i] = out->plan.baked_paths[i] > 0 || out->tracks.lights[i].path_count > 0;
        const photons_light from_sky = sky_source(p, out);
        const photon_guiding_input in = {.scene = {.triangles = p->geometry.triangles,
                                                   .attributes = p->geometry.attributes,
                                                   .triangle_count = p->model.triangles,
                                                   .materials = out->plan.materials,
                                                   .atlas = &p->atlas,
                                                   .ray_offset = p->geometry.ray_offset,
                                                   .box_pad = p->bvh.box_pad,
                                                   .effects = c->effects},
                                         .tracks = &out->tracks,
                                         .frames = c->frames,
                                         .width = c->width,
                                         .height = c->height,
                                         .bounces = c->bounces,
                                         .gives_photons = gives,
                                         .area = out->plan.area_paths > 0 ? &out->plan.area : NULL,
                                         .sky = out->plan.sky_paths > 0 ? &from_sky : NULL,
                                         .threads = p->threads};
        progress_stage(p->progress, "guides of photons");
        photon_guiding_free(&kept->guiding);
        const vit_status status = photon_guiding_find(&in, &kept->guiding, why);
        free(gives);
        if (status != VIT_OK)
            return status;
        *kept = (pipeline_guiding){kept->guiding, c->width, c->height, c->bounces, c->effects & GUIDED_BY};
    }
    out->guiding = &kept->guiding;
    out->guided_gain = photon_guiding_gain(&kept->guiding, out);
    return plan_share(s, &out->tracks, out->dark_sides, &p->sky, kept->guiding.worth, &out->plan, why);
}

static vit_status trace_photons(const pipeline *p, pipeline_packed *out, vit_text *why) {
    photons_light *lights = calloc(out->tracks.light_count + 2u, sizeof *lights);
    uint32_t count = 0;
    vit_status status = VIT_OK;
    if (!out->met)
        out->met = calloc(out->plan.scene.materials, sizeof *out->met);
    if (!lights || !out->met) {
        free(lights);
        return out_of_memory(why);
    }
    for (uint32_t i = 0; i < out->tracks.light_count; i++)
        if (out->plan.baked_paths[i] > 0)
            lights[count++] = (photons_light){
                .light = out->tracks.lights[i], .paths = out->plan.baked_paths[i], .guide = photon_guiding_of(out->guiding, i)};
    if (out->plan.area_paths > 0)
        lights[count++] = (photons_light){.paths = out->plan.area_paths,
                                          .area = &out->plan.area,
                                          .guide = photon_guiding_of(out->guiding, out->tracks.light_count)};
    if (out->plan.sky_paths > 0)
        lights[count++] = sky_source(p, out);
    if (count > 0) {
        progress_stage(p->progress, "photons of still lights");
        photons_input in = {.triangles = out->geometry->triangles,
                            .attributes = out->geometry->attributes,
                            .triangle_count = out->model->triangles,
                            .materials = out->plan.materials,
                            .atlas = &p->atlas,
                            .ray_offset = out->geometry->ray_offset,
                            .box_pad = out->plan.scene.box_pad,
                            .effects = out->plan.scene.effects,
                            .first_path = out->plan.scene.paths,
                            .radius = out->plan.scene.radius,
                            .bounces = out->plan.scene.bounces,
                            .sequence = (out->plan.scene.effects & VIT_BIT(SEQUENCE)) != 0,
                            .cells = out->plan.scene.effects & VIT_BIT(ZONES) && out->cells.count ? &out->cells : NULL,
                            .lights = lights,
                            .light_count = count,
                            .met = out->met,
                            .progress = step,
                            .user = p->progress};
        free(out->photons);
        status = photons_bake(&in, p->threads, &out->photons, &out->plan.scene.baked, why);
        if (status == VIT_OK && in.cells)
            zones_assign(in.cells, out->photons, out->plan.scene.baked);
    }
    free(lights);
    return status;
}

static void measuring(void *user, const char *stage, double fraction) {
    progress *p = user;
    if (p->stage != stage)
        progress_stage(p, stage);
    progress_step(p, fraction);
}

/* "auto" follows the photons that are stored, not the slots there are: many paths may leave the scene. Zones and areas come
 * later: they depend on the radius. */
static vit_status settle_radius(const pipeline *p, bounds_input *in, pipeline_packed *out, vit_text *why) {
    double stored;
    const uint64_t effects = in->scene->effects;
    in->scene->effects &= ~(VIT_BIT(ZONES) | VIT_BIT(AREA));
    vit_status status = bounds_count_photons(in, &stored, why);
    in->scene->effects = effects;
    if (status == VIT_OK && stored > 0) {
        out->plan.scene.radius = (float)plan_radius(&out->plan, stored);
        status = trace_photons(p, out, why); /* each photon's radius depends on it */
    }
    return status;
}

/* Keeps the chosen frames' cameras and lights. */
static void cut_frames(const pipeline_choice *c, pipeline_packed *out) {
    tracks *t = &out->tracks;
    if (!c->frames)
        return;
    for (uint32_t i = 0; i < c->frame_count; i++) { /* ascending: a frame moves towards the front */
        t->cameras[i] = t->cameras[c->frames[i]];
        for (uint32_t k = 0; k < t->light_count; k++)
            t->lights[(size_t)i * t->light_count + k] = t->lights[(size_t)c->frames[i] * t->light_count + k];
    }
    out->plan.scene.frames = c->frame_count;
}

static void point_sections(const pipeline *p, pipeline_packed *out) {
    out->sections = (pack_sections){.data = {[VIT_SECTION_META] = &out->plan.scene,
                                             [VIT_SECTION_CAMS] = out->tracks.cameras,
                                             [VIT_SECTION_LITE] = out->tracks.lights,
                                             [VIT_SECTION_GEOM] = out->geometry->triangles,
                                             [VIT_SECTION_ATTR] = out->geometry->attributes,
                                             [VIT_SECTION_BVHN] = out->bvh->nodes,
                                             [VIT_SECTION_MATL] = out->plan.materials,
                                             [VIT_SECTION_TEXR] = p->atlas.textures,
                                             [VIT_SECTION_MIPS] = p->atlas.mips,
                                             [VIT_SECTION_ATLS] = p->atlas.texels,
                                             [VIT_SECTION_SIDE] = out->cells.sides,
                                             [VIT_SECTION_CELL] = out->cells.cells,
                                             [VIT_SECTION_EMIT] = out->area_lights,
                                             [VIT_SECTION_SKYT] = p->sky.texels,
                                             [VIT_SECTION_PHOT] = out->photons,
                                             [VIT_SECTION_GOLD] = out->gold}};
}

/* Zones and effective areas, for the radius that the plan has now; then the baked photons' zones. */
static vit_status bake_zones(const pipeline *p, const pipeline_choice *c, pipeline_packed *out, vit_text *why) {
    bool *gives = calloc(out->tracks.light_count + 1u, sizeof *gives);
    if (!gives)
        return out_of_memory(why);
    for (uint32_t i = 0; i < out->tracks.light_count; i++)
        gives[i] = out->plan.baked_paths[i] > 0 || out->tracks.lights[i].path_count > 0;
    const photons_light from_sky = sky_source(p, out);
    progress_stage(p->progress, "zones and areas");
    const zones_input in = {.geometry = out->geometry,
                            .triangles = out->model->triangles,
                            .materials = out->plan.materials,
                            .atlas = &p->atlas,
                            .tracks = &out->tracks,
                            .gives_photons = gives,
                            .area_lights = out->plan.area_paths > 0 ? &out->plan.area : NULL,
                            .sky = out->plan.sky_paths > 0 ? &from_sky : NULL,
                            .guiding = out->guiding,
                            .scene = &out->plan.scene,
                            .zones = c->quality.zones,
                            .by_light = c->quality.light_zones,
                            .areas = (out->plan.scene.effects & VIT_BIT(AREA)) != 0,
                            .threads = p->threads,
                            .progress = step,
                            .user = p->progress};
    const bool own = out->geometry == &p->geometry; /* triangles of another shape are not to be mixed up with these */
    vit_status status =
        own ? zones_kept_bake(p->kept, &in, &out->cells, &out->zones, why) : zones_bake(&in, &out->cells, &out->zones, why);
    out->plan.scene.cells = out->cells.count;
    free(gives);
    return status == VIT_OK && c->quality.zones ? trace_photons(p, out, why) : status;
}

/* The sets of points on area lights and of directions to the sky. */
static vit_status place_area_lights(const pipeline *p, pipeline_packed *out, vit_text *why) {
    const vit_scene *s = &out->plan.scene;
    out->area_lights = malloc(((size_t)s->area_samples + s->sky_samples + 1) * VIT_PATTERNS * sizeof *out->area_lights);
    if (!out->area_lights)
        return out_of_memory(why);
    if (s->area_samples > 0)
        area_lights_near(&out->plan.area, s->area_samples, out->plan.materials);
    const vit_status status =
        s->area_samples > 0 ? area_lights_sets(&out->plan.area, s->area_samples, out->area_lights, why) : VIT_OK;
    if (s->sky_samples > 0)
        sky_sets(&p->sky, s->sky_samples, out->area_lights + (size_t)VIT_PATTERNS * s->area_samples);
    return status;
}

static vit_status measure(const pipeline *p, const pipeline_choice *c, pipeline_packed *out, vit_text *why) {
    out->gold = calloc(out->plan.scene.frames, sizeof *out->gold);
    if (!out->gold)
        return out_of_memory(why);
    point_sections(p, out);
    bounds_input in = {.sections = &out->sections,
                       .scene = &out->plan.scene,
                       .gold = out->gold,
                       .device = p->device,
                       .threads = p->threads,
                       .all_formats = p->all_formats,
                       .progress = measuring,
                       .user = p->progress};
    vit_status status = VIT_OK;
    if ((out->plan.scene.effects & VIT_BIT(PHOTONS)) && !(c->quality.radius > 0))
        status = settle_radius(p, &in, out, why);
    if (status == VIT_OK && (out->plan.scene.effects & (VIT_BIT(ZONES) | VIT_BIT(AREA))))
        status = bake_zones(p, c, out, why);
    point_sections(p, out);
    cut_frames(c, out);
    effects_reached *reached = calloc(EFFECTS_RECORDS(out->plan.scene.materials), sizeof *reached);
    in.reached = (out->plan.scene.effects | out->plan.effects.forced_off) & (EFFECTS_SETTLED | VIT_BIT(AREA_LIGHTS))
                     ? reached
                     : NULL; /* else there is nothing to find out */
    if (status == VIT_OK && !reached)
        status = out_of_memory(why);
    if (status == VIT_OK)
        status = bounds_measure(&in, why);
    for (uint32_t i = 0; i < out->plan.scene.materials && status == VIT_OK; i++)
        reached[i].how |= out->met && out->met[i] ? EFFECTS_REACHED_BAKED : 0;
    if (status == VIT_OK)
        effects_settle(&out->plan.scene, out->model, out->plan.materials, reached, &out->plan.effects);
    free(reached);
    if (status == VIT_OK)
        status = pack_assemble(&out->sections, &out->bytes, &out->size, why);
    return status;
}

vit_status pipeline_pack(pipeline *p, const pipeline_choice *choice, pipeline_packed *out, vit_text *why) {
    scene s = p->scene; /* borrows its lists */
    memset(out, 0, sizeof *out);
    s.quality = choice->quality;
    s.width = choice->width;
    s.height = choice->height;
    vit_status status = tracks_evaluate(&s, &p->model, &out->tracks, why);
    if (status == VIT_OK)
        status = choose_shape(p, &choice->quality, out, why);
    if (status == VIT_OK)
        status = plan_make(&s, out->model, &out->tracks, &p->atlas, out->bvh, out->geometry, out->dark_sides, &p->sky,
                           p->threads, &out->plan, why);
    if (status == VIT_OK)
        status = guide_photons(p, &s, out, why);
    if (status == VIT_OK)
        status = place_area_lights(p, out, why);
    if (status == VIT_OK)
        status = trace_photons(p, out, why);
    if (status == VIT_OK)
        status = measure(p, choice, out, why);
    progress_end(p->progress);
    if (status != VIT_OK)
        pipeline_packed_free(out);
    return status;
}

void pipeline_packed_free(pipeline_packed *packed) {
    free(packed->bytes);
    free(packed->gold);
    free(packed->photons);
    free(packed->met);
    free(packed->area_lights);
    cells_free(&packed->cells);
    plan_free(&packed->plan);
    geometry_free(&packed->coarse.geometry);
    bvh_free(&packed->coarse.bvh);
    model_quantise_free(&packed->coarse.model);
    tracks_free(&packed->tracks);
    memset(packed, 0, sizeof *packed);
}
