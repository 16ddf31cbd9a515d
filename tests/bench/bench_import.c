/* Our readers of mesh files against Assimp's, from file to model: processor time, and memory at its highest. Each reading has a
 * process of its own, the two in turn. Pictures are the same work for both and would hide the rest: Sponza is read from a copy
 * without them. Both must have the same triangles in the same box before anything is timed. */
#include "import/assimp/assimp.h"
#include "import/importer.h"
#include "scenes.h"

#include <stdarg.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <zip.h>

#define ROUNDS 11

typedef struct reading {
    struct rusage used;
    uint32_t triangles;
    double size[3];       /* of the box */
    double ms, mib, wall; /* of processor time; above a process that reads nothing; by the clock */
} reading;

static void read_here(const char *path, const import_format *format, reading *out) {
    scene s;
    vit_text why = {{0}};
    model m = {0};
    if (scene_for_mesh(path, &s, &why) != VIT_OK)
        bench_fail("%s", why.text);
    importer im = {.s = &s, .m = &m, .why = &why, .file = path, .format = format};
    if (!format->read(&im, &s.meshes[0]))
        bench_fail("%s", why.text);
    double lo[3] = {1e30, 1e30, 1e30}, hi[3] = {-1e30, -1e30, -1e30};
    for (size_t i = 0; i < 3 * (size_t)m.vertices; i++) {
        lo[i % 3] = fmin(lo[i % 3], (double)m.position[i]);
        hi[i % 3] = fmax(hi[i % 3], (double)m.position[i]);
    }
    out->triangles = m.triangles;
    for (int k = 0; k < 3; k++)
        out->size[k] = hi[k] - lo[k];
}

/* In a process of its own; format NULL: does nothing. */
static reading read_apart(const char *path, const import_format *format) {
    int ends[2];
    reading r = {.triangles = 0};
    const double began = bench_seconds();
    const pid_t child = pipe(ends) == 0 ? fork() : -1;
    if (child < 0)
        bench_fail("no process: %s", strerror(errno));
    if (child == 0) {
        if (format)
            read_here(path, format, &r);
        (void)getrusage(RUSAGE_SELF, &r.used);
        _exit(write(ends[1], &r, sizeof r) == (ssize_t)sizeof r ? 0 : 1);
    }
    (void)close(ends[1]);
    int status = 0;
    if (read(ends[0], &r, sizeof r) != (ssize_t)sizeof r || waitpid(child, &status, 0) != child || status != 0)
        bench_fail("%s: the reading process has ended", path);
    (void)close(ends[0]);
    r.wall = 1e3 * (bench_seconds() - began);
    r.ms = 1e3 * (double)(r.used.ru_utime.tv_sec + r.used.ru_stime.tv_sec) +
           1e-3 * (double)(r.used.ru_utime.tv_usec + r.used.ru_stime.tv_usec);
    r.mib = (double)r.used.ru_maxrss / 1024.0;
    return r;
}

static bool same(const reading *a, const reading *b) {
    for (int k = 0; k < 3; k++)
        if (fabs(a->size[k] - b->size[k]) > 1e-5 * fabs(a->size[k]))
            return false;
    return a->triangles == b->triangles;
}

static void row(csv *c, const char *name, const char *reader, const char *what, const series *s, const char *unit) {
    char column[64];
    (void)snprintf(column, sizeof column, "%s, %s", reader, what);
    printf("%-8s %-26s %9.2f +- %6.2f %s (%d)\n", name, column, series_median(s), series_mad(s), unit, s->count);
    csv_row(c, name, "", column, s, unit);
}

