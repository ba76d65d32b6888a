#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "clients/skeleton/tracking/decoder.h"
#include "clients/skeleton/tracking/joint_set.h"
#include "clients/skeleton/tracking/person_gate.h"
#include "common/base/osc.h"
#include "common/base/result.h"
#include "common/stream/hands.h"

namespace footing::skeleton {

/// A joint in W. What is absent has no place.
struct JointObservation {
  bool present = false;
  bool inferred = false;  ///< The camera did not see it and filled it in.
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_W_m2 = Eigen::Matrix3d::Identity();
  double confidence = 0;
};

/// One exposure of one person, as it goes to footingd.
struct Observation {
  std::int32_t user = 0;
  std::optional<std::int64_t> sequence;
  std::int64_t exposed_ns = 0, arrived_ns = 0;  ///< Monotonic, of this host.
  std::array<JointObservation, kJoints> joints;
  Eigen::Isometry3d X_WK = Eigen::Isometry3d::Identity();  ///< Pose of K, which puts them in W.
};

/// Standard deviations of a tracked joint: jitter of recorded Kinect v2 joints (2 to 4 mm between
/// frames, 10 to 21 mm of bone length) and the offset against marker systems, which changes slowly
/// (50 to 100 mm for most joints of the Kinect 2: Wang, Kurillo et al. 2015, here 40 mm, since half
/// of it are other definitions of joints). An inferred joint has three times as much.
inline constexpr double kJitterM = 0.015;
inline constexpr double kOffsetM = 0.04;
inline constexpr double kInferredFactor = 3;

/// A frame behind the gate, in W.
Observation Observe(const Skeleton& skeleton, const Eigen::Isometry3d& X_WK);

/// An observation for the device socket: all joints, those that are absent, or too far off, with
/// confidence 0. What counts of a point is its covariance over its confidence, which is the
/// observation's (docs/protocol.md).
stream::HandFrame ToHandFrame(const Observation& observation, std::int64_t now_ns);

/// Pose of the camera in W.
struct CameraPlace {
  Eigen::Vector3d p_W_m{2.5, 0, 1};  ///< Origin of K in W, above the boards' surface.
  double yaw_rad =
      3.141592653589793;  ///< Viewing direction about W's z; 0 looks along x, pi at a person.
  double pitch_rad = 0;   ///< Upwards positive.
  double roll_rad = 0;    ///< Its left side up is positive.
};

/// K in W.
Eigen::Isometry3d ToPose(const CameraPlace& place);

/// A place found from a person who stands on the boards.
struct StandingFit {
  CameraPlace place;
  double lean_rad = 0;   ///< Trunk against the camera's up: the camera's tilt, or the person's.
  double scatter_m = 0;  ///< Standard deviation of the middle of the feet.
};

inline constexpr double kStandingS = 2;
inline constexpr std::size_t kLeastStandingFrames = 10;  ///< However long they take.
inline constexpr double kMostLeanRad = 0.26;             ///< 15 degrees.
inline constexpr double kMostScatterM = 0.03;
inline constexpr double kAnkleHeightM = 0.08;  ///< Height of an ankle's centre above the sole.

/// The place of a camera from frames of a person who stands still on the boards, facing along W's
/// x: left is where shoulders and hips say, the middle of the ankles is above W's origin. Pitch and
/// roll are known from `known`. Failure says what to do: too few whole frames, a person who moves,
/// a trunk that leans by more than 15 degrees. If left and right are swapped, the camera would be
/// on the opposite side, so it is a failure, too, that the toes point back, or that the person does
/// not face a camera where there is one (`by_camera`).
Result<StandingFit> FitStanding(std::span<const Skeleton> frames, const CameraPlace& known,
                                bool by_camera = true);

/// Estimates the age of an exposure by the sender's own time. A sender on this host, or with a
/// synchronised clock, gives it at once. Of any other clock only differences mean something: the
/// fastest packet of the last 10 to 20 s is taken to have needed `latency_ns`, the others longer. A
/// plain value.
class SenderClock {
 public:
  static constexpr std::int64_t kOldestNs = 500'000'000;  ///< Older ones have another clock.
  static constexpr std::int64_t kWindowNs = 10'000'000'000;

  explicit SenderClock(std::int64_t latency_ns) : latency_ns_(latency_ns) {}

  /// `sent_ns`: none where the sender gives no time; `unix_time`: it counts from 1970, as
  /// `wall_ns` does. `now_ns` is monotonic and does not decrease. The age is 0 to 1 s.
  std::int64_t Age(std::optional<std::int64_t> sent_ns, bool unix_time, std::int64_t now_ns,
                   std::int64_t wall_ns);

