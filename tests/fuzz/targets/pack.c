/* The pack loader on any bytes. Random bytes never get past the hashes, so an input is either a pack as it is (it begins with
 * the magic number; read as it is and again with its hashes made right) or a script of edits to a good one:
 *
 *   chain N             begin from a deep tree of N nodes rather than from the cube
 *   basis               begin from the cube with receivers and a basis rather than with photons
 *   live                begin from the cube with receivers and patches
 *   points              begin from the cube with a basis whose receivers are points
 *   lightmap            begin from the cube with a lightmap, part of which is left to rays
 *   plain               leave META's derived fields and the sections' sizes as they were: otherwise they follow META's counts
 *   CODE INDEX = HEX    word INDEX of section CODE (modulo its words); "+" adds, "^" flips bits
 *   HEAD, TABL, FILE    instead of CODE: the header, the section table, the whole file
 *   kept                the table's own hash stays as it was: otherwise all hashes are made right after the edits
 *   cut N               the file ends after N bytes
 *
 * What is accepted must be safe to play: every index that a kernel would follow is followed here, under the sanitizer. */
#include "fuzz.h"
#include "pack_fixture.h"
#include "pack_read.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

enum { MAX_SECTION = 1 << 18, MAX_EDITS = 64 };

typedef enum edit_place { PLACE_HEAD = VIT_SECTION_COUNT, PLACE_TABL, PLACE_FILE } edit_place;

static const char codes[][5] = {
#define X(code, type, records) #code,
    VIT_SECTIONS(X)
#undef X
        "HEAD",
    "TABL",
    "FILE",
};
enum { PLACES = sizeof codes / sizeof codes[0] };

typedef struct edit {
    int place;
    uint32_t index, value;
    char how;
} edit;

typedef struct script {
    edit edits[MAX_EDITS];
    int count;
    uint32_t chain, cut;
    bool basis, live, points, lightmap, plain, kept;
} script;

/* ---- reading a script ---- */

static void read_line(script *s, const char *line) {
    char code[5];
    edit e;
    if (sscanf(line, "chain %u", &s->chain) == 1 || sscanf(line, "cut %u", &s->cut) == 1)
        return;
    s->basis |= strcmp(line, "basis") == 0;
    s->live |= strcmp(line, "live") == 0;
    s->points |= strcmp(line, "points") == 0;
    s->lightmap |= strcmp(line, "lightmap") == 0;
    s->plain |= strcmp(line, "plain") == 0;
    s->kept |= strcmp(line, "kept") == 0;
    if (s->count == MAX_EDITS || sscanf(line, "%4s %u %c %x", code, &e.index, &e.how, &e.value) != 4)
        return;
    for (e.place = 0; e.place < PLACES; e.place++)
        if (strcmp(code, codes[e.place]) == 0) {
            s->edits[s->count++] = e;
            return;
        }
}

static void read_script(script *s, const uint8_t *data, size_t size) {
    char line[64];
    *s = (script){.cut = UINT32_MAX};
    for (size_t at = 0; at < size;) {
        const uint8_t *feed = memchr(data + at, '\n', size - at);
        const size_t length = feed ? (size_t)(feed - data) - at : size - at;
        (void)snprintf(line, sizeof line, "%.*s", (int)(length < sizeof line ? length : sizeof line - 1),
                       (const char *)data + at);
        read_line(s, line);
        at += length + 1;
    }
}

static void apply(const script *s, int place, void *bytes, size_t size) {
    for (int i = 0; i < s->count; i++) {
        const edit *e = &s->edits[i];
        if (e->place != place || size < 4)
            continue;
        unsigned char *at = (unsigned char *)bytes + 4 * (e->index % (size / 4));
        uint32_t word;
        memcpy(&word, at, 4);
        word = e->how == '+' ? word + e->value : e->how == '^' ? word ^ e->value : e->value;
        memcpy(at, &word, 4);
    }
}

/* ---- making the pack ---- */

typedef struct forged {
    void *section[VIT_SECTION_COUNT];
    unsigned char *bytes; /* a heap block of exactly `size` bytes: a sanitizer sees any reading beyond it */
    size_t size;
} forged;

