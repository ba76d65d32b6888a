#include "daemon/offline/tune/team.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <thread>

#include <Eigen/Eigenvalues>
#include <nlohmann/json.hpp>

#include "common/base/units.h"
#include "common/runtime/files.h"
#include "common/virtual/devices/noise.h"
#include "daemon/simulation/biped/model.h"
#include "daemon/simulation/gait_service/config.h"

namespace footing::tune {
namespace {

using stream::Gait;

/// The controller keeps the legs' axes 7 cm apart (CurveGains::leg_gap_m), 4 cm of it legs.
constexpr double kLegGapM = 0.03;

double Square(double value) { return value * value; }

/// A trial that fell before it showed one whole flight, stance or stride says nothing of it; the
/// fall is charged already.
double Deviation(double seen, double wanted) {
  if (seen <= 0) return 0;
  return std::min(1.0, 0.25 * Square((seen / wanted - 1) / 0.1));
}

}  // namespace

Wanted WantedOf(const Task& task, double height_m) {
  const auto strides = [&task](double flight_s, double stance_s, double stride_s) {
    return Wanted{flight_s, stance_s, task.speed_mps * stride_s, 0.6 + 0.1 * task.speed_mps};
  };
  switch (task.gait) {
    case Gait::kRun: {
      const double flight_s = 0.28, stance_s = 0.25 - 0.024 * task.speed_mps;
      return strides(flight_s, stance_s, 2 * (flight_s + stance_s));
    }
    case Gait::kJump: {
      const double flight_s = 2 * std::sqrt(2 * height_m / kStandardGravityMps2), stance_s = 0.18;
      return strides(flight_s, stance_s, flight_s + stance_s);
    }
    case Gait::kStep:
    case Gait::kWalk:
    case Gait::kUnspecified:
      return strides(0.32, 0.40, 0.72);
  }
  return {};
}

Cost CostOf(const Task& task, const TrialResult& result, double weight_n) {
  const Wanted wanted = WantedOf(task, result.height_m);
  Cost cost;
  cost.failure = result.survived < 1 ? 10 + 10 * (1 - result.survived) : 0;
  if (task.paper && result.survived == 1 && !result.reached) cost.failure = 10;
  cost.speed = std::min(2.0, Square(result.speed_error_mps / 0.15));
  if (task.style) {
    cost.style = StyleCostOf(task.gait, result.style, weight_n, result.steady);
  } else {
    cost.flight = Deviation(result.flight_s, wanted.flight_s);
    cost.stance = Deviation(result.stance_s, wanted.stance_s);
    if (task.speed_mps >= 0.3) cost.stride = Deviation(result.stride_m, wanted.stride_m);
  }
  cost.heading = std::min(2.0, Square(RadiansToDegrees(result.heading_error_rad) / 5));
  if (task.gait == Gait::kRun) {
    cost.legs = std::min(2.0, Square(std::max(0.0, 1 - result.leg_gap_m / kLegGapM)));
    if (task.paper) return cost;
    const double late = std::max(0.0, result.latency_s / wanted.latency_s - 1);
    cost.latency = std::min(2.0, Square(late / 0.1));
  }
  return cost;
}

namespace {

constexpr double kDifference = 0.5;
constexpr std::array kLengths{0.25, 0.5, 1.0, 2.0};
constexpr double kLongestStep = 4, kShortestStep = 0.05;

}  // namespace

SearchState StartSearch(int dimensions, double step) {
  SearchState state;
  state.step = step;
  state.point = Eigen::VectorXd::Zero(dimensions);
  state.covariance = Eigen::MatrixXd::Identity(dimensions, dimensions);
  state.covariance_path = state.step_path = Eigen::VectorXd::Zero(dimensions);
  return state;
}

void Descend(SearchState& state, const Evaluate& evaluate) {
  const auto batch = static_cast<std::uint64_t>(state.iteration);
  const Eigen::Index n = state.point.size();
  std::vector<Eigen::VectorXd> points(static_cast<std::size_t>(n) + 1, state.point);
  for (Eigen::Index i = 0; i < n; ++i) points[static_cast<std::size_t>(i) + 1][i] += kDifference;
  const std::vector<double> values = evaluate(points, batch);
  const double here = values[0];
  Eigen::VectorXd downhill(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    downhill[i] = (here - values[static_cast<std::size_t>(i) + 1]) / kDifference;
  }
  double best = here;
  if (downhill.norm() > 0) {
    points.clear();
    for (const double length : kLengths) {
      points.push_back(state.point + length * state.step * downhill.normalized());
    }
    const std::vector<double> along = evaluate(points, batch);
    const auto lowest = std::min_element(along.begin(), along.end()) - along.begin();
    const auto index = static_cast<std::size_t>(lowest);
    if (along[index] < here) {
      best = along[index];
      state.point = points[index];
      state.step = std::clamp(state.step * kLengths[index], kShortestStep, kLongestStep);
    } else {
      state.step = std::max(state.step / 2, kShortestStep);
    }
  }
  state.history.push_back({state.iteration, here, best});
  ++state.iteration;
}

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The tutorial's table 1, for n dimensions.
struct Constants {
  explicit Constants(int dimensions) : n(dimensions) {
    offspring = 4 + static_cast<int>(3 * std::log(n));
    weights.resize(offspring / 2);
    for (int i = 0; i < weights.size(); ++i) {
      weights[i] = std::log((offspring + 1) / 2.0) - std::log(i + 1.0);
    }
    weights /= weights.sum();
    mu = 1 / weights.squaredNorm();
    step_rate = (mu + 2) / (n + mu + 5);
    step_damping = 1 + 2 * std::max(0.0, std::sqrt((mu - 1) / (n + 1)) - 1) + step_rate;
    path_rate = (4 + mu / n) / (n + 4 + 2 * mu / n);
    rank_one = 2 / ((n + 1.3) * (n + 1.3) + mu);
    rank_mu = std::min(1 - rank_one, 2 * (mu - 2 + 1 / mu) / ((n + 2) * (n + 2) + mu));
    expected_norm = std::sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n));
  }

  double n;
  int offspring;
  VectorXd weights;
  double mu, step_rate, step_damping, path_rate, rank_one, rank_mu, expected_norm;
};

}  // namespace

