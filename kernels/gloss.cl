/* The passes gloss and gloss_filter: what a GGX lobe reflects of its surroundings. METHODS.md, "Surroundings in gloss". As with
 * the sky's light (skylight.cl) each pixel of 4 x 4 sends rays of another one of VIT_PATTERNS sets, and takes the mean over the
 * pixels about it whose lobes look the same way. What Fresnel's term makes of them comes after: `gloss` has planes of radiance
 * for a reflectance of 1 at normal incidence, and of what 1 would add at grazing incidence, so that materials stay sharp. */

#if VIT_WITH(GLOSS)
#define GLOSS_TURNED 0.7f   /* of alpha: sine of the angle between normals from which lobes have nothing in common */
#define GLOSS_ALIKE 0.5f    /* of alpha: from which difference on neither have lobes of other roughness */
#define GLOSS_CONE 0.5f     /* of alpha: width of rays' footprints a metre, for textures */
#define GLOSS_GRAZING 1e-3f /* cosine of the way to the eye, at least */

/* A lobe's place: axes on the surface, the first towards the eye; the way to the eye, stretched to the hemisphere of visible
 * normals, in them and the normal. */
typedef struct gloss_lobe {
    lv3 across, along, stretched;
    lf alpha, nv, smith; /* smith: root of nv^2 (1 - a^2) + a^2 */
} gloss_lobe;

static inline gloss_lobe gloss_lobe_at(const lit_sample *s) {
    gloss_lobe g;
    g.alpha = l_max(-s->exponent, L_F(0));
    lf nv = lv3_dot(s->n, s->v), a2 = g.alpha * g.alpha;
    lv3 flat = lv3_along(s->v, s->n, -nv);
    lf d = lv3_dot(flat, flat);
    li upright = L_LT(d, L_F(1e-6f));
    ray_packet frame = ray_make(s->n, s->n);
    g.across = lv3_sel(upright, frame.ax, lv3_scale(flat, l_div(1.0f, l_sqrt(l_max(d, L_F(1e-6f))))));
    g.along = lv3_set(s->n.y * g.across.z - s->n.z * g.across.y, s->n.z * g.across.x - s->n.x * g.across.z,
                      s->n.x * g.across.y - s->n.y * g.across.x);
    g.nv = l_max(nv, L_F(GLOSS_GRAZING));
    g.smith = l_sqrt(fma(g.nv * g.nv, 1.0f - a2, a2));
    g.stretched = lv3_unit(lv3_set(g.alpha * l_sel(upright, L_F(0), l_sqrt(d)), L_F(0), g.nv));
    return g;
}

/* A direction mirrored at a normal that the eye sees, from two numbers of [0, 1); *grazing: Fresnel's way to 1 there. Returns
 * the part of its light that gets out, Smith's G2 / G1; 0: none. */
static inline lf gloss_direction(const lit_sample *s, const gloss_lobe *g, lf u, lf v, lv3 *d, lf *grazing) {
    lf z = fma(1.0f - u, 1.0f + g->stretched.z, -g->stretched.z), r = l_sqrt(l_max(1.0f - z * z, L_F(0))), sine, cosine;
    l_sincos_turn(v, &sine, &cosine);
    lv3 m =
        lv3_unit(lv3_set(g->alpha * fma(r, cosine, g->stretched.x), g->alpha * (r * sine), l_max(z + g->stretched.z, L_F(0))));
    lv3 h = lv3_along(lv3_along(lv3_scale(s->n, m.z), g->across, m.x), g->along, m.y);
    lf vh = lv3_dot(s->v, h), a2 = g->alpha * g->alpha;
    *d = lv3_unit(lv3_along(lv3_scale(s->v, L_F(-1)), h, 2.0f * vh));
    lf nl = lit_cosine(s, *d), smith = l_sqrt(fma(nl * nl, 1.0f - a2, a2));
    lf c = l_min(l_max(1.0f - vh, L_F(0)), L_F(1)), c2 = c * c;
    *grazing = c2 * c2 * c;
    return l_sel(L_GT(nl, L_F(0)), l_div(nl * (g->nv + g->smith), l_max(nl * g->smith + g->nv * smith, L_F(SPECULAR_GRAZING))),
                 L_F(0));
}

