#include "clients/skeleton/commands.h"
#include "common/cli/cli.h"
#include "common/runtime/log.h"

int main(int argc, char** argv) {
  auto app = footing::cli::NewApp(
      "footing-skeleton",
      "Receives skeletons of people by OSC (OSCeleton, KinectV2-OSC and others, VMC) and publishes "
      "their joints on footingd's device socket. A webcam's joints come from the page of "
      "footing-web.",
      "  footing-skeleton                                # port 7110 of this host\n"
      "  footing-skeleton --listen 0.0.0.0:7110 --camera-m 2.4,0,1.1 --camera-pitch-deg -5\n"
      "  footing-skeleton --listen 0.0.0.0:12345         # KinectV2-OSC on another computer\n"
      "  footing-skeleton --no-publish --seconds 10 --json   # is what arrives plausible?\n"
      "  footing-skeleton send --seconds 60              # a synthetic person\n"
      "  footing-skeleton send wave.csv --dialect sensebloom");
  footing::skeleton::Shared shared;
  app->add_flag("--json", shared.json, "Print one JSON object on standard output at the end");
  app->require_subcommand(0, 1);
  app->fallthrough();
  const auto receive = footing::skeleton::AddReceiver(*app, shared);
  app->parse_complete_callback([] { footing::log::Start("footing-skeleton", false); });
  footing::skeleton::AddSend(*app, shared);
  if (const auto code = footing::cli::Parse(*app, argc, argv)) return *code;
  if (app->get_subcommands().empty()) receive();
  return shared.exit_code;
}
