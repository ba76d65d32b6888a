#pragma once

#include <array>

#include "daemon/offline/tune/trial.h"

namespace footing::tune {

/// Mean of what was added.
struct Mean {
  double sum = 0;
  int count = 0;

  void Add(double value) {
    sum += value;
    ++count;
  }
  double value() const { return count > 0 ? sum / count : 0; }
};

/// Measures speed, contacts and strides of a trial, millisecond by millisecond.
class GaitMeter {
 public:
  explicit GaitMeter(const Task& task) : task_(task) {}

  void Add(const engine::EngineOutput& output, double step_s);
  /// All but how long it was survived.
  void Report(TrialResult& result) const;

 private:
  /// A contact without its chatter: a change counts, from its beginning, once it has lasted.
  struct Contact {
    bool known = false;
    bool down = false;
    double since_s = -1;    ///< Negative: not seen from its beginning.
    double changed_s = -1;  ///< Since when it looks otherwise; negative: it does not.
  };

  void Watch(Contact& contact, bool down, double time_s);
  void AddStride(const engine::EngineOutput& output);

  Task task_;
  double time_s_ = 0;
  double mean_speed_mps_ = 0;
  Mean squared_error_, squared_heading_error_;
  std::array<Contact, 2> contacts_;
  Mean flight_s_, stance_s_, stride_m_;
  std::uint64_t steps_ = 0;
  double step_m_ = -1;  ///< Distance at the last touchdown.
  double leg_gap_m_ = INFINITY;
};

}  // namespace footing::tune
