#include "daemon/offline/eval/pose_replay.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/json_text.h"
#include "common/cli/cli.h"
#include "common/recording/mcap_reader.h"
#include "common/recording/mcap_writer.h"
#include "common/recording/recorded_session.h"
#include "common/recording/recording_writer.h"
#include "common/runtime/exchange.h"
#include "daemon/offline/eval/replay.h"
#include "daemon/simulation/gait_service/applied_input.h"
#include "daemon/simulation/gait_service/config.h"
#include "daemon/simulation/pose_service/pose_line.h"
#include "daemon/simulation/pose_service/pose_run.h"
#include "daemon/simulation/pose_service/publish.h"

namespace footing::eval {
namespace {

using pose_service::PoseApplied;
using pose_service::PoseFrame;
using pose_service::PoseInputs;
using pose_service::PoseLine;
using pose_service::PoseRun;
using pose_service::SubjectExchange;
using subject::Subject;

/// The recorded messages of footing-sim, by step.
struct PoseRecording {
  std::map<std::uint64_t, v1::AppliedInput> inputs;
  std::map<std::uint64_t, v1::CharacterFrame> frames;
};

PoseRecording GatherPose(const std::vector<v1::Tick>& ticks) {
  PoseRecording recording;
  for (const v1::Tick& tick : ticks) {
    for (const v1::AppliedInput& input : tick.inputs().inputs()) {
      recording.inputs[input.step()] = input;
    }
    if (tick.has_characters() && tick.characters().characters_size() > 0) {
      recording.frames[tick.characters().step()] = tick.characters();
    }
  }
  return recording;
}

bool WearsInsoles(const PoseRecording& recording) {
  return std::any_of(recording.inputs.begin(), recording.inputs.end(), [](const auto& input) {
    const v1::PoseInput& pose = input.second.pose();
    return pose.left_foot().insole_cells_size() > 0 || pose.right_foot().insole_cells_size() > 0;
  });
}

/// The subjects' own models are where footing-sim had them, where no other folder is named.
ModelFolders WithRecorded(ModelFolders folders, const std::vector<v1::Tick>& ticks) {
  const std::string config = ConfigOf(ticks).json();
  const std::string recorded = text::SettingIn(config, "subject_models").value_or("");
  std::error_code error;
  if (folders.subjects.empty() && std::filesystem::is_directory(recorded, error)) {
    folders.subjects = recorded;
  }
  return folders;
}

/// A frame without what differs from run to run, and without the texts for people, whose causes are
/// not all recorded.
std::string ComparableFrame(v1::CharacterFrame frame) {
  frame.clear_overruns();
  for (v1::Character& character : *frame.mutable_characters()) {
    character.mutable_body()->clear_solve_us();
    character.mutable_body()->clear_note();
    character.mutable_body()->clear_hands_source();
  }
  return frame.SerializeAsString();
}

/// The pose engine, driven step by step by recorded inputs.
class PoseRerun {
 public:
  /// With the recorded lag, or with `lag_s` in its place.
  static Result<std::unique_ptr<PoseRerun>> Create(const PoseRecording& recording,
                                                   const ModelFolders& folders,
                                                   std::optional<double> lag_s = std::nullopt) {
    const v1::Character& shown = recording.frames.begin()->second.characters(0);
    reconstruction::Options options;
    options.mode =
        shown.body().mode() == "paper" ? reconstruction::Mode::kPaper : reconstruction::Mode::kBest;
    options.rate_hz = PoseLine::kRateHz;
    options.lag_s = lag_s.value_or(shown.body().lag_s());
    auto models = pose_service::PoseModels::Load(folders.data, options.mode, folders.subjects);
    if (!models) return models.error();
    std::unique_ptr<PoseRerun> rerun(new PoseRerun(std::move(models).value(), options));
    std::uint64_t number = 1;
    Subject first{shown.body().subject(), shown.body().height_m(), 0, 0};
    if (!recording.inputs.empty()) {
      const v1::AppliedInput& input = recording.inputs.begin()->second;
      number = input.pose().subject_number();
      first = pose_service::SubjectFrom(input);
    }
    if (!recording.inputs.empty()) {
      const auto first_options =
          pose_service::OptionsFrom(recording.inputs.begin()->second, rerun->options_);
      if (!first_options) return first_options.error();
      rerun->Take(*first_options);
    }
    auto run = rerun->MakeRun(number, first);
    if (!run) return run.error();
    rerun->run_ =
        std::make_unique<PoseRun>(std::move(run).value(), PoseLine::kRateHz, rerun->subjects_);
    return rerun;
  }

