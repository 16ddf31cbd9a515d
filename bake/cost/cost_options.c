/* One table holds the options: parser and --help are made from it. Adding an option is adding a row. */
#include "cost/cost_options.h"
#include "common/fail.h"
#include "cost/converge.h"
#include "cost/knobs.h"
#include "common/option_text.h"
#include "cost/sweep.h"
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef enum option_kind { FLAG, WORD, WHOLE, FRAME, REAL, SIZE, ERRORS } option_kind;

typedef struct option {
    const char *name, *value; /* value: as --help writes it; NULL: a flag */
    option_kind kind;
    size_t field;       /* offset in cost_options */
    double least, most; /* numbers */
    const char *meaning;
} option;

#define AT(field) offsetof(cost_options, field)
static const option options[] = {
    {"-o", "FOLDER", WORD, AT(output), 0, 0, "writes report.csv, report.json and index.html there"},
    {"--fit", "MS", REAL, AT(fit), 1e-3, 1e6, "picks the most accurate setting whose 95th percentile fits"},
    {"--fit-work", "N", REAL, AT(fit_work), 1, 1e18, "likewise in work units of a frame: the same choice on every machine"},
    {"--by", "nmse|relmse", ERRORS, AT(relmse), 0, 0, "the error by which --fit judges (default nmse)"},
    {"--write", "SCENE.cfg", WORD, AT(write), 0, 0,
     "puts the choice into this file's quality block; the rest stays byte for byte"},
    {"--converge", "N", WHOLE, AT(converge), CONVERGE_LEAST, CONVERGE_MOST,
     "instead of trying settings: N steps with ever more photons of smaller radius; converge.csv, converge.svg"},
    {"--shrink", "E", REAL, AT(shrink), 0, 1, "of --converge: the radius goes with paths^-E (default 1/3; 0: it stays)"},
    {"--knobs", "A,B,...", WORD, AT(knobs), 0, 0, "turns only these (list below)"},
    {"--settings", "N", WHOLE, AT(settings), 1, 100000, "settings tried, at most (default 96)"},
    {"--size", "WxH", SIZE, AT(width), 0, 0, "output size instead of the scene's"},
    {"--frame", "N", FRAME, AT(frame), 0, 99999, "frame that is compared with the reference (default: the middle one)"},
    {"--every", "N", WHOLE, AT(every), 1, 4096, "compares one pixel in N x N (default: at most 60 000 pixels)"},
    {"--repeats", "N", WHOLE, AT(repeats), SWEEP_LEAST_REPEATS, 100000, "frames timed a setting, at least 7 (default 14)"},
    {"--reference-error", "E", REAL, AT(reference_error), 1e-9, 1,
     "NMSE of the reference's own error (default: a tenth of the smallest error; to choose by NMSE alone a quarter)"},
    {"--max-samples", "N", WHOLE, AT(max_samples), 16, 1 << 18, "paths a pixel of the reference, at most (default 4096)"},
    {"--cache", "FOLDER", WORD, AT(cache), 0, 0, "keeps references there (default $XDG_CACHE_HOME/vitrine, ~/.cache/vitrine)"},
    {"--no-cache", NULL, FLAG, AT(no_cache), 0, 0, "keeps none"},
    {"--memory", "MIB", WHOLE, AT(memory), 1, 1 << 24,
     "for packs, and for what is open at once (default: a quarter of the machine's)"},
    {"--threads", "N", WHOLE, AT(threads), 0, 1024, "of baker and reference (default 0: all cores); changes no bit"},
    {"--device", "NAME|N", WORD, AT(device), 0, 0,
     "plays what is timed: an OpenCL device, as vitrine-play takes it, or host (default OpenCL's first, "
     "or host if there is none)"},
    {"--strict", NULL, FLAG, AT(strict), 0, 0,
     "a missing texture, or a material of the scene file that no mesh has, is an error, not a warning"},
    {"--quiet", NULL, FLAG, AT(quiet), 0, 0, "warnings and errors only"},
    {"--version", NULL, FLAG, AT(version), 0, 0, ""},
    {"--help", NULL, FLAG, AT(help), 0, 0, ""},
};
enum { OPTIONS = sizeof options / sizeof options[0] };

static vit_status usage(vit_text *why, const char *name, const char *wants) {
    return bake_fail_plain(why, VIT_USAGE, "%.100s: %s (try --help)", name, wants);
}

static bool read_number(const char *text, bool whole, const option *row, double *out) {
    return option_number(text, row->least, row->most, out) && (!whole || *out == floor(*out));
}