/* What rays' hits are shaded with. */
#define GLOSS_PARAMETERS                                                                                                       \
    RAY_SCENE_PARAMETERS, global const vit_maps *maps, uint frame, global const vit_light *lights,                             \
        global const vit_light_sample *area_lights, global const vit_sky_texel *sky, global const uint *sides,                 \
        RECEIVER_PARAMETERS, LIGHTMAP_PARAMETERS, volatile global uint *reached
#define GLOSS                                                                                                                  \
    RAY_SCENE, maps, frame, lights, area_lights, sky, sides, receiver_cells, receiver_splits, receivers, relit, LIGHTMAP,      \
        reached

/* Irradiance of hits that is baked, or is found at receivers: indirect light, and the lightmap's. */
static inline lv3 gloss_baked(GLOSS_PARAMETERS, const surface *s, li hit, li triangle, li set, lit_sample *q WORK_PASSED) {
    lv3 e = lv3_set(L_F(0), L_F(0), L_F(0));
    hit &= ~s->dark;
    if (VIT_EFFECT_ON_CELLS)
        e = receivers_light(sides, receiver_cells, receiver_splits, VIT_EFFECT_LIVE ? relit : receivers, hit, triangle, s->back,
                            s->b1, s->b2, s->position,
                            VIT_EFFECT_REACH ? reached + scene->materials + VIT_REACHED_MORE : reached);
    li unknown = hit;
    if (VIT_EFFECT_LIGHTMAP) {
        lv3 m = receivers_light(LIGHTMAP, hit, triangle, s->back, s->b1, s->b2, s->position, 0);
        unknown &= L_LT(m.x, L_F(0));
        e = lv3_sel(unknown, e, lv3_along(e, m, L_F(1)));
    }
    if (VIT_EFFECT_NORMAL_MAPS)
        e = lv3_scale(e, sample_open_part(s));
    if (!(VIT_EFFECT_AREA_LIGHTS || VIT_EFFECT_SKY_LIGHT) || !l_any(unknown))
        return e;
    /* Where it is not known, by the points of one set. */
    q->hit = unknown;
    if (VIT_EFFECT_AREA_LIGHTS)
        lit_by_area_lights(RAY_SCENE, area_lights, scene->area_samples, 0, set, triangle, q WORK_PASS);
    if (VIT_EFFECT_SKY_LIGHT)
        lit_by_area_lights(RAY_SCENE, area_lights + VIT_PATTERNS * scene->area_samples, scene->sky_samples, 1, set, triangle,
                           q WORK_PASS);
    q->hit = hit;
    return e;
}

/* Radiance that matt surfaces and lobes at hits of rays along d send back. */
static inline lv3 gloss_reflected(GLOSS_PARAMETERS, const surface *s, lv3 d, li hit, li triangle, li set WORK_PASSED) {
    lit_sample q;
    q.hit = hit;
    q.p = s->position;
    q.n = s->normal;
    q.face = s->face;
    q.v = lv3_scale(d, L_F(-1));
    q.exponent = s->specular.exponent;
    q.specular = s->specular.specular;
    q.no_lobe = L_I(0);
    q.matt = q.glossy = lv3_set(L_F(0), L_F(0), L_F(0));
    if (VIT_EFFECT_LIGHTS)
        lit_by_lights(RAY_SCENE, frame, lights, hit, &q WORK_PASS);
    lv3 e = gloss_baked(GLOSS, s, hit, triangle, set, &q WORK_PASS);
    /* Baked light comes from all about. */
    li facets = L_LT(q.exponent, L_F(0)) & L_GT(q.specular.x + q.specular.y + q.specular.z, L_F(0));
    lv3 lobe = lv3_sel(facets, specular_mean(q.specular, l_sel(facets, -q.exponent, L_F(1))), q.specular);
    lv3 a = s->albedo, all = lv3_along(a, lobe, L_F(1));
    return lv3_set(fma(fma(all.x, e.x, a.x * q.matt.x), L_F(VIT_INV_PI), q.glossy.x),
                   fma(fma(all.y, e.y, a.y * q.matt.y), L_F(VIT_INV_PI), q.glossy.y),
                   fma(fma(all.z, e.z, a.z * q.matt.z), L_F(VIT_INV_PI), q.glossy.z));
}

