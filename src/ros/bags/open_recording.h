// Recordings of any kind, bags included.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "depth_fusion/recording/recording.h"
#include "depth_fusion/recording/recording_writer.h"

namespace depth_fusion {

bool endsWith(const std::string& path, const std::string& ending);

// A bag of ROS 1 or an .oni file, both whatever they are called, or a folder as openFolder takes it. Throws
// Error for anything else.
std::unique_ptr<Recording> openRecording(const std::string& path, const RecordingOptions& options);
// One of these, or several bags that are the parts of one. Throws Error for several of anything else.
std::unique_ptr<Recording> openRecordings(const std::vector<std::string>& paths,
                                          const RecordingOptions& options);
// The paths in one line, for messages.
std::string namesOf(const std::vector<std::string>& paths);

// Reads a bag: depth as sensor_msgs/Image (16UC1, mono16, 32FC1) or CompressedImage (compressedDepth png),
// colour as Image (whatever colorFromImage takes) or CompressedImage (jpeg, png), intrinsics from the
// CameraInfo beside the depth topic; the layout of RealSense Viewer, too. Stamps that jump are made to go on;
// next() throws Error for a depth image that is out of order or cannot be used. What is wrong with colour
// leaves it out. Throws Error naming the topics of the bag if no depth topic or no camera_info is found.
std::unique_ptr<Recording> openBag(const std::string& path, const RecordingOptions& options);
std::unique_ptr<Recording> openBags(const std::vector<std::string>& paths, const RecordingOptions& options);

// A bag with the topics of openni2_launch: /camera/depth_registered/image_raw (16UC1, mm) and
// /camera/rgb/image_raw (bgr8 or mono8), their camera_info, and the reference pose of the depth camera on /tf
// (world -> camera_rgb_optical_frame). Frames with readings of a robot have its tree on tf (odom -> base_link
// -> camera_rgb_optical_frame, imu_link), /imu/data, and the reference pose as /ground_truth. Throws Error if
// there is a file of that name.
std::unique_ptr<RecordingWriter> createBag(const std::string& path);

}  // namespace depth_fusion
