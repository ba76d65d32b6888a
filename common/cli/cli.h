#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "common/base/result.h"

/// Common parts of every program's command line.
namespace footing::cli {

/// A new parser with --version and the house's exit codes in its footer; help prints the default of
/// every option that has one. `examples` is a few lines of commands to copy.
std::unique_ptr<CLI::App> NewApp(const std::string& name, const std::string& what,
                                 const std::string& examples);

/// Parses; returns the exit code when the program should end now (0 after --help or --version, 2
/// for a wrong command line, whose reason is printed to standard error).
std::optional<int> Parse(CLI::App& app, int argc, char** argv);

/// Prints "error: ..." to standard error and returns the error's exit code.
int Report(const Error& error);

/// Who runs this program and where, for others to read: "anna@lab1"; "uid 1000@lab1" where the
/// environment names no user.
std::string UserAtHost();

/// Reason that a program's clients read when a signal ends it: "footingd is being stopped".
std::string StopReason(const std::string& program, int signal);

/// Program version, e.g. "0.1.0".
const char* Version();

}  // namespace footing::cli