static void forged_free(forged *p) {
    for (int i = 0; i < VIT_SECTION_COUNT; i++)
        free(p->section[i]);
    free(p->bytes);
}

/* Bytes of each section as `s` counts them. */
static void count_bytes(const vit_scene *s, uint64_t bytes[VIT_SECTION_COUNT]) {
    int i = 0;
#define X(code, type, records) bytes[i++] = (uint64_t)(records) * sizeof(type);
    VIT_SECTIONS(X)
#undef X
}

/* The fixture's section in the wanted length; where it is longer, its records are repeated. NULL: too long. */
static void *resized(const void *from, uint64_t have, uint64_t want) {
    if (want > MAX_SECTION || (have == 0 && want > 0))
        return NULL;
    unsigned char *to = calloc(1, (size_t)want + 4);
    FUZZ_HOLDS(to != NULL);
    for (uint64_t done = 0; done < want; done += have)
        memcpy(to + done, from, (size_t)(want - done < have ? want - done : have));
    return to;
}

/* Sections by the edited META, or as they were. */
static bool fill_sections(const script *sc, const pack_fixture *f, forged *out) {
    const pack_sections from = fixture_sections(f);
    uint64_t have[VIT_SECTION_COUNT], want[VIT_SECTION_COUNT];
    vit_scene s = f->scene;
    apply(sc, VIT_SECTION_META, &s, sizeof s);
    if (!sc->plain)
        (void)vit_pack_derive(&s, NULL);
    count_bytes(&f->scene, have);
    count_bytes(sc->plain ? &f->scene : &s, want);
    for (int i = 0; i < VIT_SECTION_COUNT; i++) {
        out->section[i] = resized(i == VIT_SECTION_META ? &s : from.data[i], have[i], want[i]);
        if (!out->section[i])
            return false;
        if (i != VIT_SECTION_META)
            apply(sc, i, out->section[i], (size_t)want[i]);
    }
    return true;
}

/* Sizes of the sections come from META in pack_assemble(): with `plain` it gets the old META first. */
static bool assemble(const script *sc, const pack_fixture *f, forged *out) {
    pack_sections sections = {{0}};
    void *image;
    size_t size;
    for (int i = 0; i < VIT_SECTION_COUNT; i++)
        sections.data[i] = out->section[i];
    if (sc->plain)
        sections.data[VIT_SECTION_META] = &f->scene;
    if (pack_assemble(&sections, &image, &size, NULL) != VIT_OK)
        return false;
    const vit_pack_entry *table = (const vit_pack_entry *)((const vit_pack_header *)image + 1);
    memcpy((char *)image + table[VIT_SECTION_META].offset, out->section[VIT_SECTION_META], sizeof f->scene);
    out->size = sc->cut < size ? sc->cut : size;
    out->bytes = aligned_alloc(8, out->size + 8 - out->size % 8);
    FUZZ_HOLDS(out->bytes != NULL);
    memcpy(out->bytes, image, out->size);
    free(image);
    return true;
}

/* Makes hashes right, as far as the table's places lie in the file. */
static void repair(unsigned char *bytes, size_t size, bool kept) {
    vit_pack_header *header = (vit_pack_header *)(void *)bytes;
    vit_pack_entry *table = (vit_pack_entry *)(header + 1);
    if (size < sizeof *header + VIT_SECTION_COUNT * sizeof *table)
        return;
    for (int i = 0; i < VIT_SECTION_COUNT; i++)
        if (table[i].offset <= size && table[i].size <= size - table[i].offset)
            table[i].hash = vit_hash(bytes + table[i].offset, (size_t)table[i].size);
    if (!kept)
        header->table_hash = vit_hash(table, VIT_SECTION_COUNT * sizeof *table);
}

static void edit_file(const script *sc, forged *p) {
    const size_t head = sizeof(vit_pack_header), all = head + VIT_SECTION_COUNT * sizeof(vit_pack_entry);
    apply(sc, PLACE_FILE, p->bytes, p->size);
    if (p->size < all)
        return;
    apply(sc, PLACE_TABL, p->bytes + head, all - head);
    repair(p->bytes, p->size, sc->kept);
    apply(sc, PLACE_HEAD, p->bytes, head);
}

/* ---- what an accepted pack must hold ---- */

