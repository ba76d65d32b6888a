#include "daemon/simulation/pose_service/pose_line.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/model/model.h"
#include "common/runtime/clock.h"
#include "common/runtime/files.h"
#include "common/wire/model_file.h"
#include "common/wire/scalar.h"
#include "common/wire/wire.h"
#include "daemon/simulation/pose_service/publish.h"
#include "daemon/simulation/serving/messages.h"
#include "daemon/simulation/serving/simulation_thread.h"

namespace footing::pose_service {

void Config::Bind(config::Binder& binder) {
  binder.Text("subject", subject,
              "Subject file of the pose engine: code, height_m, mass_kg, foot_length_m");
  binder.Text(
      "subject_models", subject_models,
      "Folder of the subjects' own models, CODE.fmodel (default: that of the subject file)");
  binder.Text("mode", mode, "Reconstruction mode of the pose engine: best or paper");
  binder.TextList(
      "leave_out", leave_out,
      "Parts that the pose engine leaves out: angular_momentum, momentum, posture, basis, "
      "cleanup");
  binder.Integer("lag_ms", lag_ms, 0, 200,
                 "Output delay of the pose engine, ms: 0, 100 or 200; longer is more accurate");
}

Result<void> Check(const Config& config) {
  if (config.mode != "best" && config.mode != "paper") {
    return UsageError("unknown --mode " + config.mode + "; there are: best, paper");
  }
  if (config.lag_ms != 0 && config.lag_ms != 100 && config.lag_ms != 200) {
    return UsageError("--lag-ms " + std::to_string(config.lag_ms) +
                      " is not possible; there are: 0, 100, 200");
  }
  reconstruction::Options options;
  return reconstruction::LeaveOut(config.leave_out, options);
}

using serving::Answer;

namespace {

std::string SubjectModelsOf(const Config& config) {
  if (!config.subject_models.empty() || config.subject.empty()) return config.subject_models;
  const auto folder = std::filesystem::path(config.subject).parent_path();
  return folder.empty() ? "." : folder.string();
}

/// Settings that the engine runs with; its subject stands in the frames. The folder of models is
/// the one in use, so that a recording can be run again anywhere.
std::string EffectiveConfig(const serving::Config& common, Config config) {
  using nlohmann::ordered_json;
  config.subject_models = SubjectModelsOf(config);
  std::error_code error;
  const auto models = std::filesystem::absolute(config.subject_models, error);
  if (!config.subject_models.empty() && !error) config.subject_models = models.lexically_normal();
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
  if (auto set = reconstruction::SetMode(config.mode, config.leave_out, options); !set) {
    return set.error();
  }
  options.rate_hz = kRateHz;
  options.lag_s = 1e-3 * static_cast<double>(config.lag_ms);
  auto models = PoseModels::Load(common.data_folder, options.mode, SubjectModelsOf(config));
  if (!models) return models.error();
  const auto own = models->Of(first.code);
  if (!own) return own.error();
  auto run = MakeSubjectRun(1, *body, *own, options);
  if (!run) return run.error();
  return std::unique_ptr<PoseLine>(new PoseLine(common, config, std::move(models).value(),
                                                {1, first, *body, options}, std::move(run).value(),
                                                wake_descriptor));
}

PoseLine::PoseLine(const serving::Config& common, const Config& config, PoseModels models,
                   Known first, std::unique_ptr<SubjectRun> run, int wake_descriptor)
    : effective_config_(EffectiveConfig(common, config)),
      models_(std::move(models)),
      known_{std::move(first)},
      shown_number_(known_.front().number),
      thread_(PoseRun(std::move(run), kRateHz, subjects_), 1 / kRateHz, 1, wake_descriptor),
      sensors_(common.rig, thread_.inputs(), models_.common().arm, models_.common().paper_arm) {
  sensors_.TakeMode(known_.front().options.mode);
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
  const auto body = MakeSubjectBody(next);
  if (!body) return Answer(false, "set_subject: " + body.error().message);
  return Next({0, next, *body, known_.back().options}, "set_subject");
}

v1::CommandResult PoseLine::TakeMode(const v1::SetPoseMode& message) {
  Known next = known_.back();
  const std::vector<std::string> parts(message.left_out().begin(), message.left_out().end());
  if (const auto set = reconstruction::SetMode(message.mode(), parts, next.options); !set) {
    return Answer(false, "set_pose_mode: " + set.error().message);
  }
  next.same_person = true;
  const reconstruction::Mode mode = next.options.mode;
  const v1::CommandResult answer = Next(std::move(next), "set_pose_mode");
  if (answer.ok()) sensors_.TakeMode(mode);
  return answer;
}

v1::CommandResult PoseLine::Next(Known next, const std::string& command) {
  if (known_.size() >= SubjectExchange::kMost) {
    return Answer(false, command + ": the one before is not in place yet; try again");
  }
  next.number = known_.back().number + 1;
  const auto models = models_.Of(next.subject.code);
  if (!models) return Answer(false, command + ": " + models.error().message);
  auto run = MakeSubjectRun(next.number, next.body, *models, next.options);
  if (!run) return Answer(false, command + ": " + run.error().message);
  (*run)->same_person = next.same_person;
  if (!subjects_.next.Push(std::move(run).value())) {
    return Answer(false, command + ": the one before is not in place yet; try again");
  }
  sensors_.TakeSubject(next.number);
  known_.push_back(std::move(next));
  return Answer(true, "");
}

v1::CommandResult PoseLine::OnCommand(const transport::SessionInfo& who,
                                      const v1::Command& command) {
  if (const auto refusal = serving::RefuseOtherCharacter(command)) return *refusal;
  if (const auto answer = lease_.Answer(command, who.session, clock::MonotonicNs())) return *answer;
  if (command.has_set_subject()) return TakeSubject(command.set_subject());
  if (command.has_set_pose_mode()) return TakeMode(command.set_pose_mode());
  if (command.has_calibrate_t_pose()) {
    if (const std::string& problem = sensors_.board_problem(); !problem.empty()) {
      return Answer(false, "calibrate_t_pose: " + problem);
    }
    sensors_.Calibrate();
    return Answer(true, "");
  }
  return Answer(
      false,
      "footing-sim --engine pose takes calibrate_t_pose, set_subject, set_pose_mode and the "
      "lease");
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
    const Known& then = Of(applied.inputs.subject_number);
    *inputs.add_inputs() = ToAppliedInput(applied, then.subject, then.options, then.same_person);
  }
  v1::CharacterFrame characters = ToCharacterFrame(frame, known.subject, known.options, world_,
                                                   sensors_.rig(), sensors_.tracker());
  if (!sensors_.board_problem().empty() && characters.characters_size() > 0) {
    characters.mutable_characters(0)->mutable_body()->set_note(sensors_.board_problem());
  }
  characters.set_lease_holder(lease_.holder());
  v1::Events events = events_.Between(frame, known.subject, now_ns);
  serving::AddLeaseEvents(lease_.TakeChanges(now_ns), now_ns, events);
  serving::AddFrame(characters, events, inputs, channels);
  return channels;
}

namespace {

Result<reconstruction::NamedModel> ReadModelFile(const std::string& path) {
  const auto bytes = config::ReadTextFile(path, model::kMostFileBytes);
  if (!bytes) return bytes.error();
  auto model = wire::FromModelFile(*bytes, path);
  if (!model) return model.error();
  return reconstruction::NamedModel{path, std::move(model).value()};
}

Result<reconstruction::NamedModel> Load(const char* name, const std::string& data_folder) {
  const auto path = config::FindDataFile(name, data_folder);
  if (!path) {
    return Failure(path.error().message +
                   " with --set data_folder=..., or make it with footing-train (docs/models.md)");
  }
  return ReadModelFile(*path);
}

}  // namespace

Result<PoseModels> PoseModels::Load(const std::string& data_folder, reconstruction::Mode mode,
                                    const std::string& subjects_folder) {
  PoseModels models;
  models.subjects_folder_ = subjects_folder;
  std::vector<const char*> names{kPoseFile};
  if (mode == reconstruction::Mode::kPaper || config::FindDataFile(kComFile, data_folder)) {
    names.push_back(kComFile);
  }
  for (const char* name : {kArmFile, kPaperArmFile}) {
    if (config::FindDataFile(name, data_folder)) names.push_back(name);
  }
  for (const char* name : names) {
    auto model = pose_service::Load(name, data_folder);
    if (!model) return model.error();
    models.files_.push_back(std::move(model).value());
  }
  auto common = reconstruction::MakeModels(models.files_);
  if (!common) return common.error();
  models.common_ = *std::move(common);
  return models;
}

std::string PoseModels::OwnFileOf(const std::string& code) const {
  // A recording may name anything; only a name within the folder is one of its files.
  const bool named = !code.empty() && code.find('/') == std::string::npos;
  if (subjects_folder_.empty() || !named) return "";
  const auto path = std::filesystem::path(subjects_folder_) / (code + ".fmodel");
  std::error_code error;
  return std::filesystem::exists(path, error) ? path.string() : "";
}

Result<reconstruction::Models> PoseModels::Of(const std::string& code) const {
  const std::string path = OwnFileOf(code);
  if (path.empty()) return common_;
  auto own = ReadModelFile(path);
  if (!own) return own.error();
  if (const auto kind = model::CheckKind(own->model, "person", path); !kind) return kind.error();
  const auto& subjects = own->model.provenance.subjects;
  if (subjects.size() != 1 || model::SubjectName(subjects[0]) != model::SubjectName(code)) {
    return InvalidData(path + ": is of " + (subjects.empty() ? "no subject" : subjects[0]) +
                       ", not of " + code + "; make it with footing-train person --subject " +
                       code);
  }
  std::vector<reconstruction::NamedModel> files = files_;
  files.push_back(*std::move(own));
  return reconstruction::MakeModels(files);
}

namespace {

using wire::Finite;
using wire::FromProto;
using wire::ToProto;

void WriteCell(const momentum::Cell& cell, v1::PoseCell& message) {
  wire::Write(cell.p_WS_m, *message.mutable_position_m());
  message.set_load_n(Finite(cell.load_n));
}

momentum::Cell CellFrom(const v1::PoseCell& message) {
  return {FromProto(message.position_m()), Finite(message.load_n())};
}

/// As many cells as a foot can have.
template <typename Cells>
std::size_t CountOf(const Cells& cells) {
  return std::min(static_cast<std::size_t>(cells.size()), momentum::kMaxCells);
}

void WriteLoads(const momentum::FootLoads& loads, v1::PoseFoot& message) {
  message.set_valid(loads.valid);
  for (std::size_t i = 0; i < loads.count; ++i) WriteCell(loads.cells[i], *message.add_cells());
}

void TakeLoads(const v1::PoseFoot& message, momentum::FootLoads& loads) {
  loads.valid = message.valid();
  loads.count = CountOf(message.cells());
  for (std::size_t i = 0; i < loads.count; ++i) {
    loads.cells[i] = CellFrom(message.cells(static_cast<int>(i)));
  }
}

/// Valid where there is an impulse for each corner.
void WriteImpulse(const board::BoardImpulse& impulse, v1::PoseFoot& message) {
  if (!impulse.valid) return;
  for (const double impulse_ns : impulse.impulse_ns) message.add_impulse_ns(impulse_ns);
  message.set_sampled_s(Finite(impulse.sampled_s));
}

void TakeImpulse(const v1::PoseFoot& message, board::BoardImpulse& impulse) {
  const auto& impulses = message.impulse_ns();
  impulse.valid = impulses.size() == static_cast<int>(board::kCorners);
  if (!impulse.valid) return;
  std::copy(impulses.begin(), impulses.end(), impulse.impulse_ns.begin());
  impulse.sampled_s = Finite(message.sampled_s());
}

/// Valid where there are cells.
void WriteInsole(const reconstruction::InsoleFoot& insole, v1::PoseFoot& message) {
  for (std::size_t i = 0; insole.valid && i < insole.count; ++i) {
    const Eigen::Vector2d& p_S_m = insole.p_S_m[i];
    WriteCell({{p_S_m.x(), p_S_m.y(), 0}, insole.load_n[i]}, *message.add_insole_cells());
  }
}

void TakeInsole(const v1::PoseFoot& message, reconstruction::InsoleFoot& insole) {
  insole.count = CountOf(message.insole_cells());
  insole.valid = insole.count > 0;
  for (std::size_t i = 0; i < insole.count; ++i) {
    const momentum::Cell cell = CellFrom(message.insole_cells(static_cast<int>(i)));
    insole.p_S_m[i] = cell.p_WS_m.head<2>();
    insole.load_n[i] = cell.load_n;
  }
}

void WriteHand(const reconstruction::HandInput& hand, v1::PoseHand& message) {
  message.set_valid(hand.valid);
  wire::Write(hand.p_W_m, *message.mutable_position_m());
  wire::Write(hand.sd_m, *message.mutable_sd_m());
  if (!hand.covariance_m2.isZero(0)) {
    wire::Write(hand.covariance_m2, *message.mutable_covariance_m2());
  }
  message.set_of_skeleton(hand.of_skeleton);
}

void TakeHand(const v1::PoseHand& message, reconstruction::HandInput& hand) {
  hand.valid = message.valid();
  hand.p_W_m = FromProto(message.position_m());
  hand.sd_m = FromProto(message.sd_m());
  hand.covariance_m2 = FromProto(message.covariance_m2());
  hand.of_skeleton = message.of_skeleton();
}

void WriteArm(const arms::ArmEstimate& arm, v1::PoseArm& message) {
  wire::Write(arm.directions.upper, *message.mutable_upper());
  wire::Write(arm.directions.hinge, *message.mutable_hinge());
  wire::Write(arm.directions.forearm, *message.mutable_forearm());
  wire::Write(arm.upper_sd, *message.mutable_upper_sd());
  wire::Write(arm.hinge_sd, *message.mutable_hinge_sd());
  wire::Write(arm.forearm_sd, *message.mutable_forearm_sd());
}

arms::ArmEstimate ArmFrom(const v1::PoseArm& message) {
  arms::ArmEstimate arm;
  arm.directions.upper = FromProto(message.upper());
  arm.directions.hinge = FromProto(message.hinge());
  arm.directions.forearm = FromProto(message.forearm());
  arm.upper_sd = FromProto(message.upper_sd());
  arm.hinge_sd = FromProto(message.hinge_sd());
  arm.forearm_sd = FromProto(message.forearm_sd());
  return arm;
}

/// Adds the joints that are seen.
void SetJoints(const reconstruction::JointInputs& joints, v1::PoseInput& message) {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const reconstruction::JointInput& joint = joints[i];
    if (!joint.valid) continue;
    v1::PoseJoint& one = *message.add_joints();
    one.set_joint(static_cast<v1::BodyJoint>(i + 1));
    *one.mutable_position_m() = ToProto(joint.p_W_m);
    *one.mutable_sd_m() = ToProto(joint.sd_m);
    if (!joint.covariance_m2.isZero(0)) *one.mutable_covariance_m2() = ToProto(joint.covariance_m2);
  }
}

reconstruction::JointInputs GetJoints(const v1::PoseInput& message) {
  reconstruction::JointInputs joints;
  for (const v1::PoseJoint& one : message.joints()) {
    if (one.joint() < 1 || one.joint() > static_cast<int>(joints.size())) continue;
    joints[static_cast<std::size_t>(one.joint() - 1)] = {
        true, FromProto(one.position_m()), FromProto(one.sd_m()), FromProto(one.covariance_m2())};
  }
  return joints;
}

/// Adds the segments that have turned.
void SetTurns(const reconstruction::BodyTurns& turns, v1::PoseInput& message) {
  for (std::size_t site = 0; site < turns.size(); ++site) {
    const arms::HandState& turn = turns[site];
    if (!turn.valid) continue;
    v1::PoseTurn& one = *message.add_turns();
    one.set_segment(reconstruction::kBodySiteNames[site]);
    // Axes and not a quaternion: a recording is run again to the same bits.
    wire::Write(turn.turn_W.col(0), *one.mutable_x());
    wire::Write(turn.turn_W.col(1), *one.mutable_y());
    wire::Write(turn.turn_W.col(2), *one.mutable_z());
    one.set_heading_sd_rad(Finite(turn.heading_sd_rad));
    one.set_inclination_sd_rad(Finite(turn.inclination_sd_rad));
  }
}

reconstruction::BodyTurns GetTurns(const v1::PoseInput& message) {
  reconstruction::BodyTurns turns = {};
  for (const v1::PoseTurn& one : message.turns()) {
    const auto name = std::find(reconstruction::kBodySiteNames.begin(),
                                reconstruction::kBodySiteNames.end(), one.segment());
    if (name == reconstruction::kBodySiteNames.end()) continue;
    arms::HandState& turn =
        turns[static_cast<std::size_t>(name - reconstruction::kBodySiteNames.begin())];
    turn.valid = true;
    turn.turn_W << FromProto(one.x()), FromProto(one.y()), FromProto(one.z());
    turn.heading_sd_rad = Finite(one.heading_sd_rad());
    turn.inclination_sd_rad = Finite(one.inclination_sd_rad());
  }
  return turns;
}

void SetSide(const PoseInputs& inputs, std::size_t side, v1::PoseFoot& foot, v1::PoseHand& hand) {
  WriteLoads(inputs.sensors.loads.feet[side], foot);
  WriteImpulse(inputs.impulses[side], foot);
  WriteInsole(inputs.insoles[side], foot);
  WriteHand(inputs.sensors.hands[side], hand);
  const arms::ArmEstimate& arm = inputs.sensors.arms[side];
  if (arm.valid) WriteArm(arm, *hand.mutable_arm());
}

void GetSide(const v1::PoseFoot& foot, const v1::PoseHand& hand, std::size_t side,
             PoseInputs& inputs) {
  TakeLoads(foot, inputs.sensors.loads.feet[side]);
  TakeImpulse(foot, inputs.impulses[side]);
  TakeInsole(foot, inputs.insoles[side]);
  TakeHand(hand, inputs.sensors.hands[side]);
  arms::ArmEstimate& arm = inputs.sensors.arms[side];
  if (hand.has_arm()) arm = ArmFrom(hand.arm());
  arm.valid = hand.has_arm();
}

}  // namespace

