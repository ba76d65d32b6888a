#include "daemon/offline/eval/arm.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/runtime/files.h"
#include "common/wire/model_file.h"
#include "daemon/offline/eval/pose_scene.h"
#include "daemon/offline/eval/report.h"
#include "daemon/simulation/pose/arm_model.h"
#include "daemon/simulation/pose/arm_tracker.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;

/// Axis for the kinematic prediction alone: a left forearm bends forwards.
const Eigen::Vector3d kElbowAxis_U = -Eigen::Vector3d::UnitZ();

/// A network's own estimates of both arms from the T-pose on.
struct NetworkScore {
  const arm_network::ArmNetwork& network;
  std::array<arm_network::ArmPose, arms::kArms> poses = {};
  ArmScore score = {};
};

class ArmTrial {
 public:
  ArmTrial(const pose_run::ArmRun& run, const std::optional<arms::ArmModel>& model,
           const std::vector<arm_network::ArmNetwork>& networks,
           const std::optional<pose_run::Places>& observed)
      : run_(run),
        tracker_(model),
        geometry_{arms::ArmGeometry(run.body, 0), arms::ArmGeometry(run.body, 1)},
        at_(run.body.skeleton) {
    for (const arms::ArmGeometry& geometry : geometry_) {
      if (observed) bounds_.emplace_back(geometry, *observed, run.rate_hz);
    }
    for (const arm_network::ArmNetwork& network : networks) networks_.push_back({network});
    if (model) mean_ = arms::Of(model->offset);
    body::ComputeKinematics(run.body.skeleton, run.frames.front().q, at_);
    for (std::size_t arm = 0; arm < arms::kArms; ++arm) {
      for (std::size_t place = 0; place < arms::kPlaces; ++place)
        rest_[arm][place] = SegmentAt(arm, place).transpose();
    }
  }

  ordered_json Run() {
    const double step_s = 1 / run_.rate_hz;
    const auto first = static_cast<std::size_t>(std::lround(pose_run::kStandS * run_.rate_hz));
    for (std::size_t i = 0; i < run_.frames.size(); ++i) {
      const pose_run::ArmFrame& frame = run_.frames[i];
      pose_run::Feed(frame.readings, run_.reading_s, tracker_);
      Count(frame.readings);
      if (i == run_.aligned) tracker_.Align();
      const auto& estimates = tracker_.Advance(step_s);
      if (i >= run_.aligned && tracker_.aligned()) AdvanceNetworks(step_s);
      if (i < first) continue;
      body::ComputeKinematics(run_.body.skeleton, frame.q, at_);
      for (std::size_t arm = 0; arm < arms::kArms; ++arm) Score(arm, estimates[arm]);
    }
    return Json(run_.frames.size() - first);
  }

 private:
  /// Rotation in W of the segment to which a device at that place is fixed.
  Eigen::Matrix3d SegmentAt(std::size_t arm, std::size_t place) const {
    const arms::ArmGeometry& geometry = geometry_[arm];
    const std::array joints{geometry.fist.joint, geometry.shoulder, geometry.elbow};
    return at_.R_WJ[static_cast<std::size_t>(joints[place])];
  }

  void Count(const pose_run::ArmReadings& readings) {
    for (std::size_t arm = 0; arm < arms::kArms; ++arm) {
      for (const auto& of_place : readings[arm]) {
        for (const arms::HandReading& reading : of_place) clipped_ += reading.clipped ? 1 : 0;
        readings_ += of_place.size();
      }
    }
  }

  void AdvanceNetworks(double step_s) {
    for (std::size_t arm = 0; arm < arms::kArms; ++arm) {
      const auto input = arm_network::MakeInput(arm, tracker_.hand(arm), tracker_.features());
      kinematic_pose_[arm] = arm_network::Predicted(kinematic_pose_[arm], kElbowAxis_U,
                                                    input.angular_velocity_W_radps, step_s);
      for (NetworkScore& one : networks_) {
        one.poses[arm] = one.network.Next(one.poses[arm], input, step_s);
      }
    }
  }

