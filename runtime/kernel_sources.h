/* The kernels' text, built into the library by the Makefile, in the order in which it is joined into one program. */
#ifndef VIT_KERNEL_SOURCES_H
#define VIT_KERNEL_SOURCES_H

extern const char *const vit_kernel_sources[];
extern const unsigned vit_kernel_source_count;

#endif
