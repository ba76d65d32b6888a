#include "daemon/sensor/service/publish.h"

#include <utility>

#include "common/wire/wire.h"
#include "footing/v1/session.pb.h"

namespace footing::sensor {
namespace {

using v1::Tick;

template <typename List>
void Append(std::vector<transport::ChannelBytes>& channels, int field, const List& list) {
  channels.push_back({static_cast<std::uint32_t>(field), list.SerializeAsString()});
}

}  // namespace

std::vector<transport::Channel> Channels() {
  return {{"status", Tick::kStatusFieldNumber, true},
          {"motion", Tick::kMotionFieldNumber, false},
          {"features", Tick::kFeaturesFieldNumber, false},
          {"boards", Tick::kBoardsFieldNumber, false},
          {"raw", Tick::kRawFieldNumber, false},
          {"nunchuk", Tick::kNunchukFieldNumber, false},
          {"camera", Tick::kCameraFieldNumber, false},
          {"setup", Tick::kSetupFieldNumber, true},
          {"hands", Tick::kHandsFieldNumber, false},
          {"reference", Tick::kReferenceFieldNumber, false},
          {"contacts", Tick::kContactsFieldNumber, false},
          {"gamepad", Tick::kGamepadFieldNumber, false}};
}

std::vector<transport::ChannelBytes> ToChannels(const TickContent& content) {
  std::vector<transport::ChannelBytes> channels;
  if (content.has_status) {
    v1::DeviceStatusList list;
    for (const auto& status : content.status) *list.add_devices() = wire::ToProto(status);
    Append(channels, Tick::kStatusFieldNumber, list);
  }
  if (!content.motion.empty()) {
    v1::MotionSamples list;
    for (const auto& sample : content.motion) *list.add_samples() = wire::ToProto(sample);
    Append(channels, Tick::kMotionFieldNumber, list);
  }
  if (!content.features.empty()) {
    v1::FeatureFrame frame;
    for (const auto& rig : content.features) *frame.add_rigs() = wire::ToProto(rig);
    Append(channels, Tick::kFeaturesFieldNumber, frame);
  }
  if (!content.boards.empty()) {
    v1::BoardSamples list;
    for (const auto& sample : content.boards) *list.add_samples() = wire::ToProto(sample);
    Append(channels, Tick::kBoardsFieldNumber, list);
  }
  if (content.has_setup) {
    v1::SetupState state;
    for (const auto& rig : content.setup) *state.add_rigs() = wire::ToProto(rig);
    Append(channels, Tick::kSetupFieldNumber, state);
  }
  if (!content.nunchuks.empty()) {
    v1::NunchukSamples list;
    for (const auto& sample : content.nunchuks) *list.add_samples() = wire::ToProto(sample);
    Append(channels, Tick::kNunchukFieldNumber, list);
  }
  if (!content.gamepads.empty()) {
    v1::GamepadSamples list;
    for (const auto& sample : content.gamepads) *list.add_samples() = wire::ToProto(sample);
    Append(channels, Tick::kGamepadFieldNumber, list);
  }
  if (!content.cameras.empty()) {
    v1::CameraSamples list;
    for (const auto& sample : content.cameras) *list.add_samples() = wire::ToProto(sample);
    Append(channels, Tick::kCameraFieldNumber, list);
  }
  if (!content.hands.empty()) {
    v1::HandSamples list;
    for (const auto& sample : content.hands) *list.add_samples() = wire::ToProto(sample);
    Append(channels, Tick::kHandsFieldNumber, list);
  }
  if (!content.reference.empty()) {
    v1::ReferencePoses list;
    for (const auto& pose : content.reference) *list.add_poses() = wire::ToProto(pose);
    Append(channels, Tick::kReferenceFieldNumber, list);
  }
  if (!content.contacts.empty()) {
    v1::ContactSamples list;
    for (const auto& sample : content.contacts) *list.add_samples() = wire::ToProto(sample);
    Append(channels, Tick::kContactsFieldNumber, list);
  }
  if (!content.raw.empty()) {
    v1::RawReports list;
    for (const auto& raw : content.raw) *list.add_reports() = wire::ToProto(raw);
    Append(channels, Tick::kRawFieldNumber, list);
  }
  return channels;
}

}  // namespace footing::sensor
