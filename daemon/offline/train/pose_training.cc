#include "daemon/offline/train/pose_training.h"

#include <map>

#include "common/virtual/motion/edit.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::train {
namespace {

constexpr double kCellNoiseKg = 0.05;

}  // namespace

std::vector<PoseTake> TakesOf(const std::vector<const Clip*>& clips, std::uint64_t seed,
                              int& piece) {
  std::vector<PoseTake> takes;
  std::map<std::string, int> people;
  for (const Clip* clip : clips) {
    const int person = people.emplace(clip->subject, static_cast<int>(people.size())).first->second;
    for (const bool mirrored : {false, true}) {
      takes.push_back({clip, mirrored, piece, person, false,
                       seed + 2 * static_cast<std::uint64_t>(piece) + (mirrored ? 1 : 0)});
    }
    piece += 1 + static_cast<int>(clip->motion.duration_s() / kPosePieceS);
  }
  for (PoseTake& take : takes) take.by_person = people.size() >= kFewestPeople;
  return takes;
}

Result<pose_run::PoseRun> SimulateTake(const PoseTake& take, pose_run::HeadDevice head, bool belt) {
  pose_run::Settings settings;
  settings.head = head;
  settings.belt = belt;
  settings.errors.noise_kg = kCellNoiseKg;
  settings.errors.seed = settings.seed = take.seed;
  const motion::Motion& motion = take.clip->motion;
  return pose_run::RunPose(take.mirrored ? motion::Mirrored(motion) : motion, settings,
                           take.clip->name);
}

Result<void> AddExamples(const PoseTake& take, const reconstruction::Models& models,
                         learning::PoseCues cues, learning::PoseExamples& examples) {
  const auto run = SimulateTake(take);
  if (!run) return run.error();
  reconstruction::Options options;
  options.rate_hz = run->rate_hz;
  auto made = reconstruction::Reconstruction::Create(run->body, models, options);
  if (!made) return made.error();
  const auto first = static_cast<std::size_t>((pose_run::kStandS + kSettledS) * run->rate_hz);
  const auto piece_frames = static_cast<std::size_t>(kPosePieceS * run->rate_hz);
  for (std::size_t i = 0; i < run->frames.size(); ++i) {
    const auto& output = made->Advance(run->frames[i].inputs);
    if (i < first) continue;
    if (!output.calibrated) {
      return InvalidData(take.clip->name + ": its T-pose never stood still");
    }
    const int piece = take.piece + static_cast<int>((i - first) / piece_frames);
    const int fold = take.by_person ? take.person : piece % learning::kFolds;
    examples.Add(*made, cues, run->frames[i].q, fold, take.person);
  }
  return {};
}

learning::FittedPoseRegression AppendPoses(const learning::PoseExamples& examples,
                                           learning::PoseCues cues, const Eigen::VectorXd& scale,
                                           std::uint64_t seed, model::Model& model) {
  learning::RandomWaves waves = learning::kPoseWaves;
  waves.seed = seed;
  auto fitted = learning::FitPoseRegression(examples, scale, waves);
  learning::AppendTensors(
      fitted, model, cues == learning::PoseCues::kPosture ? reconstruction::kPosturePrefix : "");
  return fitted;
}

}  // namespace footing::train
