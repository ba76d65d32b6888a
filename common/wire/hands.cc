#include <limits>

#include "common/wire/fields.h"

namespace footing::wire {
namespace {

/// Three numbers from `first` on; what is missing is NaN, so that a check finds it.
template <typename Numbers>
Eigen::Vector3d Triple(const Numbers& numbers, int first) {
  Eigen::Vector3d value = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  for (int i = 0; i < 3 && first + i < numbers.size(); ++i)
    value[i] = static_cast<double>(numbers.Get(first + i));
  return value;
}

v1::TrackerPose ToProto(const stream::TrackerPose& value) {
  v1::TrackerPose message;
  message.set_x_m(Finite(value.position_m.x()));
  message.set_y_m(Finite(value.position_m.y()));
  message.set_z_m(Finite(value.position_m.z()));
  message.set_qw(Finite(value.rotation.w()));
  message.set_qx(Finite(value.rotation.x()));
  message.set_qy(Finite(value.rotation.y()));
  message.set_qz(Finite(value.rotation.z()));
  return message;
}

/// With what is not finite, so that a check finds it.
stream::TrackerPose FromProto(const v1::TrackerPose& message) {
  return {{message.x_m(), message.y_m(), message.z_m()},
          {message.qw(), message.qx(), message.qy(), message.qz()}};
}

}  // namespace

template <typename Way>
void Fields(Way way, const stream::TrackedPoint&) {
  FOOTING_ENUM(DeviceRole, role);
  FOOTING_FIELD_OF(position_m.x(), x_m);
  FOOTING_FIELD_OF(position_m.y(), y_m);
  FOOTING_FIELD_OF(position_m.z(), z_m);
  FOOTING_FIELD_OF(sd_m.x(), sd_x_m);
  FOOTING_FIELD_OF(sd_m.y(), sd_y_m);
  FOOTING_FIELD_OF(sd_m.z(), sd_z_m);
  FOOTING_FIELD(confidence);
  FOOTING_FIELD_OF(covariance_m2.x(), cov_xy_m2);
  FOOTING_FIELD_OF(covariance_m2.y(), cov_xz_m2);
  FOOTING_FIELD_OF(covariance_m2.z(), cov_yz_m2);
  FOOTING_FIELD(saturated);
  FOOTING_FIELD(occluded);
  FOOTING_ENUM(BodyJoint, joint);
}
FOOTING_BOTH_WAYS(TrackedPoint)

template <typename Way>
void Fields(Way way, const stream::HandFrame&) {
  FOOTING_FIELD(tracker);
  FOOTING_FIELD(rig);
  FOOTING_FIELD(age_ns);
  FOOTING_FIELD(sent_ns);
  if constexpr (Way::kOut) {
    for (const auto& point : way.value.points) *way.message.add_points() = ToProto(point);
  } else {
    for (const v1::TrackedPoint& point : way.message.points()) {
      stream::TrackedPoint& one = way.value.points.emplace_back(FromProto(point));
      one.position_m = {point.x_m(), point.y_m(), point.z_m()};  // With what is not finite.
      one.sd_m = {point.sd_x_m(), point.sd_y_m(), point.sd_z_m()};
      one.confidence = point.confidence();
      one.covariance_m2 = {point.cov_xy_m2(), point.cov_xz_m2(), point.cov_yz_m2()};
    }
  }
  FOOTING_FIELD(simulated);
  FOOTING_OPTIONAL(tracker_pose)
}
FOOTING_BOTH_WAYS(HandFrame)

v1::ReferenceFrame ToProto(const stream::ReferenceFrame& value) {
  v1::ReferenceFrame message;
  message.set_rig(Utf8(value.rig));
  message.set_age_ns(value.age_ns);
  message.set_sent_ns(value.sent_ns);
  for (const int parent : value.parents) message.add_parents(parent);
  for (const Eigen::Vector3d& position : value.positions_m) {
    for (int i = 0; i < 3; ++i) message.add_position_m(static_cast<float>(Finite(position[i])));
  }
  for (int i = 0; i < 3; ++i) message.add_com_m(static_cast<float>(Finite(value.com_m[i])));
  return message;
}

stream::ReferenceFrame FromProto(const v1::ReferenceFrame& message) {
  stream::ReferenceFrame value;
  value.rig = message.rig();
  value.age_ns = message.age_ns();
  value.sent_ns = message.sent_ns();
  value.parents.assign(message.parents().begin(), message.parents().end());
  for (int i = 0; i < message.position_m_size(); i += 3) {
    value.positions_m.push_back(Triple(message.position_m(), i));
  }
  value.com_m = Triple(message.com_m(), 0);
  return value;
}

template <typename Way>
void Fields(Way way, const stream::HandSample&) {
  FOOTING_FIELD(rig);
  FOOTING_ENUM(DeviceRole, role);
  FOOTING_FIELD(received_ns);
  FOOTING_FIELD(sampled_ns);
  FOOTING_MESSAGE(position_m);
  FOOTING_MESSAGE(sd_m);
  FOOTING_FIELD(confidence);
  FOOTING_FIELD(simulated);
  FOOTING_FIELD(tracker);
  if (!Way::kOut || !way.value.covariance_m2.isZero()) {
    FOOTING_MESSAGE(covariance_m2);
  }
  FOOTING_FIELD(saturated);
  FOOTING_FIELD(occluded);
  FOOTING_OPTIONAL(tracker_pose)
  FOOTING_ENUM(BodyJoint, joint);
}
FOOTING_BOTH_WAYS(HandSample)

v1::ReferencePose ToProto(const stream::ReferencePose& value) {
  v1::ReferencePose message;
  message.set_rig(Utf8(value.rig));
  message.set_sampled_ns(value.sampled_ns);
  for (const int parent : value.parents) message.add_parents(parent);
  for (const Eigen::Vector3d& position : value.positions_m) {
    *message.add_positions_m() = ToProto(position);
  }
  *message.mutable_com_m() = ToProto(value.com_m);
  return message;
}

stream::ReferencePose FromProto(const v1::ReferencePose& message) {
  stream::ReferencePose value;
  value.rig = message.rig();
  value.sampled_ns = message.sampled_ns();
  value.parents.assign(message.parents().begin(), message.parents().end());
  for (const v1::Vector3& position : message.positions_m()) {
    value.positions_m.push_back(FromProto(position));
  }
  value.com_m = FromProto(message.com_m());
  return value;
}

}  // namespace footing::wire
