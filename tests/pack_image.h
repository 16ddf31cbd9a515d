/* A pack in memory that tests can spoil, and what its refusal must look like. Each image is a heap block of exactly its size,
 * so that a sanitizer sees any reading beyond it. */
#ifndef VIT_TESTS_PACK_IMAGE_H
#define VIT_TESTS_PACK_IMAGE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "pack_fixture.h"
#include "pack_read.h"

#include <stdio.h>
#include <stdlib.h>

/* An image and where its sections are, for spoiling. */
typedef struct image {
    void *bytes;
    size_t size;
    vit_pack_header *header;
    vit_pack_entry *table;
    vit_scene *scene;
    vit_camera *cameras;
    vit_light *lights;
    vit_triangle *triangles;
    vit_attributes *attributes;
    vit_bvh_node *nodes;
    vit_material *materials;
    vit_maps *maps;
    vit_texture *textures;
    vit_mip *mips;
    vit_u32 *sides;
    vit_cell *cells;
    vit_light_sample *emitters;
    vit_sky_texel *sky;
    vit_receiver_cell *receiver_cells;
    vit_receiver_split *splits;
    vit_receiver *receivers;
    vit_u32 *map_sides;
    vit_receiver_cell *map_cells;
    vit_receiver_split *map_splits;
    vit_receiver *map_receivers;
    vit_basis_group *groups;
    vit_u32 *words;
    vit_basis_coefficient *coefficients;
    vit_basis_frame *basis_frames;
    vit_patch *patches;
    vit_patch_point *patch_points;
    vit_gather_row *gather_rows;
    vit_u32 *gather_words, *looked_up;
    vit_u32 *transfer;
    vit_cache_cell *cache, *point_cells; /* the latter of FIXTURE_POINT_CELLS alone */
    vit_photon *photons;
    vit_gold *golds;
} image;

static inline void *section(const image *im, int i) {
    return (char *)im->bytes + im->table[i].offset;
}

static inline image image_of(const pack_fixture *f) {
    image im = {0};
    vit_text why = {""};
    assert_int_equal(fixture_assemble(f, &im.bytes, &im.size, &why), VIT_OK);
    im.header = im.bytes;
    im.table = (vit_pack_entry *)(im.header + 1);
    im.scene = section(&im, VIT_SECTION_META);
    im.cameras = section(&im, VIT_SECTION_CAMS);
    im.lights = section(&im, VIT_SECTION_LITE);
    im.triangles = section(&im, VIT_SECTION_GEOM);
    im.attributes = section(&im, VIT_SECTION_ATTR);
    im.nodes = section(&im, VIT_SECTION_BVHN);
    im.materials = section(&im, VIT_SECTION_MATL);
    im.maps = section(&im, VIT_SECTION_MAPS);
    im.textures = section(&im, VIT_SECTION_TEXR);
    im.mips = section(&im, VIT_SECTION_MIPS);
    im.sides = section(&im, VIT_SECTION_SIDE);
    im.cells = section(&im, VIT_SECTION_CELL);
    im.emitters = section(&im, VIT_SECTION_EMIT);
    im.sky = section(&im, VIT_SECTION_SKYT);
    im.receiver_cells = section(&im, VIT_SECTION_RCEL);
    im.splits = section(&im, VIT_SECTION_RSPL);
    im.receivers = section(&im, VIT_SECTION_RECV);
    im.map_sides = section(&im, VIT_SECTION_MSID);
    im.map_cells = section(&im, VIT_SECTION_MCEL);
    im.map_splits = section(&im, VIT_SECTION_MSPL);
    im.map_receivers = section(&im, VIT_SECTION_MREC);
    im.groups = section(&im, VIT_SECTION_BGRP);
    im.words = section(&im, VIT_SECTION_BWRD);
    im.coefficients = section(&im, VIT_SECTION_BCOE);
    im.basis_frames = section(&im, VIT_SECTION_BFRM);
    im.patches = section(&im, VIT_SECTION_PATC);
    im.patch_points = section(&im, VIT_SECTION_PPNT);
    im.gather_rows = section(&im, VIT_SECTION_GROW);
    im.gather_words = section(&im, VIT_SECTION_GATH);
    im.looked_up = section(&im, VIT_SECTION_LOOK);
    im.transfer = section(&im, VIT_SECTION_XFER);
    im.cache = section(&im, VIT_SECTION_CACH);
    im.point_cells = section(&im, VIT_SECTION_RCEL);
    im.photons = section(&im, VIT_SECTION_PHOT);
    im.golds = section(&im, VIT_SECTION_GOLD);
    return im;
}

/* The fixtures: between them no section is empty. */
typedef enum fixture_kind {
    FIXTURE_PHOTONS,
    FIXTURE_BASIS,
    FIXTURE_LIVE,
    FIXTURE_LIGHTMAP,
    FIXTURE_POINT_CELLS,
    FIXTURE_KINDS
} fixture_kind;

static inline void fixture_make_kind(pack_fixture *f, fixture_kind kind) {
    kind == FIXTURE_LIGHTMAP      ? fixture_make_lightmap(f)
    : kind == FIXTURE_POINT_CELLS ? fixture_make_points(f)
    : kind == FIXTURE_LIVE        ? fixture_make_live(f)
    : kind == FIXTURE_BASIS       ? fixture_make_basis(f)
                                  : fixture_make(f);
}

static inline image valid_image_of(fixture_kind kind) {
    pack_fixture *f = malloc(sizeof *f);
    assert_non_null(f);
    fixture_make_kind(f, kind);
    image im = image_of(f);
    free(f);
    return im;
}

static inline image valid_image(void) {
    return valid_image_of(FIXTURE_PHOTONS);
}

/* Makes every hash right again, as far as the table's places lie in the file. */
static inline void forge(image *im) {
    for (int i = 0; i < VIT_SECTION_COUNT; i++) {
        vit_pack_entry *e = &im->table[i];
        if (e->offset <= im->size && e->size <= im->size - e->offset)
            e->hash = vit_hash(section(im, i), (size_t)e->size);
    }
    im->header->table_hash = vit_hash(im->table, VIT_SECTION_COUNT * sizeof *im->table);
}

static inline vit_status read_image(const image *im, vit_text *why) {
    vit_pack pack;
    vit_text silent = {""};
    *why = silent;
    return vit_pack_read(im->bytes, im->size, &pack, why);
}

static inline void assert_one_line(const vit_text *why) {
    assert_non_null(memchr(why->text, 0, sizeof why->text));
    assert_true(strncmp(why->text, "pack: ", 6) == 0);
    assert_null(strchr(why->text, '\n'));
}

/* `place` is "header" or a section's code; `cause` a part of the line. */
static inline void assert_refused(vit_status status, const vit_text *why, const char *place, const char *cause) {
    char start[32];
    snprintf(start, sizeof start, place[0] == 'h' ? "pack: %s: " : "pack: section %s: ", place);
    if (status != VIT_BAD_INPUT || strncmp(why->text, start, strlen(start)) != 0 || !strstr(why->text, cause))
        fail_msg("expected '%s...%s...', got %d '%s'", start, cause, (int)status, why->text);
    assert_one_line(why);
}

#endif
