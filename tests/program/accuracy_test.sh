#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
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
  "$root/tools/accuracy.sh" --lacuna "$LACUNA_PROGRAM" --bench "$LACUNA_BENCH_PROGRAM" --no-peers --work "$scratch/work" --data "$scratch/none" \
    --csv "$scratch/a.csv" "$@" >"$scratch/out" 2>"$scratch/err"
}

# One even set and one thinned: a line for each, their sums, and a row for each in the CSV.
accuracy --only 'torus-noise0$' || fail "ended with status $?: $(cat "$scratch/err")"
for line in '^| torus-noise0 ' '^| closed-uneven-torus-noise0 ' '^| synth: 1 sets '; do
  grep -q "$line" "$scratch/out" || fail "no line $line in the table"
done
grep -q '^synth,torus-noise0,[0-9]*,default,16,13,' "$scratch/a.csv" || fail "no row of torus-noise0 in the CSV"
grep -q 'bun_zipper.ply is not there' "$scratch/err" || fail "missing scans are not told"

# A second run of these sets gives equal rows, and options reach lacuna.
cp "$scratch/a.csv" "$scratch/first.csv"
accuracy --only 'torus-noise0$'
cmp -s "$scratch/a.csv" "$scratch/first.csv" || fail "a second run differs"
accuracy --only 'synth/torus-noise0$' -- --min-points 100000
grep -q '^synth,torus-noise0,[0-9]*,default,16,13,0,0,0,0,' "$scratch/a.csv" || fail "options do not reach lacuna"

# A range map is scan and truth in one.
accuracy --only '/table-orthographic-noise0-strays$' || fail "ended with status $?: $(cat "$scratch/err")"
grep -q '^range-made,table-orthographic-noise0-strays,[0-9]*,default,8,20,' "$scratch/a.csv" ||
  fail "the range map has not 20 true loops: $(cat "$scratch/a.csv")"

# Errors are reported.
if accuracy --only no-such-set; then fail "no set, and no error"; fi
if accuracy --only 'synth/torus-noise0$' -- --k 0; then fail "a failing lacuna is no error"; fi
grep -q 'k = 0' "$scratch/err" || fail "the reason of lacuna is not told"
status=0
accuracy --colour || status=$?
((status == 2)) || fail "wrong usage has exit code $status"

# A mesh of 30 x 30 squares in every encoding, with a vertex that no face uses. A ball cut out of it leaves its outer
# edge and one hole.
python3 - "$root/bench/accuracy" "$scratch" <<'END'
import struct
import sys

sys.path.insert(0, sys.argv[1])
from mesh import cut_balls, read_mesh, write_ply

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
assert list(map(len, meshes[0].boundary_loops())) == [4 * (n - 1)]
cut = cut_balls(meshes[0], 1.0, [4.5], 3, 1)
assert len(meshes[0].without(set()).positions) == n * n
assert len(cut.positions) < n * n - 50
write_ply(f"{sys.argv[2]}/cut.ply", cut.positions, cut.faces)
END
"$LACUNA_PROGRAM" detect "$scratch/cut.ply" --out "$scratch/holes" --quiet
"$LACUNA_BENCH_PROGRAM" evaluate "$scratch/holes" "$scratch/cut.ply" >"$scratch/told"
grep -q '^found . of 2 true loops' "$scratch/told" || fail "the cut mesh has not two true loops: $(cat "$scratch/told")"
grep -q '^found 2 of 2' "$scratch/told" || fail "the loops of the cut mesh are not found: $(cat "$scratch/told")"

# Two holes that share a vertex are two true loops, besides the outer edge. Degraded scans keep what is left of each true loop.
python3 - "$root/bench/accuracy" <<'END'
import math
import random
import sys

sys.path.insert(0, sys.argv[1])
from mesh import Mesh
from degrade import Scan, doubled, falling_by_ten, halved, with_outliers

