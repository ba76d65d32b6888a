#include "daemon/offline/pose_run/plates.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/number.h"
#include "common/base/units.h"
#include "common/virtual/devices/impact_reaction.h"
#include "daemon/offline/pose_run/plates_com.h"
#include "daemon/offline/pose_run/stage.h"

namespace footing::pose_run {
namespace {

namespace sensors = virtual_sensors;
using sensors::kFeet;

constexpr double kLeastSupportedS = 0.5;
/// The first frames of a clip have the forces of leaving the T-pose in them: the low-pass of the
/// motion spreads them so far.
constexpr double kRunInS = 0.15;
constexpr double kMissingShare = 0.25;  // Of the weight: more than inverse dynamics is wrong by.
constexpr double kMissingSpanS = 0.2;   // Span of the mean: it smears impacts.
constexpr double kBesideM = 0.08;       // Further from a foot than a COP under it can be.
constexpr double kElsewhereM = 0.4;     // Forces of another place or trial.
constexpr double kMassOff = 0.05;
constexpr double kTinyS = 1e-6;
constexpr double kMovingMps = 0.3;

/// [begin, begin + count) of the clip's frames.
motion::Motion Part(const motion::Motion& clip, Eigen::Index begin, Eigen::Index count) {
  motion::Motion part = clip;
  part.q = clip.q.middleCols(begin, count);
  part.start_s = clip.start_s + static_cast<double>(begin) / clip.rate_hz;
  return part;
}

double LastS(const motion::Motion& clip) {
  return clip.start_s + static_cast<double>(clip.frames() - 1) / clip.rate_hz;
}

/// Stage, with forces that measured ones can be compared with.
Result<sensors::Scene> StageOnPlates(const motion::Motion& clip, const Settings& settings,
                                     const std::string& origin) {
  auto scene = Stage(clip, settings, origin);
  if (!scene) return scene.error();
  scene->reaction = sensors::ReactToImpacts(scene->body, scene->motion, scene->course);
  return scene;
}

std::string Seconds(double begin_s, double end_s) {
  return text::Fixed(begin_s, 2) + " to " + text::Fixed(end_s, 2) + " s";
}

Result<motion::Motion> InCommon(const motion::Motion& clip, const motion::GroundForces& forces,
                                const std::string& origin, const std::string& forces_origin) {
  const double samples = static_cast<double>(forces.plates.front().force_W.cols());
  const double forces_end_s = forces.start_s + (samples - 1) / forces.rate_hz;
  const double begin_s = std::max(clip.start_s, forces.start_s);
  const double end_s = std::min(LastS(clip), forces_end_s);
  if (end_s - begin_s < kLeastSupportedS) {
    return InvalidData(forces_origin + ": its forces (" + Seconds(forces.start_s, forces_end_s) +
                       ") and the motion of " + origin + " (" + Seconds(clip.start_s, LastS(clip)) +
                       ") have less than half a second in common: give the same trial's");
  }
  const auto begin =
      static_cast<Eigen::Index>(std::ceil((begin_s - clip.start_s) * clip.rate_hz - 1e-6));
  const auto end =
      static_cast<Eigen::Index>(std::floor((end_s - clip.start_s) * clip.rate_hz + 1e-6));
  return Part(clip, begin, end - begin + 1);
}

/// Frames of the clip in which the plates carry what the motion needs.
std::vector<bool> SupportedFrames(const motion::Motion& clip, const sensors::Scene& scene,
                                  const FeltForces& felt) {
  const Eigen::Index frames = clip.frames();
  const Eigen::Index before = scene.motion.frames() - frames;
  const auto half = static_cast<Eigen::Index>(std::lround(0.5 * kMissingSpanS * clip.rate_hz));
  std::vector<double> missing_n;
  for (Eigen::Index i = 0; i < frames; ++i) {
    const double time_s = static_cast<double>(i) / clip.rate_hz;
    double load_n = 0;
    for (std::size_t f = 0; f < kFeet; ++f) load_n += felt.Mean(f, time_s, 0).load_n;
    missing_n.push_back(scene.reaction.force_n(2, before + i) - load_n);
  }
  std::vector<bool> supported;
  for (Eigen::Index i = 0; i < frames; ++i) {
    const Eigen::Index low = std::max<Eigen::Index>(i - half, 0);
    const Eigen::Index high = std::min(i + half, frames - 1);
    double sum = 0;
    for (Eigen::Index k = low; k <= high; ++k) sum += missing_n[static_cast<std::size_t>(k)];
    supported.push_back(sum / static_cast<double>(high - low + 1) <
                        kMissingShare * scene.course.mass_kg * kStandardGravityMps2);
  }
  return supported;
}

struct Stretch {
  Eigen::Index begin = 0, count = 0;
};

Stretch Longest(const std::vector<bool>& supported) {
  Stretch best, now;
  for (std::size_t i = 0; i < supported.size(); ++i) {
    if (!supported[i]) {
      now = {static_cast<Eigen::Index>(i) + 1, 0};
    } else if (++now.count > best.count) {
      best = now;
    }
  }
  return best;
}

/// What the boards feel at one time: simulated in the T-pose, measured in the clip. While the
/// T-pose is left, the left foot's share of the load and the COPs go over by what they differ
/// later. Who begins in the air has stepped off the boards to get there.
class Feet {
 public:
  using Forces = std::array<sensors::FootForce, kFeet>;

