/* What it does to the picture that photons are counted per area of triangles, while a smooth surface's irradiance is about its
 * shading normal: two references. */
#include "cost/sweep_parts.h"
#include <math.h>

#define FLAT 0.99999 /* least cosine between a flat triangle's normal and its vertices': normals are stored in 16 bits */

/* Does any vertex's normal differ from its triangle's? */
static bool smooth(const model *m) {
    for (uint32_t i = 0; i < m->triangles; i++) {
        const uint32_t *corner = m->index + 3 * (size_t)i;
        const float *p[3];
        double a[3], b[3], n[3];
        for (int k = 0; k < 3; k++)
            p[k] = m->position + 3 * (size_t)corner[k];
        for (int k = 0; k < 3; k++) {
            a[k] = (double)p[1][k] - (double)p[0][k];
            b[k] = (double)p[2][k] - (double)p[0][k];
        }
        for (int k = 0; k < 3; k++)
            n[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
        const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int c = 0; c < 3; c++) {
            const float *v = m->normal + 3 * (size_t)corner[c];
            if (fabs(n[0] * (double)v[0] + n[1] * (double)v[1] + n[2] * (double)v[2]) < FLAT * length)
                return true;
        }
    }
    return false;
}

/* The mean squared difference of two pictures with independent errors is that of what they show plus both variances. */
static cost_error difference(const reference *about_shading, const reference *about_faces) {
    const size_t values = 3 * (size_t)about_shading->width * about_shading->height;
    double mean = 0, sum = 0, squares = 0, relative = 0;
    for (size_t i = 0; i < values; i++)
        mean += (about_shading->direct[i] + about_shading->limited[i]) / (double)values;
    for (size_t i = 0; i < values; i++) {
        const double d = about_faces->limited[i] - about_shading->limited[i],
                     x = about_shading->direct[i] + about_shading->limited[i],
                     d2 = d * d - about_faces->limited_variance[i] - about_shading->limited_variance[i],
                     scale = x * x + 0.01 * mean * mean; /* as metrics.c */
        sum += d;
        squares += d2;
        relative += scale > 0 ? d2 / scale : 0;
    }
    if (!(mean > 0))
        return (cost_error){.nmse = 0};
    return (cost_error){.nmse = squares / (double)values / (mean * mean),
                        .relmse = relative / (double)values,
                        .bias = sum / (double)values / mean};
}

vit_status sweep_normals(sweep *s, vit_text *why) {
    reference_input about_faces = s->truth;
    reference other;
    s->out->normals = (cost_error){.nmse = 0};
    if (!smooth(s->base.model))
        return VIT_OK;
    about_faces.face_normals = true;
    progress_stage(s->progress, "reference about geometric normals");
    const vit_status status = reference_render(&about_faces, &other, why);
    progress_end(s->progress);
    if (status == VIT_OK)
        s->out->normals = difference(&s->out->reference, &other);
    reference_free(&other);
    return status;
}
