// A viewer that can be made to stall.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>

namespace depth_fusion {

// A viewer in a process of its own, which can be made to stall. It passes on whatever it gets, for its own
// queue has no end.
class OtherViewer {
 public:
  OtherViewer(const std::string& topic, const std::string& passed_on) : process_(fork()) {
    if (process_ != 0) return;
    constexpr char kScript[] = R"(
import socket, sys, rospy
class SmallSocket(socket.socket):
    def __init__(self, *args, **kwargs):
        super().__init__(*args, **kwargs)
        self.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 16)
socket.socket = SmallSocket
publisher = None
def pass_on(message):
    global publisher
    if publisher is None:
        header = message._connection_header
        raw = type('Raw', (rospy.AnyMsg,), {'_type': header['type'], '_md5sum': header['md5sum'],
                                            '_full_text': header['message_definition']})
        publisher = rospy.Publisher(sys.argv[2], raw, queue_size=10000)
        while publisher.get_num_connections() == 0:
            rospy.rostime.wallsleep(0.01)
    copy = publisher.data_class()
    copy._buff = message._buff
    publisher.publish(copy)
rospy.init_node('other_viewer', anonymous=True)
rospy.Subscriber(sys.argv[1], rospy.AnyMsg, pass_on, queue_size=None, buff_size=1 << 24)
rospy.spin()
)";
    execlp("python3", "python3", "-c", kScript, topic.c_str(), passed_on.c_str(), nullptr);
    _exit(1);
  }
  ~OtherViewer() {
    goOn();
    kill(process_, SIGTERM);
    waitpid(process_, nullptr, 0);
  }

  void stall() { kill(process_, SIGSTOP); }
  void goOn() { kill(process_, SIGCONT); }

 private:
  pid_t process_;
};

}  // namespace depth_fusion
