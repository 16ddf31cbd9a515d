/* The passes direct_light and area_light: hard shadows of points and directions, soft ones of surfaces.
 * METHODS.md, "Direct light" (8) and METHODS.md, "Area lights" (10). */

/* Fraction of a light's intensity that goes into direction -l (l: unit, towards the light). glTF KHR_lights_punctual. */
static inline lf light_cone(global const vit_light *light, lv3 l) {
    if (VIT_EFFECT_SPOT && light->kind == VIT_LIGHT_SPOT) {
        lf cosine = -lv3_dot(l, lv3_load(light->direction));
        lf a = l_min(l_max(fma(cosine, L_F(light->spot_scale), L_F(light->spot_offset)), L_F(0)), L_F(1));
        return a * a;
    }
    return L_F(1);
}

/* Irradiance on a surface facing the light, a unit of intensity, at squared distance d2: 1/m2. */
static inline lf light_falloff(global const vit_light *light, lf d2) {
    if (!VIT_EFFECT_RANGE)
        return l_div(1.0f, d2);
    lf q = d2 * light->inv_range2;
    if (light->falloff == VIT_FALLOFF_WINDOW)
        return l_max(1.0f - q, L_F(0));
    return l_div(l_max(1.0f - q * q, L_F(0)), d2);
}

/* The same times d2: what a range leaves of a photon's power. Exactly 1 without a range. */
static inline lf light_left(global const vit_light *light, lf d2) {
    lf q = d2 * light->inv_range2;
    if (light->falloff == VIT_FALLOFF_WINDOW)
        return l_max(1.0f - q, L_F(0)) * d2;
    return l_max(1.0f - q * q, L_F(0));
}

/* View samples as lights see them. */
typedef struct lit_sample {
    li hit;
    lv3 p, n, v;      /* position; unit normal, unit direction to where it is seen from (with specular reflection) */
    lv3 face;         /* normal of the triangle on the seen side, of any length (with smooth normals) */
    lf exponent;      /* of the lobe; -alpha of a GGX lobe */
    lv3 specular;     /* of the lobe, at normal incidence (with effect ggx) */
    li no_lobe;       /* lanes whose lobe gets none of the light that is added (with effect gloss) */
    lv3 matt, glossy; /* sums of irradiance, W/m2, and of irradiance times the lobe, W/(m2 sr); with
                       * effect ggx times its reflectance too, and matt light is what Fresnel's term leaves */
} lit_sample;

/* The samples' triangles' normals on the side that p is on. */
static inline lv3 lit_face(global const vit_triangle *triangles, li hit, li triangle, lv3 p) {
    lv3 face = lv3_set(L_F(0), L_F(0), L_F(0));
    li own;
    while (l_any(hit)) {
        global const vit_triangle *t = triangles + surface_next(&hit, triangle, &own);
        lv3 n = lv3_set(L_F(t->nx), L_F(t->ny), L_F(t->nz));
        lf side = l_sel(L_LT(lv3_dot(n, lv3_sub(p, lv3_load(t->v0))), L_F(0)), L_F(-1), L_F(1));
        face = lv3_sel(own, lv3_scale(n, side), face);
    }
    return face;
}

static inline lit_sample lit_load(global const vit_scene *scene, ROUND_PARAMETERS, global const vit_triangle *triangles,
                                  uint first, li hit, global const uint *hit_triangle, global const float *position,
                                  global const uint *normal, global const float *rays, global const uint *specular) {
    lit_sample s;
    uint n = scene->samples;
    s.hit = hit;
    s.no_lobe = L_I(0);
    s.p = sample_position(scene, position, first);
    s.n = l_decode_normal(L_LOAD(normal + first));
    s.matt = s.glossy = s.specular = s.v = s.face = lv3_set(L_F(0), L_F(0), L_F(0));
    if (VIT_EFFECT_SMOOTH)
        s.face = lit_face(triangles, hit, L_AS_INT(L_LOAD(hit_triangle + first)), s.p);
    s.exponent = L_F(1);
    if (VIT_EFFECT_SPECULAR) {
        s.v = VIT_EFFECT_CHAINS ? lv3_scale(chain_direction(rays, n, first), L_F(-1))
                                : lv3_unit(lv3_sub(lv3_load((cameras + frame)->eye), s.p));
        s.exponent = L_AS_FLOAT(L_LOAD(specular + n + first));
        if (VIT_EFFECT_GGX)
            s.specular = l_decode_albedo(L_LOAD(specular + first));
    }
    return s;
}

