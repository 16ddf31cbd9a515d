/* A reference is the same to the bit however it is made: with any number of threads and of MPI ranks, in one go or interrupted
 * and resumed, computed or taken from the cache. For MPI the program runs itself again under mpirun (`--rank`), where it writes
 * the hash of what it got. */
#include "reference/spread.h"
#include "reference_lab.h"
#include "test_folder.h"
#include <dirent.h>

static char program[512]; /* this one's path */

/* A coloured room with a texture, a cut-out curtain and two lights, one of which gives direct light alone; the ceiling shines,
 * too, and one wall is a mirror. */
static void open_room(reference_lab *l) {
    static const float eye[3] = {0.1f, 0.05f, 0.9f}, corner[3] = {-1, 1, -1}, right[3] = {2, 0, 0}, down[3] = {0, -2, 0},
                       curtain[3] = {-0.5f, -0.8f, -0.3f}, x[3] = {1, 0, 0}, y[3] = {0, 1.2f, 0};
    static const bool direct_only[ROOM_LIGHTS] = {false, true};
    room *r = room_closed(0.7f);
    room_paint(r, WALL_LEFT, 0.8f, 0.2f, 0.1f);
    room_paint(r, WALL_RIGHT, 0.2f, 0.6f, 0.3f);
    room_texture(r, WALL_FLOOR, 0, 200, 255, 60, 255);
    room_quad(r, curtain, x, y, 7);
    room_texture(r, 7, 1, 180, 255, 90, 0);
    r->model_materials[7].cutoff = 0.5f;
    r->lights[0] = room_point_light(0.3f, 0.7f, 0.2f, 16);
    r->lights[1] = room_point_light(-0.4f, -0.2f, 0.5f, 16);
    lab_open(l, r, 40, 2, 4);
    lab_look(l, 0, eye, corner, right, down);
    l->in.direct_only = direct_only;
    r->materials[WALL_RIGHT] =
        (vit_material){.texture = VIT_NONE, .specular = {0.9f, 0.8f, 0.7f}, .exponent = 1, .ior = 1, .kind = VIT_MIRROR};
    r->materials[WALL_CEILING].lights = 1;
    r->materials[WALL_CEILING].emission[0] = r->materials[WALL_CEILING].emission[2] = 0.5f;
}

static uint64_t hash_of(const reference *r) {
    const double *const images[] = {r->direct,          r->limited,          r->unlimited,
                                    r->direct_variance, r->limited_variance, r->unlimited_variance};
    uint64_t hash[8] = {r->samples, r->rays};
    for (size_t i = 0; i < 6; i++)
        hash[2 + i] = vit_hash(images[i], (size_t)r->width * r->height * 3 * sizeof(double));
    return vit_hash(hash, sizeof hash);
}

static uint64_t render_hash(reference_lab *l) {
    reference r = lab_render(l, 0);
    const uint64_t hash = hash_of(&r);
    reference_free(&r);
    return hash;
}

/* A folder for caches. */
typedef struct folder {
    char path[TEST_FOLDER];
} folder;

static folder folder_open(void) {
    folder f;
    folder_make_temporary(f.path);
    return f;
}

/* How many files; *name: the last one's path. */
static int folder_files(const folder *f, char name[400]) {
    int files = 0;
    DIR *d = opendir(f->path);
    assert_non_null(d);
    for (struct dirent *e = readdir(d); e; e = readdir(d))
        if (e->d_name[0] != '.') {
            files++;
            path_join(name, 400, f->path, e->d_name);
        }
    (void)closedir(d);
    return files;
}

static void folder_drop(const folder *f) {
    char name[400];
    while (folder_files(f, name) > 0)
        assert_int_equal(unlink(name), 0);
    assert_int_equal(rmdir(f->path), 0);
}

static void threads_change_no_bit(void **state) {
    (void)state;
    reference_lab l;
    open_room(&l);
    const uint64_t one = render_hash(&l);
    for (unsigned threads = 2; threads <= 5; threads++) {
        l.in.threads = threads;
        assert_true(render_hash(&l) == one);
    }
    l.in.max_samples = 128;
    assert_true(render_hash(&l) != one);
    lab_close(&l);
}

static volatile sig_atomic_t cancel;

static void cancel_at_half(void *user, double fraction, double seconds_left) {
    (void)user;
    (void)seconds_left;
    if (fraction > 0.4)
        cancel = 1;
}

