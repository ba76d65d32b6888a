#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "common/statistics/analysis.h"

/// The options of tests against a control that several programs have.
namespace footing::statistics_options {

/// As the command line gives them; `ties` and `method` are empty where it does not.
struct Options {
  std::string alternative = "two.sided";
  std::string ties;
  std::string method;
};

/// Choices of a command line, as the tests take them.
struct Chosen {
  statistics::Alternative alternative = statistics::Alternative::kTwoSided;
  statistics::Ties ties = statistics::Ties::kPairwise;  ///< Handling of ties in Steel's test.
  std::optional<statistics::Method> method;             ///< Without: the one the test prefers.
};

/// Adds --alternative, --ties and --method, the last with that help. CLI11 refuses other names than
/// those of statistics::kAlternatives, kAllTies and kMethods.
void Add(CLI::App& command, Options& options, const std::string& method_help);
/// Choices by names that CLI11 has checked.
Chosen ChosenIn(const Options& options);

}  // namespace footing::statistics_options
