#include "options.h"
#include "common/fail.h"
#include "pack/effects.h"
#include "scene/fields.h"
#include "common/option_text.h"
#include "scene/setting_rows.h"
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static vit_status usage(vit_text *why, const char *option, const char *wants) {
    return bake_fail_plain(why, VIT_USAGE, "%.100s: %.300s (try --help)", option, wants);
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
    } flags[] = {
        {"--explain", &o->explain},   {"--strict", &o->strict}, {"--quiet", &o->quiet}, {"--all-formats", &o->all_formats},
        {"--no-check", &o->no_check}, {"--list", &o->list},     {"--json", &o->json},   {"--settings", &o->table},
        {"--version", &o->version},   {"--help", &o->help},     {"-h", &o->help}};
    for (size_t i = 0; i < sizeof flags / sizeof flags[0]; i++)
        if (strcmp(name, flags[i].name) == 0)
            return *flags[i].to = true;
    return false;
}

/* Options of the quality settings. --zones 2 is both kinds of zones. */
static bool quality_setting(const char *name, const char *value, options *o, bool *known, vit_text *wants) {
    const setting_row *s = strncmp(name, "--", 2) == 0 ? settings_named(name + 2, strlen(name + 2)) : NULL;
    scene_quality scratch = settings_default;
    *known = s != NULL;
    if (!s)
        return false;
    const bool zones = s == &setting_rows[SETTING_AT_zones], both = zones && value && strcmp(value, "2") == 0;
    settings_wants(s, wants->text, sizeof wants->text);
    if (zones)
        o->settings[SETTING_AT_light_zones] = both ? "1" : "0";
    o->settings[s - setting_rows] = both ? "1" : value;
    return both || settings_put(s, value, &scratch);
}

/* Options with a value; false with *known: the value is wrong, `wants` says what would be right. */
static bool valued(const char *name, const char *value, options *o, bool *known, vit_text *wants) {
    const char *want = NULL;
    bool good = false;
    long n = 0;
    *known = true;
    if (strcmp(name, "-o") == 0 || strcmp(name, "--output") == 0) {
        want = "a file to write; - is none, since a pack is put in place whole (./- is one)";
        good = file_of(value, &o->output);
    } else if (strcmp(name, "--threads") == 0) {
        want = "a number of threads, 0 to 1024";
        good = option_whole(value, 0, 1024, &n);
        o->threads = (unsigned)n;
    } else if (strcmp(name, "--device") == 0) {
        want = "a number or a part of a name of vitrine-play --list-devices, gpu, cpu or host";
        good = (o->device = value) != NULL && value[0] != '\0' && value[0] != '-';
    } else if (strcmp(name, "--size") == 0) {
        want = "WIDTHxHEIGHT, up to 7680x4320";
        good = option_size(value, &o->width, &o->height);
    } else if (strcmp(name, "--frames") == 0) {
        want = "a number of frames, 1 to 100000";
        good = option_whole(value, 1, 100000, &n);
        o->frames = (int)n;
    } else if (strcmp(name, "--fit") == 0) {
        want = "milliseconds a frame";
        good = budget_of(value, &o->fit);
    } else if (strcmp(name, "--fit-work") == 0) {
        want = "work units a frame, a whole number";
        good = budget_of(value, &o->fit_work) && o->fit_work == floor(o->fit_work);
    } else if (strcmp(name, "--exposure") == 0) {
        want = "a factor on radiance, or auto";
        good = exposure_of(value, o);
    } else if (strcmp(name, "--quality") == 0) {
        want = "auto or stated";
        good = one_of(value, "auto", "stated", &o->quality);
    } else if (strcmp(name, "--effects") == 0) {
        want = "auto, all, none, or names with commas between (bake/README.md lists them)";
        good = effects_of(value, o);
    } else {
        good = quality_setting(name, value, o, known, wants);
    }
    if (want)
        (void)snprintf(wants->text, sizeof wants->text, "%s", want);
    return good;
}

