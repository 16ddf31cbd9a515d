/* What is cited exists: .md files and their sections, equations and sources of kernels/METHODS.md, source files that READMEs
 * name.
 *
 * A citation is `FILE.md`, or `FILE.md, "Section"`, or `FILE.md, "Section" (7)` with an equation's number, in code, comments
 * and READMEs; the file's path begins at the repository's root or at the file that cites. Code that cites METHODS.md says where
 * in it. A year in a comment is that of a source, whose name stands beside it: [Name Year] of METHODS.md. Texts are read with
 * line ends and comment marks as blanks, so that a citation may run over a line's end. "name() of FOLDER/FILE" is a function
 * that is there. */
#include "repository_texts.h"
#include <ctype.h>
#include <fnmatch.h>
#include <regex.h>
#include <strings.h>

#define METHOD "kernels/METHODS.md"
#define SELF "tests/unit/test_citations.c" /* has what must be found wrong */

/* ---- what is wrong ---- */

static void fault(library *l, const file *f, size_t at, const char *what, const char *of, int length) {
    unsigned line = 1;
    for (size_t i = 0; i < at; i++)
        line += f->raw[i] == '\n';
    snprintf(l->last, sizeof l->last, "%s:%u: %s: %.*s", f->path, line, what, length, of);
    if (!l->quiet)
        print_error("%s\n", l->last);
    l->faults++;
}

static regex_t compiled(const char *pattern) {
    regex_t r;
    assert_int_equal(regcomp(&r, pattern, REG_EXTENDED), 0);
    return r;
}

static int length_of(const regmatch_t *m) {
    return (int)(m->rm_eo - m->rm_so);
}

/* The first line that is so a heading, and where the next of its level or above begins; a log's heading may begin with a date.
 */
static bool has_section(const file *f, const char *name, int length, const char **begin, const char **end) {
    for (const char *s = f->raw; s && *s; s = (s = strchr(s, '\n')) ? s + 1 : NULL) {
        if (*s != '#')
            continue;
        const char *h = s;
        while (*h == '#' || *h == ' ')
            h++;
        if (strncmp(h, "20", 2) == 0 && strncmp(h + 10, ": ", 2) == 0)
            h += 12;
        if (strncasecmp(h, name, (size_t)length) != 0 || (h[length] != '\n' && h[length] != ' ' && h[length] != ','))
            continue;
        *begin = s;
        *end = strstr(s + 1, "\n#");
        *end = *end ? *end : s + strlen(s);
        return true;
    }
    return false;
}

/* Equations are indented lines that end in their number. */
static unsigned equation_of(const char *line) {
    const char *end = strchr(line, '\n');
    unsigned number = 0;
    end = end ? end : line + strlen(line);
    const char *open = end;
    while (open > line && *open != '(')
        open--;
    const bool is = strncmp(line, "    ", 4) == 0 && end > line && end[-1] == ')' && sscanf(open, "(%u)", &number) == 1 &&
                    strspn(open + 1, "0123456789") == (size_t)(end - open) - 2;
    return is ? number : 0;
}

static bool has_equation(const char *begin, const char *end, unsigned number) {
    for (const char *s = begin; s && s < end; s = (s = strchr(s, '\n')) ? s + 1 : NULL)
        if (equation_of(s) == number)
            return true;
    return false;
}

static void check_citations_of(library *l, const file *f) {
    regex_t citation = compiled("([A-Za-z0-9_./-]*[A-Za-z0-9_-]\\.md)([^A-Za-z0-9_]|$)");
    regex_t section = compiled("^, +\\\\?\"([^\"\\\\]+)\\\\?\"( +\\(([0-9]+)\\))?");
    regex_t unquoted = compiled("^, +[A-Z][a-z]+[ .);]");
    regmatch_t m[3], s[4];
    for (size_t at = 0; regexec(&citation, f->text + at, 3, m, 0) == 0; at += (size_t)m[1].rm_eo) {
        const char *name = f->text + at + m[1].rm_so, *after = f->text + at + m[1].rm_eo, *begin, *end;
        const size_t where = at + (size_t)m[1].rm_so;
        const file *cited = find_cited(l, f, name, length_of(m + 1));
        if (name > f->text && name[-1] == ':')
            continue; /* of an address */
        if (!cited)
            fault(l, f, where, "no such file", name, length_of(m + 1));
        else if (regexec(&unquoted, after, 0, NULL, 0) == 0)
            fault(l, f, where, "put the section between quotes", name, length_of(m + 1) + 20);
        else if (regexec(&section, after, 4, s, 0) != 0) {
            if (is_code(f->path) && strcmp(cited->path, METHOD) == 0)
                fault(l, f, where, "names no section", name, length_of(m + 1));
        } else if (!has_section(cited, after + s[1].rm_so, length_of(s + 1), &begin, &end))
            fault(l, f, where, "no such section", name, length_of(m + 1) + (int)s[1].rm_eo);
        else if (s[3].rm_so >= 0 && !has_equation(begin, end, (unsigned)atoi(after + s[3].rm_so)))
            fault(l, f, where, "no such equation there", name, length_of(m + 1) + (int)s[3].rm_eo);
    }
    regfree(&citation);
    regfree(&section);
    regfree(&unquoted);
}