  /// One step; `input` is what was applied at it, or null.
  Result<void> Step(const v1::AppliedInput* input) {
    if (input != nullptr) {
      const std::uint64_t number = input->pose().subject_number();
      if (known_.count(number) == 0) {
        const auto options = pose_service::OptionsFrom(*input, options_);
        if (!options) return options.error();
        Take(*options);
        auto run = MakeRun(number, pose_service::SubjectFrom(*input));
        if (!run) return run.error();
        (*run)->same_person = input->pose().same_person();
        subjects_.next.Push(std::move(run).value());
      }
      inputs_.Write(pose_service::PoseAppliedFrom(*input).inputs);
    }
    run_->StepOnSimThread(inputs_, frame_);
    run_->FillOnSimThread(frame_);
    run_->TakenOnSimThread(frame_);
    std::unique_ptr<pose_service::SubjectRun> done;
    while (subjects_.done.Pop(done)) done.reset();
    return {};
  }

  std::uint64_t state_hash() const { return frame_.state_hash; }

  /// The newest frame as footing-sim publishes it, with the names of the recorded one.
  v1::CharacterFrame Publish(const v1::CharacterFrame& recorded) const {
    const v1::Character& shown = recorded.characters(0);
    const auto found = known_.find(frame_.subject_number);
    const Known& known = found == known_.end() ? known_.begin()->second : found->second;
    return pose_service::ToCharacterFrame(frame_, known.subject, known.options, recorded.world(),
                                          shown.rig(), "");
  }

 private:
  PoseRerun(pose_service::PoseModels models, const reconstruction::Options& options)
      : models_(std::move(models)), options_(options), lag_s_(options.lag_s) {}

  /// With the lag of the best mode; the paper mode has none.
  void Take(const reconstruction::Options& options) {
    options_ = options;
    options_.lag_s = options.mode == reconstruction::Mode::kBest ? lag_s_ : 0;
  }

  Result<std::unique_ptr<pose_service::SubjectRun>> MakeRun(std::uint64_t number,
                                                            const Subject& subject) {
    known_[number] = {subject, options_};
    const auto body = pose_service::MakeSubjectBody(subject);
    if (!body) return body.error();
    const auto models = models_.Of(subject.code);
    if (!models) return models.error();
    return pose_service::MakeSubjectRun(number, *body, *models, options_);
  }

