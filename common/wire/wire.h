#pragma once

#include "common/stream/character.h"
#include "common/stream/contacts.h"
#include "common/stream/device.h"
#include "common/stream/game.h"
#include "common/stream/hands.h"
#include "common/stream/response.h"
#include "common/stream/sensor.h"
#include "common/stream/server_stats.h"
#include "common/stream/setup.h"
#include "common/stream/study.h"
#include "common/stream/user_interface.h"
#include "footing/v1/character.pb.h"
#include "footing/v1/device.pb.h"
#include "footing/v1/game.pb.h"
#include "footing/v1/sensor.pb.h"
#include "footing/v1/stats.pb.h"
#include "footing/v1/study.pb.h"

/// Between the plain structs of common/stream and the messages of the protocol. Enums have the same
/// numbers on both sides; an unknown number becomes kUnspecified. A number that is not finite
/// becomes 0 on the way out, so nothing published is ever NaN, and on the way in, where a server
/// may not be ours; a rotation becomes the identity. Text is made valid UTF-8. HandFrame,
/// ReferenceFrame and ContactFrame come in as they are, with what is not finite: footingd checks
/// and refuses them.
namespace footing::wire {

v1::Vector3 ToProto(const Eigen::Vector3d& value);
v1::Quaternion ToProto(const Eigen::Quaterniond& value);
v1::DeviceStatus ToProto(const stream::DeviceStatus& value);
v1::RawReport ToProto(const stream::RawReport& value);
v1::MotionSample ToProto(const stream::MotionSample& value);
v1::RigFeatures ToProto(const stream::RigFeatures& value);
v1::BoardSample ToProto(const stream::BoardSample& value);
v1::NunchukSample ToProto(const stream::NunchukSample& value);
v1::GamepadSample ToProto(const stream::GamepadSample& value);
v1::CameraPoint ToProto(const stream::CameraPoint& value);
v1::CameraSample ToProto(const stream::CameraSample& value);
v1::BoardPose ToProto(const stream::BoardPose& value);
v1::BoardGeometry ToProto(const stream::BoardGeometry& value);
v1::BoardLayout ToProto(const stream::BoardLayout& value);
v1::SetupItem ToProto(const stream::SetupItem& value);
v1::SetupPrompt ToProto(const stream::SetupPrompt& value);
v1::RigSetup ToProto(const stream::RigSetup& value);
v1::Skeleton ToProto(const stream::Skeleton& value);
v1::Track ToProto(const stream::Track& value);
v1::GamePlayer ToProto(const stream::GamePlayer& value);
v1::GameRound ToProto(const stream::GameRound& value);
v1::GameState ToProto(const stream::GameState& value);
v1::StudyState ToProto(const stream::StudyState& value);
v1::SessionStats ToProto(const stream::SessionStats& value);
stream::SessionStats FromProto(const v1::SessionStats& message);
v1::ServerStats ToProto(const stream::ServerStats& value);
v1::TrackSegment ToProto(const stream::TrackSegment& value);
v1::FailureCounts ToProto(const stream::FailureCounts& value);
v1::TrialState ToProto(const stream::TrialState& value);
v1::LinkPose ToProto(const stream::LinkPose& value);
v1::Contact ToProto(const stream::Contact& value);
v1::GaitState ToProto(const stream::GaitState& value);
v1::InterfaceState ToProto(const stream::InterfaceState& value);
v1::ResponseStages ToProto(const stream::ResponseStages& value);
v1::HandFrame ToProto(const stream::HandFrame& value);
v1::ReferenceFrame ToProto(const stream::ReferenceFrame& value);
v1::HandSample ToProto(const stream::HandSample& value);
v1::ReferencePose ToProto(const stream::ReferencePose& value);
v1::ContactFrame ToProto(const stream::ContactFrame& value);
v1::ContactSample ToProto(const stream::ContactSample& value);

Eigen::Vector3d FromProto(const v1::Vector3& value);
Eigen::Quaterniond FromProto(const v1::Quaternion& value);
stream::DeviceStatus FromProto(const v1::DeviceStatus& value);
stream::RawReport FromProto(const v1::RawReport& value);
stream::MotionSample FromProto(const v1::MotionSample& value);
stream::RigFeatures FromProto(const v1::RigFeatures& value);
stream::BoardSample FromProto(const v1::BoardSample& value);
stream::NunchukSample FromProto(const v1::NunchukSample& value);
stream::GamepadSample FromProto(const v1::GamepadSample& value);
stream::CameraPoint FromProto(const v1::CameraPoint& value);
stream::CameraSample FromProto(const v1::CameraSample& value);
stream::BoardPose FromProto(const v1::BoardPose& value);
stream::BoardGeometry FromProto(const v1::BoardGeometry& value);
stream::BoardLayout FromProto(const v1::BoardLayout& value);
stream::SetupItem FromProto(const v1::SetupItem& value);
stream::SetupPrompt FromProto(const v1::SetupPrompt& value);
stream::RigSetup FromProto(const v1::RigSetup& value);
stream::Skeleton FromProto(const v1::Skeleton& value);
stream::Track FromProto(const v1::Track& value);
stream::GamePlayer FromProto(const v1::GamePlayer& value);
stream::GameRound FromProto(const v1::GameRound& value);
stream::GameState FromProto(const v1::GameState& value);
stream::StudyState FromProto(const v1::StudyState& value);
stream::ServerStats FromProto(const v1::ServerStats& value);
stream::TrackSegment FromProto(const v1::TrackSegment& value);
stream::FailureCounts FromProto(const v1::FailureCounts& value);
stream::TrialState FromProto(const v1::TrialState& value);
stream::LinkPose FromProto(const v1::LinkPose& value);
stream::InterfaceState FromProto(const v1::InterfaceState& value);
stream::HandFrame FromProto(const v1::HandFrame& value);
stream::ReferenceFrame FromProto(const v1::ReferenceFrame& value);
stream::HandSample FromProto(const v1::HandSample& value);
stream::ReferencePose FromProto(const v1::ReferencePose& value);
stream::Contact FromProto(const v1::Contact& value);
stream::GaitState FromProto(const v1::GaitState& value);
stream::ResponseStages FromProto(const v1::ResponseStages& value);
stream::ContactFrame FromProto(const v1::ContactFrame& value);
stream::ContactSample FromProto(const v1::ContactSample& value);

}  // namespace footing::wire
