// Models as VTK takes them.
#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkTexture.h>

#include "apps/view/model.h"

namespace depth_fusion {

// Triangles with normals, or points where the model has none, in the colours of a paint.
vtkSmartPointer<vtkPolyData> surfaceData(const ViewedModel& model, const std::string& paint);

// The triangles of one page of the texture, with their places in it.
vtkSmartPointer<vtkPolyData> pageData(const ViewedModel& model, size_t page);

// The picture as a texture.
vtkSmartPointer<vtkTexture> textureOf(const cv::Mat& page);

// One line through all the positions.
vtkSmartPointer<vtkPolyData> wayData(const Trajectory& way);

}  // namespace depth_fusion
