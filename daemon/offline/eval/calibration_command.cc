#include "daemon/offline/eval/calibration_command.h"

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/runtime/clock.h"
#include "daemon/offline/eval/calibration_trial.h"
#include "daemon/offline/eval/print_report.h"
#include "daemon/offline/eval/progress.h"

namespace footing::eval {
namespace {

constexpr double kPosePlacementSdM = 0.025;  // Of an arm in the air.

}  // namespace

void AddCalibrationCommand(CLI::App& app, Shared& shared) {
  auto* command = app.add_subcommand(
      "calibration", "Errors of a camera's calibration on rendered frames, over random places");
  const auto trial = std::make_shared<CalibrationTrial>();
  command
      ->add_option("--method", trial->method,
                   "marks of the boards, marks and gravity, or three poses in the air")
      ->check(CLI::IsMember(CalibrationMethods()));
  command->add_option("--boards", trial->boards, "Boards with marks (default 2)")
      ->check(CLI::Range(1, 2));
  const auto* placement =
      command
          ->add_option("--placement-sd-m", trial->placement_sd_m,
                       "Standard deviation of the sphere's place on a mark, m, per axis (default "
                       "0.001; poses: 0.025)")
          ->check(CLI::Range(0.0001, 0.1));
  command
      ->add_option("--distance-m", trial->distance_m,
                   "From the camera to the origin along the floor, m (default 2)")
      ->check(CLI::Range(1.0, 4.0));
  command->add_option("--frames", trial->frames, "Frames per mark (default 30)")
      ->check(CLI::Range(30, 1000));
  command->add_option("--trials", trial->trials, "Calibrations (default 20)")
      ->check(CLI::Range(1, 100000));
  command->add_option("--seed", trial->seed, "Seed of places and noise");
  command->callback([trial, placement, &shared] {
    if (trial->method == "poses" && placement->count() == 0)
      trial->placement_sd_m = kPosePlacementSdM;
    Progress progress("calibration", "trials", trial->trials, clock::MonotonicNs());
    const auto on_done = [&](int done) { progress.Done(done, clock::MonotonicNs(), std::cerr); };
    shared.exit_code = PrintResult(RunCalibrationTrial(*trial, on_done), shared.json);
  });
}

}  // namespace footing::eval