/* "(Section, below)" in a README. */
static void check_own_sections(library *l, const file *f) {
    regex_t own = compiled("\\(\"?([A-Z][^(),]*), (below|above)\\)");
    regmatch_t m[2];
    const char *begin, *end;
    for (size_t at = 0; regexec(&own, f->text + at, 2, m, 0) == 0; at += (size_t)m[1].rm_eo) {
        const char *name = f->text + at + m[1].rm_so;
        if (!has_section(f, name, length_of(m + 1) - (name[-1] == '"'), &begin, &end))
            fault(l, f, at + (size_t)m[1].rm_so, "no such section here", name, length_of(m + 1));
    }
    regfree(&own);
}

static bool names_a_file(const library *l, const char *name, int length) {
    char pattern[300], below[304];
    snprintf(pattern, sizeof pattern, "%.*s", length, name);
    while (strncmp(pattern, "../", 3) == 0)
        memmove(pattern, pattern + 3, strlen(pattern + 3) + 1);
    snprintf(below, sizeof below, "*/%s", pattern);
    for (size_t i = 0; i < l->count; i++)
        if (fnmatch(pattern, l->files[i].path, 0) == 0 || fnmatch(below, l->files[i].path, 0) == 0)
            return true;
    return false;
}

/* Of a file that is to be made, or of several: build/x.h, bench_NAME.c. */
static bool is_pattern(const char *name, int length) {
    for (int i = 0; i + 1 < length; i++)
        if (isupper((unsigned char)name[i]) && isupper((unsigned char)name[i + 1]))
            return true;
    return strncmp(name, "build/", 6) == 0;
}

/* Source files that a README names between backticks, or a comment with their folder. */
static void check_source_files(library *l, const file *f) {
    const char *text = is_code(f->path) ? f->comment : f->text;
    regex_t source =
        compiled(is_code(f->path) ? "[ (]((bake|kernels|runtime|include|tests)/[A-Za-z0-9_./*-]+\\.(c|h|cl|clh|sh|mk|cfg))"
                                  : "`([A-Za-z0-9_./*-]+\\.(c|h|cl|clh|sh|mk|cfg|js|css))`");
    regmatch_t m[2];
    for (size_t at = 0; regexec(&source, text + at, 2, m, 0) == 0; at += (size_t)m[1].rm_eo) {
        const char *name = text + at + m[1].rm_so;
        if (!names_a_file(l, name, length_of(m + 1)) && !is_pattern(name, length_of(m + 1)))
            fault(l, f, at + (size_t)m[1].rm_so, "no such file", name, length_of(m + 1));
    }
    regfree(&source);
}

/* "name() of kernels/file.cl" in a comment: what is computed in two places says where the other one is. */
static void check_functions(library *l, const file *f) {
    regex_t function =
        compiled("([A-Za-z0-9_]+)\\(\\) +of +((bake|kernels|runtime|include|tests)/[A-Za-z0-9_./-]+\\.(c|h|cl|clh))");
    regmatch_t m[3];
    for (size_t at = 0; regexec(&function, f->comment + at, 3, m, 0) == 0; at += (size_t)m[1].rm_eo) {
        char name[128];
        const char *where = f->comment + at;
        const file *cited = find_cited(l, f, where + m[2].rm_so, length_of(m + 2));
        snprintf(name, sizeof name, "%.*s(", length_of(m + 1), where + m[1].rm_so);
        if (cited && !strstr(cited->raw, name))
            fault(l, f, at + (size_t)m[1].rm_so, "no such function there", where + m[1].rm_so, (int)(m[2].rm_eo - m[1].rm_so));
    }
    regfree(&function);
}

