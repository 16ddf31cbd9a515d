/* vitrine-bake: import -> tracks -> BVH -> geometry -> reach -> atlas -> plan -> photons -> bounds -> pack. Data flows one way. */
#include "atlas.h"
#include "bounds.h"
#include "bvh.h"
#include "options.h"
#include "pack_write.h"
#include "photons.h"
#include "planner.h"
#include "progress.h"
#include "reach.h"
#include "tracks.h"
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Everything a bake makes, in the order in which it is made. */
typedef struct bake {
    options options;
    progress progress;
    scene scene;
    model model;
    tracks tracks;
    bvh bvh;
    geometry geometry;
    reach reach;
    atlas atlas;
    plan plan;
    vit_photon *photons;
    vit_gold *gold;
    void *pack;
    size_t pack_size;
} bake;

/* Everything that is unfinished is in memory or under a temporary name, so that the end may come at once. */
static void on_signal(int number) {
    static const char line[] = "\nvitrine-bake: interrupted\n";
    (void)number;
    pack_abandon();
    if (write(STDERR_FILENO, line, sizeof line - 1) < 0)
        _exit(VIT_FAILED);
    _exit(VIT_FAILED);
}

static void warn(void *user, const char *line) {
    progress_line(user, true, "warning: %s", line);
}

static void step(void *user, double fraction) {
    progress_step(user, fraction);
}

static bool is_scene_file(const char *path) {
    const char *dot = strrchr(path, '.');
    return dot && strcmp(dot, ".cfg") == 0;
}

static vit_status import(bake *b, vit_text *why) {
    progress_stage(&b->progress, "import");
    vit_status status = is_scene_file(b->options.input) ? scene_read(b->options.input, &b->scene, why)
                                                        : scene_for_mesh(b->options.input, &b->scene, why);
    if (status == VIT_OK)
        status = options_apply(&b->options, &b->scene, why);
    if (status == VIT_OK)
        status = model_import(&b->scene, b->options.strict, warn, &b->progress, &b->model, why);
    if (status == VIT_OK)
        status = tracks_evaluate(&b->scene, &b->model, &b->tracks, why);
    return status;
}

static vit_status build(bake *b, vit_text *why) {
    progress_stage(&b->progress, "BVH");
    vit_status status = bvh_build(&b->model, b->options.threads, &b->bvh, why);
    if (status == VIT_OK)
        status = geometry_pack(&b->model, &b->bvh, &b->geometry, why);
    if (status == VIT_OK) {
        progress_stage(&b->progress, "sides that light can reach");
        status = reach_dark_sides(&b->model, &b->tracks, (uint32_t)b->scene.frames, &b->geometry, b->options.threads, step, &b->progress, &b->reach,
                                  why);
    }
    if (status == VIT_OK) {
        progress_stage(&b->progress, "atlas");
        status = atlas_pack(&b->model, &b->atlas, why);
    }
    if (status == VIT_OK)
        status = plan_make(&b->scene, &b->model, &b->tracks, &b->atlas, &b->bvh, &b->geometry, &b->reach, &b->plan, why);
    return status;
}

static vit_status trace_photons(bake *b, vit_text *why) {
    photons_light *lights = calloc(b->tracks.light_count + 1u, sizeof *lights);
    uint32_t count = 0;
    vit_status status = VIT_OK;
    if (!lights) {
        snprintf(why->text, sizeof why->text, "out of memory");
        return VIT_FAILED;
    }
    for (uint32_t i = 0; i < b->tracks.light_count; i++)
        if (b->plan.baked_paths[i] > 0)
            lights[count++] = (photons_light){b->tracks.lights[i], b->plan.baked_paths[i]};
    if (count > 0) {
        progress_stage(&b->progress, "photons of still lights");
        photons_input in = {.triangles = b->geometry.triangles,
                            .attributes = b->geometry.attributes,
                            .triangle_count = b->model.triangles,
                            .materials = b->plan.materials,
                            .atlas = &b->atlas,
                            .ray_offset = b->geometry.ray_offset,
                            .box_pad = b->plan.scene.box_pad,
                            .first_path = b->plan.scene.paths,
                            .radius = b->plan.scene.radius,
                            .bounces = b->plan.scene.bounces,
                            .lights = lights,
                            .light_count = count,
                            .progress = step,
                            .user = &b->progress};
        status = photons_bake(&in, b->options.threads, &b->photons, &b->plan.scene.baked, why);
    }
    free(lights);
    return status;
}

