#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "daemon/offline/compute/ranks.h"
#include "daemon/offline/tune/dimension.h"
#include "daemon/offline/tune/style_terms.h"
#include "daemon/offline/tune/trial.h"
#include "daemon/simulation/gait/gain_table.h"

namespace footing::tune {

/// The terms of the paper's objective (section 5, Optimization), each at least 0, lower is better.
/// The paper names what it evaluates and gives no weights; these are ours. A trial that turns has
/// no change of gait, so heading and latency never come together.
struct Cost {
  double failure = 0;  ///< A fall: 10 + 10 (1 - fraction survived), more than all else can be; the
                       ///< paper's laws: 10 where a gait was not reached.
  double speed = 0;    ///< (speed error / 0.15 m/s)^2, at most 2.
  double flight = 0;   ///< Flight or swing: 0.25 (relative deviation / 10 %)^2, at most 1.
  double stance = 0;   ///< As flight.
  double stride = 0;   ///< As flight; left out below 0.3 m/s, where a stride has no length.
  double heading = 0;  ///< Turning: (heading error / 5 degrees)^2, at most 2.
  double legs = 0;  ///< Running: (what the gap lacks of 3 cm / 3 cm)^2, at most 2; 1: they touch.
  double latency = 0;  ///< Change to walking: (what is more than wanted / 10 %)^2, at most 2.
  StyleCost style;     ///< With style; in place of flight, stance and stride.

  double total() const {
    return failure + speed + flight + stance + stride + heading + legs + latency + style.total();
  }
};

/// Durations that are aimed at.
struct Wanted {
  double flight_s, stance_s, stride_m, latency_s;
};

/// Those of the gaits as tuned by hand, so that a better score is robustness and obedience, not
/// another look. Step and walk: swing 0.32 s, stance 0.40 s. Run: flight 0.28 s, stance 0.20 s at
/// 2 m/s, 0.13 s at 5. Jump: the flight of the commanded height, stance 0.18 s. From running to
/// walking: 0.6 s and 0.1 s for each m/s, which their medians are from 3.5 to 6 m/s.
Wanted WantedOf(const Task& task, double height_m);

/// Cost of one trial of a task; `weight_n` is the biped's, for its cost of transport.
Cost CostOf(const Task& task, const TrialResult& result, double weight_n = 1);

/// One iteration of a search, for the plot.
struct HistoryPoint {
  int iteration = 0;
  double objective = 0;  ///< At the present point, on this iteration's trials.
  double best = 0;       ///< Best of all points tried on them.
};

/// Everything a search remembers: a plain value, so that it can be kept and gone on with.
struct SearchState {
  int iteration = 0;
  Eigen::VectorXd point;  ///< The answer so far; CMA-ES: the mean.
  double step = 1;        ///< Step of the line search; CMA-ES: sigma.
  // CMA-ES alone:
  Eigen::MatrixXd covariance;
  Eigen::VectorXd covariance_path, step_path;
  std::vector<HistoryPoint> history;
};

/// Mean objective of each point. All points of one call meet the same trials (common random
/// numbers); another `batch` means other trials.
using Evaluate = std::function<std::vector<double>(const std::vector<Eigen::VectorXd>& points,
                                                   std::uint64_t batch)>;

/// A search of so many dimensions about 0, with its first `step`.
SearchState StartSearch(int dimensions, double step = 1);

/// One step of steepest descent: the gradient by finite differences of half a unit, then the best
/// of four lengths along it. Nothing better there: stays, and halves the step.
void Descend(SearchState& state, const Evaluate& evaluate);

/// One generation of CMA-ES (Hansen, "The CMA Evolution Strategy: A Tutorial", 2016, with its
/// default constants); drawn from `seed` and the iteration.
void Evolve(SearchState& state, const Evaluate& evaluate, std::uint64_t seed);

/// Parameters that the paper tunes: the servos' spring and damper coefficients, the constants of
/// equations (1) and (2), and the landing length. `paper`: of the paper's own laws.
std::vector<Dimension> DimensionsOf(stream::Gait gait, bool paper = false);

/// The gains at a point, 0 being `start`; kept within what a table may say.
gait::Gains GainsAt(const gait::Gains& start, const std::vector<Dimension>& dimensions,
                    const Eigen::VectorXd& point);

/// Means with the half width of their 95 % confidence interval.
struct Score {
  Cost mean;
  double total_half_width = 0;
  double survival = 0;  ///< Fraction of trials without a fall.
  int falls = 0;
  int trials = 0;
};

/// Threads with a world each, in one process or as many as MPI runs, that try gains out. What comes
/// out does not depend on how many.
class Team {
 public:
  /// Reads the product's data, with the files `gains` in place of its tables of the same gaits,
  /// since an engine begins with the gains that it is created with. One engine for each thread of
  /// this rank. `styled`: the gaits as they are shipped, with style and foresight; `gains` and all
  /// that is tried are tables of the style.
  static Result<Team> Create(int threads, ranks::Ranks ranks = {},
                             const std::vector<std::string>& gains = {}, bool styled = false);

