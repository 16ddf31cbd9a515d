/* The library from outside: one header and one archive, in C and in C++, and nothing of the baker.
 *
 * Strategy: the compiler is the judge. The header is compiled alone in both languages with every warning an error; a small
 * program of a user's is built with the header, the archive and OpenCL alone, and plays a pack. What a folder may include is
 * read from the sources: each #include "..." is resolved as the compiler does it and must lie where the table of
 * folders on the repository's first page allows. */
#include "test_packs.h"

#include <dirent.h>

static tool_run r;

static void compiles(const char *how) {
    test_packs_begin();
    put_bytes(TEST_PACKS "/header.c", "#include \"vitrine.h\"\n", 21);
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
    put_bytes(TEST_PACKS "/twice.c", twice, sizeof twice - 1);
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
    put_bytes(TEST_PACKS "/user.c", users_program, sizeof users_program - 1);
    tool(&r, VIT_COMPILE " -std=c11 -Wall -Wextra -Wpedantic -Werror -Iinclude " TEST_PACKS "/user.c " VIT_BUILD_DIR
                         "/libvitrine.a " VIT_LIBS " -o " TEST_PACKS "/user");
    tool_succeeds(&r);
    tool(&r, TEST_PACKS "/user %s", test_pack("list"));
    tool_succeeds(&r);
}

/* The same call with nobody to tell why, of every function that takes a `why`. */
static const char silent_program[] =
    "#include \"vitrine.h\"\n"
    "#include <stdio.h>\n"
    "#include <stdlib.h>\n"
    "#define IS(call, want) do { if ((call) != (want)) return fprintf(stderr, \"line %d\\n\", __LINE__), 1; } while (0)\n"
    "static void passed(void *user, const char *pass, uint64_t hash) { (void)user; (void)pass; (void)hash; }\n"
    "int main(int argc, char **argv) {\n"
    "    vit_requirements need; vit *v; vit_statistics s; vit_fault faults[VIT_MAX_FAULTS]; uint32_t n, device; int lost;\n"
    "    static char bad[64];\n"
    "    FILE *f = argc > 1 ? fopen(argv[1], \"rb\") : NULL;\n"
    "    if (!f) return 9;\n"
    "    fseek(f, 0, SEEK_END); size_t size = (size_t)ftell(f); rewind(f);\n"
    "    void *pack = malloc(size);\n"
    "    if (!pack || fread(pack, 1, size, f) != size) return 9;\n"
    "    fclose(f);\n"
    "    IS(vit_device_name(VIT_DEVICE_HOST, NULL) != NULL, 1); IS(vit_device_name(12345, NULL) == NULL, 1);\n"
    "    IS(vit_device_find(\"Host\", &device, NULL), VIT_OK); IS(device, VIT_DEVICE_HOST);\n"
    "    IS(vit_device_find(\"no such thing\", &device, NULL), VIT_FAILED);\n"
    "    vit_open_info info = {.pack = bad, .pack_size = sizeof bad, .device = VIT_DEVICE_HOST};\n"
    "    IS(vit_require(&info, &need, NULL), VIT_BAD_INPUT); IS(vit_open(&info, &v, NULL), VIT_BAD_INPUT);\n"
    "    info.pack = pack; info.pack_size = size; info.threads = 300;\n"
    "    IS(vit_require(&info, &need, NULL), VIT_USAGE);\n"
    "    info.threads = 0;\n"
    "    IS(vit_require(&info, &need, NULL), VIT_OK); IS(vit_open(&info, &v, NULL), VIT_USAGE);\n"
    "    info.arena = aligned_alloc(64, (need.host_bytes + 63) / 64 * 64); info.arena_size = need.host_bytes;\n"
    "    IS(vit_open(&info, &v, NULL), VIT_OK);\n"
    "    IS(vit_frame(v, 0, NULL, 0, NULL), VIT_OK); IS(vit_frame(v, 1000000, NULL, 0, NULL), VIT_USAGE);\n"
    "    IS(vit_stats(v, &s, NULL), VIT_OK); IS(vit_faults(v, faults, &n, &lost, NULL), VIT_OK);\n"
    "    IS(vit_reached(v, &n, 1, NULL), VIT_USAGE);\n"
    "    IS(vit_trace(v, 0, bad, 1, passed, NULL, NULL), VIT_USAGE);\n"
    "    vit_close(v); free(info.arena); free(pack);\n"
    "    return 0;\n"
    "}\n";