static uint32_t sum; /* of all that is read, so that it is read */

static void follow_mip(const vit_pack *p, const vit_mip *m) {
    const vit_u32 *texels = p->section[VIT_SECTION_ATLS];
    const int64_t w = m->width, h = m->height, x[] = {-1, w}, y[] = {-1, h};
    for (int i = 0; i < 4; i++) {
        const int64_t word = (int64_t)m->offset + y[i / 2] * (int64_t)m->pitch + x[i % 2];
        FUZZ_HOLDS(word >= 0 && word < p->scene->texels);
        sum += texels[word];
    }
}

static void follow_texture(const vit_pack *p, vit_u32 texture) {
    const vit_texture *textures = p->section[VIT_SECTION_TEXR];
    const vit_mip *mips = p->section[VIT_SECTION_MIPS];
    if (texture == VIT_NONE)
        return;
    FUZZ_HOLDS(texture < p->scene->textures && textures[texture].mip_count > 0);
    for (vit_u32 i = 0; i < textures[texture].mip_count; i++)
        follow_mip(p, &mips[textures[texture].first_mip + i]);
}

static void follow_material(const vit_pack *p, uint32_t index) {
    const vit_material *materials = p->section[VIT_SECTION_MATL];
    const vit_maps *maps = p->section[VIT_SECTION_MAPS];
    FUZZ_HOLDS(index < p->scene->materials);
    follow_texture(p, materials[index].texture);
    if (VIT_HAS_MAPS(p->scene->effects))
        follow_texture(p, maps[index].normal);
}

static void follow_cells(const vit_pack *p, uint32_t triangle) {
    const vit_u32 *sides = p->section[VIT_SECTION_SIDE];
    const vit_cell *cells = p->section[VIT_SECTION_CELL];
    const vit_u32 on_surfaces = p->scene->point_levels > 0 ? 0 : p->scene->receiver_cells;
    const vit_u32 count = p->scene->receivers > 0 ? on_surfaces : p->scene->cells;
    for (uint32_t side = 2 * triangle; count && side < 2 * triangle + 2; side++) {
        const vit_u32 n = sides[side] >> VIT_SIDE_PARTS_SHIFT, first = sides[side] & VIT_SIDE_CELL;
        FUZZ_HOLDS(n >= 1 && first + n * n <= count);
        sum += cells ? cells[first].word + cells[first + n * n - 1].word : 0;
    }
}

/* Baked places: of indirect light, or of the lightmap. */
typedef struct places {
    const vit_receiver_cell *cells;
    const vit_receiver_split *splits;
    const vit_receiver *receivers;
    vit_u32 cell_count, split_count, receiver_count;
} places;

static void follow_receivers(const places *p, const vit_u32 receiver[3]) {
    for (int k = 0; k < 3; k++) {
        FUZZ_HOLDS(receiver[k] < p->receiver_count);
        sum += p->receivers[receiver[k]].irradiance[0] > 1.0f;
    }
}

/* So many times at most it is divided, whatever place is looked up. */
static int divided(const vit_receiver_cell *cells, vit_u32 cell) {
    const vit_u32 parts = cells[cell].split & ~VIT_RECEIVER_DIVIDED, first = cells[cell].receiver[0];
    int most = 0;
    if (!VIT_RECEIVER_IS_DIVIDED(cells[cell].split) || parts == 0)
        return 0;
    FUZZ_HOLDS(first > cell);
    for (vit_u32 k = first; k < first + parts * parts; k++) {
        const int one = divided(cells, k);
        most = one > most ? one : most;
    }
    return most + 1;
}

static void follow_receiver_cells(const places *p, bool by_rays) {
    for (vit_u32 i = 0; i < p->cell_count; i++) {
        const vit_receiver_cell *c = p->cells + i;
        if (by_rays && c->split == VIT_RECEIVER_BY_RAYS)
            continue;
        if (VIT_RECEIVER_IS_DIVIDED(c->split)) {
            const vit_u32 parts = c->split & ~VIT_RECEIVER_DIVIDED, end = c->receiver[0] + parts * parts;
            FUZZ_HOLDS(parts >= 1 && parts <= VIT_RECEIVER_PARTS && end <= p->cell_count);
            FUZZ_HOLDS(divided(p->cells, i) <= VIT_RECEIVER_LEVELS);
            continue;
        }
        follow_receivers(p, c->receiver);
        FUZZ_HOLDS(c->split == VIT_NONE || c->split < p->split_count);
        if (c->split != VIT_NONE)
            follow_receivers(p, p->splits[c->split].receiver);
    }
}

