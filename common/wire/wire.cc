#include "common/wire/wire.h"

#include <limits>

#include "common/wire/scalar.h"

namespace footing::wire {
namespace {

/// Three numbers from `first` on.
template <typename Numbers>
Eigen::Vector3d Triple(const Numbers& numbers, int first) {
  Eigen::Vector3d value = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  for (int i = 0; i < 3 && first + i < numbers.size(); ++i)
    value[i] = static_cast<double>(numbers.Get(first + i));
  return value;
}

}  // namespace

void Write(const Eigen::Vector3d& value, v1::Vector3& message) {
  message.set_x(Finite(value.x()));
  message.set_y(Finite(value.y()));
  message.set_z(Finite(value.z()));
}

void Write(const Eigen::Quaterniond& value, v1::Quaternion& message) {
  const bool whole = value.coeffs().allFinite();
  message.set_w(whole ? value.w() : 1.0);
  message.set_x(whole ? value.x() : 0.0);
  message.set_y(whole ? value.y() : 0.0);
  message.set_z(whole ? value.z() : 0.0);
}

v1::Vector3 ToProto(const Eigen::Vector3d& value) {
  v1::Vector3 message;
  Write(value, message);
  return message;
}

v1::Quaternion ToProto(const Eigen::Quaterniond& value) {
  v1::Quaternion message;
  Write(value, message);
  return message;
}

Eigen::Vector3d FromProto(const v1::Vector3& message) {
  return {Finite(message.x()), Finite(message.y()), Finite(message.z())};
}

Eigen::Quaterniond FromProto(const v1::Quaternion& message) {
  const Eigen::Quaterniond value(message.w(), message.x(), message.y(), message.z());
  const bool rotation = value.coeffs().allFinite() && value.squaredNorm() > 0;
  return rotation ? value : Eigen::Quaterniond::Identity();
}

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

}  // namespace footing::wire
