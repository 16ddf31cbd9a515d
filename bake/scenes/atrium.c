#include "atrium.h"
#include "scenes.h"
#include "textures.h"

static const mesh_material materials[] = {
    {"marble", {0.95, 0.95, 0.95}, "marble.png"},
    {"court", {0.95, 0.95, 0.95}, "court.png"},
    {"terracotta", {0.95, 0.95, 0.95}, "terracotta.png"},
    {"ashlar", {0.95, 0.95, 0.95}, "ashlar.png"},
    {"plaster", {0.95, 0.95, 0.95}, "plaster.png"},
    {"wood", {0.95, 0.95, 0.95}, "wood.png"},
    {"glaze", {0.95, 0.95, 0.95}, "glaze.png"},
    {"red_cloth", {1.0, 1.0, 1.0}, "red.png"},
    {"green_cloth", {1.0, 1.0, 1.0}, "green.png"},
    {"blue_cloth", {1.0, 1.0, 1.0}, "blue.png"},
    {"leaves", {1.0, 1.0, 1.0}, "leaves.png"},
    {"gilt", {0.65, 0.45, 0.15}, NULL},
    {"clay", {0.56, 0.27, 0.15}, NULL},
    {"water", {0.10, 0.28, 0.34}, NULL},
    {"trim", {0.67, 0.63, 0.56}, NULL},
};

atrium_side atrium_side_of(int i) {
    static const v3 origin[4] = {{0, 0, -COURT_Z}, {COURT_X, 0, 0}, {0, 0, COURT_Z}, {-COURT_X, 0, 0}};
    static const int quarters[4] = {0, 3, 2, 1};
    bool is_long = (i & 1) == 0;
    return (atrium_side){mesh_frame_at(origin[i & 3], quarters[i & 3]), is_long ? LONG_BAYS : SHORT_BAYS, is_long};
}

void atrium_ring(mesh *m, double hx, double hz, const double (*profile)[2], int count, double uv) {
    for (int i = 0; i < 4; i++) {
        bool is_long = (i & 1) == 0;
        double half = is_long ? hx : hz, away = is_long ? hz : hx;
        mesh_frame f = atrium_side_of(i).frame;
        double length = 0.0;
        for (int k = 0; k + 1 < count; k++) {
            double w0 = profile[k][0], w1 = profile[k + 1][0], y0 = profile[k][1], y1 = profile[k + 1][1];
            double slope = sqrt((w1 - w0) * (w1 - w0) + (y1 - y0) * (y1 - y0));
            const double corner[4][3] = {{-half + w0, y0, w0}, {half - w0, y0, w0}, {half - w1, y1, w1}, {-half + w1, y1, w1}};
            v3 n = v3_unit(v3_of(0, w0 - w1, y1 - y0));
            uint32_t at[4];
            m->frame = f;
            m->frame.o = v3_scale(f.z, -away);
            for (int c = 0; c < 4; c++) {
                vertex v = {.p = {corner[c][0], corner[c][1], corner[c][2]}, .n = n, .u = corner[c][0] / uv};
                v.v = (length + (c > 1 ? slope : 0.0)) / uv;
                at[c] = mesh_vertex(m, v);
            }
            mesh_triangle(m, at[0], at[1], at[2]);
            mesh_triangle(m, at[0], at[2], at[3]);
            length += slope;
        }
    }
    m->frame = mesh_frame_at(v3_of(0, 0, 0), 0);
}

bool atrium_make(const char *dir, scenes_report *report) {
    size_t count;
    const texture *textures = atrium_textures(&count);
    for (size_t i = 0; i < count; i++) {
        report->file = textures[i].file;
        if (!texture_write(textures + i, dir))
            return false;
    }
    mesh m;
    mesh_init(&m);
    atrium_hall(&m);
    atrium_ceilings(&m);
    atrium_colonnades(&m);
    atrium_curtains(&m);
    atrium_banners(&m);
    atrium_props(&m);
    report->file = "atrium.obj";
    report->triangles = m.triangle_count;
    bool good = mesh_write(&m, dir, "atrium", materials, sizeof materials / sizeof materials[0]);
    mesh_free(&m);
    return good;
}