void Evolve(SearchState& state, const Evaluate& evaluate, std::uint64_t seed) {
  const Constants c(static_cast<int>(state.point.size()));
  const auto batch = static_cast<std::uint64_t>(state.iteration);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> axes(state.covariance);
  const MatrixXd& B = axes.eigenvectors();
  const VectorXd D = axes.eigenvalues().cwiseMax(1e-12).cwiseSqrt();

  noise::Random random(seed * 6364136223846793005u + batch);
  std::vector<VectorXd> moves, points;
  for (int k = 0; k < c.offspring; ++k) {
    VectorXd z(state.point.size());
    for (double& value : z) value = random.Normal();
    moves.push_back(B * D.asDiagonal() * z);
    points.push_back(state.point + state.step * moves.back());
  }
  points.push_back(state.point);
  const std::vector<double> values = evaluate(points, batch);
  std::vector<std::size_t> order(moves.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&values](std::size_t a, std::size_t b) { return values[a] < values[b]; });

  VectorXd mean_move = VectorXd::Zero(state.point.size());
  MatrixXd rank_mu = MatrixXd::Zero(state.point.size(), state.point.size());
  for (int i = 0; i < c.weights.size(); ++i) {
    const VectorXd& move = moves[order[static_cast<std::size_t>(i)]];
    mean_move += c.weights[i] * move;
    rank_mu += c.weights[i] * move * move.transpose();
  }
  state.point += state.step * mean_move;
  state.step_path = (1 - c.step_rate) * state.step_path +
                    std::sqrt(c.step_rate * (2 - c.step_rate) * c.mu) *
                        (B * D.cwiseInverse().asDiagonal() * B.transpose() * mean_move);
  const double length = state.step_path.norm();
  const double settled = std::sqrt(1 - std::pow(1 - c.step_rate, 2 * (state.iteration + 1)));
  const double follows = length / settled < (1.4 + 2 / (c.n + 1)) * c.expected_norm ? 1 : 0;
  state.covariance_path = (1 - c.path_rate) * state.covariance_path +
                          follows * std::sqrt(c.path_rate * (2 - c.path_rate) * c.mu) * mean_move;
  const double kept =
      1 - c.rank_one - c.rank_mu + (1 - follows) * c.rank_one * c.path_rate * (2 - c.path_rate);
  state.covariance = kept * state.covariance +
                     c.rank_one * state.covariance_path * state.covariance_path.transpose() +
                     c.rank_mu * rank_mu;
  state.step *= std::exp(c.step_rate / c.step_damping * (length / c.expected_norm - 1));

  state.history.push_back({state.iteration, values.back(), values[order.front()]});
  ++state.iteration;
}