static void follow_places(const vit_pack *p) {
    const vit_scene *s = p->scene;
    const places indirect = {p->section[VIT_SECTION_RCEL], p->section[VIT_SECTION_RSPL],
                             p->section[VIT_SECTION_RECV], s->receiver_cells,
                             s->receiver_splits,           s->receivers},
                 lightmap = {p->section[VIT_SECTION_MCEL],
                             p->section[VIT_SECTION_MSPL],
                             p->section[VIT_SECTION_MREC],
                             s->map_cells,
                             s->map_splits,
                             s->map_receivers};
    const vit_u32 *sides = p->section[VIT_SECTION_MSID];
    if (s->point_levels == 0)
        follow_receiver_cells(&indirect, false);
    follow_receiver_cells(&lightmap, s->effects & VIT_BIT(LIGHTMAP_RAYS));
    for (vit_u32 i = 0; s->map_cells && i < 2 * s->triangles; i++) {
        const vit_u32 n = sides[i] >> VIT_SIDE_PARTS_SHIFT;
        FUZZ_HOLDS(n >= 1 && (sides[i] & VIT_SIDE_CELL) + n * n <= s->map_cells);
    }
}

/* As the pass relight does, in its 32-bit numbers. */
static void follow_basis(const vit_pack *p) {
    const vit_scene *s = p->scene;
    const vit_basis_group *groups = p->section[VIT_SECTION_BGRP];
    const vit_u32 *words = p->section[VIT_SECTION_BWRD];
    const vit_basis_coefficient *coefficients = p->section[VIT_SECTION_BCOE];
    const vit_basis_frame *frames = p->section[VIT_SECTION_BFRM];
    for (vit_u32 i = 0; i < s->frames * s->basis_lights; i++) {
        const vit_basis_frame *at = frames + i;
        FUZZ_HOLDS(at->light < s->lights && at->weight >= 0.0f && at->weight <= 1.0f);
        for (vit_u32 g = 0; g < s->receivers / VIT_BASIS_GROUP; g++) {
            const vit_basis_group *b = groups + g * s->basis_lights + i % s->basis_lights;
            const vit_u32 first = b->first_coefficient + at->knot * b->rank, last = first + b->rank - 1,
                          word = b->first_word + b->rank * (VIT_BASIS_GROUP / 2) - 1;
            if (b->rank == 0)
                continue;
            FUZZ_HOLDS(last < s->basis_coefficients && last + (at->weight > 0.0f ? b->rank : 0) < s->basis_coefficients);
            FUZZ_HOLDS(first >= b->first_coefficient && word < s->basis_words);
            sum += words[b->first_word] + words[word] + (coefficients[first].rgb[0] > coefficients[last].rgb[2]);
        }
    }
}

/* As cache_find() of kernels/cache.clh does. */
static void follow_table(const vit_cache_cell *cells, vit_u32 count, vit_u32 probes) {
    for (vit_u32 i = 0; i < count; i++) {
        const vit_u32 key = cells[i].key, mask = count - 1;
        vit_u32 found = VIT_NONE;
        for (vit_u32 k = 0, at = key & mask; k < probes && found == VIT_NONE && cells[at].key <= key; k++) {
            if (cells[at].key == key && ((cells[at].word[2] ^ cells[i].word[2]) & VIT_CACHE_TAG) == 0)
                found = at;
            at = (at + 1) & mask;
        }
        FUZZ_HOLDS(key == VIT_CACHE_EMPTY || found == i);
    }
}