/* Cosine of the light from unit direction l. Light from behind the triangle does not come to this side of it, whatever the
 * interpolated normal says: its shadow ray would go by the triangle's edge. */
static inline lf lit_cosine(const lit_sample *s, lv3 l) {
    lf cosine = l_max(lv3_dot(s->n, l), L_F(0));
    if (VIT_EFFECT_SMOOTH)
        cosine = l_sel(L_GT(lv3_dot(s->face, l), L_F(0)), cosine, L_F(0));
    return cosine;
}

/* The same as lit_add where some lobe is of microfacets. */
static inline void lit_add_facets(lit_sample *s, lv3 l, lv3 light) {
    li facets = L_LT(s->exponent, L_F(0));
    specular_facets f = specular_at_facets(s->n, l, s->v, l_sel(facets, -s->exponent, L_F(1)));
    lf lobe = l_sel(facets, f.lobe, specular_lobe(s->n, l, s->v, l_sel(facets, L_F(1), s->exponent)));
    lf grazing = l_sel(facets, f.grazing, L_F(0));
    if (VIT_EFFECT_GLOSS)
        lobe = l_sel(s->no_lobe, L_F(0), lobe);
    lv3 g = s->specular;
    g = lv3_set(fma(1.0f - g.x, grazing, g.x), fma(1.0f - g.y, grazing, g.y), fma(1.0f - g.z, grazing, g.z));
    s->glossy = lv3_along(s->glossy, lv3_set(light.x * g.x, light.y * g.y, light.z * g.z), lobe);
    s->matt = lv3_along(s->matt, light, 1.0f - grazing);
}

/* Adds light of power `intensity` from unit direction l: e, irradiance a unit of it. */
static inline void lit_add(lit_sample *s, lv3 l, lf e, lv3 intensity) {
    lv3 light = lv3_set(intensity.x * e, intensity.y * e, intensity.z * e);
    if (VIT_EFFECT_GGX) {
        lit_add_facets(s, l, light);
        return;
    }
    s->matt = lv3_set(s->matt.x + light.x, s->matt.y + light.y, s->matt.z + light.z);
    if (VIT_EFFECT_SPECULAR) {
        lf lobe = specular_lobe(s->n, l, s->v, s->exponent);
        s->glossy = lv3_along(s->glossy, light, lobe);
    }
}

/* Adds the samples' reflected light to `direct`. */
static inline void lit_store(global const vit_scene *scene, const lit_sample *s, uint first, global const uint *albedo,
                             global const uint *specular, global float *direct) {
    uint n = scene->samples;
    lv3 a = lv3_scale(l_decode_albedo(L_LOAD(albedo + first)), L_F(VIT_INV_PI)), out = lv3_load_planes(direct, n, first);
    out = lv3_set(fma(a.x, s->matt.x, out.x), fma(a.y, s->matt.y, out.y), fma(a.z, s->matt.z, out.z));
    if (VIT_EFFECT_SPECULAR) {
        lv3 g = VIT_EFFECT_GGX ? lv3_set(L_F(1), L_F(1), L_F(1)) : l_decode_albedo(L_LOAD(specular + first));
        out = lv3_set(fma(g.x, s->glossy.x, out.x), fma(g.y, s->glossy.y, out.y), fma(g.z, s->glossy.z, out.z));
    }
    lv3_store_planes(out, direct, n, first);
}

#define LIT_PARAMETERS                                                                                                         \
    global const uint *hit_triangle, global const float *position, global const uint *normal, global const uint *albedo,       \
        global const float *rays, global const uint *specular, global float *direct
#define LIT hit_triangle, position, normal, albedo, rays, specular, direct

/* Way to a light of a place: unit direction, distance, irradiance a unit of its power. *to: the way, not a direction's. */
static inline lv3 lit_way(global const vit_scene *scene, global const vit_light *light, const lit_sample *s, lv3 *to, lf *d,
                          lf *e) {
    if (VIT_EFFECT_DIRECTIONAL && light->kind == VIT_LIGHT_DIRECTIONAL) {
        lv3 along = lv3_scale(lv3_load(light->direction), L_F(-1));
        *d = L_F(3e38f);
        *e = lit_cosine(s, along);
        *to = along;
        return along;
    }
    float least = scene->ray_offset * 0.0625f, least2 = least * least; /* of distances, relative to the scene's size */
    *to = lv3_sub(lv3_load(light->position), s->p);
    lf d2 = l_max(lv3_dot(*to, *to), L_F(least2));
    *d = l_sqrt(d2);
    lv3 l = lv3_scale(*to, l_div(1.0f, *d));
    *e = lit_cosine(s, l) * light_cone(light, l) * light_falloff(light, d2);
    return l;
}