namespace {

constexpr double kCoefficient = 0.25;  // Springs and dampers by about a quarter.
constexpr double kLength = 0.02;       // Lengths by 2 %.

const std::vector<DimensionRow> kEveryGait{{"servo.hip_stiffness_nm_per_rad", kCoefficient},
                                           {"servo.hip_damping_nms_per_rad", kCoefficient},
                                           {"attitude.roll_stiffness_nm_per_rad", kCoefficient},
                                           {"attitude.roll_damping_nms_per_rad", kCoefficient},
                                           {"attitude.pitch_stiffness_nm_per_rad", kCoefficient},
                                           {"attitude.pitch_damping_nms_per_rad", kCoefficient}};
const std::vector<DimensionRow> kOnTheGround{
    {"attitude.walk_yaw_stiffness_nm_per_rad", kCoefficient},
    {"attitude.walk_yaw_damping_nms_per_rad", kCoefficient},
    {"walking.leg_stiffness_n_per_m", kCoefficient},
    {"walking.leg_damping_ns_per_m", kCoefficient},
    {"walking.hip_height_m", kLength},
    {"walking.step_width_m", 0.15}};
const std::vector<DimensionRow> kInHops{{"hopping.touchdown_length_m", kLength}};
const std::vector<DimensionRow> kRunning{{"attitude.run_yaw_stiffness_nm_per_rad", kCoefficient},
                                         {"attitude.run_yaw_damping_nms_per_rad", kCoefficient},
                                         {"hopping.run_leg_stiffness_n_per_m", kCoefficient},
                                         {"hopping.run_leg_damping_ns_per_m", kCoefficient},
                                         {"hopping.run_velocity_gain_s", 0.15},
                                         {"hopping.speed_gain_s", 0.003, false},
                                         {"hopping.run_foot_spacing_m", kCoefficient},
                                         {"recovery.idle_yield", kCoefficient}};
const std::vector<DimensionRow> kJumping{{"attitude.jump_yaw_stiffness_nm_per_rad", kCoefficient},
                                         {"attitude.jump_yaw_damping_nms_per_rad", kCoefficient},
                                         {"hopping.jump_leg_stiffness_n_per_m", kCoefficient},
                                         {"hopping.jump_leg_damping_ns_per_m", kCoefficient},
                                         {"hopping.jump_velocity_gain_s", 0.15},
                                         {"attitude.jump_lean_rad_per_mps", 0.03, false},
                                         {"recovery.spread_mps", kCoefficient}};
/// Tuned by the paper: springs and dampers, the constants of equation (1), and the landing length;
/// besides, lengths that its text leaves open.
const std::vector<DimensionRow> kPaperOnTheGround{{"walking.leg_stiffness_n_per_m", kCoefficient},
                                                  {"walking.leg_damping_ns_per_m", kCoefficient},
                                                  {"paper.walk_offset_rad", 0.02, false},
                                                  {"paper.walk_offset_side_rad", 0.01, false},
                                                  {"paper.walk_gain_rad_per_mps", 0.15},
                                                  {"paper.walk_side_gain_rad_per_mps", 0.15},
                                                  {"paper.touchdown_length_m", kLength},
                                                  {"paper.swing_length_m", kLength},
                                                  {"paper.fall_extension_m", 0.005, false},
                                                  {"paper.rear_extension_m", 0.005, false},
                                                  {"paper.rise_passed_m", 0.03, false},
                                                  {"paper.rise_sideways_mps", 0.02, false},
                                                  {"paper.reach_mps", kCoefficient},
                                                  {"paper.step_below_mps", kCoefficient},
                                                  {"paper.thrust_extension_m", 0.01, false}};
const std::vector<DimensionRow> kPaperRunning{
    {"hopping.run_leg_stiffness_n_per_m", kCoefficient},
    {"paper_hop.run_side_gain_s", 0.15},
    {"hopping.run_leg_damping_ns_per_m", kCoefficient},
    {"hopping.run_velocity_gain_s", 0.15},
    {"hopping.run_foot_spacing_m", kCoefficient},
    {"hopping.idle_length_m", 0.05},
    {"paper_hop.run_extension_m", 0.005, false},
    {"paper_hop.leaving_extension_m", 0.005, false},
    {"paper_hop.landing_extension_m", 0.01, false},
    {"paper_hop.leap_extension_m", 0.01, false},
    {"transition.run_to_walk_mps", 0.1},
    {"transition.run_to_walk_margin_mps", 0.2},
    {"transition.run_landing_stiffness_n_per_m", kCoefficient},
    {"transition.run_landing_damping_ns_per_m", kCoefficient}};
const std::vector<DimensionRow> kPaperJumping{{"hopping.jump_leg_stiffness_n_per_m", kCoefficient},
                                              {"hopping.jump_leg_damping_ns_per_m", kCoefficient},
                                              {"hopping.jump_velocity_gain_s", 0.15},
                                              {"paper_hop.jump_extension_share", 0.01, false},
                                              {"paper_hop.landing_shortening_m", 0.01, false}};

}  // namespace

