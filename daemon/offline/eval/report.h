#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/base/result.h"

namespace footing::eval {

/// State that all subcommands share.
struct Shared {
  bool json = false;
  int exit_code = 0;  ///< Set by the subcommand that ran.
};

/// Each adds one subcommand to footing-eval; its callback does the work and sets
/// `shared.exit_code`.

/// To standard output: one line of JSON, or a line for each field, for people.
void PrintReport(const nlohmann::ordered_json& report, bool json);
/// The same, or the error that there is in its place; returns the exit code.
int PrintResult(const Result<nlohmann::ordered_json>& report, bool json);

/// A line now and then while a command computes: "monkey: 120 of 600 s simulated". The first one
/// after 2 s, then one every 5 s; none for what ends sooner.
class Progress {
 public:
  /// `unit` follows the numbers: "trials", "s simulated".
  Progress(std::string command, std::string unit, double total, std::int64_t now_ns)
      : command_(std::move(command)),
        unit_(std::move(unit)),
        total_(total),
        next_ns_(now_ns + kFirstNs) {}

  /// Whole units only.
  void Done(double done, std::int64_t now_ns, std::ostream& out);

 private:
  static constexpr std::int64_t kFirstNs = 2'000'000'000, kEveryNs = 5'000'000'000;

  std::string command_, unit_;
  double total_;
  std::int64_t next_ns_;
};

/// The rows of a CSV file whose header is exactly `columns` (comma between names) and whose cells
/// are numbers within +-1e9. The first column is a time that never decreases. Lines that are empty
/// or begin with # are left out. Every error names file, line and what is wrong.
Result<std::vector<std::vector<double>>> ReadTimeTable(const std::string& path,
                                                       const std::string& columns);

/// The cells, as text, of the columns with these names out of a CSV file whose header holds them
/// among others, in any order. Cells in quotes are not understood: such columns stay unread.
/// InvalidData names the column that is missing or the line that is too short.
Result<std::vector<std::vector<std::string>>> ReadNamedColumns(
    const std::string& path, const std::vector<std::string>& names);

/// The names in a CSV file's first line; none when the file cannot be read or is empty.
std::vector<std::string> ReadHeader(const std::string& path);

/// A file with this text; one of before is overwritten.
Result<void> WriteText(const std::string& path, const std::string& text);

}  // namespace footing::eval