/* Adds the light of the frame's lights to the lanes of `hit`. */
static inline void lit_by_lights(RAY_SCENE_PARAMETERS, uint frame, global const vit_light *lights, li hit,
                                 lit_sample *s WORK_PASSED) {
    for (uint i = 0; i < scene->lights; i++) {
        global const vit_light *light = lights + (size_t)frame * scene->lights + i;
        lv3 to;
        lf e, d;
        lv3 l = lit_way(scene, light, s, &to, &d, &e);
        li lit = hit & L_GT(e, L_F(0));
        if (!l_any(lit))
            continue;
        ray_packet r = ray_make(s->p, l);
        WORK_LANES(shadow_rays, lit);
        lit &= ~ray_occluded(RAY_SCENE, &r, lit, d);
        WORK_TRACED(r);
        lit_add(s, l, l_sel(lit, e, L_F(0)), lv3_load(light->intensity));
    }
}

#if VIT_WITH(LIGHTS) && VIT_BUNDLE == 1
kernel void direct_light(RAY_SCENE_PARAMETERS, ROUND_PARAMETERS, global const vit_light *lights,
                         LIT_PARAMETERS WORK_PARAMETERS) {
    uint first = (uint)get_global_id(0) * VIT_LANES;
    if (first >= scene->samples)
        return;
    li hit = L_NE(L_AS_INT(L_LOAD(hit_triangle + first)), L_I((int)VIT_NONE));
    if (!l_any(hit))
        return;
    lit_sample s = lit_load(scene, ROUND, triangles, first, hit, hit_triangle, position, normal, rays, specular);
    WORK_BEGIN
    lit_by_lights(RAY_SCENE, frame, lights, hit, &s WORK_PASS);
    lit_store(scene, &s, first, albedo, specular, direct);
    WORK_END
}
#endif

#if VIT_WITH(AREA_LIGHTS)
#define NEAR_RAYS 64u    /* at least: a strip of light beside an area light is found by few of them */
#define NEAR_SHARE 0.01f /* of a white sky's light, that a point must not stand for alone */

/* Lanes for which a point of any set would be much of all light: those whose irradiance from a white sky of the area light's
 * radiance it is more than NEAR_SHARE of. The same for all sets, so that which of them a pixel has changes nothing but noise.
 */
static inline li lit_near(global const vit_light_sample *area_lights, uint points, const lit_sample *s, float *far2) {
    li near = L_I(0);
    *far2 = 0;
    for (uint i = 0; i < VIT_PATTERNS * points; i++) {
        global const vit_light_sample *q = area_lights + i;
        lv3 to = lv3_sub(lv3_load(q->position), s->p);
        lf d2 = lv3_dot(to, to);
        *far2 = vit_max(*far2, q->near2);
        if (!l_any(L_LT(d2, L_F(4.0f * q->near2)))) /* a surface within its distance has a point within twice that */
            continue;
        lf facing = l_max(lv3_dot(s->n, to), L_F(0)) * l_max(-lv3_dot(lv3_load(q->normal), to), L_F(0));
        near |= L_GT(facing * q->radius2, d2 * d2 * NEAR_SHARE) & L_LT(d2, L_F(4.0f * q->near2));
    }
    return near & s->hit;
}

/* Adds the light of surfaces nearer than vit_material.near2 to lanes of `near`, where points are too far apart: rays by the
 * cosine find it. `set`: the samples' sets. Points leave out just what is added here. */
