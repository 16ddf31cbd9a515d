/* vitrine-bake: a scene file or mesh to one pack (pipeline.c does the work). */
#include "check/auto.h"
#include "check/exposure.h"
#include "common/fail.h"
#include "cost/effect_cost.h"
#include "cost/fit_pack.h"
#include "list.h"
#include "options.h"
#include "scene/setting_rows.h"
#include "pack/pipeline.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct bake {
    options options;
    progress progress;
    pipeline pipeline;
    pipeline_packed packed;
    auto_found chosen; /* with quality "auto" */
} bake;

/* Everything that is unfinished is in memory or under a temporary name, so that the end may come at once. */
static void on_signal(int number) {
    static const char line[] = "\nvitrine-bake: interrupted\n";
    (void)number;
    pack_abandon(); /* NOLINT(bugprone-signal-handler,cert-sig30-c,cert-msc54-cpp): it does nothing but unlink(), which POSIX
                       allows here */
    if (write(STDERR_FILENO, line, sizeof line - 1) < 0)
        _exit(VIT_FAILED);
    _exit(VIT_FAILED);
}

static void warn_of_missed_effects(bake *b) {
    const effects_decided *e = &b->packed.plan.effects;
    for (int bit = 0; bit < 64; bit++)
        if (e->missed >> bit & 1)
            progress_line(&b->progress, true, "warning: %s is left out: %s", effects_name(bit),
                          e->reason[bit] + strlen(EFFECTS_FORCED_OFF));
}

/* Settings of light that is baked, stated though there is no such light, and not what is taken anyway: a warning each, with
 * --strict an error. */
static vit_status check_idle_settings(bake *b, vit_text *why) {
    static const char no_radius[] = "there is no ambient light of a radius",
                      no_light[] = "no matt surface takes light of the sky or of area lights",
                      no_basis[] = "no basis makes indirect light";
    static const struct {
        int setting;
        uint64_t effects; /* one of which it needs */
        const char *lacks;
    } all[] = {{SETTING_AT_basis_receivers, VIT_BIT(BASIS), no_basis},
               {SETTING_AT_point_spacing, VIT_BIT(POINTS), "irradiance is not baked at points"},
               {SETTING_AT_cache, VIT_BIT(OCCLUSION), no_radius},
               {SETTING_AT_cache_spacing, VIT_BIT(OCCLUSION), no_radius},
               {SETTING_AT_cache_error, VIT_BIT(OCCLUSION), no_radius},
               {SETTING_AT_lightmap, VIT_BIT(LIGHTMAP), no_light},
               {SETTING_AT_lightmap_spacing, VIT_BIT(AREA_LIGHTS) | VIT_BIT(SKY_LIGHT), no_light},
               {SETTING_AT_lightmap_error, VIT_BIT(AREA_LIGHTS) | VIT_BIT(SKY_LIGHT), no_light}};
    const scene *s = &b->pipeline.scene;
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        const bool stated = s->quality_kept >> all[i].setting & 1,
                   open = (all[i].setting == SETTING_AT_lightmap && s->quality.lightmap != LIGHTMAP_BAKED) ||
                          (all[i].setting == SETTING_AT_basis_receivers && s->quality.basis_receivers == RECEIVERS_CELLS);
        const char *word = setting_rows[all[i].setting].field.name;
        if (!stated || open || b->packed.plan.scene.effects & all[i].effects)
            continue;
        if (b->options.strict)
            return bake_fail_plain(why, VIT_BAD_INPUT, "%.200s: '%s' does nothing: %s", b->options.input, word, all[i].lacks);
        progress_line(&b->progress, true, "warning: '%s' does nothing: %s", word, all[i].lacks);
    }
    return VIT_OK;
}

static bool fits(const options *o) {
    return o->fit > 0 || o->fit_work > 0;
}

/* The device whose frames --fit times. OpenCL is looked at only if there is something to time. */
static vit_status find_device(const options *o, uint32_t *out, vit_text *why) {
    *out = VIT_DEVICE_HOST;
    if (o->device)
        return vit_device_find(o->device, out, why);
    if (o->fit > 0)
        *out = vit_device_default();
    return VIT_OK;
}

