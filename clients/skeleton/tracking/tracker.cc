#include "clients/skeleton/tracking/tracker.h"

#include <algorithm>
#include <cmath>

#include "common/base/number.h"
#include "common/base/units.h"

namespace footing::skeleton {
namespace {

constexpr std::int64_t kAwayNs = 1'000'000'000;    // Then another person may be published.
constexpr std::size_t kMostPeople = 32;            // Remembered.
constexpr std::size_t kMostOthers = 8;             // Named.
constexpr std::int64_t kWantedNs = 2'000'000'000;  // For the wanted person to appear beside others.
constexpr std::size_t kMostStanding = 2000;        // At 1000 skeletons a second.
constexpr const char* kNotPlaced =
    "the camera is not placed yet: stand on the boards, upright, facing the camera, for two "
    "seconds, or give its position with --camera-m";

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
  for (std::string& problem : decoder_.TakeProblems()) messages_.push_back(std::move(problem));
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
  if (options_.user && user != *options_.user) return NoteOther(user, now_ns);
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
  if (!camera_) Stand(decoded, gated.skeleton, exposed_ns);
  if (!camera_) return;
  Observation& observation = out.emplace_back(Observe(gated.skeleton, X_WK_));
  observation.exposed_ns = exposed_ns;
  observation.arrived_ns = decoded.arrived_ns;
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

void Tracker::Stand(const Decoded& decoded, const Skeleton& gated, std::int64_t exposed_ns) {
  if (standing_.empty()) standing_since_ns_ = exposed_ns;
  if (standing_.size() < kMostStanding) standing_.push_back(gated);
  const double seconds = NanosecondsToSeconds(exposed_ns - standing_since_ns_);
  if (seconds < kStandingS || standing_.size() < kLeastStandingFrames) return;
  const auto fit = FitStanding(standing_, options_.camera, decoded.dialect != Dialect::kVmc);
  standing_.clear();
  if (!fit) {
    if (not_placed_ != fit.error().message) messages_.push_back(fit.error().message);
    not_placed_ = fit.error().message;
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

/// Nobody but the wanted person is published, so others are worth a line when that one stays away.
void Tracker::NoteOther(std::int32_t user, std::int64_t now_ns) {
  if (others_.empty()) other_since_ns_ = now_ns;
  if (others_.size() < kMostOthers) others_.insert(user);
  if (others_reported_ || now_ns - other_since_ns_ < kWantedNs) return;
  others_reported_ = true;
  if (const std::string advice = Advice(); !advice.empty()) messages_.push_back(advice);
}

std::string Tracker::AdviceOf(std::int32_t user) const {
  const auto found = counts_.people.find(user);
  if (found == counts_.people.end()) return "";
  if (found->second.fault != Fault::kNone) return skeleton::Advice(found->second.fault);
  if (camera_ || published_ != user) return "";
  return not_placed_.empty() ? kNotPlaced : not_placed_;
}

std::string Tracker::Advice() const {
  if (options_.user && counts_.people.count(*options_.user) == 0 && !others_.empty()) {
    std::string seen;
    for (const std::int32_t other : others_)
      seen += (seen.empty() ? "" : ", ") + std::to_string(other);
    return "person " + std::to_string(*options_.user) + " was not seen; seen: " + seen +
           "; choose one of them with --user, or leave it out";
  }
  return decoder_.NoSkeleton();
}

void Tracker::Report(std::int32_t user, Person& person, Fault fault) {
  if (fault == person.reported) return;
  person.reported = fault;
  const std::string who = "person " + std::to_string(user) + ": ";
  messages_.push_back(
      who + (fault == Fault::kNone ? "the skeleton is plausible again" : skeleton::Advice(fault)));
}

}  // namespace footing::skeleton
