// A second publisher of images.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>

namespace depth_fusion {

// Another node, that publishes images of one pixel on a topic until it is destroyed.
class OtherCamera {
 public:
  explicit OtherCamera(const std::string& topic) : process_(fork()) {
    if (process_ != 0) return;
    execlp("rostopic", "rostopic", "pub", "-s", "-r", "20", topic.c_str(), "sensor_msgs/Image",
           "{header: {stamp: {secs: 7}}, height: 1, width: 1, encoding: 16UC1, step: 2, data: [1, 1]}",
           nullptr);
    _exit(1);
  }
  ~OtherCamera() {
    kill(process_, SIGINT);
    waitpid(process_, nullptr, 0);
  }

 private:
  pid_t process_;
};

}  // namespace depth_fusion
