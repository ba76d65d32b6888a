#include "daemon/simulation/gait_service/applied_input.h"

#include <algorithm>

#include "common/wire/fields.h"

namespace footing::gait_service {
namespace {

using wire::FromProto;
using wire::ToProto;

template <typename Way>
void Fields(Way way, const mapping::LimbFeatures&) {
  FOOTING_FIELD(present);
  FOOTING_FIELD(moving);
  FOOTING_FIELD(frequency_valid);
  FOOTING_FIELD(frequency_hz);
  FOOTING_FIELD(amplitude_valid);
  FOOTING_FIELD(amplitude_mps2);
  FOOTING_FIELD(inclination_valid);
  FOOTING_FIELD(roll_rad);
  FOOTING_FIELD(pitch_rad);
  FOOTING_FIELD(swing_valid);
  FOOTING_FIELD(swing_rad);
  FOOTING_FIELD(mounted);
}
FOOTING_BOTH_WAYS_OF(mapping::LimbFeatures, v1::HandInput)

template <typename Way>
void Fields(Way way, const mapping::StickInput&) {
  FOOTING_FIELD(present);
  FOOTING_FIELD(x);
  FOOTING_FIELD(y);
  FOOTING_FIELD(pressed);
  FOOTING_FIELD(presses);
  FOOTING_ENUM(DeviceRole, role);
}
FOOTING_BOTH_WAYS_OF(mapping::StickInput, v1::StickInput)

template <typename Way>
void Fields(Way way, const mapping::BoardInput&) {
  FOOTING_FIELD(present);
  if constexpr (Way::kOut) {
    for (const double corner_n : way.value.corners_n) {
      way.message.add_corners_n(wire::Sent(corner_n));
    }
  } else {
    auto& corners_n = way.value.corners_n;
    const int count = std::min(way.message.corners_n_size(), static_cast<int>(corners_n.size()));
    std::transform(way.message.corners_n().begin(), way.message.corners_n().begin() + count,
                   corners_n.begin(), [](double corner_n) { return wire::Received(corner_n); });
  }
  FOOTING_FIELD(cop_valid);
  FOOTING_FIELD(cop_x_m);
  FOOTING_FIELD(cop_y_m);
}
FOOTING_BOTH_WAYS_OF(mapping::BoardInput, v1::BoardInput)

/// One part of a person's inputs; what is not there is left out.
#define FOOTING_INPUT_OF(member, name)                           \
  if constexpr (Way::kOut) {                                     \
    if (way.value.member != decltype(way.value.member){}) {      \
      *way.message.mutable_##name() = ToProto(way.value.member); \
    }                                                            \
  } else {                                                       \
    way.value.member = FromProto(way.message.name());            \
  }

/// Fields of a person's devices: worn, held and stood on.
template <typename Way>
void Fields(Way way, const mapping::Inputs&) {
  FOOTING_MESSAGE_OF(hands.left, left);
  FOOTING_MESSAGE_OF(hands.right, right);
  FOOTING_FIELD_OF(hands.phase_valid, phase_valid);
  FOOTING_FIELD_OF(hands.phase_rad, phase_rad);
  FOOTING_INPUT_OF(legs.left, left_leg);
  FOOTING_INPUT_OF(legs.right, right_leg);
  FOOTING_FIELD_OF(legs.phase_valid, legs_phase_valid);
  FOOTING_FIELD_OF(legs.phase_rad, legs_phase_rad);
  FOOTING_INPUT_OF(head, head);
  FOOTING_INPUT_OF(trunk, trunk);
  FOOTING_INPUT_OF(stick, stick);
  FOOTING_INPUT_OF(left_board, left_board);
  FOOTING_INPUT_OF(right_board, right_board);
  FOOTING_FIELD(simulated);
}
#undef FOOTING_INPUT_OF

template <typename Way>
void Fields(Way way, const terrain::NewSegment&) {
  FOOTING_FIELD(length_m);
  FOOTING_FIELD(slope_rad);
  FOOTING_FIELD(curve_rad);
  FOOTING_FIELD(step_m);
  FOOTING_FIELD(pit);
}
FOOTING_BOTH_WAYS_OF(terrain::NewSegment, v1::AppendedSegment)

template <typename Way>
void Fields(Way way, const engine::InterfaceInputs&) {
  FOOTING_FIELD_OF(number, interface_number);
  FOOTING_ENUM_OF(UserInterface, options.interface, interface);
  FOOTING_ENUM_OF(TurnSource, options.leg.turn_by, turn_by);
  FOOTING_FIELD_OF(options.boards_may_be_left, boards_may_be_left);
  if constexpr (!Way::kOut) {
    const bool named = way.value.options.interface != stream::UserInterface::kUnspecified;
    if (!named) way.value.options = {};
  }
}

template <typename Way>
void Fields(Way way, const engine::EngineInputs&) {
  FOOTING_FIELD(features_number);
  FOOTING_PART(features);
  FOOTING_PART(interface);
  FOOTING_FIELD(direct);
  FOOTING_ENUM_OF(Gait, direct_command.gait, direct_gait);
  FOOTING_FIELD_OF(direct_command.speed_mps, direct_speed_mps);
  FOOTING_FIELD_OF(direct_command.height_m, direct_height_m);
  FOOTING_FIELD_OF(direct_command.turn_per_step_rad, direct_turn_rad);
  FOOTING_FIELD(push_number);
  FOOTING_FIELD_OF(push_impulse_W_ns.x(), push_x_ns);
  FOOTING_FIELD_OF(push_impulse_W_ns.y(), push_y_ns);
  FOOTING_FIELD(put_back_number);
  FOOTING_FIELD(append_number);
  if constexpr (Way::kOut) {
    for (int i = 0; i < way.value.append_count; ++i) {
      *way.message.add_appends() = ToProto(way.value.appends[static_cast<std::size_t>(i)]);
    }
  } else {
    way.value.append_count = std::min(way.message.appends_size(), engine::kMaxAppends);
    for (int i = 0; i < way.value.append_count; ++i) {
      way.value.appends[static_cast<std::size_t>(i)] = FromProto(way.message.appends(i));
    }
  }
  FOOTING_FIELD_OF(trial.number, trial_number);
  if constexpr (Way::kOut) {
    way.message.set_trial_task(static_cast<std::uint32_t>(way.value.trial.task + 1));
  } else {
    way.value.trial.task = static_cast<int>(way.message.trial_task()) - 1;
  }
  FOOTING_FIELD_OF(trial.stopped_below, trials_stopped_below);
  FOOTING_FIELD_OF(trial.track_number, track_number);
}

template <typename Way>
void Fields(Way way, const Applied&) {
  FOOTING_FIELD(step);
  FOOTING_FIELD_OF(inputs.sensor_epoch, sensor_epoch);
  FOOTING_FIELD_OF(inputs.sensor_sequence, sensor_sequence);
  FOOTING_PART(inputs.engine);
}
FOOTING_BOTH_WAYS_OF(Applied, v1::AppliedInput)

}  // namespace

v1::AppliedInput ToAppliedInput(const Applied& applied) { return ToProto(applied); }

Applied FromAppliedInput(const v1::AppliedInput& message) { return FromProto(message); }

}  // namespace footing::gait_service