/* The pack must be none of the files that are known to be read by now. */
static vit_status check_against_inputs(const bake *b, vit_text *why) {
    const char *path = b->options.output;
    vit_status status = path ? inputs_check_output(&b->pipeline.scene.files, "-o", path, why) : VIT_OK;
    return path && status == VIT_OK ? inputs_check_output(&b->pipeline.model.files, "-o", path, why) : status;
}

/* What would make all the work be for nothing. */
static vit_status check_before(const bake *b, vit_text *why) {
    vit_status status = check_against_inputs(b, why);
    if (status == VIT_OK && b->options.output)
        status = pack_can_save(b->options.output, why);
    return status;
}

static vit_status make_pack(bake *b, vit_text *why) {
    pipeline *p = &b->pipeline;
    p->strict = b->options.strict;
    p->all_formats = b->options.all_formats;
    p->threads = b->options.threads;
    uint32_t played_on;
    p->progress = &b->progress;
    vit_status status = find_device(&b->options, &played_on, why);
    p->device = fits(&b->options) ? VIT_DEVICE_HOST : played_on;
    if (status == VIT_OK)
        status = pipeline_read(b->options.input, &p->scene, why);
    if (status == VIT_OK)
        status = options_apply(&b->options, &p->scene, why);
    if (status == VIT_OK)
        status = check_before(b, why);
    if (status == VIT_OK)
        status = pipeline_load(p, why);
    if (status == VIT_OK)
        status = check_against_inputs(b, why);
    if (status == VIT_OK)
        status = exposure_settle(p, why);
    if (status == VIT_OK)
        status = pipeline_settle_indirect(p, why);
    if (status != VIT_OK)
        return status;
    const fit_budget budget = {.ms = b->options.fit, .work = (uint64_t)b->options.fit_work};
    const bool chooses = p->scene.quality_auto && p->scene.check && !fits(&b->options);
    if (chooses)
        status = auto_choose(p, &b->chosen, why);
    const pipeline_choice asked = pipeline_default(p);
    if (status == VIT_OK && fits(&b->options))
        status = fit_pack(p, played_on, &budget, &b->packed, why);
    else if (status == VIT_OK)
        status = pipeline_pack(p, &asked, &b->packed, why);
    if (status != VIT_OK)
        return status;
    if (p->indirect_why[0])
        progress_line(&b->progress, false, "indirect = \"auto\": %s, since %s",
                      settings_indirect_name(p->scene.quality.indirect), p->indirect_why);
    if (!p->indirect_why[0] && p->scene.quality.indirect == INDIRECT_RADIOSITY &&
        (b->packed.plan.scene.effects & VIT_BIT(BASIS)))
        progress_line(&b->progress, false,
                      "indirect = \"radiosity\": a basis is baked, since no light moves or changes, or nothing reflects it");
    if (plan_leaves_area_out(&p->scene.quality)) /* as fitted */
        progress_line(&b->progress, true, "warning: effective_area does nothing for buckets within zones");
    warn_of_missed_effects(b);
    status = check_idle_settings(b, why);
    if (status != VIT_OK)
        return status;
    if (chooses)
        auto_say(p, &b->packed, &b->chosen);
    return p->scene.check && !chooses ? check_pack(p, &b->packed, why) : VIT_OK;
}

/* A line each: name, what it adds, why. */
static void explain_effects(const pipeline_packed *p, const effect_costs *all) {
    printf("effects %24s %16s   of %llu bytes and %llu work units a frame\n", "bytes", "work units",
           (unsigned long long)all->device_bytes, (unsigned long long)all->work);
    for (int bit = 0; bit < 64; bit++) {
        const effect_cost *a = &all->effect[bit];
        if (!effects_name(bit))
            continue;
        printf("  %-15s ", effects_name(bit));
        if (a->found)
            printf("%+14lld %+16lld", (long long)a->bytes, (long long)a->work);
        else
            printf("%14s %16s", "-", "-");
        printf("   %s\n", p->plan.effects.reason[bit]);
    }
}