  Feet(const sensors::Scene& scene, const motion::Motion& clip, const FeltForces& felt,
       double rate_hz)
      : scene_(scene),
        felt_(felt),
        span_s_(1 / rate_hz),
        begin_s_(static_cast<double>(scene.motion.frames() - clip.frames()) / clip.rate_hz) {
    const Forces simulated = Simulated(ColumnAt(scene, judged_s()));
    const Forces first = Measured(kRunInS, simulated);
    left_share_ = LeftShare(first) - LeftShare(simulated);
    for (std::size_t f = 0; f < kFeet; ++f) cop_m_[f] = first[f].cop_m - simulated[f].cop_m;
    const Forces begin = Measured(0, simulated);
    begins_aloft_ = begin[0].load_n + begin[1].load_n < kLoadedN;
  }

  double judged_s() const { return begin_s_ + kRunInS; }

  Forces At(double time_s, Eigen::Index column) const {
    Forces feet = Simulated(column);
    if (time_s > judged_s() - kTinyS) return Measured(time_s - begin_s_, feet);
    if (begins_aloft_ && time_s > kStandS) {
      for (sensors::FootForce& foot : feet) foot.load_n = 0;
      return feet;
    }
    const double u = std::clamp((time_s - kStandS) / (begin_s_ - kStandS), 0.0, 1.0);
    const double s = u * u * u * (10 - 15 * u + 6 * u * u);
    const double total_n = feet[0].load_n + feet[1].load_n;
    const double left = std::clamp(LeftShare(feet) + s * left_share_, 0.0, 1.0);
    feet[0].load_n = left * total_n;
    feet[1].load_n = (1 - left) * total_n;
    for (std::size_t f = 0; f < kFeet; ++f) feet[f].cop_m += s * cop_m_[f];
    return feet;
  }

 private:
  static double LeftShare(const Forces& feet) {
    const double total_n = feet[0].load_n + feet[1].load_n;
    return total_n > kLoadedN ? feet[0].load_n / total_n : 0.5;
  }
  Forces Simulated(Eigen::Index column) const {
    return sensors::ShareBetweenFeet(scene_.course, scene_.reaction, column);
  }
  Forces Measured(double clip_s, const Forces& otherwise) const {
    Forces feet;
    for (std::size_t f = 0; f < kFeet; ++f) {
      feet[f] = felt_.Mean(f, clip_s, span_s_);
      if (!feet[f].cop_m.allFinite()) feet[f].cop_m = otherwise[f].cop_m;
    }
    return feet;
  }

