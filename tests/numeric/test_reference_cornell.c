/* The reference in our Cornell box against the radiosity integral.
 *
 * By one reflection, a point x gets the irradiance  sum over surfaces y of  albedo / pi * E(y) * cos cos' / d^2 * V(x, y) dA,
 * where E(y) is the lamp's direct irradiance at y. Here the integral is done by quadrature over areas, in double, with a lamp,
 * shadows and visibility of its own: no path, no Embree, no random number. A triangle is cut in four until it is small beside
 * its distance from x. Points nearer to another surface than the smallest cut are left out. Cornell's walls do not hide one
 * another, so only the blocks' triangles are blockers. */
#include "catalogue.h"
#include "../pack_sections.h"
#include "reference/reference.h"
#include "test_packs.h"
#include <math.h>

#define PI 3.14159265358979323846
enum { EVERY = 20, MAX_BLOCKERS = 1024, DEEPEST = 5 };

typedef struct point {
    double x, y, z;
} point;

typedef struct box {
    const vit_scene *meta;
    const vit_triangle *triangles;
    const vit_attributes *attributes;
    const vit_material *materials;
    const vit_light *light;
    uint32_t blockers[MAX_BLOCKERS], blocker_count;
} box;

static point of(const float p[3]) {
    return (point){(double)p[0], (double)p[1], (double)p[2]};
}