static void follow_cache(const vit_pack *p) {
    const vit_scene *s = p->scene;
    const vit_cache_cell *points = p->section[VIT_SECTION_RCEL];
    const vit_receiver *receivers = p->section[VIT_SECTION_RECV];
    follow_table(p->section[VIT_SECTION_CACH], s->cache_cells, s->cache_probes);
    if (s->point_levels == 0)
        return;
    follow_table(points, s->receiver_cells, VIT_CACHE_PROBES);
    for (vit_u32 i = 0; i < s->receiver_cells; i++)
        for (vit_u32 q = 0; points[i].key != VIT_CACHE_EMPTY && !(points[i].word[2] & VIT_CACHE_PARTED) && q < 8; q++) {
            const vit_u32 point = points[i].word[1] >> VIT_POINT_BITS * q & VIT_POINT_NONE;
            if (point >= VIT_CACHE_POINTS)
                continue;
            FUZZ_HOLDS(points[i].word[0] + point < s->receivers);
            sum += receivers[points[i].word[0] + point].irradiance[1] > 1.0f;
        }
}

static void follow_patches(const vit_pack *p) {
    const vit_scene *s = p->scene;
    const vit_patch *patches = p->section[VIT_SECTION_PATC];
    const vit_patch_point *points = p->section[VIT_SECTION_PPNT];
    const vit_u32 stride = VIT_PATCH_STRIDE(s);
    for (vit_u32 i = 0; i < s->patches; i++) {
        FUZZ_HOLDS(patches[i].first < patches[i].end && patches[i].end <= s->patch_points);
        sum += points[patches[i].first].weight > 0.5f;
    }
    for (vit_u32 i = 0; i < s->patch_points; i++)
        FUZZ_HOLDS(points[i].patch < s->patches);
    FUZZ_HOLDS(s->patch_points % 16 == 0 && stride + s->patch_points <= VIT_MAX_COLUMNS);
}

static void follow_gather(const vit_pack *p) {
    const vit_scene *s = p->scene;
    const vit_gather_row *rows = p->section[VIT_SECTION_GROW];
    const vit_u32 *words = p->section[VIT_SECTION_GATH];
    for (vit_u32 i = 0; s->patches > 0 && i < s->receivers; i++)
        for (vit_u32 k = 0, ones = (rows[i].ones + 1) / 2; k < VIT_GATHER_WORDS(&rows[i]); k++) {
            FUZZ_HOLDS(rows[i].first + k < s->gather_words);
            const vit_u32 word = words[rows[i].first + k], columns = VIT_PATCH_STRIDE(s) + s->patch_points;
            FUZZ_HOLDS((word & 0xffffu) < columns && (k >= ones || word >> 16 < columns));
        }
    FUZZ_HOLDS(s->patches == 0 || (s->frames - 1) / s->looked_frames < VIT_LOOKED_SETS(s));
}

/* Parts of a code, and what is sparse in it, as transfer_product.clh does. */
static void follow_transfer(const vit_pack *p) {
    const vit_scene *s = p->scene;
    const vit_u32 *words = p->section[VIT_SECTION_XFER];
    const vit_transfer *h = p->section[VIT_SECTION_XFER];
    if (s->transfer_words == 0)
        return;
    FUZZ_HOLDS(h->words == s->transfer_words && h->stride == VIT_PATCH_STRIDE(s) && h->mix <= h->words);
    FUZZ_HOLDS(h->rank == s->transfer_rank && h->dense_chunks + h->sparse_chunks + (h->rank > 0) == s->transfer_sums);
    for (vit_u32 i = 0; h->sparse_chunks > 0 && i < h->stride; i++) {
        const vit_u32 first = words[h->panels + i / 16 * 2], slots = words[h->panels + i / 16 * 2 + 1];
        FUZZ_HOLDS(words[h->places + i] < h->stride);
        for (vit_u32 k = 0; k < slots; k += 2) {
            const vit_u32 at = first + k / 2 * VIT_TRANSFER_PAIR(h->codec) + i % 16;
            FUZZ_HOLDS(at < h->words && (words[at] & 0xffffu) < h->stride && words[at] >> 16 < h->stride);
        }
    }
}

