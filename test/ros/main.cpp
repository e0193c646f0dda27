// The main function of every test program that runs against a ROS master.
#include <gtest/gtest.h>
#include <ros/ros.h>

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test");
  const ros::NodeHandle handle;  // the node lives as long as it does
  return RUN_ALL_TESTS();
}
