#include "clients/view/app/translate.h"

#include <algorithm>

#include "common/wire/scalar.h"
#include "common/wire/wire.h"

namespace footing::view {
namespace {

constexpr int kMaxCharacters = 8;
constexpr int kMaxParts = 256;

using wire::Finite;

scene::BodyFoot FootOf(const v1::BodyFoot& from) {
  return {from.contact(),
          from.valid(),
          wire::FromProto(from.position_m()),
          wire::FromProto(from.variance_m2()),
          Finite(from.load_n()),
          from.cop_valid(),
          wire::FromProto(from.cop_m()),
          Finite(from.airborne_s())};
}

scene::BodyState BodyOf(const v1::BodyState& from) {
  scene::BodyState body;
  body.subject = from.subject();
  body.mode = from.mode();
  body.calibrated = from.calibrated();
  body.calibration_progress = Finite(from.calibration_progress());
  body.calibration_restarts = from.calibration_restarts();
  body.mass_kg = Finite(from.mass_kg());
  body.height_m = Finite(from.height_m());
  body.lag_s = Finite(from.lag_s());
  body.momentum_valid = from.momentum_valid();
  body.com_variance_m2 = wire::FromProto(from.com_variance_m2());
  body.angular_momentum_kgm2ps = wire::FromProto(from.angular_momentum_kgm2ps());
  for (int i = 0; i < std::min(from.feet_size(), 2); ++i) {
    body.feet[static_cast<std::size_t>(i)] = FootOf(from.feet(i));
  }
  body.resets = from.resets();
  for (int i = 0; i < std::min(from.link_sd_m_size(), kMaxParts); ++i) {
    body.link_sd_m.push_back(Finite(from.link_sd_m(i)));
  }
  body.note = from.note();
  body.solve_us = Finite(from.solve_us());
  for (int i = 0; i < std::min(from.hands_seen_size(), 2); ++i) {
    body.hands_seen[static_cast<std::size_t>(i)] = from.hands_seen(i);
  }
  body.hands_source = from.hands_source();
  body.contact_source = from.contact_source();
  return body;
}

scene::ReferencePose ReferenceOf(const v1::ReferencePose& from, std::int64_t received_ns,
                                 std::int64_t offset_ns) {
  scene::ReferencePose reference;
  reference.received_ns = received_ns;
  reference.sampled_ns = from.sampled_ns() - offset_ns;
  for (int i = 0; i < std::min(from.positions_m_size(), kMaxParts); ++i) {
    reference.positions_m.push_back(wire::FromProto(from.positions_m(i)));
    reference.parents.push_back(i < from.parents_size() ? from.parents(i) : -1);
  }
  return reference;
}

scene::CharacterPose CharacterOf(const v1::Character& from) {
  scene::CharacterPose pose;
  pose.character = from.character();
  pose.rig = from.rig();
  pose.valid = from.valid();
  for (int i = 0; i < std::min(from.links_size(), kMaxParts); ++i) {
    pose.links.push_back(wire::FromProto(from.links(i)));
  }
  for (int i = 0; i < std::min(from.contacts_size(), kMaxParts); ++i) {
    pose.contacts.push_back(wire::FromProto(from.contacts(i)));
  }
  pose.com_m = wire::FromProto(from.com_m());
  pose.com_velocity_mps = wire::FromProto(from.com_velocity_mps());
  pose.gait = wire::FromProto(from.gait());
  pose.phase = from.gait().phase();
  pose.interface = wire::FromProto(from.interface());
  pose.simulated_input = from.simulated_input();
  if (from.has_body()) pose.body = BodyOf(from.body());
  if (from.has_trial()) pose.trial = wire::FromProto(from.trial());
  return pose;
}

scene::WorldFrame FrameOf(const v1::CharacterFrame& from, std::uint64_t sequence) {
  scene::WorldFrame frame;
  frame.sequence = sequence;
  frame.step = from.step();
  frame.time_s = Finite(from.time_s());
  frame.overruns = from.overruns();
  for (int i = 0; i < std::min(from.characters_size(), kMaxCharacters); ++i) {
    frame.characters.push_back(CharacterOf(from.characters(i)));
  }
  return frame;
}

scene::NoteKind KindOf(v1::Event::Kind kind) {
  switch (kind) {
    case v1::Event::KIND_FALL:
      return scene::NoteKind::kFall;
    case v1::Event::KIND_PUT_BACK:
      return scene::NoteKind::kPutBack;
    case v1::Event::KIND_GAIT_CHANGED:
      return scene::NoteKind::kGaitChanged;
    case v1::Event::KIND_RESPONSE:
      return scene::NoteKind::kResponse;
    case v1::Event::KIND_STREAM_LOST:
      return scene::NoteKind::kStreamLost;
    case v1::Event::KIND_STREAM_BACK:
      return scene::NoteKind::kStreamBack;
    default:  // Kinds that a newer server adds are shown by their text.
      return scene::NoteKind::kOther;
  }
}

void AddSensors(const v1::Tick& tick, std::int64_t offset_ns, scene::Update& update) {
  if (tick.has_status()) {
    update.devices.emplace();
    for (const auto& device : tick.status().devices()) {
      update.devices->push_back(wire::FromProto(device));
    }
  }
  for (const auto& sample : tick.motion().samples()) {
    update.motion.push_back(wire::FromProto(sample));
    update.motion.back().received_ns -= offset_ns;
  }
  for (const auto& rig : tick.features().rigs()) update.features.push_back(wire::FromProto(rig));
  for (const auto& sample : tick.boards().samples()) {
    update.boards.push_back(wire::FromProto(sample));
  }
  for (const auto& sample : tick.hands().samples()) {
    update.hands.push_back(wire::FromProto(sample));
  }
  if (tick.has_setup()) {
    update.setup.emplace();
    for (const auto& rig : tick.setup().rigs()) update.setup->push_back(wire::FromProto(rig));
  }
  if (tick.reference().poses_size() > 0) {
    update.reference =
        ReferenceOf(*tick.reference().poses().rbegin(), update.received_ns, offset_ns);
  }
}

void AddSimulation(const v1::Tick& tick, scene::Update& update) {
  if (tick.has_skeletons()) {
    update.skeletons.emplace();
    for (const auto& skeleton : tick.skeletons().skeletons()) {
      update.skeletons->push_back(wire::FromProto(skeleton));
    }
  }
  if (tick.has_track()) update.track = wire::FromProto(tick.track());
  if (tick.has_study()) update.study = wire::FromProto(tick.study());
  if (tick.has_game()) update.game = wire::FromProto(tick.game());
  if (tick.has_characters()) update.frame = FrameOf(tick.characters(), tick.sequence());
  for (const auto& event : tick.events().events()) {
    update.notes.push_back(
        {KindOf(event.kind()), event.host_ns(), event.text(), wire::FromProto(event.response())});
  }
}

}  // namespace

scene::Update Translate(const v1::Tick& tick, int source, std::int64_t received_ns,
                        std::int64_t offset_ns) {
  scene::Update update;
  update.source = source;
  update.live = !tick.snapshot() && !tick.refilled();
  update.host_ns = tick.host_ns() - offset_ns;
  update.received_ns = received_ns;
  AddSensors(tick, offset_ns, update);
  AddSimulation(tick, update);
  return update;
}

scene::Update TranslateNotice(const v1::Notice& notice, int source, std::int64_t received_ns) {
  scene::Update update;
  update.source = source;
  update.live = false;
  update.received_ns = received_ns;
  update.notes.push_back({scene::NoteKind::kServer, received_ns, notice.text(), {}});
  return update;
}

}  // namespace footing::view
