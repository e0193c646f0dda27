// Models as VTK takes them.
#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "apps/view/model.h"

namespace depth_fusion {

// Triangles with normals, or points where the model has none, in the colours of a paint.
vtkSmartPointer<vtkPolyData> surfaceData(const ViewedModel& model, const std::string& paint);

// One line through all the positions.
vtkSmartPointer<vtkPolyData> wayData(const Trajectory& way);

}  // namespace depth_fusion
