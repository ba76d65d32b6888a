#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/net/server.h"
#include "common/net/session.h"
#include "common/net/session_limits.h"
#include "footing/v1/command.pb.h"

namespace footing::transport {

/// All sessions of one server, in the order of their numbers: which have a place, and which an
/// administrator or a reload ends. Those that are being refused are among them.
class SessionTable {
 public:
  static constexpr std::int64_t kMostLingering = 64;  ///< Sessions that are being refused.

  explicit SessionTable(Shared& shared) : shared_(shared) {}

  const std::vector<std::shared_ptr<Session>>& all() const { return sessions_; }
  std::int64_t lingering() const;

  /// Why there is no place for one that is not in the table yet; empty when there is one. Makes
  /// place for it: the oldest connection of its host that has not said who it is gives way, and so
  /// does the oldest guess of a token.
  std::string WhyFull(const Session& session);
  void Add(const std::shared_ptr<Session>& session) { sessions_.push_back(session); }
  std::shared_ptr<Session> Remove(const Session& session);

  /// Other keys: ends the sessions that came in by what is gone, and returns how many.
  std::size_t SetKeys(const AccessKeys& keys);

  /// list_sessions and end_sessions.
  v1::CommandResult CarryOut(const SessionInfo& who, const v1::Command& command);

 private:
  SessionCounts CountsFor(const Session& one) const;
  bool EndAGuess(const std::optional<std::string>& host);
  void BoundGuesses(const std::string& host);
  void BoundEntering(const Session& session);
  v1::CommandResult List(const SessionInfo& who, std::uint64_t after) const;
  v1::CommandResult End(const SessionInfo& who, const v1::EndSessions& wish);

  Shared& shared_;
  std::vector<std::shared_ptr<Session>> sessions_;
};

}  // namespace footing::transport
