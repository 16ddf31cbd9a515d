/* Rays from inside closed meshes, as tests/numeric/test_watertight.c casts them: how many find nothing by the watertight test, and
 * by Moeller and Trumbore's. */
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

static inline void leaks_report(csv *c, const char *what, const leaks *sum) {
    const uint64_t all = sum->theirs[0] + sum->theirs[1] + sum->theirs[2] + sum->theirs[3];
    const double quarter = (double)sum->rays / AIMS / 100.0;
    const series ours = series_exact((double)sum->ours), theirs = series_exact((double)all);
    printf("%-36s %9llu %6llu %9llu %9.3f %9.3f %9.3f %9.4f   %u of %u\n", what, (unsigned long long)sum->rays,
           (unsigned long long)sum->ours, (unsigned long long)all, (double)sum->theirs[AT_VERTEX] / quarter,
           (double)sum->theirs[AT_EDGE] / quarter, (double)sum->theirs[AT_MIDDLE_OF_EDGE] / quarter,
           (double)sum->theirs[AT_ANY] / quarter, sum->still, sum->checked);
    csv_row(c, "closed", what, "leaks, ours", &ours, "rays");
    csv_row(c, "closed", what, "leaks, Moeller-Trumbore", &theirs, "rays");
    if (sum->ours > 0)
        bench_fail("%s: ours leak", what);
}

static inline void leaks_compare(csv *c) {
    lab l = octree_lab_open(ray_lab_kernels);
    printf("\n%-36s %9s %6s %9s %9s %9s %9s %9s   %s\n", "rays that leak", "rays", "ours", "M.-T.", "vertex %", "edge %",
           "middle %", "any %", "without the octree too");
    for (int i = 0; i < CLOSED_MESHES; i++) {
        ray_mesh r;
        leaks sum = {0};
        uint64_t state = 7;
        mesh_cube(&r, closed_meshes[i].squares, closed_meshes[i].place);
        mesh_bake(&r);
        octree o = octree_of(&r, OCTREE_USUAL);
        ray_set s = rays_new(LEAK_BATCH);
        for (int batch = 0; batch < LEAK_BATCHES; batch++) {
            closed_aim(&s, &r, &state, closed_meshes[i].half);
            leaks_count(&l, &r, &o, &s, &sum);
        }
        leaks_report(c, closed_meshes[i].what, &sum);
        free(s.plane);
        octree_free(&o);
        mesh_free(&r);
    }
    lab_close(&l);
}

#endif
