/* Balls of glTF's materials, metallic 1 in front and 0 behind, roughness 0.1 to 1 from the left, on a floor under a sky's
 * picture and a point light, against path tracing: of each ball its light over the reference's, and the error of its pixels but
 * for peaks of highlights. A picture a method in build/bench/indirect: above what is played, below the
 * reference.
 *
 * METHODS="basis basis+gloss-rays=0": each as bench_indirect.c has it; REFERENCE_SECONDS=40: that the reference may take. */
#include "indirect_methods.h"
#include "indirect_truth.h"

enum { BALLS = 10, ACROSS = 64, DOWN = 32, SKY_W = 64, SKY_H = 32, WIDTH = 320, HEIGHT = 160 };
#define RADIUS 0.45
#define PEAK 4.0 /* of a ball's mean: brighter pixels are highlights' */
#define PI 3.14159265358979323846
static const double roughnesses[5] = {0.1, 0.3, 0.5, 0.7, 1.0}, eye[3] = {0, 2.4, 7.5}, target[3] = {0, 0.35, 0}, fov = 24;

static void centre_of(int ball, double out[3]) {
    out[0] = (ball % 5 - 2) * 1.05;
    out[1] = RADIUS;
    out[2] = ball < 5 ? 0.6 : -0.7;
}

static void write_balls(void) {
    FILE *f = untuned_create("gloss", ".obj");
    fprintf(f, "mtllib gloss.mtl\nusemtl floor\nv -8 0 -8\nv 8 0 -8\nv 8 0 8\nv -8 0 8\nf 4 3 2 1\n");
    for (int b = 0; b < BALLS; b++) {
        double c[3];
        centre_of(b, c);
        for (int y = 0; y <= DOWN; y++)
            for (int x = 0; x < ACROSS; x++) {
                const double t = PI * y / DOWN, p = 2 * PI * x / ACROSS, n[3] = {sin(t) * cos(p), cos(t), sin(t) * sin(p)};
                fprintf(f, "v %.7f %.7f %.7f\nvn %.7f %.7f %.7f\n", c[0] + RADIUS * n[0], c[1] + RADIUS * n[1],
                        c[2] + RADIUS * n[2], n[0], n[1], n[2]);
            }
        fprintf(f, "usemtl ball%d\n", b);
        for (int y = 0; y < DOWN; y++)
            for (int x = 0; x < ACROSS; x++) {
                const int at = b * (DOWN + 1) * ACROSS + 1, i[4] = {y * ACROSS + x, y * ACROSS + (x + 1) % ACROSS,
                                                                    (y + 1) * ACROSS + (x + 1) % ACROSS, (y + 1) * ACROSS + x};
                if (y > 0)
                    fprintf(f, "f %d//%d %d//%d %d//%d\n", at + 4 + i[0], at + i[0], at + 4 + i[1], at + i[1], at + 4 + i[2],
                            at + i[2]);
                if (y < DOWN - 1)
                    fprintf(f, "f %d//%d %d//%d %d//%d\n", at + 4 + i[0], at + i[0], at + 4 + i[2], at + i[2], at + 4 + i[3],
                            at + i[3]);
            }
    }
    fclose(f);
    f = untuned_create("gloss", ".mtl");
    fprintf(f, "newmtl floor\nKd 0.35 0.35 0.35\n");
    for (int b = 0; b < BALLS; b++)
        fprintf(f, "newmtl ball%d\nKd 0.9 0.6 0.3\nPr %g\nPm %d\n", b, roughnesses[b % 5], b < 5);
    fclose(f);
}

/* A sky of blue above and grey below the horizon, with a bright window. */
static void write_sky(void) {
    static const unsigned char header[18] = {[2] = 2, [12] = SKY_W, [14] = SKY_H, [16] = 24, [17] = 0x20};
    FILE *f = untuned_create("gloss", ".tga");
    fwrite(header, 1, sizeof header, f);
    for (int y = 0; y < SKY_H; y++)
        for (int x = 0; x < SKY_W; x++) {
            const bool window = x >= 18 && x < 26 && y >= 5 && y < 11, up = y < SKY_H / 2;
            const int rgb[3] = {window ? 255
                                : up   ? 80 + 6 * y
                                       : 90,
                                window ? 250
                                : up   ? 130 + 4 * y
                                       : 85,
                                window ? 235
                                : up   ? 220
                                       : 80};
            for (int k = 2; k >= 0; k--)
                fputc(rgb[k], f);
        }
    fclose(f);
}

static void write_scene(void) {
    FILE *f = untuned_create("gloss", ".cfg");
    fprintf(f,
            "output: { width = %d; height = %d; frames = 1; };\nmeshes = ( { file = \"gloss.obj\"; } );\n"
            "sky: { image = \"gloss.tga\"; light = true; scale = 2.0; };\n"
            "camera: { keys = ( { eye = [%.3f, %.3f, %.3f]; target = [%.3f, %.3f, %.3f]; fov = %.3f; exposure = 1.0; } ); };\n"
            "lights = ( { type = \"point\"; keys = ( { position = [2.0, 4.0, 4.0]; power = [400.0, 400.0, 400.0]; } ); } );\n"
            "quality: { lobe = \"ggx\"; };\n",
            WIDTH, HEIGHT, eye[0], eye[1], eye[2], target[0], target[1], target[2], fov);
    fclose(f);
}

