#include "daemon/offline/train/people_score.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/offline/analysis/pose_metrics.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::train {
namespace {

constexpr std::array<const char*, kPoseWays> kWayNames{
    "best",          "hands_feet_learned",
    "hands_feet_ik", "true_com",
    "true_momentum", "true_feet",
    "true_all",      "head",
    "head_kinect",   "belt",
    "head_belt",     "hands_feet_learned_head_belt"};

constexpr std::size_t Index(PoseWay way) { return static_cast<std::size_t>(way); }

reconstruction::Options OptionsOf(PoseWay way, double rate_hz) {
  reconstruction::Options options;
  options.rate_hz = rate_hz;
  options.use_momentum =
      way != PoseWay::kLearned && way != PoseWay::kBare && way != PoseWay::kLearnedHeadBelt;
  options.use_posture = way != PoseWay::kBare;
  return options;
}

reconstruction::Truth TruthOf(PoseWay way, const pose_run::Frame& frame) {
  reconstruction::Truth truth;
  const bool all = way == PoseWay::kTrueAll;
  if (all || way == PoseWay::kTrueCom) truth.com_W_m = frame.com_m;
  if (all || way == PoseWay::kTrueMomentum) truth.angular_W = frame.angular_momentum;
  if (all || way == PoseWay::kTrueFeet) {
    const auto foot = [&](std::size_t f) {
      return reconstruction::Truth::Foot{frame.feet[f].ankle_m, frame.feet[f].toe_m};
    };
    truth.feet = std::array{foot(0), foot(1)};
  }
  return truth;
}

/// Without the head and the belt where the way has none.
reconstruction::Inputs InputsOf(PoseWay way, const reconstruction::Inputs& all) {
  reconstruction::Inputs inputs = all;
  if (way < PoseWay::kHead || way == PoseWay::kBelt) inputs.joints = {};
  if (way < PoseWay::kBelt) inputs.turns = {};
  return inputs;
}

/// Adds the measures that only the way of boards and hands reports.
void AddReport(const reconstruction::Output& output, const pose_run::Frame& frame,
               const eval::PoseScore& score, const eval::JudgedJoints& joints, PoseTally& tally) {
  ++tally.frames;
  tally.invalid += output.valid ? 0 : 1;
  tally.height_m2 += std::pow(output.com_W_m.z() - frame.com_m.z(), 2);
  if (output.posture_com_W_m) {
    ++tally.posture_frames;
    tally.posture_m2 += std::pow(output.posture_com_W_m->z() - frame.com_m.z(), 2);
  }
  const auto add = [&](std::size_t joint, Nees& nees) {
    nees.Add(score.errors_m()[joint].squaredNorm(), output.joint_sd_m[joint]);
  };
  for (std::size_t joint = 0; joint < output.joint_sd_m.size(); ++joint) add(joint, tally.all);
  for (const int joint : joints.legs) add(static_cast<std::size_t>(joint), tally.legs);
  for (const int joint : joints.arms) add(static_cast<std::size_t>(joint), tally.arms);
}

void AddHipTurns(const eval::PoseScore& score, PoseTally& tally) {
  for (std::size_t side = 0; side < 2; ++side) {
    for (const Eigen::Vector3d& turn : score.hip_turns_rad()[side]) {
      tally.hip_square_rad2 += turn.squaredNorm();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        tally.hip_turn_rad[3 * side + axis] += turn(static_cast<Eigen::Index>(axis));
      }
    }
  }
}

void AddTimes(double frames, const eval::LegAngles& mean, eval::LegAngles& sum) {
  sum.hip += frames * mean.hip;
  sum.swing += frames * mean.swing;
  sum.twist += frames * mean.twist;
  sum.knee += frames * mean.knee;
  sum.flexion += frames * mean.flexion;
  sum.abduction += frames * mean.abduction;
  sum.rotation += frames * mean.rotation;
}

}  // namespace

void PoseTally::Add(const PoseTally& other) {
  frames += other.frames;
  invalid += other.invalid;
  height_m2 += other.height_m2;
  posture_m2 += other.posture_m2;
  posture_frames += other.posture_frames;
  all.Add(other.all);
  legs.Add(other.legs);
  arms.Add(other.arms);
  for (std::size_t i = 0; i < hip_turn_rad.size(); ++i) hip_turn_rad[i] += other.hip_turn_rad[i];
  hip_square_rad2 += other.hip_square_rad2;
  hip_about_person_rad2 += other.hip_about_person_rad2;
  for (std::size_t i = 0; i < kPoseWays; ++i) {
    if (other.mpjpe_cm[i]) mpjpe_cm[i] = mpjpe_cm[i].value_or(0) + *other.mpjpe_cm[i];
    AddTimes(1, other.angles_deg[i], angles_deg[i]);
  }
}

