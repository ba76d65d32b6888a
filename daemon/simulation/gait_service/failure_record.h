#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/stream/trial.h"
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

  /// The failures that are withdrawn at present: all of them, or those of one trial.
  const stream::FailureCounts& withdrawn() const { return withdrawn_; }
  stream::FailureCounts WithdrawnOf(std::uint64_t trial_number) const;

 private:
  struct Entry {
    v1::Failure failure;
    std::uint64_t trial_number = 0;
    bool in_trial = false;
  };

  /// Of an entry that was withdrawn or restored just now.
  void CountWithdrawn(const Entry& entry);

  std::map<std::uint64_t, Entry> entries_;  ///< By their numbers.
  stream::FailureCounts withdrawn_;
  std::map<std::uint64_t, stream::FailureCounts> withdrawn_of_;  ///< By the numbers of trials.
  std::vector<v1::Event> corrections_;
};

}  // namespace footing::gait_service
