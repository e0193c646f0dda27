#include "acquisition/openni2/runtime.h"

#include <algorithm>
#include <mutex>
#include <regex>
#include <vector>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

std::mutex& initialisation() {
  static std::mutex mutex;
  return mutex;
}

struct Entry {
  std::string uri, name;
};

std::vector<Entry> pluggedDevices() {
  openni::Array<openni::DeviceInfo> list;
  openni::OpenNI::enumerateDevices(&list);
  std::vector<Entry> entries;
  for (int i = 0; i < list.getSize(); ++i)
    entries.push_back({list[i].getUri(), std::string(list[i].getVendor()) + " " + list[i].getName()});
  return entries;
}

// Empty if it has none, or cannot be opened.
std::string serialAt(const std::string& uri) {
  openni::Device device;
  return device.open(uri.c_str()) == openni::STATUS_OK ? serialOf(device) : "";
}

std::string describe(const std::vector<Entry>& entries) {
  if (entries.empty())
    return "OpenNI2 sees none: plug one in; if one is plugged in, see that its user may open it (udev rules "
           "of libopenni2-0)";
  std::string text = "there are";
  for (size_t i = 0; i < entries.size(); ++i) {
    const std::string serial = serialAt(entries[i].uri);
    text += (i == 0 ? " #" : ", #") + std::to_string(i + 1) + " " + entries[i].name + " (" + entries[i].uri +
            (serial.empty() ? "" : ", serial number " + serial) + ")";
  }
  return text;
}

// A URI of the USB drivers ends in @bus/address.
bool isAt(const std::string& uri, const std::string& bus, const std::string& address) {
  std::smatch place;
  if (!std::regex_search(uri, place, std::regex("@0*(\\d+)/0*(\\d+)$"))) return false;
  return place[1] == bus && (address == "0" || place[2] == address);
}

bool isMeant(const std::vector<Entry>& entries, size_t index, const std::string& device_id) {
  std::smatch parts;
  if (device_id.empty()) return true;
  if (device_id[0] == '#') return device_id == "#" + std::to_string(index + 1);
  if (device_id == entries[index].uri) return true;
  if (std::regex_match(device_id, parts, std::regex("0*(\\d+)@0*(\\d+)")))
    return isAt(entries[index].uri, parts[1], parts[2]);
  return device_id == serialAt(entries[index].uri);
}

}  // namespace

OpenNi2Runtime::OpenNi2Runtime() {
  const std::lock_guard<std::mutex> lock(initialisation());
  if (openni::OpenNI::initialize() == openni::STATUS_OK) return;
  const std::string reason = openNi2Error();
  openni::OpenNI::shutdown();  // it counts the calls, this one too
  throw Error("OpenNI2 does not start: " + reason);
}

OpenNi2Runtime::~OpenNi2Runtime() {
  const std::lock_guard<std::mutex> lock(initialisation());
  openni::OpenNI::shutdown();
}

std::string openNi2Error() {
  std::string text = openni::OpenNI::getExtendedError();
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\t'; }, ' ');
  text.erase(text.find_last_not_of(' ') + 1);
  return text.empty() ? "no reason given" : text;
}

bool isPlugged(const std::string& uri) {
  const std::vector<Entry> entries = pluggedDevices();
  return std::any_of(entries.begin(), entries.end(), [&](const Entry& entry) { return entry.uri == uri; });
}

std::string findDevice(const std::string& device_id) {
  const std::vector<Entry> entries = pluggedDevices();
  for (size_t i = 0; i < entries.size(); ++i) {
    if (isMeant(entries, i, device_id)) return entries[i].uri;
  }
  throw Error("no camera " + (device_id.empty() ? "#1" : device_id) + ": " + describe(entries));
}

std::string serialOf(openni::Device& device) {
  char serial[256] = {};
  int size = sizeof(serial) - 1;
  if (device.getProperty(openni::DEVICE_PROPERTY_SERIAL_NUMBER, serial, &size) != openni::STATUS_OK)
    return {};
  return serial;
}

}  // namespace depth_fusion
