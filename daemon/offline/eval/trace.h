#pragma once

#include <fstream>
#include <string>

#include "common/base/result.h"
#include "daemon/simulation/engine/engine.h"

namespace footing::eval {

/// A CSV of what a trial's user meant, what the interface made of it and what the character did:
/// one row per look of the user (10 ms), a row of units under the names.
class TrackTrace {
 public:
  /// Nothing is written to an empty path. Fails when the file cannot be created.
  static Result<TrackTrace> Create(const std::string& path);

  /// The rows that follow are of this trial.
  void Begin(std::uint64_t seed) { seed_ = seed; }
  void Add(stream::Gait wanted, stream::Gait meant, double turn_rad,
           const engine::EngineOutput& output);
  /// Whether all rows so far are in the file: fails where the disk is full.
  Result<void> Flush();

 private:
  Error CannotWrite() const;

  std::string path_;
  int error_ = 0;  ///< errno of the first row that could not be written.
  std::ofstream file_;
  std::uint64_t seed_ = 0;
};

}  // namespace footing::eval
