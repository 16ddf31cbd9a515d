#!/bin/sh
# Headers of Radiance pictures that change what the numbers mean. Radiance divides by every EXPOSURE line; 32-bit_rle_xyze holds CIE XYZ.
#
# Seen, four texels that say 1 in each channel:
#   EXPOSURE=4 (0.25 is right)   stb_image, OpenCV 5.0.0.93, OpenImageIO 3.2.2.0, Mitsuba 3.9.1: 1
#   FORMAT=32-bit_rle_xyze       stb_image, OpenCV, OpenImageIO refuse it; Mitsuba gives (1, 1, 1), which is white in neither meaning
#                                ((1, 1, 1) in XYZ is about (1.20, 0.95, 0.91) in linear sRGB)
set -eu
T=$(mktemp -d); trap 'rm -rf "$T"' EXIT
cd "$T"
apt-get download -q libstb0=0.0~git20220908.8b5f1f3+ds-1 >/dev/null 2>&1 || { echo "libstb0 is not to be had"; exit 77; }
dpkg -x libstb0*.deb root
python3 -m venv v && v/bin/pip install -q numpy==2.4.6 opencv-python-headless==5.0.0.93 OpenImageIO==3.2.2.0 mitsuba==3.9.1 || exit 77
STB=$(find root -name 'libstb.so*' | head -n 1)
export STB
v/bin/python - <<'P'
import ctypes, os, sys
import cv2, mitsuba, numpy as np, OpenImageIO
mitsuba.set_variant('scalar_rgb')
texels = bytes([128, 128, 128, 129]) * 4
open('exposure.hdr', 'wb').write(b'#?RADIANCE\nEXPOSURE=4\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 4\n' + texels)
open('xyz.hdr', 'wb').write(b'#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 4\n' + texels)
lib = ctypes.CDLL(os.path.abspath(os.environ['STB']))
lib.stbi_loadf.restype = ctypes.POINTER(ctypes.c_float)
def stb(path):
    w, h, n = ctypes.c_int(), ctypes.c_int(), ctypes.c_int()
    data = lib.stbi_loadf(path.encode(), ctypes.byref(w), ctypes.byref(h), ctypes.byref(n), 3)
    return [data[0], data[1], data[2]] if data else None
def opencv(path):
    a = cv2.imread(path, cv2.IMREAD_UNCHANGED)
    return None if a is None else a[0, 0].tolist()
def oiio(path):
    i = OpenImageIO.ImageInput.open(path)
    return i.read_image('float')[0, 0].tolist() if i else None
def mi(path):
    try:
        return np.array(mitsuba.Bitmap(path))[0, 0].tolist()
    except RuntimeError:
        return None
same = True
for read in (stb, opencv, oiio, mi):
    exposure, xyz = read('exposure.hdr'), read('xyz.hdr')
    print(read.__name__, 'EXPOSURE=4:', exposure, ' XYZ:', xyz)
    same &= exposure == [1, 1, 1] and xyz == ([1, 1, 1] if read is mi else None)
print('as described' if same else 'changed')
sys.exit(0 if same else 1)
P
