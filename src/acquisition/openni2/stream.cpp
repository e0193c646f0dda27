#include "acquisition/openni2/stream.h"

#include <algorithm>
#include <opencv2/core.hpp>
#include <vector>

#include "acquisition/openni2/runtime.h"
#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

struct Format {
  ImageStream stream;
  openni::PixelFormat pixels;
  const char* encoding;
  int type;
  double depth_unit_m;
};

// The formats that each stream is wanted in, the best first.
constexpr Format kFormats[] = {
    {ImageStream::kDepth, openni::PIXEL_FORMAT_DEPTH_1_MM, "16UC1", CV_16UC1, 0.001},
    {ImageStream::kDepth, openni::PIXEL_FORMAT_DEPTH_100_UM, "16UC1", CV_16UC1, 0.0001},
    {ImageStream::kColor, openni::PIXEL_FORMAT_RGB888, "rgb8", CV_8UC3, 0.0},
    {ImageStream::kColor, openni::PIXEL_FORMAT_GRAY8, "mono8", CV_8UC1, 0.0},
    {ImageStream::kInfrared, openni::PIXEL_FORMAT_GRAY16, "mono16", CV_16UC1, 0.0},
    {ImageStream::kInfrared, openni::PIXEL_FORMAT_GRAY8, "mono8", CV_8UC1, 0.0},
    {ImageStream::kInfrared, openni::PIXEL_FORMAT_RGB888, "rgb8", CV_8UC3, 0.0}};

const Format* findFormat(ImageStream stream, openni::PixelFormat pixels) {
  const auto found = std::find_if(std::begin(kFormats), std::end(kFormats), [&](const Format& format) {
    return format.stream == stream && format.pixels == pixels;
  });
  return found == std::end(kFormats) ? nullptr : found;
}

VideoMode modeOf(const openni::VideoMode& mode) {
  return {mode.getResolutionX(), mode.getResolutionY(), mode.getFps()};
}

bool fits(const VideoMode& asked, const VideoMode& mode) {
  return asked.width == mode.width && asked.height == mode.height &&
         (asked.fps == 0 || asked.fps == mode.fps);
}

// The modes whose pixels can be read, the best format first.
std::vector<openni::VideoMode> readableModes(const openni::SensorInfo& sensor, ImageStream stream) {
  std::vector<openni::VideoMode> modes;
  for (int i = 0; i < sensor.getSupportedVideoModes().getSize(); ++i) {
    const openni::VideoMode& mode = sensor.getSupportedVideoModes()[i];
    if (findFormat(stream, mode.getPixelFormat()) != nullptr) modes.push_back(mode);
  }
  std::stable_sort(modes.begin(), modes.end(), [&](const openni::VideoMode& a, const openni::VideoMode& b) {
    return findFormat(stream, a.getPixelFormat()) < findFormat(stream, b.getPixelFormat());
  });
  return modes;
}

std::string listOf(const std::vector<openni::VideoMode>& modes) {
  std::vector<std::string> texts;
  for (const openni::VideoMode& mode : modes) {
    const std::string text = videoModeText(modeOf(mode));
    if (std::find(texts.begin(), texts.end(), text) == texts.end()) texts.push_back(text);
  }
  std::string list;
  for (const std::string& text : texts) list += (list.empty() ? "" : ", ") + text;
  return list.empty() ? "none whose pixels are known here" : list;
}

// Cameras that look at their user show him as a mirror does, unless told otherwise.
bool staysMirrored(openni::VideoStream& video) {
  return video.setMirroringEnabled(false) != openni::STATUS_OK && video.getMirroringEnabled();
}

}  // namespace

std::string streamName(ImageStream stream) {
  return stream == ImageStream::kDepth ? "depth" : stream == ImageStream::kColor ? "color" : "ir";
}

