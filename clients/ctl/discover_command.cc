#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "clients/ctl/commands.h"
#include "common/cli/cli.h"
#include "common/net/browser.h"

namespace footing::ctl {
namespace {

using nlohmann::ordered_json;

Result<void> RunDiscover(double within_s, const Shared& shared) {
  const auto found = discovery::Browse(within_s);
  if (!found) return found.error();
  ordered_json servers = ordered_json::array();
  std::string text;
  for (const discovery::Found& one : *found) {
    const discovery::Service& service = one.service;
    servers.push_back({{"name", service.name},
                       {"program", service.program},
                       {"address", one.address.Text()},
                       {"fingerprint", service.fingerprint}});
    text += (text.empty() ? "" : "\n") + service.name + "  " + service.program + "  " +
            one.address.Text();
    if (!service.fingerprint.empty()) text += "\n  says that it has " + service.fingerprint;
  }
  if (text.empty()) {
    text = "no server advertises itself in this network; name its address with --connect";
  } else {
    text +=
        "\nAnyone in the network can say so: compare the fingerprint with what footing-ctl trust "
        "prints on the server.";
  }
  Print({{"servers", servers}}, text, shared);
  return {};
}

}  // namespace

void AddDiscoverCommand(CLI::App& app, Shared& shared) {
  auto within_s = std::make_shared<double>(3);
  CLI::App* command = app.add_subcommand(
      "discover", "List servers in this network that advertise themselves (needs avahi-daemon)");
  command->add_option("--seconds", *within_s, "Timeout, s")->check(CLI::Range(0.1, 60.0));
  command->footer(
      "Examples:\n"
      "  footing-ctl discover\n"
      "  footing-ctl discover --json");
  command->callback([within_s, &shared] {
    const auto done = RunDiscover(*within_s, shared);
    if (!done) shared.exit_code = cli::Report(done.error());
  });
}

}  // namespace footing::ctl
