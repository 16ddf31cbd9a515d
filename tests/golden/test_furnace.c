/* White furnaces: closed rooms of one albedo, in which indirect irradiance is known exactly.
 *
 * What makes light hard to test is that nobody knows the right picture. Here it is known. In a closed room of area A and albedo
 * rho around a light of power Phi, each reflection takes in all the light of the one before and gives back rho of it, whatever
 * the room's shape and the light's place. With photons stored at reflections 1 .. K (a path of `bounces` hits stores all but
 * the first: K = bounces - 1), the mean of indirect irradiance over the surface is E = Phi / A * (rho + rho^2 + ... + rho^K).
 * Photon powers add up to exactly that, so the mean has no noise: what the frames miss is the estimate's own error. In a sphere
 * every point gives every other the same (the form factor is 1 / A), so there E holds at each point, which has noise.
 *
 * A camera inside looks along all six axes, one frame each, with a field of view of 90 degrees: together they see each point of
 * the surface once. A pixel stands for the area d^2 dOmega / cos; in the box d and cos are computed here, not taken from the
 * renderer, and must add up to the box's area.
 *
 * What remains: in the box, the kernel loses light over edges and takes some from the wall round the corner; both go with
 * radius / width of the room, and nearly cancel. Buckets see all samples of a cluster from one point: corners suffer. Effective
 * areas must mend the edges themselves, with and without zones; so pixels near edges are also measured alone. */
#include "furnace_box.h"

#define ALBEDO 0.5
#define BOUNCES 8
#define POWER 60.0 /* W a channel */
#define GLOW 2.0   /* W/(m2 sr) */
#define LIST_WITHIN 0.02
#define BUCKETS_WITHIN 0.05
#define LIVE "--indirect radiosity --receiver-rays 128"

/* moving: photons are traced while playing; else they are baked. The light moves by a millimetre, so that the six views still
 * see one and the same light. */
static void write_scene(scene_lab *l, const char *name, const char *mesh, const double from[3], bool moving) {
    FILE *f = scene_lab_create(l, name);
    (void)fprintf(f, "output: { width = %d; height = %d; fps = 1.0; frames = %d; };\nmeshes = ( { file = \"%s\"; } );\n", SIDE,
                  SIDE, VIEWS, mesh);
    write_views(f, from);
    (void)fprintf(f, "lights = ( { type = \"point\"; keys = ( { position = [-0.3, 0.2, 0.4]; power = [%.1f, %.1f, %.1f]; }",
                  POWER, POWER, POWER);
    if (moving)
        (void)fprintf(f, ", { time = 5.0; position = [-0.299, 0.2, 0.4]; }");
    (void)fprintf(f, "); } );\nquality: { bounces = %d; tile = 8; };\n", BOUNCES);
    (void)fclose(f);
}

/* Unit sphere: a cube's faces of n x n cells, blown up; normals are the positions. */
static void write_sphere(scene_lab *l, int n) {
    FILE *f = scene_lab_create(l, "sphere.obj");
    (void)fprintf(f, "mtllib half.mtl\nusemtl half\n");
    for (int side = 0; side < 6; side++)
        for (int j = 0; j <= n; j++)
            for (int i = 0; i <= n; i++) {
                double p[3], u = tan(PI / 4 * (2.0 * i / n - 1)), v = tan(PI / 4 * (2.0 * j / n - 1)),
                             r = sqrt(1 + u * u + v * v);
                p[side / 2] = (side & 1 ? -1 : 1) / r;
                p[(side / 2 + 1) % 3] = u / r;
                p[(side / 2 + 2) % 3] = v / r;
                (void)fprintf(f, "v %.7f %.7f %.7f\nvn %.7f %.7f %.7f\n", p[0], p[1], p[2], -p[0], -p[1], -p[2]);
            }
    for (int side = 0; side < 6; side++)
        for (int j = 0; j < n; j++)
            for (int i = 0; i < n; i++) {
                int a = (side * (n + 1) + j) * (n + 1) + i + 1, b = a + 1, c = b + n + 1, d = a + n + 1;
                (void)fprintf(f, "f %d//%d %d//%d %d//%d %d//%d\n", a, a, b, b, c, c, d, d);
            }
    (void)fclose(f);
}