/* Is there a "- [Name Year]" in METHODS.md, Name in the text? Without a text: is there exactly this key? */
static bool has_source(const file *method, const char *key, int length, const char *year, const char *text) {
    for (const char *s = method->raw; (s = strstr(s, "\n- [")) != NULL;) {
        s += 4;
        const char *close = strchr(s, ']'), *blank = close;
        char name[64];
        if (!text && strncmp(s, key, (size_t)length) == 0 && s[length] == ']')
            return true;
        while (blank > s && *blank != ' ')
            blank--;
        snprintf(name, sizeof name, "%.*s", (int)(blank - s), s);
        if (text && strncmp(blank + 1, year, 4) == 0 && strstr(text, name))
            return true;
    }
    return false;
}

static void check_years(library *l, const file *f, const file *method) {
    regex_t year = compiled("[ (]((19[4-9]|20[0-3])[0-9])([),.:; ]|$)");
    regmatch_t m[2];
    for (char *block = f->comment; *block;) {
        block += strspn(block, "\1");
        const size_t n = strcspn(block, "\1");
        char *text = strndup(block, n);
        assert_non_null(text);
        for (size_t at = 0; regexec(&year, text + at, 2, m, 0) == 0; at += (size_t)m[1].rm_eo)
            if (!has_source(method, NULL, 0, text + at + m[1].rm_so, text))
                fault(l, f, (size_t)(block - f->comment) + at, "a source that METHODS.md does not have", text + at,
                      (int)m[1].rm_eo);
        free(text);
        block += n;
    }
    regfree(&year);
}

/* Keys that the page itself uses, and equations: in order, and those named are there. */
static void check_method(library *l, const file *f) {
    regex_t key = compiled("\\[?([A-Z][A-Za-z'-]+ (19[4-9]|20[0-3])[0-9])[],]");
    regex_t equation = compiled("[Ee]quation \\(([0-9]+)\\)");
    regmatch_t m[2];
    unsigned last = 0;
    for (const char *s = f->raw; s; s = (s = strchr(s, '\n')) ? s + 1 : NULL) {
        const unsigned number = equation_of(s);
        if (number && number != last + 1)
            fault(l, f, (size_t)(s - f->raw), "equation out of order", s + strcspn(s, "\n") - 4, 4);
        last = number ? number : last;
    }
    const char *references = strstr(f->text, "# The four systems");
    const size_t text_end = references ? (size_t)(references - f->text) : strlen(f->text);
    for (size_t at = 0; regexec(&key, f->text + at, 2, m, 0) == 0 && at + (size_t)m[1].rm_so < text_end;
         at += (size_t)m[1].rm_eo)
        if (!has_source(f, f->text + at + m[1].rm_so, length_of(m + 1), NULL, NULL))
            fault(l, f, at + (size_t)m[1].rm_so, "no such source below", f->text + at + m[1].rm_so, length_of(m + 1));
    for (size_t at = 0; regexec(&equation, f->text + at, 2, m, 0) == 0; at += (size_t)m[1].rm_eo)
        if ((unsigned)atoi(f->text + at + m[1].rm_so) > last)
            fault(l, f, at, "no such equation", f->text + at + m[1].rm_so, length_of(m + 1));
    regfree(&key);
    regfree(&equation);
}

/* Passes go by their kernels' names: there are no numbers to renumber. */
static void check_pass_names(library *l, const file *f) {
    regex_t number = compiled("[Pp]ass(es)? [0-9]");
    regmatch_t m[1];
    for (size_t at = 0; regexec(&number, f->text + at, 1, m, 0) == 0; at += (size_t)m[0].rm_eo)
        fault(l, f, at + (size_t)m[0].rm_so, "say its name", f->text + at + m[0].rm_so, length_of(m));
    regfree(&number);
}

static void check_all(library *l) {
    const file *method = find_exactly(l, METHOD);
    assert_non_null(method);
    check_method(l, method);
    for (size_t i = 0; i < l->count; i++) {
        const file *f = l->files + i;
        if (!f->text || strcmp(f->path, SELF) == 0)
            continue;
        check_citations_of(l, f);
        check_pass_names(l, f);
        if (is_code(f->path)) {
            check_functions(l, f);
            check_years(l, f, method);
        }
        if (ends_with(f->path, ".md"))
            check_own_sections(l, f);
        if (is_code(f->path) || (ends_with(f->path, ".md") && !ends_with(f->path, "LOG.md"))) /* a log tells of what was */
            check_source_files(l, f);
    }
}

/* ---- tests ---- */

static library *new_library(void) {
    library *l = calloc(1, sizeof *l);
    assert_non_null(l);
    return l;
}