std::vector<Dimension> DimensionsOf(Gait gait, bool paper) {
  std::vector<Dimension> dimensions;
  const auto add = [&dimensions](const std::vector<DimensionRow>& rows) {
    AddDimensions(rows, dimensions);
  };
  add(kEveryGait);
  switch (gait) {
    case Gait::kRun:
      add(kInHops);
      add(paper ? kPaperRunning : kRunning);
      break;
    case Gait::kJump:
      add(kInHops);
      add(paper ? kPaperJumping : kJumping);
      break;
    case Gait::kStep:
    case Gait::kWalk:
    case Gait::kUnspecified:
      add(paper ? kPaperOnTheGround : kOnTheGround);
      break;
  }
  return dimensions;
}

gait::Gains GainsAt(const gait::Gains& start, const std::vector<Dimension>& dimensions,
                    const Eigen::VectorXd& point) {
  gait::Gains gains = start;
  for (std::size_t i = 0; i < dimensions.size(); ++i) {
    const Dimension& dimension = dimensions[i];
    const double step = dimension.scale * point[static_cast<Eigen::Index>(i)];
    double& value = dimension.gain->of(gains);
    value = dimension.relative ? value * std::exp(step) : value + step;
    value = std::clamp(value, dimension.gain->min, dimension.gain->max);
  }
  return gains;
}

