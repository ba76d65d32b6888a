#include "common/cli/statistics_options.h"

namespace footing::statistics_options {

using statistics::Named;
using statistics::NamesOf;

void Add(CLI::App& command, Options& options, const std::string& method_help) {
  command
      .add_option("--alternative", options.alternative,
                  "Differences to look for: any, or values greater or less than the control's")
      ->check(CLI::IsMember(NamesOf(statistics::kAlternatives)));
  command
      .add_option("--ties", options.ties,
                  "Ties that Steel's deviation allows for: of the two groups compared, or of all "
                  "groups (default pairwise)")
      ->check(CLI::IsMember(NamesOf(statistics::kAllTies)));
  command.add_option("--method", options.method, method_help)
      ->check(CLI::IsMember(NamesOf(statistics::kMethods)));
}

Chosen ChosenIn(const Options& options) {
  Chosen chosen;
  chosen.alternative = Named(options.alternative, statistics::kAlternatives);
  chosen.ties = Named(options.ties, statistics::kAllTies);
  if (!options.method.empty()) chosen.method = Named(options.method, statistics::kMethods);
  return chosen;
}

}  // namespace footing::statistics_options
