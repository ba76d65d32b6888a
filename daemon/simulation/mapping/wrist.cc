#include "daemon/simulation/mapping/wrist.h"

#include <algorithm>
#include <cmath>

namespace footing::mapping {

using stream::Gait;

void SettledGait::Reset(Gait gait) {
  gait_ = gait;
  next_ = Gait::kUnspecified;
}

void SettledGait::Pause(double time_s) { time_s_ = time_s; }

Gait SettledGait::Advance(double time_s, Gait seen, double lasting_s) {
  const double elapsed_s = time_s - time_s_;
  time_s_ = time_s;
  if (seen == gait_) {
    Reset(gait_);
    return gait_;
  }
  lasted_s_ = seen == next_ ? lasted_s_ + elapsed_s : 0;
  next_ = seen;
  share_ = lasting_s > 0 ? std::clamp(lasted_s_ / lasting_s, 0.0, 1.0) : 1;
  if (lasted_s_ >= lasting_s) Reset(seen);
  return gait_;
}

namespace {

using stream::Activity;

/// Steps in a period of the limbs: walking's own two; who runs swings too fast for two.
constexpr double kWalkStepsPerSwing = 2;
constexpr double kRunStepsPerSwing = 1;

bool BothMove(const LimbPair& limbs) {
  return limbs.left.present && limbs.right.present && limbs.left.moving && limbs.right.moving;
}

bool BothHaveFrequency(const LimbPair& limbs) {
  return limbs.left.frequency_valid && limbs.right.frequency_valid;
}

}  // namespace

bool SwingMapping::IsOrdered() const {
  return walk_mps_from_hz.Rises() && run_mps_from_hz.Rises() && jump_mps_from_hz.Rises() &&
         jump_m_from_mps2.Rises() && in_phase_below_rad <= out_of_phase_above_rad;
}

void AddFields(SwingMapping& m, TableFields& fields) {
  AddSpeedFields(m.walk_mps_from_hz, m.run_mps_from_hz, fields);
  AddFields({"jump_amplitude_min_mps2", "jump_amplitude_max_mps2", "jump_height_min_m",
             "jump_height_max_m", 0.1, 100, 0.02, 0.5},
            m.jump_m_from_mps2, fields);
  AddFields({"jump_frequency_min_hz", "jump_frequency_max_hz", "jump_speed_min_mps",
             "jump_speed_max_mps", 0.1, 10, 0, 2},
            m.jump_mps_from_hz, fields);
  const TableField more[] = {
      {"in_phase_below_deg", &m.in_phase_below_rad, 0, 180, Unit::kDegrees},
      {"out_of_phase_above_deg", &m.out_of_phase_above_rad, 0, 180, Unit::kDegrees},
      {"start_cycles", &m.start_cycles, 0, 3},
      {"change_cycles", &m.change_cycles, 0, 3},
      {"change_min_s", &m.change_min_s, 0, 2},
      {"hold_s", &m.hold_s, 0, 10},
  };
  fields.insert(fields.end(), std::begin(more), std::end(more));
}

void AddFields(FrequencyBorder& border, TableFields& fields) {
  fields.push_back({"walk_run_border_hz", &border.border_hz, 0.1, 10});
  fields.push_back({"walk_run_hysteresis_hz", &border.hysteresis_hz, 0, 1});
}

bool FrequencyBorder::IsRun(double frequency_hz, Gait now) const {
  const double slack_hz = now == Gait::kRun    ? -hysteresis_hz
                          : now == Gait::kWalk ? hysteresis_hz
                                               : 0;
  return frequency_hz >= border_hz + slack_hz;
}

std::optional<double> MeanOf(const LimbPair& limbs, bool LimbFeatures::*valid,
                             double LimbFeatures::*value) {
  const bool left = limbs.left.*valid, right = limbs.right.*valid;
  if (left && right) return (limbs.left.*value + limbs.right.*value) / 2;
  if (left) return limbs.left.*value;
  if (right) return limbs.right.*value;
  return std::nullopt;
}

Gait SwingGait::Seen(double phase_rad, bool run) const {
  const double border_rad =
      gait() == Gait::kJump   ? mapping_.out_of_phase_above_rad
      : gait() == Gait::kStep ? (mapping_.in_phase_below_rad + mapping_.out_of_phase_above_rad) / 2
                              : mapping_.in_phase_below_rad;
  if (std::fabs(phase_rad) < border_rad) return Gait::kJump;
  return run ? Gait::kRun : Gait::kWalk;
}

/// Limbs that are seen together before they show their new period keep the last one.
void SwingGait::Know(const LimbPair& limbs) {
  known_hz_ = MeanOf(limbs, &LimbFeatures::frequency_valid, &LimbFeatures::frequency_hz)
                  .value_or(known_hz_);
  known_mps2_ = MeanOf(limbs, &LimbFeatures::amplitude_valid, &LimbFeatures::amplitude_mps2)
                    .value_or(known_mps2_);
}

/// Limbs that change from one motion to another pass through low frequencies, and a run-up is not
/// to be braked by them: a slower pace must last as a change of gait does.
void SwingGait::FollowPace(double elapsed_s) {
  const bool slower = known_hz_ < pace_hz_;
  if (slower) {
    slower_s_ += elapsed_s;
    slower_hz_ = std::max(slower_hz_, known_hz_);
    if (slower_s_ < mapping_.change_cycles / known_hz_) return;
  }
  pace_hz_ = slower ? slower_hz_ : known_hz_;
  slower_s_ = slower_hz_ = 0;
}

void SwingGait::SetPace() {
  command_.gait = gait();
  command_.cadence_hz = 0;
  switch (command_.gait) {
    case Gait::kWalk:
      command_.speed_mps = mapping_.walk_mps_from_hz(pace_hz_);
      command_.cadence_hz = kWalkStepsPerSwing * pace_hz_;
      break;
    case Gait::kRun:
      command_.speed_mps = mapping_.run_mps_from_hz(pace_hz_);
      command_.cadence_hz = kRunStepsPerSwing * pace_hz_;
      break;
    case Gait::kJump:
      command_.speed_mps = mapping_.jump_mps_from_hz(known_hz_);
      command_.height_m = mapping_.jump_m_from_mps2(known_mps2_);
      break;
    case Gait::kStep:
    case Gait::kUnspecified:
      command_ = {};
      break;
  }
}

/// The time for which `run` differs from what it was when the gait settled, while nothing else is
/// known: that the motion is another one has then lasted, although not which one it is.
void SwingGait::WaitForPhase(double time_s, bool run) {
  other_s_ = run == settled_run_ ? 0 : other_s_ + time_s - time_s_;
  settled_.Pause(time_s);
}

biped::GaitCommand SwingGait::Rest() {
  other_s_ = 0;
  known_hz_ = known_mps2_ = pace_hz_ = slower_s_ = slower_hz_ = 0;
  settled_.Reset(Gait::kStep);
  return command_ = biped::GaitCommand{};
}

biped::GaitCommand SwingGait::Advance(double time_s, const LimbPair& limbs, bool run) {
  if (!limbs.left.present || !limbs.right.present) {
    valid_time_s_ = time_s;
    return Rest();
  }
  if (!BothMove(limbs)) {
    valid_time_s_ = time_s;
    const Gait settled = settled_.Advance(time_s, Gait::kStep, mapping_.change_min_s);
    return settled == Gait::kStep ? Rest() : command_;
  }
  Know(limbs);
  if (!limbs.phase_valid || known_hz_ <= 0) {
    WaitForPhase(time_s, run);
    time_s_ = time_s;
    return time_s - valid_time_s_ > mapping_.hold_s ? Rest() : command_;
  }
  const double elapsed_s = time_s - time_s_;
  valid_time_s_ = time_s_ = time_s;
  if (run == settled_run_) other_s_ = 0;
  const Gait seen = Seen(limbs.phase_rad, run);
  const double least_s = mapping_.start_cycles / known_hz_;
  const double change_s = mapping_.change_cycles / known_hz_ - other_s_;
  // Two resting limbs that turn, and turn back, are a swing together for half a cycle.
  const double from_rest_s = seen == Gait::kJump ? mapping_.change_cycles / known_hz_ : least_s;
  const double lasting_s = gait() == Gait::kStep ? from_rest_s : std::max(least_s, change_s);
  const Gait before = gait();
  if (settled_.Advance(time_s, seen, std::max(mapping_.change_min_s, lasting_s)) == seen) {
    if (seen != before) pace_hz_ = 0;
    FollowPace(elapsed_s);
    SetPace();
    settled_run_ = run;
    other_s_ = 0;
  } else {
    slower_s_ = slower_hz_ = 0;
  }
  return command_;
}

void SwingGait::Describe(const LimbPair& limbs, stream::InterfaceState& state) const {
  const auto frequency_hz =
      MeanOf(limbs, &LimbFeatures::frequency_valid, &LimbFeatures::frequency_hz);
  state.gait = gait();
  state.next_gait = settled_.next();
  state.next_share = settled_.share();
  state.frequency_valid = frequency_hz.has_value();
  state.frequency_hz = frequency_hz.value_or(0);
  state.phase_valid = limbs.phase_valid;
  state.phase_rad = limbs.phase_rad;
  state.together_rad = mapping_.in_phase_below_rad;
  if (!limbs.left.present || !limbs.right.present) {
    state.activity = Activity::kAbsent;
  } else if (!BothMove(limbs)) {
    state.activity = Activity::kRest;
  } else if (!limbs.phase_valid) {
    state.activity = BothHaveFrequency(limbs) ? Activity::kUnequal : Activity::kUnclear;
  } else {
    const bool together = Seen(limbs.phase_rad, false) == Gait::kJump;
    state.activity = together ? Activity::kTogether : Activity::kAlternate;
  }
}

Result<WristMapping> ParseWristMapping(const std::string& text, const std::string& origin) {
  WristMapping mapping;
  TableFields fields;
  AddFields(mapping.swing, fields);
  AddFields(mapping.border, fields);
  AddFields(mapping.turn, false, fields);
  if (const auto read = ReadTable(text, origin, fields); !read) return read.error();
  if (!mapping.swing.IsOrdered() || !mapping.turn.IsOrdered()) return NotOrdered(origin);
  return mapping;
}

biped::GaitCommand WristInterface::Advance(double time_s, const Inputs& inputs) {
  const LimbPair& hands = inputs.hands;
  const auto frequency_hz =
      MeanOf(hands, &LimbFeatures::frequency_valid, &LimbFeatures::frequency_hz);
  const bool run = frequency_hz && mapping_.border.IsRun(*frequency_hz, gait_.gait());
  biped::GaitCommand command = gait_.Advance(time_s, hands, run);
  if (!hands.left.present && !hands.right.present) turn_.Rest();
  command.turn_per_step_rad = turn_.Advance(
      time_s, MeanOf(hands, &LimbFeatures::inclination_valid, &LimbFeatures::roll_rad));

  state_ = {
      .interface = stream::UserInterface::kWrist,
      .border_hz = mapping_.border.border_hz,
      .turn = {
          .valid = turn_.valid(), .source = stream::TurnSource::kHands, .share = turn_.share()}};
  gait_.Describe(hands, state_);
  state_.missing_roles = Missing(hands.left, stream::DeviceRole::kLeftHand) |
                         Missing(hands.right, stream::DeviceRole::kRightHand);
  return command;
}

}  // namespace footing::mapping