/* Walls that emit and light one another, each point of them the same: radiance L (1 + rho + rho^2 + ...), of which view samples
 * see one reflection by points on the walls, and photons are the others. */
static void write_glowing_scene(scene_lab *l) {
    FILE *f = scene_lab_create(l, "glowing.cfg");
    (void)fprintf(f, "output: { width = %d; height = %d; fps = 1.0; frames = %d; };\nmeshes = ( { file = \"box.obj\"; } );\n",
                  SIDE, SIDE, VIEWS);
    write_views(f, eye);
    (void)fprintf(f, "materials = ( { name = \"half\"; emission = [%.1f, %.1f, %.1f]; } );\n", GLOW, GLOW, GLOW);
    (void)fprintf(f, "quality: { bounces = %d; tile = 8; radius = 0.1; photons = 65536; light_samples = 512; };\n", BOUNCES);
    (void)fclose(f);
}

static int set_up(void **state) {
    static scene_lab lab;
    scene_lab_open(&lab);
    FILE *f = scene_lab_create(&lab, "half.mtl");
    (void)fprintf(f, "newmtl half\nKd %g %g %g\n", ALBEDO, ALBEDO, ALBEDO);
    (void)fclose(f);
    static const double centre[3] = {0, 0, 0};
    write_box(&lab, "half");
    write_sphere(&lab, 16);
    write_scene(&lab, "box.cfg", "box.obj", eye, false);
    write_scene(&lab, "box_moving.cfg", "box.obj", eye, true);
    write_scene(&lab, "sphere.cfg", "sphere.obj", centre, false);
    write_glowing_scene(&lab);
    *state = &lab;
    return 0;
}

static double analytic(double area) {
    double sum = 0, part = 1;
    for (int k = 1; k < BOUNCES; k++)
        sum += part *= ALBEDO;
    return POWER / area * sum;
}

/* Mean over the box of indirect irradiance, over the analytic one. */
static double box_ratio(scene_lab *l, const char *scene, const char *options) {
    static float pixels[FLOATS];
    scene_lab_indirect(l, scene, options, pixels, FLOATS);
    double light = 0, area = 0;
    for (int i = 0; i < VIEWS; i++)
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                const double a = pixel_area(i, x, y);
                light += a * (double)pixels[4 * ((i * SIDE + y) * SIDE + x)] * PI / stored_albedo(ALBEDO);
                area += a;
            }
    if (fabs(area / box_area() - 1) > 2e-3) /* the views see the box once, all of it */
        fail_msg("the views see %g m2 of %g m2", area, box_area());
    const double ratio = light / box_area() / analytic(box_area());
    printf("box     %-44s %+.2f %%\n", options, 100 * (ratio - 1));
    return ratio;
}

/* Mean over the glowing box of a view's radiance. */
static double glowing_mean(scene_lab *l, const char *view) {
    static float pixels[FLOATS];
    double light = 0;
    scene_lab_play(l, view, pixels, FLOATS);
    for (int i = 0; i < VIEWS; i++)
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++)
                light += pixel_area(i, x, y) * (double)pixels[4 * ((i * SIDE + y) * SIDE + x)];
    return light / box_area();
}