  void Score(std::size_t arm, const arms::ArmEstimate& estimate) {
    const arms::ArmGeometry& geometry = geometry_[arm];
    const arms::ArmDirections truth = geometry.Directions(at_);
    const Eigen::Vector3d hand_m =
        body::Place(geometry.fist, at_) - at_.p_WJ[static_cast<std::size_t>(geometry.shoulder)];
    estimate_.Add(geometry, estimate.directions, truth, hand_m);
    for (NetworkScore& one : networks_) {
      const auto own = arm_network::ToDirections(one.poses[arm], one.network.elbow_axis_U);
      one.score.Add(geometry, arm == 1 ? arms::Mirrored(own) : own, truth, hand_m);
    }
    const auto kinematic = arm_network::ToDirections(kinematic_pose_[arm], kElbowAxis_U);
    kinematic_.Add(geometry, arm == 1 ? arms::Mirrored(kinematic) : kinematic, truth, hand_m);
    still_.Add(geometry, arm == 1 ? arms::Mirrored(mean_) : mean_, truth, hand_m);
    ArmMoment moment{
        .turns_W = {}, .truth = truth, .error = Distance(geometry, estimate.directions, truth)};
    for (std::size_t place = 0; place < arms::kPlaces; ++place) {
      moment.turns_W[place] = SegmentAt(arm, place) * rest_[arm][place];
      const arms::HandState& state = tracker_.hand(arm, static_cast<arms::Place>(place));
      if (state.valid) turn_.Add(state.turn_W, moment.turns_W[place]);
    }
    if (!bounds_.empty()) bounds_[arm].Add(moment);
    nees_.Add(estimate, truth);
    finite_ = finite_ && arms::Stacked(estimate.directions).allFinite();
  }

  ordered_json Json(std::size_t frames) const {
    ordered_json json = {{"frames", frames}, {"rate_hz", run_.rate_hz}};
    json.update(estimate_.Json());
    json["attitude_error_deg"] = turn_.mean_deg();
    json["inclination_error_deg"] = turn_.inclination_deg();
    json["clipped_share"] = static_cast<double>(clipped_) / static_cast<double>(readings_);
    json["nees"] = nees_.mean();
    json["nees_quarters"] = nees_.Parts(4);
    json["finite"] = finite_;
    if (!bounds_.empty()) json["observability"] = ArmBound::Json(bounds_);
    json["baselines"]["mean_arm"] = still_.Json();
    if (tracker_.aligned()) json["baselines"]["kinematic"] = kinematic_.Json();
    for (const NetworkScore& one : networks_) {
      json["networks"][arm_network::KindName(one.network.kind)] = one.score.Json();
    }
    return json;
  }

  const pose_run::ArmRun& run_;
  arms::ArmTracker tracker_;
  std::array<arms::ArmGeometry, arms::kArms> geometry_;
  std::vector<ArmBound> bounds_;  ///< Bounds of each arm, or none.
  std::array<std::array<Eigen::Matrix3d, arms::kPlaces>, arms::kArms> rest_;
  body::Kinematics at_;
  arms::ArmDirections mean_;
  std::vector<NetworkScore> networks_;
  std::array<arm_network::ArmPose, arms::kArms> kinematic_pose_ = {};
  ArmScore estimate_, still_, kinematic_;
  TurnScore turn_;
  NeesScore nees_;
  std::size_t clipped_ = 0, readings_ = 0;
  bool finite_ = true;
};

}  // namespace

ordered_json RunArmTrial(const pose_run::ArmRun& run, const std::optional<arms::ArmModel>& model,
                         const std::vector<arm_network::ArmNetwork>& networks,
                         const std::optional<pose_run::Places>& observed) {
  return ArmTrial(run, model, networks, observed).Run();
}

