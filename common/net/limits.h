#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <sys/types.h>

#include "common/runtime/config.h"
#include "footing/v1/session.pb.h"

namespace footing::transport {

/// Longest message of the device socket, and of devices within a session.
inline constexpr std::uint32_t kMaxDeviceBytes = 2048;

/// How much somebody may do: `per_s` a second on the average, `burst` at once. What is done is
/// charged afterwards, so that the level may fall below zero; the next one waits that much longer.
/// A plain value; instants are nanoseconds of any one clock. A rate of 0 never limits.
class TokenBucket {
 public:
  TokenBucket() = default;
  TokenBucket(double per_s, double burst) : per_s_(per_s), burst_(burst), level_(burst) {}

  bool limits() const { return per_s_ > 0; }

  void Charge(double tokens) { level_ -= tokens; }

  /// Whether at least one token is there.
  bool HasOne(std::int64_t now_ns) { return !limits() || Level(now_ns) >= 1; }

  /// Spends one token if it is there.
  bool Spend(std::int64_t now_ns) {
    if (!HasOne(now_ns)) return false;
    Charge(1);
    return true;
  }

  /// How long until the level is `tokens` (at most the burst); 0 when it is.
  std::int64_t WaitNs(std::int64_t now_ns, double tokens) {
    if (!limits()) return 0;
    const double missing = std::min(tokens, burst_) - Level(now_ns);
    return missing <= 0 ? 0 : static_cast<std::int64_t>(missing / per_s_ * 1e9) + 1;
  }

 private:
  double Level(std::int64_t now_ns) {
    if (filled_ns_ != 0 && now_ns > filled_ns_) {
      level_ = std::min(burst_, level_ + static_cast<double>(now_ns - filled_ns_) * 1e-9 * per_s_);
    }
    filled_ns_ = now_ns;
    return level_;
  }

  double per_s_ = 0;
  double burst_ = 0;
  double level_ = 0;
  std::int64_t filled_ns_ = 0;
};

/// Input limits for the other side of a connection; rates of 0 do not limit.
struct InputBudget {
  double messages_per_s = 0;
  double message_burst = 0;  ///< At once, after a pause.
  double bytes_per_s = 0;
  double byte_burst = 0;
};

/// Share of its budget that a connection has used. A plain value.
class InputPace {
 public:
  explicit InputPace(const InputBudget& budget)
      : messages_(budget.messages_per_s, budget.message_burst),
        bytes_(budget.bytes_per_s, budget.byte_burst) {}

  bool limits() const { return messages_.limits() || bytes_.limits(); }

  void ChargeMessages(double messages) { messages_.Charge(messages); }
  void ChargeBytes(std::size_t bytes) { bytes_.Charge(static_cast<double>(bytes)); }

  /// 0 while a message may be handled; else how long to wait until some are worth it.
  std::int64_t WaitNs(std::int64_t now_ns) {
    constexpr double kMessages = 8, kBytes = 16 << 10;
    if (messages_.HasOne(now_ns) && bytes_.HasOne(now_ns)) return 0;
    return std::max(messages_.WaitNs(now_ns, kMessages), bytes_.WaitNs(now_ns, kBytes));
  }

