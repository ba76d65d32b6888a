#include "common/cli/cli.h"
#include "daemon/offline/tune/tune_command.h"

int main(int argc, char** argv) {
  auto app = footing::cli::NewApp(
      "footing-tune", "Tunes a gait's gains by search over simulated trials (docs/tuning.md).",
      "  footing-tune --gait walk --speeds 0.5,1.5 --out walk.csv\n"
      "  footing-tune --gait run --speeds 2,5 --out run.csv --method cmaes --iterations 20\n"
      "  footing-tune --gait walk --speeds 0.5 --from mine.csv --iterations 0 --trials 400 "
      "--seed 7 --json");
  footing::tune::Options options;
  app->add_option("--gait", options.gait, "step, walk, run or jump")->required();
  app->add_option("--speeds", options.speeds_mps, "One set for each, m/s, rising")
      ->required()
      ->delimiter(',')
      ->check(CLI::Range(0.0, 6.0));
  app->add_option("--out", options.out,
                  "The table; its state for going on and its plot are beside it. Needed unless "
                  "--iterations is 0");
  app->add_option("--from", options.from, "Gait tables to start from; default: the product's");
  app->add_option("--seed", options.seed, "Of the trials");
  app->add_option("--method", options.method, "descent (the paper's) or cmaes")
      ->check(CLI::IsMember({"descent", "cmaes"}));
  app->add_option("--iterations", options.iterations, "Altogether; 0 only scores the start")
      ->check(CLI::Range(0, 100000));
  app->add_option("--trials", options.trials, "Of each point tried")->check(CLI::Range(1, 100000));
  app->add_option("--threads", options.threads, "0: one a core")->check(CLI::Range(0, 256));
  app->add_flag("--json", options.json, "One JSON object on standard output");
  if (const auto code = footing::cli::Parse(*app, argc, argv)) return *code;
  options.command_line = "footing-tune";
  for (int i = 1; i < argc; ++i) (options.command_line += ' ') += argv[i];
  return footing::tune::Run(options);
}
