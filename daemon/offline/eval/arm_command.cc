#include "daemon/offline/eval/arm_command.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "common/runtime/data_file.h"
#include "common/wire/model_file.h"
#include "daemon/offline/eval/arm_trial.h"
#include "daemon/offline/eval/motion_options.h"
#include "daemon/offline/eval/pose_scene.h"
#include "daemon/offline/eval/print_report.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;

struct Flags {
  PoseSceneOptions scene;
  std::string model;
  std::vector<std::string> networks;
  std::vector<std::string> devices = {"fist"};
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
    auto read = ReadArmModel(flags.model, flags.scene.motion);
    if (!read) return read.error();
    model = *std::move(read);
  }
  std::vector<arm_network::ArmNetwork> networks;
  for (const std::string& path : flags.networks) {
    auto network = ReadNetwork(path, flags.scene.motion);
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

}  // namespace footing::eval
