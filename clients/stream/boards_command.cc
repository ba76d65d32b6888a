#include "clients/stream/boards_command.h"

namespace footing::stream_client {
namespace {

void AddMotion(CLI::App& command, StageOptions& stage) {
  command
      .add_option("--motion", stage.motion,
                  "A carried motion (demo, quiet), a script of one, or BVH, AMC, TRC, C3D")
      ->required();
  command.add_option("--skeleton", stage.skeleton, "ASF of an AMC");
  command.add_option("--mass-kg", stage.mass_kg)->check(CLI::Range(20.0, 250.0));
  command.add_option("--height-m", stage.height_m, "Of who performs a script")
      ->check(CLI::Range(1.4, 2.1));
}

}  // namespace

CLI::App* AddBoardsCommand(CLI::App& app, BoardsOptions& options) {
  auto* boards = app.add_subcommand("boards", "Two Balance Boards under a body in motion");
  AddMotion(*boards, options.stage);
  boards->add_option("--hands", options.hands, "none, move, wiimote or kinect");
  boards->add_option("--lose-hand", options.lost_hand, "left or right: lost for a while");
  boards->add_option("--lose-from-s", options.lost_from_s, "From then on,")
      ->check(CLI::Range(0.0, 1e6));
  boards->add_option("--lose-for-s", options.lost_for_s, "so long")->check(CLI::Range(0.0, 1e6));
  boards->add_option("--hand-noise-m", options.hand_noise_m)->check(CLI::Range(0.0, 0.5));
  boards->add_flag("--place-boards", options.stage.place_boards, "Lay the boards under the feet");
  boards->add_option("--cell-noise-kg", options.errors.noise_kg)->check(CLI::Range(0.0, 5.0));
  boards->add_option("--gain-error", options.errors.gain_spread, "0.01: one percent a cell")
      ->check(CLI::Range(0.0, 0.2));
  boards->add_option("--hysteresis-n", options.errors.hysteresis_n, "Play of a cell, half")
      ->check(CLI::Range(0.0, 50.0));
  boards->add_option("--slow-force-n", options.errors.slow_force_n, "Slow error of a board")
      ->check(CLI::Range(0.0, 50.0));
  return boards;
}

CLI::App* AddInsolesCommand(CLI::App& app, InsolesOptions& options) {
  auto* insoles =
      app.add_subcommand("insoles", "Pressure insoles in the shoes of a body in motion");
  AddMotion(*insoles, options.stage);
  insoles->add_option("--hands", options.hands, "none or move");
  insoles->add_option("--hand-noise-m", options.hand_noise_m)->check(CLI::Range(0.0, 0.5));
  insoles->add_option("--cell-noise-kg", options.errors.noise_kg)->check(CLI::Range(0.0, 5.0));
  insoles->add_option("--gain-error", options.errors.gain_spread, "0.01: one percent a cell")
      ->check(CLI::Range(0.0, 0.2));
  return insoles;
}

}  // namespace footing::stream_client
