#include "texturing/texture_painting.h"

#include <algorithm>
#include <array>

#include "surface_mesh/triangle_pixels.h"

namespace depth_fusion {
namespace {

constexpr float kSlack_px = 0.75f;  // by which a face's pixels reach beyond it
constexpr float kSteps = 256.0f;    // of a level of colour, while shares of pictures are summed up
constexpr int kNoOwner = -1;
constexpr int kSpread_px = 3;
constexpr MeshColor kGrey = {128, 128, 128};

// A face in the texture.
struct PaintedFace {
  size_t page = 0;
  std::array<cv::Point2f, 3> corners;
};

struct PaintedPage {
  cv::Mat owners;  // CV_32SC1: the face that a pixel belongs to, or kNoOwner
  cv::Mat sums;    // CV_16UC3: kSteps times the colour
};

class Painting {
 public:
  Painting(const TriangleMesh& mesh, const std::vector<ChosenView>& views,
           const std::vector<uint16_t>& labels, const VertexViews& vertices, const TextureLayout& layout)
      : mesh_(mesh), views_(views), labels_(labels), vertices_(vertices), faces_(labels.size()) {
    for (const cv::Size& size : layout.pages)
      pages_.push_back(
          {cv::Mat(size, CV_32SC1, cv::Scalar(kNoOwner)), cv::Mat(size, CV_16UC3, cv::Scalar::all(0))});
    for (const TexturePatch& patch : layout.patches) place(patch);
  }

  void paintUnseen() {
    for (size_t face = 0; face < faces_.size(); ++face) {
      if (labels_[face] != kNoView) continue;
      const std::array<cv::Vec3f, 3> c = {color(face, 0), color(face, 1), color(face, 2)};
      const cv::Point at(faces_[face].corners[0]);
      const std::array<cv::Vec3f, 4> pixels = {c[0], c[1], c[2], c[1] + c[2] - c[0]};
      for (int i = 0; i < 4; ++i) {
        const cv::Point pixel = at + cv::Point(i % 2, i / 2);
        pages_[faces_[face].page].sums.at<cv::Vec3w>(pixel) = kSteps * pixels[i];
        pages_[faces_[face].page].owners.at<int>(pixel) = static_cast<int>(face);
      }
    }
  }

  // Paints a view's share in every face that it has one in.
  void paintShares(uint16_t view, const std::vector<uint32_t>& faces) {
    const cv::Mat image = imageOf(views_[view].view);
    const Eigen::Isometry3f T_C_W = views_[view].view.T_W_C.inverse().cast<float>();
    cv::parallel_for_({0, static_cast<int>(faces.size())}, [&](const cv::Range& range) {
      for (int i = range.start; i < range.end; ++i) paintShare(faces[i], view, image, T_C_W);
    });
  }

  // The faces of each view's shares.
  std::vector<std::vector<uint32_t>> shares() const {
    std::vector<std::vector<uint32_t>> shares(views_.size());
    const auto note = [&](uint16_t view, uint32_t face) {
      if (shares[view].empty() || shares[view].back() != face) shares[view].push_back(face);
    };
    for (uint32_t face = 0; face < faces_.size(); ++face) {
      if (labels_[face] == kNoView) continue;
      note(labels_[face], face);
      for (const uint32_t vertex : mesh_.triangles[face]) {
        for (const VertexView* entry = vertices_.begin(vertex); entry != vertices_.end(vertex); ++entry) {
          if (entry->weight > 0.0f) note(entry->view, face);
        }
      }
    }
    return shares;
  }

  PaintedTexture finish() {
    PaintedTexture painted;
    double owned = 0.0, all = 0.0;
    for (PaintedPage& page : pages_) {
      cv::Mat colors;
      page.sums.convertTo(colors, CV_8U, 1.0 / static_cast<double>(kSteps));
      owned += cv::countNonZero(page.owners != kNoOwner);
      all += static_cast<double>(page.owners.total());
      for (int i = 0; i < kSpread_px; ++i) spread(colors, page.owners);
      painted.pages.push_back(colors);
    }
    painted.fill = all > 0.0 ? owned / all : 0.0;
    return painted;
  }

 private:
  void place(const TexturePatch& patch) {
    const cv::Point2f origin(patch.place.corner);
    cv::Mat& owners = pages_[patch.place.page].owners;
    for (size_t i = 0; i < patch.faces.size(); ++i) {
      PaintedFace& face = faces_[patch.faces[i]];
      face.page = patch.place.page;
      for (int k = 0; k < 3; ++k) face.corners[k] = patch.corners[i][k] + origin;
    }
    // What lies in a face is its own; what lies beside it goes to the first that is near.
    for (const float slack_px : {0.0f, kSlack_px}) {
      if (patch.view == kNoView) return;
      for (const uint32_t face : patch.faces) {
        forEachPixelOf(faces_[face].corners, owners.size(), slack_px, [&](const cv::Point& at, const auto&) {
          int& owner = owners.at<int>(at);
          if (owner == kNoOwner) owner = static_cast<int>(face);
        });
      }
    }
  }

