#!/bin/sh
# One scene as many tools write it, each file baked and played, on one sheet beside Cycles' picture of the original:
#   tests/tools_models.sh [folder of the tools, default build/release] [folder for models and pictures, default build/tools_models]
# Blender writes glTF, FBX, COLLADA, OBJ, PLY and STL; Assimp (from COLLADA), trimesh, MeshLab and gltfpack turn these into others; OpenSCAD has the scene as a
# script of its own, in millimetres. To be looked at: all parts are there, upright, of one size, F and L not mirrored but for the right L, red,
# green and yellow where a format has colours, the pane a hole, the camera where the file's is. Needs the network, 3 GB, and the packages openscad,
# assimp-utils, gltfpack. Exit 1 if a file is not baked and played.
# Wrong in the files themselves: Assimp 5.2's 3DS and 3MF (places lost, 3MF's colours black), X (one material for all) and FBX (which Assimp itself
# refuses); MeshLab's PLY and COLLADA (one texture for all), OBJ (the texture is lost; normals smoothed over edges); Blender's FBX of the lamp (no unit).
# OpenSCAD's 3MF is an archive in ZIP64, which Debian 12's libminizip does not read.
set -u
tools=$(cd "${1:-build/release}" && pwd) out=${2:-build/tools_models} failed=0 sheet=
mkdir -p "$out"
cd "$out" || exit 1
[ -x v/bin/python ] || { python3 -m venv v && v/bin/pip install -q bpy==4.2.0 numpy scipy trimesh==5.2.0 networkx lxml pycollada pymeshlab pillow; } || exit 1
rm -rf models pictures && mkdir models pictures

cat > scene.py <<'P'
import bpy, math, mathutils, os
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
picture = bpy.data.images.new('sign', 16, 16)
F = {(x, y) for x in (5, 6) for y in range(3, 13)} | {(x, y) for x in range(5, 12) for y in (11, 12)} | {(x, y) for x in range(5, 10) for y in (7, 8)}
picture.pixels = [c for y in range(16) for x in range(16) for c in ((0.1, 0.1, 0.9, 1) if (x, y) in F else (1, 0.6, 0.1, 1))]
picture.filepath_raw = 'models/sign.png'
picture.file_format = 'PNG'
picture.save()
def material(name, color, alpha=1, image=None):
    m = bpy.data.materials.new(name)
    m.use_nodes = True
    p = m.node_tree.nodes['Principled BSDF']
    p.inputs['Base Color'].default_value = (*color, 1)
    p.inputs['Roughness'].default_value = 1
    p.inputs['Specular IOR Level'].default_value = 0
    p.inputs['Alpha'].default_value = alpha
    m.diffuse_color = (*color, alpha)
    if alpha < 1:
        m.blend_method = 'BLEND'
    if image:
        t = m.node_tree.nodes.new('ShaderNodeTexImage')
        t.image = image
        t.interpolation = 'Closest'
        m.node_tree.links.new(t.outputs['Color'], p.inputs['Base Color'])
    return m
def put(name, data, place, scale=(1, 1, 1), turn=(0, 0, 0)):
    o = bpy.data.objects.new(name, data)
    o.location, o.scale, o.rotation_euler = place, scale, turn
    scene.collection.objects.link(o)
    return o
def mesh(name, points, faces, m, smooth=False):
    d = bpy.data.meshes.new(name)
    d.from_pydata(points, [], faces)
    d.materials.append(m)
    d.polygons.foreach_set('use_smooth', [smooth] * len(d.polygons))
    return d
def prism(name, outline, height, m):
    n = len(outline)
    return mesh(name, [(x, y, z) for z in (0, height) for x, y in outline],
                [list(range(n))[::-1], list(range(n, 2 * n))] + [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)], m)