/* The ball that the pixel's ray meets first, or -1. */
static int ball_at(double x, double y) {
    double f[3], d[3], best = 1e9;
    int found = -1;
    const double half = tan(fov * PI / 360);
    for (int k = 0; k < 3; k++)
        f[k] = target[k] - eye[k];
    const double length = sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
    const double u = (2 * x / WIDTH - 1) * half * WIDTH / HEIGHT, v = (1 - 2 * y / HEIGHT) * half;
    /* right is (1, 0, 0): the camera looks along x = 0 */
    d[0] = u;
    d[1] = f[1] / length + v * -f[2] / length;
    d[2] = f[2] / length + v * f[1] / length;
    for (int b = 0; b < BALLS; b++) {
        double c[3], o[3], dd = 0, od = 0, oo = 0;
        centre_of(b, c);
        for (int k = 0; k < 3; k++) {
            o[k] = eye[k] - c[k];
            dd += d[k] * d[k];
            od += o[k] * d[k];
            oo += o[k] * o[k];
        }
        const double q = od * od - dd * (oo - 0.98 * 0.98 * RADIUS * RADIUS), t = q > 0 ? (-od - sqrt(q)) / dd : 1e9;
        if (t > 0 && t < best) {
            best = t;
            found = b;
        }
    }
    return found;
}

typedef struct ball_error {
    double got[3], right[3], mean; /* light of all its pixels; of one */
    double off, noise;             /* squared errors of those that are kept, and what the reference's own noise makes of them */
    size_t pixels, kept;
} ball_error;

static ball_error error_of(const method *m, const truth *t, uint32_t every, int ball) {
    const truth_part *p = &t->part[PICTURE];
    ball_error e = {.mean = 0};
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < (size_t)t->r.width * t->r.height; i++) {
            const double *right = p->light + 3 * i, middle = every / 2 + 0.5;
            const float *got = m->picture + 3 * i;
            if (ball_at((double)(i % t->r.width) * every + middle, (double)(i / t->r.width) * every + middle) != ball)
                continue;
            e.pixels += pass == 0;
            const bool kept = pass == 1 && right[0] + right[1] + right[2] <= 3 * PEAK * e.mean;
            e.kept += kept;
            for (size_t k = 0; k < 3; k++) {
                e.got[k] += pass == 0 ? (double)got[k] : 0;
                e.right[k] += pass == 0 ? right[k] : 0;
                e.off += kept ? pow((double)got[k] - right[k], 2) / 3 : 0;
                e.noise += kept ? p->variance[3 * i + k] / 3 : 0;
            }
        }
        e.mean = (e.right[0] + e.right[1] + e.right[2]) / (3 * (double)e.pixels);
    }
    return e;
}

static void print_balls(const method *m, const truth *t, uint32_t every) {
    for (int b = 0; b < BALLS; b++) {
        const ball_error e = error_of(m, t, every, b);
        const double all = e.mean * e.mean * (double)e.kept;
        if (!isfinite(e.off))
            bench_fail("ball %d: the light is no number", b);
        printf("%-24s %8d %9.1f  %6.3f %6.3f %6.3f  %8.4f %8.4f  %6zu %6zu\n", m->name, b < 5, roughnesses[b % 5],
               e.got[0] / e.right[0], e.got[1] / e.right[1], e.got[2] / e.right[2], (e.off - e.noise) / all, e.noise / all,
               e.kept, e.pixels);
    }
}

static void write_picture(const char *name, const float *played, const truth *t) {
    FILE *f = untuned_create(name, ".ppm");
    const size_t w = t->r.width, h = t->r.height;
    fprintf(f, "P6\n%zu %zu\n255\n", w, 2 * h);
    for (size_t i = 0; i < 2 * h * w; i++)
        for (size_t k = 0; k < 3; k++)
            fputc(truth_shade(0.4 * (i < h * w ? (double)played[3 * i + k] : t->part[PICTURE].light[3 * (i - h * w) + k])), f);
    fclose(f);
}

int main(void) {
    char names[512], *rest = NULL;
    const char *given = getenv("METHODS"), *seconds = getenv("REFERENCE_SECONDS");
    truth t = {.sum = NULL};
    const uint32_t every = bench_smoke() ? 8 : 1;
    char folder[BENCH_PATH];
    untuned_path(folder, "", "");
    bench_folder(folder);
    write_balls();
    write_sky();
    write_scene();
    snprintf(names, sizeof names, "%s", given ? given : bench_smoke() ? "basis+gloss-rays=1" : "basis basis+gloss-rays=0");
    printf("%-24s %8s %9s  %6s %6s %6s  %8s %8s  %6s %6s\n", "", "metallic", "roughness", "red", "green", "blue", "NMSE", "own",
           "kept", "pixels");
    for (char *word = strtok_r(names, " ", &rest); word; word = strtok_r(NULL, " ", &rest)) {
        const untuned_scene s = {.name = "gloss"};
        method m = {.name = word};
        pack_image image = method_bake(&s, &m);
        const images_grid grid = {WIDTH, HEIGHT, every};
        m.picture = method_play(&image, VIT_VIEW_final, 0, &grid);
        if (!t.sum) { /* the same for all */
            const pack_sections sections = pack_sections_of(image.bytes);
            reference_input in = {.sections = &sections, .frame = 0, .every = every, .cache = folder};
            truth_trace(&in, 1e-4, seconds ? atof(seconds) : bench_smoke() ? 0.2 : 40, &t);
        }
        print_balls(&m, &t, every);
        write_picture(m.name, m.picture, &t);
        free(m.picture);
        image_free(&image);
    }
    truth_free(&t);
    return 0;
}