/* What there is, and what of it is kept and asked for. */
static void explain_radiosity(const pipeline_packed *p) {
    const live_saving *l = &p->live.saving;
    const vit_scene *s = &p->plan.scene;
    printf("  indirect light by live radiosity: %u patches with %u points, %u bounces%s\n", s->patches, s->patch_points,
           s->bounces, s->bounces < PLAN_ALL_BOUNCES ? "" : " and more");
    printf("    receivers %u, of which some frame looks up %u, a frame %.0f (one set for %u frame%s); these see %u patches\n",
           l->receivers, l->kept, l->looked_up, s->looked_frames, s->looked_frames == 1 ? "" : "s", l->patches);
    printf("    of %u words that say what receivers see %u are kept, and a frame reads %.0f\n", l->words, s->gather_words,
           l->gathered);
}

/* Which method, and why where the baker has chosen it. */
static void explain_indirect(const bake *b) {
    const pipeline *p = &b->pipeline;
    const vit_scene *s = &b->packed.plan.scene;
    if (p->indirect_why[0])
        printf("  indirect = \"auto\": %s, since %s\n", settings_indirect_name(p->scene.quality.indirect), p->indirect_why);
    if (s->effects & VIT_BIT(BASIS))
        printf("  indirect light by the basis: %u receivers, %u lights that move, %u bounces%s\n", s->receivers,
               s->basis_lights, s->bounces, s->bounces < PLAN_ALL_BOUNCES ? "" : " and more");
    const basis_points *at = &b->packed.baked.points;
    if (s->effects & VIT_BIT(POINTS))
        printf(
            "    at points in space: %u points of %u cells, %u of them parted by walls, %.0f kB (%.0f %% full, a look-up reads "
            "%u records at most, %u cells dropped), %u levels of boxes from %.3g m on; by %u places, off by %.2g of the mean "
            "light\n",
            at->count, at->cells, at->parted,
            1e-3 * (double)(s->receiver_cells * sizeof(vit_cache_cell) + s->receivers * sizeof(vit_receiver)),
            100.0 * at->table.filled / s->receiver_cells, at->table.longest, at->table.dropped, at->levels, (double)at->step,
            at->places, at->off);
    if (s->effects & VIT_BIT(RADIOSITY))
        explain_radiosity(&b->packed);
}

static void explain_lightmap(const bake *b) {
    const lightmap *m = &b->packed.lightmap;
    const vit_scene *s = &b->packed.plan.scene;
    if (b->packed.plan.lightmap_why[0])
        printf("  lightmap = \"auto\": rays, since %s\n", b->packed.plan.lightmap_why);
    if (s->effects & VIT_BIT(LIGHTMAP))
        printf(
            "  light of the sky and of area lights by a lightmap: %u receivers, %u cells, %.0f kB; rays find it in %u cells, "
            "%.2g %% of what is seen\n",
            s->map_receivers, s->map_cells,
            1e-3 * (double)(s->map_receivers * sizeof(vit_receiver) + s->map_cells * sizeof(vit_receiver_cell) +
                            s->map_splits * sizeof(vit_receiver_split) + s->triangles * 2 * sizeof(vit_u32)),
            m->receivers.unknown, 100 * (double)m->receivers.unknown_share);
}

static void explain_cache(const bake *b) {
    const occlusion *o = &b->packed.occlusion;
    const vit_scene *s = &b->packed.plan.scene;
    if (!(s->effects & VIT_BIT(OCCLUSION)))
        return;
    printf(
        "  ambient light within %g m by a cache: %u cells, %.0f kB (%.0f %% full, a look-up reads %u records at most, %u cells "
        "dropped), %u levels of boxes from %.3g m on",
        (double)s->ambient_radius, o->cells, 1e-3 * (double)(s->cache_cells * sizeof(vit_cache_cell)),
        100.0 * o->table.filled / s->cache_cells, o->table.longest, o->table.dropped, o->levels, (double)o->step);
    if (s->effects & VIT_BIT(LIVE_CACHE))
        printf("; filled while playing\n");
    else
        printf("; %u points, by %u rays at each of %u places, off by %.2g of all light\n", o->points, o->rays, o->places,
               o->off);
}

