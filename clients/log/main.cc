#include "clients/log/commands.h"
#include "common/cli/cli.h"

int main(int argc, char** argv) {
  auto app = footing::cli::NewApp(
      "footing-log",
      "Records what the servers send, reads, exports and repairs recordings, and sends live poses.",
      "  footing-log record --out a.mcap\n"
      "  footing-log info a.mcap --json\n"
      "  footing-log export a.mcap --format csv --out a/\n"
      "  footing-log export a.mcap --format csv --tidy --out tidy/\n"
      "  footing-log export a.mcap --format xdf --out a/\n"
      "  footing-log export a.mcap --format foxglove --out a/\n"
      "  footing-log export a.mcap --format bids --out data/ --subject 02\n"
      "  footing-log export a.mcap --format bvh --skeleton humanoid --out a/\n"
      "  footing-log repair cut.mcap --out whole.mcap\n"
      "  footing-log recalibrate a.mcap --camera camera.json --out again.mcap\n"
      "  footing-log align a.mcap --with squats.c3d --out opensim/\n"
      "  footing-log serve a.mcap --listen unix:/tmp/replay.sock\n"
      "  footing-log osc --to 127.0.0.1:39539 --format vmc\n"
      "  footing-log serve-control --root study/    # others start and stop recordings\n"
      "  footing-log lsl                            # live, to the Lab Streaming Layer");
  footing::log_client::Shared shared;
  app->add_flag("--json", shared.json, "Print one JSON object on standard output");
  app->require_subcommand(1);
  app->fallthrough();
  footing::log_client::AddRecordCommand(*app, shared);
  footing::log_client::AddInfoCommand(*app, shared);
  footing::log_client::AddExportCommand(*app, shared);
  footing::log_client::AddRepairCommand(*app, shared);
  footing::log_client::AddRecalibrateCommand(*app, shared);
  footing::log_client::AddServeCommand(*app, shared);
  footing::log_client::AddAlignCommand(*app, shared);
  footing::log_client::AddOscCommand(*app, shared);
  footing::log_client::AddServeControlCommand(*app, shared);
  footing::log_client::AddLslCommand(*app, shared);
  if (const auto code = footing::cli::Parse(*app, argc, argv)) return *code;
  return shared.exit_code;
}
