#include "daemon/offline/pose_run/pose_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/body/kinematics.h"
#include "common/body/momentum.h"
#include "common/body/points.h"
#include "common/virtual/devices/random.h"
#include "common/virtual/devices/scene.h"
#include "daemon/offline/pose_run/held_hands.h"
#include "daemon/offline/pose_run/stage.h"
#include "daemon/simulation/momentum/estimate.h"
#include "daemon/simulation/reconstruction/skeleton.h"

namespace footing::pose_run {
namespace {

namespace sensors = virtual_sensors;

/// The calibration is over before the T-pose is.
constexpr double kWeighedS = momentum::TPoseCalibration::kSeconds + 0.2;

/// The boards, where they are and where they are configured to be.
struct Boards {
  std::array<sensors::BoardPlace, sensors::kFeet> real = sensors::SideBySide();
  std::array<sensors::BoardPlace, sensors::kFeet> configured;
  std::vector<sensors::CellErrors> cells;

  Boards(const sensors::Scene& scene, const Settings& settings) {
    for (std::size_t f = 0; f < sensors::kFeet; ++f) {
      // Each foot begins in its board's middle.
      real[f].middle_m = sensors::SoleMiddle(scene.course, f, 0).head<2>();
      configured[f] = real[f];
      configured[f].middle_m.y() += (f == 0 ? 0.5 : -0.5) * settings.gap_error_m;
      if (f == 1) configured[f].yaw_rad -= settings.yaw_error_rad;
      sensors::CellErrorConfig errors = settings.errors;
      errors.seed = 2 * settings.errors.seed + f;
      cells.emplace_back(errors);
    }
  }

  sensors::BoardLoad Load(std::size_t f, const sensors::FootForce& force,
                          const Settings& settings) const {
    sensors::BoardLoad load = sensors::LoadBoard(real[f], force, settings.limited);
    if (settings.floor && sensors::IsBeside(real[f], force)) load.corners_n = {};
    return load;
  }

  momentum::FootLoads Read(std::size_t f, const sensors::BoardLoad& load, double scale,
                           double step_s) {
    const auto read_n = cells[f].Advance(load.corners_n, step_s);
    const auto places = sensors::SensorPlaces(configured[f]);
    momentum::FootLoads foot;
    foot.valid = true;
    foot.count = places.size();
    for (std::size_t k = 0; k < places.size(); ++k) {
      foot.cells[k] = {{places[k].x(), places[k].y(), 0}, scale * read_n[k]};
    }
    return foot;
  }
};

}  // namespace

void MeasureHands(const body::Body& body, const body::Kinematics& at, double noise_m,
                  noise::Random& random,
                  std::array<reconstruction::HandInput, reconstruction::kHands>& hands) {
  for (int side = 0; side < 2; ++side) {
    reconstruction::HandInput& hand = hands[static_cast<std::size_t>(side)];
    hand.valid = true;
    hand.p_W_m = body::Place(body::Fist(body, side), at);
    for (double& value : hand.p_W_m) value += noise_m * random.Normal();
    hand.sd_m.setConstant(std::max(noise_m, 0.001));
  }
}

PoseRun WithoutExtras(PoseRun run) {
  for (Frame& frame : run.frames) {
    if (!reconstruction::IsSkeleton(frame.inputs.joints)) frame.inputs.joints = {};
    frame.inputs.belt = {};
  }
  return run;
}

FootForcesAt SimulatedForces(const sensors::Scene& scene) {
  return [&scene](double, Eigen::Index column) {
    return sensors::ShareBetweenFeet(scene.course, scene.reaction, column);
  };
}

PoseRun RunScene(const sensors::Scene& scene, const Settings& settings,
                 const FootForcesAt& forces_at) {
  PoseRun run;
  run.body = scene.body;
  run.rate_hz = settings.rate_hz;
  Boards boards(scene, settings);
  noise::Random random(settings.seed);
  std::optional<HeldHands> held;
  const bool strapped = settings.hand_device == HandDevice::kStraps;
  if (settings.hands && (strapped || settings.hand_device == HandDevice::kWiimote)) {
    held.emplace(scene, strapped ? kStrapped : kFists, settings);
    run.reading_s = held->step_s();
  }
  virtual_sensors::KinectOptions options = settings.kinect;
  options.hides = options.hides && settings.joints;
  KinectBody kinect(scene.body, settings.seed, 1 / settings.rate_hz, options);
  body::Kinematics at(scene.body.skeleton);
  const double step_s = 1 / settings.rate_hz;
  ExtraSensors extra(scene, settings.head, settings.belt, settings.seed, step_s);
  const auto aligned = static_cast<std::size_t>(kAlignedS * settings.rate_hz);
  const std::size_t count = FrameCount(scene, settings.rate_hz);
  std::size_t loaded = 0, outside = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double time_s = static_cast<double>(i) * step_s;
    const Eigen::Index column = ColumnAt(scene, time_s);
    const auto forces = forces_at(time_s, column);
    Frame frame;
    frame.inputs.loads.time_s = time_s;
    frame.q = scene.motion.q.col(column);
    frame.angular_momentum = scene.course.angular_momentum.col(column);
    body::ComputeKinematics(scene.body.skeleton, frame.q, at);
    frame.com_m = body::CentreOfMass(scene.body, at);
    const double scale = time_s < kWeighedS ? 1 + settings.mass_error : 1;
    for (std::size_t f = 0; f < sensors::kFeet; ++f) {
      const auto load = boards.Load(f, forces[f], settings);
      frame.inputs.loads.feet[f] = boards.Read(f, load, scale, step_s);
      frame.feet[f] = {forces[f].load_n, forces[f].cop_m,
                       body::Place(body::Ankle(scene.body, static_cast<int>(f)), at),
                       body::Place(body::Toe(scene.body, static_cast<int>(f)), at)};
      if (forces[f].load_n > kLoadedN) {
        ++loaded;
        outside += load.outside ? 1 : 0;
      }
    }
    if (held) {
      frame.readings = held->Until(column);
    } else if (settings.hands && settings.hand_device == HandDevice::kKinect) {
      kinect.Advance(at, settings.joints, frame.inputs);
      frame.kinect.assign(kinect.exposed().begin(), kinect.exposed().end());
      frame.kinect_crouches = kinect.crouches();
    } else if (settings.hands) {
      MeasureHands(scene.body, at, settings.hand_noise_m, random, frame.inputs.hands);
    }
    extra.Advance(at, column, time_s < kStandS, i == aligned, frame.inputs);
    run.frames.push_back(std::move(frame));
  }
  run.outside_share = loaded > 0 ? static_cast<double>(outside) / static_cast<double>(loaded) : 0;
  run.judged_from = static_cast<std::size_t>(std::lround(kStandS * settings.rate_hz));
  return run;
}

Result<PoseRun> RunPose(const motion::Motion& clip, const Settings& settings,
                        const std::string& origin) {
  const auto scene = Stage(clip, settings, origin);
  if (!scene) return scene.error();
  PoseRun run = RunScene(*scene, settings, SimulatedForces(*scene));
  run.clock_offset_s =
      clip.start_s - (scene->motion.duration_s() - clip.duration_s());  // But for a loop.
  return run;
}

}  // namespace footing::pose_run
