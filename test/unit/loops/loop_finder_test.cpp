#include "depth_fusion/loops/loop_finder.h"

#include <gtest/gtest.h>

#include <random>

namespace depth_fusion {
namespace {

FrameFeatures madeUp(std::mt19937_64& random, size_t count = 300) {
  FrameFeatures features;
  features.features.resize(count);
  for (Feature& feature : features.features) {
    for (uint64_t& bits : feature.descriptor) bits = random();
  }
  return features;
}

// As the place looks when it is seen again: a part of the features, with some bits that differ.
FrameFeatures seenAgain(FrameFeatures features, std::mt19937_64& random, double part, double flipped) {
  std::bernoulli_distribution is_there(part), differs(flipped);
  for (Feature& feature : features.features) {
    const bool there = is_there(random);
    for (uint64_t& bits : feature.descriptor) {
      if (!there) bits = random();
      for (int i = 0; i < 64; ++i) bits ^= static_cast<uint64_t>(differs(random)) << i;
    }
  }
  return features;
}

const auto kAll = [](uint32_t) { return true; };

TEST(LoopFinder, FindsWhatIsSeenAgainAmongHundreds) {
  std::mt19937_64 random(1);
  LoopFinder finder(300);
  std::vector<FrameFeatures> places;
  for (uint32_t i = 0; i < 500; ++i) {
    places.push_back(madeUp(random));
    finder.add(i, places.back());
  }
  for (uint32_t i = 0; i < 500; i += 50) {
    const auto found = finder.find(seenAgain(places[i], random, 0.4, 0.1), kAll, 3);
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].number, i);
    EXPECT_TRUE(found.size() < 2 || found[1].likeness < found[0].likeness);
  }
}

TEST(LoopFinder, LooksOnlyAtThoseThatCount) {
  std::mt19937_64 random(2);
  LoopFinder finder(100);
  const FrameFeatures place = madeUp(random);
  for (uint32_t i = 0; i < 4; ++i) finder.add(i, seenAgain(place, random, 0.8, 0.05));
  const auto found = finder.find(
      place, [](uint32_t number) { return number == 1 || number == 2; }, 5);
  ASSERT_EQ(found.size(), 2u);
  for (const AlikeKeyframe& alike : found) EXPECT_TRUE(alike.number == 1 || alike.number == 2);
}

TEST(LoopFinder, KnowsNothingOfKeyframesWithoutFeatures) {
  std::mt19937_64 random(3);
  LoopFinder finder(100);
  EXPECT_TRUE(finder.find(madeUp(random), kAll, 5).empty());
  finder.add(0, FrameFeatures());
  EXPECT_TRUE(finder.find(madeUp(random), kAll, 5).empty());
  EXPECT_TRUE(finder.find(FrameFeatures(), kAll, 5).empty());
}

TEST(LoopFinder, AWordThatMostKeyframesHaveSaysNothing) {
  std::mt19937_64 random(4);
  LoopFinder finder(300);
  const FrameFeatures everywhere = madeUp(random, 100);
  FrameFeatures rare = madeUp(random, 20);
  for (uint32_t i = 0; i < 60; ++i) {
    FrameFeatures features = everywhere;
    if (i == 30)
      features.features.insert(features.features.end(), rare.features.begin(), rare.features.end());
    finder.add(i, features);
  }
  FrameFeatures now = everywhere;
  now.features.insert(now.features.end(), rare.features.begin(), rare.features.end());
  const auto found = finder.find(now, kAll, 5);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].number, 30u);
}

}  // namespace
}  // namespace depth_fusion
