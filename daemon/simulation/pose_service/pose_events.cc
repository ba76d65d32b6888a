#include "daemon/simulation/pose_service/pose_events.h"

#include <cmath>
#include <string>
#include <utility>

#include "daemon/simulation/pose_service/pose_note.h"
#include "daemon/simulation/serving/messages.h"

namespace footing::pose_service {
namespace {

void Add(v1::Events& events, v1::Event::Kind kind, std::int64_t now_ns, const std::string& text) {
  *events.add_events() = serving::MakeEvent(kind, now_ns, text);
}

std::string Kilograms(double mass_kg) {
  const auto tenths = std::llround(10 * mass_kg);
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " kg";
}

}  // namespace

/// Of Wiimotes alone: trackers lose hands and find them all the time.
void PoseEvents::AddHands(const PoseFrame& frame, std::int64_t now_ns, v1::Events& events) {
  for (std::size_t side = 0; side < hand_trouble_.size(); ++side) {
    const HandTrouble now = frame.input.hand_trouble[side];
    const HandTrouble before = std::exchange(hand_trouble_[side], now);
    if (!frame.t_pose.complete || now == before) continue;
    const std::string name = side == 0 ? "left" : "right";
    if (now == HandTrouble::kNone) {
      Add(events, v1::Event::KIND_STREAM_BACK, now_ns,
          "the " + name + " Wiimote reports its arm again");
    } else {
      Add(events, v1::Event::KIND_STREAM_LOST, now_ns, HandText(now, name));
    }
  }
}

v1::Events PoseEvents::Between(const PoseFrame& frame, const Subject& subject,
                               std::int64_t now_ns) {
  v1::Events events;
  const bool measured = frame.input.feet_measured[0] && frame.input.feet_measured[1];
  const bool on_insoles = frame.input.source == PoseSource::kInsoles;
  const bool next_subject = has_last_ && frame.subject_number != subject_number_;
  const std::string source = on_insoles ? "insole" : "board";
  if (has_last_ && frame.input.source != source_) {
    Add(events, v1::Event::KIND_COMMAND, now_ns, "the pose follows the " + source + "s");
  }
  if (measured != measured_) {
    Add(events, measured ? v1::Event::KIND_STREAM_BACK : v1::Event::KIND_STREAM_LOST, now_ns,
        measured ? "both " + source + "s are there"
                 : (on_insoles ? "an " : "a ") + source + " is lost: the pose coasts");
  }
  if (next_subject) {
    Add(events, v1::Event::KIND_COMMAND, now_ns,
        "next subject: " + subject.code + "; their T-pose is awaited");
  } else if (calibrated_ && !frame.t_pose.complete) {
    Add(events, v1::Event::KIND_COMMAND, now_ns, "the T-pose is to be taken again");
  }
  if (!calibrated_ && frame.t_pose.complete) {
    Add(events, v1::Event::KIND_COMMAND, now_ns,
        "T-pose taken: " + Kilograms(frame.t_pose.mass_kg));
  }
  if (has_last_ && !next_subject && frame.resets > resets_) {
    Add(events, v1::Event::KIND_COMMAND, now_ns, "the filters were reset");
  }
  AddHands(frame, now_ns, events);
  has_last_ = true;
  measured_ = measured;
  source_ = frame.input.source;
  calibrated_ = frame.t_pose.complete;
  subject_number_ = frame.subject_number;
  resets_ = frame.resets;
  return events;
}

}  // namespace footing::pose_service
