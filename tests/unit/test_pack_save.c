/* Saving: under its name a pack is there whole or not at all, and nothing else is left in the folder. Failures are made real:
 * a file size limit breaks a write in the middle, and the signal that comes with it stands for the user's Ctrl-C. Each test has
 * a fresh folder, which must be empty but for the named file at its end. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "pack/pack_write.h"
#include "test_folder.h"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <sys/resource.h>
#include <sys/wait.h>

enum { SIZE = 20000, LIMIT = 5000, ABANDONED = 7 };

static char folder[TEST_FOLDER];
static char path[128];
static unsigned char bytes[SIZE];

static int make_folder(void **state) {
    (void)state;
    folder_make_temporary(folder);
    path_join(path, sizeof path, folder, "scene.vit");
    for (int i = 0; i < SIZE; i++)
        bytes[i] = (unsigned char)(i * 7 + 3);
    return 0;
}

/* Entries of the folder, "." and ".." left out. */
static int entries(void) {
    DIR *d = opendir(folder);
    assert_non_null(d);
    int count = -2;
    while (readdir(d))
        count++;
    closedir(d);
    return count;
}

static int remove_folder(void **state) {
    (void)state;
    unlink(path);
    return rmdir(folder); /* fails if a temporary file is left */
}

static void assert_file_holds(const unsigned char *expected, size_t size) {
    size_t got;
    unsigned char *found = read_file(path, &got);
    assert_int_equal(got, size);
    assert_memory_equal(found, expected, size);
    free(found);
}

static void assert_failed(vit_status status, const vit_text *why, const char *cause) {
    assert_int_equal(status, VIT_FAILED);
    assert_null(strchr(why->text, '\n'));
    if (!strstr(why->text, cause))
        fail_msg("expected '...%s...', got '%s'", cause, why->text);
}

static void a_saved_pack_holds_the_bytes_and_is_alone_in_its_folder(void **state) {
    (void)state;
    vit_text why = {""};
    assert_int_equal(pack_save(path, bytes, SIZE, &why), VIT_OK);
    assert_string_equal(why.text, "");
    assert_file_holds(bytes, SIZE);
    assert_int_equal(entries(), 1);
}

static void a_saved_pack_replaces_the_one_before_and_cannot_be_abandoned(void **state) {
    (void)state;
    vit_text why = {""};
    assert_int_equal(pack_save(path, "before", 6, &why), VIT_OK);
    assert_int_equal(pack_save(path, bytes, SIZE, &why), VIT_OK);
    pack_abandon();
    assert_file_holds(bytes, SIZE);
    assert_int_equal(entries(), 1);
}

static void a_pack_is_as_readable_as_the_umask_says(void **state) {
    (void)state;
    vit_text why = {""};
    struct stat info;
    mode_t before = umask(027);
    assert_int_equal(pack_save(path, bytes, SIZE, &why), VIT_OK);
    umask(before);
    assert_int_equal(stat(path, &info), 0);
    assert_int_equal(info.st_mode & 0777, 0640);
}

static void a_name_without_a_folder_means_this_folder(void **state) {
    (void)state;
    char before[4096];
    vit_text why = {""};
    assert_non_null(getcwd(before, sizeof before));
    assert_int_equal(chdir(folder), 0);
    vit_status status = pack_save("scene.vit", bytes, SIZE, &why);
    assert_int_equal(chdir(before), 0);
    assert_int_equal(status, VIT_OK);
    assert_file_holds(bytes, SIZE);
}

static void a_folder_that_is_not_there_is_named(void **state) {
    (void)state;
    char deep[256];
    vit_text why = {""};
    snprintf(deep, sizeof deep, "%s/none/scene.vit", folder);
    assert_failed(pack_save(deep, bytes, SIZE, &why), &why, deep);
    assert_int_equal(entries(), 0);
}

static void a_folder_that_is_read_only_stays_empty(void **state) {
    (void)state;
    vit_text why = {""};
    assert_int_equal(chmod(folder, 0555), 0);
    const bool root = geteuid() == 0; /* whom no mode stops */
    if (root && seteuid(65534) != 0)
        skip();
    vit_status status = pack_save(path, bytes, SIZE, &why);
    if (root)
        assert_int_equal(seteuid(0), 0);
    assert_int_equal(chmod(folder, 0755), 0);
    assert_failed(status, &why, "Permission denied");
    assert_int_equal(entries(), 0);
}

