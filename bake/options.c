#include "options.h"
#include "effects.h"
#include "fields.h"
#include "option_text.h"
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static vit_status usage(vit_text *why, const char *option, const char *wants) {
    snprintf(why->text, sizeof why->text, "%.100s: %s (try --help)", option, wants);
    for (char *c = why->text; *c; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f)
            *c = '?';
    return VIT_USAGE;
}

static bool radius_of(const char *text, options *o) {
    o->radius_given = true;
    o->radius = 0;
    if (text && strcmp(text, "auto") == 0)
        return true;
    return option_number(text, 0, 1e9, &o->radius) && o->radius > 0;
}

static bool exposure_of(const char *text, options *o) {
    o->exposure_given = true;
    o->exposure = 0;
    if (text && strcmp(text, "auto") == 0)
        return true;
    return option_number(text, 0, 1e9, &o->exposure) && o->exposure > 0;
}

/* A positive number. */
static bool budget_of(const char *text, double *out) {
    return option_number(text, 0, 1e18, out) && *out > 0;
}

/* "-" would be standard output, and a pack is renamed into place. */
static bool file_of(const char *text, const char **out) {
    *out = text;
    return text && *text && strcmp(text, "-") != 0;
}

static bool effects_of(const char *text, options *o) {
    o->effects_given = true;
    o->effects = 0;
    o->effects_choice = fields_place(SCENE_EFFECTS, text ? text : "");
    if (o->effects_choice >= 0)
        return true;
    o->effects_choice = EFFECTS_LISTED;
    if (!text || strcmp(text, "none") == 0)
        return text != NULL;
    for (size_t length; *text; text += length + (text[length] == ',')) {
        char name[32];
        length = strcspn(text, ",");
        snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : sizeof name - 1), text);
        if (!(effects_named(name) & EFFECTS_NAMED) || (text[length] == ',' && text[length + 1] == 0))
            return false;
        o->effects |= effects_named(name);
    }
    return o->effects != 0;
}

static bool one_of(const char *text, const char *a, const char *b, const char **out) {
    *out = text;
    return text && (strcmp(text, a) == 0 || strcmp(text, b) == 0);
}

/* Options that are words alone. */
static bool flag(const char *name, options *o) {
    const struct {
        const char *name;
        bool *to;
    } flags[] = {{"--explain", &o->explain},  {"--strict", &o->strict}, {"--quiet", &o->quiet}, {"--all-formats", &o->all_formats}, {"--no-check", &o->no_check},
                 {"--list", &o->list}, {"--json", &o->json}, {"--version", &o->version}, {"--help", &o->help},     {"-h", &o->help}};
    for (size_t i = 0; i < sizeof flags / sizeof flags[0]; i++)
        if (strcmp(name, flags[i].name) == 0)
            return *flags[i].to = true;
    return false;
}

/* Options that take one of a few numbers. */
static bool among(const char *name, const char *value, options *o, bool *known, const char **wants) {
    const struct {
        const char *name, *list, *wants;
        int *to;
    } lists[] = {{"--indirect-samples", SCENE_INDIRECT_SAMPLES, "1, 4 or 16", &o->indirect_samples},
                 {"--vertex-bits", SCENE_VERTEX_BITS, "32 or 16", &o->vertex_bits},
                 {"--normal-bits", SCENE_NORMAL_BITS, "16 or 8", &o->normal_bits},
                 {"--sample-bits", SCENE_SAMPLE_BITS, "32 or 16", &o->sample_bits},
                 {"--antialias", SCENE_ANTIALIAS, "1, 2, 4, 8 or 16", &o->antialias}};
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++)
        if (strcmp(name, lists[i].name) == 0) {
            *known = true;
            *wants = lists[i].wants;
            long number = 0;
            if (fields_place(lists[i].list, value) < 0 || !option_whole(value, 0, INT_MAX, &number))
                return false;
            *lists[i].to = (int)number;
            return true;
        }
    return *known = false;
}

