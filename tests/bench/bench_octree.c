/* The plain octree and triangle test (kernels/METHODS.md, "What we correct"; tests/baselines/) against our BVH and watertight
 * test, one process, in turn, the same rays on the same device: view rays, and shadow rays of their hits. Hits are compared
 * before anything is timed; what both do for a ray is counted apart, untimed. Then what leaks at shared edges. Cut-outs are
 * filled on both sides. */
#include "measure.h" /* before scene.h, whose type its parameter hides */
#include "octree_leaks.h"
#include "octree_scenes.h"
#include "octree_sides.h"

#define ROUNDS 7
#define NEAR_TIE 1e-4f /* of the distance: another triangle so near is a shared edge or a tie */

enum { SIDE_OCTREE, SIDE_1, SIDE_8, SIDE_16, SIDES };
static const unsigned side_lanes[SIDES] = {0, 1, 8, 16};
static const char *const side_names[SIDES] = {"octree", "BVH, 1 lane", "BVH, 8 lanes", "BVH, 16 lanes"};
static const char *const cast_names[CASTS] = {"view rays", "shadow rays"};

typedef struct race {
    const char *scene;
    uint32_t triangles, tree_nodes, tree_depth, rays[CASTS];
    double tree_seconds, work[SIDES][CASTS][2];
    octree o; /* sizes; its arrays are freed */
    series ms[SIDES][CASTS];
} race;

/* Equal triangles, or which way they differ. */
static void verify_view(const race *r, side sides[SIDES]) {
    uint32_t *theirs = side_read(&sides[SIDE_OCTREE], sides[SIDE_OCTREE].triangle), n = sides[0].n, hits = 0;
    float *t = side_read(&sides[SIDE_OCTREE], sides[SIDE_OCTREE].distance);
    uint32_t *ours = side_read(&sides[SIDE_1], sides[SIDE_1].triangle), same = 0, tie = 0, lost = 0, far = 0, near = 0;
    float *own = side_read(&sides[SIDE_1], sides[SIDE_1].distance);
    for (uint32_t i = 0; i < n; i++) {
        hits += ours[i] != VIT_NONE;
        if (ours[i] == theirs[i])
            same++;
        else if (ours[i] != VIT_NONE && theirs[i] != VIT_NONE && fabsf(t[i] - own[i]) <= NEAR_TIE * own[i])
            tie++;
        else if (theirs[i] == VIT_NONE)
            lost++;
        else if (ours[i] != VIT_NONE && t[i] > own[i])
            far++;
        else
            near++;
    }
    printf(
        "%-8s view rays: %u, hits %u, the same triangle or none %u; another at the same distance %u; the octree's ray goes on "
        "to a farther one %u, to nothing %u, ends at a nearer one %u\n",
        r->scene, n, hits, same, tie, far, lost, near);
    if (same + tie < 0.999 * n)
        bench_fail("%s: the octree's hits are not the BVH's", r->scene);
    for (int s = SIDE_8; s < SIDES; s++) {
        uint32_t *wide = side_read(&sides[s], sides[s].triangle);
        if (memcmp(wide, ours, (size_t)n * 4) != 0)
            bench_fail("%s: %s finds other hits than one lane", r->scene, side_names[s]);
        free(wide);
    }
    free(theirs);
    free(t);
    free(ours);
    free(own);
}

static void verify_shadow(const race *r, side sides[SIDES], const ray_set *rays) {
    uint32_t *found[SIDES], apart[SIDES] = {0}, dark = 0;
    for (int s = 0; s < SIDES; s++)
        found[s] = side_read(&sides[s], sides[s].occluded);
    for (uint32_t i = 0; i < rays->n; i++) {
        dark += found[SIDE_1][i];
        for (int s = 0; s < SIDES; s++)
            apart[s] += found[s][i] != found[SIDE_1][i];
    }
    printf("%-8s shadow rays: %u, occluded %u; the octree says otherwise on %u\n", r->scene, r->rays[CAST_SHADOW], dark,
           apart[SIDE_OCTREE]);
    if (apart[SIDE_8] + apart[SIDE_16] > 0 || apart[SIDE_OCTREE] > 0.001 * r->rays[CAST_SHADOW])
        bench_fail("%s: shadows differ", r->scene);
    for (int s = 0; s < SIDES; s++)
        free(found[s]);
}

static void count_work(race *r, const raced_scene *place, const octree *o, const ray_set rays[CASTS]) {
    for (int s = 0; s < SIDES; s++) {
        side counting = side_open(side_names[s], side_lanes[s], &place->mesh, o, rays[0].n, true);
        for (int c = 0; c < CASTS; c++)
            side_work(&counting, c, &rays[c], r->work[s][c]);
        side_close(&counting);
    }
}

