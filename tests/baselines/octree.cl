/* One ray a work-item: parametric walk through the octree (Revelles, Urena, Lastra, WSCG 2000) with a stack in place
 * of its recursion, and Moeller and Trumbore's triangle test (JGT 2(1), 1997). Stands behind the library's kernels (strict.clh:
 * no contraction, so that these hits, and what leaks, are the same on every device).
 *
 * The nearest hit is at the least distance in (0, limit]; among equal distances it is the triangle of smallest index. */

#define OCTREE_INNER 0xffffffffu
#define OCTREE_DEEPEST 16
/* Walking on this far behind a hit, in parts of its distance: distances of octants and of triangles are rounded differently. */
#define OCTREE_BEHIND (1.0f + 0x1p-16f)

typedef struct octree_triangle {
    float4 v0, e1, e2;
} octree_triangle;

/* What a ray walks through. box[0], box[1]: the root's corners. index, nodes: octree.h, a node is (first, count). */
#define OCTREE_PARAMETERS                                                                                                      \
    global const float4 *box, global const uint2 *nodes, global const uint *index, global const octree_triangle *triangles
#define OCTREE box, nodes, index, triangles

/* Octants entered and triangles tested; costs nothing where it is not read. */
typedef struct octree_work {
    uint nodes, tests;
} octree_work;

/* Fused, as a compiler that may contract would have it: less work, and two to three times the leaks, since a * b - c * d is no
 * longer exactly opposite when a, b and c, d change places. */
#ifndef OCTREE_FUSED
#define OCTREE_FUSED 0
#endif

static inline float octree_dot(float3 a, float3 b) {
    return OCTREE_FUSED ? fma(a.z, b.z, fma(a.y, b.y, a.x * b.x)) : a.x * b.x + a.y * b.y + a.z * b.z;
}

/* a * b - c * d */
static inline float octree_minor(float a, float b, float c, float d) {
    return OCTREE_FUSED ? fma(a, b, -(c * d)) : a * b - c * d;
}

static inline float3 octree_cross(float3 a, float3 b) {
    return (float3)(octree_minor(a.y, b.z, a.z, b.y), octree_minor(a.z, b.x, a.x, b.z), octree_minor(a.x, b.y, a.y, b.x));
}

static inline float octree_most(float3 t) {
    return fmax(t.x, fmax(t.y, t.z));
}

static inline float octree_least(float3 t) {
    return fmin(t.x, fmin(t.y, t.z));
}

/* Distance at which the ray hits the triangle, or 0: (t, u, v) = (Q E2, P T, Q d) / (P E1) with P = d x E2, Q = T x E1, T from
 * the first vertex to o. */
static inline float octree_hit(global const octree_triangle *g, float3 o, float3 d) {
    float3 e1 = g->e1.xyz, e2 = g->e2.xyz, p = octree_cross(d, e2);
    float det = octree_dot(p, e1);
    if (det == 0.0f)
        return 0.0f;
    float inv = 1.0f / det;
    float3 from = o - g->v0.xyz;
    float u = octree_dot(p, from) * inv;
    if (u < 0.0f || u > 1.0f)
        return 0.0f;
    float3 q = octree_cross(from, e1);
    float v = octree_dot(q, d) * inv;
    if (v < 0.0f || u + v > 1.0f)
        return 0.0f;
    return octree_dot(q, e2) * inv;
}

/* An octant on the way down: distances at which the ray crosses its lower and upper planes; its children; the one to come. */
typedef struct octree_frame {
    float3 t0, t1;
    uint first, next;
} octree_frame;

/* The child at distance max(t0, 0): bit by bit, whether the middle plane lies behind the ray there. */
static inline uint octree_first_child(float3 t0, float3 tm) {
    float enter = fmax(octree_most(t0), 0.0f);
    return (tm.x < enter ? 4u : 0u) | (tm.y < enter ? 2u : 0u) | (tm.z < enter ? 1u : 0u);
}

static inline float3 octree_by_bits(uint child, float3 set, float3 clear) {
    return (float3)(child & 4u ? set.x : clear.x, child & 2u ? set.y : clear.y, child & 1u ? set.z : clear.z);
}

/* The child behind the plane through which the ray leaves this one; 8: it leaves the octant. */
static inline uint octree_next_child(uint child, float3 leave) {
    uint bit = leave.x < leave.y ? (leave.x < leave.z ? 4u : 1u) : (leave.y < leave.z ? 2u : 1u);
    return child & bit ? 8u : child | bit;
}

