/* FBX and COLLADA files of one triangle: corners at 0, 1 along x and 1 along the file's up axis, say. A program defines
 * FOLDER, where they go, before it includes this. */
#ifndef VIT_TESTS_FOREIGN_LAB_H
#define VIT_TESTS_FOREIGN_LAB_H

#include "case_model.h"

/* The file in a scene whose mesh has these settings. */
static inline void import_with(const char *file, const char *settings, model *m) {
    char text[512];
    scene s;
    vit_text why = {{0}};
    (void)snprintf(text, sizeof text,
                   "meshes = ( { file = \"%s\"; %s } ); camera: { keys = ( { eye = (0, 1, 3); target = (0, 1, 0); } ); };\n",
                   file, settings);
    put(FILE_OF("m.cfg"), text);
    forget_warnings();
    if (scene_read(FILE_OF("m.cfg"), &s, &why) != VIT_OK || model_import(&s, false, remember, NULL, m, &why) != VIT_OK)
        fail_msg("%s", why.text);
    scene_free(&s);
}

/* t.fbx: one triangle of `corners`; axes right, up, front with signs; more objects and connections. */
static inline void put_fbx(const char *corners, const int axes[6], double unit, const char *objects, const char *connections) {
    char text[8192];
    static const char *const names[6] = {"CoordAxis", "CoordAxisSign", "UpAxis", "UpAxisSign", "FrontAxis", "FrontAxisSign"};
    int used = snprintf(text, sizeof text,
                        "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n\tFBXHeaderVersion: 1003\n\tFBXVersion: 7400\n}\n"
                        "GlobalSettings:  {\n\tVersion: 1000\n\tProperties70:  {\n");
    for (int i = 0; i < 6; i++)
        used += snprintf(text + used, sizeof text - (size_t)used, "\t\tP: \"%s\", \"int\", \"Integer\", \"\",%d\n", names[i],
                         axes[i]);
    used += snprintf(
        text + used, sizeof text - (size_t)used,
        "\t\tP: \"UnitScaleFactor\", \"double\", \"Number\", \"\",%.9g\n\t}\n}\n"
        "Definitions:  {\n\tVersion: 100\n\tCount: 2\n}\nObjects:  {\n"
        "\tGeometry: 100, \"Geometry::g\", \"Mesh\" {\n\t\tVertices: *9 {\n\t\t\ta: %s\n\t\t}\n"
        "\t\tPolygonVertexIndex: *3 {\n\t\t\ta: 0,1,-3\n\t\t}\n\t\tGeometryVersion: 124\n"
        "\t\tLayerElementMaterial: 0 {\n\t\t\tVersion: 101\n\t\t\tName: \"\"\n\t\t\tMappingInformationType: \"AllSame\"\n"
        "\t\t\tReferenceInformationType: \"IndexToDirect\"\n\t\t\tMaterials: *1 {\n\t\t\t\ta: 0\n\t\t\t}\n\t\t}\n"
        "\t\tLayerElementUV: 0 {\n\t\t\tVersion: 101\n\t\t\tName: \"uv\"\n"
        "\t\t\tMappingInformationType: \"ByPolygonVertex\"\n\t\t\tReferenceInformationType: \"Direct\"\n"
        "\t\t\tUV: *6 {\n\t\t\t\ta: 0,0,1,0,1,1\n\t\t\t}\n\t\t}\n"
        "\t\tLayer: 0 {\n\t\t\tVersion: 100\n\t\t\tLayerElement:  {\n\t\t\t\tType: \"LayerElementMaterial\"\n"
        "\t\t\t\tTypedIndex: 0\n\t\t\t}\n\t\t\tLayerElement:  {\n\t\t\t\tType: \"LayerElementUV\"\n"
        "\t\t\t\tTypedIndex: 0\n\t\t\t}\n\t\t}\n\t}\n"
        "\tModel: 200, \"Model::m\", \"Mesh\" {\n\t\tVersion: 232\n\t\tProperties70:  {\n\t\t}\n\t}\n%s}\n"
        "Connections:  {\n\tC: \"OO\",200,0\n\tC: \"OO\",100,200\n%s}\n",
        unit, corners, objects, connections);
    assert_true(used > 0 && (size_t)used < sizeof text);
    put(FILE_OF("t.fbx"), text);
}

static const int y_up[6] = {0, 1, 1, 1, 2, 1}, z_up[6] = {0, 1, 2, 1, 1, -1};

#define DAE_UNIT(metres, up) "<unit name=\"u\" meter=\"" metres "\"/><up_axis>" up "_UP</up_axis>"

/* t.dae; `more` goes before the geometries, `nodes` into the scene. */
static inline void put_dae_with(const char *asset, const char *positions, const char *more, const char *nodes) {
    char text[4096];
    const int used = snprintf(
        text, sizeof text,
        "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\"><asset>%s"
        "</asset>%s<library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"pa\" count=\"9\">%s"
        "</float_array><technique_common><accessor source=\"#pa\" count=\"3\" stride=\"3\"><param name=\"X\" type=\"float\"/>"
        "<param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor></technique_common></source>"
        "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices><triangles count=\"1\"><input "
        "semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>"
        "<library_visual_scenes><visual_scene id=\"s\"><node id=\"n\"><instance_geometry url=\"#g\"/></node>%s</visual_scene>"
        "</library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>",
        asset, more, positions, nodes);
    assert_true(used > 0 && (size_t)used < sizeof text);
    put(FILE_OF("t.dae"), text);
}

static inline void put_dae(const char *asset, const char *positions, const char *more) {
    put_dae_with(asset, positions, more, *more ? "<node id=\"lamp\" name=\"lamp\"><instance_light url=\"#l\"/></node>" : "");
}

#endif