vit_status options_parse(int argc, char **argv, options *out, vit_text *why) {
    *out = (options){0};
    for (int i = 1; i < argc; i++) {
        vit_text wants = {""};
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
                return usage(why, w.name, known ? wants.text : "unknown option");
            i += !w.joined;
        }
    }
    if (out->table && (out->list || out->input))
        return usage(why, "--settings", "goes alone");
    if (out->help || out->version || out->table)
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
    if (o->width) {
        s->width = o->width;
        s->height = o->height;
    }
    s->frames = o->frames ? o->frames : s->frames;
    s->check = s->check && !o->no_check;
    s->exposure_auto = o->exposure_given ? !(o->exposure > 0) : s->exposure_auto;
    s->exposure_fixed = o->exposure;
    s->quality_auto = o->quality ? strcmp(o->quality, "auto") == 0 : s->quality_auto;
    for (int i = 0; i < SETTINGS; i++)
        if (o->settings[i] && settings_put(&setting_rows[i], o->settings[i], &s->quality))
            s->quality_kept |= (uint64_t)1 << i;
    vit_text fault;
    if (!settings_agree(&s->quality, &fault))
        return usage(why, "with these options", fault.text);
    if (o->settings[SETTING_AT_flatten] && !s->quality.flattened)
        return usage(why, "--flatten", "needs --kernel flattened");
    if (o->effects_given) {
        s->effects_choice = o->effects_choice;
        s->effects = o->effects;
    }
    return VIT_OK;
}

void options_help(void) {
    puts(
        "vitrine-bake: turns a scene into one packed file that vitrine-play plays.\n"
        "\n"
        "  vitrine-bake scene.cfg -o scene.vit      bake a scene file (bake/README.md has its grammar)\n"
        "  vitrine-bake model.glb -o model.vit      any mesh: framed by its box, turning camera, one moving light\n"
        "  vitrine-bake scene.cfg --explain         bake, write nothing, say what: effects and why, every buffer, total bytes\n"
        "  vitrine-bake scene.cfg --fit 33 -o s.vit   the best quality that plays at 30 frames a second here\n"
        "\n"
        "  -o, --output FILE     the pack; written under another name first, so there is never half a pack; never a file that "
        "is read\n"
        "  --explain             effects with what each adds in bytes and work, bounds, buffers; with -o the pack is written "
        "too\n"
        "  --list[=json]         bakes nothing: meshes, materials, textures, lights and their units, cameras, who reads the "
        "files, extensions,\n"
        "                        what is not done\n"
        "  --strict              a missing texture, what a mesh file says and is not done, a material of the scene file that "
        "no mesh has,\n"
        "                        a setting of the cache or the lightmap that does nothing, is an error, not a warning\n"
        "  --all-formats         golden hashes of RGB565 and RGBA32F frames too\n"
        "  --no-check            does not compare the picture with path tracing (else seconds), and so chooses no quality "
        "either\n"
        "  --quality auto        chooses the settings that --settings marks with * by that check, but for what the scene "
        "file or an option\n"
        "                        states; the default where there is no quality block. stated: what is stated, and defaults\n"
        "  --fit MS              tries many settings (as vitrine-cost does) and bakes the most accurate one whose frames take "
        "at most MS\n"
        "                        milliseconds (95th percentile) on this device; prints what it chose from\n"
        "  --fit-work N          likewise in work units of a frame: the same choice on every machine\n"
        "  --threads N           of the baker and the device host (default: all cores); changes no byte\n"
        "  --device NAME|N       measures bounds and hashes: an OpenCL device, as vitrine-play takes it, or host (the default, "
        "which has no\n"
        "                        kernels to compile); changes no byte. With --fit: plays what is timed (default 0, or host if\n"
        "                        there is no OpenCL)\n"
        "  --settings            the settings of a quality block, their values, defaults and meaning, as a Markdown table\n"
        "  --quiet               warnings and errors only\n"
        "  --version, --help     every --option VALUE may be written --option=VALUE\n"
        "\n"
        "Instead of what the scene file says:\n"
        "  --size WxH  --frames N  --exposure N|auto\n"
        "  --effects auto|all|none|NAME,NAME...   of mirror, glass, antialias and so on; the rest is left out\n"
        "Instead of what its quality block says (and its default):");
    settings_help();
    puts("\nExit codes:");
#define X(name, value, meaning) printf("  %d  %s\n", value, meaning);
    VIT_STATUSES(X)
#undef X
}
