#pragma once

#include <map>
#include <string>

#include "clients/study/report/event.h"

namespace footing::study::records {

/// How long a participant has been moving, out of a journal. A phase's time holds that of its
/// trials; of a phase that was interrupted the trials that ended count.
class ActiveTally {
 public:
  /// Every event, in their order.
  void Add(const Event& event);

  /// By interface, s; phases without an interface have an empty name.
  std::map<std::string, double> by_interface() const;
  double total_s() const;

 private:
  std::map<std::string, double> by_interface_;
  std::string interface_;   ///< Of the phase that goes on.
  double of_trials_s_ = 0;  ///< Of the trials that ended in it.
};

}  // namespace footing::study::records
