/* Values one after another, in text and in both byte orders. */
#include "import/ply/ply_file.h"
#include <string.h>

enum { PASSED = 1 << 22 }; /* bytes: what has been read of the file need not stay in memory */

static size_t size_of(ply_type type) {
    static const uint8_t sizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    return sizes[type];
}

/* ---- binary ---- */

/* Written out, so that compilers see a load in it. */
static uint32_t word_at(const uint8_t *at, bool big) {
    return big ? (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3]
               : at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

static uint16_t half_at(const uint8_t *at, bool big) {
    return (uint16_t)(at[big ? 1 : 0] | at[big ? 0 : 1] << 8);
}

static uint64_t double_word_at(const uint8_t *at, bool big) {
    return (uint64_t)word_at(at + (big ? 0 : 4), big) << 32 | word_at(at + (big ? 4 : 0), big);
}

/* Integers of 64 bits lose what a double does not hold: more than any file has of anything. */
static double value_at(const uint8_t *at, ply_type type, bool big) {
    float f;
    double d;
    uint64_t bits;
    uint32_t word;
    switch (type) {
    case PLY_INT8:
        return (double)(int8_t)at[0];
    case PLY_UINT8:
        return (double)at[0];
    case PLY_INT16:
        return (double)(int16_t)half_at(at, big);
    case PLY_UINT16:
        return (double)half_at(at, big);
    case PLY_INT32:
        return (double)(int32_t)word_at(at, big);
    case PLY_UINT32:
        return (double)word_at(at, big);
    case PLY_INT64:
        return (double)(int64_t)double_word_at(at, big);
    case PLY_UINT64:
        return (double)double_word_at(at, big);
    case PLY_FLOAT:
        word = word_at(at, big);
        memcpy(&f, &word, sizeof f);
        return (double)f;
    default:
        bits = double_word_at(at, big);
        memcpy(&d, &bits, sizeof d);
        return d;
    }
}

/* ---- text ---- */

static bool is_space(uint8_t c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/* Lines may end in LF, CR LF or CR. */
static void count_line(ply_file *p) {
    const bool cr_lf = *p->at == '\r' && p->at + 1 < p->end && p->at[1] == '\n';
    p->line += *p->at == '\n' || (*p->at == '\r' && !cr_lf);
}

static bool read_text(ply_file *p, ply_type type, double *out) {
    for (; p->at < p->end && is_space(*p->at); p->at++)
        count_line(p);
    const char *at = (const char *)p->at, *end = (const char *)p->end, *behind = import_number(at, end, type == PLY_FLOAT, out);
    p->wrong = p->at == p->end ? "is cut short" : "a value is no number";
    if (!behind || (behind < end && !is_space((uint8_t)*behind)))
        return false;
    p->at += behind - at;
    return true;
}

/* A row has a line: what stands behind it is not what the header says. */
static bool ends_line(ply_file *p) {
    while (p->at < p->end && is_space(*p->at) && *p->at != '\n' && *p->at != '\r')
        p->at++;
    return p->at == p->end || *p->at == '\n' || *p->at == '\r';
}

/* ---- both ---- */

bool ply_read_value(ply_file *p, ply_type type, double *out) {
    if (p->encoding == PLY_TEXT)
        return read_text(p, type, out);
    const size_t size = size_of(type);
    p->wrong = "is cut short";
    if ((size_t)(p->end - p->at) < size)
        return false;
    *out = value_at(p->at, type, p->encoding == PLY_BIG);
    p->at += size;
    return true;
}

bool ply_skip_list(ply_file *p, const ply_property *property, uint64_t count) {
    double value;
    p->wrong = "is cut short";
    if (p->encoding != PLY_TEXT) {
        const uint64_t size = size_of(property->type);
        if (count > (uint64_t)(p->end - p->at) / size)
            return false;
        p->at += count * size;
        return true;
    }
    for (uint64_t i = 0; i < count; i++)
        if (!read_text(p, property->type, &value))
            return false;
    return true;
}

static bool read_list(ply_file *p, const ply_property *property, ply_list_fn *list) {
    double count;
    if (!ply_read_value(p, property->count, &count))
        return false;
    p->wrong = "a list has a length that cannot be";
    if (!(count >= 0.0 && count < 0x1p53) || count != (double)(uint64_t)count)
        return false;
    return list(p, property, (uint64_t)count);
}

/* The system takes back pages of a mapping that are not in it any more. */
static void let_go(ply_file *p) {
    if (!p->keep && p->at - p->file.at >= PASSED)
        import_drop_front(&p->file, (size_t)(p->at - p->file.at));
}

/* In one line where and why. */
static bool fail(const ply_file *p, const ply_element *e) {
    const unsigned long long row = (unsigned long long)p->row, line = (unsigned long long)p->line;
    if (p->encoding == PLY_TEXT)
        return import_fail(p->im, "line %llu: element '%.60s', row %llu: %s", line, e->name, row, p->wrong);
    return import_fail(p->im, "element '%.60s', row %llu: %s", e->name, row, p->wrong);
}

bool ply_read_row(ply_file *p, const ply_element *e, ply_list_fn *list, double row[PLY_ROLES]) {
    const ply_property *property = p->properties + e->first;
    for (size_t i = 0; i < e->properties; i++, property++) {
        if (!(property->is_list ? read_list(p, property, list) : ply_read_value(p, property->type, &row[property->role])))
            return fail(p, e);
    }
    p->wrong = "more values than properties";
    if (p->encoding == PLY_TEXT && e->properties > 0 && !ends_line(p))
        return fail(p, e);
    let_go(p);
    p->row++;
    return true;
}

/* Bytes of a row whose lists are empty. */
static uint64_t least_of(const ply_file *p, const ply_element *e, bool *lists) {
    uint64_t least = 0;
    *lists = false;
    for (size_t i = 0; i < e->properties; i++) {
        const ply_property *property = &p->properties[e->first + i];
        *lists = *lists || property->is_list;
        least += p->encoding == PLY_TEXT ? 2 : size_of(property->is_list ? property->count : property->type);
    }
    return least;
}

bool ply_rows_fit(ply_file *p, const ply_element *e) {
    bool lists;
    /* In text the last value may end with the file. */
    const uint64_t left = (uint64_t)(p->end - p->at) + (p->encoding == PLY_TEXT), least = least_of(p, e, &lists);
    p->row = 0;
    return least == 0 || e->rows <= left / least ||
           import_fail(p->im, "is cut short: %llu rows of '%.60s' where at most %llu can be", (unsigned long long)e->rows,
                       e->name, (unsigned long long)(left / least));
}

bool ply_skip_element(ply_file *p, const ply_element *e) {
    double row[PLY_ROLES];
    bool lists;
    const uint64_t least = least_of(p, e, &lists);
    if (!ply_rows_fit(p, e) || least == 0)
        return least == 0;
    if (p->encoding != PLY_TEXT && !lists) {
        p->at += least * e->rows;
        return true;
    }
    for (uint64_t i = 0; i < e->rows; i++)
        if (!ply_read_row(p, e, ply_skip_list, row))
            return false;
    return true;
}
