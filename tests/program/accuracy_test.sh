#!/usr/bin/env bash
# tools/accuracy.sh on a few sets, and the meshes, thinned scans and range maps that it makes. LACUNA_PROGRAM names the
# program.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

fail() {
  echo "accuracy_test.sh: $1" >&2
  exit 1
}

accuracy() {
  "$root/tools/accuracy.sh" --lacuna "$LACUNA_PROGRAM" --no-peers --work "$scratch/work" --data "$scratch/none" \
    --csv "$scratch/a.csv" "$@" >"$scratch/out" 2>"$scratch/err"
}

# One even set and one thinned: a line for each, their sums, and a row for each in the CSV.
accuracy --only 'torus-noise0$' || fail "ended with status $?: $(cat "$scratch/err")"
for line in '^| torus-noise0 ' '^| closed-uneven-torus-noise0 ' '^| synth: 1 sets '; do
  grep -q "$line" "$scratch/out" || fail "no line $line in the table"
done
grep -q '^synth,torus-noise0,[0-9]*,default,16,13,' "$scratch/a.csv" || fail "no row of torus-noise0 in the CSV"
grep -q 'bun_zipper.ply is not there' "$scratch/err" || fail "missing scans are not told"

# The same sets again give the same rows, and options reach lacuna.
cp "$scratch/a.csv" "$scratch/first.csv"
accuracy --only 'torus-noise0$'
cmp -s "$scratch/a.csv" "$scratch/first.csv" || fail "a second run differs"
accuracy --only 'synth/torus-noise0$' -- --min-points 100000
grep -q '^synth,torus-noise0,[0-9]*,default,16,13,0,0,0,0,' "$scratch/a.csv" || fail "options do not reach lacuna"

# A range map is scan and truth in one.
accuracy --only '/table-orthographic-noise0-strays$' || fail "ended with status $?: $(cat "$scratch/err")"
grep -q '^range-made,table-orthographic-noise0-strays,[0-9]*,default,8,20,' "$scratch/a.csv" ||
  fail "the range map has not 20 true loops: $(cat "$scratch/a.csv")"

# What goes wrong is told.
if accuracy --only no-such-set; then fail "no set, and no error"; fi
if accuracy --only 'synth/torus-noise0$' -- --k 0; then fail "a failing lacuna is no error"; fi
grep -q 'k = 0' "$scratch/err" || fail "the reason of lacuna is not told"
status=0
accuracy --colour || status=$?
((status == 2)) || fail "wrong usage has exit code $status"

# A mesh of 30 x 30 squares in every encoding, with a vertex that no face uses: a ball cut out of it leaves its rim
# and one hole.
python3 - "$root/bench/accuracy" "$scratch" <<'END'
import struct
import sys

sys.path.insert(0, sys.argv[1])
from mesh import cut_balls, read_mesh, write_mesh