static void measuring(void *user, const char *stage, double fraction) {
    bake *b = user;
    if (b->progress.stage != stage)
        progress_stage(&b->progress, stage);
    progress_step(&b->progress, fraction);
}

/* "auto" follows the photons that are stored, not the slots there are: many paths may leave the scene. */
static vit_status settle_radius(bake *b, bounds_input *in, vit_text *why) {
    double stored;
    vit_status status = bounds_count_photons(in, &stored, why);
    if (status == VIT_OK && stored > 0)
        plan_set_radius(&b->plan, plan_radius(&b->plan, stored), b->photons);
    return status;
}

static vit_status measure(bake *b, vit_text *why) {
    b->gold = calloc((size_t)b->scene.frames, sizeof *b->gold);
    if (!b->gold) {
        snprintf(why->text, sizeof why->text, "out of memory");
        return VIT_FAILED;
    }
    pack_sections sections = {.data = {[VIT_SECTION_META] = &b->plan.scene,
                                       [VIT_SECTION_CAMS] = b->tracks.cameras,
                                       [VIT_SECTION_LITE] = b->tracks.lights,
                                       [VIT_SECTION_GEOM] = b->geometry.triangles,
                                       [VIT_SECTION_ATTR] = b->geometry.attributes,
                                       [VIT_SECTION_BVHN] = b->bvh.nodes,
                                       [VIT_SECTION_MATL] = b->plan.materials,
                                       [VIT_SECTION_TEXR] = b->atlas.textures,
                                       [VIT_SECTION_MIPS] = b->atlas.mips,
                                       [VIT_SECTION_ATLS] = b->atlas.texels,
                                       [VIT_SECTION_PHOT] = b->photons,
                                       [VIT_SECTION_GOLD] = b->gold}};
    bounds_input in = {.sections = &sections,
                       .scene = &b->plan.scene,
                       .gold = b->gold,
                       .device = b->options.device,
                       .all_formats = b->options.all_formats,
                       .progress = measuring,
                       .user = b};
    vit_status status = VIT_OK;
    if ((b->plan.scene.effects & VIT_EFFECT_BIT_PHOTONS) && !(b->scene.quality.radius > 0))
        status = settle_radius(b, &in, why);
    if (status == VIT_OK)
        status = bounds_measure(&in, why);
    if (status == VIT_OK)
        status = pack_assemble(&sections, &b->pack, &b->pack_size, why);
    return status;
}

static void print_line(void *user, const char *line) {
    (void)user;
    printf("  %s\n", line);
}