namespace {

double RmsOfRange(const std::vector<double>& values, std::size_t from, std::size_t to) {
  double squares = 0;
  for (std::size_t i = from; i < to; ++i) squares += values[i] * values[i];
  return to > from ? std::sqrt(squares / static_cast<double>(to - from)) : 0;
}

}  // namespace

void ArmScore::Add(const arms::ArmGeometry& geometry, const arms::ArmDirections& estimate,
                   const arms::ArmDirections& truth, const Eigen::Vector3d& hand_m) {
  shoulder_.Add(RadiansToDegrees(arms::ShoulderError(estimate, truth)));
  elbow_.Add(RadiansToDegrees(arms::ElbowError(estimate, truth)));
  cm_.push_back(100 * (geometry.Hand(estimate) - hand_m).norm());
  hand_.Add(cm_.back());
}

nlohmann::ordered_json ArmScore::Json() const {
  const std::size_t half = cm_.size() / 2;
  return {{"shoulder_error_deg", shoulder_.mean()},
          {"elbow_error_deg", elbow_.mean()},
          {"hand_position_rms_cm", hand_.rms()},
          {"hand_position_p95_cm", hand_.Quantile(0.95)},
          {"hand_position_rms_halves_cm",
           {RmsOfRange(cm_, 0, half), RmsOfRange(cm_, half, cm_.size())}}};
}

void TurnScore::Add(const Eigen::Matrix3d& estimate, const Eigen::Matrix3d& truth) {
  const double cosine = ((estimate.transpose() * truth).trace() - 1) / 2;
  all_.Add(RadiansToDegrees(std::acos(std::clamp(cosine, -1.0, 1.0))));
  const double level = estimate.row(2).dot(truth.row(2));
  inclination_.Add(RadiansToDegrees(std::acos(std::clamp(level, -1.0, 1.0))));
}

void NeesScore::Add(const arms::ArmEstimate& estimate, const arms::ArmDirections& truth) {
  const auto squares = [](const Eigen::Vector3d& error, const Eigen::Vector3d& sd) {
    return error.cwiseQuotient(sd).squaredNorm();
  };
  nees_.push_back((squares(estimate.directions.upper - truth.upper, estimate.upper_sd) +
                   squares(estimate.directions.hinge - truth.hinge, estimate.hinge_sd) +
                   squares(estimate.directions.forearm - truth.forearm, estimate.forearm_sd)) /
                  arms::kDirections);
}

double NeesScore::mean() const {
  return std::accumulate(nees_.begin(), nees_.end(), 0.0) / static_cast<double>(nees_.size());
}

std::vector<double> NeesScore::Parts(std::size_t count) const {
  std::vector<double> means;
  for (std::size_t part = 0; part < count; ++part) {
    const auto at = [&](std::size_t k) {
      return nees_.begin() + static_cast<std::ptrdiff_t>(k * nees_.size() / count);
    };
    means.push_back(std::accumulate(at(part), at(part + 1), 0.0) /
                    static_cast<double>(at(part + 1) - at(part)));
  }
  return means;
}

