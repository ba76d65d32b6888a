#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/stream/character.h"
#include "daemon/simulation/gait/gain_fields.h"

/// Gait tables as data: for each gait a few sets of gains, each for a speed.
namespace footing::gait {

/// The gains of one gait at one speed.
struct GainSet {
  std::string name;      ///< "slow", "fast", ...
  double speed_mps = 0;  ///< v_d at which the set holds as it is.
  Gains gains;
};

/// The sets of each gait, in the order of stream::kGaits.
using GainSets = std::array<std::vector<GainSet>, stream::kGaits.size()>;

/// The sets of every gait. A gait without any has the defaults of gains.h.
class GainTable {
 public:
  /// Reads one file (docs/tuning.md): lines that are empty or begin with # are left out, then
  /// come the columns' names (gait, set, speed_mps, and any of GainFields), a row with their units
  /// (- for text), and one row a set, the speeds of a gait rising. What it has for a gait replaces
  /// what the table had; a gain without a column keeps its default. `origin` names the file in
  /// errors.
  Result<void> Add(std::string_view text, const std::string& origin);

  void Set(stream::Gait gait, std::vector<GainSet> sets);
  const std::vector<GainSet>& SetsOf(stream::Gait gait) const;

  /// The gains of a gait at a desired speed: linear between the two nearest sets, the outermost
  /// set beyond. Walking and stepping take the laws of hopping from running's sets, for the thrust
  /// that leads there; running and jumping take those of walking from walking's.
  Gains At(stream::Gait gait, double desired_speed_mps) const;

 private:
  GainSets sets_;
};

/// A table's text, with `comment` (lines without #) before it and these columns only.
std::string WriteGains(stream::Gait gait, const std::vector<GainSet>& sets,
                       const std::vector<const GainField*>& columns, const std::string& comment);

}  // namespace footing::gait