static point along(point a, double s, point b) {
    return (point){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static double dot(point a, point b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static point cross(point a, point b) {
    return (point){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static point unit(point a) {
    return along((point){0, 0, 0}, 1 / sqrt(dot(a, a)), a);
}

static point normal_of(const vit_triangle *t) {
    return unit(cross(along(of(t->v1), -1, of(t->v0)), along(of(t->v2), -1, of(t->v0))));
}

/* Does the segment from a to b cross the triangle's inside? Moeller and Trumbore. */
static bool crosses(const vit_triangle *t, point a, point b) {
    const point d = along(b, -1, a), e1 = along(of(t->v1), -1, of(t->v0)), e2 = along(of(t->v2), -1, of(t->v0));
    const point p = cross(d, e2), s = along(a, -1, of(t->v0)), q = cross(s, e1);
    const double det = dot(p, e1), u = dot(s, p) / det, v = dot(d, q) / det, at = dot(e2, q) / det;
    return fabs(det) > 1e-15 && u >= 0 && v >= 0 && u + v <= 1 && at > 1e-6 && at < 1 - 1e-6;
}

static bool visible(const box *b, point from, point to) {
    for (uint32_t i = 0; i < b->blocker_count; i++)
        if (crosses(b->triangles + b->blockers[i], from, to))
            return false;
    return true;
}

/* Direct irradiance, a unit of the lamp's intensity. */
static double lamp(const box *b, point y, point n) {
    const vit_light *l = b->light;
    const point to = along(of(l->position), -1, y), d = unit(to);
    const double fade = -dot(d, of(l->direction)) * (double)l->spot_scale + (double)l->spot_offset;
    const double cone = fade <= 0 ? 0 : fade < 1 ? fade * fade : 1, cosine = dot(d, n);
    if (cosine <= 0 || cone <= 0 || !visible(b, y, of(l->position)))
        return 0;
    return cosine * cone / dot(to, to);
}

/* Integral over the triangle p of E(y) cos cos' / d^2 V, by midpoints of parts that are small from x. */
static double integral(const box *b, const point p[3], point ny, point x, point nx, int depth) {
    const point middle = {(p[0].x + p[1].x + p[2].x) / 3, (p[0].y + p[1].y + p[2].y) / 3, (p[0].z + p[1].z + p[2].z) / 3};
    const point to = along(middle, -1, x), half = cross(along(p[1], -1, p[0]), along(p[2], -1, p[0]));
    const double d2 = dot(to, to), area = 0.5 * sqrt(dot(half, half));
    if (depth < DEEPEST && (depth < 1 || area > 0.002 * d2)) {
        const point m[3] = {along(p[0], 0.5, along(p[1], -1, p[0])), along(p[1], 0.5, along(p[2], -1, p[1])),
                            along(p[2], 0.5, along(p[0], -1, p[2]))};
        const point parts[4][3] = {{p[0], m[0], m[2]}, {m[0], p[1], m[1]}, {m[2], m[1], p[2]}, {m[0], m[1], m[2]}};
        double sum = 0;
        for (int i = 0; i < 4; i++)
            sum += integral(b, parts[i], ny, x, nx, depth + 1);
        return sum;
    }
    const double cosines = dot(nx, to) * -dot(ny, to) / d2;
    if (dot(nx, to) <= 0 || dot(ny, to) >= 0 || !visible(b, x, middle))
        return 0;
    return area * lamp(b, middle, ny) * cosines / d2;
}

static void reflected(const box *b, point x, point nx, double out[3]) {
    out[0] = out[1] = out[2] = 0;
    for (uint32_t i = 0; i < b->meta->triangles; i++) {
        const vit_triangle *t = b->triangles + i;
        const vit_material *m = b->materials + (b->attributes[i].material & VIT_MATERIAL_INDEX);
        const point p[3] = {of(t->v0), of(t->v1), of(t->v2)};
        const double part = integral(b, p, normal_of(t), x, nx, 0);
        for (int k = 0; k < 3; k++)
            out[k] += (double)m->albedo[k] / PI * part * (double)b->light->intensity[k];
    }
}

/* The camera ray's nearest triangle, by trying all; its place and normal. False: none. */
static bool look(const box *b, const vit_camera *c, double px, double py, uint32_t *triangle, point *x, point *n) {
    const point eye = of(c->eye), d = along(along(of(c->corner), px + 0.5, of(c->right)), py + 0.5, of(c->down));
    double nearest = 1e30;
    for (uint32_t i = 0; i < b->meta->triangles; i++) {
        const vit_triangle *t = b->triangles + i;
        const point ni = normal_of(t);
        const double at = dot(along(of(t->v0), -1, eye), ni) / dot(d, ni);
        if (at > 0 && at < nearest && crosses(t, eye, along(eye, 2 * at, d))) {
            nearest = at;
            *triangle = i;
            *n = dot(ni, d) < 0 ? ni : along((point){0, 0, 0}, -1, ni);
        }
    }
    *x = along(along(eye, nearest, d), 1e-7, *n);
    return nearest < 1e30;
}

/* On the room's walls: nothing is behind them. The front is open. */
static bool is_wall(const vit_triangle *t) {
    const float *v[3] = {t->v0, t->v1, t->v2};
    bool left = true, right = true, floor_ = true, ceiling = true, back = true;
    for (int i = 0; i < 3; i++) {
        left = left && v[i][0] < -0.999f;
        right = right && v[i][0] > 0.999f;
        floor_ = floor_ && v[i][1] < 0.001f;
        ceiling = ceiling && v[i][1] > 1.999f;
        back = back && v[i][2] < -0.999f;
    }
    return left || right || floor_ || ceiling || back;
}

/* Is x so near to a surface across its own that the cuts are too coarse? */
static bool near_another(const box *b, point x, point n) {
    for (uint32_t i = 0; i < b->meta->triangles; i++) {
        const vit_triangle *t = b->triangles + i;
        const float *v[3] = {t->v0, t->v1, t->v2};
        for (int k = 0; k < 3 && fabs(dot(n, normal_of(t))) < 0.99; k++) {
            const point to = along(of(v[k]), -1, x);
            if (dot(to, to) < 0.01)
                return true;
        }
    }
    return false;
}

static void one_reflection_is_the_radiosity_integral(void **state) {
    (void)state;
    size_t size;
    vit_text why;
    reference r;
    void *pack = read_file(test_pack("list"), &size);
    const pack_sections s = pack_sections_of(pack);
    static box b; /* 1. the box, and what stands in it */
    b = (box){.meta = s.data[VIT_SECTION_META],
              .triangles = s.data[VIT_SECTION_GEOM],
              .attributes = s.data[VIT_SECTION_ATTR],
              .materials = s.data[VIT_SECTION_MATL],
              .light = s.data[VIT_SECTION_LITE]};
    for (uint32_t i = 0; i < b.meta->triangles; i++)
        if (!is_wall(b.triangles + i)) {
            assert_true(b.blocker_count < MAX_BLOCKERS);
            b.blockers[b.blocker_count++] = i;
        }
    const reference_input in = {.sections = &s, .every = EVERY, .bounces = 2, .target = 1e-9, .max_samples = 65536};
    if (reference_render(&in, &r, &why) != VIT_OK) /* 2. by paths */
        fail_msg("%s", why.text);
    const vit_camera *c = s.data[VIT_SECTION_CAMS];
    double found = 0, wanted = 0, squares = 0, stated = 0;
    uint32_t points = 0;
    for (uint32_t i = 0; i < r.width * r.height; i++) {
        uint32_t triangle = 0;
        point x, n;
        double e[3];
        if (!look(&b, c, i % r.width * EVERY + EVERY / 2, i / r.width * EVERY + EVERY / 2, &triangle, &x, &n) ||
            near_another(&b, x, n))
            continue;
        reflected(&b, x, n, e); /* 3. by quadrature, where no edge is near */
        const vit_material *m = b.materials + (b.attributes[triangle].material & VIT_MATERIAL_INDEX);
        points++;
        for (int k = 0; k < 3; k++) {
            const double light = (double)m->albedo[k] / PI * e[k] * (double)c->exposure;
            found += r.limited[3 * i + (uint32_t)k];
            wanted += light;
            stated += r.limited_variance[3 * i + (uint32_t)k];
            squares += pow(r.limited[3 * i + (uint32_t)k] - light, 2);
        }
    }
    const double mean2 = pow(wanted / (3.0 * points), 2), nmse = squares / (3.0 * points) / mean2;
    printf("Cornell box, %u points: sum %+.3f %%, NMSE %.2e, stated by the reference %.2e\n", points,
           100 * (found / wanted - 1), nmse, stated / (3.0 * points) / mean2);
    assert_true(points >= 20);
    catalogue_row("reference", "Cornell box: sum of light against quadrature", fabs(found / wanted - 1), 1e-3, "relative");
    catalogue_row("reference", "Cornell box: NMSE against quadrature", nmse, 1e-5, "");
    reference_free(&r);
    free(pack);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(one_reflection_is_the_radiosity_integral)};
    return cmocka_run_group_tests_name("reference in the Cornell box", tests, NULL, NULL);
}
