#include "daemon/simulation/pose_service/pose_applied.h"

#include <algorithm>

#include "common/wire/fields.h"

namespace footing::pose_service {
namespace {

using wire::FromProto;
using wire::ToProto;

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
  if (!Way::kOut || !way.value.covariance_m2.isZero(0)) {
    FOOTING_MESSAGE(covariance_m2);
  }
  FOOTING_FIELD(of_skeleton);
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

/// Of the joints those that are seen.
void SetJoints(const reconstruction::JointInputs& joints, v1::PoseInput& message) {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const reconstruction::JointInput& joint = joints[i];
    if (!joint.valid) continue;
    v1::PoseJoint& one = *message.add_joints();
    one.set_joint(static_cast<v1::BodyJoint>(i + 1));
    *one.mutable_position_m() = ToProto(joint.p_W_m);
    *one.mutable_sd_m() = ToProto(joint.sd_m);
    if (!joint.covariance_m2.isZero(0)) *one.mutable_covariance_m2() = ToProto(joint.covariance_m2);
  }
}

reconstruction::JointInputs GetJoints(const v1::PoseInput& message) {
  reconstruction::JointInputs joints;
  for (const v1::PoseJoint& one : message.joints()) {
    if (one.joint() < 1 || one.joint() > static_cast<int>(joints.size())) continue;
    joints[static_cast<std::size_t>(one.joint() - 1)] = {
        true, FromProto(one.position_m()), FromProto(one.sd_m()), FromProto(one.covariance_m2())};
  }
  return joints;
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
  SetJoints(inputs.sensors.joints, pose);
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
  inputs.sensors.joints = GetJoints(pose);
  for (reconstruction::HandInput& hand : inputs.sensors.hands) {
    hand.of_skeleton = hand.of_skeleton || pose.hands_of_skeleton();
  }
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
