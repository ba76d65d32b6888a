#include "clients/stream/user_command.h"

#include <vector>

#include "common/virtual/options/sensor_options.h"

namespace footing::stream_client {
namespace {

/// --see and --ranges move a body, which the others describe.
void AddBody(CLI::App& user, UserOptions& options, CLI::Option* see, CLI::Option* ranges) {
  std::vector<CLI::Option*> body = sensor_options::AddUserStyle(user, options.style);
  body.push_back(user.add_option("--style-seed", options.style_seed,
                                 "Seed of the user's style; keep it for one person whose devices "
                                 "have several seeds (default: --seed)"));
  body.push_back(user.add_option(
      "--turn-by", options.turn_by,
      "Body part that steers with the interface leg: head, feet or trunk (default head)"));
  auto* grip = user.add_option("--grip-deg", options.grip_deg,
                               "Rotation of the remotes in the hands, with wrist and arm, degrees "
                               "(default: drawn with the style)");
  body.push_back(grip);
  user.add_option("--grip-way", options.grip_way,
                  "Grips of both hands: mirrored or same (default mirrored)")
      ->needs(grip);
  user.callback([body, see, ranges] {
    if (see->count() + ranges->count() > 0) return;
    for (const CLI::Option* option : body) {
      if (option->count() > 0) throw CLI::RequiresError(option->get_name(), "--see or --ranges");
    }
  });
}

}  // namespace

CLI::App* AddUserCommand(CLI::App& app, UserOptions& options) {
  auto* user = app.add_subcommand(
      "user", "A synthetic user, who follows a script or sees the track and steers along it");
  auto* script = user->add_option("--script", options.script,
                                  "Script of the user: a built-in name, or a JSON file");
  user->add_option(
      "--interface", options.interface,
      "Interface: wrist, arm, leg, joystick or boards; with --script wrist or joystick");
  auto* see = user->add_option("--see", options.see,
                               "Address of footing-sim, whose character, track and trial the user "
                               "sees, unix:PATH, tcp:HOST:PORT or tls:HOST:PORT");
  see->excludes(script);
  auto* ranges = user->add_flag("--ranges", options.ranges,
                                "Perform the motions for which footing-study ranges prompts, again "
                                "and again");
  ranges->excludes(script)->excludes(see);
  AddBody(*user, options, see, ranges);
  auto* motion_plus = user->add_flag("--motion-plus", options.ports.motion_plus,
                                     "Add a MotionPlus to each Wiimote");
  auto* nunchuk =
      user->add_flag("--nunchuk", options.ports.nunchuk, "Add a Nunchuk to each Wiimote");
  for (auto* body : {see, ranges}) body->excludes(motion_plus)->excludes(nunchuk);
  return user;
}

}  // namespace footing::stream_client
