/* converge.csv, converge.svg, and the table. */
#include "cost/converge.h"
#include "common/fail.h"
#include "report/report_parts.h"
#include <math.h>
#include <stddef.h>
#include <stdlib.h>

enum { WIDE = 720, HIGH = 480, NAME = 48 /* characters */ };

static vit_status print_csv(const void *results, FILE *to, vit_text *why) {
    const converge_results *r = results;
    (void)why;
    (void)fputs("what,paths,radius,nmse,indirect_nmse,relmse,bias,radius_nmse,photons_nmse,ms,ms_mad\n", to);
    for (uint32_t i = 0; i < r->count; i++) {
        const converge_step *s = &r->steps[i];
        const double columns[] = {s->radius,       s->total.nmse,           s->indirect,
                                  s->total.relmse, s->total.bias,           s->blur,
                                  s->noise,        s->ms > 0 ? s->ms : NAN, s->ms > 0 ? s->ms_mad : NAN};
        (void)fprintf(to, "step,%u", s->paths);
        for (size_t k = 0; k < sizeof columns / sizeof columns[0]; k++) {
            (void)fputc(',', to);
            text_number(to, columns[k], "");
        }
        (void)fputc('\n', to);
    }
    const struct {
        const char *name;
        double nmse, relmse, bias;
    } rest[] = {{"bounce limit", r->truncation.nmse, r->truncation.relmse, r->truncation.bias},
                {"geometric normals", r->normals.nmse, r->normals.relmse, r->normals.bias},
                {"direct light", r->direct, NAN, NAN},
                {"reference", r->own, NAN, NAN}};
    for (size_t i = 0; i < sizeof rest / sizeof rest[0]; i++) {
        (void)fprintf(to, "%s,,,", rest[i].name);
        text_number(to, rest[i].nmse, "");
        (void)fputs(",,", to);
        text_number(to, rest[i].relmse, "");
        (void)fputc(',', to);
        text_number(to, rest[i].bias, "");
        (void)fputs(",,,,\n", to);
    }
    return VIT_OK;
}

/* One block of data a series; gnuplot wants a point in each. */
static void print_series(const converge_results *r, const char *name, size_t field, FILE *to) {
    (void)fprintf(to, "$%s << EOD\nNaN NaN\n", name);
    for (uint32_t i = 0; i < r->count; i++) {
        const double y = *(const double *)(const void *)((const char *)&r->steps[i] + field);
        if (y > 0)
            (void)fprintf(to, "%u %.9g\n", r->steps[i].paths, y);
    }
    (void)fputs("EOD\n", to);
}

static report_axis axis_of(const converge_results *r, bool errors) {
    double values[3 * CONVERGE_MOST] = {0};
    report_axis a = {0.1, 10};
    for (uint32_t i = 0; i < r->count; i++) {
        const converge_step *s = &r->steps[i];
        values[3 * i] = errors ? s->total.nmse : s->paths;
        values[3 * i + 1] = errors ? s->blur : s->paths;
        values[3 * i + 2] = errors ? s->noise : s->paths;
    }
    (void)report_axis_of(values, 3 * r->count, errors ? 0.08 : 0.05, errors ? 0.3 : 0.05, &a);
    return a;
}

static void print_script(const converge_results *r, FILE *to) {
    char law[48] = "";
    if (isfinite(r->blur.slope))
        (void)snprintf(law, sizeof law, " (~ radius^%.2f)", r->blur.slope);
    (void)fprintf(
        to,
        "set border 3 lc rgb '#0101%02x'\nset tics nomirror scale 0.6,0.3\nset grid x y lt 1 lw 0.6 lc rgb '#0101%02x'\n"
        "set object 1 rectangle from screen 0,0 to screen 1,1 fc rgb 'white' fs solid noborder behind\n"
        "set key top right reverse Left samplen 2 tc rgb '#0101%02x'\nset title ",
        SOFT, GRID, INK);
    text_gnuplot(to, r->scene, 60);
    (void)fprintf(to, " tc rgb '#0101%02x'\n", INK);
    report_axis_print(to, "x", axis_of(r, false), "photon paths");
    report_axis_print(to, "y", axis_of(r, true), "NMSE of the total light");
    print_series(r, "error", offsetof(converge_step, total.nmse), to);
    print_series(r, "blur", offsetof(converge_step, blur), to);
    print_series(r, "noise", offsetof(converge_step, noise), to);
    (void)fprintf(
        to,
        "plot %.9g * x ** %.9g lw 1.6 lc rgb '#0101%02x' title 'slope %.3f ± %.3f', "
        "$error with points pt 7 ps 1 lc rgb '#0101%02x' title 'error against the reference, radius ~ paths^-%.2f', "
        "$noise with linespoints pt 6 ps 0.8 lw 1 lc rgb '#0101%02x' title 'of which more photons remove (slope %.2f)', "
        "$blur with linespoints pt 4 ps 0.8 lw 1 lc rgb '#0101%02x' title 'of which the radius leaves%s'\n",
        r->error.at_one, r->error.slope, FRONT, r->error.slope, r->error.slope_error, FRONT, r->shrink, TRACER, r->noise.slope,
        DEFAULT, law);
}

