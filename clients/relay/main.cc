#include "clients/relay/options.h"
#include "common/cli/cli.h"
#include "common/runtime/log.h"

int main(int argc, char** argv) {
  auto app = footing::cli::NewApp(
      "footing-relay",
      "Takes the ticks of servers to more viewers than one machine can serve: publishes them in "
      "NATS "
      "or MQTT, and serves them at the edge.",
      "  footing-relay publish --nats tcp:127.0.0.1:4222 --site lab1\n"
      "  footing-relay serve --nats tcp:127.0.0.1:4222 --site lab1 --listen tcp:127.0.0.1:7460\n"
      "  footing-relay serve --nats tcp:127.0.0.1:4222 --site lab1 --server footing-sim \\\n"
      "      --listen tls:192.168.1.5:7460 --token-file token\n"
      "  footing-relay publish --mqtt 127.0.0.1:1883 --site lab1 --channel features");
  footing::relay::Shared shared;
  app->add_flag("--json", shared.json, "Print one JSON object on standard output at the end");
  app->require_subcommand(1);
  app->fallthrough();
  app->parse_complete_callback([] { footing::log::Start("footing-relay", false); });
  footing::relay::AddPublishCommand(*app, shared);
  footing::relay::AddServeCommand(*app, shared);
  if (const auto code = footing::cli::Parse(*app, argc, argv)) return *code;
  return shared.exit_code;
}
