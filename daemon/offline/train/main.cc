#include <algorithm>
#include <string_view>

#include "common/cli/cli.h"
#include "common/runtime/log.h"
#include "daemon/offline/compute/ranks.h"
#include "daemon/offline/train/pose_training.h"

namespace {

std::string Joined(int argc, char** argv) {
  std::string line = "footing-train";
  for (int i = 1; i < argc; ++i) line += std::string(" ") + argv[i];
  return line;
}

}  // namespace

int main(int argc, char** argv) {
  auto app = footing::cli::NewApp(
      "footing-train", "Trains the models that the pose engine runs.",
      "  footing-train cascade --data sway.csv --inputs 20 --out sway.fmodel --seed 1 --json\n"
      "  footing-train cascade --data sway.csv --inputs 20 --out noisy.fmodel \\\n"
      "                        --feedback x2,x1,x0 --feedback x3 --noise 0.01\n"
      "  footing-train com --motions mocap/ --exclude 14 --out com.fmodel --json\n"
      "  footing-train basis --motions mocap/ --out basis.fmodel\n"
      "  footing-train pose --motions mocap/ --exclude 14 --out pose.fmodel\n"
      "  footing-train pose --motions mocap/ --recording me.mcap --motion me.bvh --out me.fmodel\n"
      "  footing-train person --recording p07.mcap --subject p07 --out p07.fmodel\n"
      "  footing-train arm --motions mocap/ --exclude 14 --out arm.fmodel\n"
      "  mpirun -n 4 footing-train people --motions mocap/ --json\n"
      "  footing-train mlp --data sway.csv --inputs 20 --out mlp.fmodel --mse-goal 1e-5");
  footing::log::Start("footing-train", false);
  footing::train::Shared shared;
  shared.command_line = Joined(argc, argv);
  app->add_flag("--json", shared.json, "One JSON object on standard output");
  app->require_subcommand(1);
  app->fallthrough();
  footing::train::AddArmCommand(*app, shared);
  footing::train::AddBasisCommand(*app, shared);
  footing::train::AddCascadeCommand(*app, shared);
  footing::train::AddComCommand(*app, shared);
  footing::train::AddMlpCommand(*app, shared);
  footing::train::AddPeopleCommand(*app, shared);
  footing::train::AddPersonCommand(*app, shared);
  footing::train::AddPoseCommand(*app, shared);
  const auto ranks = footing::ranks::Ranks::Join();
  if (!ranks) return footing::cli::Report(ranks.error());
  shared.ranks = *ranks;
  const auto asked = std::find(argv, argv + argc, std::string_view("people"));
  if (ranks->count() > 1 && asked == argv + argc) {
    return ranks->Leave(footing::cli::Report(
        footing::UsageError("only footing-train people shares its work among MPI's ranks")));
  }
  const auto code = footing::cli::Parse(*app, argc, argv);
  return ranks->Leave(code.value_or(shared.exit_code));
}
