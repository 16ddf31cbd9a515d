/* The pass photon_paths, of moving lights. METHODS.md, "Photon paths". A photon is stored at every hit but the first, which is
 * direct light. Slot of path p's k-th stored photon: k * paths + p, so that no order of execution shows. */

/* Footprint of a photon for the choice of mip level: wide, since its light spreads over its radius anyway. */
#define PHOTON_CONE 0.02f

/* Emission: path i of n takes a random point of the i-th n-th of a Z-order curve over the unit square of directions: exactly
 * uniform, stratified, and neighbouring lanes start alike. weight: the light's intensity in that direction over that on its
 * axis. */
static inline lv3 photon_emission(global const vit_light *light, lu path, lv3 *origin, lf *weight) {
    uint count = light->path_count;
    lu i = path - light->path_first; /* < 2^20, so that i * 2^32 / count can be had in two exact steps */
    lu high = (i << 12) / count, rest = (i << 12) - high * count;
    lu r = l_pcg(path * 2u + 0x9e3779b9u);
    lu curve = (high << 20) + (((rest << 10) / count) << 10) + mul_hi(r, L_U(0xffffffffu / count));
    lf u = (L_FROM_INT(L_AS_INT(l_even_bits(curve))) + l_unit_float(l_pcg(r))) * (1.0f / 65536.0f);
    lf v = (L_FROM_INT(L_AS_INT(l_even_bits(curve >> 1))) + l_unit_float(l_pcg(r ^ 0x85ebca6bu))) * (1.0f / 65536.0f);
    *origin = lv3_load(light->position);
    *weight = L_F(1);
    if (VIT_EFFECT_DIRECTIONAL && light->kind == VIT_LIGHT_DIRECTIONAL) { /* parallel, from a point of the disc */
        lf r = l_sqrt(u) * light->spot_scale, sr, cr;
        lv3 along = lv3_load(light->direction);
        l_sincos_turn(v, &sr, &cr);
        ray_packet disc = ray_make(along, along);
        *origin = lv3_along(lv3_along(*origin, disc.ax, r * cr), disc.ay, r * sr);
        return along;
    }
    /* Uniform over the cone cos >= cos_outer, about the axis. */
    lf c = fma(u, L_F(light->cos_outer - 1.0f), L_F(1)), s = l_sqrt(l_max(1.0f - c * c, L_F(0))), sp, cp;
    l_sincos_turn(v, &sp, &cp);
    lv3 axis = light->kind == VIT_LIGHT_SPOT ? lv3_load(light->direction) : lv3_set(L_F(0), L_F(1), L_F(0));
    ray_packet frame = ray_make(axis, axis);
    lv3 d = lv3_unit(lv3_along(lv3_along(lv3_scale(axis, c), frame.ax, s * cp), frame.ay, s * sp));
    *weight = light_cone(light, lv3_scale(d, L_F(-1)));
    return d;
}

constant uint photon_alpha[6] = VIT_BOUNCE_ALPHA;

/* Two numbers in [0, 1) for the reflection at a hit. */
static inline void photon_numbers(lu path, uint hit_number, lf *u, lf *v) {
    if (!VIT_EFFECT_SEQUENCE) {
        lu seed = l_pcg(path ^ l_pcg(L_U(hit_number * 2u + 1u)));
        *u = l_unit_float(seed);
        *v = l_unit_float(l_pcg(seed));
        return;
    }
    /* The R sequence (Roberts 2018) in the six dimensions of three reflections together, in integers modulo 2^32; later hits
     * start anew with other shifts. Paths are numbered along the Z-order curve of their emission, so any stretch of the
     * sequence, which is as evenly spread as the whole, belongs to neighbouring directions. */
    uint k = (hit_number % 3u) * 2u, shift = hit_number * 2u;
    *u = l_unit_float(path * photon_alpha[k] + l_pcg(L_U(shift + 1u)));
    *v = l_unit_float(path * photon_alpha[k + 1u] + l_pcg(L_U(shift + 2u)));
}

/* Of photons that land `way` metres from the surface that reflected them; facing: how that and this surface face each other. */
static inline lf photon_radius(float radius, lf way, lf facing) {
    lf near = l_div(way * VIT_PHOTON_NEAR, l_max(facing, L_F(1e-6f)));
    return l_min(L_F(radius), l_max(near, L_F(VIT_PHOTON_LEAST * radius)));
}

/* Writes VIT_LANES photons from `slot` on; empty slots are zeros but for their radii. power: W, incident; whole: the scene's
 * radius. */
