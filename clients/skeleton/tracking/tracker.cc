#include "clients/skeleton/tracking/tracker.h"

#include <algorithm>
#include <cmath>

#include "common/text/number.h"
#include "common/units/units.h"

namespace footing::skeleton {
namespace {

constexpr std::int64_t kAwayNs = 1'000'000'000;  // Then another person may be published.
constexpr std::size_t kMostPeople = 32;          // Remembered.

}  // namespace

Tracker::Tracker(const TrackerOptions& options) : options_(options), decoder_(options.dialect) {
  if (options.stand) return;
  camera_ = options.camera;
  X_WK_ = ToPose(options.camera);
}

void Tracker::Take(osc::Bytes bytes, std::int64_t now_ns, std::int64_t wall_ns,
                   std::vector<Observation>& out) {
  ++counts_.packets;
  counts_.bytes += bytes.size();
  if (const auto read = osc::Read(bytes, packet_); !read) {
    if (counts_.rejected_packets++ == 0) messages_.push_back(read.error().message);
    return;
  }
  decoder_.Take(packet_, now_ns, complete_);
  if (decoder_.last_problem() != last_problem_) {
    if (last_problem_.empty()) messages_.push_back(decoder_.last_problem());
    last_problem_ = decoder_.last_problem();
  }
  Settle(now_ns, wall_ns, out);
}

void Tracker::Flush(std::int64_t now_ns, std::int64_t wall_ns, std::vector<Observation>& out) {
  decoder_.Flush(now_ns, complete_);
  Settle(now_ns, wall_ns, out);
}

std::vector<std::string> Tracker::Messages() {
  std::vector<std::string> messages;
  messages.swap(messages_);
  return messages;
}

void Tracker::Settle(std::int64_t now_ns, std::int64_t wall_ns, std::vector<Observation>& out) {
  for (const Decoded& decoded : complete_) Take(decoded, now_ns, wall_ns, out);
  complete_.clear();
}

void Tracker::Take(const Decoded& decoded, std::int64_t now_ns, std::int64_t wall_ns,
                   std::vector<Observation>& out) {
  const std::int32_t user = decoded.skeleton.user;
  if (options_.user && user != *options_.user) return;
  Person& person = PersonOf(user, now_ns);
  const std::int64_t since_ns = now_ns - decoded.arrived_ns;
  const std::int64_t age_ns = person.clock.Age(decoded.skeleton.sent_ns, decoded.skeleton.unix_time,
                                               decoded.arrived_ns, wall_ns - since_ns);
  const std::int64_t exposed_ns = decoded.arrived_ns - age_ns;
  if (exposed_ns <= person.exposed_ns) {
    ++counts_.overtaken;
    return;
  }
  person.exposed_ns = exposed_ns;
  const Gated gated = person.gate.Advance(decoded.skeleton, exposed_ns);
  ++counts_.skeletons;
  PersonCounts& counts = counts_.people[user];
  counts.dialect = decoded.dialect;
  ++counts.skeletons;
  counts.joints += gated.skeleton.present();
  counts.inferred += gated.inferred;
  for (const Verdict verdict : gated.verdicts) ++counts.verdicts[static_cast<std::size_t>(verdict)];
  counts.fault = gated.fault;
  Report(user, person, gated.fault);
  if (gated.fault != Fault::kNone || !IsPublished(user, now_ns)) return;
  if (!camera_) Stand(gated.skeleton);
  if (!camera_) return;
  Observation& observation = out.emplace_back(Observe(gated.skeleton, X_WK_));
  observation.exposed_ns = exposed_ns;
  observation.arrived_ns = decoded.arrived_ns;
  ++counts_.published;
}

Tracker::Person& Tracker::PersonOf(std::int32_t user, std::int64_t now_ns) {
  if (people_.size() >= kMostPeople && people_.count(user) == 0) {
    const auto oldest = std::min_element(
        people_.begin(), people_.end(),
        [](const auto& a, const auto& b) { return a.second.seen_ns < b.second.seen_ns; });
    counts_.people.erase(oldest->first);
    people_.erase(oldest);
  }
  Person& person = people_.try_emplace(user, options_.latency_ns).first->second;
  person.seen_ns = now_ns;
  return person;
}

/// The first person, until nothing has come of that one for a while.
bool Tracker::IsPublished(std::int32_t user, std::int64_t now_ns) {
  if (published_) {
    const auto found = people_.find(*published_);
    if (found != people_.end() && now_ns - found->second.seen_ns <= kAwayNs)
      return *published_ == user;
  }
  published_ = user;
  standing_.clear();
  return true;
}

void Tracker::Stand(const Skeleton& skeleton) {
  standing_.push_back(skeleton);
  if (standing_.size() < kStandingFrames) return;
  const auto fit = FitStanding(standing_, options_.camera);
  standing_.clear();
  if (!fit) {
    messages_.push_back(fit.error().message);
    return;
  }
  camera_ = fit->place;
  X_WK_ = ToPose(*camera_);
  const auto number = [](double value) { return text::Fixed(value, 2); };
  messages_.push_back("placement: the camera is at " + number(camera_->p_W_m.x()) + ", " +
                      number(camera_->p_W_m.y()) + ", " + number(camera_->p_W_m.z()) + " m, yaw " +
                      text::Fixed(RadiansToDegrees(camera_->yaw_rad), 1) +
                      " degrees; the trunk leans by " +
                      text::Fixed(RadiansToDegrees(fit->lean_rad), 1) + " degrees");
}

void Tracker::Report(std::int32_t user, Person& person, Fault fault) {
  if (fault == person.reported) return;
  person.reported = fault;
  const std::string who = "person " + std::to_string(user) + ": ";
  messages_.push_back(who +
                      (fault == Fault::kNone ? "the skeleton is plausible again" : Advice(fault)));
}

}  // namespace footing::skeleton