/* Options with a value; false with *known: the value is wrong, `wants` says what would be right. */
static bool valued(const char *name, const char *value, options *o, bool *known, const char **wants) {
    const struct {
        const char *name;
        int *to;
        long least, most;
        const char *wants;
    } numbers[] = {{"--frames", &o->frames, 1, 100000, "a number of frames, 1 to 100000"},
                   {"--photons", &o->photons, 0, 1000000, "a number of photon paths, 0 to 1000000"},
                   {"--bounces", &o->bounces, 1, 32, "1 to 32"},
                   {"--tile", &o->tile, 8, 64, "8, 16, 32 or 64"},
                   {"--normal-keys", &o->normal_keys, 0, 1, "0 or 1"},
                   {"--zones", &o->zones, 0, 2, "0, 1, or 2 to part unlike lit surfaces too"},
                   {"--effective-area", &o->effective_area, 0, 1, "0 or 1"},
                   {"--guiding", &o->guiding, 0, 1, "0 or 1"},
                   {"--bounce-sequence", &o->bounce_sequence, 0, 1, "0 or 1"},
                   {"--light-samples", &o->light_samples, 1, 1024, "1 to 1024"},
                   {"--sky-samples", &o->sky_samples, 1, 1024, "1 to 1024"},
                   {"--specular-depth", &o->specular_depth, 1, 32, "1 to 32"},
                   {"--caustics", &o->caustics, 0, 1, "0 or 1"}};
    long n = 0;
    *known = true;
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        if (strcmp(name, numbers[i].name) == 0) {
            *wants = numbers[i].wants;
            bool good = option_whole(value, numbers[i].least, numbers[i].most, &n);
            *numbers[i].to = (int)n;
            return good;
        }
    if (strcmp(name, "-o") == 0 || strcmp(name, "--output") == 0)
        return *wants = "a file to write; - is none, since a pack is put in place whole (./- is one)", file_of(value, &o->output);
    if (strcmp(name, "--threads") == 0 && (*wants = "a number of threads, 0 to 1024")) {
        bool good = option_whole(value, 0, 1024, &n);
        o->threads = (unsigned)n;
        return good;
    }
    if (strcmp(name, "--device") == 0) {
        *wants = "a number or a part of a name of vitrine-play --list-devices, gpu, cpu or host";
        return (o->device = value) != NULL && value[0] != '\0' && value[0] != '-';
    }
    if (strcmp(name, "--size") == 0)
        return *wants = "WIDTHxHEIGHT, up to 7680x4320", option_size(value, &o->width, &o->height);
    if (strcmp(name, "--fit") == 0)
        return *wants = "milliseconds a frame", budget_of(value, &o->fit);
    if (strcmp(name, "--fit-work") == 0)
        return *wants = "work units a frame, a whole number", budget_of(value, &o->fit_work) && o->fit_work == floor(o->fit_work);
    if (strcmp(name, "--radius") == 0)
        return *wants = "metres, or auto", radius_of(value, o);
    if (strcmp(name, "--exposure") == 0)
        return *wants = "a factor on radiance, or auto", exposure_of(value, o);
    if (strcmp(name, "--quality") == 0)
        return *wants = "auto or stated", one_of(value, "auto", "stated", &o->quality);
    if (strcmp(name, "--estimate") == 0)
        return *wants = "list or buckets", one_of(value, "list", "buckets", &o->estimate);
    if (strcmp(name, "--smoothing") == 0)
        return *wants = "interpolated or raw", one_of(value, "interpolated", "raw", &o->smoothing);
    if (strcmp(name, "--kernel") == 0)
        return *wants = "sphere or flattened", one_of(value, "sphere", "flattened", &o->kernel);
    if (strcmp(name, "--antialias-filter") == 0)
        return *wants = "box or tent", one_of(value, "box", "tent", &o->antialias_filter);
    if (strcmp(name, "--antialias-contrast") == 0)
        return *wants = "0 to 1", option_number(value, 0, 1, &o->antialias_contrast);
    if (strcmp(name, "--effects") == 0)
        return *wants = "auto, all, none, or names with commas between (bake/README.md lists them)", effects_of(value, o);
    if (strcmp(name, "--texture-filter") == 0)
        return *wants = "nearest, bilinear or trilinear", o->texture_filter = value, fields_place(SCENE_FILTERS, value) >= 0;
    return among(name, value, o, known, wants);
}