 private:
  TokenBucket messages_;
  TokenBucket bytes_;
};

/// Who is at the other end, and what it may do.
struct Peer {
  bool known = false;  ///< False over TCP: nothing is known about it but its host.
  uid_t user = 0;
  std::vector<gid_t> groups;  ///< The main one and the supplementary ones.
  std::string host = {};      ///< Over TCP: the other side's numeric address.
};

/// Asks the kernel about the other end of a connected socket: of a Unix socket who it is
/// (SO_PEERCRED, SO_PEERGROUPS), over TCP where.
Peer PeerOf(int socket);

/// The highest role it may have: on the Unix socket the server's own user (and root) may be admin,
/// a member of its group control, others view and log; over loopback TCP view and log.
v1::Role HighestRole(const Peer& peer, uid_t own_user, gid_t own_group);

/// How many sessions a server has at once, and what each may send: settings of both servers.
///
/// Administrators (the server's own user and root, on the Unix socket) have places of their own
/// beyond `max_sessions`, half of which only root may take: no crowd of others locks them out. One
/// address, one certificate, and all viewers together leave places to others. A connection is
/// looked at twice: when it comes (WhyNoPlace), and when its Hello has said who it is
/// (PlacesTaken).
struct SessionLimits {
  std::int64_t max_sessions = 256;
  /// Sessions of one user; all sessions over TCP count as one user's, since nobody knows whose they
  /// are.
  std::int64_t max_sessions_per_user = 224;
  /// Over TLS, of one host, before they are welcomed: who has no token cannot take all places.
  std::int64_t max_entering_per_host = 64;
  /// Over TCP and TLS, of one address: its sessions with the roles view and log. Those with the
  /// role control are counted apart, up to half of max_control_sessions.
  std::int64_t max_sessions_per_host = 64;
  std::int64_t max_sessions_per_certificate = 16;  ///< The same for one client certificate.
  std::int64_t admin_places = 16;
  /// Places, of max_sessions and of those over TCP and TLS, that sessions with the roles view and
  /// log leave free; at most a quarter of either.
  std::int64_t control_places = 16;
  std::int64_t max_log_sessions = 64;      ///< With the role log, administrators not counted.
  std::int64_t max_control_sessions = 32;  ///< With the role control, likewise.
  /// Input of one session, on the average and at once after a pause; a Subscribe counts as 20,
  /// a Command as 2. A session that sends more is slowed and informed.
  double session_messages_per_s = 100;
  double session_kilobytes_per_s = 1024;

  void Bind(config::Binder& binder);
  InputBudget Input() const;
};

/// The connections that there are when another one comes, those being refused not counted.
struct SessionCounts {
  std::int64_t all = 0;
  std::int64_t of_user = 0;  ///< Connections of the user that comes now.
  /// Over TLS from the host that comes now, and not welcomed yet.
  std::int64_t entering_of_host = 0;
};

/// Why there is not a place for one more connection of this peer; empty when there is. It has not
/// said yet who it is.
std::string WhyNoPlace(const SessionLimits& limits, const Peer& peer, uid_t own_user,
                       const SessionCounts& taken);

/// Identity under which a session is counted, once it has said who it is.
struct Claim {
  v1::Role role = v1::ROLE_VIEW;
  bool remote = false;           ///< Over TCP or TLS.
  std::string host = {};         ///< The address that it comes from; empty on a Unix socket.
  std::string certificate = {};  ///< By which it came in; empty: by something else.
};

/// The welcomed sessions, administrators not counted. A plain value.
class PlacesTaken {
 public:
  /// Why there is not a place for one more; empty when there is.
  std::string WhyNotOneMore(const SessionLimits& limits, const Claim& claim) const;
  void Add(const Claim& claim) { Count(claim, 1); }
  void Remove(const Claim& claim) { Count(claim, -1); }

  std::int64_t with_role(v1::Role role) const;
  bool empty() const { return with_role_.empty() && of_.empty(); }

 private:
  /// Sessions of a host or a certificate: the role control apart from the others.
  struct Sessions {
    std::int64_t ordinary = 0;
    std::int64_t control = 0;
  };

  void Count(const Claim& claim, std::int64_t one);
  std::string WhyOneHasTooMany(const std::string& key, std::int64_t most,
                               const SessionLimits& limits, const Claim& claim,
                               const std::string& whose) const;

  std::map<v1::Role, std::int64_t> with_role_;
  std::int64_t ordinary_remote_ = 0;
  std::map<std::string, Sessions> of_;  ///< By host, and by certificate: the two differ in form.
};

}  // namespace footing::transport
