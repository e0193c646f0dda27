// Parameters that change while a nodelet runs, by dynamic_reconfigure's protocol, from the parameter tables.
#pragma once

#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/node_handle.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ros/callbacks/callback_gate.h"
#include "ros/parameters/reconfigure_messages.h"

namespace depth_fusion {

// What is refused (an unknown name, a value out of range, a parameter that is at_start_only, values that do
// not fit together) is warned of, and stands in the answer as it was. Nodelets of one process that have a
// stage's group in common have one value of it.
class ReconfigureServer {
 public:
  using Action = std::function<void()>;
  struct Nodelet {
    std::string name;
    // Runs the action between two frames, and returns when it is done.
    std::function<void(const Action&)> between_frames;
    // Takes over what the rows say. Throws Error if that does not fit together.
    Action apply;
  };

  // Topics and service stand in the namespace of the first group, which holds the nodelet's own rows.
  ReconfigureServer(std::vector<ParameterGroup> groups, const dynamic_reconfigure::Config& defaults,
                    Nodelet nodelet);
  // Waits for a change in progress.
  ~ReconfigureServer();

 private:
  bool serve(dynamic_reconfigure::Reconfigure::Request& request,
             dynamic_reconfigure::Reconfigure::Response& response);
  // Gives back what has changed.
  std::vector<Setting> change(const std::vector<Setting>& wanted);
  // Is called between two frames. Gives back the rows that changed, with the texts they had.
  std::vector<Setting> take(const std::vector<Setting>& wanted);
  // Gives back the text it had; none if it stays. Throws Error if refused.
  std::optional<Setting> set(const Setting& wanted);
  void shareWith(ReconfigureServer& other, const std::vector<Setting>& changed) const;
  void publish();
  void warn(const std::string& message) const;

  std::vector<ParameterGroup> groups_;
  ParameterTable table_;
  Nodelet nodelet_;
  ros::Publisher description_publisher_, update_publisher_;
  ros::ServiceServer server_;
  CallbackGate callbacks_;
};

}  // namespace depth_fusion
