#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <variant>

#include "common/net/peer.h"
#include "common/net/server.h"
#include "common/net/session_limits.h"
#include "common/net/token.h"
#include "footing/v1/session.pb.h"

/// Who may come in, and as what: a state machine over the Hello messages of all sessions of a
/// server, without sockets and clocks.
namespace footing::transport {

/// Whose Hello it is, as the kernel and TLS know it.
struct Caller {
  Peer peer;
  bool secured = false;  ///< It comes over TLS.
  std::string certificate =
      {};  ///< Fingerprint of the certificate that it has proved; empty: none.
};

/// Whose process the server is.
struct ServerUser {
  uid_t user = 0;
  gid_t group = 0;
};

/// By what a caller got its role.
enum class Grant { kAddress, kUser, kCertificate, kToken, kViewToken };

/// "address" (loopback TCP), "user" (the kernel knows it), "certificate", "token", "view_token".
std::string Name(Grant grant);

struct Admitted {
  v1::Role role = v1::ROLE_VIEW;
  v1::Role highest = v1::ROLE_VIEW;  ///< That it could have asked for.
  std::string client_name;           ///< As PlainName() gives it.
  Grant grant = Grant::kAddress;
  Claim claim = {};

  bool may_administer() const { return highest == v1::ROLE_ADMIN; }
};

/// Which proof of who it is a caller lacked, for the log.
enum class Lack { kNone, kAnyProof, kKnownCertificate, kRightToken };

struct NotAdmitted {
  v1::Refused answer;
  Lack lack = Lack::kNone;
  std::string lack_text = {};  ///< For the log; empty with kNone.
  bool waits = false;          ///< A guess of a token: it is answered later.
};

/// What Hello messages change. A plain value.
struct AdmissionState {
  TokenGuard token;
  PlacesTaken places = {};
};

using Admission = std::variant<Admitted, NotAdmitted>;

/// The answer to a Hello. Neither it nor what the log gets depends on the wrong token that a caller
/// presents. Leave() takes an Admitted back when its session ends.
Admission Admit(const ServerOptions& options, const ServerUser& own, const Caller& caller,
                const v1::Hello& hello, std::int64_t now_ns, AdmissionState& state);
void Leave(const Admitted& admitted, AdmissionState& state);

/// Why a session that was admitted with the keys `before` may not stay with those of `now`, for its
/// client; empty when it may.
std::string WhyRevoked(const AccessKeys& before, const AccessKeys& now, const Admitted& admitted);

/// For logs and other people's screens: at most 64 bytes, printable.
std::string PlainName(std::string name);

}  // namespace footing::transport
