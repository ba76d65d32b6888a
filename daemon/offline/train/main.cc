#include "common/cli/cli.h"
#include "common/log/log.h"
#include "daemon/offline/train/command.h"

namespace {

std::string Joined(int argc, char** argv) {
  std::string line = "footing-train";
  for (int i = 1; i < argc; ++i) line += std::string(" ") + argv[i];
  return line;
}

/// A kind of model whose trainer is to come: a usage error that says which are there.
void AddUnbuiltCommand(CLI::App& app, const std::string& name, footing::train::Shared& shared) {
  CLI::App* command = app.add_subcommand(name, "Not built yet");
  command->fallthrough(false);
  command->allow_extras();
  command->callback([name, &shared] {
    shared.exit_code = footing::cli::Report(
        footing::UsageError("footing-train " + name +
                            " is not built yet; there are basis, cascade, com, mlp and pose"));
  });
}

}  // namespace

int main(int argc, char** argv) {
  auto app = footing::cli::NewApp(
      "footing-train", "Trains the models that the pose engine runs.",
      "  footing-train cascade --data sway.csv --inputs 20 --out sway.fmodel --seed 1 --json\n"
      "  footing-train cascade --data sway.csv --inputs 20 --out sway.fmodel \\\n"
      "                        --feedback c2,c1,c0 --feedback other --noise 0.01\n"
      "  footing-train com --motions mocap/ --exclude 14 --out com.fmodel --json\n"
      "  footing-train basis --motions mocap/ --out basis.fmodel\n"
      "  footing-train pose --motions mocap/ --exclude 14 --out pose.fmodel\n"
      "  footing-train pose --motions mocap/ --recording me.mcap --motion me.bvh --out me.fmodel\n"
      "  footing-train mlp --data sway.csv --inputs 20 --out mlp.fmodel --mse-goal 1e-5");
  footing::log::Start("footing-train", false);
  footing::train::Shared shared;
  shared.command_line = Joined(argc, argv);
  app->add_flag("--json", shared.json, "One JSON object on standard output");
  app->require_subcommand(1);
  app->fallthrough();
  footing::train::AddBasisCommand(*app, shared);
  footing::train::AddCascadeCommand(*app, shared);
  footing::train::AddComCommand(*app, shared);
  footing::train::AddMlpCommand(*app, shared);
  footing::train::AddPoseCommand(*app, shared);
  AddUnbuiltCommand(*app, "arm", shared);
  if (const auto code = footing::cli::Parse(*app, argc, argv)) return *code;
  return shared.exit_code;
}
