/* The library from outside: one header and one archive, in C and in C++, and nothing of the baker.
 *
 * Strategy: the compiler is the judge. The header is compiled alone in both languages with every warning an error; a small
 * program of a user's is built with the header, the archive and OpenCL alone, and plays a pack. What a folder may include is
 * read from the sources: each #include "..." is resolved as the compiler does it and must lie where DESIGN.md's table of
 * folders allows. */
#include "test_packs.h"

#include <dirent.h>

static tool_run r;

static void compiles(const char *how) {
    test_packs_begin();
    test_packs_write(TEST_PACKS "/header.c", "#include \"vitrine.h\"\n", 21);
    tool(&r, "cc %s -Wall -Wextra -Wpedantic -Werror -fsyntax-only -Iinclude " TEST_PACKS "/header.c", how);
    tool_succeeds(&r);
    assert_string_equal(r.err, "");
}

static void the_header_alone_compiles_as_c11(void **state) {
    (void)state;
    compiles("-x c -std=c11");
}

static void the_header_alone_compiles_as_cpp17(void **state) {
    (void)state;
    compiles("-x c++ -std=c++17");
}

static void the_header_twice_is_as_good_as_once(void **state) {
    (void)state;
    test_packs_begin();
    static const char twice[] =
        "#include \"vitrine.h\"\n#include \"vitrine.h\"\nvit *none(void);\nvit *none(void) { return 0; }\n";
    test_packs_write(TEST_PACKS "/twice.c", twice, sizeof twice - 1);
    tool(&r, "cc -x c -std=c11 -Wall -Wextra -Wpedantic -Werror -fsyntax-only -Iinclude " TEST_PACKS "/twice.c");
    tool_succeeds(&r);
}

static const char users_program[] =
    "#include \"vitrine.h\"\n"
    "#include <stdio.h>\n"
    "#include <stdlib.h>\n"
    "int main(int argc, char **argv) {\n"
    "    vit_requirements need; vit_text why; vit *v;\n"
    "    FILE *f = argc > 1 ? fopen(argv[1], \"rb\") : NULL;\n"
    "    if (!f) return 9;\n"
    "    fseek(f, 0, SEEK_END); size_t size = (size_t)ftell(f); rewind(f);\n"
    "    void *pack = malloc(size);\n"
    "    if (!pack || fread(pack, 1, size, f) != size) return 9;\n"
    "    vit_open_info info = {.pack = pack, .pack_size = size};\n"
    "    if (vit_require(&info, &need, &why)) return puts(why.text), 8;\n"
    "    info.arena = aligned_alloc(64, (need.host_bytes + 63) / 64 * 64); info.arena_size = need.host_bytes;\n"
    "    if (vit_open(&info, &v, &why)) return puts(why.text), 7;\n"
    "    void *frame = malloc(need.frame_bytes);\n"
    "    for (uint32_t i = 0; i < need.frames; i++) {\n"
    "        if (vit_frame(v, i, frame, need.frame_bytes / need.height, &why)) return puts(why.text), 6;\n"
    "        if (vit_hash_frame(frame, info.format, need.frame_bytes) != vit_golden(v, i)) return 4;\n"
    "    }\n"
    "    vit_close(v); free(frame); free(info.arena); free(pack); fclose(f);\n"
    "    return 0;\n"
    "}\n";

static void a_users_program_needs_the_archive_and_opencl_alone(void **state) {
    (void)state;
    test_packs_begin();
    test_packs_write(TEST_PACKS "/user.c", users_program, sizeof users_program - 1);
    tool(&r, VIT_COMPILE " -std=c11 -Wall -Wextra -Wpedantic -Werror -Iinclude " TEST_PACKS "/user.c " VIT_BUILD_DIR
                         "/libvitrine.a " VIT_LIBS " -o " TEST_PACKS "/user");
    tool_succeeds(&r);
    tool(&r, TEST_PACKS "/user %s", test_pack("list"));
    tool_succeeds(&r);
}

