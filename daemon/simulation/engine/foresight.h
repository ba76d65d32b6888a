#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/result.h"
#include "common/stream/character.h"
#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/biped/model.h"
#include "daemon/simulation/biped/world.h"
#include "daemon/simulation/gait/gain_table.h"
#include "daemon/simulation/gait/targets.h"

/// A character out of its rhythm tries gains on a copy of itself before it takes its next step:
/// docs/gait.md, "Foresight".
namespace footing::engine {

/// A way to go on: gains of one gait, each times a factor.
struct GainChoice {
  std::string name;
  std::vector<std::pair<const gait::GainField*, double>> factors;
};

/// The choices of each gait, in the order of stream::kGaits. A gait without any has no foresight.
using GainChoices = std::array<std::vector<GainChoice>, stream::kGaits.size()>;

/// Reads a table: lines that are empty or begin with # are skipped, then gait,choice,gain,factor,
/// one row a factor. Rows that follow each other with one name are one choice; the first one of a
/// gait is tried first. `origin` names the file in errors.
Result<GainChoices> ReadChoices(std::string_view text, const std::string& origin);

/// Tables that the gains come from.
struct GainTables {
  gait::GainTable plain;
  gait::GainTable style;  ///< The same with style; a gait without sets has none.
  GainChoices choices;
};

/// A choice that is in force while its gait runs; number 0 are the gains as they are.
struct ChosenGains {
  stream::Gait gait = stream::Gait::kUnspecified;
  int number = 0;

  bool operator==(const ChosenGains&) const = default;
};

/// The gains of the present step; looked up when what they depend on changes.
class GainsInForce {
 public:
  /// Notes in the memory whether its gait has a style.
  const gait::Gains& At(const GainTables& tables, const ChosenGains& chosen,
                        gait::GaitMemory& memory);
  void Forget() { gait_ = stream::Gait::kUnspecified; }

 private:
  gait::Gains gains_;
  stream::Gait gait_ = stream::Gait::kUnspecified;
  double speed_mps_ = 0;
  double style_ = 0;
  ChosenGains chosen_;
};

/// A character as of one step, to go on from.
struct Outlook {
  physics::WorldState world;
  gait::GaitMemory gait;
  std::uint64_t step = 0;
};

/// Where rollouts take place, and what stays as it is meanwhile. Borrowed for the call.
struct Stage {
  const biped::BipedParameters& biped;
  const GainTables& tables;
  const stream::Track& track;
  const stream::Track* sight;  ///< As gait::Context's seen_ground.
  const biped::GaitCommand& command;
  const Eigen::Vector3d& tow_W_n;  ///< That goes on.
  double step_s;
  physics::World& twin;  ///< Left where the last rollout ended.
  GainsInForce& gains;
};

/// Result of the rollouts.
struct Foresight {
  ChosenGains chosen;
  std::uint64_t stands_until = 0;  ///< Step until which it does, if nothing comes from outside.
};

/// Each rollout looks this far ahead. Shorter ones miss what a bad landing leads to.
inline constexpr double kHorizonS = 0.9;
/// Together they take this many steps at most. In the worst case, at every phase of a run that
/// falls whatever it does, that is 70 steps for one.
inline constexpr int kMostSteps = 6000;

/// The choice with which the character stands longest, by rollouts from its present state: its
/// gains as they are, if it stands with these, or else the first choice with which it does. The
/// same state leads to the same choice. Allocates nothing.
Foresight ChooseAhead(const Outlook& now, const Stage& stage);

/// Gait whose gains hold: running's in a thrust out of walking.
stream::Gait GaitOf(const gait::GaitMemory& memory);

/// Number of the phase of the machine that runs: another one after a touchdown, a lift-off or
/// another change.
int PhaseOf(const gait::GaitMemory& memory);

}  // namespace footing::engine
