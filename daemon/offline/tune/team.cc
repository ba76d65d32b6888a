#include "daemon/offline/tune/team.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "daemon/simulation/gait_service/engine_files.h"

namespace footing::tune {
namespace {

constexpr std::size_t kStarts = 12;
constexpr double k95Percent = 1.96;

template <typename Value>
Difference MeanOf(std::size_t count, const Value& value) {
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < count; ++i) sum += value(i);
  const auto n = static_cast<double>(count);
  const double mean = sum / n;
  for (std::size_t i = 0; i < count; ++i) squares += (value(i) - mean) * (value(i) - mean);
  return {mean, count > 1 ? k95Percent * std::sqrt(squares / (n - 1) / n) : 0};
}

}  // namespace

Result<Team> Team::Create(int threads, ranks::Ranks ranks, const std::vector<std::string>& gains) {
  const Result<engine::EngineTexts> texts = engine_files::ReadTexts({.more_gains = gains});
  if (!texts) return texts.error();
  Team team;
  team.ranks_ = ranks;
  team.texts_ = *texts;
  for (int i = 0; i < threads; ++i) {
    Result<engine::GaitEngine> engine = engine::GaitEngine::Create(*texts);
    if (!engine) return engine.error();
    team.engines_.push_back(std::move(engine).value());
  }
  return team;
}

Result<void> Team::Prepare(const std::vector<Task>& tasks, const gait::GainTable& table,
                           std::uint64_t seed, std::vector<gait::GainSet> others) {
  const std::size_t each = kStarts / tasks.size();
  std::vector<std::vector<engine::EngineState>> settled;
  for (const Task& task : tasks) {
    Result<engine::GaitEngine> engine = engine::GaitEngine::Create(texts_);
    if (!engine) return engine.error();
    engine->UseGains(table);
    auto states =
        SettledStates(*engine, task, static_cast<int>(each), MixSeeds(seed, settled.size()));
    if (!states) return states.error();
    settled.push_back(std::move(*states));
  }
  std::vector<Start> starts;
  for (std::size_t k = 0; k < each; ++k) {
    for (std::size_t i = 0; i < tasks.size(); ++i) starts.push_back({tasks[i], settled[i][k]});
  }
  table_ = table;
  starts_ = std::move(starts);
  own_mps_ = tasks.front().speed_mps;
  others_ = std::move(others);
  return {};
}

std::vector<gait::GainSet> Team::WholeTable(const gait::Gains& gains) const {
  std::vector<gait::GainSet> sets = others_;
  const auto above = std::find_if(sets.begin(), sets.end(),
                                  [this](const auto& set) { return set.speed_mps > own_mps_; });
  sets.insert(above, {"tried", own_mps_, gains});
  return sets;
}

engine::GaitEngine Team::OnTrack(std::string track) const {
  engine::EngineTexts texts = texts_;
  texts.track = std::move(track);
  Result<engine::GaitEngine> engine = engine::GaitEngine::Create(texts);
  FOOTING_CHECK(engine.ok());  // Only the track differs from the engines there are.
  return std::move(engine).value();
}

Cost Team::TryOne(engine::GaitEngine& engine, const gait::Gains& gains, std::size_t trial,
                  std::uint64_t seed) const {
  gait::GainTable table = table_;
  const auto& [task, start] = starts_[trial % starts_.size()];
  const Disturbance disturbance = Draw(task, MixSeeds(seed, trial));
  if (disturbance.change_s > 0) {
    table.Set(task.gait, WholeTable(gains));
  } else {
    table.Set(task.gait, {{"tried", 0, gains}});
  }
  engine.UseGains(table);
  if (disturbance.pit_m == 0) return CostOf(task, RunTrial(engine, start, task, disturbance));
  engine::GaitEngine on_pit = OnTrack(PitTrack(start, disturbance));
  on_pit.UseGains(table);
  return CostOf(task, RunTrial(on_pit, start, task, disturbance));
}

std::vector<Cost> Team::TryOwn(const std::vector<gait::Gains>& gains, std::size_t trials,
                               std::uint64_t seed) {
  const std::size_t all = gains.size() * trials;
  // Job after job in turn among the ranks, and a rank's among its threads.
  std::vector<Cost> costs((all + ranks_.count() - 1 - ranks_.rank()) / ranks_.count());
  const auto work = [&](std::size_t worker) {
    for (std::size_t own = worker; own < costs.size(); own += engines_.size()) {
      const std::size_t job = own * ranks_.count() + ranks_.rank();
      costs[own] = TryOne(engines_[worker], gains[job / trials], job % trials, seed);
    }
  };
  std::vector<std::thread> others;
  for (std::size_t i = 1; i < engines_.size(); ++i) others.emplace_back(work, i);
  work(0);
  for (std::thread& other : others) other.join();
  return costs;
}

std::vector<std::vector<Cost>> Team::Try(const std::vector<gait::Gains>& gains, int trials,
                                         std::uint64_t seed) {
  const auto per_gains = static_cast<std::size_t>(trials);
  const auto shared = ranks_.Share(TryOwn(gains, per_gains, seed));
  std::vector<std::vector<Cost>> costs(gains.size(), std::vector<Cost>(per_gains));
  for (std::size_t job = 0; job < gains.size() * per_gains; ++job) {
    costs[job / per_gains][job % per_gains] = shared[job % shared.size()][job / shared.size()];
  }
  return costs;
}

Score ScoreOf(const std::vector<Cost>& costs) {
  Score score;
  score.trials = static_cast<int>(costs.size());
  const auto n = static_cast<double>(costs.size());
  for (const Cost& cost : costs) {
    score.mean.failure += cost.failure / n;
    score.mean.speed += cost.speed / n;
    score.mean.flight += cost.flight / n;
    score.mean.stance += cost.stance / n;
    score.mean.stride += cost.stride / n;
    score.mean.heading += cost.heading / n;
    score.mean.legs += cost.legs / n;
    score.mean.latency += cost.latency / n;
    score.falls += cost.failure > 0 ? 1 : 0;
  }
  score.survival = 1 - score.falls / n;
  score.total_half_width =
      MeanOf(costs.size(), [&costs](std::size_t i) { return costs[i].total(); }).half_width;
  return score;
}

Difference Compare(const std::vector<Cost>& now, const std::vector<Cost>& before) {
  return MeanOf(now.size(), [&](std::size_t i) { return now[i].total() - before[i].total(); });
}

}  // namespace footing::tune
