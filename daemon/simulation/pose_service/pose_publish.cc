#include "daemon/simulation/pose_service/pose_publish.h"

#include <algorithm>
#include <array>

#include "common/body/landmarks.h"
#include "common/wire/wire.h"
#include "daemon/simulation/pose_service/pose_note.h"

namespace footing::pose_service {
namespace {

using body::Landmark;

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
  *message.mutable_position_m() = wire::ToProto(foot.p_WF_m);
  *message.mutable_variance_m2() = wire::ToProto(foot.variance_m2);
  message.set_load_n(foot.load_n);
  message.set_cop_valid(foot.cop_valid);
  *message.mutable_cop_m() = wire::ToProto(foot.p_WP_m);
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
  *body.mutable_com_variance_m2() = wire::ToProto(frame.momentum.position_variance_m2);
  *body.mutable_com_acceleration_mps2() = wire::ToProto(frame.momentum.a_WC_mps2);
  *body.mutable_angular_momentum_kgm2ps() = wire::ToProto(frame.momentum.angular_momentum_kgm2ps);
  *body.mutable_angular_momentum_variance() =
      wire::ToProto(frame.momentum.angular_momentum_variance);
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
  for (const bool told : frame.input.feet_measured) body.add_feet_told(told);
}

void SetFootInput(const momentum::FootLoads& foot, v1::PoseFoot& message) {
  message.set_valid(foot.valid);
  for (std::size_t i = 0; i < foot.count; ++i) {
    v1::PoseCell& cell = *message.add_cells();
    *cell.mutable_position_m() = wire::ToProto(foot.cells[i].p_WS_m);
    cell.set_load_n(foot.cells[i].load_n);
  }
}

void SetImpulse(const board::BoardImpulse& impulse, v1::PoseFoot& message) {
  if (!impulse.valid) return;
  message.set_sampled_s(impulse.sampled_s);
  for (const double impulse_ns : impulse.impulse_ns) message.add_impulse_ns(impulse_ns);
}

board::BoardImpulse ImpulseFrom(const v1::PoseFoot& message) {
  board::BoardImpulse impulse;
  impulse.valid = message.impulse_ns_size() == static_cast<int>(board::kCorners);
  if (!impulse.valid) return impulse;
  impulse.sampled_s = message.sampled_s();
  std::copy(message.impulse_ns().begin(), message.impulse_ns().end(), impulse.impulse_ns.begin());
  return impulse;
}

void SetInsoleInput(const reconstruction::InsoleFoot& foot, v1::PoseFoot& message) {
  for (std::size_t i = 0; foot.valid && i < foot.count; ++i) {
    v1::PoseCell& cell = *message.add_insole_cells();
    cell.mutable_position_m()->set_x(foot.p_S_m[i].x());
    cell.mutable_position_m()->set_y(foot.p_S_m[i].y());
    cell.set_load_n(foot.load_n[i]);
  }
}

reconstruction::InsoleFoot InsoleFrom(const v1::PoseFoot& message) {
  reconstruction::InsoleFoot foot;
  foot.count = std::min(static_cast<std::size_t>(message.insole_cells_size()), momentum::kMaxCells);
  foot.valid = foot.count > 0;
  for (std::size_t i = 0; i < foot.count; ++i) {
    const v1::PoseCell& cell = message.insole_cells(static_cast<int>(i));
    foot.p_S_m[i] = wire::FromProto(cell.position_m()).head<2>();
    foot.load_n[i] = cell.load_n();
  }
  return foot;
}

momentum::FootLoads FootFrom(const v1::PoseFoot& message) {
  momentum::FootLoads foot;
  foot.valid = message.valid();
  foot.count = std::min(static_cast<std::size_t>(message.cells_size()), momentum::kMaxCells);
  for (std::size_t i = 0; i < foot.count; ++i) {
    const v1::PoseCell& cell = message.cells(static_cast<int>(i));
    foot.cells[i] = {wire::FromProto(cell.position_m()), cell.load_n()};
  }
  return foot;
}

void SetHandInput(const reconstruction::HandInput& hand, v1::PoseHand& message) {
  message.set_valid(hand.valid);
  *message.mutable_position_m() = wire::ToProto(hand.p_W_m);
  *message.mutable_sd_m() = wire::ToProto(hand.sd_m);
}

void SetArmInput(const arms::ArmEstimate& arm, v1::PoseHand& message) {
  if (!arm.valid) return;
  v1::PoseArm& told = *message.mutable_arm();
  *told.mutable_upper() = wire::ToProto(arm.directions.upper);
  *told.mutable_hinge() = wire::ToProto(arm.directions.hinge);
  *told.mutable_forearm() = wire::ToProto(arm.directions.forearm);
  *told.mutable_upper_sd() = wire::ToProto(arm.upper_sd);
  *told.mutable_hinge_sd() = wire::ToProto(arm.hinge_sd);
  *told.mutable_forearm_sd() = wire::ToProto(arm.forearm_sd);
}

arms::ArmEstimate ArmFrom(const v1::PoseHand& message) {
  arms::ArmEstimate arm;
  arm.valid = message.has_arm();
  if (!arm.valid) return arm;
  const v1::PoseArm& told = message.arm();
  arm.directions = {wire::FromProto(told.upper()), wire::FromProto(told.hinge()),
                    wire::FromProto(told.forearm())};
  arm.upper_sd = wire::FromProto(told.upper_sd());
  arm.hinge_sd = wire::FromProto(told.hinge_sd());
  arm.forearm_sd = wire::FromProto(told.forearm_sd());
  return arm;
}

reconstruction::HandInput HandFrom(const v1::PoseHand& message) {
  reconstruction::HandInput hand;
  hand.valid = message.valid();
  hand.p_W_m = wire::FromProto(message.position_m());
  hand.sd_m = wire::FromProto(message.sd_m());
  return hand;
}

}  // namespace

