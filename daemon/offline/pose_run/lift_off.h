#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace footing::pose_run {

inline constexpr std::size_t kLegJoints = 3;  ///< Hip, knee, foot (its ankle).

/// A leg in one frame: how far its joints are off (W, m), and what was reported of it, along one
/// axis.
struct LegError {
  std::array<Eigen::Vector3d, kLegJoints> error_m{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                                  Eigen::Vector3d::Zero()};
  std::array<double, kLegJoints> sd_m{};
};

/// Root mean squares over legs.
class LegScore {
 public:
  void Add(const LegError& leg);

  std::size_t count() const { return count_; }
  /// Distance in space, cm; 0 where there is nothing.
  double error_cm(std::size_t joint) const;
  /// The reported deviation along one axis, cm.
  double sd_cm(std::size_t joint) const;
  /// Mean of |error|² / (3 sd²): 1 where the reported deviation is right.
  double nees(std::size_t joint) const;
  /// Over all joints.
  double nees() const;

 private:
  std::size_t count_ = 0;
  std::array<double, kLegJoints> square_m2_{}, variance_m2_{}, nees_{};
};

/// Errors of a leg once its foot has left the ground: some times after, all the while, and
/// in kicks. A foot leaves when its load falls to 20 N or less after at least 0.1 s of more; a kick
/// is a foot off the ground whose ankle moves faster than 2 m/s.
class LiftOffs {
 public:
  static constexpr double kLoadedN = 20, kStoodS = 0.1, kKickMps = 2;
  static constexpr std::array<double, 4> kAfterS{0.25, 0.5, 1, 2};

  explicit LiftOffs(double step_s) : step_s_(step_s) {}

  /// The next frame of a foot, 0 or 1: its true load and ankle, and its leg as estimated.
  void Add(std::size_t foot, double load_n, const Eigen::Vector3d& ankle_m, const LegError& leg);

  std::size_t count() const { return count_; }  ///< Times that a foot left.
  std::size_t kicks() const { return kicks_; }  ///< Runs of frames that are kicks.
  /// The first frame at least kAfterS[i] after the foot left, if it is still off.
  const LegScore& after(std::size_t i) const { return after_[i]; }
  const LegScore& aloft() const { return aloft_; }  ///< All frames off the ground.
  const LegScore& kick() const { return kick_; }    ///< Frames that are kicks.

 private:
  struct Foot {
    bool started = false, aloft = false, kicking = false;
    double stood_s = 0, aloft_s = 0;
    std::size_t next = 0;  ///< Index into kAfterS.
    Eigen::Vector3d ankle_m = Eigen::Vector3d::Zero();
  };

  double step_s_;
  std::array<Foot, 2> feet_;
  std::size_t count_ = 0, kicks_ = 0;
  std::array<LegScore, kAfterS.size()> after_;
  LegScore aloft_, kick_;
};

}  // namespace footing::pose_run