static void compare(csv *c, const char *name, const char *path) {
    series ms[2] = {{.count = 0}}, mib[2] = {{.count = 0}}, wall[2] = {{.count = 0}};
    FILE *file = fopen(path, "rb");
    uint8_t head[4096];
    if (!file)
        bench_fail("%s: %s", path, strerror(errno));
    const size_t size = fread(head, 1, sizeof head, file);
    (void)fclose(file);
    const import_format *const formats[2] = {import_format_of(path, head, size), &assimp_format};
    for (int i = 0; i < bench_rounds(ROUNDS); i++) {
        const double nothing = read_apart(path, NULL).mib;
        const reading ours = read_apart(path, formats[0]), theirs = read_apart(path, formats[1]);
        if (!same(&ours, &theirs))
            bench_fail("%s: %u triangles, and %u by Assimp, or another box", path, ours.triangles, theirs.triangles);
        const reading *const both[2] = {&ours, &theirs};
        for (int k = 0; k < 2; k++) {
            series_add(&ms[k], both[k]->ms);
            series_add(&mib[k], both[k]->mib - nothing);
            series_add(&wall[k], both[k]->wall);
        }
    }
    for (int k = 0; k < 2; k++) {
        row(c, name, formats[k]->name, "processor", &ms[k], "ms");
        row(c, name, formats[k]->name, "clock", &wall[k], "ms");
        row(c, name, formats[k]->name, "memory", &mib[k], "MiB");
    }
    printf("%-8s ours over Assimp's: processor %.2f, clock %.2f, memory %.2f\n", name,
           series_median(&ms[0]) / series_median(&ms[1]), series_median(&wall[0]) / series_median(&wall[1]),
           series_median(&mib[0]) / series_median(&mib[1]));
}

/* A square of edge * edge quads with normals and texture coordinates. */
static void write_grid(const char *folder, uint32_t edge, char path[BENCH_PATH]) {
    const uint32_t vertices = (edge + 1) * (edge + 1), corners = 6 * edge * edge;
    float *at = bench_array(8 * (size_t)vertices, sizeof *at);
    uint32_t *corner = bench_array(corners, sizeof *corner), *to = corner;
    for (uint32_t i = 0; i < vertices; i++) {
        const float x = (float)(i % (edge + 1)), y = (float)(i / (edge + 1)), v[8] = {x, y, 0, 0, 0, 1, x / 8, y / 8};
        memcpy(at + 3 * i, v, 12);
        memcpy(at + 3 * (size_t)vertices + 3 * i, v + 3, 12);
        memcpy(at + 6 * (size_t)vertices + 2 * i, v + 6, 8);
    }
    for (uint32_t y = 0; y < edge; y++)
        for (uint32_t x = 0; x < edge; x++, to += 6) {
            const uint32_t a = y * (edge + 1) + x, b = a + edge + 1, quad[6] = {a, a + 1, b, a + 1, b + 1, b};
            memcpy(to, quad, sizeof quad);
        }
    (void)snprintf(path, BENCH_PATH, "%s/grid.bin", folder);
    FILE *f = fopen(path, "wb");
    if (!f || fwrite(at, 32, vertices, f) != vertices || fwrite(corner, 4, corners, f) != corners || fclose(f) != 0)
        bench_fail("%s cannot be written", path);
    (void)snprintf(path, BENCH_PATH, "%s/grid.gltf", folder);
    f = fopen(path, "w");
    if (!f)
        bench_fail("%s cannot be written", path);
    (void)fprintf(
        f,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],\"meshes\":"
        "[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2},\"indices\":3}]}],"
        "\"buffers\":[{\"uri\":\"grid.bin\",\"byteLength\":%u}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":%u},"
        "{\"buffer\":0,\"byteOffset\":%u,\"byteLength\":%u}],\"accessors\":[",
        32 * vertices + 4 * corners, 32 * vertices, 32 * vertices, 4 * corners);
    (void)fprintf(f,
                  "{\"bufferView\":0,\"componentType\":5126,\"count\":%u,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[%u,%u,0]},"
                  "{\"bufferView\":0,\"byteOffset\":%u,\"componentType\":5126,\"count\":%u,\"type\":\"VEC3\"},"
                  "{\"bufferView\":0,\"byteOffset\":%u,\"componentType\":5126,\"count\":%u,\"type\":\"VEC2\"},"
                  "{\"bufferView\":1,\"componentType\":5125,\"count\":%u,\"type\":\"SCALAR\"}]}",
                  vertices, edge, edge, 12 * vertices, vertices, 24 * vertices, vertices, corners);
    (void)fclose(f);
    free(at);
    free(corner);
}

