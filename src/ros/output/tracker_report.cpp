#include "ros/output/tracker_report.h"

#include <boost/make_shared.hpp>

#include "ros/conversions/status_messages.h"

namespace depth_fusion {

void TrackerReport::publish(const TrackerStatus& status, bool fits_nowhere, const std::string& device) {
  statuses_.publish(boost::make_shared<TrackerStatus>(status));
  const std::lock_guard<std::mutex> lock(mutex_);
  status_ = status;
  fits_nowhere_ = fits_nowhere;
  device_ = device;
}

void TrackerReport::diagnose(const std::string& problem,
                             diagnostic_updater::DiagnosticStatusWrapper& diagnosis) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  depth_fusion::diagnose(status_, problem, fits_nowhere_ ? "; move the sensor back to where it has been" : "",
                         diagnosis);
  diagnosis.add("device", device_);
}

}  // namespace depth_fusion
