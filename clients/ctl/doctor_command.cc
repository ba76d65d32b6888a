#include <memory>

#include "clients/ctl/collect.h"
#include "clients/ctl/commands.h"
#include "clients/ctl/report/doctor.h"
#include "common/cli/cli.h"

namespace footing::ctl {
namespace {

/// Silence shows as a stale state within this, jitter settles within it.
constexpr double kObservedS = 1;

void Doctor(Shared& shared, const std::string& root) {
  doctor::Facts facts = CollectHost(root);
  facts.own_version = cli::Version();
  facts.footingd_address =
      shared.connect.empty() ? transport::DefaultAddress("sensor").Text() : shared.connect;
  const auto session = Open(shared, {"status", "setup"});
  if (!session && session.error().kind == ErrorKind::kUsage) {
    shared.exit_code = cli::Report(session.error());
    return;
  }
  facts.footingd_reached = session.ok();
  if (session) {
    (*session)->RunFor(kObservedS);
    facts.footingd_version = (*session)->welcome().version();
    facts.devices = (*session)->status();
    facts.setup = (*session)->setup();
  } else {
    const bool refused = session.error().kind == ErrorKind::kFailure;
    facts.footingd_trouble = refused ? session.error().message : "nothing answers";
  }
  const std::vector<doctor::Finding> findings = doctor::Examine(facts);
  Print(doctor::ToJson(findings), doctor::ToText(findings), shared);
  if (!doctor::Healthy(findings)) shared.exit_code = static_cast<int>(ErrorKind::kFailure);
}

}  // namespace

void AddDoctorCommand(CLI::App& app, Shared& shared) {
  const auto root = std::make_shared<std::string>("/");
  CLI::App* command = app.add_subcommand("doctor", "Find faults and print their remedies");
  command->add_option("--root", *root, "Root folder of the host to examine")->group("");
  command->footer(
      "Exit code 0 when there is no error, else 1.\n"
      "Examples:\n  footing-ctl doctor\n  sudo footing-ctl doctor --json");
  command->callback([root, &shared] { Doctor(shared, *root); });
}

}  // namespace footing::ctl
