// Hands that trackers see, loads under feet that insoles feel, and the true poses of simulated
// bodies.
#include <utility>

#include "daemon/sensor/hands/hands.h"
#include "daemon/sensor/service/hub.h"

namespace footing::sensor {

void Hub::OnHands(std::int64_t received_ns, const stream::HandFrame& frame) {
  if (const std::string problem = hands::Problem(frame); !problem.empty()) {
    Refuse("a hand frame", problem);
    return;
  }
  for (stream::HandSample& sample : hands::ToSamples(frame, received_ns, config_.default_rig)) {
    if (content_.hands.size() < kMaxSamplesPerTick) content_.hands.push_back(std::move(sample));
  }
}

void Hub::OnReference(std::int64_t received_ns, const stream::ReferenceFrame& frame) {
  if (const std::string problem = hands::Problem(frame); !problem.empty()) {
    Refuse("a reference frame", problem);
    return;
  }
  if (content_.reference.size() >= kMaxReferencesPerTick) return;
  content_.reference.push_back(hands::ToPose(frame, received_ns, config_.default_rig));
}

void Hub::OnContacts(std::int64_t received_ns, const stream::ContactFrame& frame) {
  if (const std::string problem = hands::Problem(frame); !problem.empty()) {
    Refuse("a contact frame", problem);
    return;
  }
  if (content_.contacts.size() >= kMaxContactsPerTick) return;
  content_.contacts.push_back(hands::ToSample(frame, received_ns, config_.default_rig));
}

void Hub::Refuse(const std::string& what, const std::string& why) {
  if (const auto line = refusals_.Add(ports_.now_ns(), what, why)) ports_.log({*line, "", true});
}

}  // namespace footing::sensor
