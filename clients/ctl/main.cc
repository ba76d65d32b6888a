#include <string>

#include "clients/ctl/commands.h"
#include "common/cli/cli.h"

int main(int argc, char** argv) {
  auto app = footing::cli::NewApp(
      "footing-ctl",
      "Console: lists, sets up and checks the devices, and sends commands to the servers.",
      "  footing-ctl setup               # guided setup of all devices\n"
      "  footing-ctl doctor              # faults and their remedies\n"
      "  footing-ctl watch               # live values\n"
      "  footing-ctl led left_hand 1010\n"
      "  footing-ctl mark \"stimulus on\" # an event in every recording\n"
      "  footing-ctl sway --subject P01  # quiet standing: measures and a report");
  footing::ctl::Shared shared;
  app->add_option("--connect", shared.connect,
                  "Address of footingd, unix:PATH, tcp:HOST:PORT or tls:HOST:PORT (default: "
                  "footingd of this user)");
  app->add_flag("--json", shared.json, "Print one JSON object on standard output");
  app->require_subcommand(1);
  app->fallthrough();
  footing::ctl::AddDeviceCommands(*app, shared);
  footing::ctl::AddControlCommands(*app, shared);
  footing::ctl::AddAssignCommand(*app, shared);
  footing::ctl::AddDoctorCommand(*app, shared);
  footing::ctl::AddPairCommand(*app, shared);
  footing::ctl::AddSetupCommand(*app, shared);
  footing::ctl::AddLayoutCommand(*app, shared);
  footing::ctl::AddAcceptanceCommand(*app, shared);
  footing::ctl::AddMotionsCommand(*app, shared);
  footing::ctl::AddPoseCommands(*app, shared);
  footing::ctl::AddTrialCommands(*app, shared);
  footing::ctl::AddInterfaceCommand(*app, shared);
  footing::ctl::AddLeaseCommand(*app, shared);
  footing::ctl::AddSessionsCommand(*app, shared);
  footing::ctl::AddMarkCommand(*app, shared);
  footing::ctl::AddSwayCommand(*app, shared);
  footing::ctl::AddTrustCommand(*app, shared);
  footing::ctl::AddDiscoverCommand(*app, shared);
  footing::ctl::AddConfigCommand(*app, shared);
  for (CLI::App* command : app->get_subcommands({})) {
    const std::string name = command->get_name();
    const bool connects = name != "trust" && name != "discover" && name != "config";
    command->footer(command->get_footer() + "\nAlso: --json" + (connects ? " and --connect" : "") +
                    ", as in footing-ctl --help.");
  }
  if (const auto code = footing::cli::Parse(*app, argc, argv)) return *code;
  return shared.exit_code;
}
