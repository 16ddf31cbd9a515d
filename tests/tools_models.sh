#!/bin/sh
# One scene as many tools write it, each file baked and played, on one sheet beside Cycles' picture of the original:
#   tests/tools_models.sh [folder of the tools, default build/release] [folder for models and pictures, default build/tools_models]
# Blender writes glTF, FBX, COLLADA, OBJ, PLY and STL; Assimp (from COLLADA), trimesh, MeshLab and gltfpack turn these into others; lib3mf writes what
# 3MF has; OpenSCAD and FreeCAD have the scene as scripts of their own, in millimetres. To be looked at: all parts are there, upright, of one size, F
# and L not mirrored but for the right L, red, green and yellow where a format has colours, the pane a hole, the camera where the file's is. Needs the
# network, 3 GB, and the packages openscad, assimp-utils, gltfpack, freecad-python3, python3-collada. Exit 1 if a file is not baked and played.
# Wrong in the files themselves: Assimp 5.2's 3DS and 3MF (places lost, 3MF's colours black), X (one material for all) and FBX (which Assimp itself
# refuses); MeshLab's PLY and COLLADA (one texture for all), OBJ (the texture is lost; normals smoothed over edges); Blender's FBX of the lamp (no unit).
set -u
tools=$(cd "${1:-build/release}" && pwd) out=${2:-build/tools_models} failed=0 sheet=
mkdir -p "$out"
cd "$out" || exit 1
[ -x v/bin/python ] || { python3 -m venv v && v/bin/pip install -q bpy==4.2.0 numpy scipy trimesh==5.2.0 networkx lxml pycollada pymeshlab pillow lib3mf==2.5.0; } || exit 1
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
cat > consortium.py <<'P'
# The same scene through the 3MF Consortium's own library, in millimetres, z up: base materials, a colour group, a picture, components, a mirror.
import ctypes, lib3mf, numpy, trimesh
from lib3mf import get_wrapper
scene = trimesh.load('models/blender.glb')
w = get_wrapper()
model = w.CreateModel()
bases, colors = model.AddBaseMaterialGroup(), model.AddColorGroup()
picture = model.AddAttachment('/3D/Textures/sign.png', 'http://schemas.microsoft.com/3dmanufacturing/2013/01/3dtexture')
picture.ReadFromFile('models/sign.png')
image = model.AddTexture2DFromAttachment(picture)
image.SetContentType(lib3mf.TextureType.PNG)
coordinates = model.AddTexture2DGroup(image)
def srgb(c):
    return 12.92 * c if c < 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055
def properties(mesh, group, of):
    for i in range(mesh.GetTriangleCount()):
        p = lib3mf.TriangleProperties()
        p.ResourceID = group.GetUniqueResourceID()
        for k, value in enumerate(of(i)):
            p.PropertyIDs[k] = value
        mesh.SetTriangleProperties(i, p)
    mesh.SetObjectLevelProperty(group.GetUniqueResourceID(), of(0)[0])
def add(name, part):
    mesh = model.AddMeshObject()
    mesh.SetName(name)
    part.merge_vertices()
    for v in part.vertices:
        mesh.AddVertex(lib3mf.Position((ctypes.c_float * 3)(*[float(x) for x in v])))
    for f in part.faces:
        mesh.AddTriangle(lib3mf.Triangle((ctypes.c_uint32 * 3)(*[int(x) for x in f])))
    material = part.visual.material
    if material.baseColorTexture is not None:
        ids = [coordinates.AddTex2Coord(lib3mf.Tex2Coord(float(u), float(v))) for u, v in part.visual.uv]
        properties(mesh, coordinates, lambda i: [ids[v] for v in part.faces[i]])
        return mesh
    linear = [1, 1, 1, 1] if material.baseColorFactor is None else [x / 255 for x in material.baseColorFactor]
    color = w.FloatRGBAToColor(*[srgb(x) for x in linear[:3]], linear[3])
    if name in ('Red', 'Green'):
        one = colors.AddColor(color)
        properties(mesh, colors, lambda i: [one] * 3)
    else:
        mesh.SetObjectLevelProperty(bases.GetUniqueResourceID(), bases.AddMaterial(material.name, color))
    return mesh
