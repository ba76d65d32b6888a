#include "tests/offline/learning/made_take.h"

#include <algorithm>
#include <utility>

#include "common/body/kinematics.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/devices/noise.h"
#include "common/virtual/devices/scene.h"
#include "common/virtual/people/perform.h"
#include "common/virtual/people/script.h"
#include "daemon/offline/learning/own_take.h"

namespace footing::learning {
namespace {

namespace sensors = virtual_sensors;

constexpr double kRateHz = 100;
constexpr double kGapM = 0.02;

// A stomp: the weight is on the left foot, the right one goes up slowly and down fast.
constexpr const char* kScript = R"({"sway_mm": 2, "keys": [
  {"seconds": 6},
  {"seconds": 1.2, "both_raise_deg": -75, "both_elbow_deg": 10},
  {"seconds": 1, "weight": 1},
  {"seconds": 0.6, "right_lift_m": 0.3}, {"seconds": 0.2, "right_lift_m": 0}, {"seconds": 0.4},
  {"seconds": 0.6, "right_lift_m": 0.3}, {"seconds": 0.2, "right_lift_m": 0}, {"seconds": 1.1},
  {"seconds": 0.6, "right_lift_m": 0.3}, {"seconds": 0.2, "right_lift_m": 0}, {"seconds": 0.5},
  {"seconds": 1, "weight": 0},
  {"repeat": 2, "keys": [
    {"seconds": 0.9, "crouch_m": 0.25, "bow_deg": 30, "both_front_deg": 60},
    {"seconds": 0.9, "crouch_m": 0, "bow_deg": 0, "both_front_deg": 0}]},
  {"seconds": 1, "bend_deg": 15, "weight": 0.6},
  {"seconds": 1, "bend_deg": -15, "weight": -0.6},
  {"seconds": 1, "bend_deg": 0, "weight": 0, "left_raise_deg": 20},
  {"seconds": 0.9, "crouch_m": 0.2, "twist_deg": 20},
  {"seconds": 0.9, "crouch_m": 0, "twist_deg": 0}]})";

constexpr const char* kQuietScript = R"({"sway_mm": 2, "keys": [
  {"seconds": 6}, {"seconds": 1, "crouch_m": 0.2}, {"seconds": 1, "crouch_m": 0},
  {"seconds": 1, "weight": 0.6}, {"seconds": 1, "weight": 0}]})";

sensors::Scene Perform(bool stomps) {
  const auto script = choreography::ParseScript(stomps ? kScript : kQuietScript, "made").value();
  const auto body = choreography::Performer(1.72, kMadeMassKg).value();
  sensors::SceneOptions options;
  options.t_pose = false;
  body::PersonParameters person;
  person.mass_kg = kMadeMassKg;
  person.height_m = 1.72;
  auto scene = sensors::MakeScene(choreography::Perform(script, body, kRateHz).motion, person,
                                  options, "made")
                   .value();
  const Eigen::Vector2d start =
      0.5 *
      (sensors::SoleMiddle(scene.course, 0, 0) + sensors::SoleMiddle(scene.course, 1, 0)).head<2>();
  sensors::Shift(-start, scene);
  return scene;
}

void RecordBoards(const sensors::Scene& scene, const MadeTakeSettings& settings, double end_s,
                  RecordedSession& session) {
  const auto boards = sensors::OneFootEach(kGapM);
  const auto feet = sensors::ShareThroughout(scene);
  noise::Random random(settings.seed);
  for (std::size_t side = 0; side < 2; ++side) {
    session.cells_W_m[side] = sensors::SensorPlaces(boards[side]);
    sensors::CellErrors cells({.noise_kg = 0.05, .seed = 2 * settings.seed + side});
    double last_s = -1;
    for (double t_s = 0; t_s < end_s; t_s += random.Uniform(0.008, 0.014)) {
      const double motion_s = (t_s - settings.offset_s) / (1 + settings.drift);
      const auto frame = static_cast<std::size_t>(
          std::clamp(motion_s * kRateHz + 0.5, 0.0, static_cast<double>(feet.size() - 1)));
      const auto load = sensors::LoadBoard(boards[side], feet[frame][side]);
      last_s = std::max(last_s + 1e-4, t_s + 0.0015 * random.Normal());
      session.boards[side].push_back({last_s, cells.Advance(load.corners_n, 0.01)});
    }
  }
}

void RecordHands(const sensors::Scene& scene, const MadeTakeSettings& settings, double end_s,
                 RecordedSession& session) {
  body::Kinematics at(scene.body.skeleton);
  for (double t_s = 0; t_s < end_s; t_s += 0.01) {
    const double motion_s = (t_s - settings.offset_s) / (1 + settings.drift);
    const auto frame = static_cast<Eigen::Index>(
        std::clamp(motion_s * kRateHz + 0.5, 0.0, static_cast<double>(scene.motion.frames() - 1)));
    body::ComputeKinematics(scene.body.skeleton, scene.motion.q.col(frame), at);
    for (int side = 0; side < 2; ++side) {
      const body::Point fist = body::Fist(scene.body, side);
      const auto joint = static_cast<std::size_t>(fist.joint);
      session.hands[static_cast<std::size_t>(side)].push_back(
          {t_s, body::Place(fist, at.R_WJ[joint], at.p_WJ[joint]),
           Eigen::Vector3d::Constant(0.01)});
    }
  }
}

}  // namespace

MadeTake MakeTake(const MadeTakeSettings& settings) {
  const sensors::Scene scene = Perform(settings.stomps);
  MadeTake take;
  take.body = scene.body;
  take.motion = Placed(scene.motion, {.yaw_rad = settings.yaw_rad, .shift_m = {2, -1}});
  const double end_s = settings.offset_s + scene.motion.duration_s() + 0.5;
  take.session.name = "made.mcap";
  take.session.duration_s = end_s - 0.03;
  RecordBoards(scene, settings, end_s, take.session);
  if (settings.hands) RecordHands(scene, settings, end_s, take.session);
  return take;
}

}  // namespace footing::learning
