#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/simulation/lease/lease.h"
#include "footing/v1/character.pb.h"
#include "footing/v1/command.pb.h"

namespace footing::gait_service {

/// The lease in the messages of the protocol, on the io thread.
class LeaseControl {
 public:
  /// True for TakeLease and ReleaseLease.
  static bool Takes(const v1::Command& command);
  v1::CommandResult OnCommand(const v1::Command& command, std::uint64_t session,
                              std::int64_t now_ns);
  /// The answer to a command that another session's lease forbids: one that starts, stops or
  /// corrects a trial, puts the character back or changes the interface. Nothing for all others.
  std::optional<v1::CommandResult> Refusal(const v1::Command& command, std::uint64_t session,
                                           std::int64_t now_ns) const;

  void EndSession(std::uint64_t session) { lease_.EndSession(session); }
  /// Ends a lease whose time is over; what happened to it since the last call, as events.
  std::vector<v1::Event> TakeEvents(std::int64_t now_ns);
  const std::string& holder() const { return lease_.holder(); }

 private:
  lease::Lease lease_;
};

}  // namespace footing::gait_service