vit_status options_parse(int argc, char **argv, options *out, vit_text *why) {
    *out = (options){.photons = -1, .normal_keys = -1, .zones = -1, .effective_area = -1, .guiding = -1, .bounce_sequence = -1,
                     .caustics = -1, .antialias_contrast = -1};
    for (int i = 1; i < argc; i++) {
        const char *wants = "";
        bool known;
        const option_words w = option_split(argv[i], i + 1 < argc ? argv[i + 1] : NULL);
        if (argv[i][0] != '-') {
            if (out->input)
                return usage(why, argv[i], "one scene at a time");
            out->input = argv[i];
        } else if (strcmp(argv[i], "-") == 0) {
            return usage(why, "-", "a scene or mesh is read from a file, not from standard input");
        } else if (flag(w.name, out)) {
            if (w.joined && out->list && strcmp(w.name, "--list") == 0 && strcmp(w.value, "json") == 0)
                out->json = true;
            else if (w.joined)
                return usage(why, w.name, strcmp(w.name, "--list") == 0 ? "alone, or --list=json" : "takes no value");
        } else {
            if (!valued(w.name, w.value, out, &known, &wants))
                return usage(why, w.name, known ? wants : "unknown option");
            i += !w.joined;
        }
    }
    if (out->help || out->version)
        return VIT_OK;
    if (!out->input)
        return usage(why, "no input", "which scene or mesh?");
    if (out->fit > 0 && out->fit_work > 0)
        return usage(why, "--fit-work", "one budget at a time, not --fit as well");
    if (out->json && !out->list)
        return usage(why, "--json", "is for --list");
    if (out->list && (out->output || out->explain || out->fit > 0 || out->fit_work > 0))
        return usage(why, "--list", "goes without -o, --explain and --fit: nothing is baked");
    if (!out->output && !out->explain && !out->list)
        return usage(why, out->input, "where to? -o FILE.vit, or --explain, or --list");
    return VIT_OK;
}

vit_status options_apply(const options *o, scene *s, vit_text *why) {
    scene_quality *q = &s->quality;
    if (o->width) {
        s->width = o->width;
        s->height = o->height;
    }
    s->frames = o->frames ? o->frames : s->frames;
    s->check = s->check && !o->no_check;
    s->exposure_auto = o->exposure_given ? !(o->exposure > 0) : s->exposure_auto;
    s->exposure_fixed = o->exposure;
    s->quality_auto = o->quality ? strcmp(o->quality, "auto") == 0 : s->quality_auto;
    s->quality_kept |= (o->photons >= 0 ? QUALITY_KEPT_PHOTONS : 0u) | (o->bounces ? QUALITY_KEPT_BOUNCES : 0u) |
                       (o->radius_given ? QUALITY_KEPT_RADIUS : 0u) | (o->zones >= 0 ? QUALITY_KEPT_ZONES | QUALITY_KEPT_LIGHT_ZONES : 0u) |
                       (o->effective_area >= 0 ? QUALITY_KEPT_AREA : 0u) | (o->guiding >= 0 ? QUALITY_KEPT_GUIDING : 0u) | (o->light_samples ? QUALITY_KEPT_LIGHT_SAMPLES : 0u) |
                       (o->sky_samples ? QUALITY_KEPT_SKY_SAMPLES : 0u);
    q->photons = o->photons >= 0 ? o->photons : q->photons;
    q->bounces = o->bounces ? o->bounces : q->bounces;
    q->tile = o->tile ? o->tile : q->tile;
    q->radius = o->radius_given ? o->radius : q->radius;
    q->buckets = o->estimate ? strcmp(o->estimate, "buckets") == 0 : q->buckets;
    q->raw = o->smoothing ? strcmp(o->smoothing, "raw") == 0 : q->raw;
    if (o->kernel)
        q->flatten = strcmp(o->kernel, "sphere") == 0 ? 0 : q->flatten > 0 ? q->flatten : 15;
    q->normal_keys = o->normal_keys >= 0 ? o->normal_keys != 0 : q->normal_keys;
    if (o->zones >= 0) {
        q->zones = o->zones > 0;
        q->light_zones = o->zones > 1;
    }
    q->effective_area = o->effective_area >= 0 ? o->effective_area != 0 : q->effective_area;
    q->guiding = o->guiding >= 0 ? o->guiding != 0 : q->guiding;
    q->bounce_sequence = o->bounce_sequence >= 0 ? o->bounce_sequence != 0 : q->bounce_sequence;
    q->indirect_samples = o->indirect_samples ? o->indirect_samples : q->indirect_samples;
    q->vertex_bits = o->vertex_bits ? o->vertex_bits : q->vertex_bits;
    q->normal_bits = o->normal_bits ? o->normal_bits : q->normal_bits;
    q->sample_bits = o->sample_bits ? o->sample_bits : q->sample_bits;
    q->texture_filter = o->texture_filter ? fields_place(SCENE_FILTERS, o->texture_filter) : q->texture_filter;
    q->antialias = o->antialias ? o->antialias : q->antialias;
    q->antialias_contrast = o->antialias_contrast >= 0 ? o->antialias_contrast : q->antialias_contrast;
    q->tent = o->antialias_filter ? strcmp(o->antialias_filter, "tent") == 0 : q->tent;
    q->light_samples = o->light_samples ? o->light_samples : q->light_samples;
    q->sky_samples = o->sky_samples ? o->sky_samples : q->sky_samples;
    q->specular_depth = o->specular_depth ? o->specular_depth : q->specular_depth;
    q->caustics = o->caustics >= 0 ? o->caustics != 0 : q->caustics;
    if (o->effects_given) {
        s->effects_choice = o->effects_choice;
        s->effects = o->effects;
    }
    if (q->tile != 8 && q->tile != 16 && q->tile != 32 && q->tile != 64)
        return usage(why, "--tile", "8, 16, 32 or 64");
    return VIT_OK;
}

