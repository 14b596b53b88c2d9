// The peer of cut/sphere_1m: VTK's table-based clipper, both halves, of the same tets and values.
//   pith-bench-vtk FILE TIMES   →   its last line is "result TETS SECONDS", the median
// FILE: two 64-bit counts, then x y z value per vertex (doubles), then four 32-bit corners per tet.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>
#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkTableBasedClipDataSet.h>
#include <vtkUnstructuredGrid.h>

int main(int count, char** arguments) {
  if (count != 3) return 2;
  std::FILE* file = std::fopen(arguments[1], "rb");
  std::uint64_t size[2];
  if (!file || std::fread(size, sizeof size, 1, file) != 1) return 1;
  std::vector<double> vertex(4 * size[0]);
  std::vector<std::uint32_t> corner(4 * size[1]);
  if (std::fread(vertex.data(), sizeof(double), vertex.size(), file) != vertex.size() ||
      std::fread(corner.data(), sizeof(std::uint32_t), corner.size(), file) != corner.size())
    return 1;
  std::fclose(file);

  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> values;
  values->SetName("value");
  for (std::uint64_t v = 0; v < size[0]; ++v) {
    points->InsertNextPoint(vertex[4 * v], vertex[4 * v + 1], vertex[4 * v + 2]);
    values->InsertNextValue(vertex[4 * v + 3]);
  }
  vtkNew<vtkCellArray> cells;
  for (std::uint64_t t = 0; t < size[1]; ++t) {
    const vtkIdType ids[4] = {corner[4 * t], corner[4 * t + 1], corner[4 * t + 2], corner[4 * t + 3]};
    cells->InsertNextCell(4, ids);
  }
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(points);
  grid->SetCells(VTK_TETRA, cells);
  grid->GetPointData()->SetScalars(values);

  std::vector<double> seconds;
  vtkIdType tets = 0;
  for (int i = 0; i <= std::atoi(arguments[2]); ++i) {
    vtkNew<vtkTableBasedClipDataSet> clip;
    clip->SetInputData(grid);
    clip->SetValue(0);
    clip->GenerateClippedOutputOn();
    const auto begin = std::chrono::steady_clock::now();
    clip->Update();
    if (i > 0) seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    tets = clip->GetOutput()->GetNumberOfCells() + clip->GetClippedOutput()->GetNumberOfCells();
  }
  std::sort(seconds.begin(), seconds.end());
  std::printf("\nresult %lld %.6f\n", static_cast<long long>(tets), seconds[seconds.size() / 2]);
  return 0;
}
