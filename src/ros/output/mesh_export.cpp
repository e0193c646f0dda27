#include "ros/output/mesh_export.h"

#include <ros/console.h>
#include <wordexp.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include "depth_fusion/common/error.h"
#include "depth_fusion/submaps/world_mesh.h"
#include "depth_fusion/surface_mesh/mesh_file.h"
#include "depth_fusion/surface_mesh/mesh_finish.h"
#include "depth_fusion/texturing/textured_mesh.h"
#include "ros/conversions/mesh_message.h"
#include "ros/output/textured_export.h"

namespace depth_fusion {
namespace {

namespace fs = std::filesystem;

// On devices that run one kernel at a time, mapping waits for one of a batch at most.
constexpr int kBatchBlocks = 512;

constexpr const char* kStartWithColor = "start with color:=true (map/color)";

// Passes a mesh on and counts it. An empty one is an Error that says `no_surface`.
class CountingSink final : public MeshSink {
 public:
  CountingSink(MeshSink& sink, const std::string& no_surface) : sink_(sink), no_surface_(no_surface) {}

  void begin(const MeshSize& size) override {
    check(size.triangles > 0, no_surface_);
    size_ = size;
    sink_.begin(size);
  }
  void addVertices(const MeshVertex* vertices, const MeshColor* colors, size_t count) override {
    sink_.addVertices(vertices, colors, count);
  }
  void addTriangles(const MeshTriangle* triangles, size_t count) override {
    sink_.addTriangles(triangles, count);
  }
  void finish() override { sink_.finish(); }

  const MeshSize& size() const { return size_; }

 private:
  MeshSink& sink_;
  const std::string no_surface_;
  MeshSize size_;
};

fs::path rosHome() {
  if (const char* ros_home = std::getenv("ROS_HOME")) return ros_home;
  const char* home = std::getenv("HOME");
  return fs::path(home == nullptr ? "/" : home) / ".ros";
}

// The length of a beginning that stands for somebody's home, as ~/ or ~name/; 0 without one.
size_t homeLength(const std::string& path) {
  if (path.front() != '~') return 0;
  const size_t length = std::min(path.find('/'), path.size());
  const auto is_of_name = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
  };
  const auto begin = path.begin();
  const bool is_home = std::all_of(begin + 1, begin + static_cast<std::ptrdiff_t>(length), is_of_name);
  return is_home ? std::min(length + 1, path.size()) : 0;
}

// As a shell does it: ~ at the beginning, and environment variables, whatever signs their values have. Throws
// Error for what no shell would take.
std::string expanded(const std::string& path) {
  wordexp_t words;
  const size_t home_end = homeLength(path);
  std::string quoted = path.substr(0, home_end) + '"';
  for (size_t i = home_end; i < path.size(); ++i) {
    const char next = i + 1 < path.size() ? path[i + 1] : ' ';
    const bool is_variable =
        std::isalpha(static_cast<unsigned char>(next)) != 0 || next == '_' || next == '{';
    if (std::strchr("\"\\`", path[i]) != nullptr || (path[i] == '$' && !is_variable)) quoted += '\\';
    quoted += path[i];
  }
  quoted += '"';
  const bool is_good = wordexp(quoted.c_str(), &words, WRDE_NOCMD | WRDE_UNDEF) == 0;
  const std::string result = is_good && words.we_wordc == 1 ? words.we_wordv[0] : "";
  if (is_good) wordfree(&words);
  check(!result.empty(), "the path " + path + " has a variable that is not set");
  return result;
}

// Throws Error for numbers that make no sense.
MeshFinish finishOf(const ExportMesh::Request& request) {
  const double share = request.simplification;
  check(share >= 0.0 && share <= 1.0,
        "simplification is the share of the triangles to keep, from 0 to 1 (0 or 1: all); it is " +
            std::to_string(share));
  const MeshFinish finish{request.min_island, request.max_hole, share == 0.0 ? 1.0 : share,
                          request.max_triangles, request.max_error};
  checkFinish(finish);
  return finish;
}

void checkFolder(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  check(fs::is_directory(folder),
        "the folder " + folder.string() + " does not exist; make it, or choose another path");
  check(!fs::is_directory(path), path + " is a folder; give the name of a file");
}

void sayProgress(double done) {
  ROS_INFO_STREAM_THROTTLE(2.0, "export_mesh: " << std::lround(100.0 * done) << " %");
}

// To a file, or to the message if that is not null.
class SurfaceExport {
 public:
  // Throws Error for a request that cannot be met.
  SurfaceExport(SharedMap& map, const ExportMesh::Request& request, const MeshExportParameters& parameters,
                const ExportProgress& progress, MeshGeometry* message)
      : map_(map),
        request_(request),
        parameters_(parameters),
        progress_(progress),
        finish_(finishOf(request)),
        lacks_color_(request.color && !map.has_color),
        no_surface_(std::string("the map has no surface yet; nothing was written") +
                    (lacks_color_ ? std::string("; it will have no colour: ") + kStartWithColor : "")) {
    check(!request.texture || map.has_color,
          std::string("the map keeps no pictures that a texture could be made of; ") + kStartWithColor);
    message == nullptr ? openFile() : openMessage(*message);
  }

