#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "common/base/result.h"
#include "common/runtime/config.h"

/// Command line and main loop of the programs that have a config: footingd and footing-sim.
namespace footing::cli {

/// An option that sets one key of the config. It goes before the config file and --set.
struct KeyOption {
  enum class Kind { kText, kList, kFlag };

  std::string name;  ///< "--engine"
  std::string key;
  std::string help;
  Kind kind = Kind::kText;
};

/// A program with a config, as its help describes it.
struct ServerProgram {
  std::string name;
  std::string what;
  std::string examples;            ///< Command lines to copy, one a line.
  std::vector<KeyOption> options;  ///< Besides --listen, which every server has.
};

/// The command line of a server. It can be applied to a config again when the config file has
/// changed.
struct ServerLine {
  std::string program;
  std::string file;                                          ///< Config file; empty: none.
  std::vector<std::string> settings;                         ///< Each --set KEY=VALUE.
  std::vector<std::pair<std::string, std::string>> options;  ///< "--engine", "engine=pose".
  bool print = false;                                        ///< Print the config and end.
  bool origin = false;  ///< Where each printed value comes from, too.
  bool check = false;   ///< Check the config and the files that it names, and end.
  bool json = false;    ///< Print the listening addresses as one JSON object.

  /// Reads the file as it is now and sets the values of all bound keys: the file's, then those of
  /// --set, then those of options of their own. A usage error names the key.
  Result<void> Apply(config::Binder& binder) const;
  /// KEY=VALUE of --set and of options of their own.
  std::vector<std::string> AllSettings() const;
  /// Prints the config when --print-config is given.
  void PrintIfAsked(const config::Binder& binder) const;
};

/// Parses the command line and starts the log. The exit code when the program should end now: after
/// --help and --version, or for an error that has been printed.
std::optional<int> ParseServerLine(const ServerProgram& program, int argc, char** argv,
                                   ServerLine& line);

/// A server that listens.
struct RunningServer {
  std::string status;  ///< For `systemctl status`.
  std::vector<std::string> listening_on;
  /// The thread that is stuck; empty: none.
  std::function<std::string()> stuck;
  /// Each client gets what waits for it, and goodbye with the reason. `done` is called when the
  /// last one has ended.
  std::function<void(const std::string& reason, std::function<void()> done)> stop;
  /// Reads the config again. An error changes nothing.
  std::function<Result<void>()> reload;
};

/// Starts the server on an io_context and runs that until a signal ends it; SIGHUP reloads the
/// config. Returns the exit code.
int RunServer(const ServerLine& line,
              const std::function<Result<RunningServer>(boost::asio::io_context& io)>& start);

}  // namespace footing::cli
