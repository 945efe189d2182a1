#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# CGAL 5.5: triangles of Scale_space_surface_reconstruction_3.
# Guess: each triangle comes once. Edges with one triangle are then the outline of the scan and of its hole.
# Seen: all triangles but a few come twice, once for each side. No edge has one triangle, so that a search for
# borders finds none. On a thin surface, both sides of a facet are outside the alpha shape, and both are taken.
# What helps: one triangle of each pair. With these, the outline and the hole are there.
set -euo pipefail
shopt -s nullglob
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The package and what it needs, unpacked here; nothing is installed. If it is installed, that one is used.
apt-get install --simulate --no-install-recommends libcgal-dev=5.5.1-2 libeigen3-dev=3.4.0-4 |
  sed -nE 's/^Inst ([^ ]+).* \(([^ ]+) .*/\1=\2/p' | xargs -r apt-get download -qq -o APT::Sandbox::User=root
for package in *.deb; do dpkg-deb -x "$package" root; done
lib=$work/root/usr/lib/x86_64-linux-gnu
for link in "$lib"/*.so; do  # to libraries that the system has
  [[ -e $link ]] || ln -sf "${lib#"$work/root"}/$(readlink "$link")" "$link"
done
include=$work/root/usr/include
export CPLUS_INCLUDE_PATH=$include:$include/x86_64-linux-gnu:$include/eigen3:/usr/include/eigen3
export LIBRARY_PATH=$lib LD_LIBRARY_PATH=$lib

cat >scale.cpp <<'END'
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Scale_space_surface_reconstruction_3.h>
#include <CGAL/version.h>
#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <random>
#include <set>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangle = std::array<std::size_t, 3>;

template <class Triangles>
static void describe(const char* name, const Triangles& triangles, const std::vector<Kernel::Point_3>& points) {
  std::map<std::pair<std::size_t, std::size_t>, int> edges;
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) ++edges[std::minmax({t[k], t[(k + 1) % 3]})];
  const auto single = std::count_if(edges.begin(), edges.end(), [](const auto& edge) { return edge.second == 1; });
  const auto at_hole = std::count_if(edges.begin(), edges.end(), [&](const auto& edge) {
    const auto& p = points[edge.first.first];
    return edge.second == 1 && p.x() > 15 && p.x() < 35 && p.y() > 15 && p.y() < 35;
  });
  std::printf("%s: %zu, edges of one triangle %ld, of these at the hole %ld\n", name, triangles.size(), long(single),
              long(at_hole));
}

int main() {
  std::printf("CGAL %s\n", CGAL_VERSION_STR);
  // 50 x 50 points, moved by up to a fifth of the spacing, without 10 x 10 in the middle.
  std::mt19937 random(1);
  const auto move = [&] { return 0.4 * (random() / 4294967296.0) - 0.2; };
  std::vector<Kernel::Point_3> points;
  for (int y = 0; y < 50; ++y) {
    for (int x = 0; x < 50; ++x) {
      const double dx = move(), dy = move(), dz = move() / 4;
      if (x < 20 || x >= 30 || y < 20 || y >= 30) points.emplace_back(x + dx, y + dy, dz);
    }
  }
  CGAL::Scale_space_surface_reconstruction_3<Kernel> reconstruction(points.begin(), points.end());
  reconstruction.increase_scale(4);
  reconstruction.reconstruct_surface();
  std::vector<Triangle> triangles;
  std::set<Triangle> once;
  for (auto t = reconstruction.facets_begin(); t != reconstruction.facets_end(); ++t) {
    triangles.push_back({(*t)[0], (*t)[1], (*t)[2]});
    Triangle sorted = triangles.back();
    std::sort(sorted.begin(), sorted.end());
    once.insert(sorted);
  }
  describe("triangles", triangles, points);
  describe("one of each pair", once, points);
}
END
g++ -std=c++17 -O1 -w scale.cpp -o scale -lmpfr -lgmp -pthread
./scale | tee seen.txt

diff - seen.txt <<'END'
CGAL 5.5.1
triangles: 9170, edges of one triangle 0, of these at the hole 0
one of each pair: 4603, edges of one triangle 214, of these at the hole 31
END
echo "as before"
