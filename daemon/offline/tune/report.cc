#include "daemon/offline/tune/report.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "common/cli/cli.h"
#include "daemon/offline/analysis/line_plot.h"

namespace footing::tune {
namespace {

using nlohmann::ordered_json;

std::string Short(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

std::string ScoreText(const Score& score) {
  return Short(score.mean.total()) + " +- " + Short(score.total_half_width) + ", " +
         std::to_string(score.falls) + " falls of " + std::to_string(score.trials);
}

ordered_json ToJson(const Score& score) {
  return {{"objective", score.mean.total()},
          {"half_width", score.total_half_width},
          {"trials", score.trials},
          {"survival", score.survival},
          {"falls", score.falls},
          {"failure", score.mean.failure},
          {"speed", score.mean.speed},
          {"flight", score.mean.flight},
          {"stance", score.mean.stance},
          {"stride", score.mean.stride},
          {"heading", score.mean.heading},
          {"legs", score.mean.legs},
          {"latency", score.mean.latency}};
}

}  // namespace

std::string TableText(const Options& options, const std::vector<gait::GainSet>& kept,
                      const std::vector<TunedSet>& tuned) {
  std::string comment = "Made by footing-tune " + std::string(cli::Version()) + ", seed " +
                        std::to_string(options.seed) + ":\n" + options.command_line +
                        "\nObjective on trials that no iteration had, 95 % intervals:\n";
  std::vector<gait::GainSet> sets = kept;
  for (const TunedSet& one : tuned) {
    comment += one.set.name + ": " + ScoreText(one.before) + " before; " + ScoreText(one.after) +
               " after" + (one.better ? "" : ", not better: the start is kept") + "\n";
    sets.push_back(one.set);
  }
  std::sort(sets.begin(), sets.end(),
            [](const auto& a, const auto& b) { return a.speed_mps < b.speed_mps; });
  std::vector<const gait::GainField*> columns;
  for (const gait::GainField& field : gait::GainFields()) {
    const auto differs = [&field](const gait::GainSet& set) {
      return field.Of(set.gains) != field.Of(gait::Gains{});
    };
    if (std::any_of(sets.begin(), sets.end(), differs)) columns.push_back(&field);
  }
  return gait::WriteGains(stream::GaitNamed(options.gait), sets, columns, comment);
}

std::string Plot(const Options& options, const std::vector<SearchState>& searches) {
  std::vector<plot::Curve> curves;
  for (std::size_t i = 0; i < searches.size(); ++i) {
    const std::string speed = Short(options.speeds_mps[i]) + " m/s";
    plot::Curve present{speed, {}}, best{speed + ", best tried", {}};
    for (const HistoryPoint& point : searches[i].history) {
      present.points.emplace_back(point.iteration, point.objective);
      best.points.emplace_back(point.iteration, point.best);
    }
    curves.push_back(std::move(present));
    curves.push_back(std::move(best));
  }
  return plot::LinePlot(options.gait + ", " + options.method + ", seed " +
                            std::to_string(options.seed) + ", each iteration on trials of its own",
                        "iteration", "objective", curves);
}

ordered_json ReportOf(const Options& options, const std::vector<Dimension>& dimensions,
                      const std::vector<TunedSet>& tuned) {
  ordered_json sets = ordered_json::array();
  for (const TunedSet& one : tuned) {
    ordered_json gains;
    for (const Dimension& dimension : dimensions) {
      gains[std::string(dimension.gain->name)] = dimension.gain->Of(one.set.gains);
    }
    sets.push_back({{"set", one.set.name},
                    {"speed_mps", one.set.speed_mps},
                    {"before", ToJson(one.before)},
                    {"after", ToJson(one.after)},
                    {"difference", one.difference.mean},
                    {"difference_half_width", one.difference.half_width},
                    {"better", one.better},
                    {"gains", gains}});
  }
  return {{"gait", options.gait},     {"method", options.method},
          {"seed", options.seed},     {"iterations", options.iterations},
          {"trials", options.trials}, {"sets", sets}};
}

}  // namespace footing::tune
