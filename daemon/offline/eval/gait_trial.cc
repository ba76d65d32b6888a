#include "daemon/offline/eval/gait_trial.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <numeric>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/plot/line_plot.h"
#include "daemon/offline/analysis/leg_gap.h"
#include "daemon/offline/eval/pose_trial.h"
#include "daemon/offline/eval/report.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/simulation/biped/ground.h"
#include "daemon/simulation/biped/model.h"
#include "daemon/simulation/biped/track.h"
#include "daemon/simulation/engine/state.h"
#include "daemon/simulation/gait_service/config.h"

namespace footing::eval {
namespace {

std::vector<std::string>& MoreGains() {
  static std::vector<std::string> paths;
  return paths;
}

std::string& Gaits() {
  static std::string gaits = "best";
  return gaits;
}

Result<engine::EngineTexts> ReadTexts(
    stream::UserInterface interface = stream::UserInterface::kWrist,
    const std::string& mapping_table = "") {
  return engine_files::ReadTexts({.interface = interface,
                                  .mapping_table = mapping_table,
                                  .gaits = Gaits(),
                                  .more_gains = MoreGains()});
}

}  // namespace

void UseGaits(const std::string& gaits) { Gaits() = gaits; }

void ReadGainsToo(std::vector<std::string> paths) { MoreGains() = std::move(paths); }

std::uint64_t TrialSeed(std::uint64_t seed, int trial) {
  return seed * 1000003u + static_cast<std::uint64_t>(trial);
}

Result<std::uint64_t> ParseSeed(const std::string& text) {
  if (text == "random") {
    const std::uint64_t seed = std::random_device{}();
    std::fprintf(stderr, "seed %llu\n", static_cast<unsigned long long>(seed));
    return seed;
  }
  std::uint64_t seed = 0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, seed);
  if (read.ec != std::errc() || read.ptr != end) {
    return UsageError("--seed " + text + ": must be a number, or random");
  }
  return seed;
}

Result<engine::GaitEngine> NewEngine(const terrain::Surface& surface) {
  Result<engine::EngineTexts> texts = ReadTexts();
  if (!texts) return texts.error();
  return engine::GaitEngine::Create(*texts, {.surface = surface});
}

Result<engine::GaitEngine> NewEngineOn(const std::string& track, const terrain::Surface& surface) {
  Result<engine::EngineTexts> texts = ReadTexts();
  if (!texts) return texts.error();
  texts->track = track;
  return engine::GaitEngine::Create(*texts, {.surface = surface});
}

Result<engine::GaitEngine> NewEngineOn(const std::string& track,
                                       const mapping::InterfaceOptions& interface,
                                       const std::string& mapping_table) {
  Result<engine::EngineTexts> texts = ReadTexts(interface.interface, mapping_table);
  if (!texts) return texts.error();
  texts->track = track;
  return engine::GaitEngine::Create(*texts, {.interface = interface});
}

Result<physics::World> NewWorld(const std::optional<std::string>& track_text,
                                const terrain::Surface& surface) {
  Result<engine::EngineTexts> texts = ReadTexts();
  if (!texts) return texts.error();
  Result<biped::BipedParameters> biped = biped::ParseBiped(texts->biped, engine::kBipedFile);
  if (!biped) return biped.error();
  Result<stream::Track> track =
      terrain::ParseTrack(track_text.value_or(texts->track), engine::kPlainTrackFile);
  if (!track) return track.error();
  const terrain::GroundText ground = terrain::GroundMjcf(*track);
  return physics::World::FromMjcf(
      biped::WriteMjcf(biped::On(*biped, surface), ground.mjcf, {}, engine::EngineConfig{}.step_s),
      biped::Names());
}

void Walker::Command(const biped::GaitCommand& command) {
  inputs_.direct = true;
  inputs_.direct_command = command;
}

void Walker::Push(double impulse_ns, double direction_rad) {
  Push(impulse_ns, direction_rad, inputs_.push_number + 1);
}