square = [(-.5, -.5), (.5, -.5), (.5, .5), (-.5, .5)]
put('Ground', mesh('ground', [(x * 4, y * 4, 0) for x, y in square] + [], [(0, 1, 2, 3)], material('grey', (.6, .6, .6))), (0, 0, 0), (1.5, 1.5, 1))
put('Red', prism('red', square, 1, material('red', (.8, .05, .05))), (-1.6, 0, 0), turn=(0, 0, .4))
put('Green', prism('green', square, 2, material('green', (.05, .6, .1))), (1.6, .6, 0), (.8, .8, 1))
L = prism('L', [(0, 0), (.7, 0), (.7, .25), (.25, .25), (.25, 1), (0, 1)], .2, material('yellow', (.9, .8, .05)))
put('Left', L, (-.8, -1, 0), turn=(math.pi / 2, 0, 0))
put('Right', L, (.9, -1, 0), (-1, 1, 1), (math.pi / 2, 0, 0))
sign = mesh('sign', [(-.8, 0, -.6), (.8, 0, -.6), (.8, 0, .6), (-.8, 0, .6)], [(0, 1, 2, 3)], material('sign', (.8, .8, .8), 1, picture))
for i, uv in enumerate(((0, 0), (1, 0), (1, 1), (0, 1))):
    (sign.uv_layers.active or sign.uv_layers.new(name='uv')).data[i].uv = uv
put('Sign', sign, (0, 1.4, 1.3))
put('Pane', mesh('pane', [(-.4, 0, 0), (.4, 0, 0), (.4, 0, 1), (-.4, 0, 1)], [(0, 1, 2, 3)], material('cyan', (.1, .8, .8), .3)), (1.7, -1, 0))
def ball(n=16):
    p = [(math.sin(b) * math.cos(a), math.sin(b) * math.sin(a), math.cos(b)) for b in [math.pi * (j + .5) / n for j in range(n)]
         for a in [2 * math.pi * i / n for i in range(n)]]
    return mesh('ball', p, [(j * n + i, (j + 1) * n + i, (j + 1) * n + (i + 1) % n, j * n + (i + 1) % n) for j in range(n - 1) for i in range(n)],
                material('white', (.8, .8, .8)), True)
b = ball()
for i in range(3):
    put('Ball%d' % i, b, (-.6 + .6 * i, -.3, .2), (.2, .2, .2))
eye, target = mathutils.Vector((.6, -6, 2.4)), mathutils.Vector((0, 0, .8))
camera = bpy.data.cameras.new('Cam')
camera.sensor_fit, camera.angle = 'HORIZONTAL', 2 * math.atan(math.tan(math.radians(18)) * 4 / 3)
scene.camera = put('Cam', camera, eye, turn=(target - eye).to_track_quat('-Z', 'Y').to_euler())
lamp = bpy.data.lights.new('Lamp', 'POINT')
lamp.energy, lamp.shadow_soft_size = 500, 0
put('Lamp', lamp, (-2, -3, 4))
scene.world = bpy.data.worlds.new('w')
scene.world.use_nodes = True
scene.world.node_tree.nodes['Background'].inputs['Color'].default_value = (.3, .3, .3, 1)
scene.render.engine, scene.cycles.samples, scene.cycles.device = 'CYCLES', 48, 'CPU'
scene.cycles.use_denoising = False
scene.render.resolution_x, scene.render.resolution_y = 320, 240
scene.view_settings.view_transform = 'Standard'
scene.render.filepath = os.path.abspath('pictures/cycles.png')
bpy.ops.render.render(write_still=True)
bpy.ops.export_scene.gltf(filepath='models/blender.glb', export_cameras=True, export_lights=True)
bpy.ops.export_scene.fbx(filepath='models/blender.fbx', path_mode='COPY', embed_textures=True)
bpy.ops.export_scene.fbx(filepath='models/blender_z.fbx', axis_forward='Y', axis_up='Z', apply_scale_options='FBX_SCALE_UNITS', path_mode='COPY', embed_textures=True)
bpy.ops.wm.collada_export(filepath='models/blender.dae')
bpy.ops.wm.obj_export(filepath='models/blender.obj')
bpy.ops.wm.ply_export(filepath='models/blender.ply')
bpy.ops.wm.stl_export(filepath='models/blender.stl')
os._exit(0) # bpy's own way out crashes on some machines
P
v/bin/python scene.py > scene.log 2>&1 || { tail -n 5 scene.log; exit 1; }
cat > others.py <<'P'
import os, trimesh, pymeshlab
scene = trimesh.load('models/blender.glb')
scene.export('models/trimesh.glb')
for kind in ('3mf', 'dae', 'ply', 'stl'):
    (scene if kind == '3mf' else scene.to_geometry()).export('models/trimesh.' + kind)
m = pymeshlab.MeshSet()
m.load_new_mesh('models/blender.obj')
for kind in ('ply', 'dae', 'obj', 'x3d', '3ds'):
    try:
        m.save_current_mesh('models/meshlab.' + kind)
    except Exception as e:
        print(kind, str(e).split('\n')[0])
