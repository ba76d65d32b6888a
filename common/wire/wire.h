#pragma once

#include "common/stream/game.h"
#include "common/stream/hands.h"
#include "common/stream/response.h"
#include "common/stream/track.h"
#include "common/stream/trial.h"
#include "common/stream/user_interface.h"
#include "common/wire/messages.h"

namespace footing::rig {
struct Tick;
}  // namespace footing::rig
namespace footing::v1 {
class Tick;
}  // namespace footing::v1

/// Between the plain structs of common/stream and the messages of the protocol: ToProto and
/// FromProto. Enums have the same numbers on both sides; an unknown number becomes kUnspecified. A
/// number that is not finite becomes 0 on the way out, so nothing published is ever NaN, and on the
/// way in, where a server may not be ours; a rotation becomes the identity. Text is made valid
/// UTF-8. HandFrame, ReferenceFrame and ContactFrame come in as they are, with what is not finite:
/// footingd checks and refuses them. messages.h has the pairs that are 1:1 by proto/structs.toml;
/// the rest stands here.
namespace footing::wire {

void Write(const Eigen::Vector3d& value, v1::Vector3& message);
void Write(const Eigen::Quaterniond& value, v1::Quaternion& message);
v1::Vector3 ToProto(const Eigen::Vector3d& value);
v1::Quaternion ToProto(const Eigen::Quaterniond& value);
Eigen::Vector3d FromProto(const v1::Vector3& message);
Eigen::Quaterniond FromProto(const v1::Quaternion& message);

/// Three numbers a joint become a vector; those that are missing are NaN, so that a check finds
/// them.
v1::ReferenceFrame ToProto(const stream::ReferenceFrame& value);
stream::ReferenceFrame FromProto(const v1::ReferenceFrame& message);

/// The channels of a tick of which a rig::Tick consists. Samples of forces, places and directions
/// that are not finite are left out.
rig::Tick SensorTick(const v1::Tick& message);

}  // namespace footing::wire
