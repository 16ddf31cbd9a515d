/* pack_check_brightness.c: no float becomes infinite on its way from a light to a pixel, at any size of the scene. After all
 * sections have passed their own checks.
 *
 * The bound per frame, in double: for direct light, each light's intensity over the square of the least distance that counts
 * (kernels/direct.cl: ray_offset / 16), the points of area lights over that or their discs, the sky's as they are, times the
 * BRDF's peak; for indirect light, all photons on one place, over the least effective area, or of live radiosity as much as
 * if receivers saw nothing but the brightest patch; all that shines by itself; summed
 * over the copies and layers of a pixel, times the exposure. */
#include "pack_check.h"

#define PI 3.14159265358979
#define LEAST_AREA_INVERSE 1024.0           /* above 1 / (VIT_CELL_AREA_LEAST^2 VIT_CELL_AREA_SCALE) */
#define MOST_SMITH 5.1e5                    /* above 0.5 / SPECULAR_GRAZING */
#define MOST_LIGHT ((double)FLT_MAX * 0.25) /* the rest is for roundings */
_Static_assert(VIT_CELL_AREA_LEAST *VIT_CELL_AREA_LEAST * 4 * 1024 > 511 * 511, "LEAST_AREA_INVERSE is no less");

static double largest(const float c[3]) {
    const float red_green = c[0] > c[1] ? c[0] : c[1];
    return red_green > c[2] ? red_green : c[2];
}

/* What surfaces make of light, at most: the BRDF's peak, 1/sr, and what they shine with by themselves, W/(m2 sr). */
static void look_at_materials(const vit_pack *p, double *peak, double *own) {
    const vit_scene *s = p->scene;
    *peak = 1.0 / PI;
    *own = 0.0;
    for (vit_u32 i = 0; i < s->materials; i++) {
        const vit_material *m = VIT_RECORD(vit_material, (const vit_material *)p->section[VIT_SECTION_MATL], i);
        const double phong = s->effects & VIT_BIT(SPECULAR) ? (m->exponent + 2.0) / (2.0 * PI) : 0.0, e = largest(m->emission);
        const double facets = /* of D, times that of V: kernels/specular.clh */
            s->effects & VIT_BIT(GGX) && m->alpha > 0.0f ? MOST_SMITH / (PI * m->alpha * m->alpha) : 0.0;
        const double lobe = facets > phong ? facets : phong;
        if (lobe + 1.0 / PI > *peak)
            *peak = lobe + 1.0 / PI;
        if (e > *own)
            *own = e;
    }
    *own += *own * PI * *peak; /* what rays find of an area light nearby (lit_by_near) */
    *own += 2.0 * largest(s->ambient) + largest(s->background) + (s->sky_size > 0 ? (double)VIT_MAX_RADIANCE : 0.0);
}

/* Points of area lights and of the sky: irradiance of all, W/m2; more than of one set. */
static double of_points(const vit_pack *p, double least2) {
    const vit_scene *s = p->scene;
    const uint64_t area = VIT_PATTERNS * (uint64_t)s->area_samples, count = area + VIT_PATTERNS * (uint64_t)s->sky_samples;
    double sum = 0.0;
    for (uint64_t i = 0; i < count; i++) {
        const vit_light_sample *e = VIT_RECORD(vit_light_sample, (const vit_light_sample *)p->section[VIT_SECTION_EMIT], i);
        const double near2 = e->radius2 > least2 ? e->radius2 : least2;
        sum += i < area ? largest(e->power) / near2 : largest(e->power);
    }
    return sum;
}

/* Baked direct light. */
static double of_lightmap(const vit_pack *p) {
    double most = 0.0;
    for (vit_u32 i = 0; i < p->scene->map_receivers; i++) {
        const double e = largest(VIT_RECORD(vit_receiver, (const vit_receiver *)p->section[VIT_SECTION_MREC], i)->irradiance);
        most = e > most ? e : most;
    }
    return most;
}

static double of_stored_photons(const vit_pack *p) {
    double sum = 0.0;
    for (vit_u32 i = 0; i < p->scene->baked; i++)
        sum += largest(VIT_RECORD(vit_photon, (const vit_photon *)p->section[VIT_SECTION_PHOT], i)->power);
    return sum;
}

/* Irradiance by the frame's lights, W/m2: straight, and by the photons that are traced; *shining: their intensities. */
static void of_lights(const vit_pack *p, vit_u32 frame, double least2, double *direct, double *traced, double *shining) {
    const vit_scene *s = p->scene;
    const vit_light *lights = p->section[VIT_SECTION_LITE];
    *direct = *traced = *shining = 0.0;
    for (vit_u32 i = 0; i < s->lights; i++) {
        const vit_light *l = VIT_RECORD(vit_light, lights, (size_t)frame * s->lights + i);
        const bool even = l->kind == VIT_LIGHT_DIRECTIONAL || l->falloff == VIT_FALLOFF_WINDOW;
        const double most = largest(l->intensity);
        *shining += most;
        *direct += even ? most : most / least2;
        if (l->path_count > 0)
            *traced += vit_pack_photon_bound(s, l) * l->path_count * s->bounces;
    }
}

vit_status vit_pack_check_brightness(const vit_pack *p, vit_text *why) {
    const vit_scene *s = p->scene;
    const float least = s->ray_offset * 0.0625f, least2 = least * least; /* as the kernels have it */
    double peak, own, direct, traced, shining, still;
    if ((s->lights > 0 || s->area_samples > 0) && !(least2 >= FLT_MIN))
        return vit_pack_refuse(why, "section META: lights, and a ray_offset of %g m: its square vanishes",
                               (double)s->ray_offset);
    look_at_materials(p, &peak, &own);
    const double points = of_points(p, least2) + of_lightmap(p), stored = of_stored_photons(p),
                 basis = vit_pack_basis_bound(p, &still);
    for (vit_u32 frame = 0; frame < s->frames; frame++) {
        const double exposure = VIT_RECORD(vit_camera, (const vit_camera *)p->section[VIT_SECTION_CAMS], frame)->exposure;
        of_lights(p, frame, least2, &direct, &traced, &shining);
        const double live = s->patches ? 2.0 * (direct + (double)s->most_reflected * VIT_MAX_REFLECT) : 0.0;
        const double seen = (direct + points) * peak +
                            ((stored + traced) * LEAST_AREA_INVERSE + still + basis * shining + live) * (2.0 / PI) + own;
        const double gloss = s->effects & VIT_BIT(GLOSS) ? 2.0 : 1.0; /* what is seen in lobes comes on top */
        const double most = gloss * seen * 2.0 * s->copies * (exposure > 1.0 ? exposure : 1.0);
        if (!(most <= MOST_LIGHT))
            return vit_pack_refuse(
                why,
                "section CAMS: frame %u: light could be %.3g, more than floats hold (%.3g): nearest to a light, %.3g m, "
                "and exposed by %g; lights have to be weaker or the scene larger",
                frame, most, MOST_LIGHT, (double)least, exposure);
    }
    return VIT_OK;
}
