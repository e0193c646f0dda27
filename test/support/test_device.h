// The simulated device of test/openni2/driver, plugged into OpenNI2 as long as this lives.
#pragma once

#include <OpenNI.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <thread>

#include "acquisition/openni2/openni2_thread.h"
#include "acquisition/openni2/runtime.h"
#include "depth_fusion/acquisition/rgbd_device.h"
#include "depth_fusion/recording/recording_writer.h"
#include "openni2/driver/control.h"
#include "support/temporary_folder.h"

namespace depth_fusion {

class TestDevice {
 public:
  // Shows the frames, which are of the same size.
  explicit TestDevice(const std::vector<RgbdFrame>& frames) {
    const auto writer = createTumFolder(folder_ / "recording");
    for (const RgbdFrame& frame : frames) writer->write(frame);
    writer->finish();
    mode_ = sizeText(frames.front().depth.cols, frames.front().depth.rows) + "@30";
    apply();
    setenv(kTestDeviceVariable, folder_.path().c_str(), 1);
  }
  ~TestDevice() { unsetenv(kTestDeviceVariable); }

  // A change takes effect at the next call of apply().
  DeviceControl control;
  void apply() const { writeControl(folder_.path(), control); }

  // Returns the only video mode that the device has.
  const std::string& mode() const { return mode_; }
  DeviceParameters parameters() const {
    DeviceParameters parameters;
    parameters.depth_mode = parameters.color_mode = mode_;
    return parameters;
  }

  // Returns what the driver was told last: "auto_exposure auto_white_balance exposure gain".
  std::string settings() const {
    std::string line;
    std::ifstream file(settingsPath(folder_.path()));
    std::getline(file, line);
    return line;
  }

  // Records all the frames from the first on, by OpenNI2's own recorder; colour begins later than depth. It
  // works once a process, for its thread calls OpenNI2 and ends (see inOpenNi2Thread).
  void recordOni(const std::string& path, int frames) {
    inOpenNi2Thread([&] {
      const OpenNi2Runtime runtime;
      record(path, frames);
    });
  }

 private:
  void record(const std::string& path, int frames) {
    openni::Device device;
    openni::VideoStream depth, color;
    openni::Recorder recorder;
    ASSERT_EQ(device.open(openni::ANY_DEVICE), openni::STATUS_OK);
    ASSERT_EQ(depth.create(device, openni::SENSOR_DEPTH), openni::STATUS_OK);
    ASSERT_EQ(color.create(device, openni::SENSOR_COLOR), openni::STATUS_OK);
    ASSERT_EQ(recorder.create(path.c_str()), openni::STATUS_OK);
    ASSERT_EQ(recorder.attach(depth), openni::STATUS_OK);
    ASSERT_EQ(recorder.attach(color), openni::STATUS_OK);
    ASSERT_EQ(recorder.start(), openni::STATUS_OK);
    ASSERT_EQ(depth.start(), openni::STATUS_OK);
    await(depth, 3);
    ASSERT_EQ(color.start(), openni::STATUS_OK);
    await(depth, 5);  // while the camera stands
    control.at = frames - 1;
    apply();
    await(depth, frames + 5);
    recorder.stop();
    recorder.destroy();
  }

  static void await(openni::VideoStream& stream, int frames) {
    openni::VideoFrameRef frame;
    for (int i = 0; i < frames; ++i) ASSERT_EQ(stream.readFrame(&frame), openni::STATUS_OK);
  }

  const TemporaryFolder folder_;
  std::string mode_;
};

}  // namespace depth_fusion
