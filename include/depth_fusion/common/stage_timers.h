// Wall-clock timers of the stages, named as paths ("icp_tracking/reduce").
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

namespace depth_fusion {

class StageTimers {
 public:
  // Measures from construction to destruction.
  class Scope {
   public:
    Scope(StageTimers& timers, std::string stage)
        : timers_(timers), stage_(std::move(stage)), start_(std::chrono::steady_clock::now()) {}
    ~Scope() {
      timers_.record(
          stage_,
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count());
    }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    StageTimers& timers_;
    std::string stage_;
    std::chrono::steady_clock::time_point start_;
  };

  void record(const std::string& stage, double milliseconds) { samples_ms_[stage].push_back(milliseconds); }
  // Records the samples of others.
  void append(const StageTimers& others) {
    for (const auto& [stage, samples] : others.samples_ms_) {
      std::vector<double>& all = samples_ms_[stage];
      all.insert(all.end(), samples.begin(), samples.end());
    }
  }
  const std::map<std::string, std::vector<double>>& samplesMs() const { return samples_ms_; }
  void clear() { samples_ms_.clear(); }

 private:
  std::map<std::string, std::vector<double>> samples_ms_;
};

}  // namespace depth_fusion
