/* Which device plays: names, numbers, and what is done where the device that would play cannot.
 *
 * Why this is hard: what keeps OpenCL from playing is the machine's: a full disk, a folder that may not be written, a driver
 * that is not there. Strategy: each is made for one run of the real player by its environment and limits; what needs a mount is
 * left out with a message where the test may not mount. The picture must be there in any case, with the golden hashes, and one
 * line that names the folder and the cure. PoCL's variables also make several devices of one, and devices with small
 * work-groups. */
#define _GNU_SOURCE /* mount, unshare */
#include "test_packs.h"
#include "vitrine.h"

#include <ctype.h>
#include <sched.h>
#include <stdbool.h>
#include <sys/mount.h>
#include <sys/resource.h>

#define FOLDER TEST_PACKS "/devices"
#define CURE "set POCL_CACHE_DIR to a folder with room"
#define ON_HOST "playing on the built-in device host"

static tool_run r;

/* What is mounted is seen by this process and its children alone, and goes with them, however they end. */
static bool may_mount;

static int set_up(void **state) {
    (void)state;
    test_packs_begin();
    folder_make(FOLDER);
    may_mount = unshare(CLONE_NEWNS) == 0 && mount(NULL, "/", NULL, MS_REC | MS_PRIVATE, NULL) == 0;
    return 0;
}

static bool mount_small(const char *folder, const char *size) {
    return may_mount && mount("tmpfs", folder, "tmpfs", 0, size) == 0;
}

static int has_pocl(void) {
    tool(&r, TOOL_PLAY " --list-devices");
    tool_succeeds(&r);
    return strstr(r.out, "Portable Computing Language") != NULL;
}

static int lines_of(const char *text) {
    int lines = 0;
    for (; *text; text++)
        lines += *text == '\n';
    return lines;
}

/* The player, without --device, in an environment in which PoCL cannot compile: `cause` is named. */
static void plays_on_host(const char *environment, const char *cause) {
    const char *pack = test_pack("list");
    tool(&r, "%s " TOOL_PLAY " %s --verify --quiet", environment, pack);
    tool_succeeds(&r);
    if (lines_of(r.err) != 1 || !strstr(r.err, ON_HOST) || !strstr(r.err, CURE) || !strstr(r.err, cause))
        fail_msg("%s\none line must say that it plays on host, '%s' and how to mend it: %s", r.line, cause, r.err);
    tool(&r, "%s " TOOL_PLAY " --list-devices", environment);
    tool_succeeds(&r);
    if (!strstr(r.err, CURE) || !strstr(r.err, cause))
        fail_msg("%s\nmust say '%s' and how to mend it: %s", r.line, cause, r.err);
    tool(&r, "%s " TOOL_PLAY " %s --verify --device host", environment, pack); /* nothing to tell */
    tool_succeeds(&r);
    assert_null(strstr(r.err, "PoCL"));
    tool(&r, "%s " TOOL_PLAY " %s --verify --device pocl", environment, pack); /* who asks for PoCL gets it or an error */
    tool_refuses(&r, "vitrine-play", VIT_FAILED, CURE);
}

static void a_cache_that_cannot_be_written_plays_on_host(void **state) {
    (void)state;
    if (!has_pocl()) {
        print_message("no PoCL here: its cache is not looked at\n");
        return;
    }
    plays_on_host("POCL_CACHE_DIR=/dev/null/cache", "/dev/null/cache (Not a directory)");
    plays_on_host("HOME=/proc/none", "/proc/none/.cache/pocl (");
    plays_on_host("XDG_CACHE_HOME=/dev/null", "/dev/null/pocl (Not a directory)");
}

static void an_empty_name_of_the_cache_is_none(void **state) {
    (void)state;
    tool(&r, "POCL_CACHE_DIR= " TOOL_PLAY " %s --verify --quiet", test_pack("list"));
    tool_succeeds(&r);
    assert_string_equal(r.err, "");
}

static void a_home_that_is_not_set_is_no_failure(void **state) {
    (void)state;
    tool(&r, "env -u HOME " TOOL_PLAY " %s --verify --quiet", test_pack("list"));
    tool_succeeds(&r);
}

/* PoCL's compiler ends the process when a write fails. */
static void files_that_may_not_grow_play_on_host(void **state) {
    (void)state;
    struct rlimit before, small;
    if (!has_pocl())
        return;
    const char *pack = test_pack("list");
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    small = before;
    small.rlim_cur = 1 << 14;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    tool(&r, "POCL_CACHE_DIR=" FOLDER "/limited " TOOL_PLAY " %s --verify --quiet", pack);
    const tool_run played = r;
    tool(&r, TOOL_PLAY " %s --quiet --device host --out raw:" FOLDER "/large.raw", pack);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    tool_refuses(&r, "vitrine-play", VIT_FAILED, "large.raw: File too large");
    tool_succeeds(&played);
    assert_non_null(strstr(played.err, "16384 bytes"));
    assert_non_null(strstr(played.err, ON_HOST));
    tool(&r, "rm -rf " FOLDER "/limited " FOLDER "/large.raw");
}