/* False: `value` is not what the row takes. */
static bool set(const option *row, const char *value, cost_options *o) {
    void *to = (char *)o + row->field;
    double number = 0;
    bool fine = true;
    switch (row->kind) {
    case FLAG:
        *(bool *)to = true;
        break;
    case WORD:
        *(const char **)to = value;
        return value[0] != '\0' && strcmp(value, "-") != 0; /* files and folders, which "-" is none of, and names of knobs */
    case WHOLE:
        fine = read_number(value, true, row, &number);
        *(uint32_t *)to = fine ? (uint32_t)number : 0;
        break;
    case FRAME:
        fine = read_number(value, true, row, &number);
        *(int64_t *)to = fine ? (int64_t)number : 0;
        break;
    case REAL:
        return read_number(value, row->field == AT(fit_work), row, to);
    case SIZE:
        return option_size(value, &o->width, &o->height);
    case ERRORS:
        *(bool *)to = strcmp(value, "relmse") == 0;
        return *(bool *)to || strcmp(value, "nmse") == 0;
    }
    return fine;
}

static void describe(const option *row, char *text, size_t room) {
    if (row->kind == WHOLE || row->kind == REAL || row->kind == FRAME)
        (void)snprintf(text, room, "a %snumber, %g to %g", row->kind == REAL && row->field != AT(fit_work) ? "" : "whole ",
                       row->least, row->most);
    else
        (void)snprintf(text, room, "wants %s", row->value);
}

static vit_status check(const cost_options *o, vit_text *why) {
    if (o->help || o->version)
        return VIT_OK;
    if (!o->input)
        return usage(why, "no input", "which scene or mesh?");
    if (o->fit > 0 && o->fit_work > 0)
        return usage(why, "--fit-work", "one budget at a time, not --fit as well");
    if (o->write && !(o->fit > 0) && !(o->fit_work > 0))
        return usage(why, "--write", "there is no choice to write without --fit or --fit-work");
    if (o->converge && (!o->output || o->fit > 0 || o->fit_work > 0 || o->knobs))
        return usage(why, "--converge", "goes with -o FOLDER, and without --fit, --fit-work and --knobs");
    if (!o->output && !(o->fit > 0) && !(o->fit_work > 0))
        return usage(why, o->input, "what for? -o FOLDER for a report, or --fit MS");
    return VIT_OK;
}

vit_status cost_options_parse(int argc, char **argv, cost_options *out, vit_text *why) {
    *out = (cost_options){.settings = SWEEP_SETTINGS,
                          .shrink = CONVERGE_SHRINK,
                          .repeats = SWEEP_REPEATS,
                          .max_samples = SWEEP_SAMPLES,
                          .frame = -1};
    for (int i = 1; i < argc; i++) {
        char wants[128];
        int k = 0;
        if (argv[i][0] != '-') {
            if (out->input)
                return usage(why, argv[i], "one scene at a time");
            out->input = argv[i];
            continue;
        }
        if (strcmp(argv[i], "-") == 0)
            return usage(why, "-", "a scene or mesh is read from a file, not from standard input");
        const option_words w = option_split(argv[i], i + 1 < argc ? argv[i + 1] : NULL);
        const char *name = strcmp(w.name, "-h") == 0 ? "--help" : strcmp(w.name, "--output") == 0 ? "-o" : w.name;
        while (k < OPTIONS && strcmp(options[k].name, name) != 0)
            k++;
        if (k == OPTIONS)
            return usage(why, w.name, "unknown option");
        const bool alone = options[k].kind == FLAG;
        describe(&options[k], wants, sizeof wants);
        if (alone && w.joined)
            return usage(why, name, "takes no value");
        if ((!alone && !w.value) || !set(&options[k], alone ? "" : w.value, out))
            return usage(why, name, wants);
        i += !alone && !w.joined;
    }
    return check(out, why);
}

void cost_options_help(void) {
    puts("vitrine-cost: what accuracy costs in time, for one scene. Tries many settings of the quality block, compares each "
         "with a\n"
         "path-traced reference, times them in turns and counts their work.\n"
         "\n"
         "  vitrine-cost scene.cfg -o report                          the whole price list; open report/index.html\n"
         "  vitrine-cost scene.cfg -o report --knobs photons,radius --size 640x360\n"
         "  vitrine-cost scene.cfg --fit 33 --write scene.cfg         the best setting for 33 ms a frame on this device\n"
         "  vitrine-cost scene.cfg --converge 6 -o report             does the error go to 0 with more photons, and how fast?\n"
         "  mpirun -n 8 vitrine-cost scene.cfg -o report              all ranks make the reference; rank 0 does the rest\n");
    for (int i = 0; i < OPTIONS; i++) {
        char both[64];
        (void)snprintf(both, sizeof both, "%s %s", options[i].name, options[i].value ? options[i].value : "");
        printf("  %-22s%s%s\n", both, options[i].meaning[0] ? "  " : "", options[i].meaning);
    }
    puts("\nKnobs:");
    knobs_help();
    puts("\nExit codes:");
#define X(name, value, meaning) printf("  %d  %s\n", value, meaning);
    VIT_STATUSES(X)
#undef X
}
