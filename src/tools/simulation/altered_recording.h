// Recordings made harder, for benchmarks and tests.
#pragma once

#include <functional>
#include <memory>

#include "depth_fusion/geometry/pose.h"
#include "depth_fusion/preprocessing/preprocessing_parameters.h"
#include "depth_fusion/recording/recording.h"

namespace depth_fusion {

using OpenRecording = std::function<std::unique_ptr<Recording>()>;

// Gives the frames 0, n, 2n, ...
std::unique_ptr<Recording> everyNth(std::unique_ptr<Recording> recording, size_t n);

// Drops up to max_gap - 1 frames after each, by chance.
std::unique_ptr<Recording> irregular(std::unique_ptr<Recording> recording, size_t max_gap, unsigned seed);

// Makes `count` frames from the given one on black; their depth stays.
std::unique_ptr<Recording> lightsOff(std::unique_ptr<Recording> recording, size_t first, size_t count);

// Adds white noise to the depth: the sensor's axial sigma, and what is out of range has none.
std::unique_ptr<Recording> withNoise(std::unique_ptr<Recording> recording,
                                     const DepthSensorParameters& sensor, const DepthRange& range,
                                     unsigned seed);

struct Interruption {
  size_t black_frames = 30;      // without depth and light, 1/30 s apart
  size_t repeated_frames = 100;  // from the recording's start
};
constexpr double kRepeatedLater_s = 1000.0;

// The whole recording, then black frames, then a jump back to its start, kRepeatedLater_s later.
std::unique_ptr<Recording> interrupted(const OpenRecording& open, const Interruption& interruption);

// Gives the poses of an interrupted recording.
Trajectory repeated(const Trajectory& trajectory);

}  // namespace depth_fusion
