#!/bin/sh
# Normals of FBX files through Assimp 5.2.5 of Debian 12. A layer's values stand by corner of polygons ("ByPolygonVertex") or by vertex ("ByVertice"),
# one after another ("Direct") or by index. Blender 4.2 writes those of meshes that are smooth everywhere by vertex, and all by index.
#
# Seen, of two triangles that share an edge (4 vertices, 6 corners), as lists of normals in what "assimp dump" says of it:
#   by corner, and by vertex without an index: there
#   by vertex with an index: none, since it takes as many indices as there are corners for right; it says so in its log alone
set -eu
T=$(mktemp -d); trap 'rm -rf "$T"' EXIT
cd "$T"
apt-get download -q assimp-utils=5.2.5~ds0-1+b1 libassimp5=5.2.5~ds0-1+b1 libminizip1=1.1-8+deb12u1 >/dev/null 2>&1 ||
    { echo "packages are not to be had"; exit 77; }
for d in *.deb; do dpkg -x "$d" root; done
LIB=$(dirname "$(find root -name libassimp.so.5 | head -n 1)")
python3 - <<'P'
def fbx(mapping, reference):
    count = 6 if mapping == 'ByPolygonVertex' else 4
    values = ['0,0,1'] if reference == 'IndexToDirect' else ['0,0,1'] * count
    index = f'\t\t\tNormalsIndex: *{count} {{\n\t\t\t\ta: {",".join(["0"] * count)}\n\t\t\t}}\n' if reference == 'IndexToDirect' else ''
    return ('; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n\tFBXHeaderVersion: 1003\n\tFBXVersion: 7400\n}\n'
            'Definitions:  {\n\tVersion: 100\n\tCount: 2\n}\nObjects:  {\n\tGeometry: 100, "Geometry::g", "Mesh" {\n'
            '\t\tVertices: *12 {\n\t\t\ta: 0,0,0,1,0,0,1,1,0,0,1,0\n\t\t}\n\t\tPolygonVertexIndex: *6 {\n\t\t\ta: 0,1,-3,0,2,-4\n\t\t}\n'
            '\t\tGeometryVersion: 124\n\t\tLayerElementNormal: 0 {\n\t\t\tVersion: 101\n\t\t\tName: ""\n'
            f'\t\t\tMappingInformationType: "{mapping}"\n\t\t\tReferenceInformationType: "{reference}"\n'
            f'\t\t\tNormals: *{3 * len(values)} {{\n\t\t\t\ta: {",".join(values)}\n\t\t\t}}\n{index}\t\t}}\n'
            '\t\tLayer: 0 {\n\t\t\tVersion: 100\n\t\t\tLayerElement:  {\n\t\t\t\tType: "LayerElementNormal"\n\t\t\t\tTypedIndex: 0\n\t\t\t}\n\t\t}\n\t}\n'
            '\tModel: 200, "Model::m", "Mesh" {\n\t\tVersion: 232\n\t\tProperties70:  {\n\t\t}\n\t}\n}\n'
            'Connections:  {\n\tC: "OO",200,0\n\tC: "OO",100,200\n}\n')
for mapping in ('ByPolygonVertex', 'ByVertice'):
    for reference in ('Direct', 'IndexToDirect'):
        open(f'{mapping}_{reference}.fbx', 'w').write(fbx(mapping, reference))
P
said=
for f in ByPolygonVertex_Direct ByPolygonVertex_IndexToDirect ByVertice_Direct ByVertice_IndexToDirect; do
    LD_LIBRARY_PATH=$LIB root/usr/bin/assimp dump $f.fbx $f.assxml > log 2>&1 || { cat log; exit 1; }
    said="$said$f $(grep -c '<Normals' $f.assxml || true)
"
done
said=${said%?}
echo "$said"
want="ByPolygonVertex_Direct 1
ByPolygonVertex_IndexToDirect 1
ByVertice_Direct 1
ByVertice_IndexToDirect 0"
[ "$said" = "$want" ] && echo "as described" || { echo changed; exit 1; }