v1::AppliedInput ToAppliedInput(const PoseApplied& applied, const Subject& subject,
                                const reconstruction::Options& options, bool same_person) {
  const PoseInputs& inputs = applied.inputs;
  v1::AppliedInput message;
  message.set_step(applied.step);
  message.set_sensor_epoch(inputs.sensor_epoch);
  message.set_sensor_sequence(inputs.sensor_sequence);
  message.set_simulated(inputs.simulated);
  v1::PoseInput& pose = *message.mutable_pose();
  SetSide(inputs, 0, *pose.mutable_left_foot(), *pose.mutable_left_hand());
  SetSide(inputs, 1, *pose.mutable_right_foot(), *pose.mutable_right_hand());
  SetJoints(inputs.sensors.joints, pose);
  SetTurns(inputs.sensors.turns, pose);
  pose.set_calibrate_number(inputs.calibrate_number);
  pose.set_subject_number(inputs.subject_number);
  pose.set_subject_code(wire::Utf8(subject.code));
  pose.set_subject_height_m(Finite(subject.height_m));
  pose.set_subject_mass_kg(Finite(subject.mass_kg));
  pose.set_subject_foot_length_m(Finite(subject.foot_length_m));
  pose.set_same_person(same_person);
  pose.set_mode(reconstruction::NameOf(options.mode));
  for (const std::string& part : reconstruction::LeftOut(options)) pose.add_left_out(part);
  return message;
}

