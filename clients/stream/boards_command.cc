#include "clients/stream/boards_command.h"

#include "common/virtual/options/sensor_options.h"

namespace footing::stream_client {
namespace {

void AddMotion(CLI::App& command, StageOptions& stage) {
  command
      .add_option("--motion", stage.motion,
                  "Motion: a built-in name (demo, quiet), a choreography script, or a BVH, AMC, "
                  "TRC or C3D file")
      ->required();
  sensor_options::AddMotionFile(command, stage.skeleton, stage.bvh_unit_m);
  command.add_option("--mass-kg", stage.mass_kg, "Mass of the body, kg")
      ->check(CLI::Range(20.0, 250.0));
  command.add_option("--height-m", stage.height_m, "Height of the person who performs a script, m")
      ->check(CLI::Range(1.4, 2.1));
}

void AddHandNoise(CLI::App& command, double& hand_noise_m) {
  command
      .add_option("--hand-noise-m", hand_noise_m,
                  "Standard deviation of the noise of hand positions, m")
      ->check(CLI::Range(0.0, 0.5));
}

}  // namespace

CLI::App* AddBoardsCommand(CLI::App& app, BoardsOptions& options) {
  auto* boards =
      app.add_subcommand("boards", "Two Balance Boards, and hand devices, under a moving body");
  AddMotion(*boards, options.stage);
  boards->add_option("--hands", options.hands,
                     "Hand devices: none, move, wiimote, straps, kinect or camera");
  boards->add_option("--head", options.head,
                     "Head tracker: none, or sphere for one on a cap (default none)");
  boards->add_option("--camera", options.camera_file,
                     "With --hands camera: camera file of the simulated camera");
  boards->add_option("--frames-to", options.frames_to,
                     "FIFO for its rendered frames, which footing-camera reads");
  boards->add_flag("--moves", options.moves,
                   "PS Moves in the fists: their lights are the spheres that the camera sees");
  boards->add_option("--lose-hand", options.lost_hand, "Hand to lose for a while: left or right");
  boards->add_option("--lose-from-s", options.lost_from_s, "Start of the loss, s")
      ->check(CLI::Range(0.0, 1e6));
  boards->add_option("--lose-for-s", options.lost_for_s, "Duration of the loss, s")
      ->check(CLI::Range(0.0, 1e6));
  AddHandNoise(*boards, options.hand_noise_m);
  boards->add_flag("--place-boards", options.stage.place_boards, "Place the boards under the feet");
  sensor_options::AddBoardErrors(*boards, options.errors);
  return boards;
}

CLI::App* AddInsolesCommand(CLI::App& app, InsolesOptions& options) {
  auto* insoles = app.add_subcommand("insoles", "Pressure insoles in the shoes of a moving body");
  AddMotion(*insoles, options.stage);
  insoles->add_option("--hands", options.hands, "Hand devices: none or move");
  AddHandNoise(*insoles, options.hand_noise_m);
  sensor_options::AddCellErrors(*insoles, options.errors.noise_kg, options.errors.gain_spread);
  return insoles;
}

}  // namespace footing::stream_client
