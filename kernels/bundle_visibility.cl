/* The pass visibility where lanes are more than one: 8 x 8 rays from the camera go down the tree together (bundle.clh). */
#if VIT_BUNDLE > 1
/* The bundle's rays, packet by packet, and their nearest hits. */
typedef struct view_bundle {
    ray_packet ray[VIT_BUNDLE];
    lf t[VIT_BUNDLE];
    li triangle[VIT_BUNDLE], inside[VIT_BUNDLE];
} view_bundle;

/* How many of the bundle's pixels cast a ray; (px, py): its first pixel. */
static inline uint view_count(global const vit_scene *scene, global const uint *active, uint bundle, uint px, uint py) {
    if (VIT_EFFECT_FILM) {
        uint rays = 0;
        for (uint i = 0; i < VIT_BUNDLE; i += 16 / VIT_LANES) /* a block at a time */
            rays += popcount(active[bundle_sample(scene, bundle, i) >> 4]);
        return rays;
    }
    if (px >= scene->width || py >= scene->height)
        return 0;
    return min(scene->width - px, 8u) * min(scene->height - py, 8u);
}

/* Bounds of the bundle's directions along one axis; 0: they have both signs, or nearly. *least2: the least square of them,
 * added up. */
static inline int view_axis(global const vit_camera *camera, int k, float x, float y, float reach, float largest,
                            bundle_axis *axis, float *least2) {
    float right = camera->right[k], down = camera->down[k],
          middle = fma(y + 4.0f, down, fma(x + 4.0f, right, camera->corner[k]));
    float size = vit_max(right, -right) + vit_max(down, -down), corner = vit_max(camera->corner[k], -camera->corner[k]);
    float half_width = fma(size, 3.5f, BUNDLE_SLACK * fma(size, reach, corner)), eye = camera->eye[k];
    float lo = middle - half_width, hi = middle + half_width, least = vit_max(lo, -hi);
    if (!(least > 0))
        return 0;
    *axis = bundle_axis_of(eye, lo, hi, BUNDLE_SLACK * (largest + vit_max(eye, -eye)));
    *least2 = fma(least, least, *least2);
    return 1;
}

/* Bounds of the bundle's directions; 0: an axis has both signs. */
static inline int view_bounds(global const vit_scene *scene, global const vit_camera *camera, global const vit_bvh_node *nodes,
                              uint copy, uint px, uint py, bundle_bounds *bounds, float *least2) {
    float x = (float)px + (VIT_EFFECT_ANTIALIAS ? scene->offset[copy][0] : 0.0f);
    float y = (float)py + (VIT_EFFECT_ANTIALIAS ? scene->offset[copy][1] : 0.0f);
    float reach = (float)(scene->width + scene->height), largest = bundle_largest(nodes);
    *least2 = 0;
    bounds->limit = 3e38f;
    return view_axis(camera, 0, x, y, reach, largest, &bounds->x, least2) &&
           view_axis(camera, 1, x, y, reach, largest, &bounds->y, least2) &&
           view_axis(camera, 2, x, y, reach, largest, &bounds->z, least2);
}

/* Makes the rays, which have hit nothing yet. marked: lanes without a ray count as hit at -1, so that they do not hold back
 * the farthest of the nearest hits. */
static inline void view_make(global const vit_scene *scene, ROUND_PARAMETERS, uint bundle, int marked, view_bundle *v) {
    for (uint i = 0; i < VIT_BUNDLE; i++) {
        li x, y;
        uint first = bundle_sample(scene, bundle, i);
        l_pixel(scene, first, &x, &y);
        v->inside[i] = round_active(scene, first, x, y, active);
        v->ray[i] = ray_make(lv3_load((cameras + frame)->eye), l_camera_ray(scene, cameras + frame, round / layers, x, y));
        v->t[i] = marked ? l_sel(v->inside[i], L_F(3e38f), L_F(-1)) : L_F(3e38f);
        v->triangle[i] = L_I((int)VIT_NONE);
    }
}

/* Down the tree for the bundle; leaves and triangles for each packet. The rays are made at the first leaf, since many bundles
 * see none: was there one? scale: from distances to multiples of directions. */
static inline int view_descend(RAY_SCENE_PARAMETERS, ROUND_PARAMETERS, uint bundle, bundle_bounds *bounds, float scale,
                               view_bundle *v) {
    bundle_walk walk;
    global const float *box;
    uint leaf;
    int made = 0;
    bundle_begin(bounds, &walk);
    while ((leaf = bundle_leaf(nodes, bounds, &walk, &box)) != 0) {
        if (!made)
            view_make(scene, ROUND, bundle, 1, v);
        made = 1;
        int any = 0;
        for (uint i = 0; i < VIT_BUNDLE; i++) {
            li in = bundle_box(v->ray + i, box, walk.nx, walk.ny, walk.nz, v->inside[i], v->t[i]);
            if (l_any(in))
                any |= bundle_leaf_nearest(RAY_SCENE, v->ray + i, leaf, in, v->t + i, v->triangle + i);
        }
        if (any) { /* nothing beyond the farthest of the nearest hits matters any more */
            lf most = v->t[0];
            for (uint i = 1; i < VIT_BUNDLE; i++)
                most = l_max(most, v->t[i]);
            float limit = as_float(l_reduce_max(L_AS_INT(most)));
            bounds->limit = limit < 1e38f ? limit * scale : 3e38f;
        }
    }
    return made;
}

kernel void visibility(RAY_SCENE_PARAMETERS, ROUND_PARAMETERS, global uint *hit_triangle,
                       global float *hit_distance WORK_PARAMETERS) {
    uint bundle = (uint)get_global_id(0), px, py;
    if (bundle * 64 >= scene->samples)
        return;
    view_bundle v;
    int made = 0;
    WORK_BEGIN
    bundle_pixel(scene, bundle, &px, &py);
    uint rays = view_count(scene, active, bundle, px, py);
    if (rays > 0) {
        WORK_ADD(view_rays, rays);
        bundle_bounds bounds;
        float least2;
        if (view_bounds(scene, cameras + frame, nodes, round / layers, px, py, &bounds, &least2)) {
            /* 1. Together, where bounds of the directions hold, */
            float scale = vit_div(1.0f + 16 * BUNDLE_SLACK, vit_sqrt(least2));
            made = view_descend(RAY_SCENE, ROUND, bundle, &bounds, scale, &v);
        } else {
            /* or each packet by itself. */
            view_make(scene, ROUND, bundle, 0, &v);
            for (uint i = 0; i < VIT_BUNDLE; i++)
                ray_nearest(RAY_SCENE, v.ray + i, v.inside[i], v.t + i, v.triangle + i);
            made = 1;
        }
    }
    /* 2. Hits, packet by packet. */
    for (uint i = 0; i < VIT_BUNDLE; i++) {
        uint first = bundle_sample(scene, bundle, i);
        if (round_skips(first, active)) {
            L_STORE(L_U(VIT_NONE), hit_triangle + first);
            continue;
        }
        L_STORE(made ? L_AS_UINT(v.triangle[i]) : L_U(VIT_NONE), hit_triangle + first);
        L_STORE(made ? l_sel(v.inside[i], v.t[i], L_F(3e38f)) : L_F(3e38f), hit_distance + first);
        if (made) {
            WORK_TRACED(v.ray[i]);
        }
    }
    WORK_END
}
#endif
