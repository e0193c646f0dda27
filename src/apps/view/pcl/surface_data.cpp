#include "apps/view/pcl/surface_data.h"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnsignedCharArray.h>

#include <opencv2/imgproc.hpp>

namespace depth_fusion {
namespace {

template <class Array, class Value>
vtkSmartPointer<Array> numbersEach(int numbers, size_t count, const char* name, const Value& value) {
  vtkSmartPointer<Array> array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfComponents(numbers);
  array->SetNumberOfTuples(static_cast<vtkIdType>(count));
  for (size_t i = 0; i < count; ++i) {
    for (int k = 0; k < numbers; ++k) array->SetTypedComponent(static_cast<vtkIdType>(i), k, value(i, k));
  }
  return array;
}

vtkSmartPointer<vtkPoints> pointsOf(const TriangleMesh& mesh) {
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetData(numbersEach<vtkFloatArray>(
      3, mesh.vertices.size(), "points", [&](size_t i, int k) { return mesh.vertices[i].position_W[k]; }));
  return points;
}

vtkSmartPointer<vtkCellArray> trianglesOf(const TriangleMesh& mesh, size_t begin, size_t end) {
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  for (size_t i = begin; i < end; ++i) {
    cells->InsertNextCell(3);
    for (const uint32_t vertex : mesh.triangles[i]) cells->InsertCellPoint(vertex);
  }
  return cells;
}

vtkSmartPointer<vtkFloatArray> normalsOf(const TriangleMesh& mesh) {
  return numbersEach<vtkFloatArray>(3, mesh.vertices.size(), "normals",
                                    [&](size_t i, int k) { return mesh.vertices[i].normal_W[k]; });
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
    data->SetPolys(trianglesOf(mesh, 0, mesh.triangles.size()));
  const std::vector<MeshColor> colors = colorsOf(model, paint);
  data->GetPointData()->SetScalars(numbersEach<vtkUnsignedCharArray>(
      3, colors.size(), "colors", [&](size_t i, int k) { return colors[i][static_cast<size_t>(k)]; }));
  data->GetPointData()->SetNormals(normalsOf(mesh));
  return data;
}

vtkSmartPointer<vtkPolyData> pageData(const ViewedModel& model, size_t page) {
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(pointsOf(model.mesh));
  data->SetPolys(trianglesOf(model.mesh, page == 0 ? 0 : model.page_ends[page - 1], model.page_ends[page]));
  data->GetPointData()->SetNormals(normalsOf(model.mesh));
  data->GetPointData()->SetTCoords(numbersEach<vtkFloatArray>(
      2, model.shares.size(), "places", [&](size_t i, int k) { return model.shares[i][k]; }));
  return data;
}

vtkSmartPointer<vtkTexture> textureOf(const cv::Mat& page) {
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(page.cols, page.rows, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  cv::Mat pixels(page.size(), CV_8UC3, image->GetScalarPointer());
  cv::cvtColor(page, pixels, cv::COLOR_BGR2RGB);
  cv::flip(pixels, pixels, 0);
  auto texture = vtkSmartPointer<vtkTexture>::New();
  texture->SetInputData(image);
  texture->InterpolateOn();
  return texture;
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