static vit_status explain(bake *b, vit_text *why) {
    const pipeline *p = &b->pipeline;
    const vit_scene *s = &b->packed.plan.scene;
    vit_requirements need;
    vit_open_info info = {.pack = b->packed.bytes, .pack_size = b->packed.size};
    vit_status status = vit_require(&info, &need, why);
    if (status != VIT_OK)
        return status;
    if (b->chosen.tried > 0)
        printf("quality \"auto\": { %s}, of %u tried %s\n\n", b->chosen.text, b->chosen.tried,
               b->chosen.right ? "the cheapest that is right" : "the best");
    effect_costs all;
    status = effect_cost_measure(&b->packed, p->threads, &b->progress, &all, why);
    progress_end(&b->progress);
    if (status != VIT_OK)
        return status;
    explain_effects(&b->packed, &all);
    printf("\nscene\n  %u x %u, %u frames at %g a second\n", s->width, s->height, s->frames, (double)s->fps);
    printf("  triangles %u (dropped: %llu of no area, %llu not finite, %llu not triangles), BVH nodes %u, depth %u\n",
           s->triangles, (unsigned long long)b->packed.model->degenerate, (unsigned long long)b->packed.model->not_finite,
           (unsigned long long)b->packed.model->not_triangles, s->nodes, b->packed.bvh->depth);
    printf("  surface %.4g m2 (both sides), of which %.4g m2 get no light to speak of\n", b->packed.dark_sides->area,
           b->packed.dark_sides->dark_front + b->packed.dark_sides->dark_back);
    printf("  textures %u in an atlas of %u x %u texels, %.0f %% in use\n", s->textures, p->atlas.width, p->atlas.height,
           100 * p->atlas.occupancy);
    explain_indirect(b);
    explain_lightmap(b);
    explain_cache(b);
    if (s->effects & VIT_BIT(PHOTONS))
        printf("  indirect light by photons: %u paths a frame, %u baked photons, %u bounces, radius %g m\n", s->paths, s->baked,
               s->bounces, (double)s->radius);
    if (b->packed.guiding)
        printf("  guided photons: where paths light what is seen, one stands for %.3g even ones\n", b->packed.guided_gain);
    if (s->cells > 0)
        printf("  zones and areas: %u cells, %u groups of them seen from the path, %u patches, "
               "%.4g m2 open to light; 32 zones miss %.2g %% of the weight\n",
               s->cells, b->packed.zones.receivers, b->packed.zones.patches, b->packed.zones.open_area,
               100 * b->packed.zones.wrong);
    printf(
        "\nbounds, the largest of any frame\n  hierarchy nodes %u, list entries %u, depth slices %u from %u on, key bits %u\n",
        s->max_nodes, s->max_list, s->slice_count, s->slice_first, s->key_bits);
    printf("\nbuffers\n");
    for (uint32_t i = 0; i < need.buffer_count; i++)
        printf("  %-14s %12llu  %s\n", need.buffers[i].name, (unsigned long long)need.buffers[i].bytes, need.buffers[i].effect);
    printf("\n  device bytes %llu, host bytes %zu, pack bytes %zu\n", (unsigned long long)need.device_bytes, need.host_bytes,
           b->packed.size);
    return VIT_OK;
}

static vit_status list_input(bake *b, vit_text *why) {
    scene *s = &b->pipeline.scene;
    const vit_status status = pipeline_read(b->options.input, s, why);
    return status == VIT_OK ? list_print(s, b->options.strict, b->options.json, stdout, why) : status;
}

static vit_status run(bake *b, vit_text *why) {
    if (b->options.list)
        return list_input(b, why);
    const pipeline_packed *packed = &b->packed;
    vit_status status = make_pack(b, why);
    progress_end(&b->progress);
    if (status == VIT_OK && b->options.explain)
        status = explain(b, why);
    if (status == VIT_OK) /* links may have been made meanwhile */
        status = check_against_inputs(b, why);
    if (status == VIT_OK && b->options.output)
        status = pack_save(b->options.output, packed->bytes, packed->size, why);
    if (status == VIT_OK && b->options.output)
        progress_line(&b->progress, false, "%s: %u triangles, %u frames, %.1f MB", b->options.output,
                      b->pipeline.model.triangles, packed->plan.scene.frames, (double)packed->size * 1e-6);
    return status;
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
    if (status == VIT_OK && b.options.table) {
        settings_table(stdout);
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
    if (status == VIT_OK && (fflush(stdout) != 0 || ferror(stdout)))
        status = bake_fail(&why, VIT_FAILED, "standard output: write failed");
    if (status != VIT_OK)
        fprintf(stderr, "vitrine-bake: %s\n", why.text);
    pipeline_packed_free(&b.packed);
    pipeline_free(&b.pipeline);
    return status;
}
