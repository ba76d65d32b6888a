#include "clients/study/report/active_tally.h"

namespace footing::study::records {

void ActiveTally::Add(const Event& event) {
  if (event.kind == EventKind::kPhaseStarted) {
    by_interface_ = by_interface();
    interface_ = event.Text("interface");
    of_trials_s_ = 0;
  } else if (event.kind == EventKind::kTrialFinished) {
    of_trials_s_ += event.Number("active_s");
  } else if (event.kind == EventKind::kPhaseFinished) {
    by_interface_[event.Text("interface")] += event.Number("active_s");
    of_trials_s_ = 0;
  }
}

std::map<std::string, double> ActiveTally::by_interface() const {
  std::map<std::string, double> all = by_interface_;
  if (of_trials_s_ > 0) all[interface_] += of_trials_s_;
  return all;
}

double ActiveTally::total_s() const {
  double total_s = 0;
  for (const auto& [interface, active_s] : by_interface()) total_s += active_s;
  return total_s;
}

}  // namespace footing::study::records
