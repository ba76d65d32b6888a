#pragma once

#include <sys/types.h>

#include <cstdint>
#include <map>
#include <string>
#include <variant>

#include "common/transport/peer.h"
#include "common/transport/server.h"
#include "common/transport/token.h"
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

struct Admitted {
  v1::Role role = v1::ROLE_VIEW;
  v1::Role highest = v1::ROLE_VIEW;  ///< That it could have asked for.
  std::string client_name;           ///< As PlainName() gives it.

  bool may_administer() const { return highest == v1::ROLE_ADMIN; }
};

struct NotAdmitted {
  v1::Refused answer;
  std::string proof;  ///< For the log: which proof of who it is was missing or wrong; empty: none.
};

/// What Hello messages change. A plain value.
struct AdmissionState {
  TokenGuard token;
  std::map<v1::Role, std::int64_t> with_role = {};  ///< Sessions, administrators' not counted.
};

using Admission = std::variant<Admitted, NotAdmitted>;

/// The answer to a Hello. Neither it nor what the log gets depends on the wrong token that a caller
/// presents. Leave() takes an Admitted back when its session ends.
Admission Admit(const ServerOptions& options, const ServerUser& own, const Caller& caller,
                const v1::Hello& hello, std::int64_t now_ns, AdmissionState& state);
void Leave(const Admitted& admitted, AdmissionState& state);

/// For logs and other people's screens: at most 64 bytes, printable.
std::string PlainName(std::string name);

}  // namespace footing::transport
