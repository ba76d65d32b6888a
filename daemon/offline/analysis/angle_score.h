#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "common/base/units.h"
#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/body/landmarks.h"
#include "common/virtual/motion/table.h"
#include "daemon/simulation/momentum/contact_loads.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::eval {

/// Two tables of joint angles, row by row: {joint_angles: {NAME: {...}}, angles_since_standing:
/// {...}} as AngleScore has them, of the coordinates that are in both. `valid`: one for each row.
/// The frames in which the person stands are looked for in `truth`, from row `first` on. `stated`:
/// the stated deviations of each row, by body::kStatedAngles; empty: none are.
Result<nlohmann::ordered_json> CompareAngles(
    const motion::Table& estimated, const motion::Table& truth, const std::vector<bool>& valid,
    Eigen::Index first, const std::vector<reconstruction::AngleSd>& stated = {});

/// Joint angles and orientations of links against the truth, as the exports have them.
class AngleScore {
 public:
  /// `body` must outlive it.
  /// The frames from `first` on are of the clip itself, with its own way of standing.
  AngleScore(const body::Body& body, double rate_hz, Eigen::Index first)
      : body_(body), rate_hz_(rate_hz), first_(first) {}

  void Add(const reconstruction::Output& output, const Eigen::VectorXd& true_q, bool valid);

  /// The field joint_angles has an entry for each coordinate (joint_angles::JointAngles; both sides
  /// of a limb together) with RMS error, mean error, and the range of the true and the estimated
  /// angle; link_orientations one for each kind of link with the RMS of the whole rotation between
  /// estimate and truth in W. RMS errors are of all frames, of the valid ones, and of those in
  /// which a knee is reported as bent by kBentDeg or more (all: bent, and less: upright). A share
  /// without frames has no field.
  ///
  /// The field angles_since_standing has the same of pelvis, trunk and legs as the change from the
  /// person's own standing (joint_angles::SinceStanding), of estimate and truth each from the
  /// frames in which the true person stands; absent where it never does. The rotation of a hip is
  /// that of the frames in which it is known (joint_angles::IsKnown), known_share of all. It has
  /// the stated deviation besides, sd_deg (rms), and nees, the mean of the squared error over the
  /// stated variance, of all frames, nees_bent and nees_upright.
  Result<void> WriteTo(nlohmann::ordered_json& json) const;

  /// A frame is bent when the mean flexion of both knees exceeds this, degrees.
  static constexpr double kBentDeg = 30;

 private:
  const body::Body& body_;
  double rate_hz_;
  Eigen::Index first_;
  std::vector<Eigen::VectorXd> q_, true_q_;
  std::vector<bool> valid_;
  std::vector<reconstruction::AngleSd> stated_;
};

/// How far a value is from going on as it went: the root mean square of its second difference from
/// frame to frame.
class Roughness {
 public:
  /// The value of the next frame; only where `counted`.
  void Add(double value, bool counted = true) {
    const double bend = value - 2 * last_ + before_;
    before_ = last_;
    last_ = value;
    if (++frames_ < 3 || !counted) return;
    sum_ += bend * bend;
    ++count_;
  }
  double rms() const { return count_ > 0 ? std::sqrt(sum_ / count_) : 0; }

 private:
  double last_ = 0, before_ = 0, sum_ = 0;
  int frames_ = 0, count_ = 0;
};

/// By how much an elbow is bent; 0 is a straight arm. Side 0 is the left one.
inline double ElbowBendDeg(const body::Landmarks& landmarks, const body::Kinematics& at, int side) {
  const auto place = [&](body::Landmark left) {
    const body::Landmark landmark = side == 0 ? left : body::Mirrored(left);
    return at.p_WJ[static_cast<std::size_t>(landmarks[landmark])];
  };
  const Eigen::Vector3d elbow = place(body::Landmark::kLeftElbow);
  const Eigen::Vector3d upper = elbow - place(body::Landmark::kLeftShoulder);
  const Eigen::Vector3d fore = place(body::Landmark::kLeftWrist) - elbow;
  return RadiansToDegrees(
      std::acos(std::clamp(upper.normalized().dot(fore.normalized()), -1.0, 1.0)));
}

inline constexpr double kContactN = 20;          ///< A foot with more load is in contact.
inline constexpr double kSettledContactS = 0.3;  ///< From a landing to its evaluation.

/// Estimated contact of both feet against the true one.
struct ContactScore {
  std::size_t both = 0, only_estimated = 0, only_true = 0;
  std::size_t landings = 0;
  double delay_s = 0, worst_delay_s = 0;  ///< From landings to when they were reported.
  std::array<double, momentum::kFeet> true_since_s{};  ///< Minimum duration of true contact.

  void Add(std::size_t foot, bool truth, bool estimated, double step_s) {
    both += truth && estimated ? 1 : 0;
    only_estimated += !truth && estimated ? 1 : 0;
    only_true += truth && !estimated ? 1 : 0;
    true_since_s[foot] = truth ? (was_[foot] ? true_since_s[foot] + step_s : 0) : 0;
    if (truth && !was_[foot]) seen_[foot] = false;
    if (truth && estimated && !seen_[foot]) {
      seen_[foot] = true;
      ++landings;
      delay_s += true_since_s[foot];
      worst_delay_s = std::max(worst_delay_s, true_since_s[foot]);
    }
    was_[foot] = truth;
  }
  double F1() const {
    const auto twice = 2.0 * static_cast<double>(both);
    return both > 0 ? twice / (twice + static_cast<double>(only_estimated + only_true)) : 0;
  }
  double mean_delay_s() const { return landings > 0 ? delay_s / static_cast<double>(landings) : 0; }

 private:
  std::array<bool, momentum::kFeet> was_{true, true};
  std::array<bool, momentum::kFeet> seen_{true, true};
};

/// The frames of one foot while it stands: from 0.1 s after its landing to 0.1 s before it leaves.
/// A foot that lands or leaves does move over the ground, with some load on it already or still.
class StanceFrames {
 public:
  static constexpr double kEdgeS = 0.1;
  using Speeds = std::array<double, 2>;  ///< Estimated and true.

  /// The next frame. Returns those of kEdgeS ago when the foot stood then.
  std::optional<Speeds> Advance(bool contact, const Speeds& speeds, double step_s) {
    const bool stood = contact_ && since_s_ > kEdgeS - 1e-9;  // In the frame before, too.
    since_s_ = contact && contact_ ? since_s_ + step_s : 0;
    contact_ = contact;
    if (!contact) waiting_ = 0;
    if (!contact || !stood) return std::nullopt;
    const auto edge = static_cast<std::size_t>(std::lround(kEdgeS / step_s));
    if (edge == 0 || edge > kMost) return std::nullopt;
    Speeds& oldest = speeds_[next_++ % edge];
    const Speeds before = oldest;
    oldest = speeds;
    if (waiting_ < edge) {
      ++waiting_;
      return std::nullopt;
    }
    return before;
  }

 private:
  static constexpr std::size_t kMost = 32;

  bool contact_ = false;
  double since_s_ = 0;  // The landing.
  std::array<Speeds, kMost> speeds_{};
  std::size_t waiting_ = 0, next_ = 0;
};

}  // namespace footing::eval