static inline void photon_store(global vit_photon *photons, uint slot, li valid, lv3 p, lv3 d, lv3 power, lf radius,
                                float whole, lu zone) {
    float v[11 * VIT_LANES];
    uint zones[VIT_LANES];
    lf r2 = radius * radius, inv = l_div(1.0f, r2), spread = l_max(radius, L_F(VIT_PHOTON_CAP * whole)),
       scale = l_div(1.0f, spread * spread) * (2.0f * VIT_INV_PI);
    lv3 zero = lv3_set(L_F(0), L_F(0), L_F(0));
    p = lv3_sel(valid, p, zero);
    d = lv3_sel(valid, d, zero);
    power = lv3_sel(valid, power, zero);
    L_STORE(p.x, v);
    L_STORE(p.y, v + VIT_LANES);
    L_STORE(p.z, v + 2 * VIT_LANES);
    L_STORE(d.x, v + 3 * VIT_LANES);
    L_STORE(d.y, v + 4 * VIT_LANES);
    L_STORE(d.z, v + 5 * VIT_LANES);
    L_STORE(power.x * scale, v + 6 * VIT_LANES);
    L_STORE(power.y * scale, v + 7 * VIT_LANES);
    L_STORE(power.z * scale, v + 8 * VIT_LANES);
    L_STORE(l_sel(valid, r2, L_F(-1)), v + 9 * VIT_LANES);
    L_STORE(inv, v + 10 * VIT_LANES);
    L_STORE(l_sel_u(valid, zone, L_U(0)), zones);
    for (int i = 0; i < VIT_LANES; i++) {
        global vit_photon *q = photons + slot + i;
        q->position[0] = v[i];
        q->position[1] = v[VIT_LANES + i];
        q->position[2] = v[2 * VIT_LANES + i];
        q->radius2 = v[9 * VIT_LANES + i];
        q->direction[0] = v[3 * VIT_LANES + i];
        q->direction[1] = v[4 * VIT_LANES + i];
        q->direction[2] = v[5 * VIT_LANES + i];
        q->inv_radius2 = v[10 * VIT_LANES + i];
        q->power[0] = v[6 * VIT_LANES + i];
        q->power[1] = v[7 * VIT_LANES + i];
        q->power[2] = v[8 * VIT_LANES + i];
        q->zone = zones[i];
    }
}

#if VIT_WITH(TRACED)
/* The light of a packet and its photons as they leave it (13): lanes with a photon; without a light none. */
static inline li photon_start(global const vit_scene *scene, global const vit_light *lights, uint frame, uint first,
                              global const vit_light **light, lv3 *o, lv3 *d, lv3 *power) {
    *light = lights + (size_t)frame * scene->lights;
    *o = *d = *power = lv3_set(L_F(0), L_F(0), L_F(0));
    for (uint i = 0; i < scene->lights; i++, ++*light)
        if ((*light)->path_count > 0 && first >= (*light)->path_first && first < (*light)->path_first + (*light)->path_count)
            break;
    if (*light >= lights + (size_t)(frame + 1) * scene->lights)
        return L_I(0);
    lu path = L_U(first) + L_AS_UINT(L_INDEX);
    lf weight;
    *d = photon_emission(*light, path, o, &weight);
    float whole = 2.0f * VIT_PI * (1.0f - (*light)->cos_outer); /* sr; directional: m2 of the disc */
    if (VIT_EFFECT_DIRECTIONAL && (*light)->kind == VIT_LIGHT_DIRECTIONAL)
        whole = VIT_PI * (*light)->spot_scale * (*light)->spot_scale;
    lf share = weight * vit_div(whole, (float)(*light)->path_count);
    *power = lv3_scale(lv3_load((*light)->intensity), share);
    return L_LT(path, L_U((*light)->path_first + (*light)->path_count)) & L_GT(share, L_F(0));
}

/* On from mirrors and glass, for lanes `specular`: where to and whence, and what the surface leaves of the light. u: random,
 * decides at glass; t: the way there. */
static inline void photon_on(const surface *s, li specular, lf u, lf t, lv3 d, lv3 *o, lv3 *next, lv3 *reflectance,
                             lv3 *power) {
    lv3 start = s->position, on = specular_mirrored(d, s->normal, s->face), tint = s->specular.specular;
    li glass = specular & L_NE(s->specular.kind, L_I((int)VIT_MIRROR));
    if (VIT_EFFECT_GLASS && l_any(glass)) { /* Fresnel's part of the paths is mirrored */
        li thin = L_EQ(s->specular.kind, L_I((int)VIT_THIN_GLASS)), inside = glass & s->back & ~thin;
        specular_paths p = specular_at_glass(d, s->normal, s->face, s->back, thin, s->specular.ior);
        li through = glass & L_GE(u, p.mirror);
        *power = lv3_sel(inside, specular_left(*power, s->specular.absorption, t), *power);
        on = lv3_sel(glass, lv3_sel(through, p.refracted, p.mirrored), on);
        start = lv3_sel(through, s->beyond, start);
        tint = lv3_sel(glass & ~through, lv3_set(L_F(1), L_F(1), L_F(1)), tint);
    }
    *next = lv3_sel(specular, on, *next);
    *o = lv3_sel(specular, start, *o);
    *reflectance = lv3_sel(specular, tint, *reflectance);
}

