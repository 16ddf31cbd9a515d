/* report_csv.c: one row a setting, RFC 4180 with line feeds. Columns keep their names and order; new ones come last. */
#include "report/report_parts.h"

#include <inttypes.h>

#define ERRORS(X, group) X(group, nmse) X(group, relmse) X(group, bias) X(group, psnr) X(group, ssim) X(group, local)

static void print_header(FILE *to) {
    (void)fputs("index,scene,name,knob,values,ms,ms_p95,ms_mad,timed,work,device_bytes,pack_bytes", to);
#define X(group, field) (void)fputs("," #group "_" #field, to);
    ERRORS(X, total)
    ERRORS(X, indirect)
    ERRORS(X, unlimited)
#undef X
    (void)fputs(",front,front_relmse,path_tracer_ms_at_nmse,path_tracer_ms_at_relmse,elsewhere,bake_seconds\n", to);
}

static void comma_number(FILE *to, double value) {
    (void)fputc(',', to);
    text_number(to, value, "");
}

static void print_row(const cost_results *r, uint32_t i, FILE *to) {
    const cost_setting *s = &r->settings[i];
    (void)fprintf(to, "%" PRIu32 ",", i);
    text_csv(to, r->scene);
    (void)fputc(',', to);
    text_csv(to, s->name);
    (void)fputc(',', to);
    text_csv(to, s->knob);
    (void)fputc(',', to);
    text_csv(to, s->values);
    comma_number(to, s->ms);
    comma_number(to, s->ms_p95);
    comma_number(to, s->ms_mad);
    (void)fprintf(to, ",%" PRIu32 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64, s->timed, s->work, s->device_bytes, s->pack_bytes);
#define X(group, field) comma_number(to, s->group.field);
    ERRORS(X, total)
    ERRORS(X, indirect)
    ERRORS(X, unlimited)
#undef X
    (void)fprintf(to, ",%d,%d", s->pareto, s->pareto_relmse);
    comma_number(to, report_equal_ms(r, s, REPORT_NMSE));
    comma_number(to, report_equal_ms(r, s, REPORT_RELMSE));
    (void)fprintf(to, ",%d", s->elsewhere);
    comma_number(to, s->bake_seconds);
    (void)fputc('\n', to);
}

void report_csv(const cost_results *r, FILE *to) {
    print_header(to);
    for (uint32_t i = 0; i < r->count; i++)
        print_row(r, i, to);
}