static void all_that_is_cited_exists(void **state) {
    library *l = new_library();
    (void)state;
    read_repository(l);
    assert_true(l->count > 300);
    check_all(l);
    const unsigned faults = l->faults;
    release(l);
    assert_int_equal(faults, 0);
}

#define A_METHOD                                                                                                               \
    "# The method\n\nEquation (2), [Woop 2013, Duff 2017].\n\n## Rays\n\n    a = b   (1)\n\n## Splats\n\n    c = d   "         \
    "(2)\n\n## The four systems\n\n"                                                                                           \
    "- [Woop 2013] S. Woop.\n- [Duff 2017] T. Duff.\n- [Roberts 2018] M. Roberts.\n"

/* The one fault of a library of METHODS.md, a README and this file. */
static void expect(const char *path, const char *text, const char *fault_or_null) {
    library *l = new_library();
    l->quiet = true;
    add(l, METHOD, strcmp(path, METHOD) == 0 ? text : A_METHOD);
    add(l, "bake/README.md", "# Baker\n\n## Zones and areas\n\n### 2026-11-22: the radius, later\n");
    add(l, "bake/zones/zones.c", "int zone(int x);");
    if (strcmp(path, METHOD) != 0)
        add(l, path, text);
    check_all(l);
    if (l->faults != (fault_or_null ? 1u : 0u) || (fault_or_null && !strstr(l->last, fault_or_null)))
        fail_msg("%s: %u faults, %s instead of %s", text, l->faults, l->last, fault_or_null ? fault_or_null : "none");
    release(l);
}

static void each_kind_of_wrong_citation_is_found(void **state) {
    (void)state;
    expect("bake/a.c", "/* NOWHERE.md */", "bake/a.c:1: no such file: NOWHERE.md");
    expect("bake/a.c", "\nputs(\"bake/NOWHERE.md has it\");", "bake/a.c:2: no such file");
    expect("kernels/a.cl", "/* METHODS.md, \"Lays\". */", "no such section: METHODS.md, \"Lays");
    expect("kernels/a.cl", "/* METHODS.md, step 3. */", "names no section");
    expect("kernels/a.cl", "/* METHODS.md,\n * \"Rays\" (2). */", "no such equation there");
    expect("bake/a.c", "puts(\"bake/README.md, \\\"Rays\\\"\");", "no such section");
    expect("bake/a.c", "/* README.md, Zones. */", "put the section between quotes");
    expect("Makefile", "# README.md\n", "no such file");
    expect("bake/a.c", "int x; /* after Nobody, 2013 */", "a source that METHODS.md does not have");
    expect("bake/a.c", "// (Woop 2014)", "a source that METHODS.md does not have");
    expect("runtime/README.md", "# R\n(Rooms, below)\n", "no such section here: Rooms");
    expect("runtime/README.md", "# R\n`bones.c`\n", "no such file: bones.c");
    expect("bake/a.c", "/* as\n   in bake/bones.c */", "bake/a.c:2: no such file: bake/bones.c");
    expect("bake/a.c", "/* cone() of\n * bake/zones/zones.c */", "no such function there: cone() of");
    expect("kernels/a.cl", "/* Pass 1: hits */", "say its name: Pass 1");
    expect(METHOD, "# M\n[Woop 2013]\n## The four systems\n", "no such source below: Woop 2013");
    expect(METHOD, "# M\n    a (1)\n    b (3)\n", "equation out of order:  (3)");
    expect(METHOD, "# M\nEquation (1)\n", "no such equation: 1");
}

static void right_citations_pass(void **state) {
    (void)state;
    expect(
        "kernels/a.cl",
        "/* METHODS.md, \"Rays\" (1), and\n * kernels/METHODS.md,\n * \"Splats\". After Woop and others, JCGT 2(1), 2013. */",
        NULL);
    expect("bake/a.c",
           "/* zone() of bake/zones/zones.c; README.md, \"Zones and areas\"; bake/README.md, "
           "\"The radius\"; x = 1920; Roberts 2018. */ int y = 2001;",
           NULL);
    expect("bake/a.c", "char *s = \"in 1999\"; /* https://x.org/README.md */", NULL);
    expect("runtime/README.md",
           "# R\n## Rooms\n(Rooms, below) `zones/*.c` `bake/zones/zones.c` `../bake/zones/zones.c` `build/x.h`\n", NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_that_is_cited_exists),
        cmocka_unit_test(each_kind_of_wrong_citation_is_found),
        cmocka_unit_test(right_citations_pass),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