v1::CharacterFrame ToCharacterFrame(const PoseFrame& frame, const Subject& subject,
                                    const std::string& mode, const std::string& world,
                                    const std::string& rig, const std::string& tracker) {
  v1::CharacterFrame message;
  message.set_world(world);
  message.set_step(frame.step);
  message.set_time_s(frame.time_s);
  message.set_overruns(frame.overruns);
  message.set_state_hash(frame.state_hash);
  v1::Character& character = *message.add_characters();
  character.set_character(1);
  character.set_rig(rig);
  character.set_valid(frame.valid);
  for (std::size_t i = 0; i < frame.links.count; ++i) {
    *character.add_links() = wire::ToProto(frame.links.pose[i]);
  }
  for (const auto& foot : frame.momentum.feet) {
    *character.add_contacts() = wire::ToProto(
        stream::Contact{foot.contact, foot.cop_valid ? foot.p_WP_m : foot.p_WF_m, foot.load_n});
  }
  *character.mutable_com_m() = wire::ToProto(frame.momentum.p_WC_m);
  *character.mutable_com_velocity_mps() = wire::ToProto(frame.momentum.v_WC_mps);
  character.set_simulated_input(frame.input.simulated);
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
  SetFootInput(inputs.sensors.loads.feet[0], *pose.mutable_left_foot());
  SetFootInput(inputs.sensors.loads.feet[1], *pose.mutable_right_foot());
  SetImpulse(inputs.impulses[0], *pose.mutable_left_foot());
  SetImpulse(inputs.impulses[1], *pose.mutable_right_foot());
  SetInsoleInput(inputs.insoles[0], *pose.mutable_left_foot());
  SetInsoleInput(inputs.insoles[1], *pose.mutable_right_foot());
  SetHandInput(inputs.sensors.hands[0], *pose.mutable_left_hand());
  SetHandInput(inputs.sensors.hands[1], *pose.mutable_right_hand());
  SetArmInput(inputs.sensors.arms[0], *pose.mutable_left_hand());
  SetArmInput(inputs.sensors.arms[1], *pose.mutable_right_hand());
  pose.set_calibrate_number(inputs.calibrate_number);
  pose.set_subject_number(inputs.subject_number);
  pose.set_subject_code(subject.code);
  pose.set_subject_height_m(subject.height_m);
  pose.set_subject_mass_kg(subject.mass_kg);
  pose.set_subject_foot_length_m(subject.foot_length_m);
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
  inputs.sensors.loads.feet = {FootFrom(pose.left_foot()), FootFrom(pose.right_foot())};
  inputs.impulses = {ImpulseFrom(pose.left_foot()), ImpulseFrom(pose.right_foot())};
  inputs.insoles = {InsoleFrom(pose.left_foot()), InsoleFrom(pose.right_foot())};
  inputs.sensors.hands = {HandFrom(pose.left_hand()), HandFrom(pose.right_hand())};
  inputs.sensors.arms = {ArmFrom(pose.left_hand()), ArmFrom(pose.right_hand())};
  inputs.calibrate_number = pose.calibrate_number();
  inputs.subject_number = pose.subject_number();
  return applied;
}

Subject SubjectFrom(const v1::AppliedInput& message) {
  const v1::PoseInput& pose = message.pose();
  return {pose.subject_code(), pose.subject_height_m(), pose.subject_mass_kg(),
          pose.subject_foot_length_m()};
}

}  // namespace footing::pose_service
