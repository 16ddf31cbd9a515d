#!/bin/sh
# Valid PLY files that come out wrong without a word. Each file is the unit square of two triangles; MeshLab, Assimp,
# trimesh and meshio read the plain one right.
#
# Seen:
#   Assimp 5.2.5              first byte of the data 0x0A (x = 0.01): no vertex is left; strips 0 1 3 -1 1 2 3: the second is lost; an element with
#                             a list between vertices and faces: not four vertices with two faces any more; colours 128 64 255 of type int: all
#                             three from 0.75 up
#   MeshLab 2025.7 (PyPI)     doubles in a big-endian file: not turned round, all of the square within 1e-300; an int `flags` of
#                             faces, 9 and 8: the face of 9 is gone (odd values mean deleted in its own memory)
#   trimesh 5.2.0             colours 32768 16384 65535 of type ushort: 0 0 255
#   meshio 5.3.5              binary, faces before vertices: coordinates near 1e-40
set -eu
T=$(mktemp -d); trap 'rm -rf "$T"' EXIT
cd "$T"
apt-get download -q assimp-utils=5.2.5~ds0-1+b1 libassimp5=5.2.5~ds0-1+b1 >/dev/null 2>&1 || { echo "assimp-utils is not to be had"; exit 77; }
for d in *.deb; do dpkg -x "$d" root; done
python3 -m venv v && v/bin/pip install -q numpy==2.4.6 trimesh==5.2.0 meshio==5.3.5 pymeshlab==2025.7.post1 || exit 77
LIBS=$(dirname "$(find root -name libassimp.so.5 | head -n 1)")
export LIBS
v/bin/python - <<'P'
import os, struct, subprocess, sys
import meshio, pymeshlab, trimesh
V, F = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)]
xyz = 'property float x\nproperty float y\nproperty float z\n'
vertex, face = 'element vertex 4\n', 'element face 2\n'
indices = 'property list uchar int vertex_indices\n'
def rows(form, values): return b''.join(struct.pack(form, *v) for v in values)
def put(name, order, elements, data):
    head = 'ply\nformat binary_%s_endian 1.0\n%send_header\n' % (order, elements)
    open(name + '.ply', 'wb').write(head.encode() + data)
corners = [(3, *f) for f in F]
points, triangles = rows('<3f', V), rows('<B3i', corners)
put('plain', 'little', vertex + xyz + face + indices, points + triangles)
put('first', 'little', vertex + xyz + face + indices, b'\x0a\xd7\x23\x3c' + points[4:] + triangles)
put('strips', 'little', vertex + xyz + 'element tristrips 1\nproperty list int int vertex_indices\n', points + struct.pack('<8i', 7, 0, 1, 3, -1, 1, 2, 3))
put('between', 'little', vertex + xyz + 'element other 2\nproperty list uchar double a\n' + face + indices,
    points + struct.pack('<BdB', 1, 2.5, 0) + triangles)
rgb = 'property %s red\nproperty %s green\nproperty %s blue\n'
put('ints', 'little', vertex + xyz + rgb % (('int',) * 3) + face + indices, rows('<3f3i', [(*v, 128, 64, 255) for v in V]) + triangles)
put('ushorts', 'little', vertex + xyz + rgb % (('ushort',) * 3) + face + indices, rows('<3f3H', [(*v, 32768, 16384, 65535) for v in V]) + triangles)
put('doubles', 'big', vertex + xyz.replace('float', 'double') + face + indices, rows('>3d', V) + rows('>B3i', corners))
put('flags', 'little', vertex + xyz + face + indices + 'property int flags\n', points + rows('<B4i', [(*corners[0], 9), (*corners[1], 8)]))
put('order', 'little', face + indices + vertex + xyz, triangles + points)

def assimp(name):
    """Vertices, faces, colour of the first vertex."""
    subprocess.run(['root/usr/bin/assimp', 'export', name + '.ply', 'a.obj'], check=True, stdout=subprocess.DEVNULL,
                   env=dict(os.environ, LD_LIBRARY_PATH=os.environ['LIBS']))
    lines = [l.split() for l in open('a.obj')]
    v = [[float(x) for x in l[1:]] for l in lines if l[:1] == ['v']]
    return len(v), sum(l[:1] == ['f'] for l in lines), v[0][3:] if v else []
def meshlab(name):
    """Faces, largest coordinate."""
    s = pymeshlab.MeshSet()
    s.load_new_mesh(name + '.ply')
    return s.current_mesh().face_number(), float(s.current_mesh().vertex_matrix().max())
def tri(name):
    m = trimesh.load(name + '.ply', process=False)
    return m.bounds.tolist(), len(m.faces), [int(c) for c in m.visual.vertex_colors[0]][:3]
def mio(name):
    m = meshio.read(name + '.ply')
    return len(m.points), float(abs(m.points).max())

seen = []
def show(what, value, as_described):
    print('%-28s %s' % (what, value))
    seen.append(as_described)
a = assimp('plain'); show('Assimp, plain', a, a[:2] == (4, 2))
m = meshlab('plain'); show('MeshLab, plain', m, m == (2, 1.0))
t = tri('plain'); show('trimesh, plain', t, t[:2] == ([[0, 0, 0], [1, 1, 0]], 2))
o = mio('plain'); show('meshio, plain', o, o == (4, 1.0))
a = assimp('first'); show('Assimp, first byte 0x0A', a, a[0] == 0)
a = assimp('strips'); show('Assimp, strips', a, a[1] == 1)
a = assimp('between'); show('Assimp, element between', a, a[:2] != (4, 2))
a = assimp('ints'); show('Assimp, int colours', a, min(a[2]) > 0.74)
m = meshlab('doubles'); show('MeshLab, big-endian doubles', m, m[1] < 1e-300)
m = meshlab('flags'); show('MeshLab, flags of faces', m, m[0] == 1)
t = tri('ushorts'); show('trimesh, ushort colours', t[2], t[2] == [0, 0, 255])
o = mio('order'); show('meshio, faces first', o, o[0] == 4 and o[1] < 1e-30)
print('as described' if all(seen) else 'changed')
sys.exit(0 if all(seen) else 1)
P