/* Lanes whose hits' material is among the area lights. */
static inline li gloss_shines(global const vit_attributes *attributes, global const vit_material *materials, li hit,
                              li triangle) {
    const int material_words = (int)(sizeof(vit_material) / sizeof(uint)), words = (int)(sizeof(vit_attributes) / sizeof(uint));
    lu word = l_gather_u((global const uint *)attributes + 3, (hit & triangle) * words);
    li m = L_AS_INT(word & L_U(VIT_MATERIAL_INDEX)) * material_words;
    return hit & L_NE(L_AS_INT(l_gather_u((global const uint *)materials + 17, m)), L_I(0));
}

/* The way on from mirrors and glass: of glass the greater part with the whole weight, as chains do after their first. */
static inline void gloss_pass(const surface *s, li passes, lf t, lv3 *o, lv3 *d, lv3 *weight) {
    lv3 next = specular_mirrored(*d, s->normal, s->face), from = s->position, tint = s->specular.specular;
    li glass = VIT_EFFECT_GLASS ? passes & L_NE(s->specular.kind, L_I((int)VIT_MIRROR)) : L_I(0);
    if (VIT_EFFECT_GLASS && l_any(glass)) {
        li thin = L_EQ(s->specular.kind, L_I((int)VIT_THIN_GLASS)), inside = glass & s->back & ~thin;
        specular_paths p = specular_at_glass(*d, s->normal, s->face, s->back, thin, s->specular.ior);
        li through = glass & L_LE(p.mirror, L_F(0.5f));
        *weight = lv3_sel(inside, specular_left(*weight, s->specular.absorption, t), *weight);
        next = lv3_sel(through, p.refracted, lv3_sel(glass, p.mirrored, next));
        from = lv3_sel(through, s->beyond, from);
        tint = lv3_sel(glass & ~through, lv3_set(L_F(1), L_F(1), L_F(1)), tint);
    }
    *weight = lv3_sel(passes, lv3_set(weight->x * tint.x, weight->y * tint.y, weight->z * tint.z), *weight);
    *o = lv3_sel(passes, from, *o);
    *d = lv3_sel(passes, next, *d);
}

/* Radiance that comes from direction d: of the sky and of what emits, direct light, and of what these light, indirect light, as
 * the view has it. by_points: lanes whose area lights are found by points. */
static inline lv3 gloss_seen(GLOSS_PARAMETERS, lv3 o, lv3 d, lf cone, li going, li by_points, li set WORK_PASSED) {
    lv3 sum = lv3_set(L_F(0), L_F(0), L_F(0)), weight = lv3_set(L_F(1), L_F(1), L_F(1));
    const int light = view_light((vit_view)VIT_VIEW);
    uint most = VIT_EFFECT_CHAINS ? scene->chain : 0;
    for (uint hop = 0; hop <= most && l_any(going); hop++) {
        lf t = L_F(3e38f);
        li triangle = L_I((int)VIT_NONE);
        ray_packet r = ray_make(o, d);
        WORK_LANES(gloss_rays, going);
        ray_nearest(RAY_SCENE, &r, going, &t, &triangle);
        WORK_TRACED(r);
        li hit = going & L_NE(triangle, L_I((int)VIT_NONE)), missed = going & ~hit;
        if (VIT_EFFECT_REACH) {
            reach_note(scene, attributes, reached, hit, triangle, VIT_REACHED_VIEW);
            if (l_any(missed))
                atomic_or(reached + scene->materials + 1u, VIT_REACHED_VIEW);
        }
        if (VIT_EFFECT_SKY_LIGHT && (light & VIT_SHOWS_DIRECT) && l_any(missed)) {
            lv3 c = sky_radiance(scene, sky, d);
            c = lv3_set(weight.x * c.x, weight.y * c.y, weight.z * c.z);
            sum = lv3_sel(missed, lv3_along(sum, c, L_F(1)), sum);
        }
        if (!l_any(hit))
            break;
        WORK_LANES(surface_points, hit);
        surface s = surface_at(SURFACE_SCENE, maps, o, d, l_sel(hit, t, L_F(1)), hit, triangle, cone);
        WORK_LANES(texture_fetches, s.textured);
        WORK_LANES(texture_fetches, s.mapped);
        going = VIT_EFFECT_CHAINS ? hit & L_NE(s.specular.kind, L_I((int)VIT_MATTE)) : L_I(0);
        li matt = hit & ~going;
        lv3 c = lv3_set(L_F(0), L_F(0), L_F(0));
        if (VIT_EFFECT_INDIRECT && (light & VIT_SHOWS_INDIRECT) && l_any(matt))
            c = gloss_reflected(GLOSS, &s, d, matt, triangle, set WORK_PASS);
        if (VIT_EFFECT_EMISSION && VIT_EFFECT_AREA_LIGHTS && (light & VIT_SHOWS_DIRECT)) {
            li shines = gloss_shines(attributes, materials, matt, triangle);
            if (hop == 0)
                shines &= ~by_points;
            c = lv3_sel(shines, lv3_along(c, s.emission, L_F(1)), c);
        }
        c = lv3_set(weight.x * c.x, weight.y * c.y, weight.z * c.z);
        sum = lv3_sel(matt, lv3_along(sum, c, L_F(1)), sum);
        if (VIT_EFFECT_CHAINS && l_any(going))
            gloss_pass(&s, going, t, &o, &d, &weight);
    }
    return sum;
}

