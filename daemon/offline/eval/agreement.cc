#include "daemon/offline/eval/agreement.h"

#include <algorithm>

namespace footing::eval {

void Agreement::Add(double time_s, stream::Gait meant, stream::Gait commanded, double delay_s,
                    bool still_stands) {
  if (meant_.empty() || meant_.back().gait != meant) meant_.push_back({time_s, meant});
  // The newest change from before the delay is what was meant when it began.
  while (meant_.size() > 1 && meant_[1].time_s <= time_s - delay_s) meant_.pop_front();
  const bool agrees =
      still_stands || std::any_of(meant_.begin(), meant_.end(),
                                  [&](const Meant& past) { return past.gait == commanded; });
  ++count_;
  agree_ += agrees ? 1 : 0;
  if (meant_.size() == 1 && meant_.front().time_s <= time_s - delay_s) {
    const stream::Gait shown = agrees && still_stands ? meant : commanded;
    ++table_[stream::IndexOf(meant)][stream::IndexOf(shown)];
  }
}

void Agreement::Pool(const Agreement& other) {
  count_ += other.count_;
  agree_ += other.agree_;
  for (std::size_t i = 0; i < table_.size(); ++i) {
    for (std::size_t j = 0; j < table_.size(); ++j) table_[i][j] += other.table_[i][j];
  }
}

}  // namespace footing::eval
