#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <opencv2/imgproc.hpp>

#include "texturing/vertex_views.h"

namespace depth_fusion {
namespace {

constexpr int kSeamBlur_px = 5;
constexpr double kSmallness = 1e-3;  // how much a colour that is added costs by itself
constexpr int kMostIterations = 300;
constexpr double kTolerance = 1e-4;

using Triplets = std::vector<Eigen::Triplet<double>>;

void addDifference(Triplets& triplets, size_t a, size_t b, double weight) {
  const int i = static_cast<int>(a), j = static_cast<int>(b);
  triplets.emplace_back(i, i, weight);
  triplets.emplace_back(j, j, weight);
  triplets.emplace_back(i, j, -weight);
  triplets.emplace_back(j, i, -weight);
}

// The colour that each entry's picture has about its vertex, where pictures meet.
std::vector<Eigen::Array3f> colorsOf(const TriangleMesh& mesh, const std::vector<ChosenView>& views,
                                     VertexViews& vertices) {
  std::vector<std::vector<std::pair<uint32_t, size_t>>> wanted(views.size());  // vertex and entry
  for (uint32_t vertex = 0; vertex < mesh.vertices.size(); ++vertex) {
    if (vertices.end(vertex) - vertices.begin(vertex) < 2) continue;
    for (const VertexView* entry = vertices.begin(vertex); entry != vertices.end(vertex); ++entry)
      wanted[entry->view].emplace_back(vertex, vertices.numberOf(entry));
  }
  std::vector<Eigen::Array3f> colors(vertices.entries().size());
  cv::parallel_for_({0, static_cast<int>(views.size())}, [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) {
      if (wanted[i].empty()) continue;
      cv::Mat image;
      cv::blur(imageOf(views[i].view), image, {kSeamBlur_px, kSeamBlur_px});
      const Eigen::Isometry3f T_C_W = views[i].view.T_W_C.inverse().cast<float>();
      for (const auto& [vertex, entry] : wanted[i]) {
        const Eigen::Vector3f uvz = projected(T_C_W * mesh.vertices[vertex].position_W, views[i].view.camera);
        colors[entry] = views[i].gain.cast<float>() * sampled(image, uvz.x(), uvz.y());
      }
    }
  });
  return colors;
}

// Pictures that meet at a vertex are to have one colour there.
void addSeams(const TriangleMesh& mesh, const std::vector<Eigen::Array3f>& colors, VertexViews& vertices,
              Triplets& triplets, Eigen::MatrixX3d& right) {
  for (uint32_t vertex = 0; vertex < mesh.vertices.size(); ++vertex) {
    const size_t begin = vertices.numberOf(vertices.begin(vertex));
    const size_t end = vertices.numberOf(vertices.end(vertex));
    for (size_t a = begin; a < end; ++a) {
      for (size_t b = a + 1; b < end; ++b) {
        addDifference(triplets, a, b, 1.0);
        const Eigen::RowVector3d difference = (colors[b] - colors[a]).matrix().cast<double>().transpose();
        right.row(static_cast<int>(a)) += difference;
        right.row(static_cast<int>(b)) -= difference;
      }
    }
  }
}

// What is added to a picture changes little from vertex to vertex.
void addEdges(const TriangleMesh& mesh, const std::vector<uint16_t>& labels, double stiffness,
              VertexViews& vertices, Triplets& triplets) {
  for (size_t face = 0; face < labels.size(); ++face) {
    if (labels[face] == kNoView) continue;
    std::array<size_t, 3> entries{};
    for (int i = 0; i < 3; ++i)
      entries[i] = vertices.numberOf(vertices.find(mesh.triangles[face][i], labels[face]));
    for (int i = 0; i < 3; ++i) addDifference(triplets, entries[i], entries[(i + 1) % 3], 0.5 * stiffness);
  }
}

}  // namespace

void levelSeams(const TriangleMesh& mesh, const std::vector<ChosenView>& views,
                const std::vector<uint16_t>& labels, float seam_stiffness, VertexViews& vertices) {
  const auto count = static_cast<int>(vertices.entries().size());
  if (count == 0) return;
  const std::vector<Eigen::Array3f> colors = colorsOf(mesh, views, vertices);
  Triplets triplets;
  Eigen::MatrixX3d right = Eigen::MatrixX3d::Zero(count, 3);
  for (int i = 0; i < count; ++i) triplets.emplace_back(i, i, kSmallness);
  addSeams(mesh, colors, vertices, triplets, right);
  addEdges(mesh, labels, static_cast<double>(seam_stiffness), vertices, triplets);
  Eigen::SparseMatrix<double, Eigen::RowMajor> matrix(count, count);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double, Eigen::RowMajor>, Eigen::Lower | Eigen::Upper> solver;
  solver.setMaxIterations(kMostIterations);
  solver.setTolerance(kTolerance);
  solver.compute(matrix);
  const Eigen::MatrixX3d solution = solver.solve(right);
  for (int i = 0; i < count; ++i)
    vertices.entries()[i].leveling = solution.row(i).transpose().cast<float>().array();
}

}  // namespace depth_fusion