static void what_is_not_a_file_is_not_replaced(void **state) {
    (void)state;
    vit_text why = {""};
    assert_failed(pack_save("/dev/null", bytes, SIZE, &why), &why, "not a regular file");
    assert_failed(pack_save(folder, bytes, SIZE, &why), &why, "not a regular file");
    struct stat info;
    assert_int_equal(stat("/dev/null", &info), 0);
    assert_true(S_ISCHR(info.st_mode));
}

static void a_name_that_is_too_long_is_refused(void **state) {
    (void)state;
    static char name[10000];
    vit_text why = {""};
    snprintf(name, sizeof name, "%s/", folder);
    memset(name + strlen(name), 'x', sizeof name - 1 - strlen(name));
    assert_failed(pack_save(name, bytes, SIZE, &why), &why, "too long");
    assert_int_equal(entries(), 0);
}

static void put_beside(const char *end, const char *text) {
    char name[192];
    snprintf(name, sizeof name, "%s%s", path, end);
    put_bytes(name, text, strlen(text) + 1);
}

/* What is left of a save that was killed begins as a pack does. */
static void put_left(const char *end) {
    put_beside(end, VIT_PACK_MAGIC);
}

static void drop(const char *end) {
    char name[192];
    snprintf(name, sizeof name, "%s%s", path, end);
    assert_int_equal(unlink(name), 0);
}

static void what_a_killed_process_left_is_removed_by_the_next_save(void **state) {
    (void)state;
    vit_text why = {""};
    put_left(".tmp-4711-0");
    put_left(".tmp-1-12");
    assert_int_equal(pack_save(path, bytes, SIZE, &why), VIT_OK);
    assert_int_equal(entries(), 1);
}

static void files_that_only_look_like_ours_stay(void **state) {
    (void)state;
    static const char *const ends[] = {".tmp", ".tmp-1", ".tmp-1-", ".tmp--1", ".tmp-1-2x", ".tmp-x-1", "x.tmp-1-2"};
    enum { ENDS = sizeof ends / sizeof ends[0] };
    vit_text why = {""};
    for (int i = 0; i < ENDS; i++)
        put_left(ends[i]);
    assert_int_equal(pack_save(path, bytes, SIZE, &why), VIT_OK);
    assert_int_equal(entries(), 1 + ENDS);
    for (int i = 0; i < ENDS; i++)
        drop(ends[i]);
}

/* A part of a scene under such a name, say. */
static void files_of_others_under_our_names_stay(void **state) {
    (void)state;
    vit_text why = {""};
    put_beside(".tmp-4711-0", "fov = 60.0;");
    assert_int_equal(pack_save(path, bytes, SIZE, &why), VIT_OK);
    assert_int_equal(entries(), 2);
    drop(".tmp-4711-0");
}

/* Links stay links: what they lead to is written. */
static void a_link_is_followed(void **state) {
    (void)state;
    char name[192];
    struct stat link;
    vit_text why = {""};
    put_left(".target");
    snprintf(name, sizeof name, "%s.target", path);
    assert_int_equal(symlink(name, path), 0);
    assert_int_equal(pack_save(path, bytes, SIZE, &why), VIT_OK);
    assert_int_equal(lstat(path, &link), 0);
    assert_true(S_ISLNK(link.st_mode));
    assert_int_equal(lstat(name, &link), 0);
    assert_int_equal(link.st_size, SIZE);
    drop(".target");
    assert_failed(pack_save(path, bytes, SIZE, &why), &why, "leads nowhere");
    assert_int_equal(unlink(path), 0);
}

