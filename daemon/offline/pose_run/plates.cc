#include "daemon/offline/pose_run/plates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/QR>

#include "common/base/result.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/virtual/devices/board_cells.h"
#include "daemon/offline/pose_run/pose_run.h"

namespace footing::pose_run {
namespace {

namespace sensors = virtual_sensors;
using sensors::kFeet;

/// The clip's frame in the scene's: columns before it, and how W of its file lies in W.
struct Placed {
  Eigen::Index before = 0;
  Eigen::Matrix3d R_WV = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_WV = Eigen::Vector3d::Zero();

  Placed(const motion::Motion& clip, const sensors::Scene& scene)
      : before(scene.motion.frames() - clip.frames()) {
    body::Kinematics in_file(clip.skeleton), in_scene(scene.motion.skeleton);
    body::ComputeKinematics(clip.skeleton, clip.q.col(0), in_file);
    body::ComputeKinematics(scene.motion.skeleton, scene.motion.q.col(before), in_scene);
    R_WV = in_scene.R_WJ[0] * in_file.R_WJ[0].transpose();
    p_WV = in_scene.p_WJ[0] - R_WV * in_file.p_WJ[0];
  }
};

/// How far a point of the ground is from the line between the middles of heel and ball.
double Beside(const sensors::BodyCourse& course, std::size_t foot, Eigen::Index column,
              const Eigen::Vector2d& p) {
  const auto& sole = course.sole_m[foot];
  const Eigen::Vector3d heel = 0.5 * (sole[0].col(column) + sole[1].col(column));
  const Eigen::Vector3d ball = 0.5 * (sole[2].col(column) + sole[3].col(column));
  const Eigen::Vector3d along = ball - heel, at(p.x(), p.y(), 0);
  const double share =
      std::clamp((at - heel).dot(along) / std::max(along.squaredNorm(), 1e-9), 0.0, 1.0);
  return (at - heel - share * along).norm();
}

/// Calls `use` with a sample, the next one and the share of the next, at points spread evenly over
/// `span_s` around a time; returns their number.
template <typename Use>
int Sample(double time_s, double span_s, double rate_hz, Eigen::Index count, const Use& use) {
  const int points = std::max(1, static_cast<int>(std::ceil(span_s * rate_hz)));
  for (int i = 0; i < points; ++i) {
    const double off_s = span_s * ((i + 0.5) / points - 0.5);
    const double at = std::clamp((time_s + off_s) * rate_hz, 0.0, static_cast<double>(count - 1));
    const auto low = static_cast<Eigen::Index>(at);
    use(low, std::min(low + 1, count - 1), at - static_cast<double>(low));
  }
  return points;
}

/// One plate's part, added to what the feet feel.
class PlateFeeler {
 public:
  PlateFeeler(const motion::Motion& clip, const sensors::Scene& scene,
              const motion::GroundForces& forces)
      : clip_(clip), scene_(scene), forces_(forces), placed_(clip, scene) {}

  PlateUse Add(const motion::PlateForces& plate, Eigen::Index first, FeltForces& felt) const {
    PlateUse use;
    use.plate = plate.name;
    double load_sum = 0, beside_sum = 0;
    const Eigen::Index count = felt.load_n[0].size();
    for (Eigen::Index begin = 0; begin < count;) {
      if (!(plate.force_W(2, first + begin) > kLoadedN)) {
        ++begin;
        continue;
      }
      Eigen::Index end = begin;
      std::array<double, kFeet> beside{};
      double load = 0;
      for (; end < count && plate.force_W(2, first + end) > kLoadedN; ++end) {
        const double force_n = plate.force_W(2, first + end);
        load += force_n;
        for (std::size_t f = 0; f < kFeet; ++f) {
          beside[f] += force_n * Beside(scene_.course, f, Column(end), CopOf(plate, first + end));
        }
      }
      const std::size_t foot = beside[1] < beside[0] ? 1 : 0;
      for (Eigen::Index i = begin; i < end; ++i) {
        const double force_n = plate.force_W(2, first + i);
        felt.load_n[foot](i) += force_n;
        felt.moment_nm[foot].col(i) += force_n * CopOf(plate, first + i);
        felt.shear_n.col(i) += (placed_.R_WV * plate.force_W.col(first + i)).head<2>();
      }
      use.loaded_s[foot] += static_cast<double>(end - begin) / forces_.rate_hz;
      load_sum += load;
      beside_sum += beside[foot];
      begin = end;
    }
    use.beside_m = load_sum > 0 ? beside_sum / load_sum : 0;
    return use;
  }

