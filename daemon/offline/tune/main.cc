#include "common/cli/cli.h"
#include "daemon/offline/compute/ranks.h"
#include "daemon/offline/tune/tune_command.h"

int main(int argc, char** argv) {
  auto app = footing::cli::NewApp(
      "footing-tune", "Tunes a gait's gains by search over simulated trials (docs/tuning.md).",
      "  footing-tune --gait walk --speeds 0.5,1.5 --out walk.csv\n"
      "  footing-tune --gait run --speeds 2,5 --out run.csv --method cmaes --iterations 20\n"
      "  footing-tune --gait walk --speeds 0.5 --from walk.csv --iterations 0 --trials 400 "
      "--seed 7 --json\n"
      "  footing-tune --gait walk --speeds 0.5,1.2,1.75 --style --out style.csv --method cmaes\n"
      "  mpirun -n 4 footing-tune --gait walk --speeds 0.5,1.5 --out walk.csv");
  footing::tune::Options options;
  app->add_option("--gait", options.gait, "Gait: step, walk, run or jump")->required();
  app->add_option("--speeds", options.speeds_mps,
                  "Speeds, m/s, increasing: A,B,...; one set of gains for each")
      ->required()
      ->delimiter(',')
      ->check(CLI::Range(0.0, 6.0));
  app->add_option(
         "--keep", options.keep_mps,
         "Speeds, m/s: A,B,...; the output also keeps the initial table's sets at these speeds")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 6.0));
  app->add_option("--out", options.out,
                  "Output table, CSV; resume state and plot are written beside it. Required unless "
                  "--iterations is 0");
  app->add_option("--from", options.from, "Gait tables to start from, CSV (default: built in)");
  app->add_option("--seed", options.seed, "Seed of the trials");
  app->add_option("--method", options.method, "Search method: descent (as in the paper) or cmaes")
      ->check(CLI::IsMember({"descent", "cmaes"}));
  app->add_option("--iterations", options.iterations,
                  "Total number of iterations; 0 only scores the initial table")
      ->check(CLI::Range(0, 100000));
  app->add_option("--trials", options.trials, "Number of trials for each point")
      ->check(CLI::Range(1, 100000));
  app->add_option("--step", options.step,
                  "First step of the search (cmaes: sigma), in units of its scales")
      ->check(CLI::Range(0.01, 4.0));
  app->add_option("--threads", options.threads, "Number of threads (0: one per core)")
      ->check(CLI::Range(0, 256));
  app->add_flag(
      "--style", options.style,
      "Search the style of walk or run: its tables, with what footing-eval style measures");
  app->add_flag("--json", options.json, "One JSON object on standard output");
  if (const auto code = footing::cli::Parse(*app, argc, argv)) return *code;
  options.command_line = "footing-tune";
  for (int i = 1; i < argc; ++i) (options.command_line += ' ') += argv[i];
  const auto ranks = footing::ranks::Ranks::Join();
  if (!ranks) return footing::cli::Report(ranks.error());
  return ranks->Leave(footing::tune::Run(options, *ranks));
}
