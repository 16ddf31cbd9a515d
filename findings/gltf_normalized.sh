#!/bin/sh
# Texture coordinates of glTF as normalized unsigned shorts (core glTF 2.0, 3.6.2.2 and 3.7.2.1; no extension): 65535 is 1.
#
# Seen, a square with (0, 1) (1, 1) (1, 0) (0, 0), which every value of 0 and 65535 says exactly:
#   Assimp 5.2.5      one coordinate for all four corners, its u not a number
#   trimesh 5.2.0     u 0 and 65535, v 1 and 2: not divided, and 1 - v in 16 bits
# Neither says a word.
set -eu
T=$(mktemp -d); trap 'rm -rf "$T"' EXIT
cd "$T"
apt-get download -q assimp-utils=5.2.5~ds0-1+b1 libassimp5=5.2.5~ds0-1+b1 >/dev/null 2>&1 || { echo "assimp-utils is not to be had"; exit 77; }
for d in *.deb; do dpkg -x "$d" root; done
python3 -m venv v && v/bin/pip install -q numpy==2.4.6 pillow==12.0.0 trimesh==5.2.0 || exit 77
v/bin/python - <<'P'
import base64, json, struct
bin_ = struct.pack('<12f', 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0) + struct.pack('<8H', 0, 65535, 65535, 65535, 65535, 0, 0, 0) + struct.pack('<6H', 0, 1, 2, 0, 2, 3)
png = 'iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmMIQAAAABJRU5ErkJggg=='
views = [(0, 48), (48, 16), (64, 12)]
json.dump({
    'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0]}], 'nodes': [{'mesh': 0}],
    'meshes': [{'primitives': [{'attributes': {'POSITION': 0, 'TEXCOORD_0': 1}, 'indices': 2, 'material': 0}]}],
    'materials': [{'pbrMetallicRoughness': {'baseColorTexture': {'index': 0}}}], 'textures': [{'source': 0}],
    'images': [{'uri': 'data:image/png;base64,' + png}],
    'buffers': [{'byteLength': len(bin_), 'uri': 'data:application/octet-stream;base64,' + base64.b64encode(bin_).decode()}],
    'bufferViews': [{'buffer': 0, 'byteOffset': o, 'byteLength': n} for o, n in views],
    'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 4, 'type': 'VEC3', 'min': [0, 0, 0], 'max': [1, 1, 0]},
                  {'bufferView': 1, 'componentType': 5123, 'normalized': True, 'count': 4, 'type': 'VEC2'},
                  {'bufferView': 2, 'componentType': 5123, 'count': 6, 'type': 'SCALAR'}]}, open('quad.gltf', 'w'))
P
LD_LIBRARY_PATH=$(dirname "$(find root -name libassimp.so.5 | head -n 1)") root/usr/bin/assimp export quad.gltf quad.obj >/dev/null
echo "Assimp: $(grep -c '^vt' quad.obj) coordinate: $(grep '^vt' quad.obj)"
v/bin/python - <<'P'
import sys, trimesh
lines = [l.split()[1:3] for l in open('quad.obj') if l.startswith('vt')]
assimp = len(lines) == 1 and lines[0][0].strip('-') == 'nan'
uv = list(trimesh.load('quad.gltf').geometry.values())[0].visual.uv
print('trimesh:', uv.tolist())
same = assimp and uv.tolist() == [[0, 2], [65535, 2], [65535, 1], [0, 1]]
print('as described' if same else 'changed')
sys.exit(0 if same else 1)
P
