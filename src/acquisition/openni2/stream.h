// One stream of an OpenNI2 device.
#pragma once

#include <OpenNI.h>

#include <memory>
#include <optional>
#include <string>

#include "acquisition/video_mode.h"
#include "depth_fusion/acquisition/rgbd_device.h"

namespace depth_fusion {

// Lets OpenNI2 write into FrameBuffers. It is called in the driver's thread, as long as OpenNI2 has a frame
// of the stream.
class BufferAllocator : public openni::VideoStream::FrameAllocator {
 public:
  explicit BufferAllocator(std::shared_ptr<FrameBuffers> buffers) : buffers_(std::move(buffers)) {}
  void* allocateFrameBuffer(int size) override { return buffers_->allocate(static_cast<size_t>(size)); }
  void freeFrameBuffer(void* data) override { buffers_->release(static_cast<const uint8_t*>(data)); }

  FrameBuffers& buffers() const { return *buffers_; }

 private:
  std::shared_ptr<FrameBuffers> buffers_;
};

std::string streamName(ImageStream stream);
openni::SensorType sensorOf(ImageStream stream);

class OpenNi2Stream {
 public:
  // Opens the stream in the mode that it has, unless one is given. Throws Error, which begins with
  // `device_name`, for a stream or a mode that the device lacks, naming those that it has.
  OpenNi2Stream(openni::Device& device, ImageStream stream, const std::optional<VideoMode>& mode,
                const std::string& device_name, std::unique_ptr<BufferAllocator> allocator);
  ~OpenNi2Stream();

  void start();

  // The frame that has come; its pixels are OpenNI2's own memory.
  DeviceImage read();

  ImageStream kind() const { return kind_; }
  openni::VideoStream& video() { return video_; }
  const openni::VideoStream& video() const { return video_; }

 private:
  void setMode(openni::Device& device, const VideoMode& mode);

  ImageStream kind_;
  std::string device_name_;
  std::unique_ptr<BufferAllocator> allocator_;
  openni::VideoStream video_;
  bool mirrored_ = false;
  int last_index_ = -1;
};

}  // namespace depth_fusion
