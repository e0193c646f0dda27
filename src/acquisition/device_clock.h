// Stamps of a device's own clock on the host's.
#pragma once

namespace depth_fusion {

// Images come late by what their way takes, now more, now less; the quickest of the last few hundred says how
// the clocks differ.
class DeviceClock {
 public:
  // Gives the host's time, in seconds, of an image that the device stamped device_s and that came at host_s.
  // Where either clock was set anew, it begins anew.
  double toHost(double device_s, double host_s);

 private:
  bool started_ = false;
  double difference_s_ = 0.0;       // host minus device
  double next_difference_s_ = 0.0;  // the least of the images since it was taken
  int images_ = 0;                  // of these
};

}  // namespace depth_fusion