openni::SensorType sensorOf(ImageStream stream) {
  return stream == ImageStream::kDepth   ? openni::SENSOR_DEPTH
         : stream == ImageStream::kColor ? openni::SENSOR_COLOR
                                         : openni::SENSOR_IR;
}

OpenNi2Stream::OpenNi2Stream(openni::Device& device, ImageStream stream, const std::optional<VideoMode>& mode,
                             const std::string& device_name, std::unique_ptr<BufferAllocator> allocator)
    : kind_(stream), device_name_(device_name), allocator_(std::move(allocator)) {
  const std::string what = streamName(kind_);
  check(device.getSensorInfo(sensorOf(kind_)) != nullptr,
        device_name_ + " has no " + what + " images" +
            (kind_ == ImageStream::kDepth ? "" : "; set " + what + "_mode to off"));
  check(video_.create(device, sensorOf(kind_)) == openni::STATUS_OK,
        device_name_ + ": the " + what + " stream cannot be opened: " + openNi2Error());
  if (mode) setMode(device, *mode);
  mirrored_ = staysMirrored(video_);
  // Where it is refused, read() copies.
  video_.setFrameBuffersAllocator(allocator_.get());
}

OpenNi2Stream::~OpenNi2Stream() {
  video_.stop();
  video_.setFrameBuffersAllocator(nullptr);
  video_.destroy();
}

void OpenNi2Stream::setMode(openni::Device& device, const VideoMode& mode) {
  const auto modes = readableModes(*device.getSensorInfo(sensorOf(kind_)), kind_);
  const auto wanted =
      std::find_if(modes.begin(), modes.end(), [&](const auto& m) { return fits(mode, modeOf(m)); });
  const std::string parameter = streamName(kind_) + "_mode";
  check(wanted != modes.end(), device_name_ + " has no " + parameter + " " + videoModeText(mode) +
                                   "; set it to one of these: " + listOf(modes));
  check(
      video_.setVideoMode(*wanted) == openni::STATUS_OK,
      device_name_ + " refuses " + parameter + " " + videoModeText(modeOf(*wanted)) + ": " + openNi2Error());
}

void OpenNi2Stream::start() {
  check(video_.start() == openni::STATUS_OK,
        device_name_ + ": the " + streamName(kind_) + " stream does not start: " + openNi2Error());
}

DeviceImage OpenNi2Stream::read() {
  openni::VideoFrameRef frame;
  check(video_.readFrame(&frame) == openni::STATUS_OK,
        device_name_ + ": a " + streamName(kind_) + " image cannot be read: " + openNi2Error());
  const Format* format = findFormat(kind_, frame.getVideoMode().getPixelFormat());
  check(format != nullptr,
        device_name_ + ": the " + streamName(kind_) + " images have a pixel format that is not known here");
  DeviceImage image;
  image.stream = kind_;
  image.width = frame.getWidth();
  image.height = frame.getHeight();
  image.step = static_cast<size_t>(frame.getStrideInBytes());
  image.encoding = format->encoding;
  image.depth_unit_m = format->depth_unit_m;
  image.device_time_s = 1e-6 * static_cast<double>(frame.getTimestamp());
  image.missed = last_index_ < 0 ? 0 : std::max(frame.getFrameIndex() - last_index_ - 1, 0);
  last_index_ = frame.getFrameIndex();

  const auto* data = static_cast<const uint8_t*>(frame.getData());
  const size_t size = image.step * static_cast<size_t>(image.height);
  check(frame.getDataSize() >= static_cast<int>(size),
        device_name_ + ": a " + streamName(kind_) + " image is cut short");
  auto own = allocator_->buffers().take(data);
  image.pixels = own ? std::move(*own) : std::vector<uint8_t>(data, data + size);
  image.pixels.resize(size);
  if (mirrored_) {
    cv::Mat pixels(image.height, image.width, format->type, image.pixels.data(), image.step);
    cv::flip(pixels, pixels, 1);
  }
  return image;
}

}  // namespace depth_fusion
