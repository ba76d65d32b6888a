#include "daemon/offline/tune/tune_command.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <thread>

#include <unistd.h>
#include <nlohmann/json.hpp>

#include "common/base/json_text.h"
#include "common/base/units.h"
#include "common/cli/cli.h"
#include "common/plot/line_plot.h"
#include "common/runtime/clock.h"
#include "common/runtime/files.h"
#include "daemon/offline/tune/team.h"
#include "daemon/simulation/gait_service/config.h"

namespace footing::tune {
namespace {

using nlohmann::ordered_json;

/// Batches of trials that no iteration has.
constexpr std::uint64_t kJudgingBatch = 1u << 30;
constexpr int kJudgingTimes = 8;  // Trials for evaluation, of those a search has.

std::string SetName(std::size_t index, std::size_t count) {
  if (count == 1) return "all";
  if (index == 0) return "slow";
  if (index + 1 == count) return "fast";
  return count == 3 ? "medium" : "medium" + std::to_string(index);
}

/// One run of the program, from its options.
class Tuning {
 public:
  Tuning(const Options& options, Team team, gait::GainTable table)
      : options_(options),
        gait_(stream::GaitNamed(options.gait)),
        team_(std::move(team)),
        table_(std::move(table)),
        paper_(table_.At(gait_, 0).paper.laws > 0.5),
        dimensions_(options.style ? StyleDimensionsOf(gait_) : DimensionsOf(gait_, paper_)) {}

  Result<void> Resume() {
    searches_.assign(options_.speeds_mps.size(),
                     StartSearch(static_cast<int>(dimensions_.size()), options_.step));
    if (options_.iterations == 0) return {};
    const Result<std::string> text = KeptText();
    if (!text) return text.error();
    if (text->empty()) return {};
    auto searches = ResumeRun(*text, Key(), StatePath());
    if (!searches) return searches.error();
    const auto sized = [this](const SearchState& search) {
      return search.point.size() == static_cast<Eigen::Index>(dimensions_.size());
    };
    if (searches->size() != searches_.size() ||
        !std::all_of(searches->begin(), searches->end(), sized)) {
      return InvalidData(StatePath() + " is of another version; remove it to start again");
    }
    searches_ = std::move(*searches);
    if (team_.ranks().first()) std::fprintf(stderr, "resuming from %s\n", StatePath().c_str());
    return {};
  }

  Result<void> Tune() {
    for (std::size_t i = 0; i < searches_.size(); ++i) {
      if (const auto tuned = TuneSet(i); !tuned) return tuned;
    }
    return {};
  }

  Result<void> Write() const {
    if (options_.iterations == 0 || !team_.ranks().first()) return {};
    std::vector<gait::GainSet> sets;
    for (std::size_t i = 0; i < options_.keep_mps.size(); ++i) {
      const double speed_mps = options_.keep_mps[i];
      sets.push_back({"kept" + std::to_string(i + 1), speed_mps, StartOf({gait_, speed_mps})});
    }
    if (const auto done = ReplaceFile(options_.out, TableText(options_, sets, tuned_)); !done)
      return done;
    return ReplaceFile(PlotPath(), Plot(options_, searches_));
  }

  ordered_json Report() const { return ReportOf(options_, dimensions_, tuned_); }

 private:
  std::string StatePath() const { return options_.out + ".state.json"; }
  std::string PlotPath() const {
    return std::filesystem::path(options_.out).replace_extension(".svg").string();
  }

  /// State of the run that was stopped, on the first rank's disk; empty when there is none.
  Result<std::string> KeptText() const {
    Result<std::string> text = std::string();
    if (team_.ranks().first() && std::filesystem::exists(StatePath())) {
      text = config::ReadTextFile(StatePath());
    }
    if (!text) return text;
    return team_.ranks().OfFirst(*text);
  }

  Result<void> Keep() const {
    if (!team_.ranks().first()) return {};
    return ReplaceFile(StatePath(), KeepRun(Key(), searches_));
  }

  RunKey Key() const {
    std::vector<const gait::GainField*> columns;
    for (const gait::GainField& field : gait::GainFields()) columns.push_back(&field);
    RunKey key{options_.gait,   options_.speeds_mps, options_.seed,  options_.method,
               options_.trials, options_.step,       options_.style, ""};
    for (const stream::Gait gait : stream::kGaits) {
      key.from += gait::WriteGains(gait, table_.SetsOf(gait), columns, "");
    }
    return key;
  }