static void an_interrupted_reference_is_resumed(void **state) {
    (void)state;
    reference_lab l;
    reference r;
    vit_text why = {""};
    char name[400];
    const folder f = folder_open();
    open_room(&l);
    l.in.max_samples = 256;
    const uint64_t whole = render_hash(&l);
    l.in.cache = f.path;
    l.in.cancel = &cancel;
    l.in.progress = cancel_at_half;
    cancel = 0;
    l.in.threads = 2;
    assert_int_equal(reference_render(&l.in, &r, &why), VIT_FAILED);
    assert_non_null(strstr(why.text, "interrupted"));
    assert_null(r.direct);
    assert_int_equal(folder_files(&f, name), 1);
    l.in.max_samples = 16; /* what there is so far is more */
    cancel = 0;
    r = lab_render(&l, 0);
    assert_in_range(r.samples, 17, 255);
    reference_free(&r);
    l.in.max_samples = 256;
    l.in.progress = NULL;
    assert_true(render_hash(&l) == whole);
    assert_int_equal(folder_files(&f, name), 1);
    folder_drop(&f);
    lab_close(&l);
}

static void never(void *user, double fraction, double seconds_left) {
    (void)seconds_left;
    fail_msg("%s: paths were traced, %g done", (const char *)user, fraction);
}

static void a_finished_reference_is_taken_from_the_cache(void **state) {
    (void)state;
    static char text[] = "cached";
    reference_lab l;
    char name[400];
    const folder f = folder_open();
    open_room(&l);
    l.in.cache = f.path;
    const uint64_t first = render_hash(&l);
    l.in.progress = never;
    l.in.user = text;
    assert_true(render_hash(&l) == first);
    l.lights[0].path_count = 4096; /* photons of the runtime's: no matter */
    l.meta.radius = 3.0f;
    assert_true(render_hash(&l) == first);
    assert_int_equal(folder_files(&f, name), 1);
    folder_drop(&f);
    lab_close(&l);
}

/* Each change of what is seen is another reference. */
static void another_input_is_another_reference(void **state) {
    (void)state;
    reference_lab l;
    char name[400];
    const folder f = folder_open();
    uint64_t hash[12];
    open_room(&l);
    l.in.cache = f.path;
    l.in.max_samples = 16;
    hash[0] = render_hash(&l);
    l.in.bounces = 3;
    hash[1] = render_hash(&l);
    l.in.direct_only = NULL;
    hash[2] = render_hash(&l);
    l.lights[0].intensity[1] = 2.5f;
    hash[3] = render_hash(&l);
    l.cameras[0].eye[0] += 0.1f;
    hash[4] = render_hash(&l);
    l.in.every = 3;
    hash[5] = render_hash(&l);
    l.room->materials[WALL_LEFT].albedo[0] = 0.3f;
    hash[6] = render_hash(&l);
    l.room->materials[WALL_CEILING].lights = 0;
    hash[7] = render_hash(&l);
    l.meta.effects = VIT_BIT(SKY_LIGHT); /* nothing of the sky is seen, but chance does not know */
    l.meta.background[0] = 1;
    hash[8] = render_hash(&l);
    l.meta.ambient[1] = 1;
    hash[9] = render_hash(&l);
    l.meta.copies = 2;
    hash[10] = render_hash(&l);
    l.meta.offset[1][0] = 0.7f;
    hash[11] = render_hash(&l);
    assert_int_equal(folder_files(&f, name), 12);
    for (int i = 0; i < 12; i++)
        for (int k = 0; k < i; k++)
            assert_true(hash[i] != hash[k]);
    folder_drop(&f);
    lab_close(&l);
}

/* Cut short, longer, and each of some bytes changed: ignored, made anew, and replaced. */
static void a_damaged_cache_is_ignored_and_replaced(void **state) {
    (void)state;
    reference_lab l;
    char name[400];
    struct stat there, after;
    const folder f = folder_open();
    open_room(&l);
    l.in.cache = f.path;
    l.in.max_samples = 16;
    const uint64_t good = render_hash(&l);
    assert_int_equal(folder_files(&f, name), 1);
    assert_int_equal(stat(name, &there), 0);
    const long size = (long)there.st_size, places[] = {0, 8, 20, 30, 44, 52, 60, 64, size / 2, size - 1};
    for (size_t i = 0; i < 2 + sizeof places / sizeof *places; i++) {
        if (i == 0)
            assert_int_equal(truncate(name, size - 3), 0);
        else {
            FILE *file = fopen(name, i == 1 ? "ab" : "r+b");
            assert_non_null(file);
            if (i > 1) {
                assert_int_equal(fseek(file, places[i - 2], SEEK_SET), 0);
                const int byte = fgetc(file);
                assert_int_equal(fseek(file, places[i - 2], SEEK_SET), 0);
                assert_true(fputc(byte ^ 0x55, file) != EOF);
            } else
                assert_true(fputc(7, file) != EOF);
            assert_int_equal(fclose(file), 0);
        }
        if (render_hash(&l) != good)
            fail_msg("damage %zu is taken for a good file", i);
        assert_int_equal(stat(name, &after), 0);
        assert_int_equal(after.st_size, size);
        assert_int_equal(folder_files(&f, name), 1);
    }
    folder_drop(&f);
    lab_close(&l);
}