kernel void gloss(RAY_SCENE_PARAMETERS, global const vit_maps *maps, ROUND_PARAMETERS, global const vit_light *lights,
                  global const vit_light_sample *area_lights, global const vit_sky_texel *sky, global const uint *sides,
                  RECEIVER_PARAMETERS, LIGHTMAP_PARAMETERS, global const uint *hit_triangle, global const float *position,
                  global const uint *normal, global const float *rays, global const uint *specular, global float *gloss,
                  volatile global uint *reached WORK_PARAMETERS) {
    uint first = (uint)get_global_id(0) * VIT_LANES, n = scene->samples;
    if (first >= n || round_skips(first, active))
        return;
    li hit = L_NE(L_AS_INT(L_LOAD(hit_triangle + first)), L_I((int)VIT_NONE)) & lit_shines(specular, first) &
             L_LT(L_AS_FLOAT(L_LOAD(specular + n + first)), L_F(0));
    lv3 all = lv3_set(L_F(0), L_F(0), L_F(0)), added = all;
    if (l_any(hit)) {
        lit_sample s = lit_load(scene, ROUND, triangles, first, hit, hit_triangle, position, normal, rays, specular);
        gloss_lobe g = gloss_lobe_at(&s);
        li set = lit_set(first, round / layers), by_points = L_GE(g.alpha, L_F(GLOSS_POINTS));
        const float share = vit_div(1.0f, (float)scene->gloss_rays);
        WORK_BEGIN
        for (uint i = 0; i < scene->gloss_rays; i++) {
            lu number = L_AS_UINT(set * (int)scene->gloss_rays) + L_U(i); /* a plane sequence (Roberts 2018) over all sets */
            lv3 d;
            lf grazing, w = gloss_direction(&s, &g, l_unit_float(number * 0xc13fa9a9u + 0x80000000u),
                                            l_unit_float(number * 0x91e10da5u + 0x80000000u), &d, &grazing);
            li going = hit & L_GT(w, L_F(0));
            if (!l_any(going))
                continue;
            lv3 c = gloss_seen(GLOSS, s.p, d, g.alpha * GLOSS_CONE, going, by_points, set WORK_PASS);
            w = l_sel(going, w * share, L_F(0));
            all = lv3_along(all, c, w * (1.0f - grazing));
            added = lv3_along(added, c, w * grazing);
        }
        WORK_END
    }
    all.x = l_sel(hit, all.x, L_F(-1));
    lv3_store_planes(all, gloss, n, first);
    lv3_store_planes(added, VIT_PLANE(gloss, 3, n), n, first);
}

/* Weights, 0..1, of lobes of normal and alpha `its` in what those of n and alpha see; seen: squared sine of the angle between
 * the ways to the eye, which turns what is mirrored half as much as the same angle between normals. */