void Walker::Push(double impulse_ns, double direction_rad, std::uint64_t number) {
  inputs_.push_number = number;
  inputs_.push_impulse_W_ns =
      impulse_ns * Eigen::Vector2d(std::cos(direction_rad), std::sin(direction_rad));
}

void Walker::Tow(double force_n, double direction_rad) {
  inputs_.tow_W_n = force_n * Eigen::Vector2d(std::cos(direction_rad), std::sin(direction_rad));
}

const engine::EngineOutput& Walker::Advance() {
  engine_.Advance(inputs_);
  output_ = &engine_.Output();
  if (!fell()) leg_gap_min_m_ = std::min(leg_gap_min_m_, legs::LegGap(*output_));
  return *output_;
}

namespace {

constexpr double kRunUpMinM = 16;
constexpr double kRunUpMaxM = 20;
constexpr double kBehindPitM = 2000;
constexpr double kPitUprightS = 2;
/// The pilot keeps to the middle: heading by sideways distance, turned a little a step.
constexpr double kSteeringRadPerM = 0.1;
constexpr double kHeadingLimitRad = 0.1;
constexpr double kTurnLimitRad = 0.02;
/// In curves a step goes along the track's heading where its middle will be: so far ahead.
constexpr double kSteeringLeadS = 0.3;
constexpr double kCurveTurnLimitRad = DegreesToRadians(biped::kTurnPerStepMaxDeg);
constexpr double kCurveSegmentDeg = 5;
constexpr double kQuarterDeg = 90;

}  // namespace

PitCourse MakePitCourse(double width_m, double length_m, Random& random) {
  PitCourse course;
  nlohmann::json segments = nlohmann::json::array();
  for (double x_m = 0; x_m < length_m;) {
    const double run_up_m = random.Uniform(kRunUpMinM, kRunUpMaxM);
    segments.push_back({{"length_m", run_up_m}});
    segments.push_back({{"length_m", width_m}, {"pit", true}});
    x_m += run_up_m;
    course.pits.push_back({x_m, x_m + width_m});
    x_m += width_m;
  }
  segments.push_back({{"length_m", kBehindPitM}});
  course.track = nlohmann::json{{"version", 1}, {"name", "pits"}, {"segments", segments}}.dump();
  return course;
}

PitCourse MakeCurvedPitCourse(double width_m, double length_m, double radius_m, Random& random) {
  const double piece_m = radius_m * DegreesToRadians(kCurveSegmentDeg);
  const double first_m = random.Uniform(kRunUpMinM, kRunUpMaxM);
  nlohmann::json segments = nlohmann::json::array({{{"length_m", first_m}}});
  double side = random.Uniform(0, 1) < 0.5 ? 1 : -1, turned_deg = 0;
  PitCourse course;
  for (double along_m = first_m; along_m < length_m;) {
    const double pit_m = along_m + random.Uniform(kRunUpMinM, kRunUpMaxM);
    while (along_m < pit_m) {
      if (turned_deg >= kQuarterDeg) {
        side = -side;
        turned_deg = 0;
      }
      const double piece = std::min(1.0, (pit_m - along_m) / piece_m);
      const double least_m = 0.01;
      const double piece_length_m = std::max(least_m, piece * piece_m);
      segments.push_back(
          {{"length_m", piece_length_m}, {"curve_deg", side * piece * kCurveSegmentDeg}});
      along_m += piece_length_m;
      turned_deg += piece * kCurveSegmentDeg;
    }
    segments.push_back({{"length_m", width_m}, {"pit", true}});
    course.pits.push_back({along_m, along_m + width_m});
    along_m += width_m;
  }
  segments.push_back({{"length_m", kBehindPitM}});
  course.track = nlohmann::json{{"version", 1}, {"name", "pits"}, {"segments", segments}}.dump();
  course.curves = std::move(terrain::ParseTrack(course.track, "the course")).value();
  return course;
}