static race race_run(raced_scene *place) {
    race r = {.scene = place->name, .triangles = place->mesh.m.triangles};
    side sides[SIDES];
    ray_set rays[CASTS] = {rays_of_view(place), {0}};
    octree o = octree_of(&place->mesh, OCTREE_USUAL);
    r.tree_nodes = place->mesh.tree.node_count;
    r.tree_depth = place->mesh.tree.depth;
    r.tree_seconds = place->mesh.tree.build_seconds;
    r.rays[CAST_VIEW] = rays[0].n;
    for (int s = 0; s < SIDES; s++) {
        sides[s] = side_open(side_names[s], side_lanes[s], &place->mesh, &o, rays[0].n, false);
        side_rays(&sides[s], CAST_VIEW, &rays[0]);
        side_run(&sides[s], CAST_VIEW);
    }
    verify_view(&r, sides);
    float *t = side_read(&sides[SIDE_1], sides[SIDE_1].distance);
    uint32_t *hit = side_read(&sides[SIDE_1], sides[SIDE_1].triangle);
    rays[CAST_SHADOW] = rays_of_shadow(place, &rays[0], t, hit, &r.rays[CAST_SHADOW]);
    free(t);
    free(hit);
    for (int s = 0; s < SIDES; s++) {
        side_rays(&sides[s], CAST_SHADOW, &rays[CAST_SHADOW]);
        side_run(&sides[s], CAST_SHADOW);
    }
    verify_shadow(&r, sides, &rays[CAST_SHADOW]);
    count_work(&r, place, &o, rays);
    for (int round = 0; round < bench_rounds(ROUNDS); round++)
        for (int c = 0; c < CASTS; c++)
            for (int s = 0; s < SIDES; s++)
                series_add(&r.ms[s][c], side_run(&sides[s], c));
    for (int s = 0; s < SIDES; s++)
        side_close(&sides[s]);
    free(rays[0].plane);
    free(rays[1].plane);
    r.o = o;
    octree_free(&o);
    mesh_free(&place->mesh);
    return r;
}

static void report_trees(csv *c, const race *r) {
    const double mib = 1.0 / (1 << 20), nodes = (double)sizeof(octree_node) * r->o.node_count;
    const series build[] = {series_exact(r->o.build_seconds), series_exact(r->tree_seconds)};
    printf("%-8s %8u | %9u %9u %5u %9u %7.1f %7.2f | %9u %5u %7.1f %7.2f\n", r->scene, r->triangles, r->o.node_count,
           r->o.empty, r->o.depth, r->o.index_count, (nodes + 4.0 * r->o.index_count) * mib, build[0].value[0], r->tree_nodes,
           r->tree_depth, (double)sizeof(vit_bvh_node) * r->tree_nodes * mib, build[1].value[0]);
    csv_row(c, r->scene, PICTURE_SIZE, "octree, build", &build[0], "s");
    csv_row(c, r->scene, PICTURE_SIZE, "BVH, build", &build[1], "s");
}

static void report_rates(csv *c, const race *r, int cast) {
    char what[96];
    double rate[SIDES];
    printf("%-8s %-12s", r->scene, cast_names[cast]);
    for (int s = 0; s < SIDES; s++) {
        const series rates = series_rate(&r->ms[s][cast], 1e-3 * r->rays[cast]);
        rate[s] = series_median(&rates);
        printf(" %8.2f", rate[s]);
        snprintf(what, sizeof what, "%s, %s", cast_names[cast], side_names[s]);
        csv_row(c, r->scene, PICTURE_SIZE, what, &rates, "Mray/s");
    }
    for (int s = SIDE_1; s < SIDES; s++) {
        const series quotient = series_exact(rate[s] / rate[SIDE_OCTREE]);
        printf(" %6.1fx", quotient.value[0]);
        snprintf(what, sizeof what, "%s, %s / octree", cast_names[cast], side_names[s]);
        csv_row(c, r->scene, PICTURE_SIZE, what, &quotient, "ratio");
    }
    printf("   boxes");
    for (int s = 0; s < SIDES; s++)
        printf(" %6.1f", r->work[s][cast][0] / r->rays[cast]);
    printf("   triangles");
    for (int s = 0; s < SIDES; s++)
        printf(" %6.1f", r->work[s][cast][1] / r->rays[cast]);
    printf("\n");
}

static void report(csv *c, const race *races, int count) {
    printf("\n%-8s %8s | %9s %9s %5s %9s %7s %7s | %9s %5s %7s %7s\n", "scene", "triangles", "octants", "empty", "depth",
           "entries", "MiB", "s", "BVH nodes", "depth", "MiB", "s");
    for (int i = 0; i < count; i++)
        report_trees(c, &races[i]);
    printf("\nM rays/s, medians of %d; BVH at 1, 8, 16 lanes over the octree; a ray's octants entered, or boxes tested at 1, "
           "8, 16 "
           "lanes, and triangles tested\n%-8s %-12s %8s %8s %8s %8s %7s %7s %7s\n",
           bench_rounds(ROUNDS), "scene", "rays", "octree", "BVH 1", "BVH 8", "BVH 16", "1", "8", "16");
    for (int i = 0; i < count; i++)
        for (int k = 0; k < CASTS; k++)
            report_rates(c, &races[i], k);
}

static void race_add(race *races, int *count, const char *name, const char *path) {
    raced_scene place = scene_load(name, path);
    races[(*count)++] = race_run(&place);
}

int main(void) {
    csv c = csv_open("octree");
    const bench_scene *others[] = {bench_scene_named("sponza"), &octree_bunny};
    race *races = bench_array(4, sizeof *races);
    int count = 0;
    char path[BENCH_PATH];
    race_add(races, &count, "cornell", VIT_BUILD_DIR "/scenes/cornell.cfg");
    if (!bench_smoke())
        race_add(races, &count, "atrium", VIT_BUILD_DIR "/scenes/atrium.cfg");
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (octree_scene_file(others[i], path))
            race_add(races, &count, others[i]->name, path);
    report(&c, races, count);
    leaks_compare(&c);
    csv_close(&c, "octree");
    free(races);
    return VIT_OK;
}
