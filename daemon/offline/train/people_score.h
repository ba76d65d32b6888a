#pragma once

#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/base/result.h"
#include "daemon/offline/analysis/pose_metrics.h"
#include "daemon/offline/train/pose_training.h"
#include "daemon/simulation/reconstruction/models.h"

/// How poses of people whom no model has seen are scored.
namespace footing::train {

/// Compared ways: boards and hands, hands and feet with what is learned of these, and without;
/// then boards and hands with parts of the truth in place of their estimates, to see which of these
/// is to blame; then with more sensors, to see what these are worth.
enum class PoseWay {
  kBest,
  kLearned,
  kBare,
  kTrueCom,
  kTrueMomentum,
  kTrueFeet,
  kTrueAll,
  kHead,        ///< A sphere on a cap,
  kKinectHead,  ///< or the head of a Kinect.
  kBelt,
  kHeadBelt,
  kLearnedHeadBelt,  ///< Hands, feet, head and belt, without the loads.
};
inline constexpr std::size_t kPoseWays = 12;

/// Which ways are scored beside the first three.
struct MoreWays {
  bool truth = false, sensors = false;

  bool Include(PoseWay way) const {
    if (way <= PoseWay::kBare) return true;
    return way <= PoseWay::kTrueAll ? truth : sensors;
  }
};

/// Normalised squared errors of joints: |error|^2 / (3 sd^2), in the mean 1 where the deviations
/// are honest.
struct Nees {
  double sum = 0, count = 0;

  void Add(double squared_m2, double sd_m) {
    sum += squared_m2 / (3 * sd_m * sd_m);
    ++count;
  }
  void Add(const Nees& other) {
    sum += other.sum;
    count += other.count;
  }
  double mean() const { return count > 0 ? sum / count : 0; }
};

/// Sums over frames, all of them: those that are not valid count like the others.
struct PoseTally {
  double frames = 0, invalid = 0, height_m2 = 0;
  double posture_m2 = 0, posture_frames = 0;
  Nees all, legs, arms;
  std::array<std::optional<double>, kPoseWays> mpjpe_cm{};  ///< Error of each way asked for.
  std::array<eval::LegAngles, kPoseWays> angles_deg{};      ///< Angle errors of the same, summed.
  /// From the true hips of a person to those of boards and hands, summed; rad, left and right.
  std::array<double, 6> hip_turn_rad{};
  double hip_square_rad2 = 0;
  /// The same sum of squares about the mean of each leg of each person, by AboutPerson.
  double hip_about_person_rad2 = 0;

  void Add(const PoseTally& other);
  /// Ends the sums of one person's takes.
  void AboutPerson();
  nlohmann::ordered_json Json() const;
};

/// The take as the sensors show it.
Result<PoseTally> ScoreTake(const PoseTake& take, const reconstruction::Models& models,
                            const MoreWays& more);

}  // namespace footing::train
