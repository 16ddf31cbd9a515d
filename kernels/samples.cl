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
    li hit = L_NE(triangle, L_I((int)VIT_NONE));
    lv3 light = lv3_load(scene->background); /* radiance that needs no light source: emission and background; direct light is added to it */
    WORK_BEGIN
    WORK_LANES(surface_points, hit);
    if (l_any(hit)) {
        lv3 eye = lv3_load(camera->eye), d = l_camera_ray(camera, x, y);
        lf t = l_sel(hit, L_LOAD(hit_distance + first), L_F(1));
        float rx = camera->right[0], ry = camera->right[1], rz = camera->right[2];
        surface s = surface_at(SURFACE_SCENE, eye, d, t, hit, triangle, L_F(vit_sqrt(fma(rz, rz, fma(ry, ry, rx * rx)))));
        WORK_LANES(texture_fetches, s.textured);
        /* Lanes that hit nothing are zeros, as in packets that hit nothing: traces are the same at every width. */
        sample_store_position(scene, s.position, s.face, hit, position, first);
        L_STORE(l_sel_u(hit, l_encode_normal(s.normal), L_U(0)), normal + first);
        L_STORE(l_sel_u(hit, l_encode_albedo(s.albedo) | l_sel_u(s.dark, L_U(VIT_SAMPLE_DARK), L_U(0)), L_U(VIT_SAMPLE_NOTHING)), albedo + first);
        light = lv3_sel(hit, s.emission, light);
        if (VIT_EFFECT_ZONES || VIT_EFFECT_AREA) {
            cell_place cell = cell_at(sides, hit, triangle, s.back, s.b1, s.b2);
            if (VIT_EFFECT_ZONES)
                L_STORE(l_sel_u(hit, cell_accept(cells, &cell), L_U(0)), accept + first);
            if (VIT_EFFECT_AREA)
                L_STORE(l_sel(hit, cell_inverse_area(cells, &cell), L_F(0)), inverse_area + first);
        }
        lv3_store_planes(light, direct, n, first);
    } else if (l_any(L_NE(L_AS_INT(L_LOAD(albedo + first)), L_I((int)VIT_SAMPLE_NOTHING)))) { /* else all this stands there, of a frame before */
        lv3 zero = lv3_set(L_F(0), L_F(0), L_F(0));
        sample_store_position(scene, zero, zero, L_I(0), position, first);
        L_STORE(L_U(0), normal + first);
        L_STORE(L_U(VIT_SAMPLE_NOTHING), albedo + first);
        if (VIT_EFFECT_ZONES)
            L_STORE(L_U(0), accept + first);
        if (VIT_EFFECT_AREA)
            L_STORE(L_F(0), inverse_area + first);
        lv3_store_planes(light, direct, n, first);
    }
    WORK_END
}