  Result<void> TuneSet(std::size_t index) {
    const Task task{gait_, options_.speeds_mps[index]};
    const std::uint64_t seed = MixSeeds(options_.seed, index);
    std::vector<Task> tasks = TasksOf(gait_, options_.speeds_mps, index, paper_);
    for (Task& each : tasks) each.style = options_.style;
    if (const auto prepared = team_.Prepare(tasks, table_, seed, Others(index)); !prepared) {
      return prepared;
    }
    SearchState& search = searches_[index];
    const gait::Gains start = StartOf(task);
    const Evaluate evaluate = [&](const std::vector<Eigen::VectorXd>& points, std::uint64_t batch) {
      std::vector<gait::Gains> gains;
      for (const Eigen::VectorXd& point : points) {
        gains.push_back(GainsAt(start, dimensions_, point));
      }
      std::vector<double> values;
      for (const auto& costs : team_.Try(gains, options_.trials, MixSeeds(seed, batch))) {
        values.push_back(ScoreOf(costs).mean.total());
      }
      return values;
    };
    while (search.iteration < options_.iterations) {
      const std::int64_t begin_ns = clock::MonotonicNs();
      if (options_.method == "descent") {
        Descend(search, evaluate);
      } else {
        Evolve(search, evaluate, seed);
      }
      if (const auto kept = Keep(); !kept) return kept;
      ShowProgress(index, NanosecondsToSeconds(clock::MonotonicNs() - begin_ns));
    }
    Validate(index, task, start, seed);
    return {};
  }

  /// The table's other sets as far as they are known: as tuned before, else those of the start.
  std::vector<gait::GainSet> Others(std::size_t index) const {
    std::vector<gait::GainSet> others;
    for (std::size_t i = 0; i < options_.speeds_mps.size(); ++i) {
      const double speed_mps = options_.speeds_mps[i];
      if (i < index) others.push_back(tuned_[i].set);
      if (i > index) others.push_back({"start", speed_mps, StartOf({gait_, speed_mps})});
    }
    return others;
  }

  /// The start's gains for this speed, which are all of the gait's own: what they take from other
  /// gaits stays theirs.
  gait::Gains StartOf(const Task& task) const {
    gait::Gains gains = table_.At(task.gait, task.speed_mps);
    const gait::Gains defaults;
    const bool hops = task.gait == stream::Gait::kRun || task.gait == stream::Gait::kJump;
    if (hops) {
      gains.walking = defaults.walking;
    } else {
      gains.hopping = defaults.hopping;
    }
    return gains;
  }

  void ShowProgress(std::size_t index, double seconds) const {
    if (!team_.ranks().first()) return;
    int left = 0;
    for (std::size_t i = index; i < searches_.size(); ++i) {
      left += std::max(0, options_.iterations - searches_[i].iteration);
    }
    const HistoryPoint& last = searches_[index].history.back();
    std::fprintf(stderr,
                 "%s %.3g m/s: iteration %d of %d, objective %.3f, best tried %.3f, about %.0f s "
                 "left\n",
                 options_.gait.c_str(), options_.speeds_mps[index], searches_[index].iteration,
                 options_.iterations, last.objective, last.best, left * seconds);
  }

  /// On trials that no iteration saw; what is not better there is not taken.
  void Validate(std::size_t index, const Task& task, const gait::Gains& start, std::uint64_t seed) {
    const bool scores_only = options_.iterations == 0;
    const gait::Gains found = GainsAt(start, dimensions_, searches_[index].point);
    const int trials = options_.trials * (scores_only ? 1 : kJudgingTimes);
    if (team_.ranks().first()) {
      std::fprintf(stderr, "%s %.3g m/s: scoring %d %strials\n", options_.gait.c_str(),
                   task.speed_mps, trials, scores_only ? "" : "new ");
    }
    std::vector<gait::Gains> judged{start};
    if (!scores_only) judged.push_back(found);
    const auto costs = team_.Try(judged, trials, MixSeeds(seed, kJudgingBatch));
    TunedSet tuned;
    tuned.before = ScoreOf(costs.front());
    tuned.after = ScoreOf(costs.back());
    tuned.difference = Compare(costs.back(), costs.front());
    tuned.better = tuned.after.falls <= tuned.before.falls &&
                   tuned.difference.mean + tuned.difference.half_width < 0;
    tuned.set = {SetName(index, searches_.size()), task.speed_mps, tuned.better ? found : start};
    const char* const remark = scores_only || tuned.better ? "" : ": not better, the start is kept";
    if (team_.ranks().first()) {
      std::fprintf(stderr,
                   "%s %.3g m/s: %.3f +- %.3f, %d falls before; %.3f +- %.3f, %d falls after%s\n",
                   options_.gait.c_str(), task.speed_mps, tuned.before.mean.total(),
                   tuned.before.total_half_width, tuned.before.falls, tuned.after.mean.total(),
                   tuned.after.total_half_width, tuned.after.falls, remark);
    }
    tuned_.push_back(std::move(tuned));
  }

