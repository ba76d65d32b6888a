#include "daemon/offline/eval/figures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>

#include "common/body/kinematics.h"
#include "common/base/units.h"
#include "daemon/offline/eval/pose_trial.h"
#include "daemon/offline/eval/write_text.h"
#include "daemon/offline/analysis/line_plot.h"
#include "daemon/offline/analysis/stick_plot.h"
#include "daemon/offline/pose_run/crouch.h"

namespace footing::eval {
namespace {

using body::Landmark;
using reconstruction::Mode;

constexpr double kWindowS = 12;

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
  const auto length = std::min(frames, static_cast<std::size_t>(kWindowS * show.run.rate_hz));
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
  // Of the trunk: left from shoulder to shoulder, up from the hips to the neck.
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