void PoseTally::AboutPerson() {
  hip_about_person_rad2 = hip_square_rad2;
  for (const double sum : hip_turn_rad) hip_about_person_rad2 -= sum * sum / frames;
}

nlohmann::ordered_json PoseTally::Json() const {
  nlohmann::ordered_json json = {{"frames", frames}};
  for (std::size_t i = 0; i < kPoseWays; ++i) {
    if (!mpjpe_cm[i]) continue;
    const eval::LegAngles& angles = angles_deg[i];
    json[kWayNames[i]] = {{"mpjpe_cm", *mpjpe_cm[i] / frames},
                          {"hip_deg", angles.hip / frames},
                          {"hip_swing_deg", angles.swing / frames},
                          {"hip_twist_deg", angles.twist / frames},
                          {"hip_flexion_deg", angles.flexion / frames},
                          {"hip_abduction_deg", angles.abduction / frames},
                          {"hip_rotation_deg", angles.rotation / frames},
                          {"knee_deg", angles.knee / frames}};
  }
  const auto rms_deg = [this](double square_rad2) {
    return RadiansToDegrees(std::sqrt(square_rad2 / (2 * frames)));  // Two hips a frame.
  };
  json["hip_rms_deg"] = rms_deg(hip_square_rad2);
  if (hip_about_person_rad2 > 0) {
    json["hip_about_person_rms_deg"] = rms_deg(hip_about_person_rad2);
  }
  json["gain_over_learned"] = 1 - mpjpe_cm[Index(PoseWay::kBest)].value_or(0) /
                                      mpjpe_cm[Index(PoseWay::kLearned)].value_or(1);
  json["invalid_share"] = invalid / frames;
  json["nees"] = all.mean();
  json["nees_legs"] = legs.mean();
  json["nees_arms"] = arms.mean();
  json["com_vertical_rms_cm"] = 100 * std::sqrt(height_m2 / frames);
  json["posture_com_vertical_rms_cm"] = 100 * std::sqrt(posture_m2 / std::max(posture_frames, 1.0));
  return json;
}

namespace {

/// One way over all frames, into the tally.
Result<void> ScoreWay(PoseWay way, const pose_run::PoseRun& run,
                      const reconstruction::Models& models, PoseTally& tally) {
  const eval::JudgedJoints joints(run.body);
  auto made = reconstruction::Reconstruction::Create(run.body, models, OptionsOf(way, run.rate_hz));
  if (!made) return made.error();
  eval::PoseScore score(run.body);
  double sum_cm = 0;
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    const pose_run::Frame& frame = run.frames[i];
    const auto& output = made->Advance(InputsOf(way, frame.inputs), TruthOf(way, frame));
    if (i < run.judged_from) continue;
    score.Add(output.q, frame.q);
    sum_cm += score.last_mpjpe_cm();
    if (way == PoseWay::kBest) AddReport(output, frame, score, joints, tally);
  }
  if (way == PoseWay::kBest) AddHipTurns(score, tally);
  tally.mpjpe_cm[Index(way)] = sum_cm;
  AddTimes(static_cast<double>(run.frames.size() - run.judged_from), score.leg_angles_deg(),
           tally.angles_deg[Index(way)]);
  return {};
}

}  // namespace

Result<PoseTally> ScoreTake(const PoseTake& take, const reconstruction::Models& models,
                            const MoreWays& more) {
  using pose_run::HeadDevice;
  const auto run =
      SimulateTake(take, more.sensors ? HeadDevice::kSphere : HeadDevice::kNone, more.sensors);
  if (!run) return run.error();
  PoseTally tally;
  for (std::size_t i = 0; i < kPoseWays; ++i) {
    const auto way = static_cast<PoseWay>(i);
    if (!more.Include(way) || way == PoseWay::kKinectHead) continue;
    if (const auto scored = ScoreWay(way, *run, models, tally); !scored) return scored.error();
  }
  if (!more.Include(PoseWay::kKinectHead)) return tally;
  const auto kinect = SimulateTake(take, HeadDevice::kKinect);
  if (!kinect) return kinect.error();
  const auto scored = ScoreWay(PoseWay::kKinectHead, *kinect, models, tally);
  if (!scored) return scored.error();
  return tally;
}

}  // namespace footing::train
