#include "depth_fusion/texturing/texturing.h"

#include <map>
#include <utility>

#include "depth_fusion/common/error.h"
#include "texturing/seam_measure.h"
#include "texturing/surface_points.h"
#include "texturing/texture_painting.h"
#include "texturing/view_alignment.h"
#include "texturing/view_choice.h"
#include "texturing/view_labelling.h"

namespace depth_fusion {
namespace {

// The vertices of each patch are its own, page after page.
TexturedMesh joinedPatches(const TriangleMesh& mesh, const TextureLayout& layout) {
  TexturedMesh result;
  for (size_t page = 0; page < layout.pages.size(); ++page) {
    for (const TexturePatch& patch : layout.patches) {
      if (patch.place.page != page) continue;
      std::map<uint32_t, uint32_t> numbers;  // of the patch's vertices
      for (size_t i = 0; i < patch.faces.size(); ++i) {
        MeshTriangle triangle = mesh.triangles[patch.faces[i]];
        if (patch.view == kNoView) numbers.clear();
        for (int k = 0; k < 3; ++k) {
          const auto [entry, is_new] =
              numbers.emplace(triangle[k], static_cast<uint32_t>(result.mesh.vertices.size()));
          if (is_new) {
            const cv::Point2f place = patch.corners[i][k] + cv::Point2f(patch.place.corner);
            result.mesh.vertices.push_back(mesh.vertices[triangle[k]]);
            result.places.emplace_back(place.x, place.y);
          }
          triangle[k] = entry->second;
        }
        result.mesh.triangles.push_back(triangle);
      }
    }
    result.page_ends.push_back(result.mesh.triangles.size());
  }
  return result;
}

void countSeen(const TriangleMesh& mesh, const std::vector<uint16_t>& labels, TexturingReport& report) {
  double area = 0.0, seen_area = 0.0;
  for (size_t face = 0; face < labels.size(); ++face) {
    const auto face_area = static_cast<double>(areaNormal(mesh, mesh.triangles[face]).norm());
    area += face_area;
    if (labels[face] == kNoView) continue;
    seen_area += face_area;
    ++report.seen;
  }
  report.faces = labels.size();
  report.seen_area = area > 0.0 ? seen_area / area : 0.0;
}

}  // namespace

Texturing textureMesh(const TriangleMesh& mesh, std::vector<TexturingView> views,
                      const TexturingParameters& parameters,
                      const std::function<void(const std::string& step, double done)>& progress) {
  check(!mesh.triangles.empty(), "the mesh has no triangles to be textured");
  check(!views.empty(), "there are no pictures to texture the mesh with");
  const auto saying = [&](const std::string& step) {
    if (progress) progress(step, 0.0);
    return [&progress, step](double done) {
      if (progress) progress(step, done);
    };
  };
  Texturing result;
  TexturingReport& report = result.report;
  report.views = views.size();
  saying("choosing pictures");
  std::vector<ChosenView> chosen = chosenViews(std::move(views), parameters);
  report.chosen = chosen.size();
  const Alignment alignment = alignViews(mesh, chosen, parameters, saying("aligning pictures"));
  report.misfit_before = alignment.misfit_before;
  report.misfit_after = alignment.misfit_after;
  report.move_m = alignment.move_m;
  std::vector<FaceViews> faces = viewsOfFaces(mesh, chosen, parameters, saying("looking at faces"));
  report.outliers = removeOutliers(faces, static_cast<double>(parameters.outlier_levels));
  saying("choosing a picture for each face");
  const FaceNeighbours neighbours = neighboursOf(mesh.triangles);
  const std::vector<uint16_t> labels = labelFaces(faces, neighbours, parameters.smoothness);
  countSeen(mesh, labels, report);
  saying("levelling seams");
  VertexViews vertices(mesh, faces, labels);
  levelSeams(mesh, chosen, labels, parameters.seam_stiffness, vertices);
  const TextureLayout layout = layOut(mesh, chosen, labels, neighbours, parameters.page_px);
  for (const TexturePatch& patch : layout.patches) report.patches += patch.view != kNoView;
  PaintedTexture painted = paint(mesh, chosen, labels, vertices, layout, saying("painting"));
  report.fill = painted.fill;
  const SeamMeasure seams = measureSeams(mesh, neighbours, labels, layout, painted.pages);
  report.seam_step = seams.step;
  report.seam_gradient = seams.gradient;
  result.textured = joinedPatches(mesh, layout);
  result.textured.pages = std::move(painted.pages);
  return result;
}

}  // namespace depth_fusion
