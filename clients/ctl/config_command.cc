#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "clients/ctl/commands.h"
#include "common/cli/cli.h"

namespace footing::ctl {
namespace {

struct ConfigOptions {
  std::string of = "footingd";
  std::string file;
  bool origin = false;
};

/// Becomes the server, which prints its config and ends; only an error comes back.
Error ShowConfig(const ConfigOptions& options, const Shared& shared) {
  if (!shared.connect.empty()) {
    return UsageError(
        "config connects to no server: it shows the config that one would start with; leave "
        "--connect out");
  }
  std::error_code error;
  const auto own = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::string program = (own.parent_path() / options.of).string();
  std::vector<std::string> words{program, "--print-config"};
  if (!options.file.empty()) words.insert(words.end(), {"--config", options.file});
  if (options.origin) words.push_back("--origin");
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execv(program.c_str(), arguments.data());
  return Failure("cannot start " + program + ": " + std::strerror(errno) +
                 "; install it, or run its own --print-config where it is");
}

}  // namespace

void AddConfigCommand(CLI::App& app, Shared& shared) {
  const auto options = std::make_shared<ConfigOptions>();
  CLI::App* config = app.add_subcommand("config", "Show the config of a server");
  config->require_subcommand(1);
  CLI::App* show =
      config->add_subcommand("show", "Print the config that a server would start with, JSON");
  show->add_option("--of", options->of, "Server: footingd or footing-sim")
      ->check(CLI::IsMember({"footingd", "footing-sim"}))
      ->capture_default_str();
  show->add_option("--config", options->file, "Config file, JSON (default: none)");
  show->add_flag("--origin", options->origin,
                 "Where each value comes from, too (default, FILE:LINE)");
  const std::string examples =
      "Examples:\n"
      "  footing-ctl config show --origin\n"
      "  footing-ctl config show --of footing-sim";
  config->footer(examples);
  show->footer(examples);
  show->callback(
      [options, &shared] { shared.exit_code = cli::Report(ShowConfig(*options, shared)); });
}

}  // namespace footing::ctl
