/* The pass visibility: the nearest triangle along each pixel's ray. */
#if VIT_BUNDLE == 1
kernel void visibility(RAY_SCENE_PARAMETERS, ROUND_PARAMETERS, global uint *hit_triangle,
                       global float *hit_distance WORK_PARAMETERS) {
    uint first = (uint)get_global_id(0) * VIT_LANES;
    if (first >= scene->samples)
        return;
    if (round_skips(first, active)) {
        L_STORE(L_U(VIT_NONE), hit_triangle + first);
        return;
    }
    li x, y;
    l_pixel(scene, first, &x, &y);
    li inside = round_active(scene, first, x, y, active);
    lf t = L_F(3e38f);
    li triangle = L_I((int)VIT_NONE);
    WORK_BEGIN
    WORK_LANES(view_rays, inside);
    if (l_any(inside)) {
        global const vit_camera *camera = cameras + frame;
        ray_packet r = ray_make(lv3_load(camera->eye), l_camera_ray(scene, camera, round / layers, x, y));
        ray_nearest(RAY_SCENE, &r, inside, &t, &triangle);
        WORK_TRACED(r);
    }
    L_STORE(L_AS_UINT(triangle), hit_triangle + first);
    L_STORE(t, hit_distance + first);
    WORK_END
}
#else
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

/* The rays of packet i. */
static inline ray_packet view_rays(global const vit_scene *scene, ROUND_PARAMETERS, uint bundle, uint i, li *inside) {
    li x, y;
    uint first = bundle_sample(scene, bundle, i);
    l_pixel(scene, first, &x, &y);
    *inside = round_active(scene, first, x, y, active);
    return ray_make(lv3_load((cameras + frame)->eye), l_camera_ray(scene, cameras + frame, round / layers, x, y));
}

kernel void visibility(RAY_SCENE_PARAMETERS, ROUND_PARAMETERS, global uint *hit_triangle,
                       global float *hit_distance WORK_PARAMETERS) {
    uint bundle = (uint)get_global_id(0), px, py;
    if (bundle * 64 >= scene->samples)
        return;
    global const vit_camera *camera = cameras + frame;
    ray_packet ray[VIT_BUNDLE];
    lf t[VIT_BUNDLE];
    li triangle[VIT_BUNDLE], inside[VIT_BUNDLE];
    int made = 0;
    WORK_BEGIN
    /* 1. How many of the bundle's pixels cast a ray. */
    bundle_pixel(scene, bundle, &px, &py);
    uint rays = px < scene->width && py < scene->height ? min(scene->width - px, 8u) * min(scene->height - py, 8u) : 0;
    if (VIT_EFFECT_FILM) {
        rays = 0;
        for (uint i = 0; i < VIT_BUNDLE; i += 16 / VIT_LANES) /* a block at a time */
            rays += popcount(active[bundle_sample(scene, bundle, i) >> 4]);
    }
    if (rays > 0) {
        WORK_ADD(view_rays, rays);
        /* 2. Bounds of their directions: they hold where no axis has both signs. */
        float ox = VIT_EFFECT_ANTIALIAS ? scene->offset[round / layers][0] : 0.0f,
              oy = VIT_EFFECT_ANTIALIAS ? scene->offset[round / layers][1] : 0.0f;
        bundle_bounds bounds;
        float reach = (float)(scene->width + scene->height), largest = bundle_largest(nodes), least2 = 0;
        int one_octant = view_axis(camera, 0, (float)px + ox, (float)py + oy, reach, largest, &bounds.x, &least2) &&
                         view_axis(camera, 1, (float)px + ox, (float)py + oy, reach, largest, &bounds.y, &least2) &&
                         view_axis(camera, 2, (float)px + ox, (float)py + oy, reach, largest, &bounds.z, &least2);
        if (one_octant) {
            /* 3. Down the tree for the bundle; leaves and triangles for each packet, whose rays are made at the first leaf. */
            float scale = vit_div(1.0f + 16 * BUNDLE_SLACK, vit_sqrt(least2)); /* from distances to multiples of directions */
            bundle_walk walk;
            global const float *box;
            uint leaf;
            bounds.limit = 3e38f;
            bundle_begin(&bounds, &walk);
            while ((leaf = bundle_leaf(nodes, &bounds, &walk, &box)) != 0) {
                if (!made) /* many bundles see no leaf */
                    for (uint i = 0; i < VIT_BUNDLE; i++) {
                        ray[i] = view_rays(scene, ROUND, bundle, i, inside + i);
                        t[i] = l_sel(inside[i], L_F(3e38f), L_F(-1));
                        triangle[i] = L_I((int)VIT_NONE);
                    }
                made = 1;
                int any = 0;
                for (uint i = 0; i < VIT_BUNDLE; i++) {
                    li in = bundle_box(ray + i, box, walk.nx, walk.ny, walk.nz, inside[i], t[i]);
                    if (l_any(in))
                        any |= bundle_leaf_nearest(RAY_SCENE, ray + i, leaf, in, t + i, triangle + i);
                }
                if (any) { /* nothing beyond the farthest of the nearest hits matters any more */
                    lf most = t[0];
                    for (uint i = 1; i < VIT_BUNDLE; i++)
                        most = l_max(most, t[i]);
                    float limit = as_float(l_reduce_max(L_AS_INT(most)));
                    bounds.limit = limit < 1e38f ? limit * scale : 3e38f;
                }
            }
        } else { /* 3. Or each packet by itself. */
            for (uint i = 0; i < VIT_BUNDLE; i++) {
                ray[i] = view_rays(scene, ROUND, bundle, i, inside + i);
                t[i] = L_F(3e38f);
                ray_nearest(RAY_SCENE, ray + i, inside[i], t + i, triangle + i);
            }
            made = 1;
        }
    }
    /* 4. Hits, packet by packet. */
    for (uint i = 0; i < VIT_BUNDLE; i++) {
        uint first = bundle_sample(scene, bundle, i);
        if (round_skips(first, active)) {
            L_STORE(L_U(VIT_NONE), hit_triangle + first);
            continue;
        }
        L_STORE(made ? L_AS_UINT(triangle[i]) : L_U(VIT_NONE), hit_triangle + first);
        L_STORE(made ? l_sel(inside[i], t[i], L_F(3e38f)) : L_F(3e38f), hit_distance + first);
        if (made) {
            WORK_TRACED(ray[i]);
        }
    }
    WORK_END
}
#endif