double PitPilot::Steer(const engine::EngineOutput& output, const terrain::TrackPlace& place) const {
  const bool curves = !course_.curves.segments.empty();
  const double aside_m =
      curves ? std::copysign(place.distance_m, place.sideways_m) : output.p_WC_m.y();
  const double lead_m = kSteeringLeadS * command_.speed_mps;
  const double ahead_rad =
      curves ? terrain::CentreAhead(course_.curves, place, lead_m).heading_rad : 0;
  const double towards_rad =
      std::clamp(-kSteeringRadPerM * aside_m, -kHeadingLimitRad, kHeadingLimitRad);
  const double limit_rad = curves ? kCurveTurnLimitRad : kTurnLimitRad;
  return std::clamp(WrapAngle(ahead_rad + towards_rad - output.gait.heading_rad), -limit_rad,
                    limit_rad);
}

biped::GaitCommand PitPilot::Command(const engine::EngineOutput& output) {
  biped::GaitCommand command = command_;
  const bool curves = !course_.curves.segments.empty();
  const terrain::TrackPlace place =
      curves ? terrain::Locate(course_.curves, output.p_WC_m.head<2>()) : terrain::TrackPlace{};
  command.turn_per_step_rad = Steer(output, place);
  if (next_ == course_.pits.size()) return command;
  const Pit& pit = course_.pits[next_];
  const double x_m = curves ? terrain::LengthTo(course_.curves, place) : output.p_WC_m.x();
  over_ = over_ || x_m > pit.near_m;
  if (passed_s_ < 0 && x_m > pit.far_m) passed_s_ = output.time_s;
  if (command_.gait == stream::Gait::kRun && passed_s_ < 0) {
    jumping_ = jumping_ || pit.near_m - x_m < lead_s_ * command_.speed_mps;
  }
  const bool lands = output.contacts[0].touching || output.contacts[1].touching;
  if (passed_s_ >= 0 && lands) jumping_ = false;
  if (passed_s_ >= 0 && output.time_s - passed_s_ > kPitUprightS) {
    ++next_;
    ++crossed_;
    over_ = false;
    passed_s_ = -1;
  }
  if (jumping_) {
    command.gait = stream::Gait::kJump;
    command.height_m = height_m_;
  }
  return command;
}

double SensibleHeight(double width_m, double speed_mps) {
  constexpr double kSpareM = 0.15;
  constexpr double kSupportS = 0.2;
  const double flight_s = (width_m + 2 * kSpareM) / std::max(speed_mps, 0.5) - kSupportS;
  const double height_m = kStandardGravityMps2 * flight_s * std::max(0.0, flight_s) / 8;
  return std::clamp(height_m, 0.1, 0.5);
}

namespace {

constexpr double kPushSettleS = 4;  ///< And a second for each m/s.
constexpr double kPushKickNs = 2;
constexpr double kPushUprightS = 5;
constexpr double kLargestNs = 64;
constexpr double kResolutionNs = 1;
constexpr double kNoCycleS = 5;  ///< A cycle that takes longer is none.

/// States of one undisturbed cycle.
class Cycle {
 public:
  Cycle(engine::GaitEngine& engine, const biped::GaitCommand& command)
      : engine_(engine), command_(command) {}

  Result<void> Record(int phases, Random& random);
  bool Falls(int phase, double impulse_ns, double direction_rad);
  int phases() const { return static_cast<int>(states_.size()); }
  double leg_gap_min_m() const { return leg_gap_min_m_; }

 private:
  Walker NewWalker() {
    Walker walker(engine_);
    walker.Command(command_);
    return walker;
  }
  static void Run(Walker& walker, double until_s) {
    while (!walker.fell() && walker.Advance().time_s < until_s) {
    }
  }
  static double NextTouchdown(Walker& walker) {
    const engine::EngineOutput& output = walker.Advance();
    const std::uint64_t steps = output.gait.steps;
    const double latest_s = output.time_s + kNoCycleS;
    while (output.gait.steps == steps && output.time_s < latest_s && !walker.fell()) {
      walker.Advance();
    }
    return output.time_s;
  }

