#include "daemon/offline/eval/spheres_command.h"

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "daemon/offline/eval/print_report.h"
#include "daemon/offline/eval/sphere_trial.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;

struct TrialFlags {
  SphereTrial trial;
  std::vector<double> distances_m = {0.5, 1, 1.5, 2, 2.5, 3, 4};
  bool with_progress = false;
};

void PrintProgress(const SphereProgress& so_far) {
  std::cerr << so_far.frames << " frames: " << so_far.missed << " of " << so_far.spheres
            << " spheres missed (95 %: below " << RateBound(so_far.missed, so_far.spheres) << "), "
            << so_far.extra << " false ones (95 %: below " << RateBound(so_far.extra, so_far.frames)
            << " a frame)" << std::endl;
}

Result<ordered_json> EvaluateTrials(const TrialFlags& flags) {
  const auto camera = CalibratedCamera(flags.trial.condition, flags.trial.seed);
  if (!camera) return camera.error();
  if (!flags.trial.out.empty() && flags.distances_m.size() != 1)
    return UsageError("--out takes the frames of one distance; name it with --distance-m");
  ordered_json rows = ordered_json::array();
  for (const double distance_m : flags.distances_m) {
    SphereTrial trial = flags.trial;
    trial.distance_m = distance_m;
    if (flags.with_progress) trial.on_progress = PrintProgress;
    const auto row = RunSphereTrial(trial, *camera);
    if (!row) return row.error();
    rows.push_back(*row);
  }
  return ordered_json{{"blur_px", camera->settings.profile.blur_px},
                      {"limb", camera->settings.profile.limb},
                      {"rows", rows}};
}

}  // namespace

void AddSpheresCommand(CLI::App& app, Shared& shared) {
  auto* command = app.add_subcommand(
      "spheres", "Errors of the sphere finder on rendered frames, by distance and condition");
  const auto flags = std::make_shared<TrialFlags>();
  SphereTrial& trial = flags->trial;
  command->add_option("--condition", trial.condition, "Light, lens and surroundings")
      ->check(CLI::IsMember(SphereConditions()));
  command
      ->add_option("--distance-m", flags->distances_m,
                   "Distances of the spheres, m; 0 draws each from 0.5 to 4")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 10.0));
  command->add_option("--frames", trial.frames, "Frames per distance")
      ->check(CLI::Range(1, 1000000));
  command->add_option("--seed", trial.seed, "Seed of places, noise and clutter");
  command->add_option("--rows", trial.rows,
                      "CSV file to add a row to for every sphere that is there or is found");
  command->add_option("--out", trial.out,
                      "Folder to write the frames, truth.csv and camera.json into");
  command->add_flag("--progress", flags->with_progress,
                    "Counts and rates so far on standard error, every 500 frames");
  command->callback(
      [flags, &shared] { shared.exit_code = PrintResult(EvaluateTrials(*flags), shared.json); });
}

}  // namespace footing::eval
