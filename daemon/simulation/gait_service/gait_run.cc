#include "daemon/simulation/gait_service/gait_run.h"

#include <cmath>
#include <memory>
#include <utility>

#include "common/runtime/clock.h"
#include "common/runtime/files.h"
#include "common/runtime/log.h"
#include "common/wire/wire.h"
#include "daemon/simulation/biped/track.h"
#include "daemon/simulation/gait_service/applied_input.h"
#include "daemon/simulation/gait_service/config.h"
#include "daemon/simulation/gait_service/publish.h"
#include "daemon/simulation/serving/messages.h"

namespace footing::gait_service {

void GaitRun::UseTrackOnSimThread(std::uint64_t number, Frame& frame) {
  std::unique_ptr<engine::TrackWorld> next;
  while (number != 0 && engine_.track().number != number && tracks_->next.Pop(next)) {
    engine_.UseTrack(*next);
    tracks_->done.Push(std::move(next));  // It has space for all that are on their way.
    frame.added_count = 0;                // Those were the former track's.
  }
}

void GaitRun::StepOnSimThread(exchange::Latest<Inputs>& inputs, Frame& frame) {
  // One input adds at most kMaxAppends segments, of which each has its place in the frame.
  const bool fits =
      frame.applied_count < kMaxApplied && frame.added_count + engine::kMaxAppends <= kMaxAdded;
  if (fits && inputs.Refresh()) {
    Applied& applied = frame.applied[static_cast<std::size_t>(frame.applied_count++)];
    applied.step = engine_.Output().step + 1;
    applied.inputs = inputs.Front();
    UseTrackOnSimThread(inputs.Front().engine.trial.track_number, frame);
  }
  engine_.Advance(inputs.Front().engine);
  const engine::EngineOutput& output = engine_.Output();
  if (output.append.added && frame.added_count < kMaxAdded) {
    frame.added[static_cast<std::size_t>(frame.added_count++)] = engine_.track().segments.back();
  }
  if (output.response.commanded == output.step) frame.command_ns = clock::MonotonicNs();
  if (output.response.taken_over == output.step) frame.contact_ns = clock::MonotonicNs();
  for (int i = 0; i < output.event_count && frame.event_count < kMaxFrameEvents; ++i) {
    frame.events[static_cast<std::size_t>(frame.event_count++)] =
        output.events[static_cast<std::size_t>(i)];
  }
}

void GaitRun::TakenOnSimThread(Frame& frame) const {
  frame.event_count = 0;
  frame.applied_count = 0;
  frame.added_count = 0;
}

namespace {

constexpr std::size_t kMostTableBytes = 16 * 1024;

}  // namespace

Result<std::unique_ptr<GaitLine>> GaitLine::Create(const serving::Config& common,
                                                   const Config& config, int wake_descriptor) {
  const mapping::InterfaceOptions interface = OptionsOf(config);
  if (interface.boards_may_be_left) {  // SetInterface may choose the boards later.
    log::Warning(
        "boards_may_be_left: a person who jumps off a board can fall beside it; keep the floor "
        "around the boards free, and a second person near");
  }
  const auto texts = engine_files::ReadTexts({.track = config.track,
                                              .interface = interface.interface,
                                              .mapping_table = config.mapping_table,
                                              .data_folder = common.data_folder,
                                              .gaits = config.gaits});
  if (!texts) return texts.error();
  engine::EngineConfig engine_config;
  engine_config.fall_shown_s = config.fall_shown_s;
  engine_config.put_back_distance_m = config.put_back_distance_m;
  engine_config.features_timeout_s = config.features_timeout_s;
  engine_config.interface = interface;
  auto engine = engine::GaitEngine::Create(*texts, engine_config);
  if (!engine) return engine.error();
  const auto biped = biped::ParseBiped(texts->biped, engine::kBipedFile);
  if (!biped) return biped.error();
  return std::unique_ptr<GaitLine>(
      new GaitLine(common.rig, config, std::move(engine).value(),
                   {config.track, common.data_folder, *biped, engine_config.step_s},
                   EffectiveConfig(common, config, *texts, engine_config), wake_descriptor));
}

GaitLine::GaitLine(const std::string& rig, const Config& config, engine::GaitEngine engine,
                   TrialControl::Options trial_options, EffectiveConfig effective,
                   int wake_descriptor)
    : world_(config.track),
      data_folder_(trial_options.data_folder),
      frame_rate_hz_(config.frame_rate_hz),
      thread_(GaitRun(std::move(engine), tracks_), trial_options.step_s,
              static_cast<int>(std::lround(1.0 / (trial_options.step_s * config.frame_rate_hz))),
              wake_descriptor),
      trials_(std::move(trial_options), thread_.run().engine().track(), tracks_),
      input_(rig, OptionsOf(config), thread_.inputs(), responses_),
      effective_(std::move(effective)) {}

std::vector<std::string> GaitLine::Capabilities() {
  std::vector<std::string> names{"gait"};
  for (const auto interface : stream::kUserInterfaces) names.push_back(stream::Name(interface));
  names.insert(names.end(), {"trial", "game", "lease"});
  return names;
}

std::vector<transport::Channel> GaitLine::Channels() {
  return {{"skeletons", serving::kSkeletons, true},
          {"track", serving::kTrack, true},
          {"characters", serving::kCharacters, false},
          {"events", serving::kEvents, false},
          {"inputs", serving::kInputs, false},
          {"config", serving::kConfig, true},
          {"study", serving::kStudy, true},
          {"game", serving::kGame, true}};
}

std::vector<transport::ChannelBytes> GaitLine::Retained() const {
  return {serving::Bytes(serving::kSkeletons,
                         serving::MakeSkeletons(world_, thread_.run().engine().skeleton())),
          serving::Bytes(serving::kTrack, wire::ToProto(trials_.track())),
          serving::Bytes(serving::kConfig, effective_.Message())};
}

Result<void> GaitLine::SetInterface(const transport::SessionInfo& who,
                                    const v1::SetInterface& message) {
  mapping::InterfaceOptions options = input_.interface();
  options.interface = v1::UserInterface_IsValid(message.interface())
                          ? static_cast<stream::UserInterface>(message.interface())
                          : stream::UserInterface::kUnspecified;
  if (message.turn_by() != v1::TURN_SOURCE_UNSPECIFIED) {
    options.leg.turn_by = LegTurnSource(message.turn_by());
  }
  if (options.leg.turn_by == stream::TurnSource::kUnspecified) {
    return UsageError("unknown turn_by; there are: head, feet, trunk");
  }
  if (const auto none = trials_.CheckNoneGoesOn(); !none) return none;
  const bool own = !message.table().empty();
  if (message.table().size() > kMostTableBytes) {
    return InvalidData("the table has more than 16 KiB");
  }
  const auto table =
      own ? Result<std::string>(message.table())
          : config::ReadDataFile(mapping::MappingFileOf(options.interface), data_folder_);
  if (!table) return table.error();
  const std::string what = std::string("the table of ") + stream::Name(options.interface);
  const auto made = mapping::AnyInterface::Create(options, *table, own ? what : "");
  if (!made) return made.error();
  if (const auto done = input_.SetInterface(options, *made); !done) return done;
  effective_.SetInterface(input_.interface_number(), options, *table,
                          own ? who.client_name : kBuiltInTable);
  config_changed_ = true;
  return {};
}

v1::CommandResult GaitLine::OnCommand(const transport::SessionInfo& who,
                                      const v1::Command& command) {
  const std::int64_t now_ns = clock::MonotonicNs();
  if (const auto refusal = serving::RefuseOtherCharacter(command)) return *refusal;
  if (const auto answer = lease_.Answer(command, who.session, now_ns)) return *answer;
  if (command.has_set_study()) return study_.OnSetStudy(who, command.set_study());
  if (command.has_set_game()) {
    const v1::CommandResult result = game_.OnSetGame(who, command.set_game());
    EndLeftGame();
    return result;
  }
  if (const auto refusal = game_.Refuse(who, command)) return *refusal;
  if (command.has_set_interface()) {
    const Result<void> done = SetInterface(who, command.set_interface());
    return serving::Answer(done.ok(), done ? "" : "set_interface: " + done.error().message);
  }
  if (!TrialControl::Takes(command)) return input_.OnCommand(command, who.session);
  const v1::CommandResult result = trials_.OnCommand(command);
  if (result.ok()) input_.SetTrial(trials_.inputs());
  return result;
}

void GaitLine::EndLeftGame() {
  if (!game_.TakeLeft() || trials_.CheckNoneGoesOn()) return;
  trials_.StopNewest();
  input_.SetTrial(trials_.inputs());
}

v1::Events GaitLine::EventsOf(const Frame& frame, std::int64_t now_ns) {
  v1::Events events;
  for (int i = 0; i < frame.event_count; ++i) {
    *events.add_events() = trials_.ToEvent(frame.events[static_cast<std::size_t>(i)], now_ns);
  }
  for (v1::Event& event : trials_.TakeCorrections(now_ns)) {
    *events.add_events() = std::move(event);
  }
  serving::AddLeaseEvents(lease_.TakeChanges(now_ns), now_ns, events);
  v1::ResponseStages stages;
  if (!responses_.Complete(frame, now_ns, stages)) return events;
  v1::Event& event = *events.add_events();
  event = serving::MakeEvent(v1::Event::KIND_RESPONSE, now_ns);
  event.set_gait(stages.to());
  *event.mutable_response() = stages;
  return events;
}

void GaitLine::AddChanges(const Frame& frame, bool switched, std::int64_t now_ns,
                          std::vector<transport::ChannelBytes>& channels) {
  if (switched || frame.added_count > 0) {
    channels.push_back(serving::Bytes(serving::kTrack, wire::ToProto(trials_.track())));
  }
  if (std::exchange(config_changed_, false)) {
    channels.push_back(serving::Bytes(serving::kConfig, effective_.Message()));
  }
  if (const auto study = study_.TakeChange(now_ns)) {
    channels.push_back(serving::Bytes(serving::kStudy, wire::ToProto(*study)));
  }
  if (const auto game = game_.TakeChange()) {
    channels.push_back(serving::Bytes(serving::kGame, wire::ToProto(*game)));
  }
}

std::vector<transport::ChannelBytes> GaitLine::OnFrame(const Frame& frame, std::int64_t now_ns) {
  input_.OnFrame(frame);
  std::vector<transport::ChannelBytes> channels;
  const v1::Events events = EventsOf(frame, now_ns);
  const bool switched = trials_.OnFrame(frame);
  for (int i = 0; i < frame.added_count; ++i) {
    terrain::Add(frame.added[static_cast<std::size_t>(i)], trials_.track());
  }
  AddChanges(frame, switched, now_ns, channels);
  v1::CharacterFrame characters = ToCharacterFrame(frame, world_, input_.rig());
  trials_.Describe(frame, *characters.mutable_characters(0));
  characters.set_lease_holder(lease_.holder());
  v1::AppliedInputs inputs;
  for (int i = 0; i < frame.applied_count; ++i) {
    *inputs.add_inputs() = ToAppliedInput(frame.applied[static_cast<std::size_t>(i)]);
  }
  serving::AddFrame(characters, events, inputs, channels);
  return channels;
}

}  // namespace footing::gait_service
