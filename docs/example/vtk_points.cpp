// SPDX-License-Identifier: Apache-2.0
// Points of VTK in, the holes out as closed polylines on the same points.
#include "plane_with_hole.hpp"

#include <lacuna/lacuna.hpp>
#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

// Reads the coordinates where they are. VTK has them as floats or as doubles.
lacuna::PointArray array_of(vtkPoints* points) {
  const std::size_t size = points->GetNumberOfPoints();
  if (auto* floats = vtkFloatArray::SafeDownCast(points->GetData()))
    return {floats->GetPointer(0), size, 3 * sizeof(float)};
  if (auto* doubles = vtkDoubleArray::SafeDownCast(points->GetData()))
    return {doubles->GetPointer(0), size, 3 * sizeof(double)};
  throw lacuna::Error("points of VTK: their array is of another type; allowed: float and double");
}

vtkNew<vtkPolyData> polylines_of(const lacuna::Holes& found, vtkPoints* points) {
  vtkNew<vtkCellArray> lines;
  for (const lacuna::ReportedLoop& loop : found.loops) {
    lines->InsertNextCell(static_cast<int>(loop.points.size()) + 1);
    for (const lacuna::LoopPoint& point : loop.points) lines->InsertCellPoint(value(point.id));
    lines->InsertCellPoint(value(loop.points.front().id));
  }
  vtkNew<vtkPolyData> polylines;
  polylines->SetPoints(points);
  polylines->SetLines(lines);
  return polylines;
}

int main() {
  vtkNew<vtkPoints> points;
  for (const Eigen::Vector3d& p : plane_with_hole()) points->InsertNextPoint(p.data());

  lacuna::Config config;
  config.scale.min_hole = 10;
  config.selection.holes_only = true;
  const lacuna::Holes found = lacuna::find_holes(array_of(points), config);
  const vtkNew<vtkPolyData> polylines = polylines_of(found, points);
  for (vtkIdType i = 0; i < polylines->GetNumberOfLines(); ++i)
    print_hole(found.loops[i].measures, polylines->GetLines()->GetCellSize(i) - 1);
}
