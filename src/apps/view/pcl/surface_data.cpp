#include "apps/view/pcl/surface_data.h"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnsignedCharArray.h>

namespace depth_fusion {
namespace {

template <class Array, class Value>
vtkSmartPointer<Array> threeEach(size_t count, const char* name, const Value& value) {
  vtkSmartPointer<Array> array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(static_cast<vtkIdType>(count));
  for (size_t i = 0; i < count; ++i) {
    for (int k = 0; k < 3; ++k) array->SetTypedComponent(static_cast<vtkIdType>(i), k, value(i, k));
  }
  return array;
}

vtkSmartPointer<vtkPoints> pointsOf(const TriangleMesh& mesh) {
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetData(threeEach<vtkFloatArray>(mesh.vertices.size(), "points",
                                           [&](size_t i, int k) { return mesh.vertices[i].position_W[k]; }));
  return points;
}

vtkSmartPointer<vtkCellArray> trianglesOf(const TriangleMesh& mesh) {
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  for (const MeshTriangle& triangle : mesh.triangles) {
    cells->InsertNextCell(3);
    for (const uint32_t vertex : triangle) cells->InsertCellPoint(vertex);
  }
  return cells;
}

// The cell of one point each, or of all of them.
vtkSmartPointer<vtkCellArray> rowsOf(size_t points, size_t in_a_row) {
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  for (size_t i = 0; i < points; ++i) {
    if (i % in_a_row == 0) cells->InsertNextCell(static_cast<int>(in_a_row));
    cells->InsertCellPoint(static_cast<vtkIdType>(i));
  }
  return cells;
}

}  // namespace

vtkSmartPointer<vtkPolyData> surfaceData(const ViewedModel& model, const std::string& paint) {
  const TriangleMesh& mesh = model.mesh;
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(pointsOf(mesh));
  if (mesh.triangles.empty())
    data->SetVerts(rowsOf(mesh.vertices.size(), 1));
  else
    data->SetPolys(trianglesOf(mesh));
  const std::vector<MeshColor> colors = colorsOf(model, paint);
  data->GetPointData()->SetScalars(threeEach<vtkUnsignedCharArray>(
      colors.size(), "colors", [&](size_t i, int k) { return colors[i][static_cast<size_t>(k)]; }));
  data->GetPointData()->SetNormals(threeEach<vtkFloatArray>(
      mesh.vertices.size(), "normals", [&](size_t i, int k) { return mesh.vertices[i].normal_W[k]; }));
  return data;
}

vtkSmartPointer<vtkPolyData> wayData(const Trajectory& way) {
  auto points = vtkSmartPointer<vtkPoints>::New();
  for (const StampedPose& pose : way) points->InsertNextPoint(pose.T_W_D.translation().data());
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetLines(rowsOf(way.size(), way.size()));
  return data;
}

}  // namespace depth_fusion