  const pose_service::PoseModels models_;
  reconstruction::Options options_;  ///< Options of the newest.
  double lag_s_;
  struct Known {
    Subject subject;
    reconstruction::Options options;
  };
  std::map<std::uint64_t, Known> known_;
  SubjectExchange subjects_;
  exchange::Latest<PoseInputs> inputs_;
  std::unique_ptr<PoseRun> run_;
  PoseFrame frame_;
};

/// Runs every recorded step again, and shows each recorded frame when its step is done.
template <typename F>
Result<void> EachFrame(const PoseRecording& recording, PoseRerun& rerun, std::uint64_t& last_step,
                       F show) {
  for (const auto& [frame_step, recorded] : recording.frames) {
    while (last_step < frame_step) {
      const auto input = recording.inputs.find(++last_step);
      const auto done = rerun.Step(input == recording.inputs.end() ? nullptr : &input->second);
      if (!done) return done;
    }
    show(frame_step, recorded);
  }
  return {};
}

}  // namespace

bool IsPoseRecording(const std::vector<v1::Tick>& ticks) {
  for (const v1::Tick& tick : ticks) {
    for (const v1::Character& character : tick.characters().characters()) {
      return character.has_body();
    }
  }
  return false;
}

Result<EngineReplay> ReplayPose(const std::vector<v1::Tick>& ticks, const ModelFolders& folders) {
  const PoseRecording recording = GatherPose(ticks);
  EngineReplay result;
  if (recording.frames.empty()) return result;
  if (const auto whole = CheckFirstStep(recording.frames.begin()->first); !whole) {
    return whole.error();
  }
  auto rerun = PoseRerun::Create(recording, WithRecorded(folders, ticks));
  if (!rerun) return rerun.error();
  const auto ran =
      EachFrame(recording, **rerun, result.last_step,
                [&](std::uint64_t frame_step, const v1::CharacterFrame& recorded) {
                  ++result.frames;
                  result.state_hash = (*rerun)->state_hash();
                  if (ComparableFrame((*rerun)->Publish(recorded)) == ComparableFrame(recorded)) {
                    ++result.equal;
                  } else if (result.first_difference_step == 0) {
                    result.first_difference_step = frame_step;
                  }
                });
  if (!ran) return ran.error();
  return result;
}

namespace {

constexpr char kFrameSchema[] = "footing.v1.CharacterFrame";

/// Copies a recording, with other frames of the character at their steps.
class FrameCopier {
 public:
  FrameCopier(recording::OutputFile& file,
              const std::map<std::uint64_t, v1::CharacterFrame>& frames)
      : file_(file),
        frames_(frames),
        writer_({"", std::string("footing-eval ") + cli::Version()}, {}) {}

  mcap::Visitor Visitor() {
    mcap::Visitor visitor;
    visitor.schema = [this](const mcap::Schema& schema) {
      if (schema.name == kFrameSchema) schemas_.insert(schema.id);
      writer_.CopySchema(schema);
    };
    visitor.channel = [this](const mcap::Channel& channel) {
      if (schemas_.contains(channel.schema_id)) channels_.insert(channel.id);
      writer_.CopyChannel(channel);
    };
    visitor.message = [this](const mcap::Message& message) { Copy(message); };
    visitor.attachment = [this](const mcap::Attachment& attachment) {
      writer_.Add(attachment);
      WriteDown();
    };
    visitor.metadata = [this](const mcap::Metadata& metadata) { writer_.Add(metadata); };
    visitor.chunk = [this](const mcap::Chunk& chunk) {
      writer_.SetCompress(chunk.compression == mcap::kZstd);
    };
    return visitor;
  }

  Result<void> Finish() {
    writer_.Finish();
    WriteDown();
    if (!written_) return written_;
    return file_.Sync();
  }

 private:
  void Copy(mcap::Message message) {
    std::string bytes;
    v1::CharacterFrame frame;
    if (channels_.contains(message.channel_id) &&
        frame.ParseFromArray(message.data.data(), static_cast<int>(message.data.size()))) {
      if (const auto found = frames_.find(frame.step()); found != frames_.end()) {
        bytes = found->second.SerializeAsString();
        message.data = bytes;
      }
    }
    writer_.Add(message);
    WriteDown();
  }

  void WriteDown() {
    const std::string bytes = writer_.Take();
    if (written_ && !bytes.empty()) written_ = file_.Write(bytes);
  }

