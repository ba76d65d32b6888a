#include "daemon/simulation/pose_service/pose_publish.h"

#include <algorithm>
#include <array>

#include "common/body/landmarks.h"
#include "common/wire/fields.h"
#include "daemon/simulation/pose_service/pose_note.h"
#include "daemon/simulation/serving/messages.h"

namespace footing::pose_service {
namespace {

using body::Landmark;
using wire::FromProto;
using wire::ToProto;

/// Thickness of a body at its joints over its height, by eye from anatomical proportions.
struct Thickness {
  Landmark landmark;
  double of_height;
};
constexpr std::array<Thickness, 13> kThickness{{
    {Landmark::kHips, 0.125},
    {Landmark::kChest, 0.13},
    {Landmark::kNeck, 0.065},
    {Landmark::kHead, 0.065},
    {Landmark::kLeftClavicle, 0.07},
    {Landmark::kLeftShoulder, 0.062},
    {Landmark::kLeftElbow, 0.046},
    {Landmark::kLeftWrist, 0.034},
    {Landmark::kLeftHip, 0.095},
    {Landmark::kLeftKnee, 0.062},
    {Landmark::kLeftAnkle, 0.042},
    {Landmark::kLeftToe, 0.040},
    {Landmark::kLeftToeEnd, 0.028},
}};
constexpr double kElseOfHeight = 0.03;

void SetFoot(const momentum::FootEstimate& foot, v1::BodyFoot& message) {
  message.set_contact(foot.contact);
  message.set_valid(foot.valid);
  *message.mutable_position_m() = ToProto(foot.p_WF_m);
  *message.mutable_variance_m2() = ToProto(foot.variance_m2);
  message.set_load_n(foot.load_n);
  message.set_cop_valid(foot.cop_valid);
  *message.mutable_cop_m() = ToProto(foot.p_WP_m);
  message.set_airborne_s(foot.airborne_s);
}

std::string HandsSource(const PoseFrame& frame, const std::string& tracker) {
  if (frame.input.hands_valid[0] || frame.input.hands_valid[1])
    return tracker.empty() ? "tracker" : tracker;
  return frame.input.arms_valid[0] || frame.input.arms_valid[1] ? "wiimote" : "";
}

void SetBody(const PoseFrame& frame, const Subject& subject, const std::string& mode,
             const std::string& tracker, v1::BodyState& body) {
  body.set_subject(subject.code);
  body.set_mode(mode);
  body.set_calibrated(frame.t_pose.complete);
  body.set_calibration_progress(frame.t_pose.progress);
  body.set_calibration_restarts(frame.t_pose.restarts);
  body.set_mass_kg(frame.t_pose.mass_kg);
  body.set_height_m(subject.height_m);
  body.set_lag_s(frame.lag_s);
  body.set_momentum_valid(frame.momentum.valid);
  *body.mutable_com_variance_m2() = ToProto(frame.momentum.position_variance_m2);
  *body.mutable_com_acceleration_mps2() = ToProto(frame.momentum.a_WC_mps2);
  *body.mutable_angular_momentum_kgm2ps() = ToProto(frame.momentum.angular_momentum_kgm2ps);
  *body.mutable_angular_momentum_variance() = ToProto(frame.momentum.angular_momentum_variance);
  for (const auto& foot : frame.momentum.feet) SetFoot(foot, *body.add_feet());
  body.set_resets(frame.resets);
  for (std::size_t i = 0; i < frame.links.count; ++i) body.add_link_sd_m(frame.links.sd_m[i]);
  body.set_note(PoseNote(frame, subject));
  body.set_solve_us(frame.solve_us);
  for (std::size_t side = 0; side < reconstruction::kHands; ++side) {
    body.add_hands_seen(frame.input.hands_valid[side] || frame.input.arms_valid[side]);
  }
  body.set_hands_source(HandsSource(frame, tracker));
  body.set_contact_source(frame.input.source == PoseSource::kInsoles ? "insoles" : "boards");
  for (const bool measured : frame.input.feet_measured) body.add_feet_told(measured);
}

template <typename Way>
void Fields(Way way, const momentum::Cell&) {
  FOOTING_MESSAGE_OF(p_WS_m, position_m);
  FOOTING_FIELD(load_n);
}
FOOTING_BOTH_WAYS_OF(momentum::Cell, v1::PoseCell)

template <typename Way>
void Fields(Way way, const momentum::FootLoads&) {
  FOOTING_FIELD(valid);
  if constexpr (Way::kOut) {
    for (std::size_t i = 0; i < way.value.count; ++i) {
      *way.message.add_cells() = ToProto(way.value.cells[i]);
    }
  } else {
    const auto& cells = way.message.cells();
    way.value.count = std::min(static_cast<std::size_t>(cells.size()), momentum::kMaxCells);
    for (std::size_t i = 0; i < way.value.count; ++i) {
      way.value.cells[i] = FromProto(cells.Get(static_cast<int>(i)));
    }
  }
}

/// Valid where there is an impulse for each corner.
template <typename Way>
void Fields(Way way, const board::BoardImpulse&) {
  if constexpr (Way::kOut) {
    if (!way.value.valid) return;
    for (const double impulse_ns : way.value.impulse_ns) way.message.add_impulse_ns(impulse_ns);
  } else {
    const auto& impulses = way.message.impulse_ns();
    way.value.valid = impulses.size() == static_cast<int>(board::kCorners);
    if (!way.value.valid) return;
    std::copy(impulses.begin(), impulses.end(), way.value.impulse_ns.begin());
  }
  FOOTING_FIELD(sampled_s);
}

/// Valid where there are cells.
template <typename Way>
void Fields(Way way, const reconstruction::InsoleFoot&) {
  if constexpr (Way::kOut) {
    for (std::size_t i = 0; way.value.valid && i < way.value.count; ++i) {
      const Eigen::Vector2d& p_S_m = way.value.p_S_m[i];
      *way.message.add_insole_cells() =
          ToProto(momentum::Cell{{p_S_m.x(), p_S_m.y(), 0}, way.value.load_n[i]});
    }
  } else {
    const auto& cells = way.message.insole_cells();
    way.value.count = std::min(static_cast<std::size_t>(cells.size()), momentum::kMaxCells);
    way.value.valid = way.value.count > 0;
    for (std::size_t i = 0; i < way.value.count; ++i) {
      const momentum::Cell cell = FromProto(cells.Get(static_cast<int>(i)));
      way.value.p_S_m[i] = cell.p_WS_m.head<2>();
      way.value.load_n[i] = cell.load_n;
    }
  }
}

template <typename Way>
void Fields(Way way, const reconstruction::HandInput&) {
  FOOTING_FIELD(valid);
  FOOTING_MESSAGE_OF(p_W_m, position_m);
  FOOTING_MESSAGE(sd_m);
}

template <typename Way>
void Fields(Way way, const arms::ArmEstimate&) {
  FOOTING_MESSAGE_OF(directions.upper, upper);
  FOOTING_MESSAGE_OF(directions.hinge, hinge);
  FOOTING_MESSAGE_OF(directions.forearm, forearm);
  FOOTING_MESSAGE(upper_sd);
  FOOTING_MESSAGE(hinge_sd);
  FOOTING_MESSAGE(forearm_sd);
}
FOOTING_BOTH_WAYS_OF(arms::ArmEstimate, v1::PoseArm)

template <typename Way>
void Fields(Way way, const Subject&) {
  FOOTING_FIELD_OF(code, subject_code);
  FOOTING_FIELD_OF(height_m, subject_height_m);
  FOOTING_FIELD_OF(mass_kg, subject_mass_kg);
  FOOTING_FIELD_OF(foot_length_m, subject_foot_length_m);
}

template <typename Value, typename Message>
void Set(const Value& value, Message& message) {
  Fields(wire::Out<Value, Message>{value, message}, value);
}

template <typename Value, typename Message>
void Get(const Message& message, Value& value) {
  Fields(wire::In<Value, Message>{value, message}, value);
}

void SetSide(const PoseInputs& inputs, std::size_t side, v1::PoseFoot& foot, v1::PoseHand& hand) {
  Set(inputs.sensors.loads.feet[side], foot);
  Set(inputs.impulses[side], foot);
  Set(inputs.insoles[side], foot);
  Set(inputs.sensors.hands[side], hand);
  const arms::ArmEstimate& arm = inputs.sensors.arms[side];
  if (arm.valid) *hand.mutable_arm() = ToProto(arm);
}

void GetSide(const v1::PoseFoot& foot, const v1::PoseHand& hand, std::size_t side,
             PoseInputs& inputs) {
  Get(foot, inputs.sensors.loads.feet[side]);
  Get(foot, inputs.impulses[side]);
  Get(foot, inputs.insoles[side]);
  Get(hand, inputs.sensors.hands[side]);
  arms::ArmEstimate& arm = inputs.sensors.arms[side];
  if (hand.has_arm()) arm = FromProto(hand.arm());
  arm.valid = hand.has_arm();
}

}  // namespace

v1::CharacterFrame ToCharacterFrame(const PoseFrame& frame, const Subject& subject,
                                    const std::string& mode, const std::string& world,
                                    const std::string& rig, const std::string& tracker) {
  v1::CharacterFrame message = serving::MakeFrame({.step = frame.step,
                                                   .time_s = frame.time_s,
                                                   .overruns = frame.overruns,
                                                   .state_hash = frame.state_hash,
                                                   .valid = frame.valid,
                                                   .p_WC_m = frame.momentum.p_WC_m,
                                                   .v_WC_mps = frame.momentum.v_WC_mps,
                                                   .simulated_input = frame.input.simulated},
                                                  world, rig);
  v1::Character& character = *message.mutable_characters(0);
  for (std::size_t i = 0; i < frame.links.count; ++i) {
    *character.add_links() = ToProto(frame.links.pose[i]);
  }
  for (const auto& foot : frame.momentum.feet) {
    *character.add_contacts() = ToProto(
        stream::Contact{foot.contact, foot.cop_valid ? foot.p_WP_m : foot.p_WF_m, foot.load_n});
  }
  SetBody(frame, subject, mode, tracker, *character.mutable_body());
  return message;
}

stream::Skeleton ToSkeleton(const body::Body& body) {
  stream::Skeleton skeleton;
  skeleton.character = 1;
  skeleton.name = "person";
  skeleton.contact_points = {"left_foot", "right_foot"};
  for (const body::Joint& joint : body.skeleton.joints) {
    const double size_m = kElseOfHeight * body.height_m;
    skeleton.links.push_back({joint.name, joint.parent, Eigen::Vector3d::Constant(size_m)});
  }
  for (const Thickness& thickness : kThickness) {
    for (const Landmark landmark : {thickness.landmark, body::Mirrored(thickness.landmark)}) {
      const int joint = body.landmarks[landmark];
      if (joint < 0) continue;
      skeleton.links[static_cast<std::size_t>(joint)].size_m.setConstant(thickness.of_height *
                                                                         body.height_m);
    }
  }
  return skeleton;
}

v1::AppliedInput ToAppliedInput(const PoseApplied& applied, const Subject& subject) {
  const PoseInputs& inputs = applied.inputs;
  v1::AppliedInput message;
  message.set_step(applied.step);
  message.set_sensor_epoch(inputs.sensor_epoch);
  message.set_sensor_sequence(inputs.sensor_sequence);
  message.set_simulated(inputs.simulated);
  v1::PoseInput& pose = *message.mutable_pose();
  SetSide(inputs, 0, *pose.mutable_left_foot(), *pose.mutable_left_hand());
  SetSide(inputs, 1, *pose.mutable_right_foot(), *pose.mutable_right_hand());
  pose.set_calibrate_number(inputs.calibrate_number);
  pose.set_subject_number(inputs.subject_number);
  Set(subject, pose);
  return message;
}

PoseApplied PoseAppliedFrom(const v1::AppliedInput& message) {
  PoseApplied applied;
  applied.step = message.step();
  PoseInputs& inputs = applied.inputs;
  inputs.sensor_epoch = message.sensor_epoch();
  inputs.sensor_sequence = message.sensor_sequence();
  inputs.simulated = message.simulated();
  const v1::PoseInput& pose = message.pose();
  GetSide(pose.left_foot(), pose.left_hand(), 0, inputs);
  GetSide(pose.right_foot(), pose.right_hand(), 1, inputs);
  inputs.calibrate_number = pose.calibrate_number();
  inputs.subject_number = pose.subject_number();
  return applied;
}

Subject SubjectFrom(const v1::AppliedInput& message) {
  Subject subject;
  Get(message.pose(), subject);
  return subject;
}

}  // namespace footing::pose_service