PoseApplied PoseAppliedFrom(const v1::AppliedInput& message) {
  PoseApplied applied;
  applied.step = message.step();
  PoseInputs& inputs = applied.inputs;
  inputs.sensor_epoch = message.sensor_epoch();
  inputs.sensor_sequence = message.sensor_sequence();
  inputs.simulated = message.simulated();
  const v1::PoseInput& pose = message.pose();
  GetSide(pose.left_foot(), pose.left_hand(), 0, inputs);
  GetSide(pose.right_foot(), pose.right_hand(), 1, inputs);
  inputs.sensors.joints = GetJoints(pose);
  inputs.sensors.turns = GetTurns(pose);
  for (reconstruction::HandInput& hand : inputs.sensors.hands) {
    hand.of_skeleton = hand.of_skeleton || pose.hands_of_skeleton();
  }
  inputs.calibrate_number = pose.calibrate_number();
  inputs.subject_number = pose.subject_number();
  return applied;
}

Subject SubjectFrom(const v1::AppliedInput& message) {
  const v1::PoseInput& pose = message.pose();
  Subject subject;
  subject.code = pose.subject_code();
  subject.height_m = Finite(pose.subject_height_m());
  subject.mass_kg = Finite(pose.subject_mass_kg());
  subject.foot_length_m = Finite(pose.subject_foot_length_m());
  return subject;
}

Result<reconstruction::Options> OptionsFrom(const v1::AppliedInput& message,
                                            reconstruction::Options options) {
  const v1::PoseInput& pose = message.pose();
  if (pose.mode().empty()) return options;
  const std::vector<std::string> parts(pose.left_out().begin(), pose.left_out().end());
  if (const auto set = reconstruction::SetMode(pose.mode(), parts, options); !set) {
    return InvalidData("recorded input: " + set.error().message);
  }
  return options;
}

}  // namespace footing::pose_service