static void the_archive_exports_only_names_that_begin_with_vit(void **state) {
    (void)state;
    static const char *const prefixes[] = {"vit_", "pack_check_", "pack_refuse"}; /* the last two: between its own files */
    tool(&r, "nm -P -g --defined-only " VIT_BUILD_DIR "/libvitrine.a");
    tool_succeeds(&r);
    int seen = 0;
    char *rest = NULL;
    for (char *line = strtok_r(r.out, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        int good = strchr(line, '[') != NULL || strncmp(line, "__odr_asan", 10) == 0; /* "libvitrine.a[open.o]:" */
        for (size_t i = 0; i < sizeof prefixes / sizeof prefixes[0]; i++)
            good |= strncmp(line, prefixes[i], strlen(prefixes[i])) == 0;
        if (!good)
            fail_msg("libvitrine.a exports %s", line);
        seen++;
    }
    assert_true(seen > 10);
}

static int is_there(const char *folder, const char *name, char *path, size_t size) {
    (void)snprintf(path, size, "%s/%s", folder, name);
    return access(path, F_OK) == 0;
}

/* Each #include "..." of the file is beside it or in one of `folders`, and does not climb out of them to `forbidden`. */
static int check_file(const char *folder, const char *name, const char *const folders[], const char *forbidden) {
    char path[512], line[1024], found[1024] = "";
    int count = 0;
    (void)snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "r");
    assert_non_null(f);
    for (int n = 1; fgets(line, sizeof line, f); n++) {
        char included[256];
        if (sscanf(line, " # include \"%255[^\"]\"", included) != 1)
            continue;
        int good = is_there(folder, included, found, sizeof found);
        for (size_t i = 0; !good && folders[i]; i++)
            good = is_there(folders[i], included, found, sizeof found);
        if (!good && strcmp(included, "kernel_sources.h") != 0 && strcmp(included, "kernel_list.h") != 0 &&
            strcmp(included, "host_programs.h") != 0) /* in the build's folder */
            fail_msg("%s:%d: %s is not where this folder may look", path, n, included);
        if (strstr(included, forbidden) || strstr(found, forbidden))
            fail_msg("%s:%d: includes %s", path, n, included);
        count++;
    }
    (void)fclose(f);
    return count;
}

static int check_folder(const char *folder, const char *const folders[], const char *forbidden) {
    int count = 0;
    DIR *d = opendir(folder);
    assert_non_null(d);
    for (struct dirent *e; (e = readdir(d)) != NULL;) {
        char path[512];
        struct stat s;
        const char *dot = strrchr(e->d_name, '.');
        (void)snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        if (e->d_name[0] == '.' || stat(path, &s) != 0)
            continue;
        if (S_ISDIR(s.st_mode))
            count += check_folder(path, folders, forbidden);
        else if (dot && strchr(".c.h.cl.clh", dot[1]))
            count += check_file(folder, e->d_name, folders, forbidden);
    }
    (void)closedir(d);
    return count;
}

static void runtime_kernels_and_include_take_nothing_from_the_baker(void **state) {
    (void)state;
    static const char *const public_only[] = {"include", NULL}, *const none[] = {NULL};
    assert_true(check_folder("runtime", public_only, "bake/") > 30);
    (void)check_folder("kernels", none, "bake/");
    assert_true(check_folder("include", none, "bake/") > 0);
}

static void the_baker_reaches_the_runtime_through_include_alone(void **state) {
    (void)state;
    static const char *const folders[] = {"bake", "include", NULL};
    assert_true(check_folder("bake", folders, "runtime/") > 30);
}

static void library_and_player_are_linked_to_nothing_of_the_baker(void **state) {
    (void)state;
    static const char *const baker[] = {"rtc", "ai", "config_", "stb"};
    tool(&r, "nm -u -P " TOOL_PLAY);
    tool_succeeds(&r);
    char *rest = NULL;
    for (char *line = strtok_r(r.out, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest))
        for (size_t i = 0; i < sizeof baker / sizeof baker[0]; i++)
            if (strncmp(line, baker[i], strlen(baker[i])) == 0)
                fail_msg(TOOL_PLAY " needs %s", line);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_header_alone_compiles_as_c11),
        cmocka_unit_test(the_header_alone_compiles_as_cpp17),
        cmocka_unit_test(the_header_twice_is_as_good_as_once),
        cmocka_unit_test(a_users_program_needs_the_archive_and_opencl_alone),
        cmocka_unit_test(the_archive_exports_only_names_that_begin_with_vit),
        cmocka_unit_test(runtime_kernels_and_include_take_nothing_from_the_baker),
        cmocka_unit_test(the_baker_reaches_the_runtime_through_include_alone),
        cmocka_unit_test(library_and_player_are_linked_to_nothing_of_the_baker),
    };
    return cmocka_run_group_tests_name("public header", tests, NULL, NULL);
}
