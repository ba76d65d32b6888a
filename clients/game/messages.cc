#include "clients/game/messages.h"

#include "common/wire/scalar.h"
#include "common/wire/wire.h"

namespace footing::game {
namespace {

/// Of a Wiimote's two button bytes.
constexpr std::uint32_t kButtonA = 0x0008, kButtonB = 0x0004;

Fault FaultOf(const v1::Failure& failure) {
  const auto cause = v1::FailureCause_IsValid(failure.cause())
                         ? static_cast<stream::FailureCause>(failure.cause())
                         : stream::FailureCause::kUnspecified;
  return {failure.number(), cause, failure.trial(), wire::Finite(failure.distance_m()),
          failure.withdrawn()};
}

/// Of the first rig whose editor sends samples; footingd sorts the rigs by name. Null when none.
const v1::DeviceFeatures* EditorOf(const v1::Tick& tick) {
  for (const v1::RigFeatures& rig : tick.features().rigs()) {
    for (const v1::DeviceFeatures& one : rig.devices()) {
      if (one.role() == v1::DEVICE_ROLE_EDITOR && one.inclination_valid()) return &one;
    }
  }
  return nullptr;
}

}  // namespace

void Take(const v1::Tick& tick, Collector& collector) {
  if (tick.has_track()) collector.OnTrack(wire::FromProto(tick.track()));
  for (const v1::Event& event : tick.events().events()) {
    if (event.has_failure()) collector.OnFault(FaultOf(event.failure()));
  }
  if (tick.characters().characters_size() > 0) {
    collector.OnTrial(wire::FromProto(tick.characters().characters(0).trial()));
  }
}

bool Take(const v1::Tick& tick, std::uint32_t& device, Hand& hand) {
  const v1::DeviceFeatures* editor = EditorOf(tick);
  if (editor != nullptr) {
    device = editor->device();
    hand.roll_rad = wire::Finite(editor->roll_rad());
    hand.pitch_rad = wire::Finite(editor->pitch_rad());
  }
  for (const v1::MotionSample& sample : tick.motion().samples()) {
    if (device == 0 || sample.device() != device) continue;
    hand.a = (sample.buttons() & kButtonA) != 0;
    hand.b = (sample.buttons() & kButtonB) != 0;
  }
  return editor != nullptr;
}

Frame FrameOf(const v1::Tick& tick) {
  const v1::Character& character = tick.characters().characters(0);
  const stream::InterfaceState interface = wire::FromProto(character.interface());
  Frame frame;
  frame.time_s = wire::Finite(tick.characters().time_s());
  frame.commanded_speed_mps = wire::Finite(character.gait().commanded_speed_mps());
  frame.commanded = character.gait().commanded_by_stream();
  frame.runner_silent =
      interface.activity == stream::Activity::kAbsent || interface.missing_roles != 0;
  frame.trial = wire::FromProto(character.trial());
  return frame;
}

v1::Command ToCommand(const Piece& piece) {
  v1::Command command;
  v1::AppendSegment& append = *command.mutable_append_segment();
  append.set_length_m(piece.length_m);
  append.set_slope_rad(piece.slope_rad);
  append.set_curve_rad(piece.curve_rad);
  append.set_step_m(piece.step_m);
  append.set_pit(piece.pit);
  return command;
}

}  // namespace footing::game
