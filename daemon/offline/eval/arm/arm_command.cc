#include "daemon/offline/eval/arm/arm_command.h"

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "common/config/data_file.h"
#include "common/wire/model_file.h"
#include "daemon/offline/eval/arm/trial.h"
#include "daemon/offline/eval/pose/motion_options.h"
#include "daemon/offline/eval/pose/scene.h"
#include "daemon/offline/eval/report/print_report.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;

struct Flags {
  PoseSceneOptions scene;
  std::string model;
  std::vector<std::string> networks;
  double loop_minutes = 0;
};

/// Refuses one that was trained on the motion's subject.
Result<arm_network::ArmNetwork> ReadNetwork(const std::string& path, const std::string& motion) {
  const auto bytes = config::ReadTextFile(path, model::kMostFileBytes);
  if (!bytes) return bytes.error();
  const auto model = wire::FromModelFile(*bytes, path);
  if (!model) return model.error();
  const std::string subject = model::SubjectOfFile(std::filesystem::path(motion).stem().string());
  if (auto fresh = model::CheckNotTrainedOn(*model, subject, path); !fresh) return fresh.error();
  return arm_network::MakeArmNetwork(*model, path);
}

Result<ordered_json> Evaluate(Flags flags) {
  flags.scene.settings.loop_s = 60 * flags.loop_minutes;
  const auto model = ReadArmModel(flags.model, flags.scene.motion);
  if (!model) return model.error();
  std::vector<arm_network::ArmNetwork> networks;
  for (const std::string& path : flags.networks) {
    auto network = ReadNetwork(path, flags.scene.motion);
    if (!network) return network.error();
    networks.push_back(std::move(network).value());
  }
  const auto run = MakeArmScene(flags.scene);
  if (!run) return run.error();
  return RunArmTrial(*run, *model, networks);
}

}  // namespace

void AddArmCommand(CLI::App& app, Shared& shared) {
  auto* command = app.add_subcommand(
      "arm",
      "Arm poses estimated from a Wiimote with MotionPlus in each hand, compared with the motion");
  const auto flags = std::make_shared<Flags>();
  AddMotionOptions(*command, flags->scene);
  command->add_option("--model", flags->model, "Arm model, *.fmodel (default: built in)");
  command->add_option("--network", flags->networks,
                      "Network to compare with, of footing-train arm --kind paper or residual; may "
                      "be repeated");
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

}  // namespace footing::eval
