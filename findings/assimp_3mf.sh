#!/bin/sh
# 3MF through Assimp 5.2.5 of Debian 12, whose libminizip is 1.1. A 3MF file is a ZIP archive; lib3mf, and so OpenSCAD, writes all of it in ZIP64,
# which APPNOTE 4.3.9.2 has for any size. Its default unit is the millimetre and its z is up (3MF core specification, 3.3 and 3.4).
#
# Seen:
#   the same model in a plain archive and in ZIP64: the first is read; of the second "A node of the scene-graph is nullptr"; Python reads both
#   unit="inch": the corner at 10 stays at 10, along z
#   written by Assimp: a colour of 0.8 0.4 0.2 becomes #000000ff, since each component is cut to a whole number before it is multiplied by 255
set -eu
T=$(mktemp -d); trap 'rm -rf "$T"' EXIT
cd "$T"
apt-get download -q assimp-utils=5.2.5~ds0-1+b1 libassimp5=5.2.5~ds0-1+b1 libminizip1=1.1-8+deb12u1 >/dev/null 2>&1 ||
    { echo "packages are not to be had"; exit 77; }
for d in *.deb; do dpkg -x "$d" root; done
python3 - <<'P'
import struct, zlib, zipfile
parts = {'[Content_Types].xml': '<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" '
         'ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>',
         '_rels/.rels': '<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship '
         'Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>',
         '3D/3dmodel.model': '<?xml version="1.0"?><model unit="inch" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources><object id="1" '
         'type="model"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="10" y="0" z="0"/><vertex x="0" y="0" z="10"/></vertices><triangles>'
         '<triangle v1="0" v2="1" v3="2"/></triangles></mesh></object></resources><build><item objectid="1"/></build></model>'}
def archive(name, wide):
    body, central = b'', b''
    for path, text in parts.items():
        path, data = path.encode(), text.encode()
        crc, n = zlib.crc32(data), len(data)
        extra = struct.pack('<HHQQ', 1, 16, n, n) if wide else b''
        more = struct.pack('<HHQQQ', 1, 24, n, n, len(body)) if wide else b''
        size, at = (0xffffffff, 0xffffffff) if wide else (n, len(body))
        version = 45 if wide else 20
        local = struct.pack('<IHHHHHIIIHH', 0x04034b50, version, 0, 0, 0, 0x21, crc, size, size, len(path), len(extra)) + path + extra + data
        central += struct.pack('<IHHHHHHIIIHHHHHII', 0x02014b50, version, version, 0, 0, 0, 0x21, crc, size, size, len(path), len(more), 0, 0, 0, 0, at) + path + more
        body += local
    end, count = len(body) + len(central), len(parts)
    tail = b''
    if wide:
        tail = struct.pack('<IQHHIIQQQQ', 0x06064b50, 44, 45, 45, 0, 0, count, count, len(central), len(body)) + struct.pack('<IIQI', 0x07064b50, 0, end, 1)
    tail += struct.pack('<IHHHHIIH', 0x06054b50, 0, 0, count, count, len(central), len(body), 0)
    open(name, 'wb').write(body + central + tail)
archive('plain.3mf', False)
archive('wide.3mf', True)
for name in ('plain.3mf', 'wide.3mf'):
    z = zipfile.ZipFile(name)
    assert z.testzip() is None and all(z.read(p) == t.encode() for p, t in parts.items())
P
LIB=$(dirname "$(find root -name libassimp.so.5 | head -n 1)")
assimp() { LD_LIBRARY_PATH=$LIB root/usr/bin/assimp "$@" 2>&1; }
printf 'newmtl m\nKd 0.8 0.4 0.2\n' > c.mtl
printf 'mtllib c.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n' > c.obj
assimp export c.obj c.3mf > /dev/null || true
color=$(python3 -c "import re, zipfile; z = zipfile.ZipFile('c.3mf'); print([c for n in z.namelist() for c in re.findall('displaycolor=\"([^\"]*)', z.read(n).decode())][-1])")
said="plain: $(assimp info plain.3mf | sed -n 's/^Maximum point *//p')
ZIP64: $(assimp info wide.3mf | sed -n 's/^ERROR: Failed to load file: //p')
0.8 0.4 0.2: $color"
echo "$said"
want="plain: (10.000000 0.000000 10.000000)
ZIP64: Validation failed: A node of the scene-graph is nullptr
0.8 0.4 0.2: #000000ff"
[ "$said" = "$want" ] && echo "as described" || { echo changed; exit 1; }