static inline void lit_by_near(RAY_SCENE_PARAMETERS, uint points, li set, li own, li near, float far2,
                               lit_sample *s WORK_PASSED) {
    global const float *normals = (global const float *)triangles, *lights = (global const float *)materials;
    const int triangle_words = (int)(sizeof(vit_triangle) / sizeof(float)),
              material_words = (int)(sizeof(vit_material) / sizeof(float)),
              words = (int)(sizeof(vit_attributes) / sizeof(uint));
    const uint rays = max(points, NEAR_RAYS);
    const float e = vit_div(VIT_PI, (float)rays), far = vit_sqrt(far2);
    for (uint i = 0; i < rays; i++) {
        lu number = L_AS_UINT(set * (int)rays) + L_U(i); /* a plane sequence (Roberts 2018) over all sets */
        lv3 d = ray_cosine(s->n, l_unit_float(number * 0xc13fa9a9u + 0x80000000u),
                           l_unit_float(number * 0x91e10da5u + 0x80000000u));
        ray_packet r = ray_make(s->p, d);
        lf t = L_F(far);
        li triangle = L_I((int)VIT_NONE);
        WORK_LANES(shadow_rays, near);
        ray_nearest(RAY_SCENE, &r, near, &t, &triangle);
        WORK_TRACED(r);
        li lit = near & L_NE(triangle, L_I((int)VIT_NONE)) & L_NE(triangle, own);
        if (VIT_EFFECT_SMOOTH)
            lit &= L_GT(lv3_dot(s->face, d), L_F(0));
        if (!l_any(lit))
            continue;
        li at = lit & triangle;
        lv3 n = lv3_set(L_GATHER(lf, normals + 3, at * triangle_words), L_GATHER(lf, normals + 7, at * triangle_words),
                        L_GATHER(lf, normals + 11, at * triangle_words));
        lu word = l_gather_u((global const uint *)attributes + 3, at * words);
        lu dark = l_sel_u(L_GT(lv3_dot(n, d), L_F(0)), L_U(VIT_SIDE_DARK_BACK), L_U(VIT_SIDE_DARK_FRONT));
        li m = L_AS_INT(word & L_U(VIT_MATERIAL_INDEX)) * material_words;
        lit &= L_EQ(L_AS_INT(word & dark), L_I(0)) & L_LT(t * t, L_GATHER(lf, lights + 18, m));
        lv3 radiance = lv3_set(L_GATHER(lf, lights + 4, m), L_GATHER(lf, lights + 5, m), L_GATHER(lf, lights + 6, m));
        lit_add(s, d, l_sel(lit, L_F(e), L_F(0)), radiance);
    }
}
#endif

/* Each pixel of 4 x 4 takes another one of the VIT_PATTERNS fixed sets of points, and each copy another again. */
static inline li lit_set(uint first, uint copy) {
    return ((int)(first & 15u) + L_INDEX + (int)(copy * 7u)) & (VIT_PATTERNS - 1);
}

/* Adds the light of the samples' sets of points, which are directions with `sky`. own: the samples' triangles. */
static inline void lit_by_area_lights(RAY_SCENE_PARAMETERS, global const vit_light_sample *area_lights, uint points, int sky,
                                      li set, li own, lit_sample *s WORK_PASSED) {
    global const float *p = (global const float *)area_lights;
    const int stride = (int)(sizeof(vit_light_sample) / sizeof(float));
    float least = scene->ray_offset * 0.0625f, least2 = least * least; /* as in direct_light */
    li at = set * (int)points * stride, near = L_I(0);
#if VIT_WITH(AREA_LIGHTS)
    if (!sky) {
        float far2;
        near = lit_near(area_lights, points, s, &far2);
        if (l_any(near))
            lit_by_near(RAY_SCENE, points, set, own, near, far2, s WORK_PASS);
    }
#endif
    for (uint i = 0; i < points; i++, at += stride) {
        lv3 to = lv3_set(L_GATHER(lf, p, at), L_GATHER(lf, p + 1, at), L_GATHER(lf, p + 2, at)), l = to;
        lf d = L_F(3e38f), e;
        if (sky)
            e = lit_cosine(s, l);
        else {
            /* Nearer than the radius of the disc that the point stands for, it shines as from there: never more than half a
             * sphere of it. The point lies off the surface, by ray_offset: the light itself does not stand in the way. */
            lv3 n = lv3_set(L_GATHER(lf, p + 4, at), L_GATHER(lf, p + 5, at), L_GATHER(lf, p + 6, at));
            to = lv3_sub(to, s->p);
            lf d2 = l_max(lv3_dot(to, to), L_F(least2));
            d = l_sqrt(d2);
            l = lv3_scale(to, l_div(1.0f, d));
            e = l_div(lit_cosine(s, l) * l_max(-lv3_dot(n, l), L_F(0)), l_max(d2, L_GATHER(lf, p + 3, at)));
            e = l_sel(near & L_LT(d2, L_GATHER(lf, p + 7, at)), L_F(0), e);
        }
        li lit = s->hit & L_GT(e, L_F(0));
        if (!l_any(lit))
            continue;
        ray_packet r = ray_make(s->p, l);
        WORK_LANES(shadow_rays, lit);
        lit &= ~ray_occluded(RAY_SCENE, &r, lit, d);
        WORK_TRACED(r);
        lv3 power = lv3_set(L_GATHER(lf, p + 8, at), L_GATHER(lf, p + 9, at), L_GATHER(lf, p + 10, at));
        lit_add(s, l, l_sel(lit, e, L_F(0)), power);
    }
}