/* A height field of edge * edge * 2 triangles, binary little-endian, as scanners and sculpting programs write them. */
static void write_ply(const char *folder, uint32_t edge, char path[BENCH_PATH]) {
    const uint32_t vertices = (edge + 1) * (edge + 1), triangles = 2 * edge * edge;
    (void)snprintf(path, BENCH_PATH, "%s/grid.ply", folder);
    FILE *f = fopen(path, "wb");
    if (!f)
        bench_fail("%s cannot be written", path);
    (void)fprintf(f,
                  "ply\nformat binary_little_endian 1.0\nelement vertex %u\nproperty float x\nproperty float y\n"
                  "property float z\nproperty float nx\nproperty float ny\nproperty float nz\nelement face %u\n"
                  "property list uchar int vertex_indices\nend_header\n",
                  vertices, triangles);
    for (uint32_t i = 0; i < vertices; i++) {
        const float x = (float)(i % (edge + 1)), y = (float)(i / (edge + 1)), z = 20.0f * sinf(x / 50.0f) * cosf(y / 70.0f);
        const float v[6] = {x,   y, z, -0.4f * cosf(x / 50.0f) * cosf(y / 70.0f), 0.28f * sinf(x / 50.0f) * sinf(y / 70.0f),
                            1.0f};
        (void)fwrite(v, sizeof v, 1, f);
    }
    for (uint32_t i = 0; i < triangles; i++) {
        const uint32_t a = i / 2 % edge + i / 2 / edge * (edge + 1), b = a + edge + 1, odd = i % 2;
        const uint32_t corner[3] = {a + odd, odd ? b + 1 : a + 1, b};
        (void)fputc(3, f);
        (void)fwrite(corner, sizeof corner, 1, f);
    }
    if (fclose(f) != 0)
        bench_fail("%s cannot be written", path);
}

/* The same as OBJ, with six digits behind the point, as exporters write them. */
static void write_obj_grid(const char *folder, uint32_t edge, char path[BENCH_PATH]) {
    (void)snprintf(path, BENCH_PATH, "%s/grid.obj", folder);
    FILE *f = fopen(path, "w");
    if (!f)
        bench_fail("%s cannot be written", path);
    for (uint32_t y = 0; y <= edge; y++)
        for (uint32_t x = 0; x <= edge; x++)
            (void)fprintf(f, "v %.6f %.6f %.6f\nvt %.6f %.6f\n", x / 7.0, y / 7.0, ((x * y) % 64) / 640.0, x / 8.0, y / 8.0);
    (void)fprintf(f, "vn 0.000000 0.000000 1.000000\no grid\n");
    for (uint32_t y = 0; y < edge; y++)
        for (uint32_t x = 0; x < edge; x++) {
            const uint32_t a = y * (edge + 1) + x + 1, b = a + edge + 1;
            (void)fprintf(f, "f %u/%u/1 %u/%u/1 %u/%u/1\nf %u/%u/1 %u/%u/1 %u/%u/1\n", a, a, a + 1, a + 1, b, b, a + 1, a + 1,
                          b + 1, b + 1, b, b);
        }
    if (fclose(f) != 0)
        bench_fail("%s cannot be written", path);
}

/* Text that grows. */
typedef struct growing {
    char *at;
    size_t size, room;
} growing;

__attribute__((format(printf, 2, 3))) static void add(growing *g, const char *format, ...) {
    va_list args;
    if (g->room - g->size < 256) {
        g->room = g->room ? 2 * g->room : 1 << 20;
        g->at = realloc(g->at, g->room);
        if (!g->at)
            bench_fail("out of memory");
    }
    va_start(args, format);
    g->size += (size_t)vsnprintf(g->at + g->size, 256, format, args);
    va_end(args);
}

/* A height field as 3MF, packed, with six digits behind the point. It is as high as it is wide, so that its box is the same
 * with z up, as 3MF has it, and with y up, as Assimp has it. */
