#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/result.h"
#include "footing/v1/command.pb.h"

namespace footing::lease {

/// A session's request for the lease.
struct Request {
  std::uint64_t session = 0;
  std::string holder;       ///< Who it is, for a person.
  double seconds = 0;       ///< Until the lease ends, unless it is renewed; 0 means kUsualS.
  bool take_over = false;   ///< Also from another session.
  bool renew_only = false;  ///< Refused unless the session has the lease, or nobody after it.
};

/// Which session alone may control a server: none, or one until it releases the lease or does not
/// renew it in time. Instants are of one monotonic clock, ns.
class Lease {
 public:
  static constexpr double kUsualS = 5;
  static constexpr double kLongestS = 60;
  static constexpr std::size_t kMaxHolder = 200;  ///< Bytes.

  /// `server`: whose lease it is, for messages.
  explicit Lease(std::string server) : server_(std::move(server)) {}

  /// Takes or renews the lease. Refused, with the holder's name, while another session has it. Once
  /// the holder's session has ended, a new session that gives the same name goes on with the lease.
  /// Usage errors: a holder that is empty, too long or has control characters, and seconds outside
  /// of 0 to kLongestS.
  Result<void> Take(const Request& request, std::int64_t now_ns);
  /// Refused unless the session has the lease.
  Result<void> Release(std::uint64_t session, std::int64_t now_ns);
  /// Refused, with the holder's name, while another session has the lease.
  Result<void> Check(std::uint64_t session, std::int64_t now_ns) const;

  /// A session is gone. If it has the lease, that goes on until its end.
  void EndSession(std::uint64_t session);
  /// Ends the lease when its time is over.
  void Expire(std::int64_t now_ns);

  /// Empty: nobody has the lease.
  const std::string& holder() const { return holder_; }
  /// Changes of the lease since the last call, for a person; renewals are left out.
  std::vector<std::string> TakeChanges();

 private:
  bool HeldByOther(std::uint64_t session, std::int64_t now_ns) const;
  bool HeldBy(std::uint64_t session, std::int64_t now_ns) const;
  void End(const std::string& change);
  Error HeldByError() const;

  std::string server_;
  std::string holder_;
  std::uint64_t session_ = 0;
  bool session_ended_ = false;
  std::int64_t end_ns_ = 0;
  std::vector<std::string> changes_;
};

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
