/* From starting vitrine-play to its first frame: with an empty cache of compiled kernels, and with a full one. The pack is in
 * the system's file cache in both. Also the share of it that needs no device: mapping and checking the pack. */
#include "scenes.h"

#define COLD_RUNS 5
#define WARM_RUNS 11

/* Milliseconds till the first frame's hash is printed. */
static double first_frame(char *pack, const char *cache) {
    char player[] = VIT_BUILD_DIR "/vitrine-play", frames[] = "--frames", one[] = "0", hash[] = "--hash", quiet[] = "--quiet";
    char *const argv[] = {player, pack, frames, one, hash, quiet, NULL};
    return child_run(argv, cache, true);
}

static double check_alone(char *pack) {
    char player[] = VIT_BUILD_DIR "/vitrine-play", explain[] = "--explain";
    char *const argv[] = {player, pack, explain, NULL};
    return child_run(argv, NULL, false);
}

static void report(csv *c, const char *scene, const char *size, const char *what, const series *s) {
    printf("%-8s %-10s %-32s %9.1f +- %6.1f ms (%d)\n", scene, size, what, series_median(s), series_mad(s), s->count);
    csv_row(c, scene, size, what, s, "ms");
}

static void run(csv *c, const char *scene, const char *size, char *pack) {
    const char *cache = BENCH_FOLDER "/kernels";
    series cold = {.count = 0}, warm = {.count = 0}, check = {.count = 0};
    check_alone(pack); /* reads the pack into the file cache */
    for (int i = 0; i < bench_rounds(COLD_RUNS); i++) {
        child_remove(cache);
        bench_folder(cache);
        series_add(&cold, first_frame(pack, cache));
    }
    for (int i = 0; i < bench_rounds(WARM_RUNS); i++) {
        series_add(&warm, first_frame(pack, cache));
        series_add(&check, check_alone(pack));
    }
    child_remove(cache);
    report(c, scene, size, "first frame, cold", &cold);
    report(c, scene, size, "first frame, warm", &warm);
    report(c, scene, size, "of it: pack mapped and checked", &check);
}

int main(void) {
    csv c = csv_open("open");
    for (size_t i = 0; i < BENCH_SCENES; i++) {
        char pack[BENCH_PATH];
        if (scene_pack(&bench_scenes[i], bench_size(0), pack))
            run(&c, bench_scenes[i].name, bench_size(0), pack);
    }
    csv_close(&c, "open");
    return VIT_OK;
}