 private:
  Eigen::Vector2d CopOf(const motion::PlateForces& plate, Eigen::Index sample) const {
    return (placed_.R_WV * plate.cop_W.col(sample) + placed_.p_WV).head<2>();
  }
  Eigen::Index Column(Eigen::Index sample) const {
    const double time_s = static_cast<double>(sample) / forces_.rate_hz;
    return std::min(placed_.before + static_cast<Eigen::Index>(std::lround(time_s * clip_.rate_hz)),
                    scene_.motion.frames() - 1);
  }

  const motion::Motion& clip_;
  const sensors::Scene& scene_;
  const motion::GroundForces& forces_;
  Placed placed_;
};

}  // namespace

sensors::FootForce FeltForces::Mean(std::size_t foot, double time_s, double span_s) const {
  const Eigen::VectorXd& loads = load_n[foot];
  sensors::FootForce force;
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  const int points = Sample(
      time_s, span_s, rate_hz, loads.size(), [&](Eigen::Index low, Eigen::Index high, double part) {
        force.load_n += (1 - part) * loads(low) + part * loads(high);
        moment += (1 - part) * moment_nm[foot].col(low) + part * moment_nm[foot].col(high);
      });
  force.load_n /= points;
  if (force.load_n > 0) {
    force.cop_m = moment / points / force.load_n;
  } else {
    force.cop_m.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return force;
}

Eigen::Vector2d FeltForces::MeanShear(double time_s, double span_s) const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  const int points = Sample(time_s, span_s, rate_hz, shear_n.cols(),
                            [&](Eigen::Index low, Eigen::Index high, double part) {
                              sum += (1 - part) * shear_n.col(low) + part * shear_n.col(high);
                            });
  return sum / points;
}

FeltForces FeelPlates(const motion::Motion& clip, const sensors::Scene& scene,
                      const motion::GroundForces& forces) {
  FeltForces felt;
  felt.rate_hz = forces.rate_hz;
  const Eigen::Index all = forces.plates.front().force_W.cols();
  const auto first = std::clamp<Eigen::Index>(
      static_cast<Eigen::Index>(std::lround((clip.start_s - forces.start_s) * forces.rate_hz)), 0,
      all - 1);
  const double span_s = static_cast<double>(clip.frames() - 1) / clip.rate_hz;
  const Eigen::Index count =
      std::min(static_cast<Eigen::Index>(std::lround(span_s * forces.rate_hz)) + 1, all - first);
  for (std::size_t f = 0; f < kFeet; ++f) {
    felt.load_n[f] = Eigen::VectorXd::Zero(count);
    felt.moment_nm[f] = Eigen::Matrix2Xd::Zero(2, count);
  }
  felt.shear_n = Eigen::Matrix2Xd::Zero(2, count);
  const PlateFeeler feeler(clip, scene, forces);
  for (const motion::PlateForces& plate : forces.plates) {
    felt.plates.push_back(feeler.Add(plate, first, felt));
  }
  return felt;
}

namespace {

constexpr double kLeastSupportedS = 0.5;
/// The first frames of a clip have the forces of leaving the T-pose in them: the low-pass of the
/// motion spreads them so far.
constexpr double kRunInS = 0.15;
constexpr double kMissingShare = 0.25;  // Part of the weight: beyond inverse dynamics' errors.
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

/// Forces on the boards at one time: simulated in the T-pose, measured in the clip. While the
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

namespace {

constexpr double kLeastS = 5;
constexpr double kMostMps = 0.3;  // Fastest COM that counts as at rest.

}  // namespace

Eigen::Matrix3Xd ComByPlates(const PoseRun& run, const FeltForces& felt, double begin_s) {
  const std::size_t first = run.judged_from;
  const auto frames = static_cast<Eigen::Index>(run.frames.size() - first);
  const auto speed_mps = [&](std::size_t i) {
    return (run.frames[i + 1].com_m - run.frames[i].com_m).norm() * run.rate_hz;
  };
  if (static_cast<double>(frames) < kLeastS * run.rate_hz || speed_mps(first) > kMostMps ||
      speed_mps(run.frames.size() - 2) > kMostMps) {
    return {};
  }
  ForceCourse course{run.rate_hz, Eigen::Matrix3Xd::Zero(3, frames),
                     Eigen::Matrix2Xd::Zero(2, frames)};
  Eigen::VectorXd height_m(frames);
  for (Eigen::Index i = 0; i < frames; ++i) {
    const std::size_t frame = first + static_cast<std::size_t>(i);
    const double clip_s = static_cast<double>(frame) / run.rate_hz - begin_s;
    Eigen::Vector2d moment_nm = Eigen::Vector2d::Zero();
    double load_n = 0;
    for (std::size_t f = 0; f < momentum::kFeet; ++f) {
      const virtual_sensors::FootForce foot = felt.Mean(f, clip_s, 1 / run.rate_hz);
      if (!foot.cop_m.allFinite()) continue;
      load_n += foot.load_n;
      moment_nm += foot.load_n * foot.cop_m;
    }
    course.force_n.col(i) << felt.MeanShear(clip_s, 1 / run.rate_hz), load_n;
    if (load_n > 0) course.cop_m.col(i) = moment_nm / load_n;
    height_m(i) = run.frames[frame].com_m.z();
  }
  return ComByForce(course, height_m);
}

namespace {

/// From 0 on, by trapezoids.
Eigen::VectorXd Integrated(const Eigen::VectorXd& rate, double step_s) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(rate.size());
  for (Eigen::Index i = 1; i < rate.size(); ++i) {
    sum(i) = sum(i - 1) + 0.5 * step_s * (rate(i - 1) + rate(i));
  }
  return sum;
}

Eigen::VectorXd IntegratedTwice(const Eigen::VectorXd& rate, double step_s) {
  return Integrated(Integrated(rate, step_s), step_s);
}

Eigen::VectorXd Times(Eigen::Index frames, double step_s) {
  return Eigen::VectorXd::LinSpaced(frames, 0, step_s * static_cast<double>(frames - 1));
}

struct Vertical {
  double mass_kg = 0;
  Eigen::VectorXd height_m;
};

Vertical VerticalPath(const ForceCourse& course, const Eigen::VectorXd& height_m) {
  const Eigen::Index frames = height_m.size();
  const double step_s = 1 / course.rate_hz;
  const Eigen::VectorXd t_s = Times(frames, step_s);
  const Eigen::VectorXd fall_m = -0.5 * kStandardGravityMps2 * t_s.cwiseAbs2();
  Eigen::MatrixX3d terms(frames, 3);  // For height, velocity and inverse mass.
  terms << Eigen::VectorXd::Ones(frames), t_s, IntegratedTwice(course.force_n.row(2), step_s);
  const Eigen::Vector3d constants = terms.colPivHouseholderQr().solve(height_m - fall_m);
  return {1 / constants(2), terms * constants + fall_m};
}

/// Along one axis of the ground. `lever_s2`: z / (g + z'').
Eigen::VectorXd LevelPath(const Eigen::VectorXd& acceleration_mps2, const Eigen::VectorXd& cop_m,
                          const Eigen::VectorXd& lever_s2, const Eigen::VectorXd& load_n,
                          double step_s) {
  const Eigen::Index frames = cop_m.size();
  const Eigen::VectorXd t_s = Times(frames, step_s);
  Eigen::MatrixX3d terms(frames, 3);  // For place, velocity and constant acceleration.
  terms << Eigen::VectorXd::Ones(frames), t_s, 0.5 * t_s.cwiseAbs2();
  const Eigen::VectorXd moved_m = IntegratedTwice(acceleration_mps2, step_s);
  Eigen::MatrixX3d of_cop = terms;
  of_cop.col(2) -= lever_s2;
  const Eigen::VectorXd rest_m = cop_m - moved_m + lever_s2.cwiseProduct(acceleration_mps2);
  const Eigen::Vector3d constants =
      (load_n.asDiagonal() * of_cop).colPivHouseholderQr().solve(load_n.asDiagonal() * rest_m);
  return moved_m + terms * constants;
}

}  // namespace

Eigen::Matrix3Xd ComByForce(const ForceCourse& course, const Eigen::VectorXd& height_m) {
  const Eigen::Index frames = course.force_n.cols();
  FOOTING_CHECK(course.rate_hz > 0 && course.cop_m.cols() == frames && height_m.size() == frames);
  const Vertical up = VerticalPath(course, height_m);
  const Eigen::VectorXd load_n = course.force_n.row(2).cwiseMax(0);
  // z / (g + z'') is z m / F. In the air the load weighs the row with 0.
  const Eigen::VectorXd lever_s2 = load_n.binaryExpr(
      up.height_m,
      [&up](double load, double height) { return load > 0 ? height * up.mass_kg / load : 0; });
  Eigen::Matrix3Xd com_m(3, frames);
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    com_m.row(axis) = LevelPath(course.force_n.row(axis) / up.mass_kg, course.cop_m.row(axis),
                                lever_s2, load_n, 1 / course.rate_hz);
  }
  com_m.row(2) = up.height_m;
  return com_m;
}

}  // namespace footing::pose_run
