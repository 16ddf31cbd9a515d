/* Pass 1: the nearest triangle along each pixel's ray. */
#if VIT_BUNDLE == 1
kernel void visibility(RAY_SCENE_PARAMETERS, global const vit_camera *cameras, uint frame, global uint *hit_triangle, global float *hit_distance WORK_PARAMETERS)
{
    uint first = (uint)get_global_id(0) * VIT_LANES;
    if (first >= scene->samples)
        return;
    li x, y;
    l_pixel(scene, first, &x, &y);
    li inside = l_inside(scene, x, y);
    lf t = L_F(3e38f);
    li triangle = L_I((int)VIT_NONE);
    WORK_BEGIN
    WORK_LANES(view_rays, inside);
    if (l_any(inside)) {
        global const vit_camera *camera = cameras + frame;
        ray_packet r = ray_make(lv3_load(camera->eye), l_camera_ray(camera, x, y));
        ray_nearest(RAY_SCENE, &r, inside, &t, &triangle);
        WORK_TRACED(r);
    }
    L_STORE(L_AS_UINT(triangle), hit_triangle + first);
    L_STORE(t, hit_distance + first);
    WORK_END
}
#else
kernel void visibility(RAY_SCENE_PARAMETERS, global const vit_camera *cameras, uint frame, global uint *hit_triangle, global float *hit_distance WORK_PARAMETERS)
{
    uint bundle = (uint)get_global_id(0);
    if (bundle * (VIT_BUNDLE * VIT_LANES) >= scene->samples)
        return;
    global const vit_camera *camera = cameras + frame;
    ray_bundle b;
    WORK_BEGIN
    for (uint i = 0; i < VIT_BUNDLE; i++) {
        li x, y;
        l_pixel(scene, bundle_first(scene, bundle, i), &x, &y);
        b.active[i] = l_inside(scene, x, y);
        b.t[i] = L_F(3e38f);
        b.ray[i] = ray_make(lv3_load(camera->eye), l_camera_ray(camera, x, y));
        WORK_LANES(view_rays, b.active[i]);
    }
    bundle_nearest(RAY_SCENE, &b);
    for (uint i = 0; i < VIT_BUNDLE; i++) {
        uint first = bundle_first(scene, bundle, i);
        L_STORE(L_AS_UINT(b.triangle[i]), hit_triangle + first);
        L_STORE(b.t[i], hit_distance + first);
        WORK_TRACED(b.ray[i]);
    }
    WORK_END
}
#endif
