#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/net/lease.h"
#include "footing/v1/command.pb.h"

namespace footing::lease {

/// A server's lease in the messages of the protocol, on the io thread.
class LeaseControl {
 public:
  /// `server`: "footingd" or "footing-sim".
  explicit LeaseControl(std::string server) : lease_(std::move(server)) {}

  /// The answer to TakeLease and ReleaseLease, and to a command that another session's lease
  /// forbids: each that changes something. Nothing for all others: they may be carried out. The
  /// answer has no id yet.
  std::optional<v1::CommandResult> Answer(const v1::Command& command, std::uint64_t session,
                                          std::int64_t now_ns);

  void EndSession(std::uint64_t session) { lease_.EndSession(session); }
  /// Ends a lease whose time is over; what happened to it since the last call, for a person.
  std::vector<std::string> TakeChanges(std::int64_t now_ns);
  const std::string& holder() const { return lease_.holder(); }

 private:
  Lease lease_;
};

}  // namespace footing::lease
