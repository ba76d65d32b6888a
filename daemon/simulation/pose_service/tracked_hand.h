#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "daemon/simulation/pose/track.h"
#include "daemon/simulation/reconstruction/hand_track.h"
#include "footing/v1/sensor.pb.h"

namespace footing::pose_service {

/// A point that is not heard of for longer counts as not seen.
inline constexpr double kPointTimeoutS = 0.15;

/// A tracked point with the deviations that count: no point is known better than to 2 mm, and its
/// information is the tracker's times its confidence, which a light at the sensor's limit lowers.
struct CountedPoint {
  Eigen::Vector3d p_W_m, sd_m, covariance_m2;
  Eigen::Matrix3d matrix_m2;  ///< The same covariance without that limit.

  explicit CountedPoint(const v1::HandSample& sample);
};

/// Whether the sample is of a point that was seen and whose place is in W: a tracker without
/// calibration reports places in its own frame.
bool IsSeenInWorld(const v1::HandSample& sample);

/// One hand as several trackers see it: a HandTrack for each of them, fused by their covariances.
/// Where they contradict each other the fused covariance grows with the contradiction (Birge's
/// ratio). At most kMostTrackers at once; another one replaces the one that was heard longest ago.
/// What the camera sees of a PS Move's sphere is joined to the Move's own readings
/// (inertial::Track) while there are any. A value.
class TrackedHand {
 public:
  static constexpr std::size_t kMostTrackers = 4;

  /// The PS Move in this hand, if there is one. Another one starts again.
  void Bind(std::optional<std::uint32_t> move);
  /// Nothing but for samples of that Move that have units.
  void Feel(const v1::MotionSample& sample);

  /// A sample by IsSeenInWorld, exposed then.
  void Add(const v1::HandSample& sample, double exposed_s, std::int64_t now_ns);

  struct Fused {
    reconstruction::HandInput hand;  ///< Invalid where no tracker has it.
    bool simulated = false;          ///< One of its trackers is.
    std::set<std::string> trackers;  ///< Their names.
  };
  /// Of the trackers that have seen it lately. `host_ns`: the same instant by the clock of the
  /// samples' own times.
  Fused At(std::int64_t now_ns, std::int64_t host_ns = 0) const;

 private:
  struct Source {
    std::string tracker;
    bool used = false, simulated = false;
    std::int64_t seen_ns = 0;
    reconstruction::HandTrack track;
  };
  Source& SourceOf(const std::string& tracker);
  /// By the Move's readings and what that source sees of it. Invalid without either.
  reconstruction::HandInput Inertial(const Source& source, std::int64_t host_ns) const;

  std::array<Source, kMostTrackers> sources_;
  std::optional<std::uint32_t> move_;
  std::optional<inertial::Track> inertial_;  ///< From the Move's first sample on.
};

}  // namespace footing::pose_service
