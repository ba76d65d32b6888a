#pragma once

#include <string>
#include <vector>

#include "daemon/offline/compute/ranks.h"
#include "daemon/offline/tune/objective.h"
#include "daemon/offline/tune/search.h"
#include "daemon/offline/tune/search_space.h"

namespace footing::tune {

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
  /// this rank.
  static Result<Team> Create(int threads, ranks::Ranks ranks = {},
                             const std::vector<std::string>& gains = {});

  const ranks::Ranks& ranks() const { return ranks_; }

  /// Makes the states in which the trials begin, under `table`, for each task as many. All tasks
  /// are of one gait, the first at the tried set's own speed. `others` are the sets beside it, by
  /// rising speeds, for trials that change their speed.
  Result<void> Prepare(const std::vector<Task>& tasks, const gait::GainTable& table,
                       std::uint64_t seed, std::vector<gait::GainSet> others = {});

  /// Costs of `trials` trials for each of the gains, gains by gains, all on the same trials, which
  /// `seed` draws.
  std::vector<std::vector<Cost>> Try(const std::vector<gait::Gains>& gains, int trials,
                                     std::uint64_t seed);

 private:
  Team() = default;
  engine::GaitEngine OnTrack(std::string track) const;

  /// The jobs of this rank, on all of its threads.
  std::vector<Cost> TryOwn(const std::vector<gait::Gains>& gains, std::size_t trials,
                           std::uint64_t seed);
  std::vector<gait::GainSet> WholeTable(const gait::Gains& gains) const;
  Cost TryOne(engine::GaitEngine& engine, const gait::Gains& gains, std::size_t trial,
              std::uint64_t seed) const;

  ranks::Ranks ranks_;
  engine::EngineTexts texts_;

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

Score ScoreOf(const std::vector<Cost>& costs);

/// Mean difference of the totals, trial by trial, and the half width of its 95 % interval.
struct Difference {
  double mean = 0;
  double half_width = 0;
};
Difference Compare(const std::vector<Cost>& now, const std::vector<Cost>& before);

}  // namespace footing::tune