def transform(m):
    t = lib3mf.Transform()
    for row in range(4):
        for k in range(3):
            t.Fields[row][k] = float(m[k][row])
    return t
stand = numpy.diag([1000.0, 1000.0, 1000.0, 1.0]) @ numpy.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]])
made, balls = {}, model.AddComponentsObject()
for node in scene.graph.nodes_geometry:
    place, geometry = scene.graph[node]
    if geometry not in made:
        made[geometry] = add(node, scene.geometry[geometry])
    if node.startswith('Ball'):
        balls.AddComponent(made[geometry], transform(place))
    else:
        model.AddBuildItem(made[geometry], transform(stand @ place))
model.AddBuildItem(balls, transform(stand))
model.QueryWriter('3mf').WriteToFile('models/lib3mf.3mf')
# Colours that run from corner to corner, of a cube.
model = w.CreateModel()
colors, mesh, cube = model.AddColorGroup(), model.AddMeshObject(), trimesh.creation.box((1000, 1000, 1000))
for v in cube.vertices:
    mesh.AddVertex(lib3mf.Position((ctypes.c_float * 3)(*[float(x) for x in v])))
    colors.AddColor(w.FloatRGBAToColor(*[float(x) / 1000 + 0.5 for x in v], 1))
for f in cube.faces:
    mesh.AddTriangle(lib3mf.Triangle((ctypes.c_uint32 * 3)(*[int(x) for x in f])))
ids = colors.GetAllPropertyIDs()
properties(mesh, colors, lambda i: [ids[v] for v in cube.faces[i]])
model.AddBuildItem(mesh, transform(numpy.eye(4)))
model.QueryWriter('3mf').WriteToFile('models/lib3mf_colours.3mf')
P
v/bin/python consortium.py
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
cat > freecad.py <<'P'
# FreeCAD without its window, in millimetres, z up, and without colours, which belong to the window.
import FreeCAD, Part, Mesh
from FreeCAD import Vector, Placement, Rotation
d = FreeCAD.newDocument()
def put(name, shape, place=(0, 0, 0), turn=(0, 0, 0)):
    o = d.addObject('Part::Feature', name)
    o.Shape, o.Placement = shape, Placement(Vector(*place), Rotation(*turn))
put('Ground', Part.makeBox(6000, 6000, 1, Vector(-3000, -3000, -1)))
put('Red', Part.makeBox(1000, 1000, 1000, Vector(-500, -500, 0)), (-1600, 0, 0), (23, 0, 0))
put('Green', Part.makeBox(800, 800, 2000, Vector(-400, -400, 0)), (1600, 600, 0))
outline = [(0, 0), (700, 0), (700, 250), (250, 250), (250, 1000), (0, 1000), (0, 0)]
def letter(sign):
    return Part.Face(Part.makePolygon([Vector(sign * x, 0, y) for x, y in outline])).extrude(Vector(0, -200, 0))
put('Left', letter(1), (-800, -1000, 0))
put('Right', letter(-1), (900, -1000, 0))
put('Sign', Part.makeBox(1600, 1, 1200, Vector(-800, 1400, 700)))
for i in range(3):
    put('Ball%d' % i, Part.makeSphere(200), (-600 + 600 * i, -300, 200))
d.recompute()
for kind in ('3mf', 'amf', 'x3d', 'obj', 'ply', 'stl'):
    Mesh.export(d.Objects, 'models/freecad.' + kind)
import importDAE
importDAE.export(d.Objects, 'models/freecad.dae')
P
freecadcmd -c "exec(open('freecad.py').read())" > freecad.log 2>&1 < /dev/null

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
row freecad.3mf ''
row freecad.amf 'up = "z";'
row freecad.x3d 'units = 0.001; up = "z";'
row freecad.obj 'units = 0.001; up = "z";'
row freecad.ply 'units = 0.001; up = "z";'
row freecad.stl 'units = 0.001; up = "z";'
row freecad.dae ''
row lib3mf.3mf ''
row lib3mf_colours.3mf '' 'keys = ( { eye = (1.6, 1.2, 2); target = (0, 0, 0); fov = 36; } );'
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