/* Lanes whose lobe reflects something. */
static inline li lit_shines(global const uint *specular, uint first) {
    return VIT_EFFECT_SPECULAR ? L_NE(L_AS_INT(L_LOAD(specular + first)), L_I(0)) : L_I(0);
}

/* With effect gloss: from which alpha on points find area lights for GGX lobes, and below rays do (gloss.cl). */
#define GLOSS_POINTS 0.04f

#if VIT_WITH(AREA_RAYS)
kernel void area_light(RAY_SCENE_PARAMETERS, ROUND_PARAMETERS, global const vit_light_sample *area_lights,
                       LIT_PARAMETERS WORK_PARAMETERS) {
    uint first = (uint)get_global_id(0) * VIT_LANES;
    if (first >= scene->samples)
        return;
    li hit = L_NE(L_AS_INT(L_LOAD(hit_triangle + first)), L_I((int)VIT_NONE));
    if (VIT_EFFECT_LIGHTMAP)
        hit &= lit_shines(specular, first);
    if (!l_any(hit))
        return;
    WORK_BEGIN
    lit_sample s = lit_load(scene, ROUND, triangles, first, hit, hit_triangle, position, normal, rays, specular);
    if (VIT_EFFECT_GLOSS)
        s.no_lobe = L_LT(s.exponent, L_F(0)) & L_GT(s.exponent, L_F(-GLOSS_POINTS));
    lit_by_area_lights(RAY_SCENE, area_lights, scene->area_samples, 0, lit_set(first, round / layers),
                       L_AS_INT(L_LOAD(hit_triangle + first)), &s WORK_PASS);
    if (VIT_EFFECT_LIGHTMAP)
        s.matt = lv3_set(L_F(0), L_F(0), L_F(0));
    lit_store(scene, &s, first, albedo, specular, direct);
    WORK_END
}
#endif

#if VIT_WITH(LIGHTMAP_RAYS)
/* Matt light of all sets at samples where the lightmap does not know it: smooth without a filter. */
kernel void lightmap_rays(RAY_SCENE_PARAMETERS, ROUND_PARAMETERS, global const vit_light_sample *area_lights, LIT_PARAMETERS,
                          global const uint *by_rays WORK_PARAMETERS) {
    uint first = (uint)get_global_id(0) * VIT_LANES;
    if (first >= scene->samples || round_skips(first, active))
        return;
    li triangle = L_AS_INT(L_LOAD(hit_triangle + first));
    li hit = L_NE(triangle, L_I((int)VIT_NONE)) & L_NE(L_AS_INT(L_LOAD(by_rays + first)), L_I(0));
    if (!l_any(hit))
        return;
    WORK_BEGIN
    lit_sample s = lit_load(scene, ROUND, triangles, first, hit, hit_triangle, position, normal, rays, specular);
    s.exponent = L_F(1); /* as what is baked: matt light without Fresnel's term; the lobe's is left out below */
    for (int set = 0; set < VIT_PATTERNS; set++) {
        if (VIT_EFFECT_AREA_LIGHTS)
            lit_by_area_lights(RAY_SCENE, area_lights, scene->area_samples, 0, L_I(set), triangle, &s WORK_PASS);
        if (VIT_EFFECT_SKY_LIGHT)
            lit_by_area_lights(RAY_SCENE, area_lights + VIT_PATTERNS * scene->area_samples, scene->sky_samples, 1, L_I(set),
                               triangle, &s WORK_PASS);
    }
    s.matt = lv3_scale(s.matt, L_F(1.0f / VIT_PATTERNS));
    s.glossy = lv3_set(L_F(0), L_F(0), L_F(0));
    lit_store(scene, &s, first, albedo, specular, direct);
    WORK_END
}
#endif
