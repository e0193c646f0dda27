#include "ros/conversions/imu_conversion.h"

namespace depth_fusion {
namespace {

constexpr double kNotMeasured = -1.0;  // in the first element of a covariance

std::optional<Eigen::Vector3d> measured(const geometry_msgs::Vector3& vector, double first_covariance,
                                        const Eigen::Matrix3d& R_D_I) {
  const Eigen::Vector3d v_I(vector.x, vector.y, vector.z);
  if (first_covariance == kNotMeasured || !v_I.allFinite()) return std::nullopt;
  return Eigen::Vector3d(R_D_I * v_I);
}

geometry_msgs::Vector3 toMessage(const Eigen::Vector3d& vector) {
  geometry_msgs::Vector3 message;
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
  return message;
}

}  // namespace

ImuReading toReading(const sensor_msgs::Imu& message, const Eigen::Matrix3d& R_D_I) {
  ImuReading reading;
  reading.stamp_s = message.header.stamp.toSec();
  reading.angular_velocity_D =
      measured(message.angular_velocity, message.angular_velocity_covariance[0], R_D_I);
  reading.specific_force_D =
      measured(message.linear_acceleration, message.linear_acceleration_covariance[0], R_D_I);
  if (reading.specific_force_D && reading.specific_force_D->isZero()) reading.specific_force_D.reset();
  return reading;
}

sensor_msgs::Imu makeImu(const std_msgs::Header& header, const ImuReading& reading,
                         const Eigen::Matrix3d& R_I_D) {
  sensor_msgs::Imu message;
  message.header = header;
  message.orientation.w = 1.0;
  message.orientation_covariance[0] = kNotMeasured;
  if (reading.angular_velocity_D) {
    message.angular_velocity = toMessage(R_I_D * *reading.angular_velocity_D);
  } else {
    message.angular_velocity_covariance[0] = kNotMeasured;
  }
  if (reading.specific_force_D) {
    message.linear_acceleration = toMessage(R_I_D * *reading.specific_force_D);
  } else {
    message.linear_acceleration_covariance[0] = kNotMeasured;
  }
  return message;
}

}  // namespace depth_fusion