namespace {

struct Flags {
  PoseSceneOptions scene;
  std::string model;
  std::vector<std::string> networks;
  bool same_person = false;
  std::vector<std::string> devices = {"fist"};
  double loop_minutes = 0;
};

Result<pose_run::Places> PlacesOf(const std::vector<std::string>& names) {
  constexpr std::array kNames{"fist", "upper_arm", "forearm"};  // By arms::Place.
  pose_run::Places places{};
  for (const std::string& name : names) {
    const auto found = std::find(kNames.begin(), kNames.end(), name);
    if (found == kNames.end())
      return UsageError("--devices " + name + " is unknown; must be of: fist, upper_arm, forearm");
    places[static_cast<std::size_t>(found - kNames.begin())] = true;
  }
  if (!places[0] && !(places[1] && places[2]))
    return UsageError("--devices: an arm needs the fist, or both upper_arm and forearm");
  return places;
}

Result<ordered_json> Evaluate(Flags flags) {
  flags.scene.settings.loop_s = 60 * flags.loop_minutes;
  const auto places = PlacesOf(flags.devices);
  if (!places) return places.error();
  if (!flags.networks.empty() && !(*places)[0])
    return UsageError("--network: a network follows the device in the fist; add it to --devices");
  std::optional<arms::ArmModel> model;  // Straps alone need none.
  if ((*places)[0]) {
    auto read = ReadArmModel(flags.model, flags.scene.motion, flags.same_person);
    if (!read) return read.error();
    model = *std::move(read);
  }
  std::vector<arm_network::ArmNetwork> networks;
  for (const std::string& path : flags.networks) {
    const auto read = ReadModel(path, flags.scene.motion, flags.same_person);
    if (!read) return read.error();
    auto network = arm_network::MakeArmNetwork(read->model, path);
    if (!network) return network.error();
    networks.push_back(std::move(network).value());
  }
  const auto run = MakeArmScene(flags.scene, *places);
  if (!run) return run.error();
  std::optional<pose_run::Places> observed;
  if (flags.loop_minutes == 0) observed = *places;
  return RunArmTrial(*run, model, networks, observed);
}

}  // namespace

void AddArmCommand(CLI::App& app, Shared& shared) {
  auto* command = app.add_subcommand(
      "arm",
      "Arm poses estimated from Wiimotes with MotionPlus on each arm, compared with the motion");
  const auto flags = std::make_shared<Flags>();
  AddMotionOptions(*command, flags->scene);
  command->add_option("--model", flags->model, "Arm model, *.fmodel (default: built in)");
  command->add_option("--network", flags->networks,
                      "Network to compare with, of footing-train arm --kind paper or residual; may "
                      "be repeated");
  command->add_flag("--same-person", flags->same_person,
                    "Accept models trained on other takes of the tested person");
  command
      ->add_option("--devices", flags->devices,
                   "Where each arm has a Wiimote: fist, upper_arm, forearm (default fist)")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_flag(
      "--perfect", flags->scene.settings.perfect_devices,
      "Devices and mounting without errors: what remains is what they cannot observe");
  command->add_option("--rate-hz", flags->scene.settings.rate_hz, "Frame rate, Hz")
      ->check(CLI::Range(30.0, 120.0));
  command->add_option("--seed", flags->scene.settings.seed, "Seed of the simulated device errors");
  command
      ->add_option(
          "--loop-minutes", flags->loop_minutes,
          "Total duration, min: the motion is played forwards and backwards until then (0: once)")
      ->check(CLI::Range(0.0, 60.0));
  command->callback(
      [flags, &shared] { shared.exit_code = PrintResult(Evaluate(*flags), shared.json); });
}

namespace {

// Attitudes of each device that count as alike, now and kBeforeS ago: with 10 degrees (0.17 rad)
// both times one frame in ten has a moment like it, with these one in two.
constexpr double kAlikeRad = 0.26, kAlikeBeforeRad = 0.7;
constexpr double kBeforeS = 0.3;
constexpr double kApartS = 2;  // Closer in time is the same moment.
constexpr ArmDistance kAims{8, 8, 6};

std::size_t Frames(double seconds, double rate_hz) {
  return static_cast<std::size_t>(std::lround(seconds * rate_hz));
}

double Squared(double x) { return x * x; }

}  // namespace

ArmDistance Distance(const arms::ArmGeometry& geometry, const arms::ArmDirections& a,
                     const arms::ArmDirections& b) {
  return {RadiansToDegrees(arms::ShoulderError(a, b)), RadiansToDegrees(arms::ElbowError(a, b)),
          100 * (geometry.Hand(a) - geometry.Hand(b)).norm()};
}