  engine::GaitEngine& engine_;
  biped::GaitCommand command_;
  std::vector<engine::EngineState> states_;
  std::uint64_t pushes_ = 1;
  double leg_gap_min_m_ = INFINITY;
};

Result<void> Cycle::Record(int phases, Random& random) {
  Walker walker = NewWalker();
  Run(walker, random.Uniform(1, 2));
  walker.Push(kPushKickNs, random.Uniform(-kPi, kPi));
  Run(walker, kPushSettleS + command_.speed_mps + random.Uniform(0, 1));
  const double start_s = NextTouchdown(walker);
  double end_s = NextTouchdown(walker);
  if (command_.gait != stream::Gait::kJump) end_s = NextTouchdown(walker);
  if (walker.fell()) return InvalidData("fell before any push: nothing to sweep");
  const double spacing_s = (end_s - start_s) / phases;
  const double first_s = end_s + random.Uniform(0, spacing_s);
  for (int i = 0; i < phases; ++i) {
    Run(walker, first_s + i * spacing_s);
    states_.push_back(engine_.Save());
  }
  return {};
}

bool Cycle::Falls(int phase, double impulse_ns, double direction_rad) {
  const engine::EngineState& state = states_[static_cast<std::size_t>(phase)];
  engine_.Restore(state);
  Walker walker = NewWalker();
  walker.Push(impulse_ns, direction_rad, ++pushes_);
  Run(walker, engine_.Output().time_s + kPushUprightS);
  leg_gap_min_m_ = std::min(leg_gap_min_m_, walker.leg_gap_min_m());
  return walker.fell();
}

double DirectionRad(int index, int directions) { return index * 2 * kPi / directions; }

bool AllSurvive(Cycle& cycle, int directions, double impulse_ns) {
  for (int d = 0; d < directions; ++d) {
    for (int p = 0; p < cycle.phases(); ++p) {
      if (cycle.Falls(p, impulse_ns, DirectionRad(d, directions))) return false;
    }
  }
  return true;
}

double LargestSurvived(Cycle& cycle, int directions, double survived_ns, double fell_ns) {
  while (fell_ns - survived_ns > kResolutionNs) {
    const double middle_ns = (survived_ns + fell_ns) / 2;
    (AllSurvive(cycle, directions, middle_ns) ? survived_ns : fell_ns) = middle_ns;
  }
  return survived_ns;
}

}  // namespace

int PushSweepResult::all_falls() const { return std::accumulate(falls.begin(), falls.end(), 0); }

Result<void> RunPushSweep(const PushSweep& sweep, std::uint64_t seed, PushSweepResult& result) {
  Result<engine::GaitEngine> engine = NewEngine(sweep.surface);
  if (!engine) return engine.error();
  Random random(seed);
  Cycle cycle(*engine, sweep.command);
  if (auto recorded = cycle.Record(sweep.phases, random); !recorded) return recorded.error();

  const bool first = result.pushes == 0;
  if (first) result.falls.assign(static_cast<std::size_t>(sweep.directions), 0);
  int falls = 0;
  for (int d = 0; d < sweep.directions; ++d) {
    for (int p = 0; p < sweep.phases; ++p) {
      const bool fell = cycle.Falls(p, sweep.impulse_ns, DirectionRad(d, sweep.directions));
      result.falls[static_cast<std::size_t>(d)] += fell ? 1 : 0;
      falls += fell ? 1 : 0;
    }
  }
  result.pushes += sweep.directions * sweep.phases;
  result.leg_gap_min_m = std::min(result.leg_gap_min_m, cycle.leg_gap_min_m());
  const double largest_ns = falls == 0
                                ? LargestSurvived(cycle, sweep.directions, sweep.impulse_ns,
                                                  std::max(kLargestNs, sweep.impulse_ns))
                                : LargestSurvived(cycle, sweep.directions, 0, sweep.impulse_ns);
  result.largest_survived_ns =
      first ? largest_ns : std::min(result.largest_survived_ns, largest_ns);
  return {};
}