static void a_cache_that_cannot_be_written_is_an_error(void **state) {
    (void)state;
    reference_lab l;
    reference r;
    vit_text why = {""};
    open_room(&l);
    l.in.cache = "/dev/null/references";
    assert_int_equal(reference_render(&l.in, &r, &why), VIT_FAILED);
    assert_non_null(strstr(why.text, "/dev/null/references"));
    lab_close(&l);
}

static void input_out_of_range_is_refused(void **state) {
    (void)state;
    reference_lab l;
    reference r;
    vit_text why;
    open_room(&l);
    const reference_input good = l.in;
    for (int i = 0; i < 6; i++) {
        reference_input in = good;
        *(i == 0   ? &in.frame
          : i == 1 ? &in.every
          : i == 2 ? &in.bounces
                   : &in.max_samples) = i == 0   ? LAB_FRAMES
                                        : i == 3 ? REFERENCE_MOST + 1
                                                 : 0;
        if (i == 5) {
            in = good;
            in.target = 0;
        }
        why.text[0] = '\0';
        assert_int_equal(reference_render(&in, &r, &why), VIT_BAD_INPUT);
        assert_true(why.text[0] != '\0' && r.direct == NULL);
    }
    lab_close(&l);
}

/* What a rank does under mpirun. */
static int be_a_rank(const char *cache) {
    reference_lab l;
    open_room(&l);
    l.in.threads = 0;
    l.in.cache = cache;
    printf("rank %u of %u: %016llx\n", spread_rank(), spread_size(), (unsigned long long)render_hash(&l));
    lab_close(&l);
    spread_end();
    return 0;
}

static void ranks_change_no_bit(void **state) {
    (void)state;
#ifndef VIT_MPI
    printf("skipped: built without MPI (Debian: libopenmpi-dev, openmpi-bin)\n");
    skip();
#endif
    if (system("command -v mpirun > /dev/null") != 0) {
        printf("skipped: there is no mpirun (Debian: openmpi-bin)\n");
        skip();
    }
    reference_lab l;
    open_room(&l);
    const unsigned long long wanted = render_hash(&l);
    lab_close(&l);
    for (unsigned ranks = 1; ranks <= 3; ranks++) {
        char command[1024], line[512], name[400];
        unsigned seen = 0;
        const folder f = folder_open();
        (void)snprintf(
            command, sizeof command,
            "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun --oversubscribe -n %u %s --rank %s 2>&1", ranks,
            program, f.path);
        FILE *p = popen(command, "r");
        assert_non_null(p);
        while (fgets(line, sizeof line, p)) {
            unsigned rank, size;
            unsigned long long hash;
            printf("  %s", line);
            if (sscanf(line, "rank %u of %u: %llx", &rank, &size, &hash) == 3) {
                assert_int_equal(size, ranks);
                assert_true(hash == wanted);
                seen |= 1u << rank;
            }
        }
        assert_int_equal(pclose(p), 0);
        assert_int_equal(seen, (1u << ranks) - 1);
        assert_int_equal(folder_files(&f, name), 1);
        folder_drop(&f);
    }
}

int main(int argc, char **argv) {
    (void)snprintf(program, sizeof program, "%s", argv[0]);
    if (argc == 3 && strcmp(argv[1], "--rank") == 0) {
        spread_begin(&argc, &argv);
        return be_a_rank(argv[2]);
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_change_no_bit),
        cmocka_unit_test(an_interrupted_reference_is_resumed),
        cmocka_unit_test(a_finished_reference_is_taken_from_the_cache),
        cmocka_unit_test(another_input_is_another_reference),
        cmocka_unit_test(a_damaged_cache_is_ignored_and_replaced),
        cmocka_unit_test(a_cache_that_cannot_be_written_is_an_error),
        cmocka_unit_test(input_out_of_range_is_refused),
        cmocka_unit_test(ranks_change_no_bit),
    };
    return cmocka_run_group_tests_name("reference runs", tests, NULL, NULL);
}