P
v/bin/python others.py
for kind in dae 3ds fbx stl obj x 3mf; do assimp export models/blender.dae "models/assimp.$kind" > /dev/null 2>&1; done
gltfpack -i models/blender.glb -o models/gltfpack.glb -cc -kn -ke > /dev/null
cat > scene.scad <<'P'
$fn = 32;
color([.6, .6, .6]) translate([-3000, -3000, -1]) cube([6000, 6000, 1]);
color([.8, .05, .05]) translate([-1600, 0, 0]) rotate(23) translate([-500, -500, 0]) cube(1000);
color([.05, .6, .1]) translate([1600, 600, 0]) translate([-400, -400, 0]) cube([800, 800, 2000]);
module L() rotate([90, 0, 0]) linear_extrude(200) polygon([[0, 0], [700, 0], [700, 250], [250, 250], [250, 1000], [0, 1000]]);
color([.9, .8, .05]) { translate([-800, -1000, 0]) L(); translate([900, -1000, 0]) mirror([1, 0, 0]) L(); }
color([.8, .8, .8]) { translate([-800, 1400, 700]) cube([1600, 1, 1200]); for (i = [0:2]) translate([-600 + 600 * i, -300, 200]) sphere(200); }
P
for kind in 3mf amf stl; do openscad -q -o models/openscad.$kind scene.scad 2> /dev/null; done

by_keys='keys = ( { eye = (0.6, 2.4, 6); target = (0, 0.8, 0); fov = 36; } );'
lamp='{ type = "point"; keys = ( { position = (-2, 4, 3); power = (160, 160, 160); } ); }'
row() { # file, settings of the mesh, camera, light
    [ -s "models/$1" ] || { echo "$1: not made"; return; }
    cat > "models/$1.cfg" <<C
output: { width = 320; height = 240; frames = 1; };
background = (0.3, 0.3, 0.3);
sky: { light = true; };
meshes = ( { file = "$1"; $2 } );
camera: { ${3:-$by_keys} };
lights = ( ${4:-$lamp} );
C
    echo "== $1"
    if "$tools/vitrine-bake" "models/$1.cfg" -o "models/$1.vit" --no-check --device host --indirect photons --photons 4000 > "pictures/$1.log" 2>&1 &&
        "$tools/vitrine-play" "models/$1.vit" --quiet --device host --frames 0 --out "png:pictures/$1" > /dev/null; then
        sheet="$sheet $1"
    else
        failed=1
        tail -n 1 "pictures/$1.log"
    fi
    grep -h 'warning\|1 unit is\|without a unit' "pictures/$1.log" | cut -c1-200
    [ -z "${3:-}" ] || "$tools/vitrine-bake" "models/$1" --list | grep -A1 '^lights\|^cameras'
}
cam='use = "Cam";'
row blender.glb '' "$cam" '{ use = "Lamp"; }'
row blender.fbx '' "$cam"
row blender_z.fbx '' "$cam"
row blender.dae '' "$cam"
row blender.obj ''
row blender.ply 'up = "z";'
row blender.stl 'up = "z";'
row assimp.dae ''
row assimp.3ds 'up = "y";'
row assimp.fbx ''
row assimp.stl ''
row assimp.obj ''
row assimp.x ''
row assimp.3mf 'units = 1; up = "y";'
row trimesh.glb ''
row trimesh.3mf 'units = 1; up = "y";'
row trimesh.dae ''
row trimesh.ply ''
row trimesh.stl ''
row meshlab.ply ''
row meshlab.dae ''
row meshlab.obj ''
row meshlab.x3d ''
row meshlab.3ds 'up = "y";'
row gltfpack.glb '' "$cam" '{ use = "Lamp"; }'
row openscad.3mf ''
row openscad.amf 'up = "z";'
row openscad.stl 'units = 0.001; up = "z";'
v/bin/python - $sheet <<'P'
import sys
from PIL import Image, ImageDraw
names = ['cycles'] + sys.argv[1:]
across = 6
sheet = Image.new('RGB', (across * 324, (len(names) + across - 1) // across * 260), 'white')
for i, name in enumerate(names):
    x, y = i % across * 324, i // across * 260
    sheet.paste(Image.open('pictures/cycles.png' if name == 'cycles' else 'pictures/%s/frame_00000.png' % name).convert('RGB'), (x, y + 16))
    ImageDraw.Draw(sheet).text((x + 2, y + 2), name, 'black')
sheet.save('sheet.png')
P
exit $failed
