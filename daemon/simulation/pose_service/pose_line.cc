#include "daemon/simulation/pose_service/pose_line.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "common/runtime/clock.h"
#include "daemon/simulation/pose_service/pose_applied.h"
#include "daemon/simulation/pose_service/pose_models.h"
#include "daemon/simulation/pose_service/pose_publish.h"
#include "daemon/simulation/serving/channel_bytes.h"
#include "daemon/simulation/serving/effective_settings.h"
#include "daemon/simulation/serving/messages.h"

namespace footing::pose_service {

using serving::Answer;

namespace {

/// What the engine runs with; its subject stands in the frames.
std::string EffectiveConfig(const serving::Config& common, const Config& config) {
  using nlohmann::ordered_json;
  return serving::EffectiveSettings(common, "pose", config)
      .dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace

Result<std::unique_ptr<PoseLine>> PoseLine::Create(const serving::Config& common,
                                                   const Config& config, int wake_descriptor) {
  Subject first = subject::UnnamedSubject();
  if (!config.subject.empty()) {
    auto read = subject::ReadSubject(config.subject);
    if (!read) return read.error();
    first = *read;
  }
  const auto body = MakeSubjectBody(first);
  if (!body) return body.error();
  reconstruction::Options options;
  options.mode =
      config.mode == "paper" ? reconstruction::Mode::kPaper : reconstruction::Mode::kBest;
  options.rate_hz = kRateHz;
  options.lag_s = 1e-3 * static_cast<double>(config.lag_ms);
  auto models = LoadPoseModels(common.data_folder, options.mode);
  if (!models) return models.error();
  auto run = MakeSubjectRun(1, *body, *models, options);
  if (!run) return run.error();
  return std::unique_ptr<PoseLine>(new PoseLine(common, config, std::move(models).value(), options,
                                                {1, first, *body}, std::move(run).value(),
                                                wake_descriptor));
}

PoseLine::PoseLine(const serving::Config& common, const Config& config,
                   reconstruction::Models models, reconstruction::Options options, Known first,
                   std::unique_ptr<SubjectRun> run, int wake_descriptor)
    : mode_(config.mode),
      effective_config_(EffectiveConfig(common, config)),
      models_(std::move(models)),
      options_(options),
      known_{std::move(first)},
      shown_number_(known_.front().number),
      thread_(PoseRun(std::move(run), kRateHz, subjects_), 1 / kRateHz, 1, wake_descriptor),
      sensors_(common.rig, thread_.inputs(), models_.arm) {
  sensors_.TakeSubject(shown_number_);
}

std::vector<transport::Channel> PoseLine::Channels() {
  return {{"skeletons", serving::kSkeletons, true},
          {"characters", serving::kCharacters, false},
          {"events", serving::kEvents, false},
          {"inputs", serving::kInputs, false},
          {"config", serving::kConfig, true}};
}

const PoseLine::Known& PoseLine::Of(std::uint64_t number) const {
  for (const Known& known : known_) {
    if (known.number == number) return known;
  }
  return known_.front();
}

std::vector<transport::ChannelBytes> PoseLine::Retained() const {
  v1::EffectiveConfig effective;
  effective.set_json(effective_config_);
  return {serving::Bytes(serving::kSkeletons,
                         serving::MakeSkeletons(world_, ToSkeleton(Of(shown_number_).body))),
          serving::Bytes(serving::kConfig, effective)};
}

v1::CommandResult PoseLine::TakeSubject(const v1::SetSubject& message) {
  const Subject next{message.code(), message.height_m(), message.mass_kg(),
                     message.foot_length_m()};
  if (const auto ok = subject::CheckSubject(next, "set_subject"); !ok) {
    return Answer(false, ok.error().message);
  }
  if (known_.size() >= SubjectExchange::kMost) {
    return Answer(false, "set_subject: the subject before is not in place yet; try again");
  }
  const auto body = MakeSubjectBody(next);
  if (!body) return Answer(false, "set_subject: " + body.error().message);
  const std::uint64_t number = known_.back().number + 1;
  auto run = MakeSubjectRun(number, *body, models_, options_);
  if (!run) return Answer(false, "set_subject: " + run.error().message);
  if (!subjects_.next.Push(std::move(run).value())) {
    return Answer(false, "set_subject: the subject before is not in place yet; try again");
  }
  known_.push_back({number, next, *body});
  sensors_.TakeSubject(number);
  return Answer(true, "");
}

v1::CommandResult PoseLine::OnCommand(const transport::SessionInfo& who,
                                      const v1::Command& command) {
  if (const auto refusal = serving::RefuseOtherCharacter(command)) return *refusal;
  if (const auto answer = lease_.Answer(command, who.session, clock::MonotonicNs())) return *answer;
  if (command.has_set_subject()) return TakeSubject(command.set_subject());
  if (command.has_calibrate_t_pose()) {
    if (const std::string& problem = sensors_.board_problem(); !problem.empty()) {
      return Answer(false, "calibrate_t_pose: " + problem);
    }
    sensors_.Calibrate();
    return Answer(true, "");
  }
  return Answer(false,
                "footing-sim --engine pose takes calibrate_t_pose, set_subject and the lease");
}

std::vector<transport::ChannelBytes> PoseLine::OnFrame(const PoseFrame& frame,
                                                       std::int64_t now_ns) {
  std::unique_ptr<SubjectRun> done;
  while (subjects_.done.Pop(done)) done.reset();
  sensors_.Follow(frame);
  while (known_.size() > 1 && known_.front().number < frame.subject_number) known_.pop_front();
  const Known& known = Of(frame.subject_number);
  std::vector<transport::ChannelBytes> channels;
  if (frame.subject_number != shown_number_) {
    shown_number_ = frame.subject_number;
    channels = Retained();
  }
  v1::AppliedInputs inputs;
  for (int i = 0; i < frame.applied_count; ++i) {
    const PoseApplied& applied = frame.applied[static_cast<std::size_t>(i)];
    *inputs.add_inputs() = ToAppliedInput(applied, Of(applied.inputs.subject_number).subject);
  }
  v1::CharacterFrame characters =
      ToCharacterFrame(frame, known.subject, mode_, world_, sensors_.rig(), sensors_.tracker());
  if (!sensors_.board_problem().empty() && characters.characters_size() > 0) {
    characters.mutable_characters(0)->mutable_body()->set_note(sensors_.board_problem());
  }
  characters.set_lease_holder(lease_.holder());
  v1::Events events = events_.Between(frame, known.subject, now_ns);
  serving::AddLeaseEvents(lease_.TakeChanges(now_ns), now_ns, events);
  serving::AddFrame(characters, events, inputs, channels);
  return channels;
}

}  // namespace footing::pose_service