 private:
  static constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::max();

  std::int64_t latency_ns_;
  std::int64_t window_began_ns_ = 0;
  std::int64_t least_ns_ = kNone, least_before_ns_ = kNone;  // Minimum of this and last window.
};

/// Options of a tracker.
struct TrackerOptions {
  DialectOptions dialect = {};
  CameraPlace camera = {};
  bool stand = false;  ///< Find the camera's place from the person; nothing is published before.
  std::optional<std::int32_t> user = {};  ///< Only this person; none: who was seen first and stays.
  std::int64_t latency_ns = 67'000'000;   ///< Latency of unstamped input: two frames, 30 Hz.
};

/// Counts and last fault of one person's skeletons.
struct PersonCounts {
  Dialect dialect = Dialect::kFooting;
  std::uint64_t skeletons = 0, joints = 0, inferred = 0;
  std::array<std::uint64_t, 5> verdicts{};  ///< Indexed by Verdict.
  Fault fault = Fault::kNone;               ///< Fault of the last frame.
};

/// Counts of a tracker since its start.
struct TrackerCounts {
  std::uint64_t packets = 0, bytes = 0, rejected_packets = 0, skeletons = 0;
  std::uint64_t overtaken = 0;  ///< Skeletons that came after a newer one of their person.
  std::map<std::int32_t, PersonCounts> people;  ///< Counts by user; bounded as the decoder's.
};

/// UDP packets to observations in W: decoder, gate, clock and placement of each person, of whom one
/// is published. A plain value; time is an argument.
class Tracker {
 public:
  explicit Tracker(const TrackerOptions& options);

  /// One packet; appends the observations that are complete. `now_ns` monotonic, `wall_ns` since
  /// 1970.
  void Take(osc::Bytes packet, std::int64_t now_ns, std::int64_t wall_ns,
            std::vector<Observation>& out);
  /// Appends skeletons that have waited too long for the rest of their frame.
  void Flush(std::int64_t now_ns, std::int64_t wall_ns, std::vector<Observation>& out);

  /// Lines for a person since the last call: packets that cannot be read, a fault that came or
  /// went, the placement, a person who is wanted and not seen.
  std::vector<std::string> Messages();

  /// Fault of a person's skeleton and its remedy, also while the camera is not placed; empty when
  /// all is well.
  std::string AdviceOf(std::int32_t user) const;
  /// Why nobody is published at all, where what arrives shows it.
  std::string Advice() const;

  const TrackerCounts& counts() const { return counts_; }
  const DecoderCounts& decoder_counts() const { return decoder_.counts(); }
  /// None while the person's stand has not been seen.
  const std::optional<CameraPlace>& camera() const { return camera_; }

 private:
  struct Person {
    explicit Person(std::int64_t latency_ns) : clock(latency_ns) {}
    PersonGate gate;
    SenderClock clock;
    std::int64_t seen_ns = 0;
    /// Exposure time of the person's newest skeleton.
    std::int64_t exposed_ns = std::numeric_limits<std::int64_t>::min();
    Fault reported = Fault::kNone;
  };

  void Settle(std::int64_t now_ns, std::int64_t wall_ns, std::vector<Observation>& out);
  void Take(const Decoded& decoded, std::int64_t now_ns, std::int64_t wall_ns,
            std::vector<Observation>& out);
  Person& PersonOf(std::int32_t user, std::int64_t now_ns);
  bool IsPublished(std::int32_t user, std::int64_t now_ns);
  void Stand(const Decoded& decoded, const Skeleton& gated, std::int64_t exposed_ns);
  void NoteOther(std::int32_t user, std::int64_t now_ns);
  void Report(std::int32_t user, Person& person, Fault fault);

  TrackerOptions options_;
  Decoder decoder_;
  std::map<std::int32_t, Person> people_;
  std::optional<std::int32_t> published_;
  std::optional<CameraPlace> camera_;
  Eigen::Isometry3d X_WK_ = Eigen::Isometry3d::Identity();
  std::vector<Skeleton> standing_;
  std::int64_t standing_since_ns_ = 0;
  std::string not_placed_;
  std::set<std::int32_t> others_;  // Seen, and not the wanted one; a few.
  std::int64_t other_since_ns_ = 0;
  bool others_reported_ = false;
  TrackerCounts counts_;
  std::vector<std::string> messages_;
  osc::Packet packet_;
  std::vector<Decoded> complete_;
};

}  // namespace footing::skeleton
