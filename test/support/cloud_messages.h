// Frames as drivers of RGB-D cameras publish them as clouds.
#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <boost/make_shared.hpp>
#include <cstring>
#include <limits>

#include "depth_fusion/frames/rgbd_frame.h"

namespace depth_fusion {

inline void addField(sensor_msgs::PointCloud2& cloud, const std::string& name, uint32_t offset) {
  sensor_msgs::PointField field;
  field.name = name;
  field.offset = offset;
  field.datatype = sensor_msgs::PointField::FLOAT32;
  field.count = 1;
  cloud.fields.push_back(field);
}

// Organised, with colour, and with some bytes more in each point and row than its fields take.
inline sensor_msgs::PointCloud2Ptr cloudOf(const std_msgs::Header& header, const RgbdFrame& frame) {
  const auto cloud = boost::make_shared<sensor_msgs::PointCloud2>();
  cloud->header = header;
  cloud->width = static_cast<uint32_t>(frame.depth.cols);
  cloud->height = static_cast<uint32_t>(frame.depth.rows);
  addField(*cloud, "x", 0);
  addField(*cloud, "y", 4);
  addField(*cloud, "z", 8);
  addField(*cloud, "rgb", 16);
  cloud->point_step = 32;
  cloud->row_step = 32 * cloud->width + 8;
  cloud->data.resize(static_cast<size_t>(cloud->row_step) * cloud->height);
  cv::Mat depth;
  frame.depth.convertTo(depth, CV_32F, frame.depth_unit_m);
  const CameraIntrinsics& camera = frame.intrinsics;
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      const float d = depth.at<float>(y, x);
      const float z = d > 0.0f ? d : std::numeric_limits<float>::quiet_NaN();
      const float point[3] = {z * static_cast<float>((x - camera.cx) / camera.fx),
                              z * static_cast<float>((y - camera.cy) / camera.fy), z};
      uint8_t* out =
          cloud->data.data() + static_cast<size_t>(cloud->row_step) * static_cast<size_t>(y) + 32 * x;
      std::memcpy(out, point, sizeof(point));
      if (!frame.color.empty()) std::memcpy(out + 16, frame.color.ptr(y, x), 3);
    }
  }
  return cloud;
}

// Puts the same points in one row, as lidars and time-of-flight cameras publish them.
inline sensor_msgs::PointCloud2Ptr asList(const sensor_msgs::PointCloud2& organised) {
  const auto list = boost::make_shared<sensor_msgs::PointCloud2>(organised);
  list->data.clear();
  for (uint32_t row = 0; row < organised.height; ++row) {
    const auto begin = organised.data.begin() + static_cast<std::ptrdiff_t>(row * organised.row_step);
    list->data.insert(list->data.end(), begin, begin + 32 * organised.width);
  }
  list->width = organised.width * organised.height;
  list->height = 1;
  list->row_step = 32 * list->width;
  return list;
}

}  // namespace depth_fusion
