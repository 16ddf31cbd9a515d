#!/bin/sh
# Shadows of what is cut out, by Mitsuba 3.9.1's integrators: a point light over a matt floor, and between them a sheet whose `mask` has opacity 0
# everywhere, or 1/2. Seen, mean of the floor without a sheet, with it, with half of it; and with a sheet of holes before the camera instead:
#   direct: 0.106, 0, 0; 0        path: 0.106, 0, 0; 0.106        volpath: 0.106, 0.106, 0.053; 0.106
# `path` looks through holes but takes them as opaque for the rays that it sends to lights; so leaves and chains cast the shadows of their cards, and a
# scene with point lights alone loses that light for good. Right is what `volpath` shows.
set -eu
T=$(mktemp -d); trap 'rm -rf "$T"' EXIT
cd "$T"
python3 -m venv v && v/bin/pip install -q numpy==2.4.6 mitsuba==3.9.1 || exit 77
v/bin/python - <<'P'
import sys
import mitsuba as mi, numpy as np
mi.set_variant('scalar_rgb')
T = mi.ScalarTransform4f
def grey(value):
    return {'type': 'diffuse', 'reflectance': {'type': 'rgb', 'value': value}}
def floor(integrator, opacity, seen_through=False):
    scene = {'type': 'scene', 'integrator': {'type': integrator},
             'sensor': {'type': 'perspective', 'fov': 20, 'to_world': T().look_at([0, 1, 3], [0, 0, 0], [0, 1, 0]),
                        'film': {'type': 'hdrfilm', 'width': 8, 'height': 8, 'rfilter': {'type': 'box'}},
                        'sampler': {'type': 'independent', 'sample_count': 64}},
             'floor': {'type': 'rectangle', 'to_world': T().rotate([1, 0, 0], -90).scale(2), 'bsdf': grey(0.5)},
             'lamp': {'type': 'point', 'position': [0, 2, 0], 'intensity': {'type': 'rgb', 'value': 4}}}
    if opacity is not None:
        place = T().translate([0, 0.5, 1.5]).rotate([1, 0, 0], -20).scale(0.4) if seen_through else T().translate([0, 1.5, 0]).rotate([1, 0, 0], -90).scale(0.8)
        scene['sheet'] = {'type': 'rectangle', 'to_world': place, 'bsdf': {'type': 'mask', 'opacity': opacity, 'nested': grey(0.0)}}
    return float(np.array(mi.render(mi.load_dict(scene), seed=1)).mean())
same = True
for integrator in ('direct', 'path', 'volpath'):
    bare, holes, half, seen = floor(integrator, None), floor(integrator, 0.0), floor(integrator, 0.5), floor(integrator, 0.0, True)
    print(f'{integrator}: no sheet {bare:.3f}, all holes {holes:.3f}, half {half:.3f}; seen through all holes {seen:.3f}')
    same &= bare > 0.1 and (seen == 0 if integrator == 'direct' else abs(seen / bare - 1) < 0.02)
    if integrator == 'volpath':
        same &= abs(holes / bare - 1) < 0.02 and abs(half / bare - 0.5) < 0.02
    else:
        same &= holes == 0 and half == 0
print('as described' if same else 'changed')
sys.exit(0 if same else 1)
P
