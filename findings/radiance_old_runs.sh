#!/bin/sh
# A Radiance picture with run lengths of the old kind, which the format allows in any row: a texel (1, 1, 1, n) means n more of the texel before.
#
# The picture: ten texels of radiance (1, 0.5, 0.25), stored as one texel and a run of nine. Seen:
#   stb_image (libstb0 0.0~git20220908.8b5f1f3+ds-1): says that all went well; one texel right, nine of 5.9e-39
#   OpenCV 5.0.0.93, OpenImageIO 3.2.2.0, Mitsuba 3.9.1: refuse it
# The same picture without runs is read alike by all four.
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
head = b'#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 10\n'
texel = bytes([128, 64, 32, 129])
open('plain.hdr', 'wb').write(head + texel * 10)
open('runs.hdr', 'wb').write(head + texel + bytes([1, 1, 1, 9]))
lib = ctypes.CDLL(os.path.abspath(os.environ['STB']))
lib.stbi_loadf.restype = ctypes.POINTER(ctypes.c_float)
def by_stb(path):
    w, h, n = ctypes.c_int(), ctypes.c_int(), ctypes.c_int()
    data = lib.stbi_loadf(path.encode(), ctypes.byref(w), ctypes.byref(h), ctypes.byref(n), 3)
    return np.ctypeslib.as_array(data, (h.value, w.value, 3)).copy() if data else None
def by_opencv(path):
    a = cv2.imread(path, cv2.IMREAD_UNCHANGED)
    return None if a is None else a[..., ::-1]
def by_oiio(path):
    i = OpenImageIO.ImageInput.open(path)
    return i.read_image('float') if i else None
def by_mitsuba(path):
    try:
        return np.array(mitsuba.Bitmap(path))
    except RuntimeError:
        return None
right = np.tile(np.array([1, 0.5, 0.25], np.float32), (1, 10, 1))
same = True
for name, read in (('stb', by_stb), ('OpenCV', by_opencv), ('OpenImageIO', by_oiio), ('Mitsuba', by_mitsuba)):
    plain, runs = read('plain.hdr'), read('runs.hdr')
    print(name, 'runs:', 'refused' if runs is None else runs[0, :, 0])
    same &= plain is not None and np.array_equal(plain, right)
    same &= (runs is not None and runs[0, 0, 0] == 1 and (runs[0, 1:] < 1e-30).all()) if name == 'stb' else runs is None
print('as described' if same else 'changed')
sys.exit(0 if same else 1)
P
