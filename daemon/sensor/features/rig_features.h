#pragma once

#include <complex>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/stream/sensor.h"
#include "daemon/sensor/features/config.h"
#include "daemon/sensor/features/cycle.h"
#include "daemon/sensor/features/sample_grid.h"

/// Frequency by autocorrelation (section 6, eq. 3).
///
/// | paper | here | unit |
/// |---|---|---|
/// | a(t) | SampleGrid::Filtered | m/s² |
/// | tau | lag | grid steps of 10 ms |
/// | tp | overlap | grid steps |
/// | W(t) = 1 - (T - t) / tp | weight | 1 |
/// | Ra(tau) | Correlation, normalised to at most 1 | 1 |
///
/// Departures, with reasons in docs/features.md: Ra is made independent of the mean and of the size
/// of the swing, rho = 1 - sum W |a(t) - a(t - tau)|² / (2 sum W var); tp grows with tau; the peak
/// is refined between grid points and over several cycles.
namespace footing::features {

/// Period of a limb's swing by its autocorrelation.
struct PeriodEstimate {
  bool found = false;
  double period_s = 0;
  double correlation = 0;
};

/// The period of the newest `points` samples, those since motion began, at most size(). Not found:
/// nothing in the range repeats. `known_s` is the period until now, 0 if none: where the sure
/// search sees another one but the quick one still sees this, the cadence has not changed, only the
/// phase has jumped.
PeriodEstimate FindPeriod(const SampleGrid& grid, int points, double known_s,
                          const CadenceConfig& config);

/// Equation (3) as printed: the lag of the first high peak of Ra, and no correlation. Samples from
/// before the motion count. Not found: Ra has no peak.
PeriodEstimate PeriodAsPrinted(const SampleGrid& grid, const Config& config);

/// The period that is published: jumps must persist, a loss is bridged for a while.
struct Cadence {
  bool valid = false;
  double period_s = 0;
  double lost_s = 0;           ///< How long nothing was found.
  double candidate_s = 0;      ///< A jump that has not persisted yet; 0 none.
  double candidate_age_s = 0;  ///< For how long it was seen.
};

/// Estimate of the other hand or leg of the pair; nothing if there is none.
struct Partner {
  PeriodEstimate estimate;
  double period_s = 0;  ///< Period of its cadence; 0 none.
};

/// Whether the cadence lasts for several of the partner's: what repeats after one period repeats
/// after two and three as well, so of two limbs the one with the shorter period is right.
bool SpansSeveral(const Cadence& cadence, const Partner& partner, const CadenceConfig& config);

/// The cadence `elapsed_s` later, with a new estimate.
Cadence Next(const Cadence& before, const PeriodEstimate& estimate, const Partner& partner,
             double elapsed_s, const CadenceConfig& config);

/// How the right controller lies in its hand against the left one: rotated about the front, which
/// points along a forearm. Ours: equation (4) compares the sensors' own axes, but of controllers
/// that are rotated against each other by a right angle these have only the fronts in common, along
/// which hands that alternate and hands together move alike. Gravity shows the rotation, since both
/// forearms point the same way on the mean of a cycle. A plain value.
struct PairGrip {
  /// Gravity across the fronts, left times the conjugate of right, as x + iz: its angle is the
  /// rotation from right to left. Mean over what was seen.
  std::complex<double> turn_m2ps4 = 0;
  double seen_s = 0;                    ///< For how long, at most the horizon; 0: nothing is known.
  std::complex<double> rest_m2ps4 = 0;  ///< The same of hands at rest,
  double rest_s = 0;                    ///< and for how long.

  /// From the right one's frame S to one that lies in its hand as the left one does.
  Eigen::Matrix3d FromRight() const;
};

/// Whether the two newest cycles of `steps` grid points have the same mean across the front, so
/// that it is gravity: while a swing changes, a share of it stays in its mean.
bool MeanRepeats(const SampleGrid& grid, double steps, const GripConfig& config);

/// `elapsed_s` later, with the gravity in S that each shows, m/s²: none while it shows none.
/// `rests`: it is that of hands at rest, which counts only until they have swung.
PairGrip Next(const PairGrip& before, const std::optional<Eigen::Vector3d>& left_mps2,
              const std::optional<Eigen::Vector3d>& right_mps2, bool rests, double elapsed_s,
              const GripConfig& config);

/// The features of one controller. A plain value; copy it to try something out.
class DeviceFeatureExtractor {
 public:
  DeviceFeatureExtractor(std::uint32_t device, stream::DeviceRole role, const Config& config);