  ExportMesh::Response run() {
    const auto [snapshot, generation] = map_.locked([this](FusedMap& fused) {
      check(!fused.isEmpty(), no_surface_);
      return std::make_pair(std::make_unique<WorldSnapshot>(fused.submaps()), fused.map().generation());
    });
    ExportMesh::Response response;
    response.success = true;
    const MeshSize size = request_.texture        ? writeTextured(*snapshot, generation)
                          : finish_.changesMesh() ? writeChanged(*snapshot)
                                                  : writeStreamed(*snapshot);
    if (lacks_color_) remark(std::string("without colour, for the map has none: ") + kStartWithColor);
    response.message = remarks_;
    response.vertices = size.vertices;
    response.triangles = size.triangles;
    response.bytes = path_.empty() ? 0 : fs::file_size(path_);
    return response;
  }

 private:
  void openFile() {
    check(!request_.path.empty(), "path is empty; give the mesh file's name, mesh.ply for instance");
    path_ = absolutePath(request_.path);
    checkFolder(path_);
    if (request_.texture)
      checkTexturedPath(path_, request_.format);
    else
      sink_ = createMeshFile(path_, request_.format, UpAxis::kZ);
    remark(path_);
  }

  void openMessage(MeshGeometry& message) {
    check(!request_.texture, "no message has a texture; give a path");
    message.header.stamp = ros::Time::now();
    message.header.frame_id = map_.frame_id;
    sink_ = std::make_unique<MeshMessageSink>(message);
  }

  void remark(const std::string& text) { remarks_ += (remarks_.empty() ? "" : "; ") + text; }

  // Who wants the export may give it up.
  void ask(double done) const {
    if (progress_) progress_(done);
  }

  void tell(double done) const {
    sayProgress(done);
    ask(done);
  }

  MeshSize writeStreamed(WorldSnapshot& snapshot) {
    CountingSink sink(*sink_, no_surface_);
    extract(snapshot, sink);
    return sink.size();
  }

  MeshSize writeChanged(WorldSnapshot& snapshot) {
    CountingSink sink(*sink_, no_surface_);
    sendMesh(finishedMesh(snapshot), sink);
    return sink.size();
  }

  MeshSize writeTextured(WorldSnapshot& snapshot, uint32_t generation) {
    const TexturedExport textured =
        exportTextured(path_, request_.format, finishedMesh(snapshot), map_.keyframesOf(generation),
                       parameters_.texturing, [this] { ask(1.0); });
    remark(textured.remark);
    return textured.size;
  }

  TriangleMesh finishedMesh(WorldSnapshot& snapshot) {
    TriangleMesh mesh;
    extract(snapshot, mesh);
    check(!mesh.triangles.empty(), no_surface_);
    FinishedMesh result = finished(std::move(mesh), finish_);
    tell(1.0);
    if (!result.remark.empty()) ROS_INFO_STREAM("export_mesh: " << result.remark);
    return std::move(result.mesh);
  }

  void extract(WorldSnapshot& snapshot, MeshSink& sink) {
    const std::unique_ptr<ComputeContext> queue = map_.compute->anotherQueue();
    SurfaceMeshParameters batches = parameters_.mesh;
    batches.max_batch_blocks = std::min(batches.max_batch_blocks, kBatchBlocks);
    exportWorldMesh(*queue, snapshot, sink, batches, request_.color || request_.texture,
                    [this](double done) { tell(done); });
  }

  SharedMap& map_;
  const ExportMesh::Request& request_;
  const MeshExportParameters& parameters_;
  const ExportProgress& progress_;
  const MeshFinish finish_;
  const bool lacks_color_;
  const std::string no_surface_;
  std::string path_, remarks_;      // the path is empty where a message is written
  std::unique_ptr<MeshSink> sink_;  // null: the texture's files
};

}  // namespace

std::string absolutePath(const std::string& path) {
  return fs::absolute(rosHome() / fs::path(expanded(path))).lexically_normal().string();
}

ExportMesh::Response exportMesh(SharedMap& map, const ExportMesh::Request& request,
                                const MeshExportParameters& parameters, const ExportProgress& progress,
                                MeshGeometry* message) {
  return SurfaceExport(map, request, parameters, progress, message).run();
}

}  // namespace depth_fusion