/* Distance, m, of what the middle of pixel (x, y) of view i sees from the nearest edge of the box. */
static double edge_distance(int i, int x, int y) {
    const double u = (2 * x + 1.0) / SIDE - 1, v = 1 - (2 * y + 1.0) / SIDE;
    const double side[3] = {axis[i][1] * up[i][2] - axis[i][2] * up[i][1], axis[i][2] * up[i][0] - axis[i][0] * up[i][2],
                            axis[i][0] * up[i][1] - axis[i][1] * up[i][0]};
    double d[3], t = 1e30, least = 1e30;
    int wall = 0;
    for (int k = 0; k < 3; k++) {
        d[k] = axis[i][k] + u * side[k] + v * up[i][k];
        const double at = fabs(d[k]) > 1e-12 ? ((d[k] > 0 ? box_hi[k] : box_lo[k]) - eye[k]) / d[k] : 1e30;
        if (at < t) {
            t = at;
            wall = k;
        }
    }
    for (int k = 0; k < 3; k++)
        if (k != wall)
            least = fmin(least, fmin(box_hi[k] - eye[k] - t * d[k], eye[k] + t * d[k] - box_lo[k]));
    return least;
}

/* Mean irradiance over the room's mean, in the middle of the walls and in a strip along the edges, where a box has less light.
 */
typedef struct strips {
    double middle, edges;
} strips;

static strips box_strips(scene_lab *l, const char *options, double radius) {
    static float pixels[FLOATS];
    double light[2] = {0}, area[2] = {0};
    scene_lab_indirect(l, "box.cfg", options, pixels, FLOATS);
    for (int i = 0; i < VIEWS; i++)
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                const double far = edge_distance(i, x, y), a = pixel_area(i, x, y);
                if (far >= 0.3 * radius && far < radius)
                    continue;
                light[far < radius] += a * (double)pixels[4 * ((i * SIDE + y) * SIDE + x)] * PI / stored_albedo(ALBEDO);
                area[far < radius] += a;
            }
    const strips s = {light[0] / area[0] / analytic(box_area()), light[1] / area[1] / analytic(box_area())};
    printf("strips  %-60s middle %+.2f %%, edges %+.2f %%\n", options, 100 * (s.middle - 1), 100 * (s.edges - 1));
    return s;
}

/* Largest deviation from the analytic irradiance of the six views' means in the unit sphere. */
static double sphere_deviation(scene_lab *l, const char *options) {
    static float pixels[FLOATS];
    double worst = 0;
    scene_lab_indirect(l, "sphere.cfg", options, pixels, FLOATS);
    printf("sphere  %-44s", options);
    for (int i = 0; i < VIEWS; i++) {
        double light = 0, whole = 0;
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                const double angle = solid_angle((2 * x + 1.0) / SIDE - 1, (2 * y + 1.0) / SIDE - 1, SIDE);
                light += angle * (double)pixels[4 * ((i * SIDE + y) * SIDE + x)] * PI / stored_albedo(ALBEDO);
                whole += angle;
            }
        const double off = light / whole / analytic(4 * PI) - 1;
        printf(" %+.2f", 100 * off);
        worst = fabs(off) > worst ? fabs(off) : worst;
    }
    printf(" %%\n");
    return worst;
}

static void the_list_estimate_keeps_all_light_in_a_box(void **state) {
    assert_true(fabs(box_ratio(*state, "box.cfg", "--photons 65536 --radius 0.1") - 1) < LIST_WITHIN);
    assert_true(fabs(box_ratio(*state, "box.cfg", "--photons 65536 --radius 0.25") - 1) < LIST_WITHIN);
}

static void photons_traced_while_playing_carry_the_same_light(void **state) {
    assert_true(fabs(box_ratio(*state, "box_moving.cfg", "--photons 65536 --radius 0.1") - 1) < LIST_WITHIN);
}

/* The points' direct light is what there is of noise; a code of low rank loses some, too. */
static void live_radiosity_keeps_all_light_in_a_box(void **state) {
    assert_true(fabs(box_ratio(*state, "box_moving.cfg", LIVE " --patches 1024") - 1) < 0.005);
    assert_true(fabs(box_ratio(*state, "box_moving.cfg", LIVE " --patches 256 --codec float32") - 1) < 0.005);
}