static vit_status explain(const bake *b, vit_text *why) {
    const vit_scene *s = &b->plan.scene;
    vit_requirements need;
    vit_open_info info = {.pack = b->pack, .pack_size = b->pack_size};
    vit_status status = vit_require(&info, &need, why);
    if (status != VIT_OK)
        return status;
    printf("effects\n");
    plan_explain(&b->plan, print_line, NULL);
    printf("\nscene\n  %u x %u, %u frames at %g a second\n", s->width, s->height, s->frames, (double)s->fps);
    printf("  triangles %u (dropped: %llu of no area, %llu not finite, %llu not triangles), BVH nodes %u, depth %u\n", s->triangles,
           (unsigned long long)b->model.degenerate, (unsigned long long)b->model.not_finite, (unsigned long long)b->model.not_triangles, s->nodes,
           b->bvh.depth);
    printf("  surface %.4g m2 (both sides), of which %.4g m2 get no light to speak of\n", b->reach.area, b->reach.dark_front + b->reach.dark_back);
    printf("  textures %u in an atlas of %u x %u texels, %.0f %% in use\n", s->textures, b->atlas.width, b->atlas.height, 100 * b->atlas.occupancy);
    if (s->effects & VIT_EFFECT_BIT_PHOTONS)
        printf("  photons: %u paths a frame, %u baked photons, %u bounces, radius %g m\n", s->paths, s->baked, s->bounces,
               (double)s->radius);
    printf("\nbounds, the largest of any frame\n  hierarchy nodes %u, list entries %u, depth slices %u from %u on, key bits %u\n", s->max_nodes, s->max_list,
           s->slice_count, s->slice_first, s->key_bits);
    printf("\nbuffers\n");
    for (uint32_t i = 0; i < need.buffer_count; i++)
        printf("  %-14s %12llu  %s\n", need.buffers[i].name, (unsigned long long)need.buffers[i].bytes, need.buffers[i].effect);
    printf("\n  device bytes %llu, host bytes %zu, pack bytes %zu\n", (unsigned long long)need.device_bytes, need.host_bytes, b->pack_size);
    return VIT_OK;
}

/* Found out before the work rather than after it. */
static vit_status check_output(const char *path, vit_text *why) {
    char folder[SCENE_PATH];
    const char *slash = path ? strrchr(path, '/') : NULL;
    snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - path) + 1 : 1, slash ? path : ".");
    if (!path || access(folder, W_OK | X_OK) == 0)
        return VIT_OK;
    snprintf(why->text, sizeof why->text, "%.400s: cannot write into its folder: %s", path, strerror(errno));
    return VIT_FAILED;
}

static vit_status run(bake *b, vit_text *why) {
    vit_status status = check_output(b->options.output, why);
    if (status == VIT_OK)
        status = import(b, why);
    if (status == VIT_OK)
        status = build(b, why);
    if (status == VIT_OK)
        status = trace_photons(b, why);
    if (status == VIT_OK)
        status = measure(b, why);
    progress_end(&b->progress);
    if (status == VIT_OK && b->options.explain)
        status = explain(b, why);
    if (status == VIT_OK && b->options.output)
        status = pack_save(b->options.output, b->pack, b->pack_size, why);
    if (status == VIT_OK && b->options.output)
        progress_line(&b->progress, false, "%s: %u triangles, %u frames, %.1f MB", b->options.output, b->model.triangles, b->plan.scene.frames,
                      (double)b->pack_size * 1e-6);
    return status;
}

static void release(bake *b) {
    free(b->pack);
    free(b->gold);
    free(b->photons);
    plan_free(&b->plan);
    atlas_free(&b->atlas);
    geometry_free(&b->geometry);
    bvh_free(&b->bvh);
    tracks_free(&b->tracks);
    model_free(&b->model);
    scene_free(&b->scene);
}

int main(int argc, char **argv) {
    bake b;
    vit_text why = {""};
    memset(&b, 0, sizeof b);
    vit_status status = options_parse(argc, argv, &b.options, &why);
    if (status == VIT_OK && b.options.help) {
        options_help();
        return VIT_OK;
    }
    if (status == VIT_OK && b.options.version) {
        puts("vitrine-bake " VIT_VERSION);
        return VIT_OK;
    }
    if (status == VIT_OK) {
        signal(SIGINT, on_signal);
        signal(SIGTERM, on_signal);
        b.progress = progress_make(b.options.quiet);
        status = run(&b, &why);
    }
    if (status == VIT_OK && (fflush(stdout) != 0 || ferror(stdout))) {
        snprintf(why.text, sizeof why.text, "standard output: write failed");
        status = VIT_FAILED;
    }
    if (status != VIT_OK)
        fprintf(stderr, "vitrine-bake: %s\n", why.text);
    release(&b);
    return status;
}