  void AddSample(const stream::MotionSample& sample);
  /// Takes the newest samples in: first Observe of all controllers, then Compute of each. Forgets
  /// all when the newest sample is older than Config::stale_s at `now_ns`.
  /// `partner` is what the other hand or leg showed until now.
  void Observe(std::int64_t now_ns, const Partner& partner);
  /// The period as the newest samples alone show it; not found while still.
  const PeriodEstimate& estimate() const { return estimate_; }
  /// The estimate, and the cadence of the last Compute.
  Partner AsPartner() const { return {estimate_, cadence_.valid ? cadence_.period_s : 0}; }
  /// The features as of the newest sample.
  const stream::DeviceFeatures& Compute(const Partner& partner);

  /// Since the motion began.
  const SwingEnd& swing_end() const { return swing_end_; }

  /// As rest shows it, or the newest of two cycles that agree on it; in S, m/s². Else none.
  const std::optional<Eigen::Vector3d>& gravity_mps2() const { return gravity_mps2_; }

  std::uint32_t device() const { return features_.device; }
  stream::DeviceRole role() const { return features_.role; }
  const SampleGrid& grid() const { return grid_; }
  /// Arrival of the newest sample; 0 before the first.
  std::int64_t newest_received_ns() const { return newest_received_ns_; }

 private:
  void MeasureCycle();
  void MeasureRest();
  void TakeInclination(const Eigen::Vector3d& gravity_mps2);
  void Forget();

  Config config_;
  SampleGrid grid_;
  stream::DeviceFeatures features_;
  Moving moving_;
  PeriodEstimate estimate_;
  Cadence cadence_;
  SwingEnd swing_end_;
  std::optional<Eigen::Vector3d> gravity_mps2_;
  double elapsed_s_ = 0;  ///< Between the newest points of the last two Observe; 0 nothing new.
  std::int64_t newest_received_ns_ = 0;
  std::uint32_t beginnings_ = 0;     ///< Beginnings of the grid, when last observed.
  std::int64_t computed_index_ = 0;  ///< Grid index of the newest point already taken in.
};

// Two hands that swing together, seen without their period. Ours: eq. (4) needs a period, and has
// none for up to two cycles while both hands change from one motion to another.

/// Normalised cross-correlation at lag 0 of the newest `span_s` of both controllers, -1 to 1, with
/// the means removed and the right one turned by `from_right` (PairGrip): high when both move
/// alike, below zero when they alternate, whatever the period. 0: there are not so many samples, or
/// one stands still.
double CorrelationNow(const SampleGrid& left, const SampleGrid& right,
                      const Eigen::Matrix3d& from_right, double span_s);

/// For how long both have moved together.
struct Together {
  double lasted_s = 0;
  bool sure = false;  ///< That is long enough.
};

Together Next(const Together& before, const SampleGrid& left, const SampleGrid& right,
              const Eigen::Matrix3d& from_right, double elapsed_s, const PhaseConfig& config);

/// The five features of the gait paper, section 6, of all controllers of one rig: moving or not,
/// frequency, phase between left and right, amplitude, inclination.
struct Member {
  std::uint32_t device = 0;
  stream::DeviceRole role = stream::DeviceRole::kUnspecified;
};

/// Samples in, features out; any set of controllers of one rig, as they come. The two hands make a
/// pair, and so do the two legs. A plain value of fixed size; copy it to try something out.
class RigFeatureExtractor {
 public:
  /// Members that are boards are a bug of the caller, and so are more than eight.
  RigFeatureExtractor(std::string rig, const std::vector<Member>& members,
                      const Config& config = {});

  /// Takes the sample by its device; a device outside the rig is ignored. Instants are
  /// sampled_ns; both the raw and the filtered force must be filled in (m/s², frame S).
  void AddSample(const stream::MotionSample& sample);

  /// Features as of the newest samples. Call once a tick (10 ms): what is held is held by the time
  /// between the samples, not by the number of calls. decoded_ns is left to the caller. Never NaN.
  stream::RigFeatures Compute(std::int64_t now_ns);

 private:
  struct Pair {
    std::size_t left = 0;
    std::size_t right = 0;
    Phase phase;
    std::int64_t computed_index = 0;
    double period_s = 0;    ///< That the two had in common last.
    double disagree_s = 0;  ///< How long they have had none.
    Together together;      ///< While no period shows their phase.
    PairGrip grip;
  };
  /// The period that the two share; 0 while they do not agree on one.
  double CommonPeriod(const stream::DeviceFeatures& left, const stream::DeviceFeatures& right,
                      double elapsed_s, Pair& pair) const;
  std::vector<Partner> Partners() const;  ///< By device.
  void AddPair(stream::DeviceRole left, stream::DeviceRole right);
  stream::PairFeatures ComputePair(Pair& pair, const std::vector<stream::DeviceFeatures>& devices);

  std::string rig_;
  Config config_;
  std::vector<DeviceFeatureExtractor> devices_;
  std::vector<Pair> pairs_;
};

}  // namespace footing::features
