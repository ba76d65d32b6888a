#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/result/result.h"
#include "daemon/simulation/engine/engine.h"
#include "footing/v1/character.pb.h"
#include "footing/v1/command.pb.h"

namespace footing::gait_service {

/// All failures of a run with what was corrected about them since. Nothing is forgotten: a failure
/// that was withdrawn only does not count.
class FailureRecord {
 public:
  /// Remembers a failure; `trial` is the id of its trial.
  v1::Failure Add(const engine::EngineEvent& event, const std::string& trial);

  /// Withdraws or restores a failure. Fails when there is none of that number.
  Result<void> Correct(const v1::CorrectFailure& message);
  /// The corrections since the last call, as events without a time.
  std::vector<v1::Event> TakeCorrections();

  /// Takes out of the counts what was withdrawn, of all failures or of those of one trial.
  void Subtract(v1::FailureCounts& counts) const;
  void Subtract(std::uint64_t trial_number, v1::FailureCounts& counts) const;
  std::uint64_t Withdrawn(std::uint64_t trial_number) const;

 private:
  struct Entry {
    v1::Failure failure;
    std::uint64_t trial_number = 0;
    bool in_trial = false;
  };

  std::map<std::uint64_t, Entry> entries_;  ///< By their numbers.
  std::vector<v1::Event> corrections_;
};

}  // namespace footing::gait_service
