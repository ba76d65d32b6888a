#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "clients/view/scene/bird_motion.h"
#include "clients/view/scene/figure.h"
#include "clients/view/scene/part.h"
#include "clients/view/scene/update.h"

namespace footing::scene {

/// Feathers and skin of one bird.
struct Plumage {
  Colour back, belly, wing, tail, crest, skin, beak;
};

/// One plumage a character, so that two players can distinguish their birds.
Plumage PlumageOf(std::uint32_t character);

/// The bird over a biped's pose; its toes bend on the floor of that height. Adds nothing when the
/// pose has not the links it needs.
void AddBird(const BirdSkeleton& skeleton, const CharacterPose& pose, const BirdMotion& motion,
             double floor_m, PartList& parts);

/// Neck, head, eyes, beak and crest. X_WB's columns 0 to 2 are the body's axes, column 3 its place.
void AddHead(const Eigen::Matrix4f& X_WB, const BirdMotion& motion, const Plumage& plumage,
             PartList& parts);

/// Each of the drawn leg's two segments. The telescoping leg is 0.55 m to 1.15 m long, so two
/// segments of 0.60 m always reach.
inline constexpr double kLegSegmentM = 0.60;

/// A bird's leg drawn over a telescoping one: hip, backward-bending ankle, foot, in W.
struct LegPose {
  Eigen::Vector3d hip_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d ankle_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d foot_m = Eigen::Vector3d::Zero();
};

/// Puts the ankle sqrt(a^2 - (l/2)^2) behind the middle of the line from hip to foot, within the
/// leg's pitch plane; a = kLegSegmentM, l = |foot - hip|. `forward` is the leg's pitch-plane
/// direction; need not be of length 1 nor square to the leg. A leg longer than 2 a, which the
/// physics never makes, is drawn straight from the hip with the foot where it is.
LegPose SolveLeg(const Eigen::Vector3d& hip_m, const Eigen::Vector3d& foot_m,
                 const Eigen::Vector3d& forward);

/// Latencies of the last 100 000 ticks.
class Latencies {
 public:
  void Add(std::int64_t latency_ns);
  /// The value that a share of the ticks stay below, ms; 0 without ticks. `share` in [0, 1].
  double QuantileMs(double share) const;
  std::size_t count() const { return values_ns_.size(); }

 private:
  std::vector<std::int64_t> values_ns_;
  std::size_t next_ = 0;
};

/// Counts of one run: the numbers that the program prints at its end.
///
/// A gait counts as seen once the first character has run it without a break for 2 s of simulation
/// time and three full cycles: six steps, or three jumps, commanded by received features all the
/// while.
class Tally {
 public:
  void Add(const WorldFrame& frame);
  /// A response whose stamps say where its time went.
  void Add(const stream::ResponseStages& response);

  std::uint64_t frames() const { return frames_; }
  /// Published by the server from the first frame to the last, received or not.
  std::uint64_t frames_published() const { return frames_published_; }
  std::vector<stream::Gait> GaitsSeen() const;
  /// Since the first frame; a restarted server goes on counting.
  std::uint64_t falls() const { return falls_; }
  const stream::FailureCounts& failures() const { return failures_; }
  std::uint64_t operator_put_backs() const { return operator_put_backs_; }
  /// Simulation time in which the first character was beside its track, s.
  double off_track_s() const { return off_track_s_; }
  double distance_m() const { return distance_m_; }

  Latencies publish_to_view;
  std::map<std::string, Latencies> response_stages;  ///< By the names of stream::ResponseTimes.
  Latencies response_without_contact;  ///< All stages but the wait for the right contact.
  std::uint64_t frames_drawn = 0;

 private:
  struct Stretch {
    stream::Gait gait = stream::Gait::kUnspecified;
    double start_s = 0;
    std::uint64_t start_steps = 0;
  };

  std::uint64_t frames_ = 0;
  std::uint64_t frames_published_ = 0;
  std::uint64_t last_sequence_ = 0;
  Stretch stretch_;
  stream::GaitState last_;
  double last_time_s_ = 0;
  std::uint64_t falls_ = 0;
  stream::FailureCounts failures_;
  std::uint64_t operator_put_backs_ = 0;
  double distance_m_ = 0;
  double off_track_s_ = 0;
  std::vector<stream::Gait> seen_;
};

/// Statistics of a reconstructed body in one run, and its errors against the true motion of the
/// simulated person. Each pose is held against the reference that was sampled nearest to when the
/// pose is of (its publication less its lag), so all latencies count as errors.
class PoseTally {
 public:
  /// The first character of a frame that was published at `host_ns` (the viewer's clock).
  void Add(const CharacterPose& pose, const Anatomy& anatomy, std::int64_t host_ns,
           const std::deque<ReferencePose>& references);

  bool any() const { return frames_ > 0; }
  bool calibrated() const { return last_.calibrated; }
  /// Frames with a T-pose taken, and how often one was taken.
  std::uint64_t calibrated_frames() const { return calibrated_frames_; }
  std::uint64_t calibrations() const { return calibrations_; }
  std::uint32_t resets() const { return last_.resets; }
  double mass_kg() const { return last_.mass_kg; }
  const std::string& hands_source() const { return last_.hands_source; }
  const std::string& contact_source() const { return last_.contact_source; }
  /// Frames that were compared; the means below are over them, cm, over those that are not valid,
  /// too. Joints are the landmarks of a person without the tips of hands and toes.
  std::uint64_t compared() const { return compared_; }
  std::uint64_t invalid() const { return invalid_; }  ///< Invalid frames among those compared.
  double mpjpe_cm() const { return Mean(all_cm_); }
  /// Mean error of the joints relative to the hips, cm.
  double mpjpe_root_relative_cm() const { return Mean(relative_cm_); }
  double wrists_cm() const { return Mean(wrists_cm_); }
  double ankles_cm() const { return Mean(ankles_cm_); }

 private:
  double Mean(double sum) const {
    return compared_ == 0 ? 0 : sum / static_cast<double>(compared_);
  }
  void Compare(const CharacterPose& pose, const Anatomy& anatomy, const ReferencePose& reference);

  std::uint64_t frames_ = 0, calibrated_frames_ = 0, calibrations_ = 0, compared_ = 0, invalid_ = 0;
  BodyState last_;
  double all_cm_ = 0, relative_cm_ = 0, wrists_cm_ = 0, ankles_cm_ = 0;
};

}  // namespace footing::scene