  const Options& options_;
  stream::Gait gait_;
  Team team_;
  gait::GainTable table_;
  bool paper_;  ///< The table has the paper's own laws.
  std::vector<Dimension> dimensions_;
  std::vector<SearchState> searches_;
  std::vector<TunedSet> tuned_;
};

Result<void> Check(const Options& options) {
  if (stream::GaitNamed(options.gait) == stream::Gait::kUnspecified) {
    return UsageError("--gait " + options.gait + ": must be one of " + stream::GaitNames());
  }
  if (options.out.empty() && options.iterations > 0) {
    return UsageError("--out is missing; only --iterations 0 does without");
  }
  if (options.iterations > 0) {  // Before minutes of trials, not after them.
    const auto folder = std::filesystem::absolute(options.out).parent_path();
    if (::access(folder.c_str(), W_OK) != 0) {
      return Failure("--out " + options.out + ": cannot write to " + folder.string() + ": " +
                     std::strerror(errno));
    }
  }
  for (std::size_t i = 1; i < options.speeds_mps.size(); ++i) {
    if (options.speeds_mps[i] <= options.speeds_mps[i - 1]) {
      return UsageError("--speeds: must increase");
    }
  }
  if (options.style && !HasStyle(stream::GaitNamed(options.gait))) {
    return UsageError("--style: walk and run have a style to search, " + options.gait + " has not");
  }
  return CheckSpeeds(stream::GaitNamed(options.gait), options.speeds_mps);
}

Result<ordered_json> RunChecked(const Options& options, const ranks::Ranks& ranks) {
  if (const auto good = Check(options); !good) return good.error();
  const auto texts = engine_files::ReadTexts();
  if (!texts) return texts.error();
  auto table = TableOf(options.style ? texts->style : texts->gains, options.from);
  if (!table) return table.error();
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  auto team = Team::Create(options.threads > 0 ? options.threads : cores, ranks, options.from,
                           options.style);
  if (!team) return team.error();
  Tuning tuning(options, std::move(*team), std::move(*table));
  if (const auto resumed = tuning.Resume(); !resumed) return resumed.error();
  if (const auto tuned = tuning.Tune(); !tuned) return tuned.error();
  if (const auto written = tuning.Write(); !written) return written.error();
  return tuning.Report();
}

}  // namespace

int Run(const Options& options, const ranks::Ranks& ranks) {
  const Result<ordered_json> report = RunChecked(options, ranks);
  if (!report) return cli::Report(report.error());
  if (options.json && ranks.first()) std::printf("%s\n", text::ToText(*report).c_str());
  return 0;
}

Result<gait::GainTable> TableOf(const std::vector<engine::GainText>& texts,
                                const std::vector<std::string>& paths) {
  gait::GainTable table;
  for (const engine::GainText& gains : texts) {
    if (const auto added = table.Add(gains.text, gains.origin); !added) return added.error();
  }
  for (const std::string& path : paths) {
    const Result<std::string> text = config::ReadTextFile(path);
    if (!text) return text.error();
    if (const auto added = table.Add(*text, path); !added) return added.error();
  }
  return table;
}

Result<void> ReplaceFile(const std::string& path, const std::string& text) {
  const std::string beside = path + ".new";
  {
    std::ofstream file(beside, std::ios::binary | std::ios::trunc);
    file << text;
    file.close();
    if (!file) return Failure("cannot write " + beside + ": " + std::strerror(errno));
  }
  if (std::rename(beside.c_str(), path.c_str()) != 0) {
    return Failure("cannot rename " + beside + " to " + path + ": " + std::strerror(errno));
  }
  return {};
}

namespace {

std::string Short(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

std::string ScoreText(const Score& score) {
  return Short(score.mean.total()) + " +- " + Short(score.total_half_width) + ", " +
         std::to_string(score.falls) + " falls of " + std::to_string(score.trials);
}

ordered_json StyleJson(const StyleCost& cost) {
  return {{"cadence", cost.cadence},    {"bob", cost.bob},
          {"roll", cost.roll},          {"yaw", cost.yaw},
          {"slide", cost.slide},        {"jerk", cost.jerk},
          {"transport", cost.transport}};
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
          {"latency", score.mean.latency},
          {"style", StyleJson(score.mean.style)}};
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
