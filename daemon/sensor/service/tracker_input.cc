#include "daemon/sensor/service/tracker_input.h"

#include <algorithm>
#include <utility>

namespace footing::sensor {
namespace {

/// Clocks of sources at once: eight skeletons of 16 points. The one that was silent for longest
/// gives way to another.
constexpr std::size_t kMostExposures = 128;

int PartOf(const stream::HandSample& sample) {
  return 100 * static_cast<int>(sample.role) + static_cast<int>(sample.joint);
}

/// The newest sample of a source shows that its samples of the same read are older than was said.
template <typename Sample, typename IsOfSource>
void MakeEarlier(std::vector<Sample>& samples, std::int64_t received_ns, std::int64_t earlier_ns,
                 const IsOfSource& is_of_source) {
  if (earlier_ns == 0) return;
  for (Sample& sample : samples) {
    if (sample.received_ns == received_ns && is_of_source(sample)) sample.sampled_ns -= earlier_ns;
  }
}

}  // namespace

hands::ExposureClock::Exposure TrackerInput::Expose(const Exposed& what,
                                                    const hands::FrameTimes& times) {
  if (!exposures_.contains(what) && exposures_.size() >= kMostExposures) {
    exposures_.erase(std::min_element(
        exposures_.begin(), exposures_.end(), [](const auto& one, const auto& other) {
          return one.second.received_ns() < other.second.received_ns();
        }));
  }
  return exposures_[what].Take(times);
}

void TrackerInput::OnHands(std::int64_t received_ns, const stream::HandFrame& frame) {
  if (const std::string problem = hands::Problem(frame); !problem.empty()) {
    Refuse("a hand frame", problem);
    return;
  }
  const hands::FrameTimes times = {received_ns, frame.sent_ns, frame.age_ns};
  for (stream::HandSample& sample : hands::ToSamples(frame, received_ns, config_.default_rig)) {
    if (content_.hands.size() >= kMaxSamplesPerTick) return;
    const auto exposure = Expose({'h', sample.rig, sample.tracker, PartOf(sample)}, times);
    sample.sampled_ns = exposure.sampled_ns;
    MakeEarlier(content_.hands, received_ns, exposure.others_earlier_ns, [&](const auto& other) {
      return other.rig == sample.rig && other.tracker == sample.tracker &&
             PartOf(other) == PartOf(sample);
    });
    content_.hands.push_back(std::move(sample));
  }
}

void TrackerInput::OnReference(std::int64_t received_ns, const stream::ReferenceFrame& frame) {
  if (const std::string problem = hands::Problem(frame); !problem.empty()) {
    Refuse("a reference frame", problem);
    return;
  }
  if (content_.reference.size() >= kMaxReferencesPerTick) return;
  stream::ReferencePose pose = hands::ToPose(frame, received_ns, config_.default_rig);
  const Exposed what = {'r', pose.rig, "", 0};
  pose.sampled_ns = Expose(what, {received_ns, frame.sent_ns, frame.age_ns}).sampled_ns;
  exposures_[what].Publish();
  content_.reference.push_back(std::move(pose));
}

void TrackerInput::OnContacts(std::int64_t received_ns, const stream::ContactFrame& frame) {
  if (const std::string problem = hands::Problem(frame); !problem.empty()) {
    Refuse("a contact frame", problem);
    return;
  }
  if (content_.contacts.size() >= kMaxContactsPerTick) return;
  stream::ContactSample sample = hands::ToSample(frame, received_ns, config_.default_rig);
  const auto exposure = Expose({'c', sample.rig, sample.source, static_cast<int>(sample.body)},
                               {received_ns, frame.sent_ns, frame.age_ns});
  sample.sampled_ns = exposure.sampled_ns;
  MakeEarlier(content_.contacts, received_ns, exposure.others_earlier_ns, [&](const auto& other) {
    return other.rig == sample.rig && other.source == sample.source && other.body == sample.body;
  });
  content_.contacts.push_back(std::move(sample));
}

void TrackerInput::Refuse(const std::string& what, const std::string& why) {
  if (const auto line = refusals_.Add(now_ns_(), what, why)) log_({*line, "", true});
}

void TrackerInput::Publish(std::int64_t now_ns, TickContent& content) {
  content.hands = std::exchange(content_.hands, {});
  content.reference = std::exchange(content_.reference, {});
  content.contacts = std::exchange(content_.contacts, {});
  for (auto& [what, clock] : exposures_) clock.Publish();
  for (const std::string& line : refusals_.Due(now_ns)) log_({line, "", true});
}

}  // namespace footing::sensor