  const ranks::Ranks& ranks() const { return ranks_; }

  /// Makes the states in which the trials begin, under `table`, for each task as many. All tasks
  /// are of one gait or change into it, the first at the tried set's own speed. `others` are the
  /// sets beside it, by rising speeds, for trials that change their speed.
  Result<void> Prepare(const std::vector<Task>& tasks, const gait::GainTable& table,
                       std::uint64_t seed, std::vector<gait::GainSet> others = {});

  /// Costs of `trials` trials for each of the gains, gains by gains, all on the same trials, which
  /// `seed` draws.
  std::vector<std::vector<Cost>> Try(const std::vector<gait::Gains>& gains, int trials,
                                     std::uint64_t seed);

 private:
  Team() = default;
  engine::GaitEngine OnTrack(std::string track) const;
  void Use(const gait::GainTable& table, engine::GaitEngine& engine) const;

  /// The jobs of this rank, on all of its threads.
  std::vector<Cost> TryOwn(const std::vector<gait::Gains>& gains, std::size_t trials,
                           std::uint64_t seed);
  std::vector<gait::GainSet> WholeTable(const gait::Gains& gains) const;
  Cost TryOne(engine::GaitEngine& engine, const gait::Gains& gains, std::size_t trial,
              std::uint64_t seed) const;

  ranks::Ranks ranks_;
  engine::EngineTexts texts_;
  bool styled_ = false;
  double weight_n_ = 0;

  std::vector<engine::GaitEngine> engines_;
  struct Start {
    Task task;
    engine::EngineState state;
  };
  std::vector<Start> starts_;  ///< The tasks take turns.
  gait::GainTable table_;
  double own_mps_ = 0;
  std::vector<gait::GainSet> others_;
};

/// Sums up the costs of a set of trials.
Score ScoreOf(const std::vector<Cost>& costs);

/// Mean difference of the totals, trial by trial, and the half width of its 95 % interval.
struct Difference {
  double mean = 0;
  double half_width = 0;
};
Difference Compare(const std::vector<Cost>& now, const std::vector<Cost>& before);

/// Key of a run: a kept one is gone on with only when all of it is the same.
struct RunKey {
  std::string gait;
  std::vector<double> speeds_mps;
  std::uint64_t seed = 1;
  std::string method;
  int trials = 0;
  double step = 1;
  bool style = false;
  std::string from;  ///< All gains it starts from, as text.

  bool operator==(const RunKey&) const = default;
};

/// As JSON text, to the last bit of every number.
std::string KeepRun(const RunKey& key, const std::vector<SearchState>& searches);

/// The searches of a kept run. Invalid data when the text is damaged or of another run; `path` is
/// named.
Result<std::vector<SearchState>> ResumeRun(const std::string& text, const RunKey& key,
                                           const std::string& path);

}  // namespace footing::tune