namespace {

using body::Landmark;
using reconstruction::Mode;

constexpr double kTrialWindowS = 12;

/// The output of one reconstruction for every evaluated frame.
struct ReconstructedMotion {
  std::string name;
  std::vector<Eigen::VectorXd> q;
  std::vector<Eigen::Vector3d> com_m;
};

struct Show {
  const pose_run::PoseRun& run;
  const reconstruction::Models& models;
  reconstruction::Options options;
  std::size_t start;

  std::size_t frames() const { return run.frames.size() - start; }
  const pose_run::Frame& frame(std::size_t i) const { return run.frames[start + i]; }
  double Time(std::size_t i) const { return static_cast<double>(i) / run.rate_hz; }
};

Result<ReconstructedMotion> Reconstruct(const Show& show, const std::string& name,
                                        const reconstruction::Options& options) {
  auto made = reconstruction::Reconstruction::Create(show.run.body, show.models, options);
  if (!made) return made.error();
  ReconstructedMotion motion{name, {}, {}};
  for (std::size_t i = 0; i < show.run.frames.size(); ++i) {
    const auto& output = made->Advance(show.run.frames[i].inputs);
    if (i < show.start) continue;
    motion.q.push_back(output.q);
    motion.com_m.push_back(output.com_W_m);
  }
  return motion;
}

struct Window {
  std::size_t first = 0, last = 0;  ///< Past the end.
};

/// The window in which the values' range is greatest.
Window Liveliest(const Show& show, const std::function<double(std::size_t)>& value) {
  const std::size_t frames = show.frames();
  const auto length = std::min(frames, static_cast<std::size_t>(kTrialWindowS * show.run.rate_hz));
  const std::size_t step = std::max<std::size_t>(1, length / 8);
  Window best{0, length};
  double widest = -1;
  for (std::size_t first = 0; first + length <= frames; first += step) {
    double least = value(first), most = least;
    for (std::size_t i = first; i < first + length; ++i) {
      least = std::min(least, value(i));
      most = std::max(most, value(i));
    }
    if (most - least > widest) {
      widest = most - least;
      best = {first, first + length};
    }
  }
  return best;
}

plot::Curve CurveOf(const Show& show, const Window& window, const std::string& name,
                    const std::function<double(std::size_t)>& value, bool reference) {
  plot::Curve curve{name, {}, reference};
  for (std::size_t i = window.first; i < window.last; ++i)
    curve.points.emplace_back(show.Time(i), value(i));
  return curve;
}

std::string ComPlot(const Show& show, const std::string& title, int axis,
                    const std::vector<ReconstructedMotion>& motions) {
  const auto truth = [&](std::size_t i) { return 100 * show.frame(i).com_m(axis); };
  const Window window = Liveliest(show, truth);
  std::vector<plot::Curve> curves{CurveOf(show, window, "motion capture", truth, true)};
  for (const ReconstructedMotion& one : motions) {
    curves.push_back(CurveOf(
        show, window, one.name, [&](std::size_t i) { return 100 * one.com_m[i](axis); }, false));
  }
  return plot::LinePlot(title, "time, s", "cm", curves, plot::Axes::kFitted);
}

/// Angles of an arm, degrees: the upper arm's in the chest's frame (up, forward, turn) and the
/// elbow's bend. Turn is the forearm's about the upper arm, from hanging straight ahead.
std::array<double, 4> ArmAngles(const body::Body& body, const Eigen::VectorXd& q, int side,
                                body::Kinematics& at) {
  body::ComputeKinematics(body.skeleton, q, at);
  const auto joint = [&](Landmark left) {
    return static_cast<std::size_t>(body.landmarks[side == 0 ? left : body::Mirrored(left)]);
  };
  const Eigen::Vector3d shoulder = at.p_WJ[joint(Landmark::kLeftShoulder)];
  const Eigen::Vector3d elbow = at.p_WJ[joint(Landmark::kLeftElbow)];
  const Eigen::Vector3d wrist = at.p_WJ[joint(Landmark::kLeftWrist)];
  // Axes of the trunk: left from shoulder to shoulder, up from the hips to the neck.
  const auto place = [&](Landmark landmark) {
    return at.p_WJ[static_cast<std::size_t>(body.landmarks[landmark])];
  };
  const Eigen::Vector3d hips = 0.5 * (place(Landmark::kLeftHip) + place(Landmark::kRightHip));
  const Eigen::Vector3d up = (place(Landmark::kNeck) - hips).normalized();
  Eigen::Vector3d left = place(Landmark::kLeftShoulder) - place(Landmark::kRightShoulder);
  left = (left - left.dot(up) * up).normalized();
  const Eigen::Vector3d ahead = left.cross(up);
  const Eigen::Vector3d out = side == 0 ? left : Eigen::Vector3d(-left);
  const Eigen::Vector3d arm = (elbow - shoulder).normalized(),
                        forearm = (wrist - elbow).normalized();
  const double bend = std::acos(std::clamp(arm.dot(forearm), -1.0, 1.0));
  const Eigen::Vector3d across = forearm - forearm.dot(arm) * arm;
  const Eigen::Vector3d zero = arm.cross(up).norm() > 1e-6 ? arm.cross(up).normalized() : left;
  const double turn = std::atan2(across.dot(arm.cross(zero)), across.dot(zero));
  return {RadiansToDegrees(std::asin(std::clamp(arm.dot(out), -1.0, 1.0))),
          RadiansToDegrees(std::asin(std::clamp(arm.dot(ahead), -1.0, 1.0))),
          RadiansToDegrees(turn), RadiansToDegrees(bend)};
}

std::array<std::string, 4> ArmPlots(const Show& show,
                                    const std::vector<ReconstructedMotion>& motions) {
  constexpr int kSide = 1;
  constexpr std::array kNames{"shoulder, outwards", "shoulder, forwards", "shoulder, turn",
                              "elbow, bend"};
  const body::Body& body = show.run.body;
  body::Kinematics at(body.skeleton);
  std::vector<std::array<double, 4>> truth(show.frames());
  for (std::size_t i = 0; i < truth.size(); ++i)
    truth[i] = ArmAngles(body, show.frame(i).q, kSide, at);
  for (std::size_t i = 1; i < truth.size(); ++i)
    truth[i][2] -= 360 * std::round((truth[i][2] - truth[i - 1][2]) / 360);
  const Window window = Liveliest(show, [&](std::size_t i) { return truth[i][1]; });
  std::array<std::string, 4> plots;
  for (std::size_t k = 0; k < plots.size(); ++k) {
    const auto true_angle = [&](std::size_t i) { return truth[i][k]; };
    std::vector<plot::Curve> curves{CurveOf(show, window, "motion capture", true_angle, true)};
    for (const ReconstructedMotion& one : motions) {
      const auto angle = [&](std::size_t i) {
        // A whole turn more is the same turn: the one nearest to the truth.
        const double raw = ArmAngles(body, one.q[i], kSide, at)[k];
        return raw - 360 * std::round((raw - truth[i][k]) / 360);
      };
      curves.push_back(CurveOf(show, window, one.name, angle, false));
    }
    plots[k] = plot::LinePlot(std::string("Right ") + kNames[k] + ", hands by their places",
                              "time, s", "degrees", curves, plot::Axes::kFitted);
  }
  return plots;
}

/// The bones seen from the front left: x to the right of the picture, partly.
plot::Sticks SticksOf(const body::Body& body, const Eigen::VectorXd& q) {
  const double yaw_rad = DegreesToRadians(35.0);
  body::Kinematics at(body.skeleton);
  body::ComputeKinematics(body.skeleton, q, at);
  const auto across = [&](const Eigen::Vector3d& p) {
    return std::cos(yaw_rad) * p.x() - std::sin(yaw_rad) * p.y();
  };
  plot::Sticks sticks;
  for (int joint = 1; joint < body.skeleton.size(); ++joint) {
    const Eigen::Vector3d& from =
        at.p_WJ[static_cast<std::size_t>(body.skeleton.joint(joint).parent)];
    const Eigen::Vector3d& to = at.p_WJ[static_cast<std::size_t>(joint)];
    sticks.push_back({across(from), from.z(), across(to), to.z()});
  }
  return sticks;
}

std::string Crouch(const Show& show, const pose_run::Crouch& crouch, const std::string& compared,
                   const std::vector<ReconstructedMotion>& motions) {
  const body::Body& body = show.run.body;
  const plot::Sticks truth = SticksOf(body, show.frame(crouch.frame - show.start).q);
  std::vector<plot::Panel> panels{{"motion capture", {}, truth}};
  for (const ReconstructedMotion& one : motions) {
    panels.push_back({one.name, truth, SticksOf(body, one.q[crouch.frame - show.start])});
  }
  const std::string bend =
      std::to_string(std::lround(RadiansToDegrees(crouch.bend_rad))) + " degrees";
  const std::string title = crouch.bend_rad < pose_run::kCrouchRad
                                ? "No crouch here: knees and hips bend by " + bend + " at most"
                                : "The deepest crouch, knees and hips bent by " + bend;
  return plot::StickPlot(title + ", " + compared, panels);
}

struct Runs {
  ReconstructedMotion best, paper, without_boards, best_without_angular, paper_without_angular;
};

Result<Runs> RunAll(const Show& show) {
  reconstruction::Options best = show.options;
  best.mode = Mode::kBest;
  best.lag_s = 0;
  reconstruction::Options paper = best;
  paper.mode = Mode::kPaper;
  reconstruction::Options unloaded = best;
  unloaded.use_momentum = unloaded.use_angular_momentum = false;
  const auto without_angular = [](reconstruction::Options options) {
    options.use_angular_momentum = false;
    return options;
  };
  Runs runs;
  const struct {
    ReconstructedMotion Runs::*motion;
    const char* name;
    reconstruction::Options options;
  } all[] = {{&Runs::best, "best mode", best},
             {&Runs::paper, "paper mode", paper},
             {&Runs::without_boards, "hands and feet only", unloaded},
             {&Runs::best_without_angular, "best, without L", without_angular(best)},
             {&Runs::paper_without_angular, "paper, without L", without_angular(paper)}};
  for (const auto& one : all) {
    auto motion = Reconstruct(show, one.name, one.options);
    if (!motion) return motion.error();
    runs.*one.motion = std::move(*motion);
  }
  return runs;
}

}  // namespace

