#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "common/cli/cli.h"
#include "daemon/offline/bench/pairs.h"

namespace {

struct Benchmark {
  const char* name;
  footing::Result<footing::bench::Rows> (*run)();
};

constexpr Benchmark kBenchmarks[] = {
    {"publish_to_client_p50", footing::bench::PublishToClient},
    {"fan_out_cpu", footing::bench::FanOutCpu},
    {"fan_out_1000", footing::bench::FanOutThousand},
    {"publish_to_handler", footing::bench::PublishToHandler},
    {"stalled_readers", footing::bench::StalledReaders},
    {"tls_exchange", footing::bench::TlsExchange},
    {"body_kinematics", footing::bench::BodyKinematics},
    {"pose_frame", footing::bench::PoseFrame},
    {"biped_step", footing::bench::BipedStep},
    {"dunnett_test", footing::bench::DunnettTest},
#ifdef FOOTING_HAS_FANN
    {"cascade_training", footing::bench::CascadeTraining},
    {"spirals_training", footing::bench::SpiralsTraining},
#endif
};

std::vector<std::string> Names() {
  std::vector<std::string> names;
  for (const Benchmark& benchmark : kBenchmarks) names.push_back(benchmark.name);
  return names;
}

nlohmann::json ToJson(const footing::bench::Rows& rows) {
  auto list = nlohmann::json::array();
  for (const auto& row : rows) {
    list.push_back({{"name", row.name},
                    {"ours", row.ours},
                    {"baseline", row.baseline},
                    {"ratio", row.ratio},
                    {"unit", row.unit}});
  }
  return {{"rows", list}};
}

void Print(const footing::bench::Row& row, std::ostream& out) {
  out << row.name << ": ours " << row.ours << ", baseline " << row.baseline << " " << row.unit
      << ", ratio " << row.ratio << std::endl;
}

}  // namespace

int main(int argc, char** argv) {
  auto app = footing::cli::NewApp("footing-bench",
                                  "Benchmarks of this program against a baseline measured in the "
                                  "same run; reports the median of paired ratios.",
                                  "  footing-bench --json\n  footing-bench fan_out_cpu");
  bool json = false;
  std::vector<std::string> wanted;
  app->add_flag("--json", json, "One JSON object on standard output");
  app->add_option("NAME", wanted, "Benchmark to run; may be repeated (default: all)")
      ->check(CLI::IsMember(Names()));
  if (const auto code = footing::cli::Parse(*app, argc, argv)) return *code;

  footing::bench::Rows rows;
  for (const Benchmark& benchmark : kBenchmarks) {
    const bool named = std::find(wanted.begin(), wanted.end(), benchmark.name) != wanted.end();
    if (!wanted.empty() && !named) continue;
    std::cerr << "measuring " << benchmark.name << " (up to some minutes)" << std::endl;
    const auto measured = benchmark.run();
    if (!measured) return footing::cli::Report(measured.error());
    for (const auto& row : *measured) Print(row, json ? std::cerr : std::cout);
    rows.insert(rows.end(), measured->begin(), measured->end());
  }
  if (json) std::cout << ToJson(rows).dump() << std::endl;
  return 0;
}
