/* The pass visibility: the nearest triangle along each pixel's ray. For bundles of rays: bundle_visibility.cl. */
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
#endif
