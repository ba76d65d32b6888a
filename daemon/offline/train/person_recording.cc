#include "daemon/offline/train/person_recording.h"

#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "common/body/skeleton.h"
#include "common/recording/recorded_session.h"
#include "common/recording/recording_writer.h"
#include "common/runtime/exchange.h"
#include "common/wire/wire.h"
#include "daemon/offline/train/pose_training.h"
#include "daemon/simulation/pose_service/pose_line.h"
#include "daemon/simulation/pose_service/pose_run.h"

namespace footing::train {
namespace {

using pose_service::PoseFrame;
using pose_service::PoseInputs;
using pose_service::PoseRun;

constexpr int kEvery = 2;  // Steps of 120 Hz: as many frames as the models were trained with.
constexpr double kPersonHoldoutS = 5;

/// Boards and hands: the joints of a skeleton and a head are what the person is compared with.
PoseInputs WithoutJoints(PoseInputs inputs) {
  inputs.sensors.joints = {};
  return inputs;
}

/// The published pose as a pose of the body, which has its joints.
void PoseOf(const body::Skeleton& skeleton, const v1::Character& character, Eigen::VectorXd& q) {
  const auto turn = [&](int link) -> Eigen::Matrix3d {
    return wire::FromProto(character.links(link).orientation()).normalized().toRotationMatrix();
  };
  q.head<3>() = wire::FromProto(character.links(0).position_m());
  for (int i = 0; i < skeleton.size(); ++i) {
    const body::Joint& joint = skeleton.joint(i);
    if (joint.rotations.empty()) continue;
    const Eigen::Matrix3d R_WJ = turn(i);
    const Eigen::Matrix3d R_PJ =
        joint.parent < 0 ? R_WJ : Eigen::Matrix3d(turn(joint.parent).transpose() * R_WJ);
    body::SetJointRotation(joint, R_PJ, q);
  }
}

Result<void> CheckPublished(const PersonRecording& recording, const std::string& path,
                            const std::string& code) {
  if (recording.frames.empty() || recording.inputs.empty()) {
    return InvalidData(path +
                       (code.empty() ? ": has no frame of a subject of the pose engine; "
                                     : ": has no frame of the subject " + code + "; ") +
                       "record footing-sim --engine pose --subject FILE");
  }
  for (const auto& [step, character] : recording.frames) {
    if (character.body().mode() == "paper" || character.body().lag_s() > 0) {
      return InvalidData(path +
                         ": was recorded in paper mode or with a lag; record it with --mode best "
                         "--lag-ms 0");
    }
  }
  return {};
}

}  // namespace

Result<PersonRecording> ReadPersonRecording(const std::string& path, const std::string& code) {
  const auto file = recording::MappedFile::Open(path);
  if (!file) return file.error();
  const auto session = recording::RecordedSession::Open(path);
  if (!session) return session.error();
  const recording::RecordedServer* server = session->Find("footing-sim");
  if (server == nullptr) return InvalidData(path + ": has no footing-sim in it; record that too");
  const auto ticks = recording::ReadTicks(
      *server, {v1::Tick::kCharactersFieldNumber, v1::Tick::kInputsFieldNumber});
  if (!ticks) return InvalidData(path + ": " + ticks.error().message);
  PersonRecording recording;
  recording.file = {.name = std::filesystem::path(path).filename().string(),
                    .sha256 = model::Sha256(file->bytes())};
  for (const v1::Tick& tick : *ticks) {
    for (const v1::AppliedInput& input : tick.inputs().inputs()) {
      const subject::Subject subject = pose_service::SubjectFrom(input);
      if (subject.code.empty() || (!code.empty() && subject.code != code)) continue;
      if (subject.code != recording.subject.code) {  // The next one.
        recording.inputs.clear();
        recording.frames.clear();
      }
      recording.subject = subject;
      recording.inputs[input.step()] = pose_service::PoseAppliedFrom(input);
    }
    if (!tick.has_characters() || tick.characters().characters_size() == 0) continue;
    const v1::Character& character = tick.characters().characters(0);
    if (character.has_body() && character.body().subject() == recording.subject.code &&
        !recording.subject.code.empty()) {
      recording.frames[tick.characters().step()] = character;
    }
  }
  if (const auto checked = CheckPublished(recording, path, code); !checked) return checked.error();
  return recording;
}

Result<double> AddPersonRecording(const PersonRecording& recording,
                                  const reconstruction::Models& models,
                                  learning::PersonExamples& examples) {
  const auto body = pose_service::MakeSubjectBody(recording.subject);
  if (!body) return body.error();
  reconstruction::Options options;
  options.rate_hz = pose_service::PoseLine::kRateHz;
  const std::uint64_t number = recording.inputs.rbegin()->second.inputs.subject_number;
  auto made = pose_service::MakeSubjectRun(number, *body, models, options);
  if (!made) return made.error();
  const pose_service::SubjectRun& subject = **made;
  pose_service::SubjectExchange none;
  PoseRun run(std::move(made).value(), options.rate_hz, none);
  exchange::Latest<PoseInputs> inputs;
  PoseFrame frame;
  Eigen::VectorXd q = Eigen::VectorXd::Zero(body->skeleton.dof);
  const auto settled = static_cast<std::uint64_t>(kSettledS * options.rate_hz);
  const auto piece_steps = static_cast<std::uint64_t>(kPersonHoldoutS * options.rate_hz);
  const std::uint64_t first = recording.inputs.begin()->first;
  std::uint64_t calibrated = 0, added = 0;
  for (std::uint64_t step = first; step <= recording.frames.rbegin()->first; ++step) {
    if (const auto input = recording.inputs.find(step); input != recording.inputs.end()) {
      PoseInputs plain = WithoutJoints(input->second.inputs);
      plain.subject_number = number;
      inputs.Write(plain);
    }
    run.StepOnSimThread(inputs, frame);
    run.TakenOnSimThread(frame);
    const auto shown = recording.frames.find(step);
    calibrated = subject.reconstruction.output().calibrated ? calibrated + 1 : 0;
    if (calibrated <= settled || shown == recording.frames.end() || step % kEvery != 0) continue;
    const v1::Character& character = shown->second;
    const auto& hands = inputs.Front().sensors.hands;
    if (!character.valid() || !hands[0].valid || !hands[1].valid ||
        character.links_size() != body->skeleton.size()) {
      continue;
    }
    PoseOf(body->skeleton, character, q);
    examples.Add(subject.reconstruction, q, static_cast<int>((step - first) / piece_steps));
    ++added;
  }
  if (added == 0) {
    return InvalidData(recording.file.name +
                       ": has no valid frame with both hands after a T-pose; begin the recording "
                       "before the T-pose (footing-ctl motions does)");
  }
  return static_cast<double>(added) * kEvery / options.rate_hz;
}

}  // namespace footing::train
