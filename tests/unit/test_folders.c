/* The baker's folders in the order in which data flows: each includes only folders before it, every include names the folder,
 * and no header includes itself by way of others. Reads the sources that lie beside the tests. */
#include "test_folder.h"
#include <dirent.h>
#include <stdbool.h>

static const char *const order[] = {"common", "scene",     "import", "geometry",  "motion", "light",  "dark_sides", "zones",
                                    "cache",  "radiosity", "pack",   "reference", "check",  "report", "cost",       NULL};
enum { MOST_FILES = 600, MOST_INCLUDES = 64, PATH = 512 };

typedef struct file {
    char path[PATH]; /* below bake/ */
    char include[MOST_INCLUDES][PATH];
    int includes;
    int state; /* 0: not looked at, 1: on the way, 2: done */
} file;

typedef struct tree {
    file files[MOST_FILES];
    int count;
    char fault[4 * PATH];
} tree;

static int place_of(const char *folder, size_t length) {
    for (int i = 0; order[i]; i++)
        if (strlen(order[i]) == length && strncmp(order[i], folder, length) == 0)
            return i;
    return -1;
}

/* The folder of a path below bake/: its place in the order; the last place but one for files of bake/ itself; -1: none. */
static int folder_of(const char *path) {
    const char *slash = strchr(path, '/');
    return slash ? place_of(path, (size_t)(slash - path)) : (int)(sizeof order / sizeof *order);
}

static void read_text(tree *t, const char *path, const char *text) {
    assert_in_range(t->count, 0, MOST_FILES - 1);
    file *f = &t->files[t->count++];
    (void)snprintf(f->path, sizeof f->path, "%s", path);
    for (const char *at = text; at; at = strchr(at, '\n')) {
        at += *at == '\n';
        if (strncmp(at, "#include \"", 10) != 0)
            continue;
        assert_in_range(f->includes, 0, MOST_INCLUDES - 1);
        (void)snprintf(f->include[f->includes], PATH, "%.*s", (int)strcspn(at + 10, "\"\n"), at + 10);
        f->includes++;
    }
}

static const file *find(const tree *t, const char *path) {
    for (int i = 0; i < t->count; i++)
        if (strcmp(t->files[i].path, path) == 0)
            return &t->files[i];
    return NULL;
}

static bool goes_round(tree *t, file *f) {
    f->state = 1;
    for (int i = 0; i < f->includes; i++) {
        file *to = (file *)find(t, f->include[i]);
        if (!to || to->state == 2)
            continue;
        if (to->state == 1 || goes_round(t, to)) {
            if (!t->fault[0])
                (void)snprintf(t->fault, sizeof t->fault, "%s includes itself by way of %s", to->path, f->path);
            return true;
        }
    }
    f->state = 2;
    return false;
}

/* The first fault, or an empty text. */
static const char *judge(tree *t) {
    t->fault[0] = '\0';
    for (int i = 0; i < t->count; i++) {
        const file *f = &t->files[i];
        const char *slash = strrchr(f->path, '/');
        for (int k = 0; k < f->includes; k++) {
            char beside[2 * PATH];
            (void)snprintf(beside, sizeof beside, "%.*s%s", slash ? (int)(slash - f->path + 1) : 0, f->path, f->include[k]);
            if (slash && find(t, beside)) {
                (void)snprintf(t->fault, sizeof t->fault, "%s: \"%s\" does not say its folder", f->path, f->include[k]);
                return t->fault;
            }
            if (find(t, f->include[k]) && folder_of(f->include[k]) > folder_of(f->path)) {
                (void)snprintf(t->fault, sizeof t->fault, "%s includes %s, of a later folder", f->path, f->include[k]);
                return t->fault;
            }
        }
    }
    for (int i = 0; i < t->count; i++)
        if (t->files[i].state == 0 && goes_round(t, &t->files[i]))
            return t->fault;
    return "";
}

static void read_folder(tree *t, const char *folder) {
    char path[2 * PATH];
    (void)snprintf(path, sizeof path, "bake/%s", folder);
    DIR *d = opendir(path);
    assert_non_null(d);
    for (struct dirent *e; (e = readdir(d));) {
        char below[PATH];
        struct stat s;
        (void)snprintf(below, sizeof below, "%.100s%s%.200s", folder, folder[0] ? "/" : "", e->d_name);
        (void)snprintf(path, sizeof path, "bake/%s", below);
        assert_int_equal(stat(path, &s), 0);
        if (S_ISDIR(s.st_mode) && e->d_name[0] != '.' && strcmp(below, "scenes") != 0) {
            if (!folder[0] && place_of(e->d_name, strlen(e->d_name)) < 0)
                fail_msg("bake/%s has no place in the order", e->d_name);
            read_folder(t, below); /* folders in a folder are of its place */
        }
        const char *dot = strrchr(e->d_name, '.');
        if (!S_ISREG(s.st_mode) || !dot || (strcmp(dot, ".c") != 0 && strcmp(dot, ".h") != 0))
            continue;
        char *text = read_file(path, NULL);
        read_text(t, below, text);
        free(text);
    }
    (void)closedir(d);
}

static void data_flows_one_way(void **state) {
    tree *t = calloc(1, sizeof *t);
    (void)state;
    assert_non_null(t);
    read_folder(t, "");
    assert_true(t->count > 150);
    if (judge(t)[0])
        fail_msg("%s", t->fault);
    free(t);
}

static void each_fault_is_found(void **state) {
    static const struct {
        const char *path[2], *text[2], *fault;
    } cases[] = {
        {{"pack/a.h", "light/b.h"}, {"#include \"light/b.h\"\n", "#include \"common/c.h\"\n"}, ""},
        {{"pack/a.h", "light/b.c"}, {"", "#include \"pack/a.h\"\n"}, "light/b.c includes pack/a.h, of a later folder"},
        {{"pack/a.h", "pack/b.c"}, {"", "/* b */\n#include \"a.h\"\n"}, "pack/b.c: \"a.h\" does not say its folder"},
        {{"pack/a.h", "pack/b.h"}, {"#include \"pack/b.h\"\n", "#include \"pack/a.h\"\n"}, "by way of"},
        {{"main.c", "cost/b.h"}, {"#include \"cost/b.h\"\n", ""}, ""},
        {{"import/a/b.h", "import/a/c.c"}, {"", "#include \"b.h\"\n"}, "import/a/c.c: \"b.h\" does not say its folder"},
        {{"import/a/b.h", "pack/c.h"}, {"#include \"pack/c.h\"\n", ""}, "of a later folder"},
        {{"options.h", "cost/b.h"}, {"", "#include \"options.h\"\n"}, "of a later folder"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        tree *t = calloc(1, sizeof *t);
        assert_non_null(t);
        for (int k = 0; k < 2; k++)
            read_text(t, cases[i].path[k], cases[i].text[k]);
        const char *fault = judge(t);
        if (cases[i].fault[0] ? !strstr(fault, cases[i].fault) : fault[0])
            fail_msg("case %zu: '%s' instead of '%s'", i, fault, cases[i].fault);
        free(t);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(data_flows_one_way),
        cmocka_unit_test(each_fault_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
