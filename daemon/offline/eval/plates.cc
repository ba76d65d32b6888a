#include "daemon/offline/eval/plates.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/offline/eval/offline.h"
#include "daemon/offline/analysis/contact_score.h"
#include "daemon/simulation/reconstruction/feet.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;

// Boards without contact for longer than a flight lasts have nobody on them.
constexpr double kMostFlightS = 1;

/// The fields of a trial that measured and simulated forces are compared by.
constexpr const char* kCompared[] = {"mpjpe_cm",
                                     "mpjpe_p95_cm",
                                     "mpjpe_root_relative_cm",
                                     "com_vertical_rms_cm",
                                     "com_horizontal_rms_cm",
                                     "com_forward_rms_cm",
                                     "com_lateral_rms_cm",
                                     "com_forward_bias_cm",
                                     "com_forward_sd_cm",
                                     "foot_position_rms_cm",
                                     "contact_f1",
                                     "nees"};

constexpr const char* kOfCom[] = {"com_vertical_rms_cm", "loads_com_vertical_rms_cm",
                                  "com_forward_rms_cm",  "com_forward_bias_cm",
                                  "com_forward_sd_cm",   "com_lateral_rms_cm"};

ordered_json FeetJson(const pose_run::PlateUse& use) {
  return {{"plate", use.plate},
          {"left_s", use.loaded_s[0]},
          {"right_s", use.loaded_s[1]},
          {"beside_cm", 100 * use.beside_m}};
}

/// The fields that compare the COM with that of the plates' own force, and how far the markers' COM
/// is from it, in cm along x, y and z.
Result<ordered_json> ByForce(const pose_run::PlateRun& plates, const reconstruction::Models& models,
                             const reconstruction::Options& options, const Oracle& oracle) {
  pose_run::PoseRun run = plates.measured;
  Eigen::Vector3d square_m2 = Eigen::Vector3d::Zero(), sum_m = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < plates.com_by_force_m.cols(); ++i) {
    Eigen::Vector3d& com_m = run.frames[run.judged_from + static_cast<std::size_t>(i)].com_m;
    const Eigen::Vector3d off_m = com_m - plates.com_by_force_m.col(i);
    square_m2 += off_m.cwiseAbs2();
    sum_m += off_m;
    com_m = plates.com_by_force_m.col(i);
  }
  const auto trial = RunPoseTrial(run, models, options, oracle);
  if (!trial) return trial.error();
  ordered_json json;
  for (const char* field : kOfCom) json[field] = trial->at(field);
  const auto frames = static_cast<double>(plates.com_by_force_m.cols());
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    json["markers_rms_cm"].push_back(100 * std::sqrt(square_m2(axis) / frames));
    json["markers_bias_cm"].push_back(100 * sum_m(axis) / frames);
  }
  return json;
}

/// For how long the boards are empty at most, from a frame on.
double EmptyS(const pose_run::PoseRun& run, std::size_t from) {
  double longest_s = 0, empty_s = 0;
  for (std::size_t i = from; i < run.frames.size(); ++i) {
    const momentum::Pressure pressure = momentum::PressureOf(run.frames[i].inputs.loads, kContactN);
    empty_s = pressure.total_n < kContactN ? empty_s + 1 / run.rate_hz : 0;
    longest_s = std::max(longest_s, empty_s);
  }
  return longest_s;
}

/// The centre of mass by the offline smoothers, from the cells alone.
Result<ordered_json> Offline(const pose_run::PoseRun& run) {
  MomentumScene scene;
  scene.rate_hz = run.rate_hz;
  scene.subject = reconstruction::SubjectOf(run.body);
  momentum::TPoseCalibration calibration;
  std::size_t start = 0;
  for (const pose_run::Frame& frame : run.frames) {
    scene.frames.push_back({frame.inputs.loads, frame.com_m, frame.angular_momentum, {}});
    if (!calibration.complete()) {
      calibration.Advance(frame.inputs.loads, 1 / run.rate_hz);
      ++start;
    }
  }
  if (!calibration.complete() || start > run.judged_from) {
    return InvalidData("the T-pose never stood still on both boards: no calibration");
  }
  if (EmptyS(run, start) > kMostFlightS) {
    return ordered_json{
        {"left_out",
         "nobody is on the boards for a time, and the smoothers cannot follow the body there"}};
  }
  return OfflineJson(scene, calibration.result(), start, run.judged_from);
}

}  // namespace

Result<ordered_json> ScorePlates(const pose_run::PlateRun& plates,
                                 const reconstruction::Models& models,
                                 const reconstruction::Options& options, const Oracle& oracle) {
  const auto simulated = RunPoseTrial(plates.simulated, models, options, oracle);
  if (!simulated) return simulated.error();
  const pose_run::PlateReport& report = plates.report;
  ordered_json json = {{"begin_s", report.begin_s},
                       {"end_s", report.end_s},
                       {"carried_share", report.supported_share},
                       {"mass_kg", report.mass_kg}};
  const double weight_n = plates.measured.body.mass_kg * kStandardGravityMps2;
  json["force_rms_percent"] = 100 * report.force_rms_n / weight_n;
  json["force_own_mass_rms_percent"] = 100 * report.force_own_mass_rms_n / weight_n;
  json["cop_forward_bias_cm"] = 100 * report.cop_bias_m.x();
  json["cop_forward_rms_cm"] = 100 * report.cop_rms_m.x();
  json["cop_lateral_rms_cm"] = 100 * report.cop_rms_m.y();
  json["of_feet"] = ordered_json::array();
  for (const pose_run::PlateUse& use : report.plates) json["of_feet"].push_back(FeetJson(use));
  const auto offline = Offline(plates.measured);
  if (!offline) return offline.error();
  json["offline"] = *offline;
  if (plates.com_by_force_m.cols() > 0) {
    const auto by_force = ByForce(plates, models, options, oracle);
    if (!by_force) return by_force.error();
    json["by_force"] = *by_force;
  }
  json["warnings"] = report.warnings;
  for (const char* field : kCompared) json["simulated"][field] = simulated->at(field);
  return json;
}

}  // namespace footing::eval
