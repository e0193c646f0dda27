// The end of timers' and services' callbacks.
#pragma once

#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include <boost/function.hpp>
#include <boost/shared_ptr.hpp>
#include <future>
#include <string>

namespace depth_fusion {

// Makes timers and services whose callbacks it can wait for. ros::WallTimer::stop() and
// ros::ServiceServer::shutdown() return while a callback of theirs is at work (ros_comm, issue 2283), so that
// whoever owns them cannot be destroyed safely after them alone; ros::Subscriber::shutdown() waits.
class CallbackGate {
 public:
  CallbackGate();
  ~CallbackGate() { close(); }
  CallbackGate(const CallbackGate&) = delete;
  CallbackGate& operator=(const CallbackGate&) = delete;

  // Both as the node handle does it.
  ros::WallTimer createWallTimer(const ros::NodeHandle& handle, ros::WallDuration period,
                                 const ros::WallTimerCallback& callback) const;
  template <class Request, class Response>
  ros::ServiceServer advertiseService(ros::NodeHandle& handle, const std::string& name,
                                      const boost::function<bool(Request&, Response&)>& serve) const {
    return handle.advertiseService(name, serve, token_);
  }

  // What roscpp is to hold during a callback of another kind: its tracked object.
  ros::VoidConstPtr token() const { return token_; }

  // Waits for the callbacks at work; none begins afterwards. Must not be called from one of them.
  void close();

 private:
  boost::shared_ptr<std::promise<void>> token_;  // roscpp holds it, too, during a callback
  std::future<void> released_;
};

}  // namespace depth_fusion