/* From nothing at all to nearly enough: PoCL fails in another place each time. With a cache that holds all there is no need of
 * room. */
static void a_full_disk_plays_on_host(void **state) {
    (void)state;
    static const char *const sizes[] = {"size=16k", "size=256k", "size=600k"};
    if (!has_pocl())
        return;
    folder_make(FOLDER "/full");
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        if (!mount_small(FOLDER "/full", sizes[i])) {
            print_message("may not mount here: a full disk is not tried\n");
            break;
        }
        tool(&r, "POCL_CACHE_DIR=" FOLDER "/full " TOOL_PLAY " %s --verify --quiet", test_pack("list"));
        (void)umount(FOLDER "/full");
        tool_succeeds(&r);
        if (lines_of(r.err) != 1 || !strstr(r.err, ON_HOST) || !strstr(r.err, "are left on the disk") || !strstr(r.err, CURE))
            fail_msg("%s: one line must say why: %s", sizes[i], r.err);
    }
    (void)rmdir(FOLDER "/full");
}

/* Who asks for PoCL is told how to mend it, by the tools that play nothing else, too. */
static void the_baker_says_what_keeps_pocl_from_compiling(void **state) {
    (void)state;
    if (!has_pocl())
        return;
    tool(&r, "POCL_CACHE_DIR=/dev/null/x " TOOL_BAKE " " TEST_SCENES
             "/furnace.cfg --size 16x12 --frames 1 --no-check --device pocl --quiet -o " FOLDER "/none.vit");
    tool_refuses(&r, "vitrine-bake", VIT_FAILED, "set POCL_CACHE_DIR to a folder with room");
    folder_make(FOLDER "/none");
    if (!mount_small(FOLDER "/none", "size=16k")) {
        print_message("may not mount here: a full disk is not tried\n");
        return;
    }
    tool(&r, "POCL_CACHE_DIR=" FOLDER "/none " TOOL_BAKE " " TEST_SCENES
             "/furnace.cfg --size 16x12 --frames 1 --no-check --device pocl --quiet -o " FOLDER "/none.vit");
    (void)umount(FOLDER "/none");
    (void)rmdir(FOLDER "/none");
    tool_refuses(&r, "vitrine-bake", VIT_FAILED, "set POCL_CACHE_DIR to a folder with room");
}

static void a_read_only_disk_plays_on_host_whatever_is_in_the_cache(void **state) {
    (void)state;
    if (!has_pocl())
        return;
    folder_make(FOLDER "/filled");
    if (!mount_small(FOLDER "/filled", "size=200m")) {
        print_message("may not mount here: a read-only disk is not tried\n");
        return;
    }
    tool(&r, "POCL_CACHE_DIR=" FOLDER "/filled " TOOL_PLAY " %s --frames 0 --quiet --device pocl", test_pack("list"));
    const int filled = r.code, sealed = mount("tmpfs", FOLDER "/filled", "tmpfs", MS_REMOUNT | MS_RDONLY, "size=200m");
    tool(&r, "POCL_CACHE_DIR=" FOLDER "/filled " TOOL_PLAY " %s --verify --quiet", test_pack("list"));
    (void)umount(FOLDER "/filled");
    (void)rmdir(FOLDER "/filled");
    assert_int_equal(filled, 0);
    assert_int_equal(sealed, 0);
    tool_succeeds(&r);
    assert_non_null(strstr(r.err, "(Read-only file system)"));
    assert_non_null(strstr(r.err, ON_HOST));
}

static void without_a_driver_it_plays_on_host_and_says_what_makes_a_device(void **state) {
    (void)state;
    tool(&r, "OCL_ICD_VENDORS=/nonexistent " TOOL_PLAY " %s --verify", test_pack("list"));
    tool_succeeds(&r);
    assert_non_null(strstr(r.err, ON_HOST));
    tool(&r, "OCL_ICD_VENDORS=/nonexistent " TOOL_PLAY " %s --verify --device gpu", test_pack("list"));
    tool_refuses(&r, "vitrine-play", VIT_FAILED, "there is no device 'gpu'; there are: host");
}

static void the_summary_and_the_report_name_the_device(void **state) {
    (void)state;
    static char json[TOOL_TEXT];
    tool(&r, TOOL_PLAY " %s --device host --report " FOLDER "/out.json", test_pack("list"));
    tool_succeeds(&r);
    assert_non_null(strstr(r.err, " on Vitrine / kernels as C"));
    read_into(FOLDER "/out.json", json, sizeof json);
    (void)unlink(FOLDER "/out.json");
    assert_non_null(strstr(json, "\"device\": \"Vitrine / kernels as C"));
}

/* The device that a name means must play and be named. */
static void means(const char *environment, const char *name, const char *device) {
    tool(&r, "%s " TOOL_PLAY " %s --frames 0 --device %s", environment, test_pack("list"), name);
    tool_succeeds(&r);
    if (!strstr(r.err, device))
        fail_msg("%s\nmust play on '%s': %s", r.line, device, r.err);
}

/* What PoCL's devices of one thread and of many are called: "basic-CPU" and "pthread-CPU", from version 5 on "cpu-minimal-CPU"
 * and "cpu-CPU". */
