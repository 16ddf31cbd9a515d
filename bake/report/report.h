/* report.c: what a sweep found, as report.csv, report.json and one self-contained index.html. Columns and contents: README.md.
 */
#ifndef VIT_COST_REPORT_H
#define VIT_COST_REPORT_H

#include "report/results.h"

/* Makes `folder` (and those above it) if needed; each file is written whole, under another name and renamed. Reads `r` only.
 * r->count >= 1; a setting without `image`, or results without reference images, are reported without pictures.
 * VIT_FAILED: a file cannot be written, out of memory, or gnuplot is missing or fails: report.csv and report.json are there
 * then. */
vit_status report_write(const cost_results *r, const char *folder, vit_text *why);

/* Name of file `index` of those; NULL beyond the last. */
const char *report_name(uint32_t index);

#endif
