# SPDX-License-Identifier: Apache-2.0
"""Makes a LAS file of the points of a PLY file from `lacuna-bench synth surface`, with values in every field.

make_las.py IN.ply OUT.las FORMAT [FIRST [COUNT]]

Point formats 0 to 3 make LAS 1.2 without extra bytes. Formats 6 to 8 make LAS 1.4 with extra bytes, well-known text and a record
behind the points.
"""
import random
import struct
import sys

CRS = b'LOCAL_CS["made",UNIT["metre",1]]\0'


def descriptor(name, kind, options=0, no_data=b"", description=b""):
    """A descriptor of the record "Extra Bytes" (LAS 1.4 R15, table 24)."""
    return struct.pack("<HBB32s4x24s24s24s24s24s32s", 0, kind, options, name, no_data, b"", b"", b"", b"", description)


EXTRA = [descriptor(b"height", 4, 1, struct.pack("<q", -9999), b"above ground"), descriptor(b"pulse", 10),
         descriptor(b"echo", 9), descriptor(b"probability", 1, 0, b"", b"of another program"), descriptor(b"raw", 0, 3)]


def record(user, number, data, is_extended=False):
    return struct.pack("<H16sHQ32s" if is_extended else "<H16sHH32s", 0, user, number, len(data), b"made") + data


def point(format, stored, values):
    """A record with random values."""
    x, y, z = stored
    bits = values.getrandbits
    if format < 6:
        number = values.randint(1, 5)
        bytes = struct.pack("<3iHBBbBH", x, y, z, bits(16), number | values.randint(number, 5) << 3 | bits(2) << 6, bits(8),
                            values.randint(-90, 90), bits(8), bits(16))
    else:
        number = values.randint(1, 15)
        bytes = struct.pack("<3iHBBBBhH", x, y, z, bits(16), number | values.randint(number, 15) << 4, bits(8), bits(8),
                            bits(8), values.randint(-30_000, 30_000), bits(16))
    if format not in (0, 2):
        bytes += struct.pack("<d", values.uniform(0, 1e6))
    if format in (2, 3, 7, 8):
        bytes += struct.pack("<3H", bits(16), bits(16), bits(16))
    if format == 8:
        bytes += struct.pack("<H", bits(16))
    if format >= 6:
        bytes += struct.pack("<hdfB3s", values.randint(-999, 999), values.random(), values.random(), bits(8), b"raw")
    return bytes


def main(source, target, format, first=0, count=None):
    rows = open(source, "rb").read().split(b"end_header\n", 1)[1]
    places = list(struct.iter_unpack("<3f", rows))[first:][:count]
    scale, offset = (0.001, 0.001, 0.002), (500_000 + 0.0005 * format, 5_400_000, -100)
    stored = [[round((50_000 if axis == 2 else 100_000) * at) for axis, at in enumerate(place)] for place in places]
    values = random.Random(format)
    points = [point(format, at, values) for at in stored]
    numbers = [one[14] & (15 if format >= 6 else 7) for one in points]
    returns = [numbers.count(number) for number in range(1, 16)]
    bounds = []
    for axis in range(3):
        for most in (max, min):
            bounds.append(most(at[axis] for at in stored) * scale[axis] + offset[axis])

    is_new = format >= 6
    records = [record(b"somebody", 7, b"kept"), record(b"LASF_Projection", 2112, CRS)][:2 if is_new else 1]
    if is_new:
        records.insert(0, record(b"LASF_Spec", 4, b"".join(EXTRA)))
    header, before = 375 if is_new else 227, sum(map(len, records))
    legacy = [0] * 6 if is_new else [len(points), *returns[:5]]
    block = struct.pack("<4sHH16sBB32s32sHHHII", b"LASF", 42, 17 if is_new else 1, bytes(range(16)), 1, 4 if is_new else 2,
                        b"a scanner", b"make_las.py", 99, 2026, header, header + before, len(records))
    block += struct.pack("<BH6I", format, len(points[0]), *legacy) + struct.pack("<12d", *scale, *offset, *bounds)
    if is_new:
        end = header + before + sum(map(len, points))
        block += struct.pack("<QQIQ15Q", 0, end, 1, len(points), *returns)
    with open(target, "wb") as file:
        file.write(block + b"".join(records) + b"".join(points))
        if is_new:
            file.write(record(b"somebody", 8, b"behind the points", is_extended=True))


main(sys.argv[1], sys.argv[2], *map(int, sys.argv[3:]))
