// BRIEF (Calonder et al. 2012), upright: between frames the camera hardly rolls.
#pragma once

#include "depth_fusion/frames/frame_features.h"

namespace depth_fusion {

// A descriptor reads so many pixels to each side of its feature.
constexpr int kBriefRadius_px = 15;

BriefDescriptor describe(const cv::Mat& smoothed, cv::Point pixel);

// Counts the comparisons that differ.
int hammingDistance(const BriefDescriptor& a, const BriefDescriptor& b);

}  // namespace depth_fusion
