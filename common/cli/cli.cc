#include "common/cli/cli.h"

#include <unistd.h>

#include <array>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <regex>
#include <sstream>
#include <string_view>

namespace footing::cli {
namespace {

constexpr const char* kExitCodes =
    "Exit codes: 0 ok, 1 failure, 2 usage, 3 no device, 4 invalid data.";

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

/// Every number has to be one: a range takes NaN, which compares with nothing, and -1 becomes the
/// greatest number without a sign.
void RefuseNoNumbers(CLI::App& app) {
  const CLI::Validator finite(
      [](std::string& text) {
        double number = 0;
        const bool is_number = CLI::detail::lexical_cast(text, number);
        return is_number && !std::isfinite(number) ? text + " is not a finite number"
                                                   : std::string();
      },
      "");
  const CLI::Validator not_negative(
      [](std::string& text) {
        return text.starts_with('-') ? text + " is not a number from 0" : std::string();
      },
      "");
  for (CLI::Option* option : app.get_options()) {
    const std::string type = option->get_type_name();
    if (type.find("FLOAT") != std::string::npos) option->check(finite);
    if (type.find("UINT") != std::string::npos) option->check(not_negative);
  }
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) {
    RefuseNoNumbers(*command);
  }
}

/// The lines of `examples` that run `command`, each with the lines that continue it.
std::string ExamplesOf(const std::string& examples, const std::string& command) {
  std::istringstream lines(examples);
  std::string of_command;
  bool continues = false, taken = false;
  for (std::string line; std::getline(lines, line);) {
    if (!continues) taken = (line + " ").starts_with("  " + command + " ");
    if (taken) of_command += line + "\n";
    continues = line.ends_with('\\');
  }
  return of_command;
}

/// A subcommand takes its parent's footer over, with the examples of all its siblings; it shows its
/// own ones, or none.
void NarrowExamples(CLI::App& app) {
  const std::string footer = app.get_footer();
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) {
    if (command->get_footer() != footer) continue;
    const std::string own = ExamplesOf(footer, app.get_name() + " " + command->get_name());
    command->footer((own.empty() ? "" : "Examples:\n" + own) + kExitCodes);
  }
}

/// The command that the words of the command line lead to: "footing-ctl trial start".
const CLI::App& InnermostCommand(const CLI::App& app, std::string& name) {
  const std::vector<CLI::App*> taken = app.get_subcommands();
  if (taken.empty()) return app;
  name += " " + taken.back()->get_name();
  return InnermostCommand(*taken.back(), name);
}

std::string Subcommands(const CLI::App& command) {
  std::string text = "there are:";
  for (const CLI::App* one : command.get_subcommands([](const CLI::App*) { return true; })) {
    text += " " + one->get_name();
  }
  return text;
}

/// "10.000000" of a range becomes "10".
std::string WithShortNumbers(const std::string& text) {
  static const std::regex kTrailingZeros(R"((\.\d*?)0+\b)"), kBarePoint(R"((\d)\.(?!\d))");
  return std::regex_replace(std::regex_replace(text, kTrailingZeros, "$1"), kBarePoint, "$1");
}

/// "Could not convert: --seed = x" in our words: only numbers are converted.
std::string Unconverted(const std::string& named) {
  const std::size_t at = named.find(" = ");
  if (at == std::string::npos) return named;
  return named.substr(0, at) + ": " + named.substr(at + 3) + " is not a number that it takes";
}

/// "--x: Value -1 not in range 0 to 6" and "--x: t not in {a,b}" in our words; otherwise `text`.
std::string WrongValue(const std::string& text) {
  static const std::regex kRange("(.*): Value (.*) not in range (.*)");
  static const std::regex kMember(R"((.*): (.*) not in \{(.*)\})");
  std::smatch parts;
  if (std::regex_match(text, parts, kRange)) {
    return parts[1].str() + " " + parts[2].str() + ": must be from " + parts[3].str();
  }
  if (!std::regex_match(text, parts, kMember)) return text;
  return parts[1].str() + " " + parts[2].str() + ": must be one of " +
         std::regex_replace(parts[3].str(), std::regex(","), ", ");
}

/// Problem of a command line, as one line.
std::string Problem(const CLI::App& app, const CLI::App& command, const CLI::ParseError& error) {
  const std::vector<std::string> unknown = app.remaining(true);
  const bool has_subcommands =
      !command.get_subcommands([](const CLI::App*) { return true; }).empty();
  const std::string what = WrongValue(WithShortNumbers(error.what()));
  const bool has_word = !unknown.empty() && !unknown.front().starts_with('-');
  if (!has_word && has_subcommands && what == "A subcommand is required") {
    return "a subcommand is missing; " + Subcommands(command);
  }
  constexpr std::string_view kConversion = "Could not convert: ";
  if (what.starts_with(kConversion)) return Unconverted(what.substr(kConversion.size()));
  if (unknown.empty()) return what;
  const std::string& first = unknown.front();
  const bool is_option = first.starts_with('-');
  if (!is_option && has_subcommands) {
    return "unknown subcommand " + first + "; " + Subcommands(command);
  }
  if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr) return what;
  return (is_option ? "unknown option " : "unexpected argument ") + first;
}

}  // namespace

std::unique_ptr<CLI::App> NewApp(const std::string& name, const std::string& what,
                                 const std::string& examples) {
  auto app = std::make_unique<CLI::App>(what, name);
  app->option_defaults()->always_capture_default();
  app->set_version_flag("--version", name + " " + Version());
  app->footer("Examples:\n" + examples + (examples.ends_with('\n') ? "" : "\n") + kExitCodes);
  return app;
}

std::optional<int> Parse(CLI::App& app, int argc, char** argv) {
  HideEmptyDefaults(app);
  NarrowExamples(app);
  RefuseNoNumbers(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool asked = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success);
    if (!asked) {
      std::string name = app.get_name();
      const CLI::App& command = InnermostCommand(app, name);
      return Report(UsageError(Problem(app, command, error) + "; run " + name + " --help"));
    }
    app.exit(error, std::cout, std::cerr);
    return 0;
  }
  return std::nullopt;
}

int Report(const Error& error) {
  std::cerr << "error: " << error.message << std::endl;
  return static_cast<int>(error.kind);
}

std::string UserAtHost() {
  const char* user = std::getenv("USER");
  std::array<char, 256> host{};
  // A name that is longer is cut, and the last byte stays zero.
  if (::gethostname(host.data(), host.size() - 1) != 0) host = {"unknown host"};
  return (user != nullptr ? std::string(user) : "uid " + std::to_string(::getuid())) + "@" +
         host.data();
}

std::string StopReason(const std::string& program, int signal) {
  return program +
         (signal == SIGINT ? " was stopped at its terminal (Ctrl-C)" : " is being stopped");
}

const char* Version() { return FOOTING_VERSION; }

}  // namespace footing::cli
