#!/bin/sh
# COLLADA and X3D through Assimp 5.2.5 of Debian 12. XML collapses the white space round a number or a word of these types (XML Schema, 2, 4.3.6), so
# that meter=" 2" is 2 and <up_axis>Z_UP</up_axis> says the same with a line feed behind it. X3D 3.3 has units of lengths (7.2.5.1).
#
# Seen, each without a word, as the farthest corner of a triangle whose corners are 0 0 0, 1 0 0 and 0 0 1:
#   meter="2" is taken for 2, and so is "2 "; " 2" is taken for 1, as "two" is, which is no number; "0,5" is taken for 0.5
#   Z_UP turns the file; Z_UP with a line feed behind it does not
#   conversionFactor="0.001" of an X3D file's lengths changes nothing
set -eu
T=$(mktemp -d); trap 'rm -rf "$T"' EXIT
cd "$T"
apt-get download -q assimp-utils=5.2.5~ds0-1+b1 libassimp5=5.2.5~ds0-1+b1 libminizip1=1.1-8+deb12u1 >/dev/null 2>&1 ||
    { echo "packages are not to be had"; exit 77; }
for d in *.deb; do dpkg -x "$d" root; done
LIB=$(dirname "$(find root -name libassimp.so.5 | head -n 1)")
farthest() { LD_LIBRARY_PATH=$LIB root/usr/bin/assimp info "$1" 2>&1 | sed -n 's/^Maximum point *//p'; }
dae() { # meter, what stands behind Z_UP
    printf '<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit name="x" meter="%s"/>' "$1"
    printf '<up_axis>Z_UP%b</up_axis></asset><library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 0 1' "$2"
    printf '</float_array><technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>'
    printf '<param name="Z" type="float"/></accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>'
    printf '<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>'
    printf '<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>'
    printf '<scene><instance_visual_scene url="#s"/></scene></COLLADA>'
}
said=
for meter in 2 '2 ' ' 2' two 0,5; do
    dae "$meter" '' > t.dae
    said="$said[$meter] $(farthest t.dae)
"
done
dae 1 '\n' > t.dae
said="${said}line feed $(farthest t.dae)
"
cat > t.x3d <<'X'
<?xml version="1.0" encoding="UTF-8"?>
<X3D profile="Interchange" version="3.3"><head><unit category="length" name="millimetre" conversionFactor="0.001"/></head><Scene><Shape>
<IndexedFaceSet coordIndex="0 1 2 -1"><Coordinate point="0 0 0 1 0 0 0 0 1"/></IndexedFaceSet></Shape></Scene></X3D>
X
said="${said}X3D $(farthest t.x3d)"
echo "$said"
want="[2] (2.000000 2.000000 0.000000)
[2 ] (2.000000 2.000000 0.000000)
[ 2] (1.000000 1.000000 0.000000)
[two] (1.000000 1.000000 0.000000)
[0,5] (0.500000 0.500000 0.000000)
line feed (1.000000 0.000000 1.000000)
X3D (1.000000 0.000000 1.000000)"
[ "$said" = "$want" ] && echo "as described" || { echo changed; exit 1; }
