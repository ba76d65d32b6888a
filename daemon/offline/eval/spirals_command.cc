#include "daemon/offline/eval/spirals_command.h"

#include <memory>

#include "daemon/offline/eval/print_report.h"
#include "daemon/offline/eval/spirals_trials.h"

namespace footing::eval {

void AddSpiralsCommand(CLI::App& app, Shared& shared) {
  struct Flags {
    int seeds = 100;
    std::uint64_t first = 1;
    learning::CascadeOptions options = SpiralOptions();
  };
  auto* command = app.add_subcommand(
      "spirals", "Cascade correlation on the two spirals (Fahlman & Lebiere 1990, section 3.1)");
  const auto flags = std::make_shared<Flags>();
  command->add_option("--seeds", flags->seeds, "Number of trainings")->check(CLI::Range(1, 10'000));
  command->add_option("--first-seed", flags->first, "Seed of the first one; each has the next");
  command->add_option("--pool", flags->options.candidates.pool, "Candidates for each hidden unit")
      ->check(CLI::Range(1, 256));
  command->callback([flags, &shared] {
    shared.exit_code =
        PrintResult(RunSpiralTrials(flags->options, flags->first, flags->seeds), shared.json);
  });
}

}  // namespace footing::eval
