#!/bin/sh
# Numbers in OBJ. Wavefront's format says no more than that they are decimal; ".5" is one in every language that writes such files.
#
# Seen, 29997 coordinates as exporters write them (six digits behind the point, up to 20 m), against the nearest floats:
#   Assimp 5.2.5                1048 are another float
#   tinyobjloader 2.0.0rc10     all are right
# and three vertices of which the third is "2 .5 0":
#   Assimp                      leaves out the line, so that the face has the next vertex instead, without a warning
#   tinyobjloader               has it
# and two triangles "o a", "o b" with a third behind a second "o a", all of one material:
#   Assimp                      puts the third into b
set -eu
T=$(mktemp -d); trap 'rm -rf "$T"' EXIT
cd "$T"
apt-get download -q libassimp-dev=5.2.5~ds0-1+b1 libassimp5=5.2.5~ds0-1+b1 libtinyobjloader-dev=2.0.0~rc10+dfsg-2+b1 \
    libtinyobjloader2rc10=2.0.0~rc10+dfsg-2+b1 >/dev/null 2>&1 || { echo "packages are not to be had"; exit 77; }
for d in *.deb; do dpkg -x "$d" root; done
python3 - <<'P' > many.obj
import random
random.seed(1)
for i in range(9999):
    print('v', *('%.6f' % random.uniform(-20, 20) for k in range(3)))
for i in range(1, 9999, 3):
    print('f', i, i + 1, i + 2)
P
printf 'v 0 0 0\nv 1 0 0\nv 2 .5 0\nv 7 7 7\nf 1 2 3\n' > dot.obj
printf 'newmtl m\nKd 1 1 1\n' > m.mtl
printf 'mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\no a\nusemtl m\nf 1 2 3\no b\nusemtl m\nf 1 3 2\no a\nusemtl m\nf 2 3 1\n' > twice.obj
cat > a.c <<'C'
#include <assimp/cimport.h>
#include <assimp/scene.h>
#include <stdio.h>
#include <string.h>
static void node(const struct aiScene *s, const struct aiNode *n) {
    for (unsigned i = 0; i < n->mNumMeshes; i++)
        printf("%s %u\n", n->mName.data, s->mMeshes[n->mMeshes[i]]->mNumFaces);
    for (unsigned i = 0; i < n->mNumChildren; i++)
        node(s, n->mChildren[i]);
}
int main(int c, char **v) {
    const struct aiScene *s = aiImportFile(v[1], 0);
    if (!s)
        return puts("refused"), 0;
    if (c > 2)
        return node(s, s->mRootNode), 0;
    for (unsigned i = 0; i < s->mMeshes[0]->mNumVertices; i++)
        printf("%a %a %a\n", s->mMeshes[0]->mVertices[i].x, s->mMeshes[0]->mVertices[i].y, s->mMeshes[0]->mVertices[i].z);
}
C
cat > t.cc <<'C'
#include <cstdio>
#include <tiny_obj_loader.h>
int main(int, char **v) {
    tinyobj::attrib_t a;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::string warning, error;
    tinyobj::LoadObj(&a, &shapes, &materials, &warning, &error, v[1]);
    for (const auto &i : shapes[0].mesh.indices)
        printf("%a %a %a\n", a.vertices[3 * i.vertex_index], a.vertices[3 * i.vertex_index + 1], a.vertices[3 * i.vertex_index + 2]);
}
C
L=$(dirname "$(find root -name libassimp.so.5 | head -n 1)")
gcc -w -Iroot/usr/include a.c "$L/libassimp.so.5" -Wl,--allow-shlib-undefined -o a
g++ -w -Iroot/usr/include t.cc "$(find root -name 'libtinyobjloader.so.*' | head -n 1)" -o t
export LD_LIBRARY_PATH="$L"
./a many.obj > assimp.txt; ./t many.obj > tiny.txt
python3 - <<'P' > said
import struct
right = lambda text: struct.unpack('f', struct.pack('f', float(text)))[0]
want = [right(x) for line in open('many.obj') if line[0] == 'v' for x in line.split()[1:]]
for name in 'assimp', 'tiny':
    got = [float.fromhex(x) for x in open(name + '.txt').read().split()]
    print(name, len(got), 'numbers,', sum(a != b for a, b in zip(got, want)), 'wrong')
P
echo "dot: assimp $(./a dot.obj | tail -n 1), tiny $(./t dot.obj | tail -n 1)" >> said
echo "twice:" $(./a twice.obj nodes) >> said
cat said
cat > want <<'W'
assimp 29997 numbers, 1048 wrong
tiny 29997 numbers, 0 wrong
dot: assimp 0x1.cp+2 0x1.cp+2 0x1.cp+2, tiny 0x1p+1 0x1p-1 0x0p+0
twice: a 1 b 2
W
cmp -s said want && echo "as described" || { echo changed; exit 1; }