Result<std::vector<std::string>> WriteFigures(const pose_run::PoseRun& run,
                                              const reconstruction::Models& models,
                                              const reconstruction::Options& options,
                                              const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return Failure("cannot make " + folder + ": " + error.message());
  const Show show{run, models, options, run.judged_from};
  auto runs = RunAll(show);
  if (!runs) return runs.error();
  const std::vector<ReconstructedMotion> modes{runs->best, runs->paper};
  const auto arm = ArmPlots(show, {runs->best, runs->paper_without_angular});
  const pose_run::Crouch crouch = pose_run::DeepestCrouch(run, show.start);
  const std::vector<std::pair<std::string, std::string>> files{
      {"figure5_vertical_com.svg", ComPlot(show, "Height of the COM", 2, modes)},
      {"figure5_forward_com.svg", ComPlot(show, "COM, forward", 0, modes)},
      {"figure5_lateral_com.svg", ComPlot(show, "COM, to the left", 1, modes)},
      {"figure6_shoulder_outwards.svg", arm[0]},
      {"figure6_shoulder_forwards.svg", arm[1]},
      {"figure6_shoulder_turn.svg", arm[2]},
      {"figure6_elbow.svg", arm[3]},
      {"figure7_crouch_boards.svg", Crouch(show, crouch, "with the boards' momentum and without",
                                           {runs->best, runs->without_boards})},
      {"figure8_crouch_angular_momentum.svg",
       Crouch(show, crouch, "with and without angular momentum",
              {runs->best, runs->best_without_angular, runs->paper, runs->paper_without_angular})}};
  std::vector<std::string> names;
  for (const auto& [name, text] : files) {
    if (auto written = WriteText(folder + "/" + name, text); !written) return written.error();
    names.push_back(name);
  }
  return names;
}

}  // namespace footing::eval