/* A second process that is in the middle of saving to the same name. */
static void what_a_living_process_writes_stays(void **state) {
    (void)state;
    int ends[2];
    char byte = 0;
    vit_text why = {""};
    assert_int_equal(pipe(ends), 0);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        char name[192];
        snprintf(name, sizeof name, "%s.tmp-4711-0", path);
        const int file = open(name, O_WRONLY | O_CREAT | O_EXCL, 0666);
        const struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
        if (fcntl(file, F_SETLK, &whole) == 0 && write(ends[1], "x", 1) == 1)
            pause();
        _exit(1);
    }
    close(ends[1]);
    assert_int_equal(read(ends[0], &byte, 1), 1);
    close(ends[0]);
    assert_int_equal(pack_save(path, bytes, SIZE, &why), VIT_OK);
    assert_int_equal(entries(), 2);
    assert_int_equal(kill(child, SIGKILL), 0);
    assert_int_equal(waitpid(child, NULL, 0), child);
    assert_int_equal(pack_save(path, bytes, SIZE, &why), VIT_OK);
    assert_int_equal(entries(), 1);
}

static void abandon_and_leave(int signal_number) {
    (void)signal_number;
    pack_abandon();
    _exit(ABANDONED);
}

/* Saves in a child process that may write LIMIT bytes a file; returns its exit code. */
static int save_with_a_limit(void (*handler)(int)) {
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        const struct sigaction action = {.sa_handler = handler};
        const struct rlimit limit = {LIMIT, LIMIT};
        vit_text why = {""};
        if (sigaction(SIGXFSZ, &action, NULL) != 0 || setrlimit(RLIMIT_FSIZE, &limit) != 0)
            _exit(99);
        vit_status status = pack_save(path, bytes, SIZE, &why);
        _exit(strstr(why.text, "write: ") ? (int)status : 98);
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static void a_write_that_breaks_off_leaves_nothing(void **state) {
    (void)state;
    assert_int_equal(save_with_a_limit(SIG_IGN), VIT_FAILED);
    assert_int_equal(entries(), 0);
}

static void a_write_that_breaks_off_leaves_the_pack_before_it_whole(void **state) {
    (void)state;
    vit_text why = {""};
    assert_int_equal(pack_save(path, "before", 6, &why), VIT_OK);
    assert_int_equal(save_with_a_limit(SIG_IGN), VIT_FAILED);
    assert_file_holds((const unsigned char *)"before", 6);
    assert_int_equal(entries(), 1);
}

static void a_signal_in_the_middle_of_a_write_leaves_nothing(void **state) {
    (void)state;
    assert_int_equal(save_with_a_limit(abandon_and_leave), ABANDONED);
    assert_int_equal(entries(), 0);
}

int main(void) {
#define IN_A_FOLDER(test) cmocka_unit_test_setup_teardown(test, make_folder, remove_folder)
    static const struct CMUnitTest tests[] = {
        IN_A_FOLDER(a_saved_pack_holds_the_bytes_and_is_alone_in_its_folder),
        IN_A_FOLDER(a_saved_pack_replaces_the_one_before_and_cannot_be_abandoned),
        IN_A_FOLDER(a_pack_is_as_readable_as_the_umask_says),
        IN_A_FOLDER(a_name_without_a_folder_means_this_folder),
        IN_A_FOLDER(a_folder_that_is_not_there_is_named),
        IN_A_FOLDER(a_folder_that_is_read_only_stays_empty),
        IN_A_FOLDER(what_is_not_a_file_is_not_replaced),
        IN_A_FOLDER(a_name_that_is_too_long_is_refused),
        IN_A_FOLDER(a_write_that_breaks_off_leaves_nothing),
        IN_A_FOLDER(a_write_that_breaks_off_leaves_the_pack_before_it_whole),
        IN_A_FOLDER(a_signal_in_the_middle_of_a_write_leaves_nothing),
        IN_A_FOLDER(what_a_killed_process_left_is_removed_by_the_next_save),
        IN_A_FOLDER(files_that_only_look_like_ours_stay),
        IN_A_FOLDER(files_of_others_under_our_names_stay),
        IN_A_FOLDER(a_link_is_followed),
        IN_A_FOLDER(what_a_living_process_writes_stays),
    };
#undef IN_A_FOLDER
    return cmocka_run_group_tests_name("saving a pack", tests, NULL, NULL);
}