/* As a ray would that hits every box. Returns the triangles met. */
static uint32_t follow_tree(const vit_pack *p) {
    const vit_bvh_node *nodes = p->section[VIT_SECTION_BVHN];
    const vit_attributes *attributes = p->section[VIT_SECTION_ATTR];
    uint32_t stack[VIT_BVH_STACK] = {0}, waiting = 1, met = 0;
    while (waiting > 0) {
        const vit_bvh_node *n = &nodes[stack[--waiting]];
        const vit_u32 children[2] = {n->child1, n->child0};
        for (int c = 0; c < 2; c++) {
            const vit_u32 first = children[c] & VIT_LEAF_FIRST, count = (children[c] >> VIT_LEAF_SHIFT & 7) + 1;
            const bool leaf = children[c] & VIT_LEAF_BIT, missing = c == 0 && n->lo1[0] > n->hi1[0];
            FUZZ_HOLDS(leaf || waiting < VIT_BVH_STACK);
            if (!leaf)
                stack[waiting++] = children[c];
            for (vit_u32 i = first; leaf && i < first + count; i++) {
                FUZZ_HOLDS(i < p->scene->triangles);
                follow_material(p, attributes[i].material & VIT_MATERIAL_INDEX);
                follow_cells(p, i);
            }
            met += leaf && !missing ? count : 0;
        }
    }
    return met;
}

static void check_needs(const vit_open_info *info) {
    vit_requirements need;
    vit_text why = {""};
    uint64_t bytes = 0;
    FUZZ_HOLDS(vit_require(info, &need, &why) == VIT_OK);
    for (uint32_t i = 0; i < need.buffer_count; i++)
        bytes += need.buffers[i].bytes;
    FUZZ_HOLDS(bytes == need.device_bytes && bytes < (uint64_t)1 << 40 && need.pass_count > 0);
    FUZZ_HOLDS(need.frame_bytes == (size_t)need.width * need.height * (info->format == VIT_FORMAT_RGBA32F ? 16 : 4));
}

static void read_pack(const unsigned char *bytes, size_t size) {
    vit_pack pack;
    vit_text why;
    memset(&why, 'x', sizeof why);
    const vit_status status = vit_pack_read(bytes, size, &pack, &why);
    if (status != VIT_OK) {
        FUZZ_HOLDS(status == VIT_BAD_INPUT && strncmp(why.text, "pack: ", 6) == 0);
        fuzz_one_line(why.text, sizeof why.text);
        return;
    }
    FUZZ_HOLDS(follow_tree(&pack) == pack.scene->triangles);
    follow_places(&pack);
    follow_basis(&pack);
    follow_cache(&pack);
    follow_patches(&pack);
    follow_gather(&pack);
    follow_transfer(&pack);
    check_needs(&(vit_open_info){.pack = bytes, .pack_size = size});
    check_needs(&(vit_open_info){.pack = bytes,
                                 .pack_size = size,
                                 .lanes = 16,
                                 .count_work = 1,
                                 .format = VIT_FORMAT_RGBA32F,
                                 .view = VIT_VIEW_photons});
}

/* ---- the target ---- */

static void read_as_it_is(const uint8_t *data, size_t size) {
    unsigned char *bytes = aligned_alloc(8, size + 8 - size % 8);
    FUZZ_HOLDS(bytes != NULL);
    memcpy(bytes, data, size);
    read_pack(bytes, size);
    repair(bytes, size, false);
    read_pack(bytes, size);
    free(bytes);
}

void fuzz_pack(const uint8_t *data, size_t size) {
    if (size >= 8 && memcmp(data, VIT_PACK_MAGIC, 8) == 0) {
        read_as_it_is(data, size);
        return;
    }
    script s;
    pack_fixture *f = malloc(sizeof *f);
    forged p = {.size = 0};
    FUZZ_HOLDS(f != NULL);
    read_script(&s, data, size);
    if (s.chain > 0)
        fixture_make_chain(f, 1 + (s.chain - 1) % (FIXTURE_TRIANGLES - 1));
    else if (s.live)
        fixture_make_live(f);
    else if (s.basis)
        fixture_make_basis(f);
    else if (s.points)
        fixture_make_points(f);
    else if (s.lightmap)
        fixture_make_lightmap(f);
    else
        fixture_make(f);
    vit_pack_derive(&f->scene, NULL);
    if (fill_sections(&s, f, &p) && assemble(&s, f, &p)) {
        edit_file(&s, &p);
        read_pack(p.bytes, p.size);
    }
    forged_free(&p);
    free(f);
}
