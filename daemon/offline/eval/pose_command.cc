#include "daemon/offline/eval/pose_command.h"

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/cli/cli.h"
#include "common/base/json_text.h"
#include "common/virtual/motion/standard_layout.h"
#include "daemon/offline/eval/ablations.h"
#include "daemon/offline/eval/baselines.h"
#include "daemon/offline/eval/claims.h"
#include "daemon/offline/eval/figures.h"
#include "daemon/offline/eval/insoles.h"
#include "daemon/offline/eval/plates.h"
#include "daemon/offline/eval/pose_flags.h"
#include "daemon/offline/eval/pose_scene.h"
#include "daemon/offline/eval/pose_trial.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;

void DescribeSensors(const PoseFlags& flags, const pose_run::PoseRun& run, ordered_json& json) {
  json["mode"] = flags.mode;
  json["hands"] = flags.hands;
  json["head"] = flags.head;
  json["belt"] = flags.scene.settings.belt;
  json["boards"] = flags.boards;
  json["boards_limited"] = flags.scene.settings.limited;
  json["cop_outside_sensors_share"] = run.outside_share;
}

Result<ordered_json> Evaluate(PoseFlags flags) {
  if (const auto translated = Translate(flags); !translated) return translated.error();
  if (flags.claims) {  // About the motion and equation (2): no models.
    const auto run = MakePoseScene(flags.scene);
    if (!run) return run.error();
    return ordered_json{{"claims", CheckClaims(*run)}};
  }
  const auto models = ReadPoseModels(flags.models, flags.scene.motion, flags.same_person);
  if (!models) return models.error();
  // A basis of the user's own may be of another layout.
  flags.scene.standard_layout = motion::IsStandardLayout(models->dofs);
  if (flags.boards == "insoles") {
    const auto walk = MakeInsoleScene(flags.scene);
    if (!walk) return walk.error();
    return ScoreInsoles(*walk, *models, flags.options);
  }
  std::optional<pose_run::PlateRun> plates;
  if (flags.boards == "forces") {
    auto made = MakePlateScene(flags.scene);
    if (!made) return made.error();
    plates = *std::move(made);
  }
  auto run = plates ? Result<pose_run::PoseRun>(plates->measured) : MakePoseScene(flags.scene);
  if (!run) return run.error();
  if (flags.hands == "wiimote" && !models->arm)
    return UsageError("--hands wiimote: give a model of kind arm too (footing-train arm)");
  if (flags.hands == "wiimote" || flags.hands == "straps")
    pose_run::EstimateArms(models->arm, *run);
  if (flags.ablations) {
    const auto rows = ScoreAblations(*run, *models, flags.options);
    if (!rows) return Error{rows.error().kind, flags.scene.motion + ": " + rows.error().message};
    return ordered_json{{"ablations", *rows}};
  }
  const Oracle oracle{Has(flags.oracle, "com"), Has(flags.oracle, "momentum"),
                      Has(flags.oracle, "feet")};
  auto json = RunPoseTrial(*run, *models, flags.options, oracle);
  if (!json) return Error{json.error().kind, flags.scene.motion + ": " + json.error().message};
  DescribeSensors(flags, *run, *json);
  if (plates) {
    const auto judged = ScorePlates(*plates, *models, flags.options, oracle);
    if (!judged) return judged.error();
    (*json)["plates"] = *judged;
  }
  if (!flags.figures.empty()) {
    const auto names = WriteFigures(*run, *models, flags.options, flags.figures);
    if (!names) return names.error();
    (*json)["figures"] = *names;
  }
  if (!flags.baselines) return json;
  const std::size_t judged_from = run->judged_from;
  const auto baselines =
      ScoreBaselines(pose_run::WithoutExtras(*std::move(run)), *models, flags.options, judged_from);
  if (!baselines) return baselines.error();
  (*json)["baselines"] = *baselines;
  return json;
}

/// One line; a table has one for each row.
void PrintField(const std::string& name, const ordered_json& value) {
  if (value.empty() || !value.is_array() || !value.front().is_object()) {
    std::cout << name << ": " << text::ToText(value) << "\n";
    return;
  }
  std::cout << name << ":\n";
  for (const ordered_json& row : value) std::cout << "  " << text::ToText(row) << "\n";
}

}  // namespace

void AddPoseCommand(CLI::App& app, Shared& shared) {
  auto* command = app.add_subcommand("pose",
                                     "Whole-body pose estimated from two boards and two hands "
                                     "under a motion, compared with the motion");
  const auto flags = std::make_shared<PoseFlags>();
  flags->scene.settings.errors.noise_kg = 0.05;
  AddPoseFlags(*command, *flags);
  command->footer(
      "Examples:\n"
      "  footing-eval pose --motion clip.bvh --json\n"
      "  footing-eval pose --motion clip.bvh --activities labels.csv --json\n"
      "  footing-eval pose --motion squats.trc --still static.trc --boards forces "
      "--forces squats_grf.mot --mass-kg 60");
  command->callback([flags, &shared] {
    const auto out = Evaluate(*flags);
    if (!out) {
      shared.exit_code = cli::Report(out.error());
      return;
    }
    if (out->contains("plates")) {
      for (const auto& warning : out->at("plates").at("warnings")) {
        std::cerr << "warning: " << flags->scene.forces << ": " << warning.get<std::string>()
                  << "\n";
      }
    }
    if (shared.json) {
      std::cout << text::ToText(*out) << "\n";
    } else {
      for (const auto& [name, value] : out->items()) PrintField(name, value);
    }
  });
}

}  // namespace footing::eval
