/* Rays from inside closed meshes, as tests/numeric/test_watertight.c casts them: how many find nothing by the watertight test,
 * and by Moeller and Trumbore's. */
#ifndef VIT_BENCH_OCTREE_LEAKS_H
#define VIT_BENCH_OCTREE_LEAKS_H

#include "baselines/octree_lab.h"
#include "closed_meshes.h"
#include "measure.h"

#define LEAK_BATCH (1u << 16)
#define LEAK_BATCHES 8
#define LEAK_CHECKED 1024u /* leaking rays that are cast at every triangle, too: it is not the octree that loses them */

/* By what rays are aimed at: triangle_place() in host_rays.h. */
enum { AT_VERTEX, AT_EDGE, AT_MIDDLE_OF_EDGE, AT_ANY, AIMS };

/* Moeller and Trumbore's test with products rounded, or fused with the sum. */
enum { LEAKS_PLAIN, LEAKS_FUSED, LEAKS_KINDS };
static const char *const leaks_names[LEAKS_KINDS] = {"M.-T.", "M.-T., fma"};
static const char *const leaks_options[LEAKS_KINDS] = {"", OCTREE_WITH_FMA};

typedef struct leaks {
    uint64_t rays, ours, theirs[AIMS];
    uint32_t checked, still;
} leaks;

static inline void leaks_count(lab *l, const ray_mesh *r, const octree *o, const ray_set *s, leaks *sum) {
    ray_hits ours = rays_cast(l, 1, r, s), theirs = octree_cast(l, o, s);
    sum->rays += s->n;
    sum->ours += hits_leaks(&ours);
    for (uint32_t i = 0; i < s->n; i++)
        sum->theirs[i % AIMS] += theirs.triangle[i] == VIT_NONE || theirs.occluded[i] == 0;
    if (sum->checked == 0)
        sum->still = octree_lost_without_tree(l, o, s, &theirs, LEAK_CHECKED, &sum->checked);
    hits_free(&ours);
    hits_free(&theirs);
}

static inline void leaks_report(csv *c, const char *mesh, const char *rival, const leaks *sum) {
    const uint64_t all = sum->theirs[0] + sum->theirs[1] + sum->theirs[2] + sum->theirs[3];
    const double percent = 100.0 * AIMS / (double)sum->rays;
    const series ours = series_exact((double)sum->ours), theirs = series_exact((double)all);
    char what[96];
    printf("%-36s %-10s %8llu %5llu %7llu", mesh, rival, (unsigned long long)sum->rays, (unsigned long long)sum->ours,
           (unsigned long long)all);
    for (int i = 0; i < AIMS; i++)
        printf(" %8.4f", percent * (double)sum->theirs[i]);
    printf("   %u of %u\n", sum->still, sum->checked);
    csv_row(c, "closed", mesh, "leaks, ours", &ours, "rays");
    snprintf(what, sizeof what, "leaks, %s", rival);
    csv_row(c, "closed", mesh, what, &theirs, "rays");
    if (sum->ours > 0)
        bench_fail("%s: ours leak", mesh);
}

static inline leaks leaks_of(lab *l, const closed_mesh *mesh) {
    ray_mesh r;
    leaks sum = {0};
    uint64_t state = 7;
    mesh_cube(&r, mesh->squares, mesh->place);
    mesh_bake(&r);
    octree o = octree_of(&r, OCTREE_USUAL);
    ray_set s = rays_new(LEAK_BATCH);
    for (int batch = 0; batch < bench_rounds(LEAK_BATCHES); batch++) {
        closed_aim(&s, &r, &state, mesh->half);
        leaks_count(l, &r, &o, &s, &sum);
    }
    free(s.plane);
    octree_free(&o);
    mesh_free(&r);
    return sum;
}

static inline void leaks_compare(csv *c) {
    printf("\n%-36s %-10s %8s %5s %7s %8s %8s %8s %8s   %s\n", "rays that leak", "rival", "rays", "ours", "rival's", "vertex %",
           "edge %", "middle %", "any %", "rival's without the octree too");
    for (int kind = 0; kind < LEAKS_KINDS; kind++) {
        lab l = octree_lab_open(leaks_options[kind], ray_lab_kernels);
        for (int i = 0; i < CLOSED_MESHES; i++) {
            const leaks sum = leaks_of(&l, &closed_meshes[i]);
            leaks_report(c, closed_meshes[i].what, leaks_names[kind], &sum);
        }
        lab_close(&l);
    }
}

#endif
