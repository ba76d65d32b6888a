#pragma once

#include "common/stream/character.h"
#include "common/stream/device.h"
#include "common/stream/sensor.h"
#include "footing/v1/character.pb.h"
#include "footing/v1/device.pb.h"
#include "footing/v1/sensor.pb.h"

/// Between the plain structs of common/stream and the messages of the protocol. Enums have the same
/// numbers on both sides; an unknown number becomes kUnspecified. A number that is not finite
/// becomes 0 on the way out, so nothing published is ever NaN, and on the way in, where a server
/// may not be ours; a rotation becomes the identity. Text is made valid UTF-8.
namespace footing::wire {

v1::Vector3 ToProto(const Eigen::Vector3d& value);
v1::Quaternion ToProto(const Eigen::Quaterniond& value);
v1::DeviceStatus ToProto(const stream::DeviceStatus& value);
v1::RawReport ToProto(const stream::RawReport& value);
v1::MotionSample ToProto(const stream::MotionSample& value);
v1::RigFeatures ToProto(const stream::RigFeatures& value);
v1::BoardSample ToProto(const stream::BoardSample& value);
v1::Skeleton ToProto(const stream::Skeleton& value);
v1::Track ToProto(const stream::Track& value);
v1::LinkPose ToProto(const stream::LinkPose& value);
v1::Contact ToProto(const stream::Contact& value);
v1::GaitState ToProto(const stream::GaitState& value);

Eigen::Vector3d FromProto(const v1::Vector3& value);
Eigen::Quaterniond FromProto(const v1::Quaternion& value);
stream::DeviceStatus FromProto(const v1::DeviceStatus& value);
stream::RawReport FromProto(const v1::RawReport& value);
stream::MotionSample FromProto(const v1::MotionSample& value);
stream::RigFeatures FromProto(const v1::RigFeatures& value);
stream::BoardSample FromProto(const v1::BoardSample& value);
stream::Skeleton FromProto(const v1::Skeleton& value);
stream::Track FromProto(const v1::Track& value);
stream::LinkPose FromProto(const v1::LinkPose& value);

}  // namespace footing::wire
