#include "surface_mesh/stl_writer.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstring>
#include <limits>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

constexpr size_t kTitleBytes = 80;
constexpr uint64_t kHeaderBytes = kTitleBytes + sizeof(uint32_t);
constexpr size_t kPositionBytes = 3 * sizeof(float);
constexpr size_t kFacetBytes = 4 * kPositionBytes + sizeof(uint16_t);
constexpr size_t kFacetsPerWrite = 16384;

uint64_t facetOffset(uint64_t facet) { return kHeaderBytes + facet * kFacetBytes; }

// Replaces the three numbers of vertices that the facet begins with by its normal and its corners.
void resolveFacet(unsigned char* facet, const unsigned char* positions) {
  MeshTriangle triangle;
  std::memcpy(triangle.data(), facet, sizeof(triangle));
  Eigen::Vector3f corners[3];
  for (int i = 0; i < 3; ++i) {
    std::memcpy(corners[i].data(), positions + triangle[i] * uint64_t{kPositionBytes}, kPositionBytes);
    std::memcpy(facet + (i + 1) * kPositionBytes, corners[i].data(), kPositionBytes);
  }
  const Eigen::Vector3f normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).stableNormalized();
  std::memcpy(facet, normal.data(), kPositionBytes);
}

}  // namespace

void StlWriter::begin(const MeshSize& size) {
  check(size.triangles <= std::numeric_limits<uint32_t>::max(),
        "an STL file holds 4294967295 triangles, the mesh has " + std::to_string(size.triangles) +
            "; use ply or fewer triangles");
  size_ = size;
  unsigned char header[kHeaderBytes] = "depth_fusion, metres";
  const uint32_t triangles = static_cast<uint32_t>(size.triangles);
  std::memcpy(header + kTitleBytes, &triangles, sizeof(triangles));
  file_.writeAt(0, header, sizeof(header));
  facet_offset_ = facetOffset(0);
  position_offset_ = facetOffset(size.triangles);
}

void StlWriter::addVertices(const MeshVertex* vertices, const MeshColor*, size_t count) {
  std::vector<Eigen::Vector3f> positions(count);
  std::transform(vertices, vertices + count, positions.begin(),
                 [](const MeshVertex& v) { return v.position_W; });
  file_.writeAt(position_offset_, positions.data(), count * kPositionBytes);
  position_offset_ += count * kPositionBytes;
}

void StlWriter::addTriangles(const MeshTriangle* triangles, size_t count) {
  std::vector<unsigned char> facets(count * kFacetBytes);
  for (size_t i = 0; i < count; ++i)
    std::memcpy(&facets[i * kFacetBytes], &triangles[i], sizeof(MeshTriangle));
  file_.writeAt(facet_offset_, facets.data(), facets.size());
  facet_offset_ += facets.size();
}

void StlWriter::finish() {
  const uint64_t end = facetOffset(size_.triangles);
  const unsigned char* bytes = file_.view(end + size_.vertices * kPositionBytes);
  std::vector<unsigned char> facets;
  for (uint64_t offset = facetOffset(0); offset < end; offset += facets.size()) {
    const uint64_t count = std::min<uint64_t>(end - offset, kFacetsPerWrite * kFacetBytes);
    facets.assign(bytes + offset, bytes + offset + count);
    for (size_t i = 0; i < facets.size(); i += kFacetBytes) resolveFacet(&facets[i], bytes + end);
    file_.writeAt(offset, facets.data(), facets.size());
  }
  file_.cutTo(end);
  file_.commit();
}

}  // namespace depth_fusion
