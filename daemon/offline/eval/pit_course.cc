#include "daemon/offline/eval/pit_course.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/base/units.h"

namespace footing::eval {
namespace {

constexpr double kRunUpMinM = 16;
constexpr double kRunUpMaxM = 20;
constexpr double kBehindPitM = 2000;
constexpr double kPitUprightS = 2;
/// The pilot keeps to the middle: heading by sideways distance, turned a little a step.
constexpr double kSteeringRadPerM = 0.1;
constexpr double kHeadingLimitRad = 0.1;
constexpr double kTurnLimitRad = 0.02;

double Steer(const engine::EngineOutput& output) {
  const double wanted_rad =
      std::clamp(-kSteeringRadPerM * output.p_WC_m.y(), -kHeadingLimitRad, kHeadingLimitRad);
  return std::clamp(wanted_rad - output.gait.heading_rad, -kTurnLimitRad, kTurnLimitRad);
}

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

biped::GaitCommand PitPilot::Command(const engine::EngineOutput& output) {
  biped::GaitCommand command = command_;
  command.turn_per_step_rad = Steer(output);
  if (next_ == course_.pits.size()) return command;
  const Pit& pit = course_.pits[next_];
  const double x_m = output.p_WC_m.x();
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

}  // namespace footing::eval
