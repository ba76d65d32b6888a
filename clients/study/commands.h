#pragma once

#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "clients/study/plan/protocol.h"
#include "clients/study/report/trials.h"
#include "common/base/result.h"

namespace footing::study {

/// Options and exit code common to all subcommands.
struct Shared {
  bool json = false;
  int exit_code = 0;  ///< Set by the subcommand that ran.
};

/// A protocol that has been read and checked, with the tables and folder that belong to it.
struct LoadedProtocol {
  std::string path;
  std::string text;
  plan::Protocol protocol;
  std::string folder;  ///< Folder of the study's files.
  /// Texts of its mapping tables, by interface.
  std::map<std::string, std::string> tables = {};
  std::vector<std::string> remarks = {};  ///< On its tracks; plan::Remarks has those on the plan.
};

/// Reads and checks a protocol file; its tracks must be built-in ones, its tables measured ones.
Result<LoadedProtocol> Load(const std::string& path, const std::string& folder);

/// Records from the journals of all participants; a failure where there is none yet.
Result<std::vector<records::Records>> ReadPeople(const LoadedProtocol& loaded);

/// Answer of a command, as JSON and as text.
struct Answer {
  nlohmann::ordered_json json;
  std::string text;
};
/// Prints a command's answer, one JSON object or its text, or its error; keeps the exit code.
void Finish(const Result<Answer>& result, Shared& shared);

/// Values of PROTOCOL and --folder.
struct ProtocolOptions {
  std::string path;
  std::string folder;
};
/// Adds PROTOCOL and --folder.
void AddProtocolOptions(CLI::App& command, ProtocolOptions& options);

/// Each adds subcommands to footing-study; their callbacks do the work.
void AddCheckCommand(CLI::App& app, Shared& shared);
void AddRunCommand(CLI::App& app, Shared& shared);
void AddRangesCommand(CLI::App& app, Shared& shared);
void AddReportCommands(CLI::App& app, Shared& shared);  ///< analyze, report
void AddSimulateCommand(CLI::App& app, Shared& shared);
void AddSurveyCommand(CLI::App& app, Shared& shared);
void AddExportCommand(CLI::App& app, Shared& shared);

}  // namespace footing::study