/* One path a lane. vit_scene.paths and each light's path_first are multiples of 16, so a packet has one light. */
kernel void photon_paths(RAY_SCENE_PARAMETERS, global const vit_maps *maps, global const vit_light *lights, uint frame,
                         global const uint *sides, global const uint *cells, global vit_photon *photons,
                         volatile global uint *counters, volatile global uint *reached WORK_PARAMETERS) {
    uint first = (uint)get_global_id(0) * VIT_LANES, paths = scene->paths;
    if (first >= paths)
        return;
    /* 1. The light's part of the paths. */
    global const vit_light *light;
    lu path = L_U(first) + L_AS_UINT(L_INDEX);
    lv3 o, d, power;
    li alive = photon_start(scene, lights, frame, first, &light, &o, &d, &power);
    /* Normal of the matt surface that the photon comes from; 0: of none. */
    lv3 from = lv3_set(L_F(0), L_F(0), L_F(0));
    uint stored = 0;
    WORK_BEGIN
    for (uint hit_number = 0; hit_number < scene->bounces; hit_number++) {
        /* 2. What the ray meets. */
        lf t = L_F(3e38f);
        li triangle = L_I(0);
        surface s = surface_none(o);
        if (l_any(alive)) {
            ray_packet r = ray_make(o, d);
            WORK_LANES(photon_rays, alive);
            ray_nearest(RAY_SCENE, &r, alive, &t, &triangle);
            WORK_TRACED(r);
            alive &= L_NE(triangle, L_I((int)VIT_NONE));
            t = l_sel(alive, t, L_F(1));
            s = surface_at(SURFACE_SCENE, VIT_EFFECT_CAUSTICS ? maps : 0, o, d, t, alive, triangle, L_F(PHOTON_CONE));
            WORK_LANES(surface_points, alive);
            if (VIT_EFFECT_REACH)
                reach_note(scene, attributes, reached, alive, triangle, VIT_REACHED_PHOTON);
            WORK_LANES(texture_fetches, s.textured);
            WORK_LANES(texture_fetches, s.mapped);
        }
        /* Mirrors and glass store nothing; without caustics they end paths. */
        li matt = alive;
        if ((VIT_EFFECT_MIRROR || VIT_EFFECT_GLASS) && l_any(alive)) {
            matt &= L_EQ(s.specular.kind, L_I((int)VIT_MATTE));
            if (!VIT_EFFECT_CAUSTICS)
                alive = matt;
        }
        /* 3. A photon, (15) and (21). */
        if (hit_number > 0) {
            lu zone = L_U(0);
            if (VIT_EFFECT_ZONES && l_any(alive)) {
                cell_place cell = cell_at(sides, alive, triangle, s.back, s.b1, s.b2);
                zone = cell_zone(cells, &cell);
            }
            lf radius = l_sel(matt, photon_radius(scene->radius, t, -lv3_dot(from, s.face)), L_F(scene->radius));
            photon_store(photons, (hit_number - 1) * paths + first, matt, s.position, d, power, radius, scene->radius, zone);
            stored += popcount(l_bits(matt));
        }
        if (hit_number + 1 == scene->bounces || !l_any(alive))
            continue; /* slots of dead paths are still written, as empty */
        /* The same light that direct lighting sees. */
        if (VIT_EFFECT_RANGE && hit_number == 0)
            power = lv3_scale(power, light_left(light, t * t));
        /* 4. On from a matt surface, (14). */
        lv3 reflectance = VIT_EFFECT_SPECULAR ? lv3_along(s.albedo, s.specular.specular, L_F(1)) : s.albedo;
        lf u, v;
        photon_numbers(path, hit_number, &u, &v);
        lv3 next = ray_cosine(s.face, u, v);
        o = s.position;
        from = lv3_sel(matt, s.face, lv3_set(L_F(0), L_F(0), L_F(0)));
        /* 5. On from mirrors and glass. */
        if (VIT_EFFECT_CAUSTICS && l_any(alive & ~matt))
            photon_on(&s, alive & ~matt, u, t, d, &o, &next, &reflectance, &power);
        /* 6. What is left. */
        power = lv3_set(power.x * reflectance.x, power.y * reflectance.y, power.z * reflectance.z);
        alive &= L_GT(power.x + power.y + power.z, L_F(0));
        d = next;
    }
    atomic_add(counters + VIT_COUNTER_photons, stored);
    WORK_END
}
#endif