n = 31
positions = [(float(i % n), float(i // n), 0.0) for i in range(n * n)] + [(99.0, 99.0, 99.0)]
faces = [(a, a + 1, a + n + 1, a + n) for row in range(n - 1) for a in range(row * n, row * n + n - 1)]
meshes = []
for encoding, order in (("ascii", ""), ("binary_little_endian", "<"), ("binary_big_endian", ">")):
    file = f"{sys.argv[2]}/{encoding}.ply"
    header = (f"ply\nformat {encoding} 1.0\nelement camera 1\nproperty short view\nelement vertex {len(positions)}\n"
              "property float x\nproperty double y\nproperty float z\n"
              f"element face {len(faces)}\nproperty list uchar uint vertex_index\nproperty uchar flag\nend_header\n")
    with open(file, "wb") as out:
        out.write(header.encode())
        if encoding == "ascii":
            rows = ["7", *("%g %g %g" % p for p in positions), *("4 %d %d %d %d 0" % f for f in faces)]
            out.write(("\n".join(rows) + "\n").encode())
        else:
            out.write(struct.pack(order + "h", 7))
            out.write(b"".join(struct.pack(order + "fdf", *p) for p in positions))
            out.write(b"".join(struct.pack(order + "B4IB", 4, *f, 0) for f in faces))
    meshes.append(read_mesh(file))
assert all(mesh.positions == positions and mesh.faces == faces for mesh in meshes)
assert len(meshes[0].boundary_vertices()) == 4 * (n - 1)
cut = cut_balls(meshes[0], 1.0, [4.5], 3, 1)
assert len(meshes[0].without(set()).positions) == n * n
assert len(cut.positions) < n * n - 50
write_mesh(cut, f"{sys.argv[2]}/cut.ply")
END
"$LACUNA_PROGRAM" detect "$scratch/cut.ply" --out "$scratch/holes" --quiet
"$LACUNA_PROGRAM" evaluate "$scratch/holes" "$scratch/cut.ply" >"$scratch/told"
grep -q 'true loops  2,' "$scratch/told" || fail "the cut mesh has not two true loops: $(cat "$scratch/told")"
grep -q 'found       2' "$scratch/told" || fail "the loops of the cut mesh are not found: $(cat "$scratch/told")"

# Shapes are met where they should be, and a range map has rims that do not touch and the strays that are asked for.
python3 - "$root/bench/accuracy" <<'END'
import math
import sys
from collections import Counter

sys.path.insert(0, sys.argv[1])
from range_map import (MISS, SCENES, box, cylinder, grid_triangles, height_field, nearest, range_map, sphere, tilted,
                       torus)


def meets(shape, x, y, distance, cosine):
    """Seen from a height of 3, straight down."""
    found = shape((x, y, 3.0), (0.0, 0.0, -1.0))
    return math.isclose(found[0], distance, abs_tol=1e-6) and math.isclose(found[1], cosine, abs_tol=1e-4)


ball, brick, half = sphere((0, 0, 1), 1), box((0, 0, 0), (1, 2, 0.5)), math.sqrt(0.5)
lying, standing = cylinder((0, 0, 0), (1, 0, 0), 0.5, 1), cylinder((0, 0, 0), (0, 0, 1), 0.5, 1)
slope = height_field(lambda x, y: x / 2, -1, 1)
assert meets(ball, 0.6, 0, 1.2, 0.8) and meets(ball, 1.1, 0, *MISS)
assert meets(brick, 0.9, -1.9, 2.5, 1) and meets(brick, 1.1, 0, *MISS)
assert meets(tilted(90, brick), 0.9, 0.4, 1, 1) and meets(tilted(45, brick), 0.9, 0, 3 - half, half)
assert meets(lying, 0.9, 0.3, 2.6, 0.8) and meets(lying, 1.1, 0, *MISS)
assert meets(tilted(45, standing), 0, -half, 3 - half, half)
assert meets(torus(1, 0.5), 1.3, 0, 2.6, 0.8) and meets(torus(1, 0.5), 0.4, 0, *MISS)
assert meets(slope, 0.4, 0.7, 2.8, 2 / math.sqrt(5))
assert meets(nearest(slope, ball), 0.6, 0, 1.2, 0.8)

# Of 3 x 3 squares the four about one ray have one triangle each where it is lost or far off.
for ray, triangles in (((1.0, 1.0, 0.0), 18), (None, 14), ((1.0, 1.0, 5.0), 14)):
    seen = [(float(i % 4), float(i // 4), 0.0) for i in range(16)]
    seen[5] = ray
    assert len(grid_triangles(seen, 4)) == triangles

SCENES["ball"] = (60, nearest(sphere((0, 0, 0), 0.9), box((0, 0, -1), (1.2, 1.2, 0.1))))
maps = [range_map("ball", perspective, 0.3, True, 7) for perspective in (False, True)]
for mesh in maps:
    edges = Counter(frozenset(pair) for a, b, c in mesh.faces for pair in ((a, b), (b, c), (c, a)))
    ends = Counter(vertex for edge, count in edges.items() if count == 1 for vertex in edge)
    assert set(edges.values()) == {1, 2} and set(ends.values()) == {2}
assert maps[0].positions == range_map("ball", False, 0.3, True, 7).positions != maps[1].positions
clean = range_map("ball", False, 0.3, False, 7)
assert len(clean.faces) == len(maps[0].faces) and len(clean.positions) < len(maps[0].positions)
assert set(range(len(clean.positions))) == {vertex for face in clean.faces for vertex in face}
END
