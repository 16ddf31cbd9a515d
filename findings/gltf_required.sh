#!/bin/sh
# "extensionsRequired" of glTF 2.0 (3.12): what it lists must be supported to load or render the file. And a skin without
# "inverseBindMatrices", which may be left out: they are 1 then (3.7.3.1).
#
# Seen:
#   a triangle that requires VENDOR_something: Assimp 5.2.5, trimesh 5.2.0 and tinygltf 2.7.0 load it, without a warning
#   two instances by EXT_mesh_gpu_instancing, which is required: trimesh has one, at the origin
#   a skin without the matrices: tinygltf returns true and sets an error text, "'inverseBindMatrices' property is missing in Skin."
set -eu
T=$(mktemp -d); trap 'rm -rf "$T"' EXIT
cd "$T"
apt-get download -q assimp-utils=5.2.5~ds0-1+b1 libassimp5=5.2.5~ds0-1+b1 libtinygltf-dev=2.7.0+dfsg-2 nlohmann-json3-dev=3.11.2-2 \
    >/dev/null 2>&1 || { echo "packages are not to be had"; exit 77; }
for d in *.deb; do dpkg -x "$d" root; done
python3 -m venv v && v/bin/pip install -q numpy==2.4.6 trimesh==5.2.0 || exit 77
v/bin/python - <<'P'
import base64, json, struct
def write(name, more, node={}, mesh={}, extra=b'', accessors=[]):
    bin_ = struct.pack('<9f', 0, 0, 0, 1, 0, 0, 0, 1, 0) + extra
    j = {'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0]}], 'nodes': [{'mesh': 0, **node}],
         'meshes': [{'primitives': [{'attributes': {'POSITION': 0, **mesh}}]}],
         'buffers': [{'byteLength': len(bin_), 'uri': 'data:application/octet-stream;base64,' + base64.b64encode(bin_).decode()}],
         'bufferViews': [{'buffer': 0, 'byteLength': 36}, {'buffer': 0, 'byteOffset': 36, 'byteLength': max(len(extra), 1)}],
         'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3', 'min': [0, 0, 0], 'max': [1, 1, 0]}] + accessors}
    if not extra:
        j['bufferViews'].pop()
    j.update(more)
    json.dump(j, open(name, 'w'))
write('unknown.gltf', {'extensionsUsed': ['VENDOR_something'], 'extensionsRequired': ['VENDOR_something']})
name = 'EXT_mesh_gpu_instancing'
write('instances.gltf', {'extensionsUsed': [name], 'extensionsRequired': [name]}, {'extensions': {name: {'attributes': {'TRANSLATION': 1}}}},
      {}, struct.pack('<6f', 0, 0, 0, 5, 0, 0), [{'bufferView': 1, 'componentType': 5126, 'count': 2, 'type': 'VEC3'}])
write('skin.gltf', {'skins': [{'joints': [1]}], 'nodes': [{'mesh': 0, 'skin': 0}, {'name': 'joint'}], 'scenes': [{'nodes': [0, 1]}]}, {},
      {'JOINTS_0': 1, 'WEIGHTS_0': 2}, bytes(12) + struct.pack('<12f', 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0),
      [{'bufferView': 1, 'componentType': 5121, 'count': 3, 'type': 'VEC4'},
       {'bufferView': 1, 'byteOffset': 12, 'componentType': 5126, 'count': 3, 'type': 'VEC4'}])
P
cat > t.cc <<'C'
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>
int main(int, char **v) {
    tinygltf::TinyGLTF loader;
    tinygltf::Model model;
    std::string error, warning;
    const bool ok = loader.LoadASCIIFromFile(&model, &error, &warning, v[1]);
    printf("%s, error '%s', warning '%s'\n", ok ? "true" : "false", error.substr(0, error.find('\n')).c_str(), warning.c_str());
}
C
g++ -w -Iroot/usr/include t.cc -o t
LIB=$(dirname "$(find root -name libassimp.so.5 | head -n 1)")
count() { LD_LIBRARY_PATH=$LIB root/usr/bin/assimp export "$1" o.obj >/dev/null 2>&1 && grep -c '^f' o.obj || echo refused; }
three() { v/bin/python -c "import sys, trimesh; print(len(trimesh.load(sys.argv[1]).to_geometry().faces))" "$1" 2>/dev/null || echo refused; }
said="unknown: $(count unknown.gltf) $(three unknown.gltf) triangle, tinygltf $(./t unknown.gltf)
instances: $(three instances.gltf)
skin: tinygltf $(./t skin.gltf)"
echo "$said"
want="unknown: 1 1 triangle, tinygltf true, error '', warning ''
instances: 1
skin: tinygltf true, error ''inverseBindMatrices' property is missing in Skin.', warning ''"
[ "$said" = "$want" ] && echo "as described" || { echo changed; exit 1; }