static void write_3mf(const char *folder, uint32_t edge, char path[BENCH_PATH]) {
    static const char relations[] =
        "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship "
        "Target=\"/3D/3dmodel.model\" Id=\"r\" Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>"
        "</Relationships>";
    growing g = {NULL, 0, 0};
    int error;
    add(&g, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"meter\" "
            "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n<resources>\n<object id=\"1\" "
            "type=\"model\">\n<mesh>\n<vertices>\n");
    for (uint32_t y = 0; y <= edge; y++)
        for (uint32_t x = 0; x <= edge; x++)
            add(&g, "<vertex x=\"%.6f\" y=\"%.6f\" z=\"%.6f\"/>\n", x / 7.0, y / 7.0,
                (x * 7919 + y * 104729) % (edge + 1) / 7.0);
    add(&g, "</vertices>\n<triangles>\n");
    for (uint32_t y = 0; y < edge; y++)
        for (uint32_t x = 0; x < edge; x++) {
            const uint32_t a = y * (edge + 1) + x, b = a + edge + 1;
            add(&g, "<triangle v1=\"%u\" v2=\"%u\" v3=\"%u\"/>\n<triangle v1=\"%u\" v2=\"%u\" v3=\"%u\"/>\n", a, a + 1, b,
                a + 1, b + 1, b);
        }
    add(&g, "</triangles>\n</mesh>\n</object>\n</resources>\n<build>\n<item objectid=\"1\"/>\n</build>\n</model>\n");
    (void)snprintf(path, BENCH_PATH, "%s/grid.3mf", folder);
    zip_t *archive = zip_open(path, ZIP_CREATE | ZIP_TRUNCATE, &error);
    if (!archive ||
        zip_file_add(archive, "_rels/.rels", zip_source_buffer(archive, relations, sizeof relations - 1, 0), 0) < 0 ||
        zip_file_add(archive, "3D/3dmodel.model", zip_source_buffer(archive, g.at, g.size, 0), 0) < 0 ||
        zip_close(archive) != 0)
        bench_fail("%s cannot be written", path);
    free(g.at);
}

static void copy(const char *from, const char *to) {
    char bytes[65536];
    FILE *in = fopen(from, "rb"), *out = fopen(to, "wb");
    size_t size;
    if (!in || !out)
        bench_fail("%s cannot be copied", from);
    while ((size = fread(bytes, 1, sizeof bytes, in)) > 0)
        if (fwrite(bytes, 1, size, out) != size)
            bench_fail("%s cannot be written", to);
    (void)fclose(in);
    (void)fclose(out);
}

/* The mesh and what of it lies in a file beside it (".bin"), without the pictures. */
static bool copy_scene(const bench_scene *of, const char *beside, const char *folder, char path[BENCH_PATH]) {
    char mesh[BENCH_PATH], to[BENCH_PATH];
    if (!scene_mesh_path(of, mesh))
        return false;
    (void)snprintf(path, BENCH_PATH, "%s/%s", folder, strrchr(mesh, '/') + 1);
    copy(mesh, path);
    (void)snprintf(strrchr(mesh, '.'), 5, "%s", beside);
    (void)snprintf(to, sizeof to, "%s/%s", folder, strrchr(mesh, '/') + 1);
    copy(mesh, to);
    return true;
}

int main(void) {
    char path[BENCH_PATH];
    csv c = csv_open("import");
    const char *folder = BENCH_FOLDER "/import";
    bench_folder(BENCH_FOLDER);
    bench_folder(folder);
    write_grid(folder, bench_smoke() ? 16 : 1000, path);
    compare(&c, "grid", path);
    write_ply(folder, bench_smoke() ? 16 : 1582, path);
    compare(&c, "ply", path);
    if (!bench_smoke() && copy_scene(&bench_scenes[1], ".bin", folder, path))
        compare(&c, "sponza", path);
    write_3mf(folder, bench_smoke() ? 16 : 500, path);
    compare(&c, "3MF grid", path);
    write_obj_grid(folder, bench_smoke() ? 16 : 700, path);
    compare(&c, "OBJ grid", path);
    if (!bench_smoke() && copy_scene(&bench_scenes[2], ".mtl", folder, path))
        compare(&c, "sibenik", path);
    csv_close(&c, "import");
    return VIT_OK;
}
