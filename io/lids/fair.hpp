// SPDX-License-Identifier: Apache-2.0
// fair: a smooth lid that continues the surface around its loop.
#pragma once

#include "io/lids/lid_mesh.hpp"

#include <span>

namespace lacuna::io {

enum class Fairing : std::uint8_t { kThinPlate, kMembrane };

// Moves the inner vertices; the vertices of the loop stay.
//
// The membrane solves L x = 0, with the cotangent Laplacian L of the given lid. The thin plate has the least
// sum of (L x + f)^2 / a over all vertices, the loop's included. Here L is the Laplacian of the membrane, and
// a the third of the areas around a vertex. The flux f of a vertex of the loop is half of its two edges. Each
// edge is turned to point out of the lid, into the surface. So the lid leaves its loop in the direction of
// the surface. In a plane, membrane and thin plate leave the lid as it is. Mixed elements of the
// bi-Laplacian: Jacobson, Tosun, Sorkine, Zorin, *Mixed finite elements for variational surface modeling*,
// SGP 2010.
//
// The direction of the surface comes from `surface`. It has a vector for each point of the loop, from there
// to where the surface is, of any length. Nine points along the loop give a mean. Up to 60 degrees from the
// membrane the direction counts in full, from 85 degrees on not at all. That is an edge of the object, at
// which the lid is the membrane's.
//
// Returns the membrane, and kMembrane, where the thin plate cannot be solved or leaves the box of the loop by
// more than its diagonal. Where the membrane cannot be solved, the vertices stay. Deterministic. Cost: two
// sparse Cholesky factors, about O(n^1.5) time and O(n log n) memory.
Fairing fair(LidMesh& mesh, std::span<const Eigen::Vector3d> surface);

// Moves the inner vertices to the membrane alone.
void fair_membrane(LidMesh& mesh);

}  // namespace lacuna::io