  void paintShare(uint32_t face, uint16_t view, const cv::Mat& image, const Eigen::Isometry3f& T_C_W) {
    const MeshTriangle& t = mesh_.triangles[face];
    std::array<float, 3> weights{};
    std::array<Eigen::Array3f, 3> leveling;
    std::array<Eigen::Vector3f, 3> corners_C;
    for (int i = 0; i < 3; ++i) {
      const VertexView* entry = vertices_.find(t[i], view);
      weights[i] = vertices_.weightOf(t[i], view, labels_[face]);
      leveling[i] = entry == nullptr ? Eigen::Array3f::Zero() : entry->leveling;
      corners_C[i] = T_C_W * mesh_.vertices[t[i]].position_W;
    }
    const Eigen::Array3f gain = views_[view].gain.cast<float>();
    PaintedPage& page = pages_[faces_[face].page];
    forEachPixelOf(faces_[face].corners, page.owners.size(), kSlack_px,
                   [&](const cv::Point& at, const std::array<float, 3>& place) {
                     if (page.owners.at<int>(at) != static_cast<int>(face)) return;
                     Eigen::Vector3f p_C = Eigen::Vector3f::Zero();
                     for (int i = 0; i < 3; ++i) p_C += place[i] * corners_C[i];
                     const Eigen::Vector3f uvz = projected(p_C, views_[view].view.camera);
                     const float u = std::clamp(uvz.x(), 0.0f, static_cast<float>(image.cols - 1));
                     const float v = std::clamp(uvz.y(), 0.0f, static_cast<float>(image.rows - 1));
                     const Eigen::Array3f color = gain * sampled(image, u, v);
                     Eigen::Array3f share = Eigen::Array3f::Zero();
                     const float inside =
                         std::max(place[0], 0.0f) + std::max(place[1], 0.0f) + std::max(place[2], 0.0f);
                     for (int i = 0; i < 3; ++i)
                       share += std::max(place[i], 0.0f) / inside * weights[i] *
                                (color + leveling[i]).max(0.0f).min(255.0f);
                     cv::Vec3w& sum = page.sums.at<cv::Vec3w>(at);
                     for (int i = 0; i < 3; ++i)
                       sum[i] = cv::saturate_cast<uint16_t>(static_cast<float>(sum[i]) + kSteps * share[i]);
                   });
  }

  cv::Vec3f color(size_t face, int corner) const {
    const MeshColor& rgb = mesh_.colors.empty() ? kGrey : mesh_.colors[mesh_.triangles[face][corner]];
    return cv::Vec3f(rgb[2], rgb[1], rgb[0]);
  }

  // Pixels that nobody owns get the mean of those beside them, and belong to one of these.
  static void spread(cv::Mat& colors, cv::Mat& owners) {
    const cv::Mat before = owners.clone();
    const cv::Rect page({0, 0}, colors.size());
    cv::parallel_for_({0, colors.rows}, [&](const cv::Range& rows) {
      for (int y = rows.start; y < rows.end; ++y) {
        for (int x = 0; x < colors.cols; ++x) {
          if (before.at<int>(y, x) != kNoOwner) continue;
          cv::Vec3i sum(0, 0, 0);
          int count = 0;
          for (int i = 0; i < 9; ++i) {
            const cv::Point beside(x + i % 3 - 1, y + i / 3 - 1);
            if (!page.contains(beside) || before.at<int>(beside) == kNoOwner) continue;
            owners.at<int>(y, x) = before.at<int>(beside);
            sum += cv::Vec3i(colors.at<cv::Vec3b>(beside));
            ++count;
          }
          if (count > 0) colors.at<cv::Vec3b>(y, x) = cv::Vec3b(sum / count);
        }
      }
    });
  }

  const TriangleMesh& mesh_;
  const std::vector<ChosenView>& views_;
  const std::vector<uint16_t>& labels_;
  const VertexViews& vertices_;
  std::vector<PaintedFace> faces_;
  std::vector<PaintedPage> pages_;
};

}  // namespace

PaintedTexture paint(const TriangleMesh& mesh, const std::vector<ChosenView>& views,
                     const std::vector<uint16_t>& labels, const VertexViews& vertices,
                     const TextureLayout& layout, const std::function<void(double)>& progress) {
  Painting painting(mesh, views, labels, vertices, layout);
  painting.paintUnseen();
  const auto shares = painting.shares();
  for (size_t view = 0; view < views.size(); ++view) {
    progress(static_cast<double>(view) / static_cast<double>(views.size()));
    if (!shares[view].empty()) painting.paintShares(static_cast<uint16_t>(view), shares[view]);
  }
  return painting.finish();
}

}  // namespace depth_fusion
