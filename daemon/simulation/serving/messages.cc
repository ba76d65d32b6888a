#include "daemon/simulation/serving/messages.h"

#include <google/protobuf/descriptor.h>

#include "common/wire/wire.h"

namespace footing::serving {
namespace {

constexpr std::uint32_t kCharacter = 1;

}  // namespace

v1::CharacterFrame MakeFrame(const FrameState& state, const std::string& world,
                             const std::string& rig) {
  v1::CharacterFrame message;
  message.set_world(world);
  message.set_step(state.step);
  message.set_time_s(state.time_s);
  message.set_overruns(state.overruns);
  message.set_state_hash(state.state_hash);
  v1::Character& character = *message.add_characters();
  character.set_character(kCharacter);
  character.set_rig(rig);
  character.set_valid(state.valid);
  *character.mutable_com_m() = wire::ToProto(state.p_WC_m);
  *character.mutable_com_velocity_mps() = wire::ToProto(state.v_WC_mps);
  character.set_simulated_input(state.simulated_input);
  return message;
}

v1::Event MakeEvent(v1::Event::Kind kind, std::int64_t host_ns, const std::string& text) {
  v1::Event event;
  event.set_kind(kind);
  event.set_host_ns(host_ns);
  event.set_character(kCharacter);
  event.set_text(text);
  return event;
}

void AddLeaseEvents(const std::vector<std::string>& changes, std::int64_t host_ns,
                    v1::Events& events) {
  for (const std::string& change : changes) {
    *events.add_events() = MakeEvent(v1::Event::KIND_LEASE, host_ns, change);
  }
}

v1::Skeletons MakeSkeletons(const std::string& world, const stream::Skeleton& skeleton) {
  v1::Skeletons skeletons;
  skeletons.set_world(world);
  v1::Skeleton& message = *skeletons.add_skeletons();
  message = wire::ToProto(skeleton);
  message.set_character(kCharacter);
  return skeletons;
}

std::optional<v1::CommandResult> RefuseOtherCharacter(const v1::Command& command) {
  namespace pb = google::protobuf;
  const pb::Reflection& fields = *command.GetReflection();
  const pb::OneofDescriptor* actions = v1::Command::descriptor()->FindOneofByName("action");
  const pb::FieldDescriptor* action = fields.GetOneofFieldDescriptor(command, actions);
  if (action == nullptr) return std::nullopt;
  const pb::FieldDescriptor* character = action->message_type()->FindFieldByName("character");
  if (character == nullptr) return std::nullopt;
  const pb::Message& message = fields.GetMessage(command, action);
  const std::uint32_t number = message.GetReflection()->GetUInt32(message, character);
  if (number == 0 || number == kCharacter) return std::nullopt;
  return Answer(false, action->name() + ": character " + std::to_string(number) +
                           " does not exist; this server has character " +
                           std::to_string(kCharacter));
}

v1::CommandResult Answer(bool ok, const std::string& message) {
  v1::CommandResult result;
  result.set_ok(ok);
  result.set_message(message);
  return result;
}

void AddFrame(const v1::CharacterFrame& frame, const v1::Events& events,
              const v1::AppliedInputs& inputs, std::vector<transport::ChannelBytes>& channels) {
  channels.push_back(Bytes(kCharacters, frame));
  if (events.events_size() > 0) channels.push_back(Bytes(kEvents, events));
  if (inputs.inputs_size() > 0) channels.push_back(Bytes(kInputs, inputs));
}

}  // namespace footing::serving
