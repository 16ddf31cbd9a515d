/* options.c: the command line as plain data. */
#ifndef VIT_PLAY_OPTIONS_H
#define VIT_PLAY_OPTIONS_H

#include "budget.h"
#include "vitrine.h"
#include "sinks/sink.h"
#include <stdio.h>

typedef struct play_options {
    const char *pack;      /* file; NULL only with help, version, list_devices */
    const sink_kind *sink; /* never NULL */
    const char *target;    /* the sink's; "" if it takes none */
    bool out_given;
    uint32_t first, end; /* frames first .. end - 1; end == 0: to the path's end */
    uint32_t loop;       /* times the range is played; 0: without an end */
    vit_view view;
    vit_format format;
    uint32_t threads, lanes, group, max_nodes, max_list; /* as in vit_open_info */
    const char *device;                                  /* as vit_device_find() takes it; NULL: the default */
    const char *host_isa;                                /* as in vit_open_info */
    const char *size;                                    /* not NULL: was asked for, and will be refused */
    const char *report_file;                             /* NULL: no JSON */
    budget budget;                                       /* with has_budget */
    bool has_budget;
    unsigned percentile;                         /* 50, 95, 99 or 100 (maximum); 0: not given */
    const char *work_budget, *write_work_budget; /* NULL: not asked for */
    const char *golden, *write_golden;           /* likewise */
    bool count_work;
    bool verify, hash, trace, pace, report, explain, list_devices, wide_divide, quiet, version, help;
} play_options;

/* VIT_USAGE: `why` says which option and what it takes. All that needs no pack is checked here. Keeps pointers into `argv`. */
vit_status options_parse(int argc, char **argv, play_options *out, vit_text *why);

/* The whole page: synopsis, options, sinks, views, formats, examples, exit codes. */
void options_help(FILE *to);

/* Is work to be counted; are frames wanted for anything but their work? */
bool options_counts(const play_options *o);
/* The first option given that is of the device host alone; NULL: none. */
const char *options_of_host(const play_options *o);
bool options_plays(const play_options *o);

/* Lower-case name, as --format takes it; name, as --view does. */
const char *options_format_name(vit_format format);
const char *options_view_name(vit_view view);

#endif