  recording::OutputFile& file_;
  const std::map<std::uint64_t, v1::CharacterFrame>& frames_;
  mcap::Writer writer_;
  std::set<std::uint16_t> schemas_, channels_;
  Result<void> written_;
};

/// The frame as it would have been with the lag; what does not depend on it stays.
v1::CharacterFrame WithLag(const v1::CharacterFrame& recorded, const v1::CharacterFrame& again) {
  v1::CharacterFrame frame = again;
  frame.set_overruns(recorded.overruns());
  for (int i = 0; i < std::min(frame.characters_size(), recorded.characters_size()); ++i) {
    const v1::BodyState& before = recorded.characters(i).body();
    v1::BodyState& body = *frame.mutable_characters(i)->mutable_body();
    body.set_note(before.note());
    body.set_hands_source(before.hands_source());
  }
  return frame;
}

}  // namespace

Result<std::uint64_t> SmoothPose(const std::string& path, const std::string& out, double lag_s,
                                 const ModelFolders& folders, bool replace) {
  std::error_code error;
  if (std::filesystem::equivalent(path, out, error)) {
    return UsageError("the new recording may not replace " + path + "; name another with --out");
  }
  const auto recorded = ReadRecorded(path);
  if (!recorded) return recorded.error();
  if (!IsPoseRecording(recorded->simulation)) {
    return InvalidData(path +
                       ": has no frame of the pose engine: record footing-sim --engine pose");
  }
  const PoseRecording recording = GatherPose(recorded->simulation);
  if (WearsInsoles(recording)) {
    return InvalidData(path + ": has insoles, with which poses have no lag");
  }
  if (const auto whole = CheckFirstStep(recording.frames.begin()->first); !whole) {
    return Error{whole.error().kind, path + ": " + whole.error().message};
  }
  auto rerun = PoseRerun::Create(recording, WithRecorded(folders, recorded->simulation), lag_s);
  if (!rerun) return rerun.error();
  std::uint64_t last_step = 0;
  std::map<std::uint64_t, v1::CharacterFrame> frames;
  const auto ran = EachFrame(recording, **rerun, last_step,
                             [&](std::uint64_t step, const v1::CharacterFrame& before) {
                               frames[step] = WithLag(before, (*rerun)->Publish(before));
                             });
  if (!ran) return Error{ran.error().kind, path + ": " + ran.error().message};
  const auto in = recording::MappedFile::Open(path);
  if (!in) return in.error();
  auto file = recording::OutputFile::Create(out, replace);
  if (!file) return file.error();
  FrameCopier copier(*file, frames);
  mcap::Walk(in->bytes(), copier.Visitor(), mcap::WalkMode::kStrict);
  if (const auto done = copier.Finish(); !done) return done.error();
  return frames.size();
}

namespace {

using v1::Tick;

const std::vector<std::uint32_t>& ReplayedFields() {
  static const std::vector<std::uint32_t> fields = {
      Tick::kStatusFieldNumber,     Tick::kRawFieldNumber,   Tick::kFeaturesFieldNumber,
      Tick::kCharactersFieldNumber, Tick::kSetupFieldNumber, Tick::kInputsFieldNumber,
      Tick::kTrackFieldNumber,      Tick::kConfigFieldNumber};
  return fields;
}

}  // namespace

Result<Recorded> ReadRecorded(const std::string& path) {
  const auto session = recording::RecordedSession::Open(path);
  if (!session) return session.error();
  Recorded recorded;
  for (const auto& [name, ticks] :
       {std::pair{"footingd", &recorded.sensor}, std::pair{"footing-sim", &recorded.simulation}}) {
    const recording::RecordedServer* server = session->Find(name);
    if (server == nullptr) continue;
    auto read = recording::ReadTicks(*server, ReplayedFields());
    if (!read) return InvalidData(path + ": " + read.error().message);
    *ticks = std::move(*read);
  }
  return recorded;
}

namespace {

struct ReplayOptions {
  std::string file;
  std::string track;  ///< Empty: the recorded one.
  ModelFolders folders;
};

/// The interface that the first recorded inputs name.
mapping::InterfaceOptions InterfaceOf(const std::vector<v1::Tick>& ticks) {
  for (const v1::Tick& tick : ticks) {
    if (tick.inputs().inputs_size() == 0) continue;
    return gait_service::FromAppliedInput(tick.inputs().inputs(0)).inputs.engine.interface.options;
  }
  return {};
}

Result<EngineReplay> ReplayEngine(const std::vector<v1::Tick>& ticks,
                                  const ReplayOptions& options) {
  if (IsPoseRecording(ticks)) return ReplayPose(ticks, options.folders);
  const mapping::InterfaceOptions interface = InterfaceOf(ticks);
  engine_files::Wish wish{.interface = interface.interface, .data_folder = options.folders.data};
  wish.gaits = gait_service::GaitsIn(ConfigOf(ticks));
  const bool named_track = !options.track.empty();
  if (named_track) wish.track = options.track;
  const auto texts = engine_files::ReadTexts(wish);
  if (!texts) return texts.error();
  return ReplayBiped(ticks, {.texts = *texts,
                             .config = {.interface = interface},
                             .named_track = named_track,
                             .data_folder = options.folders.data});
}

int Run(const ReplayOptions& options) {
  const std::string& path = options.file;
  const auto recorded = ReadRecorded(path);
  if (!recorded) return cli::Report(recorded.error());
  if (recorded->sensor.empty() && recorded->simulation.empty()) {
    return cli::Report(InvalidData(path + " holds no ticks of footingd or footing-sim"));
  }
  nlohmann::ordered_json json;
  const FeaturesReplay features = ReplayFeatures(recorded->sensor);
  json["sensor_ticks"] = features.ticks;
  json["features_compared"] = features.compared;
  json["features_equal"] = features.equal;
  json["first_difference_sequence"] = features.first_difference_sequence;
  EngineReplay engine;
  if (!recorded->simulation.empty()) {
    const auto replayed = ReplayEngine(recorded->simulation, options);
    if (!replayed) return cli::Report(replayed.error());
    engine = *replayed;
  }
  json["frames_compared"] = engine.frames;
  json["frames_equal"] = engine.equal;
  json["first_difference_step"] = engine.first_difference_step;
  json["last_step"] = engine.last_step;
  json["state_hash"] = std::to_string(engine.state_hash);
  std::cout << text::ToText(json) << std::endl;
  return features.equal == features.compared && engine.equal == engine.frames ? 0 : 1;
}

void AddModelFolders(CLI::App& command, ModelFolders& folders) {
  command.add_option("--data-folder", folders.data,
                     "Folder of the pose engine's models (default: the installed ones)");
  command.add_option(
      "--subject-models", folders.subjects,
      "Folder of the subjects' own models, CODE.fmodel (default: the one that footing-sim had)");
}

}  // namespace

void AddReplayCommand(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<ReplayOptions>();
  auto* command = app.add_subcommand("replay",
                                     "Replay of a recording through the same code; compares "
                                     "features and state hashes bit for bit");
  command->add_option("file", options->file, "Recording, MCAP file of footing-log")->required();
  command->add_option(
      "--track", options->track,
      "Track of the simulation in place of the recorded one: a name, or a JSON file");
  AddModelFolders(*command, options->folders);
  command->callback([options, &shared] { shared.exit_code = Run(*options); });
}

void AddSmoothCommand(CLI::App& app, Shared& shared) {
  struct Options {
    std::string file, out;
    ModelFolders folders;
    double lag_ms = 200;
    bool force = false;
  };
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand(
      "smooth",
      "Copy of a recording of the pose engine in which each pose also uses the time after it");
  command->add_option("file", options->file, "Recording, MCAP file of footing-log")->required();
  command->add_option("--out", options->out, "New recording")->required();
  command
      ->add_option("--lag-ms", options->lag_ms,
                   "Time after a pose that it may use, ms: 0, 100 or 200 (default 200)")
      ->check(CLI::IsMember({0, 100, 200}));
  AddModelFolders(*command, options->folders);
  command->add_flag("--force", options->force, "Overwrite an existing recording");
  command->footer(
      "Examples:\n"
      "  footing-eval smooth session.mcap --out smooth.mcap\n"
      "  footing-log export smooth.mcap --format mot --out smooth/");
  command->callback([options, &shared] {
    const auto frames = SmoothPose(options->file, options->out, options->lag_ms / 1000,
                                   options->folders, options->force);
    if (!frames) {
      shared.exit_code = cli::Report(frames.error());
      return;
    }
    PrintReport({{"out", options->out}, {"frames", *frames}, {"lag_ms", options->lag_ms}},
                shared.json);
  });
}

}  // namespace footing::eval