void options_help(void) {
    puts("vitrine-bake: turns a scene into one packed file that vitrine-play plays.\n"
         "\n"
         "  vitrine-bake scene.cfg -o scene.vit      bake a scene file (bake/README.md has its grammar)\n"
         "  vitrine-bake model.glb -o model.vit      any mesh: framed by its box, turning camera, one moving light\n"
         "  vitrine-bake scene.cfg --explain         bake, write nothing, say what: effects and why, every buffer, total bytes\n"
         "  vitrine-bake scene.cfg --fit 33 -o s.vit   the best quality that plays at 30 frames a second here\n"
         "\n"
         "  -o, --output FILE     the pack; written under another name first, so there is never half a pack; never a file that is read\n"
         "  --explain             effects with what each adds in bytes and work, bounds, buffers; with -o the pack is written too\n"
         "  --list[=json]         bakes nothing: meshes, materials, textures, lights and their units, cameras, extensions, what is not done\n"
         "  --strict              a missing texture, a material of the scene file that no mesh has, is an error, not a warning\n"
         "  --all-formats         golden hashes of RGB565 and RGBA32F frames too\n"
         "  --no-check            does not compare the picture with path tracing (else seconds), and so chooses no quality either\n"
         "  --quality auto        chooses zones, areas, radius, photons, bounces and samples by that check, but for what the scene file or an\n"
         "                        option states; the default where there is no quality block. stated: what is stated, and defaults\n"
         "  --fit MS              tries many settings (as vitrine-cost does) and bakes the most accurate one whose frames take at most MS\n"
         "                        milliseconds (95th percentile) on this device; prints what it chose from\n"
         "  --fit-work N          likewise in work units of a frame: the same choice on every machine\n"
         "  --threads N           of the baker and the device host (default: all cores); changes no byte\n"
         "  --device NAME|N       measures bounds and hashes: an OpenCL device, as vitrine-play takes it, or host (the default, which has no\n"
         "                        kernels to compile); changes no byte. With --fit: plays what is timed (default 0, or host if\n"
         "                        there is no OpenCL)\n"
         "  --quiet               warnings and errors only\n"
         "  --version, --help     every --option VALUE may be written --option=VALUE\n"
         "\n"
         "Instead of what the scene file says:\n"
         "  --size WxH  --frames N  --photons N  --bounces N  --radius M|auto  --tile N  --estimate list|buckets\n"
         "  --smoothing interpolated|raw  --kernel sphere|flattened  --normal-keys 0|1  --indirect-samples 1|4|16\n"
         "  --texture-filter nearest|bilinear|trilinear  --zones 0|1|2  --effective-area 0|1  --guiding 0|1  --bounce-sequence 0|1\n"
         "  --vertex-bits 32|16  --normal-bits 16|8  --sample-bits 32|16  --light-samples N  --sky-samples N\n"
         "  --antialias 1|2|4|8|16  --antialias-contrast 0..1  --antialias-filter box|tent  --specular-depth N  --caustics 0|1  --exposure N|auto\n"
         "  --effects auto|all|none|NAME,NAME...   of mirror, glass, antialias and so on; the rest is left out\n"
         "\n"
         "Exit codes:");
#define X(name, value, meaning) printf("  %d  %s\n", value, meaning);
    VIT_STATUSES(X)
#undef X
}