static inline lf gloss_weight(lv3 n, lf alpha, lv3 its, lf its_alpha, lf seen) {
    lv3 turned = lv3_sub(its, n);
    lf limit = alpha * GLOSS_TURNED,
       w = l_max(1.0f - l_div(fma(seen, L_F(0.25f), lv3_dot(turned, turned)), limit * limit), L_F(0));
    return w * l_max(1.0f - l_div(fabs(its_alpha - alpha), alpha * GLOSS_ALIKE), L_F(0));
}

kernel void gloss_filter(global const vit_scene *scene, ROUND_PARAMETERS, global const float *position,
                         global const uint *normal, global const float *rays, global const uint *specular,
                         global const float *gloss, global float *direct) {
    uint first = (uint)get_global_id(0) * VIT_LANES, n = scene->samples;
    if (first >= n || round_skips(first, active))
        return;
    li hit = L_GE(L_LOAD(gloss + first), L_F(0));
    const int alone = FILM_GLOSS_ALONE;
    if (!alone && !l_any(hit))
        return;
    li x, y;
    skylight_window(scene, first, &x, &y);
    li right = L_I((int)scene->width - 1), bottom = L_I((int)scene->height - 1);
    lv3 p = sample_position(scene, position, first), own = l_decode_normal(L_LOAD(normal + first)),
        way = lv3_sub(p, lv3_load((cameras + frame)->eye));
    lf alpha = l_sel(hit, -L_AS_FLOAT(L_LOAD(specular + n + first)), L_F(1)), weights = L_F(0);
    if (VIT_EFFECT_CHAINS) /* as if mirrors were flat */
        way = lv3_scale(chain_direction(rays, n, first), chain_length(rays, n, first));
    lf far2 = l_max(lv3_dot(way, way), L_F(1e-30f));
    lv3 all = lv3_set(L_F(0), L_F(0), L_F(0)), added = all;
    for (int dy = 0; dy < 4; dy++)
        for (int dx = 0; dx < 4; dx++) {
            li there = l_sample_at(scene, min(x + dx, right), min(y + dy, bottom));
            lv3 e = lv3_set(L_GATHER(lf, gloss, there), L_GATHER(lf, VIT_PLANE(gloss, 1, n), there),
                            L_GATHER(lf, VIT_PLANE(gloss, 2, n), there));
            lu code = l_gather_u(normal, there);
            lv3 its = sample_position_of(scene, position, there), to = lv3_sub(its, p),
                across = lv3_set(way.y * to.z - way.z * to.y, way.z * to.x - way.x * to.z, way.x * to.y - way.y * to.x);
            lf w =
                skylight_weight(p, own, L_LOAD(normal + first), its, L_LOAD(normal + first), scene->ray_offset * SKYLIGHT_FLAT);
            w *= gloss_weight(own, alpha, l_decode_normal(code), -L_AS_FLOAT(l_gather_u(specular + n, there)),
                              l_div(lv3_dot(across, across), far2 * far2));
            w = l_sel(L_GE(e.x, L_F(0)), w, L_F(0));
            weights += w;
            all = lv3_along(all, e, w);
            e = lv3_set(L_GATHER(lf, VIT_PLANE(gloss, 3, n), there), L_GATHER(lf, VIT_PLANE(gloss, 4, n), there),
                        L_GATHER(lf, VIT_PLANE(gloss, 5, n), there));
            added = lv3_along(added, e, w);
        }
    lf scale = l_sel(hit, l_div(1.0f, l_max(weights, L_F(1e-30f))), L_F(0));
    lv3 f = lv3_scale(l_decode_albedo(L_LOAD(specular + first)), scale), out = lv3_load_planes(direct, n, first);
    if (alone) /* of direct light the view shows what is indirect in lobes */
        out = lv3_set(L_F(0), L_F(0), L_F(0));
    all = lv3_set(fma(f.x, all.x, scale * added.x), fma(f.y, all.y, scale * added.y), fma(f.z, all.z, scale * added.z));
    lv3_store_planes(lv3_sel(hit, lv3_along(out, all, L_F(1)), out), direct, n, first);
}
#endif
