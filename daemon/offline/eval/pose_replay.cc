#include "daemon/offline/eval/pose_replay.h"

#include <map>
#include <memory>
#include <utility>

#include "common/runtime/latest.h"
#include "daemon/simulation/pose_service/pose_applied.h"
#include "daemon/simulation/pose_service/pose_line.h"
#include "daemon/simulation/pose_service/pose_models.h"
#include "daemon/simulation/pose_service/pose_publish.h"
#include "daemon/simulation/pose_service/pose_run.h"
#include "daemon/simulation/pose_service/subject_body.h"

namespace footing::eval {
namespace {

using pose_service::PoseApplied;
using pose_service::PoseFrame;
using pose_service::PoseInputs;
using pose_service::PoseLine;
using pose_service::PoseRun;
using pose_service::SubjectExchange;
using subject::Subject;

/// What the recording holds of footing-sim, by step.
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
  static Result<std::unique_ptr<PoseRerun>> Create(const PoseRecording& recording,
                                                   const std::string& data_folder) {
    const v1::Character& shown = recording.frames.begin()->second.characters(0);
    reconstruction::Options options;
    options.mode =
        shown.body().mode() == "paper" ? reconstruction::Mode::kPaper : reconstruction::Mode::kBest;
    options.rate_hz = PoseLine::kRateHz;
    options.lag_s = shown.body().lag_s();
    auto models = pose_service::LoadPoseModels(data_folder, options.mode);
    if (!models) return models.error();
    std::unique_ptr<PoseRerun> rerun(new PoseRerun(std::move(models).value(), options));
    std::uint64_t number = 1;
    Subject first{shown.body().subject(), shown.body().height_m(), 0, 0};
    if (!recording.inputs.empty()) {
      const v1::AppliedInput& input = recording.inputs.begin()->second;
      number = input.pose().subject_number();
      first = pose_service::SubjectFrom(input);
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
        auto run = MakeRun(number, pose_service::SubjectFrom(*input));
        if (!run) return run.error();
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
    const auto subject = known_.find(frame_.subject_number);
    return pose_service::ToCharacterFrame(
        frame_, subject == known_.end() ? known_.begin()->second : subject->second,
        shown.body().mode(), recorded.world(), shown.rig(), "");
  }

 private:
  PoseRerun(reconstruction::Models models, const reconstruction::Options& options)
      : models_(std::move(models)), options_(options) {}

  Result<std::unique_ptr<pose_service::SubjectRun>> MakeRun(std::uint64_t number,
                                                            const Subject& subject) {
    known_[number] = subject;
    const auto body = pose_service::MakeSubjectBody(subject);
    if (!body) return body.error();
    return pose_service::MakeSubjectRun(number, *body, models_, options_);
  }

  const reconstruction::Models models_;
  const reconstruction::Options options_;
  std::map<std::uint64_t, Subject> known_;
  SubjectExchange subjects_;
  exchange::Latest<PoseInputs> inputs_;
  std::unique_ptr<PoseRun> run_;
  PoseFrame frame_;
};

}  // namespace

bool IsPoseRecording(const std::vector<v1::Tick>& ticks) {
  for (const v1::Tick& tick : ticks) {
    for (const v1::Character& character : tick.characters().characters()) {
      return character.has_body();
    }
  }
  return false;
}

Result<EngineReplay> ReplayPose(const std::vector<v1::Tick>& ticks,
                                const std::string& data_folder) {
  const PoseRecording recording = GatherPose(ticks);
  EngineReplay result;
  if (recording.frames.empty()) return result;
  if (const auto whole = CheckFirstStep(recording.frames.begin()->first); !whole) {
    return whole.error();
  }
  auto rerun = PoseRerun::Create(recording, data_folder);
  if (!rerun) return rerun.error();
  for (const auto& [frame_step, recorded] : recording.frames) {
    while (result.last_step < frame_step) {
      const auto input = recording.inputs.find(++result.last_step);
      const auto done = (*rerun)->Step(input == recording.inputs.end() ? nullptr : &input->second);
      if (!done) return done.error();
    }
    ++result.frames;
    result.state_hash = (*rerun)->state_hash();
    if (ComparableFrame((*rerun)->Publish(recorded)) == ComparableFrame(recorded)) {
      ++result.equal;
    } else if (result.first_difference_step == 0) {
      result.first_difference_step = frame_step;
    }
  }
  return result;
}

}  // namespace footing::eval
