#include "common/cli/cli.h"

#include <iostream>
#include <memory>

namespace footing::cli {

std::unique_ptr<CLI::App> NewApp(const std::string& name, const std::string& what,
                                 const std::string& examples) {
  auto app = std::make_unique<CLI::App>(what, name);
  app->set_version_flag("--version", name + " " + Version());
  app->footer("Examples:\n" + examples +
              "\nExit codes: 0 ok, 1 failure, 2 usage, 3 no device, 4 invalid data.");
  return app;
}

std::optional<int> Parse(CLI::App& app, int argc, char** argv) {
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