typedef struct pocl_names {
    char one[32], many[32];
} pocl_names;

static pocl_names names_of_pocl(void) {
    pocl_names n = {"basic", "pthread"};
    tool(&r, "POCL_DEVICES=basic " TOOL_PLAY " --list-devices");
    tool_succeeds(&r);
    const char *minimal = strstr(r.out, "cpu-minimal-");
    if (minimal) {
        (void)snprintf(n.one, sizeof n.one, "cpu-minimal");
        (void)snprintf(n.many, sizeof n.many, "cpu-%.4s", minimal + strlen("cpu-minimal-"));
    }
    return n;
}

static void a_device_is_chosen_by_a_part_of_its_name(void **state) {
    (void)state;
    char part[40], called[40];
    means("", "host", " on Vitrine / ");
    means("", "HOST", " on Vitrine / ");
    if (!has_pocl())
        return;
    const pocl_names pocl = names_of_pocl();
    assert_int_equal(setenv("POCL_DEVICES", "pthread basic", 1), 0);
    means("", "0", " on Portable Computing Language / ");
    means("", "1", " on Portable Computing Language / ");
    (void)snprintf(called, sizeof called, " / %s", pocl.many);
    means("", pocl.many, called);
    (void)snprintf(called, sizeof called, " / %s", pocl.one);
    means("", pocl.one, called);
    for (size_t i = 0; i < sizeof part; i++)
        part[i] = (char)toupper((unsigned char)(i < sizeof pocl.one ? pocl.one[i] : 0));
    means("", part, called);
    tool(&r, TOOL_PLAY " %s --device pocl", test_pack("list"));
    tool_refuses(&r, "vitrine-play", VIT_USAGE, "may be one of several; there are: 0 Portable Computing Language / ");
    assert_non_null(strstr(r.err, "; 1 Portable Computing Language / "));
    assert_non_null(strstr(r.err, "; host"));
    tool(&r, TOOL_PLAY " %s --device 2", test_pack("list"));
    tool_refuses(&r, "vitrine-play", VIT_FAILED, "no device 2, only 0 to 1, and host");
    tool(&r, TOOL_PLAY " %s --device 99999999999999999999", test_pack("list"));
    tool_refuses(&r, "vitrine-play", VIT_FAILED, "there is no device '99999999999999999999'; there are: 0 Portable");
    tool(&r, TOOL_PLAY " %s --device turbo", test_pack("list"));
    tool_refuses(&r, "vitrine-play", VIT_FAILED, "there is no device 'turbo'; there are: 0 Portable");
    tool(&r, TOOL_PLAY " %s --device=", test_pack("list"));
    tool_refuses(&r, "vitrine-play", VIT_USAGE, "--device takes");
    assert_int_equal(setenv("POCL_DEVICES", "basic basic", 1), 0); /* the same name twice: either has the same bits and speed */
    means("", "pocl", called);
    means("", "cpu", called);
    assert_int_equal(unsetenv("POCL_DEVICES"), 0);
}

static void a_device_of_small_work_groups_plays_and_a_group_that_it_has_not_is_refused_at_open(void **state) {
    (void)state;
    static const char *const packs[] = {"list", "room-buckets"};
    if (!has_pocl())
        return;
    for (size_t i = 0; i < 2; i++) {
        tool(&r, "POCL_MAX_WORK_GROUP_SIZE=8 " TOOL_PLAY " %s --verify --quiet --device pocl", test_pack(packs[i]));
        tool_succeeds(&r);
        tool(&r, "POCL_MAX_WORK_GROUP_SIZE=3 " TOOL_PLAY " %s --verify --quiet --device pocl --lanes 1", test_pack(packs[i]));
        tool_succeeds(&r);
    }
    tool(&r, "POCL_MAX_WORK_GROUP_SIZE=8 " TOOL_PLAY " %s --verify --quiet --device pocl --group 16", test_pack("list"));
    tool_refuses(&r, "vitrine-play", VIT_USAGE, "group 16: ");
    assert_non_null(strstr(r.err, "at most 8 work-items"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cache_that_cannot_be_written_plays_on_host),
        cmocka_unit_test(an_empty_name_of_the_cache_is_none),
        cmocka_unit_test(a_home_that_is_not_set_is_no_failure),
        cmocka_unit_test(files_that_may_not_grow_play_on_host),
        cmocka_unit_test(a_full_disk_plays_on_host),
        cmocka_unit_test(the_baker_says_what_keeps_pocl_from_compiling),
        cmocka_unit_test(a_read_only_disk_plays_on_host_whatever_is_in_the_cache),
        cmocka_unit_test(without_a_driver_it_plays_on_host_and_says_what_makes_a_device),
        cmocka_unit_test(the_summary_and_the_report_name_the_device),
        cmocka_unit_test(a_device_is_chosen_by_a_part_of_its_name),
        cmocka_unit_test(a_device_of_small_work_groups_plays_and_a_group_that_it_has_not_is_refused_at_open),
    };
    return cmocka_run_group_tests_name("devices", tests, set_up, NULL);
}
