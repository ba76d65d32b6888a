#include "common/net/session_table.h"

#include <unistd.h>

#include <algorithm>
#include <set>
#include <utility>

#include "common/net/admission.h"

namespace footing::transport {
namespace {

constexpr int kMostListed = 500;  // Sessions in an answer: about 100 kB.
constexpr std::size_t kMostReasonBytes = 200;
/// The right token of a host that guesses must get in, so there may be more of these.
constexpr std::int64_t kMostLingeringGuesses = 4 * SessionTable::kMostLingering;

}  // namespace

std::int64_t SessionTable::lingering() const {
  return std::count_if(sessions_.begin(), sessions_.end(),
                       [](const auto& one) { return one->refused(); });
}

std::shared_ptr<Session> SessionTable::Remove(const Session& session) {
  const auto found = std::find_if(sessions_.begin(), sessions_.end(),
                                  [&](const auto& one) { return one.get() == &session; });
  std::shared_ptr<Session> removed = *found;
  sessions_.erase(found);
  return removed;
}

std::size_t SessionTable::SetKeys(const AccessKeys& keys) {
  AccessKeys& own = shared_.options;
  std::vector<std::pair<std::shared_ptr<Session>, std::string>> revoked;
  for (const auto& session : sessions_) {
    if (!session->live()) continue;
    auto why = WhyRevoked(own, keys, session->admitted());
    if (!why.empty()) revoked.emplace_back(session, std::move(why));
  }
  if (keys.token != own.token || keys.view_token != own.view_token) {
    shared_.admission.token = TokenGuard(keys.token, keys.view_token);
  }
  own = keys;
  for (const auto& [session, why] : revoked) session->End(why);
  return revoked.size();
}

v1::CommandResult SessionTable::CarryOut(const SessionInfo& who, const v1::Command& command) {
  return command.has_end_sessions() ? End(who, command.end_sessions())
                                    : List(who, command.list_sessions().after());
}

SessionCounts SessionTable::CountsFor(const Session& one) const {
  SessionCounts taken;
  for (const auto& other : sessions_) {
    if (other->refused()) continue;
    const Peer &a = one.peer(), &b = other->peer();
    const bool entering = other->secured() && !other->welcomed();
    ++taken.all;
    taken.of_user += a.known == b.known && a.user == b.user ? 1 : 0;
    taken.entering_of_host += one.secured() && entering && a.host == b.host ? 1 : 0;
  }
  return taken;
}

/// The oldest guess of the host, or of any, has its answer now. False without one.
bool SessionTable::EndAGuess(const std::optional<std::string>& host) {
  const auto guess = std::find_if(sessions_.begin(), sessions_.end(), [&](const auto& one) {
    return one->guessing() && (!host || one->peer().host == *host);
  });
  if (guess == sessions_.end() || lingering() >= kMostLingeringGuesses) return false;
  (*guess)->AnswerGuess();
  return true;
}

/// Who came last may be quick where others stall: the oldest of the host gives way.
void SessionTable::BoundEntering(const Session& session) {
  const SessionLimits& limits = shared_.options.sessions;
  const std::string& host = session.peer().host;
  if (CountsFor(session).entering_of_host < limits.max_entering_per_host) return;
  if (lingering() >= kMostLingering) return;  // Each lingers for up to a second.
  const auto oldest = std::find_if(sessions_.begin(), sessions_.end(), [&](const auto& one) {
    return one->secured() && !one->welcomed() && !one->refused() && one->peer().host == host;
  });
  (*oldest)->GiveWay(shared_.options.server_id + " has " +
                     WhyNoPlace(limits, session.peer(), geteuid(), CountsFor(session)) +
                     "; end one or try again later");
}

std::string SessionTable::WhyFull(const Session& session) {
  const std::string& host = session.peer().host;
  const auto why = [&] {
    return WhyNoPlace(shared_.options.sessions, session.peer(), geteuid(), CountsFor(session));
  };
  BoundGuesses(host);
  BoundEntering(session);
  std::string full = why();
  if (!full.empty() && (EndAGuess(host) || EndAGuess(std::nullopt))) full = why();
  return full;
}

/// At most so many guesses of one host wait for their answers.
void SessionTable::BoundGuesses(const std::string& host) {
  const auto waiting = std::count_if(sessions_.begin(), sessions_.end(), [&](const auto& one) {
    return one->guessing() && one->peer().host == host;
  });
  if (waiting >= shared_.options.sessions.max_entering_per_host) EndAGuess(host);
}

v1::CommandResult SessionTable::List(const SessionInfo& who, std::uint64_t after) const {
  v1::CommandResult result;
  result.set_ok(true);
  for (const auto& session : sessions_) {  // In the order of their numbers.
    if (!session->live() || session->info().session <= after) continue;
    if (result.sessions_size() == kMostListed) {
      result.set_more_sessions(true);
      break;
    }
    *result.add_sessions() = session->Describe();
    const bool own = session->info().session == who.session;
    result.mutable_sessions()->rbegin()->set_own(own);
  }
  return result;
}

v1::CommandResult SessionTable::End(const SessionInfo& who, const v1::EndSessions& wish) {
  v1::CommandResult result;
  const std::set<std::uint64_t> numbers(wish.sessions().begin(), wish.sessions().end());
  if (who.role != v1::ROLE_ADMIN) {
    result.set_message(
        "end_sessions needs the role admin: connect over the server's Unix socket as its user or "
        "root, and request admin in Hello");
  } else if (numbers.empty() || wish.sessions_size() > kMostListed) {
    result.set_message("end_sessions names 1 to " + std::to_string(kMostListed) + " sessions");
  } else if (numbers.contains(who.session)) {
    result.set_message("end_sessions: session " + std::to_string(who.session) +
                       " is the one that asks; it ends when its client does");
  } else if (wish.reason().size() > kMostReasonBytes) {
    result.set_message("end_sessions: reason has at most " + std::to_string(kMostReasonBytes) +
                       " bytes");
  } else {
    result.set_ok(true);
    const std::string reason =
        "ended by an administrator" + (wish.reason().empty() ? "" : ": " + wish.reason());
    for (const auto& session : std::vector(sessions_)) {
      if (!session->live() || !numbers.contains(session->info().session)) continue;
      *result.add_sessions() = session->Describe();
      session->End(reason);
    }
  }
  return result;
}

}  // namespace footing::transport