  const sensors::Scene& scene_;
  const FeltForces& felt_;
  double span_s_, begin_s_;
  double left_share_ = 0;
  bool begins_aloft_ = false;
  std::array<Eigen::Vector2d, kFeet> cop_m_;
};

void AddWarnings(double mass_kg, PlateReport& report) {
  if (report.supported_share < 1) {
    report.warnings.push_back("the plates carry the body in " +
                              text::Fixed(100 * report.supported_share, 0) +
                              " % of the trial only (a chair, a box, the floor beside them?); " +
                              Seconds(report.begin_s, report.end_s) + " is evaluated");
  }
  if (report.begin_mps > kMovingMps) {
    report.warnings.push_back("it begins with the body at " + text::Fixed(report.begin_mps, 1) +
                              " m/s; the boards did not measure what came before");
  }
  if (std::abs(report.mass_kg / mass_kg - 1) > kMassOff) {
    report.warnings.push_back("the plates carry " + text::Fixed(report.mass_kg, 1) +
                              " kg in the mean, --mass-kg says " + text::Fixed(mass_kg, 1));
  }
  for (const PlateUse& use : report.plates) {
    if (use.beside_m < kBesideM) continue;
    report.warnings.push_back(use.plate + ": its centre of pressure is " +
                              text::Fixed(100 * use.beside_m, 0) +
                              " cm beside the foot: are both feet on it, or the markers off?");
  }
}

/// How far the measured forces are from those made from the motion, at the motion's own frames but
/// for the first and last ones, which the low-pass spreads the ends over.
void Compare(const motion::Motion& clip, const sensors::Scene& scene, const FeltForces& felt,
             PlateReport& report) {
  double sum_n = 0, square_n2 = 0, count = 0, loaded = 0;
  double made_n = 0, made_n2 = 0, both_n2 = 0;
  Eigen::Vector2d square_m2 = Eigen::Vector2d::Zero(), sum_m = Eigen::Vector2d::Zero();
  const Eigen::Index before = scene.motion.frames() - clip.frames();
  const auto end_frames = static_cast<Eigen::Index>(std::ceil(kRunInS * clip.rate_hz));
  for (Eigen::Index i = end_frames; i + end_frames < clip.frames(); ++i) {
    const double made = scene.reaction.force_n(2, before + i);
    double load = 0;
    Eigen::Vector2d moment = Eigen::Vector2d::Zero();
    for (std::size_t f = 0; f < kFeet; ++f) {
      const auto foot = felt.Mean(f, static_cast<double>(i) / clip.rate_hz, 1 / clip.rate_hz);
      if (!foot.cop_m.allFinite()) continue;
      load += foot.load_n;
      moment += foot.load_n * foot.cop_m;
    }
    sum_n += load;
    square_n2 += std::pow(load - made, 2);
    made_n += made;
    made_n2 += made * made;
    both_n2 += made * (load - made);
    ++count;
    if (std::min(load, made) < kLoadedN * kFeet) continue;
    const Eigen::Vector2d off = moment / load - scene.reaction.cop_m.col(before + i);
    sum_m += off;
    square_m2 += off.cwiseAbs2();
    ++loaded;
  }
  report.mass_kg = count > 0 ? sum_n / count / kStandardGravityMps2 : 0;
  report.force_rms_n = count > 0 ? std::sqrt(square_n2 / count) : 0;
  report.cop_rms_m = (square_m2 / std::max(loaded, 1.0)).cwiseSqrt();
  report.cop_bias_m = sum_m / std::max(loaded, 1.0);
  // |measured - (1 + more) simulated|^2, from the sums of |measured - simulated|^2 and its like.
  const double more = made_n > 0 ? sum_n / made_n - 1 : 0;
  const double own_n2 = square_n2 - 2 * more * both_n2 + more * more * made_n2;
  report.force_own_mass_rms_n = count > 0 ? std::sqrt(std::max(own_n2, 0.0) / count) : 0;
}

}  // namespace

Result<PlateRun> RunOnPlates(const motion::Motion& clip, const motion::GroundForces& forces,
                             const Settings& settings, const std::string& origin,
                             const std::string& forces_origin) {
  if (settings.loop_s > 0) {
    return UsageError("measured forces go forwards once: no loop with them");
  }
  auto common = InCommon(clip, forces, origin, forces_origin);
  if (!common) return common.error();
  auto scene = StageOnPlates(*common, settings, origin);
  if (!scene) return scene.error();
  PlateRun out;
  FeltForces felt = FeelPlates(*common, *scene, forces);
  for (const PlateUse& use : felt.plates) {
    if (use.beside_m < kElsewhereM) continue;
    return InvalidData(forces_origin + ": the centre of pressure of " + use.plate + " is " +
                       std::to_string(std::lround(100 * use.beside_m)) +
                       " cm from the nearer foot of " + origin +
                       ": forces and motion must be of one trial, in one frame");
  }
  const std::vector<bool> supported = SupportedFrames(*common, *scene, felt);
  const Stretch stretch = Longest(supported);
  if (static_cast<double>(stretch.count) < kLeastSupportedS * common->rate_hz) {
    return InvalidData(forces_origin + ": never carries the body of " + origin +
                       " for half a second: give all plates and the person's --mass-kg");
  }
  out.report.supported_share =
      static_cast<double>(std::count(supported.begin(), supported.end(), true)) /
      static_cast<double>(supported.size());
  motion::Motion part = Part(*common, stretch.begin, stretch.count);
  if (stretch.count < common->frames()) {
    scene = StageOnPlates(part, settings, origin);
    if (!scene) return scene.error();
    felt = FeelPlates(part, *scene, forces);
  }
  const Feet feet(*scene, part, felt, settings.rate_hz);
  out.measured = RunScene(*scene, settings, [&feet](double time_s, Eigen::Index column) {
    return feet.At(time_s, column);
  });
  out.simulated = RunScene(*scene, settings, SimulatedForces(*scene));
  out.measured.judged_from = out.simulated.judged_from =
      static_cast<std::size_t>(std::ceil((feet.judged_s() - kTinyS) * settings.rate_hz));
  out.com_by_force_m = ComByPlates(out.measured, felt, feet.judged_s() - kRunInS);
  out.measured.clock_offset_s = out.simulated.clock_offset_s =
      part.start_s - (scene->motion.duration_s() - part.duration_s());
  out.report.plates = felt.plates;
  out.report.begin_s = part.start_s;
  out.report.end_s = LastS(part);
  const Frame* const first = &out.measured.frames[out.measured.judged_from];
  out.report.begin_mps = (first[1].com_m - first[0].com_m).norm() * settings.rate_hz;
  Compare(part, *scene, felt, out.report);
  AddWarnings(settings.mass_kg, out.report);
  return out;
}

}  // namespace footing::pose_run
