#include "clients/view/scene/tally.h"

#include <algorithm>
#include <cmath>

#include "common/base/quantile.h"
#include "common/base/time.h"

namespace footing::scene {
namespace {

constexpr std::size_t kMaxLatencies = 100'000;
constexpr double kSeenS = 2.0;
constexpr std::uint64_t kSeenSteps = 6;
constexpr std::uint64_t kSeenJumps = 3;

std::uint64_t Increase(std::uint64_t before, std::uint64_t now) {
  return now > before ? now - before : 0;
}

}  // namespace

void Latencies::Add(std::int64_t latency_ns) {
  last_ns_ = latency_ns;
  if (values_ns_.size() < kMaxLatencies) {
    values_ns_.push_back(latency_ns);
    return;
  }
  values_ns_[next_] = latency_ns;
  next_ = (next_ + 1) % kMaxLatencies;
}

double Latencies::QuantileMs(double share) const {
  if (values_ns_.empty()) return 0;
  const auto rank = static_cast<std::size_t>(std::llround(share * (values_ns_.size() - 1.0)));
  return NanosecondsToMilliseconds(text::OfRank(values_ns_, rank));
}

double Latencies::LastMs() const { return NanosecondsToMilliseconds(last_ns_); }

void Tally::Add(const WorldFrame& frame) {
  ++frames_;
  if (frame.characters.empty()) return;
  const stream::GaitState& now = frame.characters.front().gait;
  const bool restarted = frame.time_s < last_time_s_;
  if (frames_ > 1 && !restarted) {
    falls_ += Increase(last_.falls, now.falls);
    for (const stream::FailureCause cause : stream::kFailureCauses) {
      *stream::MutableCountOf(cause, failures_) +=
          Increase(stream::CountOf(cause, last_.failures), stream::CountOf(cause, now.failures));
    }
    operator_put_backs_ += Increase(last_.operator_put_backs, now.operator_put_backs);
    distance_m_ += std::max(0.0, now.distance_m - last_.distance_m);
    const auto& trial = frame.characters.front().trial;
    if (trial && !trial->progress.on_track) off_track_s_ += frame.time_s - last_time_s_;
  }
  // A restarted server counts from 1 again.
  frames_published_ += frame.sequence > last_sequence_ && frames_ > 1 && !restarted
                           ? frame.sequence - last_sequence_
                           : 1;
  last_sequence_ = frame.sequence;
  if (frames_ == 1 || restarted || now.gait != stretch_.gait || now.falls != last_.falls ||
      !now.commanded_by_stream) {
    stretch_ = {now.gait, frame.time_s, now.steps};
  }
  last_ = now;
  last_time_s_ = frame.time_s;

  const std::uint64_t needed = now.gait == stream::Gait::kJump ? kSeenJumps : kSeenSteps;
  const bool long_enough =
      frame.time_s - stretch_.start_s >= kSeenS && now.steps >= stretch_.start_steps + needed;
  if (!long_enough || now.gait == stream::Gait::kUnspecified) return;
  if (std::find(seen_.begin(), seen_.end(), now.gait) == seen_.end()) seen_.push_back(now.gait);
}

void Tally::Add(const stream::ResponseStages& response) {
  double without_contact_ms = 0;
  const std::vector<stream::ResponseStage> stages = stream::ResponseTimes(response);
  if (stages.empty()) return;
  for (const stream::ResponseStage& stage : stages) {
    response_stages[stage.name].Add(static_cast<std::int64_t>(stage.ms * 1e6));
    if (stage.name != std::string(stream::kContactStage)) without_contact_ms += stage.ms;
  }
  response_without_contact.Add(static_cast<std::int64_t>(without_contact_ms * 1e6));
}

std::vector<stream::Gait> Tally::GaitsSeen() const {
  std::vector<stream::Gait> gaits = seen_;
  std::sort(gaits.begin(), gaits.end());
  return gaits;
}

}  // namespace footing::scene
