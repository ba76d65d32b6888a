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

/// A channel of one repeated message; none when there is nothing in it.
template <typename Values, typename List, typename Element>
void AppendList(std::vector<transport::ChannelBytes>& channels, int field, const Values& values,
                Element* (List::*add)()) {
  if (values.empty()) return;
  List list;
  for (const auto& value : values) *(list.*add)() = wire::ToProto(value);
  Append(channels, field, list);
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
  AppendList(channels, Tick::kMotionFieldNumber, content.motion, &v1::MotionSamples::add_samples);
  AppendList(channels, Tick::kFeaturesFieldNumber, content.features, &v1::FeatureFrame::add_rigs);
  AppendList(channels, Tick::kBoardsFieldNumber, content.boards, &v1::BoardSamples::add_samples);
  if (content.has_setup) {
    v1::SetupState state;
    for (const auto& rig : content.setup) *state.add_rigs() = wire::ToProto(rig);
    Append(channels, Tick::kSetupFieldNumber, state);
  }
  AppendList(channels, Tick::kNunchukFieldNumber, content.nunchuks,
             &v1::NunchukSamples::add_samples);
  AppendList(channels, Tick::kGamepadFieldNumber, content.gamepads,
             &v1::GamepadSamples::add_samples);
  AppendList(channels, Tick::kCameraFieldNumber, content.cameras, &v1::CameraSamples::add_samples);
  AppendList(channels, Tick::kHandsFieldNumber, content.hands, &v1::HandSamples::add_samples);
  AppendList(channels, Tick::kReferenceFieldNumber, content.reference,
             &v1::ReferencePoses::add_poses);
  AppendList(channels, Tick::kContactsFieldNumber, content.contacts,
             &v1::ContactSamples::add_samples);
  AppendList(channels, Tick::kRawFieldNumber, content.raw, &v1::RawReports::add_reports);
  return channels;
}

}  // namespace footing::sensor