static vit_status print_svg(const void *results, FILE *to, vit_text *why) {
    static const report_drawing drawing = {.id = "converge",
                                           .alt = "Error against photon paths, both axes logarithmic",
                                           .width = WIDE,
                                           .height = HIGH,
                                           .alone = true};
    char *script = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&script, &size);
    if (f)
        print_script(results, f);
    if (!f || fclose(f) != 0 || !script) {
        return bake_fail(why, VIT_FAILED, "converge.svg: out of memory");
    }
    const vit_status status = report_gnuplot(&drawing, script, to, why);
    free(script);
    return status;
}

static const struct {
    const char *name;
    report_part_fn *part;
} files[] = {{"converge.csv", print_csv}, {"converge.svg", print_svg}};
enum { FILES = sizeof files / sizeof files[0] };

const char *converge_name(uint32_t index) {
    return index < FILES ? files[index].name : NULL;
}

vit_status converge_write(const converge_results *r, const char *folder, vit_text *why) {
    vit_status status = report_folder(folder, why);
    for (int i = 0; i < FILES && status == VIT_OK; i++)
        status = report_file(r, folder, files[i].name, files[i].part, why);
    return status;
}

static void print_steps(const converge_results *r, FILE *to) {
    (void)fprintf(to, "%9s %9s %10s %10s %10s %8s %12s %12s %9s\n", "paths", "radius m", "NMSE", "indirect", "relMSE", "bias %",
                  "of radius", "of photons", "ms");
    for (uint32_t i = 0; i < r->count; i++) {
        const converge_step *s = &r->steps[i];
        (void)fprintf(to, "%9u %9.4g %10.3g %10.3g %10.3g %+8.2f %12.3g %12.3g ", s->paths, s->radius, s->total.nmse,
                      s->indirect, s->total.relmse, 100 * s->total.bias, s->blur, s->noise);
        if (s->ms > 0)
            (void)fprintf(to, "%9.1f\n", s->ms);
        else
            (void)fprintf(to, "%9s\n", "-");
    }
}

static void print_slope(const char *name, const converge_line *l, FILE *to) {
    (void)fprintf(to, "  %-*s slope %+.3f, standard error %.3f\n", NAME, name, l->slope, l->slope_error);
}

static void print_part(const char *name, const cost_error *e, FILE *to) {
    (void)fprintf(to, "  %-*s %.3g, bias %+.2f %%\n", NAME, name, e->nmse, 100 * e->bias);
}

void converge_print(const converge_results *r, FILE *to) {
    const converge_step *last = &r->steps[r->count - 1];
    (void)fprintf(to, "%s, %u x %u, frame %u; %s\n", r->scene, r->width, r->height, r->frame, r->device);
    print_steps(r, to);
    (void)fprintf(to, "\nradius ~ paths^-%.3f; NMSE ~ paths^slope\n", r->shrink);
    print_slope("total light", &r->error, to);
    print_slope("indirect light", &r->indirect, to);
    print_slope("what more photons remove", &r->noise, to);
    (void)fprintf(to, "\nwhat more photons alone do not remove, NMSE of the total light\n");
    (void)fprintf(to, "  %-*s %.3g at %.4g m", NAME, "bias of the radius", last->blur, last->radius);
    if (isfinite(r->blur.slope))
        (void)fprintf(to, ", ~ radius^%.2f, standard error %.2f", r->blur.slope, r->blur.slope_error);
    (void)fputc('\n', to);
    print_part("bounce limit against all bounces", &r->truncation, to);
    print_part("tessellation: geometric against shading normals", &r->normals, to);
    (void)fprintf(to, "  %-*s %.3g of its own squared mean\n", NAME, "direct light", r->direct);
    (void)fprintf(to, "  %-*s %.3g (%u paths a pixel)\n", NAME, "the reference's own error", r->own, r->samples);
}