/* Directions are mirrored to be positive: `mirror` has the bits of children to flip. A zero becomes tiny: no 0 * inf. */
static inline uint octree_mirror(global const float4 *box, float3 *o, float3 *d) {
    float3 sum = box[0].xyz + box[1].xyz;
    uint mirror = (d->x < 0.0f ? 4u : 0u) | (d->y < 0.0f ? 2u : 0u) | (d->z < 0.0f ? 1u : 0u);
    *o = octree_by_bits(mirror, sum - *o, *o);
    *d = fmax(fabs(*d), 1e-18f);
    return mirror;
}

/* Nearest hit, or with `any` the first that is found. Returns the triangle or VIT_NONE; *t: limit in, distance out. */
static inline uint octree_walk(OCTREE_PARAMETERS, float3 o, float3 d, int any, float *t, octree_work *work) {
    octree_frame stack[OCTREE_DEEPEST];
    float3 from = o, along = d;
    uint mirror = octree_mirror(box, &from, &along), found = VIT_NONE, node = 0;
    float3 t0 = (box[0].xyz - from) / along, t1 = (box[1].xyz - from) / along;
    float best = *t;
    int depth = 0;
    if (fmax(octree_most(t0), 0.0f) > octree_least(t1))
        return VIT_NONE;
    for (;;) {
        uint2 n = nodes[node];
        uint first = n.x, child;
        work->nodes++;
        if (n.y == OCTREE_INNER) {
            child = octree_first_child(t0, 0.5f * (t0 + t1));
        } else {
            for (uint i = n.x; i < n.x + n.y; i++) {
                uint g = index[i];
                float at = octree_hit(triangles + g, o, d);
                work->tests++;
                if (at > 0.0f && at <= best && (at < best || g < found)) {
                    best = at;
                    found = g;
                    if (any)
                        return found;
                }
            }
            if (depth == 0 || best * OCTREE_BEHIND < octree_least(t1))
                break;
            depth--;
            t0 = stack[depth].t0;
            t1 = stack[depth].t1;
            first = stack[depth].first;
            child = stack[depth].next;
        }
        float3 tm = 0.5f * (t0 + t1), leave = octree_by_bits(child, t1, tm);
        uint next = octree_next_child(child, leave);
        if (next < 8u)
            stack[depth++] = (octree_frame){t0, t1, first, next};
        t0 = octree_by_bits(child, tm, t0);
        t1 = leave;
        node = first + (child ^ mirror);
    }
    *t = best;
    return found;
}

/* Planes of n values: origin, unit direction, limit (negative: no ray). */
#define OCTREE_RAY                                                                                                             \
    uint i = (uint)get_global_id(0), n = count[0];                                                                             \
    float3 o = (float3)(rays[i], rays[n + i], rays[2 * n + i]),                                                                \
           d = (float3)(rays[3 * n + i], rays[4 * n + i], rays[5 * n + i]);                                                    \
    float t = rays[6 * n + i];                                                                                                 \
    octree_work work = {0, 0}

kernel void octree_nearest(OCTREE_PARAMETERS, global const float *rays, global const uint *count, global float *distance,
                           global uint *triangle) {
    OCTREE_RAY;
    triangle[i] = t >= 0.0f ? octree_walk(OCTREE, o, d, 0, &t, &work) : VIT_NONE;
    distance[i] = t;
}

kernel void octree_any(OCTREE_PARAMETERS, global const float *rays, global const uint *count, global uint *occluded) {
    OCTREE_RAY;
    occluded[i] = t >= 0.0f && octree_walk(OCTREE, o, d, 1, &t, &work) != VIT_NONE ? 1u : 0u;
}

/* Sums over no rays but this one: octants and tests, for nearest (any[0] is 0) or any hit. */
kernel void octree_work_of(OCTREE_PARAMETERS, global const float *rays, global const uint *count, global const uint *any,
                           global uint2 *done) {
    OCTREE_RAY;
    if (t >= 0.0f)
        octree_walk(OCTREE, o, d, (int)any[0], &t, &work);
    done[i] = (uint2)(work.nodes, work.tests);
}

/* Without a tree: every triangle, the same test, the same ties. count[1]: triangles. */
kernel void octree_nearest_of_all(OCTREE_PARAMETERS, global const float *rays, global const uint *count, global float *distance,
                                  global uint *triangle) {
    OCTREE_RAY;
    uint found = VIT_NONE;
    for (uint g = 0; t >= 0.0f && g < count[1]; g++) {
        float at = octree_hit(triangles + g, o, d);
        work.tests++;
        if (at > 0.0f && at <= t && (at < t || g < found)) {
            t = at;
            found = g;
        }
    }
    triangle[i] = found;
    distance[i] = t;
}