static void every_call_works_with_nobody_to_tell_why(void **state) {
    (void)state;
    test_packs_begin();
    put_bytes(TEST_PACKS "/silent.c", silent_program, sizeof silent_program - 1);
    tool(&r, VIT_COMPILE " -std=c11 -Wall -Wextra -Wpedantic -Werror -Iinclude " TEST_PACKS "/silent.c " VIT_BUILD_DIR
                         "/libvitrine.a " VIT_LIBS " -o " TEST_PACKS "/silent");
    tool_succeeds(&r);
    tool(&r, TEST_PACKS "/silent %s", test_pack("list"));
    tool_succeeds(&r);
}

/* The value of a line of the .pc file, with ${libdir} and ${includedir} replaced by where these files lie here. */
static void value_of(const char *text, const char *name, char *out, size_t size) {
    const char *at = strstr(text, name);
    assert_non_null(at);
    size_t n = 0;
    for (at += strlen(name); *at && *at != '\n' && n + 64 < size;)
        if (strncmp(at, "${libdir}", 9) == 0) {
            n += (size_t)snprintf(out + n, size - n, VIT_BUILD_DIR);
            at += 9;
        } else if (strncmp(at, "${includedir}", 13) == 0) {
            n += (size_t)snprintf(out + n, size - n, "include");
            at += 13;
        } else
            out[n++] = *at++;
    out[n] = '\0';
}

static void the_file_for_pkg_config_says_how_to_link(void **state) {
    (void)state;
    char text[2048], flags[512], libs[512];
    read_into(VIT_BUILD_DIR "/vitrine.pc", text, sizeof text);
    value_of(text, "\nCflags:", flags, sizeof flags);
    value_of(text, "\nLibs:", libs, sizeof libs);
    put_bytes(TEST_PACKS "/user.c", users_program, sizeof users_program - 1);
    tool(&r, VIT_COMPILE " -std=c11 %s " TEST_PACKS "/user.c -o " TEST_PACKS "/user %s", flags, libs);
    tool_succeeds(&r);
    assert_non_null(strstr(text, "\nVersion: "));
}

static void the_archive_exports_only_names_that_begin_with_vit(void **state) {
    (void)state;
    tool(&r, "nm -P -g --defined-only " VIT_BUILD_DIR "/libvitrine.a");
    tool_succeeds(&r);
    int seen = 0;
    char *rest = NULL;
    for (char *line = strtok_r(r.out, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        int good = strchr(line, '[') != NULL || strncmp(line, "__odr_asan", 10) == 0; /* "libvitrine.a[open.o]:" */
        good |= strncmp(line, "vit_", 4) == 0;
        if (!good)
            fail_msg("libvitrine.a exports %s", line);
        seen++;
    }
    assert_true(seen > 10);
}

static int is_there(const char *folder, const char *name, char *path, size_t size) {
    path_join(path, size, folder, name);
    return access(path, F_OK) == 0;
}

/* Each #include "..." of the file is beside it or in one of `folders`, and does not climb out of them to `forbidden`. */
static int check_file(const char *folder, const char *name, const char *const folders[], const char *forbidden) {
    char path[512], line[1024], found[1024] = "";
    int count = 0;
    path_join(path, sizeof path, folder, name);
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
        cmocka_unit_test(every_call_works_with_nobody_to_tell_why),
        cmocka_unit_test(the_file_for_pkg_config_says_how_to_link),
        cmocka_unit_test(the_archive_exports_only_names_that_begin_with_vit),
        cmocka_unit_test(runtime_kernels_and_include_take_nothing_from_the_baker),
        cmocka_unit_test(the_baker_reaches_the_runtime_through_include_alone),
        cmocka_unit_test(library_and_player_are_linked_to_nothing_of_the_baker),
    };
    return cmocka_run_group_tests_name("public header", tests, NULL, NULL);
}