bool ArmBound::Alike(std::size_t a, std::size_t b, double most_rad) const {
  const double least_trace = 1 + 2 * std::cos(most_rad);
  for (std::size_t place = 0; place < arms::kPlaces; ++place) {
    if (!places_[place]) continue;
    const double trace = moments_[a].turns_W[place].cwiseProduct(moments_[b].turns_W[place]).sum();
    if (trace < least_trace) return false;
  }
  return true;
}

arms::ArmDirections ArmBound::Moved(const ArmMoment& other, const ArmMoment& now) const {
  const auto turn = [&](arms::Place nearest) {
    auto place = static_cast<std::size_t>(nearest);
    if (!places_[place]) place = static_cast<std::size_t>(arms::Place::kFist);
    return Eigen::Matrix3d(now.turns_W[place] * other.turns_W[place].transpose());
  };
  const Eigen::Matrix3d upper = turn(arms::Place::kUpperArm), forearm = turn(arms::Place::kForearm);
  return {upper * other.truth.upper, upper * other.truth.hinge, forearm * other.truth.forearm};
}

void ArmBound::AddFrame(std::size_t frame, Sums& sums) const {
  const std::size_t before = Frames(kBeforeS, rate_hz_), apart = Frames(kApartS, rate_hz_);
  ArmDistance sum;
  std::size_t count = 0;
  for (std::size_t other = before; other < moments_.size(); ++other) {
    if (other + apart > frame && other < frame + apart) continue;
    if (!Alike(frame, other, kAlikeRad) ||
        !Alike(frame - before, other - before, kAlikeBeforeRad)) {
      continue;
    }
    const ArmDistance off =
        Distance(geometry_, Moved(moments_[other], moments_[frame]), moments_[frame].truth);
    sum.shoulder_deg += off.shoulder_deg;
    sum.elbow_deg += off.elbow_deg;
    sum.hand_cm += Squared(off.hand_cm);
    ++count;
  }
  if (count == 0) return;
  const auto n = static_cast<double>(count);
  const ArmDistance least{sum.shoulder_deg / n / std::sqrt(2.0), sum.elbow_deg / n / std::sqrt(2.0),
                          std::sqrt(sum.hand_cm / n / 2)};
  const auto add = [](const ArmDistance& one, ArmDistance& all) {
    all.shoulder_deg += one.shoulder_deg;
    all.elbow_deg += one.elbow_deg;
    all.hand_cm += Squared(one.hand_cm);
  };
  ++sums.alike;
  add(least, sums.least);
  if (least.shoulder_deg > kAims.shoulder_deg || least.elbow_deg > kAims.elbow_deg ||
      least.hand_cm > kAims.hand_cm)
    return;
  ++sums.observable;
  add(moments_[frame].error, sums.error);
}

nlohmann::ordered_json ArmBound::Json(const std::vector<ArmBound>& arms) {
  Sums sums;
  std::size_t frames = 0;
  for (const ArmBound& arm : arms) {
    frames += arm.moments_.size();
    const std::size_t first = Frames(kBeforeS, arm.rate_hz_);
    for (std::size_t i = first; i < arm.moments_.size(); ++i) arm.AddFrame(i, sums);
  }
  const auto share = [](std::size_t part, std::size_t whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
  };
  const auto json = [](const ArmDistance& sum, std::size_t count) {
    const double n = count > 0 ? static_cast<double>(count) : 1;
    return nlohmann::ordered_json{{"shoulder_error_deg", sum.shoulder_deg / n},
                                  {"elbow_error_deg", sum.elbow_deg / n},
                                  {"hand_position_rms_cm", std::sqrt(sum.hand_cm / n)}};
  };
  nlohmann::ordered_json report = {{"alike_share", share(sums.alike, frames)}};
  report["least"] = json(sums.least, sums.alike);
  report["observable_share"] = share(sums.observable, sums.alike);
  report["in_observable"] = json(sums.error, sums.observable);
  return report;
}

}  // namespace footing::eval