static void the_bucket_estimate_keeps_all_light_in_a_box(void **state) {
    assert_true(fabs(box_ratio(*state, "box.cfg", "--photons 65536 --radius 0.25 --estimate buckets") - 1) < BUCKETS_WITHIN);
}

static void the_list_estimate_is_right_everywhere_in_a_sphere(void **state) {
    assert_true(sphere_deviation(*state, "--photons 65536 --radius 0.1") < LIST_WITHIN);
}

static void the_bucket_estimate_is_right_everywhere_in_a_sphere(void **state) {
    assert_true(sphere_deviation(*state, "--photons 65536 --radius 0.25 --estimate buckets") < BUCKETS_WITHIN);
}

static void walls_that_emit_light_one_another(void **state) {
    scene_lab_bake(*state, "glowing.cfg", "");
    double sum = GLOW * stored_albedo(ALBEDO), part = sum;
    for (int k = 1; k < BOUNCES; k++)
        sum += part *= ALBEDO;
    const double direct = glowing_mean(*state, "direct") / (GLOW * (1 + stored_albedo(ALBEDO))),
                 whole = glowing_mean(*state, "final") / (GLOW + sum);
    printf("glowing box: direct %+.2f %%, whole %+.2f %%\n", 100 * (direct - 1), 100 * (whole - 1));
    assert_true(fabs(direct - 1) < LIST_WITHIN);
    assert_true(fabs(whole - 1) < LIST_WITHIN);
}

#define STRIPS "--indirect-samples 1 --photons 65536 --radius 0.25 "
#define ALL_AREAS "--zones 1 --effective-area 1"
static bool agree(strips a, strips b, double middle, double edges) {
    return fabs(a.middle / b.middle - 1) < middle && fabs(a.edges / b.edges - 1) < edges;
}

/* What plain estimates lose at edges goes with the radius, so two radii tell what is there without loss. */
static strips true_strips(scene_lab *l) {
    const strips wide = box_strips(l, "--photons 262144 --radius 0.1 --zones 0 --effective-area 0", 0.25);
    const strips narrow = box_strips(l, "--photons 262144 --radius 0.05 --zones 0 --effective-area 0", 0.25);
    return (strips){2 * narrow.middle - wide.middle, 2 * narrow.edges - wide.edges};
}

static void effective_areas_mend_edges(void **state) {
    const strips truth = true_strips(*state);
    printf("without loss: middle %+.2f %%, edges %+.2f %%\n", 100 * (truth.middle - 1), 100 * (truth.edges - 1));
    assert_false(agree(box_strips(*state, STRIPS "--zones 0 --effective-area 0", 0.25), truth, 0.01, 0.08));
    assert_true(agree(box_strips(*state, STRIPS ALL_AREAS, 0.25), truth, 0.01, 0.03));
    assert_true(agree(box_strips(*state, STRIPS "--zones 0 --effective-area 1", 0.25), truth, 0.01, 0.06));
}

static void effective_areas_keep_the_light(void **state) {
    assert_true(fabs(box_ratio(*state, "box.cfg", STRIPS ALL_AREAS) - 1) < 0.01);
    assert_true(sphere_deviation(*state, STRIPS ALL_AREAS) < 0.02);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_list_estimate_keeps_all_light_in_a_box),
        cmocka_unit_test(photons_traced_while_playing_carry_the_same_light),
        cmocka_unit_test(live_radiosity_keeps_all_light_in_a_box),
        cmocka_unit_test(the_bucket_estimate_keeps_all_light_in_a_box),
        cmocka_unit_test(the_list_estimate_is_right_everywhere_in_a_sphere),
        cmocka_unit_test(the_bucket_estimate_is_right_everywhere_in_a_sphere),
        cmocka_unit_test(walls_that_emit_light_one_another),
        cmocka_unit_test(effective_areas_mend_edges),
        cmocka_unit_test(effective_areas_keep_the_light),
    };
    return cmocka_run_group_tests_name("furnace", tests, set_up, scene_lab_tear_down);
}
