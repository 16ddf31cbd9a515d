/* Pass 2: view samples, what each pixel's ray found. */
kernel void samples(SURFACE_PARAMETERS, global const vit_camera *cameras, uint frame, global const uint *hit_triangle,
                    global const float *hit_distance, global const uint *sides, global const uint *cells, global float *position, global uint *normal, global uint *albedo,
                    global float *direct, global uint *accept, global float *inverse_area WORK_PARAMETERS)
{
    uint first = (uint)get_global_id(0) * VIT_LANES, n = scene->samples;
    if (first >= n)
        return;
    global const vit_camera *camera = cameras + frame;
    li x, y;
    l_pixel(scene, first, &x, &y);
    li triangle = L_AS_INT(L_LOAD(hit_triangle + first));
    li hit = L_NE(triangle, (li)(int)VIT_NONE);
    lv3 light = lv3_load(scene->background);
    WORK_BEGIN
    WORK_LANES(surface_points, hit);
    if (l_any(hit)) {
        lv3 eye = lv3_load(camera->eye), d = l_camera_ray(camera, x, y);
        lf t = l_sel(hit, L_LOAD(hit_distance + first), (lf)1);
        float rx = camera->right[0], ry = camera->right[1], rz = camera->right[2];
        surface s = surface_at(SURFACE_SCENE, eye, d, t, hit, triangle, (lf)sqrt(fma(rz, rz, fma(ry, ry, rx * rx))));
        WORK_LANES(texture_fetches, s.textured);
        /* Lanes that hit nothing are zeros, as in packets that hit nothing: traces are the same at every width. */
        lv3_store_planes(lv3_sel(hit, s.position, lv3_set((lf)0, (lf)0, (lf)0)), position, n, first);
        L_STORE(l_sel_u(hit, l_encode_normal(s.normal), (lu)0), normal + first);
        L_STORE(l_sel_u(hit, l_encode_albedo(s.albedo) | l_sel_u(s.dark, (lu)VIT_SAMPLE_DARK, (lu)0), (lu)0), albedo + first);
        light = lv3_sel(hit, s.emission, light);
#if VIT_EFFECT_ZONES || VIT_EFFECT_AREA
        cell_place cell = cell_at(sides, hit, triangle, s.back, s.b1, s.b2);
#endif
#if VIT_EFFECT_ZONES
        L_STORE(l_sel_u(hit, cell_accept(cells, &cell), (lu)0), accept + first);
#endif
#if VIT_EFFECT_AREA
        L_STORE(l_sel(hit, cell_inverse_area(cells, &cell), (lf)0), inverse_area + first);
#endif
    } else {
        lv3 zero = lv3_set((lf)0, (lf)0, (lf)0);
        lv3_store_planes(zero, position, n, first);
        L_STORE((lu)0, normal + first);
        L_STORE((lu)0, albedo + first);
#if VIT_EFFECT_ZONES
        L_STORE((lu)0, accept + first);
#endif
#if VIT_EFFECT_AREA
        L_STORE((lf)0, inverse_area + first);
#endif
    }
    /* Radiance that needs no light source: emission and background. Direct light is added to it. */
    lv3_store_planes(light, direct, n, first);
    WORK_END
}
