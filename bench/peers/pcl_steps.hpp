// SPDX-License-Identifier: Apache-2.0
// The two steps of the Point Cloud Library that lead to boundary points.
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

namespace lacuna::peers {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;
using Boundary = pcl::PointCloud<pcl::Boundary>;
using Tree = pcl::search::KdTree<pcl::PointXYZ>;

// Returns the points of a PLY file with finite coordinates.
Cloud::Ptr load_cloud(const char* file);

// Both functions search with the same tree, which the first of them builds. PCL counts a point among its own
// neighbours.
Normals::Ptr estimate_normals(const Cloud::Ptr& cloud, const Tree::Ptr& tree, int neighbours, int threads);

// A boundary point has a gap of more than `angle` (radians) between the directions of its neighbours. It runs
// on one thread, because PCL has no other way.
Boundary find_boundary(const Cloud::Ptr& cloud, const Normals::Ptr& normals, const Tree::Ptr& tree,
                       int neighbours, float angle);

}  // namespace lacuna::peers