namespace {

constexpr std::size_t kStarts = 12;  // For each task one at least.
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

Result<Team> Team::Create(int threads, ranks::Ranks ranks, const std::vector<std::string>& gains,
                          bool styled) {
  Result<engine::EngineTexts> texts =
      styled ? engine_files::ReadTexts()
             : engine_files::ReadTexts({.gaits = "plain", .more_gains = gains});
  if (!texts) return texts.error();
  if (styled) {
    for (const std::string& path : gains) {
      Result<std::string> text = config::ReadTextFile(path);
      if (!text) return text.error();
      texts->style.push_back({path, std::move(*text)});
    }
  }
  const auto biped = biped::ParseBiped(texts->biped, engine::kBipedFile);
  if (!biped) return biped.error();
  Team team;
  team.ranks_ = ranks;
  team.texts_ = *texts;
  team.styled_ = styled;
  team.weight_n_ = biped->mass_kg() * kStandardGravityMps2;
  for (int i = 0; i < threads; ++i) {
    Result<engine::GaitEngine> engine = engine::GaitEngine::Create(*texts);
    if (!engine) return engine.error();
    team.engines_.push_back(std::move(engine).value());
  }
  return team;
}

Result<void> Team::Prepare(const std::vector<Task>& tasks, const gait::GainTable& table,
                           std::uint64_t seed, std::vector<gait::GainSet> others) {
  const std::size_t each = std::max<std::size_t>(2, kStarts / tasks.size());
  std::vector<std::vector<engine::EngineState>> settled;
  for (const Task& task : tasks) {
    Result<engine::GaitEngine> engine = engine::GaitEngine::Create(texts_);
    if (!engine) return engine.error();
    Use(table, *engine);
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

void Team::Use(const gait::GainTable& table, engine::GaitEngine& engine) const {
  if (styled_) {
    engine.UseStyle(table);
  } else {
    engine.UseGains(table);
  }
}

Cost Team::TryOne(engine::GaitEngine& engine, const gait::Gains& gains, std::size_t trial,
                  std::uint64_t seed) const {
  gait::GainTable table = table_;
  const auto& [task, start] = starts_[trial % starts_.size()];
  const Disturbance disturbance = Draw(task, MixSeeds(seed, trial));
  const stream::Gait tried = starts_.front().task.gait;
  if (task.paper || task.style || disturbance.change_s > 0) {
    table.Set(tried, WholeTable(gains));
  } else {
    table.Set(tried, {{"tried", 0, gains}});
  }
  Use(table, engine);
  if (disturbance.pit_m == 0) {
    return CostOf(task, RunTrial(engine, start, task, disturbance), weight_n_);
  }
  engine::GaitEngine on_pit = OnTrack(PitTrack(start, disturbance));
  Use(table, on_pit);
  return CostOf(task, RunTrial(on_pit, start, task, disturbance), weight_n_);
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
    AddShare(cost.style, 1 / n, score.mean.style);
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

namespace {

using nlohmann::json;

json ToJson(const RunKey& key) {
  return {{"gait", key.gait},     {"speeds_mps", key.speeds_mps},
          {"seed", key.seed},     {"method", key.method},
          {"trials", key.trials}, {"step", key.step},
          {"style", key.style},   {"from", key.from}};
}

std::vector<double> Numbers(const Eigen::MatrixXd& matrix) {
  return {matrix.data(), matrix.data() + matrix.size()};
}

json ToJson(const SearchState& search) {
  json history = json::array();
  for (const HistoryPoint& point : search.history) {
    history.push_back({point.iteration, point.objective, point.best});
  }
  return {{"iteration", search.iteration},
          {"point", Numbers(search.point)},
          {"step", search.step},
          {"covariance", Numbers(search.covariance)},
          {"covariance_path", Numbers(search.covariance_path)},
          {"step_path", Numbers(search.step_path)},
          {"history", history}};
}

Eigen::MatrixXd Matrix(const json& numbers, Eigen::Index rows, Eigen::Index columns) {
  const auto values = numbers.get<std::vector<double>>();
  if (static_cast<Eigen::Index>(values.size()) != rows * columns)
    throw json::other_error::create(501, "wrong size", nullptr);
  return Eigen::Map<const Eigen::MatrixXd>(values.data(), rows, columns);
}

SearchState FromJson(const json& kept) {
  SearchState search;
  search.iteration = kept.at("iteration");
  search.step = kept.at("step");
  const auto n = static_cast<Eigen::Index>(kept.at("point").size());
  search.point = Matrix(kept.at("point"), n, 1);
  search.covariance = Matrix(kept.at("covariance"), n, n);
  search.covariance_path = Matrix(kept.at("covariance_path"), n, 1);
  search.step_path = Matrix(kept.at("step_path"), n, 1);
  for (const json& point : kept.at("history")) {
    search.history.push_back({point.at(0), point.at(1), point.at(2)});
  }
  return search;
}

}  // namespace

std::string KeepRun(const RunKey& key, const std::vector<SearchState>& searches) {
  json kept = {{"version", 1}, {"key", ToJson(key)}, {"searches", json::array()}};
  for (const SearchState& search : searches) kept["searches"].push_back(ToJson(search));
  return kept.dump(1) + "\n";
}

Result<std::vector<SearchState>> ResumeRun(const std::string& text, const RunKey& key,
                                           const std::string& path) {
  const json kept = json::parse(text, nullptr, false);
  if (!kept.is_object() || !kept.contains("key") || !kept["key"].is_object()) {
    return InvalidData(path + " is not a state file of footing-tune; remove it to start again");
  }
  const json wanted = ToJson(key);
  for (const auto& [name, value] : wanted.items()) {
    if (kept["key"].value(name, json()) == value) continue;
    return InvalidData(path + " is of a run with another " + name +
                       "; remove it to start again, or name another --out");
  }
  try {
    std::vector<SearchState> searches;
    for (const json& search : kept.at("searches")) searches.push_back(FromJson(search));
    return searches;
  } catch (const json::exception& error) {
    return InvalidData(path + " is damaged (" + error.what() + "); remove it to start again");
  }
}

}  // namespace footing::tune
