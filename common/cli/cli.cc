#include "common/cli/cli.h"

#include <iostream>
#include <memory>

namespace footing::cli {
namespace {

/// Help prints every default, but an empty list has none, and a description may state its own.
void HideEmptyDefaults(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    const bool stated = option->get_description().find("(default") != std::string::npos;
    if (stated || option->get_default_str() == "[]") option->default_str("");
  }
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) {
    HideEmptyDefaults(*command);
  }
}

}  // namespace

std::unique_ptr<CLI::App> NewApp(const std::string& name, const std::string& what,
                                 const std::string& examples) {
  auto app = std::make_unique<CLI::App>(what, name);
  app->option_defaults()->always_capture_default();
  app->set_version_flag("--version", name + " " + Version());
  app->footer("Examples:\n" + examples +
              "\nExit codes: 0 ok, 1 failure, 2 usage, 3 no device, 4 invalid data.");
  return app;
}

std::optional<int> Parse(CLI::App& app, int argc, char** argv) {
  HideEmptyDefaults(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool asked = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success);
    app.exit(error, std::cout, std::cerr);
    return asked ? 0 : static_cast<int>(ErrorKind::kUsage);
  }
  return std::nullopt;
}

int Report(const Error& error) {
  std::cerr << "error: " << error.message << std::endl;
  return static_cast<int>(error.kind);
}

const char* Version() { return FOOTING_VERSION; }

}  // namespace footing::cli