n = 41
positions = [(float(i % n), float(i // n), 0.0) for i in range(n * n)]
squares = [(a, a + 1, a + n + 1, a + n) for row in range(n - 1) for a in range(row * n, row * n + n - 1)]
open_squares = {(5, 5), (6, 6), (20, 30)}
mesh = Mesh(positions, [square for square in squares if (square[0] % n, square[0] // n) not in open_squares])
loops = mesh.boundary_loops()
assert sorted(map(len, loops)) == [4, 4, 4, 4 * (n - 1)]
assert all(math.dist(positions[a], positions[b]) == 1 for loop in loops for a, b in zip(loop, loop[1:] + loop[:1]))

scan = Scan(positions, loops, 1.0)
for treatment, low, high in ((halved, 0.45, 0.55), (falling_by_ten, 0.34, 0.44)):
    part = treatment(scan, random.Random(1))
    left = set(part.points)
    assert low < len(part.points) / n**2 < high and len(left) == len(part.points) and left < set(positions)
    rows = [[part.points[vertex] for vertex in loop] for loop in part.loops]
    assert rows == [row for loop in loops if (row := [positions[v] for v in loop if positions[v] in left])]
    assert part.points == treatment(scan, random.Random(1)).points != treatment(scan, random.Random(2)).points
shares = [sum(low <= x < low + 10 for x, _, _ in part.points) / 10 / n for low in (0, 31)]
assert 0.6 < shares[0] < 0.9 and 0.08 < shares[1] < 0.2

twins = doubled(scan, random.Random(1))
assert len(twins.points) == 2 * n**2 and twins.points[:n**2] == positions and twins.loops == loops
assert all(math.isclose(math.dist(a, b), 1 / 3) and b[2] == 0 for a, b in zip(positions, twins.points[n**2:]))
assert all(-1e-9 <= value <= n - 1 + 1e-9 for point in twins.points for value in point)
stray = doubled(Scan([(0.0, 0.0, 0.0), (9.0, 0.0, 0.0)], [], 1.0), random.Random(1)).points
assert len(stray) == 4 and math.isclose(math.dist(stray[0], stray[2]), 1 / 3)

strewn = with_outliers(scan, random.Random(1))
outliers = strewn.points[n**2:]
assert strewn.points[:n**2] == positions and strewn.loops == loops and len(outliers) == 17
assert all(-2 <= x <= 42 and -2 <= y <= 42 and -2 <= z <= 2 for x, y, z in outliers)
assert max(z for _, _, z in outliers) > 1
END

# The table shows the best of CGAL's bounds for a group, and sums of columns that only some methods have.
python3 - "$root/bench/accuracy" <<'END' >"$scratch/table"
import sys

sys.path.insert(0, sys.argv[1])
from table import print_table


def row(name, method, found, false):
    return {"group": "g", "set": name, "method": method, "points": 1000, "true": 10, "found": found, "false": false,
            "joined": 0, "parted": 0, "step": 0, "repeated": 0, "flagged": None if "cgal" in method else 50, "boundary": 60, "f1": 0.5}


print_table([[row("a", "default", 9, 1), row("a", "cgal-r1.5", 10, 4), row("a", "cgal-r2", 8, 0)],
             [row("b", "default", 8, 2), row("b", "cgal-r1.5", 10, 5), row("b", "cgal-r2", 9, 1)]], ["default"])
END
tr -s ' ' <"$scratch/table" >"$scratch/squeezed"
grep -qxF '| a | 1,000 | 10 | 9 | 1 | 0 | 0 | 0 | 0 | 5.0 | 0.500 | 8 | 0 | r2 |' "$scratch/squeezed" || fail "$(cat "$scratch/table")"
grep -qxF '| g: 2 sets | 2,000 | 20 | 17 | 3 | 0 | 0 | 0 | 0 | 5.0 | 0.500 | 17 | 1 | r2 |' "$scratch/squeezed" ||
  fail "$(cat "$scratch/table")"
