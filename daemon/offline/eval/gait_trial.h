#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "daemon/simulation/engine/engine.h"
#include "daemon/simulation/biped/world.h"

namespace footing::eval {

/// Random numbers that are the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double Uniform(double min, double max) {
    constexpr double kSteps = 9007199254740992.0;  // 2^53
    return min + (max - min) * static_cast<double>(engine_() >> 11) / kSteps;
  }

 private:
  std::mt19937_64 engine_;
};

/// A number for the seed of one trial.
std::uint64_t TrialSeed(std::uint64_t seed, int trial);

/// "random" or a number; a random one is drawn from the system and printed to standard error.
Result<std::uint64_t> ParseSeed(const std::string& text);

/// Gait tables (gain_table.h) that every engine made after this reads after the product's own. The
/// command line's, said once for the whole process.
void ReadGainsToo(std::vector<std::string> paths);

/// An engine on the straight track, from the product's data files.
Result<engine::GaitEngine> NewEngine();
/// An engine on a track given as text, for a user interface with the mapping table of this path;
/// empty: the built-in one.
Result<engine::GaitEngine> NewEngineOn(const std::string& track,
                                       const mapping::InterfaceOptions& interface = {},
                                       const std::string& mapping_table = "");
/// The world of NewEngine's engine alone, or of one on a track; its feet are not listed as pairs.
Result<physics::World> NewWorld(const std::optional<std::string>& track = std::nullopt);

/// An engine driven by direct commands, with what one wants to know of it.
class Walker {
 public:
  explicit Walker(engine::GaitEngine& engine) : engine_(engine) {}

  void Command(const biped::GaitCommand& command);
  /// Pushes the body over the 0.1 s that follow; in an engine restored to an earlier step a push
  /// needs a number that its state has not seen.
  void Push(double impulse_ns, double direction_rad);
  void Push(double impulse_ns, double direction_rad, std::uint64_t number);
  /// One step; reads the output every step.
  const engine::EngineOutput& Advance();
  bool fell() const { return output_ != nullptr && output_->gait.falls > 0; }
  /// Least gap between the legs so far, m (leg_gap.h); without falls and what follows them.
  double leg_gap_min_m() const { return leg_gap_min_m_; }
  const engine::EngineInputs& inputs() const { return inputs_; }

 private:
  engine::GaitEngine& engine_;
  engine::EngineInputs inputs_;
  const engine::EngineOutput* output_ = nullptr;
  double leg_gap_min_m_ = INFINITY;
};

}  // namespace footing::eval
