#include "common/wire/wire.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "common/rig/follower.h"
#include "common/wire/scalar.h"
#include "footing/v1/session.pb.h"

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

namespace {

bool IsFinite(const v1::Vector3& v) {
  return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}

bool IsFinite(const v1::MotionSample& sample) {
  return IsFinite(sample.specific_force_mps2()) && IsFinite(sample.angular_velocity_radps());
}

bool IsFinite(const v1::NunchukSample& sample) {
  return std::isfinite(sample.stick_x()) && std::isfinite(sample.stick_y());
}

bool IsFinite(const v1::BoardSample& sample) {
  return std::isfinite(sample.top_left_n()) && std::isfinite(sample.top_right_n()) &&
         std::isfinite(sample.bottom_left_n()) && std::isfinite(sample.bottom_right_n()) &&
         std::isfinite(sample.cop_x_m()) && std::isfinite(sample.cop_y_m());
}

/// The place of a point that was not seen means nothing.
bool IsFinite(const v1::HandSample& sample) {
  return sample.confidence() == 0 || (IsFinite(sample.position_m()) && IsFinite(sample.sd_m()) &&
                                      IsFinite(sample.covariance_m2()));
}

bool IsFinite(const v1::ContactSample& sample) {
  return std::all_of(sample.cells().begin(), sample.cells().end(), [](const v1::ContactCell& cell) {
    return std::isfinite(cell.x_m()) && std::isfinite(cell.y_m()) && std::isfinite(cell.load_n());
  });
}

/// Features and what has no samples: FromProto makes its numbers finite.
template <typename Message>
bool IsFinite(const Message&) {
  return true;
}

template <typename Messages, typename Value>
void Append(const Messages& messages, std::vector<Value>& values) {
  for (const auto& message : messages) {
    if (IsFinite(message)) values.push_back(wire::FromProto(message));
  }
}

}  // namespace

rig::Tick SensorTick(const v1::Tick& message) {
  rig::Tick tick;
  tick.epoch = message.epoch();
  tick.sequence = message.sequence();
  tick.host_ns = message.host_ns();
  tick.snapshot = message.snapshot();
  tick.refilled = message.refilled();
  if (message.has_status()) Append(message.status().devices(), tick.devices.emplace());
  if (message.has_setup()) Append(message.setup().rigs(), tick.setup.emplace());
  Append(message.motion().samples(), tick.motion);
  Append(message.nunchuk().samples(), tick.nunchuks);
  Append(message.features().rigs(), tick.features);
  Append(message.boards().samples(), tick.boards);
  Append(message.hands().samples(), tick.hands);
  Append(message.contacts().samples(), tick.contacts);
  return tick;
}

}  // namespace footing::wire
