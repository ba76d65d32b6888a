#include "clients/web/serve.h"
#include "common/cli/cli.h"
#include "common/runtime/log.h"

int main(int argc, char** argv) {
  auto app = footing::cli::NewApp(
      "footing-web",
      "Shows footing-sim and footingd in a browser, without anything to install there, and takes "
      "phones as controllers.",
      "  footing-web                                   # http://127.0.0.1:7480/ on this host\n"
      "  footing-web --listen tls:192.168.1.5:7480 --invite    # a QR code for other devices\n"
      "  footing-web --listen tls:192.168.1.5:7480 --phones    # a QR code for each phone\n"
      "  footing-web --connect unix:/run/footing/simulation.sock --json");
  const auto serve = footing::web::AddServe(*app);
  app->parse_complete_callback([] { footing::log::Start("footing-web", false); });
  if (const auto code = footing::cli::Parse(*app, argc, argv)) return *code;
  return serve();
}
