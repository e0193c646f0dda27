#include "texturing/view_labelling.h"

#include <gtest/gtest.h>

namespace depth_fusion {
namespace {

// A strip of faces, each beside the next.
FaceNeighbours strip(uint32_t count) {
  FaceNeighbours neighbours(count, {kNoFace, kNoFace, kNoFace});
  for (uint32_t i = 0; i + 1 < count; ++i) {
    neighbours[i][1] = i + 1;
    neighbours[i + 1][0] = i;
  }
  return neighbours;
}

FaceViews viewsWith(std::vector<std::pair<uint16_t, float>> qualities) {
  std::stable_sort(qualities.begin(), qualities.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  FaceViews views;
  for (size_t i = 0; i < qualities.size(); ++i) views[i] = {qualities[i].first, {}, qualities[i].second};
  return views;
}

// View 7 is better on the left, view 9 on the right; in the middle one face, and then another, sees it
// otherwise.
std::vector<FaceViews> twoSides() {
  std::vector<FaceViews> faces;
  for (int i = 0; i < 20; ++i) {
    const bool left = i < 10 ? i != 4 : i == 14;
    faces.push_back(viewsWith({{7, left ? 1.0f : 0.8f}, {9, left ? 0.6f : 1.0f}}));
  }
  return faces;
}

size_t seamsOf(const std::vector<uint16_t>& labels) {
  size_t seams = 0;
  for (size_t i = 1; i < labels.size(); ++i) seams += labels[i] != labels[i - 1];
  return seams;
}

TEST(ViewLabelling, eachFaceHasItsBestViewIfSeamsCostNothing) {
  const std::vector<uint16_t> labels = labelFaces(twoSides(), strip(20), 0.0f);
  for (size_t i = 0; i < labels.size(); ++i) EXPECT_EQ(labels[i], twoSides()[i][0].view);
}

TEST(ViewLabelling, seamsThatCostMoreThanTheyBringGo) {
  const std::vector<uint16_t> labels = labelFaces(twoSides(), strip(20), 0.3f);
  EXPECT_EQ(seamsOf(labels), 1u);
  EXPECT_EQ(labels[4], 7);
  EXPECT_EQ(labels[14], 9);
  EXPECT_EQ(labels[9], 7);
  EXPECT_EQ(labels[10], 9);
}

TEST(ViewLabelling, costlySeamsLeaveTheViewThatIsBetterInAll) {
  EXPECT_EQ(seamsOf(labelFaces(twoSides(), strip(20), 100.0f)), 0u);
  EXPECT_EQ(labelFaces(twoSides(), strip(20), 100.0f)[0], 7);  // lacks 0.2 ten times; the other 0.4
}

TEST(ViewLabelling, aFaceThatNoViewShowsHasNone) {
  std::vector<FaceViews> faces = twoSides();
  faces[5] = {};
  const std::vector<uint16_t> labels = labelFaces(faces, strip(20), 0.3f);
  EXPECT_EQ(labels[5], kNoView);
  EXPECT_EQ(labels[6], 7);
}

TEST(FaceViews, colorsFarFromTheOthersAreRemoved) {
  FaceViews views = viewsWith({{1, 5.0f}, {2, 4.0f}, {3, 3.0f}, {4, 2.0f}});
  for (int i = 0; i < 4; ++i) views[i].color = {100, static_cast<uint8_t>(120 + 3 * i), 90};
  std::vector<FaceViews> faces = {views};
  EXPECT_EQ(removeOutliers(faces, 30.0), 0u);
  faces[0][0].color = {100, 120, 180};
  EXPECT_EQ(removeOutliers(faces, 30.0), 1u);
  EXPECT_EQ(faces[0][0].view, 2);
  EXPECT_EQ(countOf(faces[0]), 3);
  FaceViews two = viewsWith({{1, 5.0f}, {2, 4.0f}});  // who of the two is right, nothing says
  two[0].color = {255, 255, 255};
  faces = {two};
  EXPECT_EQ(removeOutliers(faces, 30.0), 0u);
}

TEST(FaceNeighbours, edgesOfTwoFacesJoinThem) {
  const FaceNeighbours neighbours = neighboursOf({{0, 1, 2}, {1, 3, 2}, {4, 5, 6}});
  EXPECT_EQ(neighbours[0], (std::array<uint32_t, 3>{kNoFace, 1, kNoFace}));
  EXPECT_EQ(neighbours[1], (std::array<uint32_t, 3>{kNoFace, kNoFace, 0}));
  EXPECT_EQ(neighbours[2], (std::array<uint32_t, 3>{kNoFace, kNoFace, kNoFace}));
  const FaceNeighbours three = neighboursOf({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  EXPECT_EQ(three[0][0], kNoFace);
}

}  // namespace
}  // namespace depth_fusion
