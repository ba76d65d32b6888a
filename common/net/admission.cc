#include "common/net/admission.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "common/net/handshake.h"

namespace footing::transport {
namespace {

constexpr std::size_t kMostNameBytes = 64;

std::string VersionText(std::uint32_t major, std::uint32_t minor) {
  return std::to_string(major) + "." + std::to_string(minor);
}

NotAdmitted Without(v1::Refused::Reason reason, const std::string& message) {
  return {Refuse(reason, message)};
}

/// Without a right token or a known certificate.
NotAdmitted Unproved(const std::string& message, Lack lack, const std::string& lack_text,
                     bool waits = false) {
  return {Refuse(v1::Refused::REASON_TOKEN, message), lack, lack_text, waits};
}

std::string HowToComeIn(const ServerOptions& options, const Caller& caller) {
  if (!caller.secured) {
    return "this server wants its token: FOOTING_TOKEN_FILE=FILE names it, and "
           "FOOTING_INSECURE_LAN=1 allows a client to send it without encryption";
  }
  std::string text = "this server wants";
  if (options.has_token()) text += " its token, which FOOTING_TOKEN_FILE=FILE names";
  if (options.has_token() && !options.clients.empty()) text += ", or";
  if (!options.clients.empty()) {
    text += caller.certificate.empty()
                ? " a certificate that it knows; footing-ctl trust --client makes one"
                : " a certificate that it knows; it does not know yours, " + caller.certificate;
  }
  return text;
}

std::string HowToGetMore(const ServerOptions& options, Grant grant) {
  if (grant == Grant::kCertificate) {
    return "the server's clients_file gives this client's certificate that role: change it there";
  }
  if (grant == Grant::kViewToken) {
    return "it came with the token of the server's view_token_file; that of its token_file gives "
           "control";
  }
  return std::string(
             "connect over the server's Unix socket as its user (admin) or as a member of its "
             "group (control)") +
         (options.token.empty() ? ", or give the server a token_file, and the client its token"
                                : ", or over TCP with the server's token (control)");
}

/// What an administrator does to let in a client whose certificate the server does not know.
NotAdmitted UnknownCertificate(const ServerOptions& options, const Caller& caller) {
  return Unproved(HowToComeIn(options, caller), Lack::kKnownCertificate,
                  "its certificate is not in the clients_file; to let it in add the line \"" +
                      caller.certificate +
                      " view\" there and reload (footing-ctl trust --client prints it)");
}

/// The highest role of a caller, and by what it has it.
struct Known {
  v1::Role highest = v1::ROLE_UNSPECIFIED;
  Grant grant = Grant::kAddress;
};

/// Who the caller is, or why it may not come in.
std::variant<Known, NotAdmitted> Authenticate(const ServerOptions& options, const ServerUser& own,
                                              const Caller& caller, const std::string& token,
                                              std::int64_t now_ns, TokenGuard& guard) {
  const v1::Role without_proof = HighestRole(caller.peer, own.user, own.group);
  if (caller.peer.known) return Known{without_proof, Grant::kUser};  // The kernel vouches for it.
  if (const auto known = options.clients.find(caller.certificate); known != options.clients.end()) {
    return Known{known->second, Grant::kCertificate};
  }
  const bool needs_proof = options.insecure_lan || caller.secured;
  if (token.empty() || !options.has_token()) {
    if (!needs_proof) return Known{without_proof, Grant::kAddress};
    if (!caller.certificate.empty()) return UnknownCertificate(options, caller);
    return Unproved(HowToComeIn(options, caller), Lack::kAnyProof,
                    caller.secured ? "neither a token nor a certificate" : "no token");
  }
  const TokenGuard::Verdict verdict = guard.Check(token, caller.peer.host, now_ns);
  if (verdict.role == v1::ROLE_CONTROL) return Known{v1::ROLE_CONTROL, Grant::kToken};
  if (verdict.role == v1::ROLE_VIEW) {
    // It takes away nothing that this host's users have without it.
    return Known{needs_proof ? v1::ROLE_VIEW : without_proof, Grant::kViewToken};
  }
  const std::string text =
      "the token is wrong; compare the file that FOOTING_TOKEN_FILE names with the server's";
  return Unproved(text, Lack::kRightToken, "wrong token", verdict.waits);
}

/// Another minor version is fine: both sides leave out what they do not know.
std::optional<NotAdmitted> CheckVersion(const ServerOptions& options, const v1::Hello& hello) {
  if (hello.protocol_major() == kProtocolMajor) return std::nullopt;
  if (hello.protocol_major() == 0) {
    return Without(v1::Refused::REASON_PROTOCOL_VERSION,
                   "Hello has no protocol_major: send " + std::to_string(kProtocolMajor) +
                       " for protocol " + VersionText(kProtocolMajor, kProtocolMinor));
  }
  const bool client_older = hello.protocol_major() < kProtocolMajor;
  return Without(v1::Refused::REASON_PROTOCOL_VERSION,
                 options.server_id + " speaks protocol " +
                     VersionText(kProtocolMajor, kProtocolMinor) + ", this client " +
                     VersionText(hello.protocol_major(), hello.protocol_minor()) + "; update the " +
                     (client_older ? "client" : "server"));
}

std::optional<NotAdmitted> CheckRole(const ServerOptions& options, v1::Role wished,
                                     const Known& known) {
  // An enum of the protocol may have any number, a negative one as well.
  if (wished >= v1::ROLE_VIEW && wished <= known.highest) return std::nullopt;
  if (!v1::Role_IsValid(wished)) {
    return Without(v1::Refused::REASON_ROLE,
                   "Hello has the unknown role " + std::to_string(wished) +
                       "; there are 1 (view), 2 (log), 3 (control) and 4 (admin)");
  }
  return Without(v1::Refused::REASON_ROLE,
                 "the role " + RoleName(wished) + " is not given to this connection, at most " +
                     RoleName(known.highest) + "; " + HowToGetMore(options, known.grant));
}

}  // namespace

std::string Name(Grant grant) {
  switch (grant) {
    case Grant::kAddress:
      return "address";
    case Grant::kUser:
      return "user";
    case Grant::kCertificate:
      return "certificate";
    case Grant::kToken:
      return "token";
    case Grant::kViewToken:
      return "view_token";
  }
  return "";
}

Admission Admit(const ServerOptions& options, const ServerUser& own, const Caller& caller,
                const v1::Hello& hello, std::int64_t now_ns, AdmissionState& state) {
  auto answer = Authenticate(options, own, caller, hello.token(), now_ns, state.token);
  if (auto* unknown = std::get_if<NotAdmitted>(&answer)) return std::move(*unknown);
  const auto& known = std::get<Known>(answer);
  const v1::Role wished = hello.role() == v1::ROLE_UNSPECIFIED ? v1::ROLE_VIEW : hello.role();
  if (auto other = CheckVersion(options, hello)) return std::move(*other);
  if (auto too_high = CheckRole(options, wished, known)) return std::move(*too_high);
  Admitted admitted{wished, known.highest, PlainName(hello.client_name()), known.grant};
  const bool by_certificate = known.grant == Grant::kCertificate;
  admitted.claim = {wished, !caller.peer.known, caller.peer.host,
                    by_certificate ? caller.certificate : ""};
  if (admitted.may_administer()) return admitted;
  const auto taken = state.places.WhyNotOneMore(options.sessions, admitted.claim);
  if (!taken.empty()) {
    return Without(v1::Refused::REASON_TOO_MANY_SESSIONS,
                   options.server_id + " has " + taken + "; end one or try again later");
  }
  state.places.Add(admitted.claim);
  return admitted;
}

void Leave(const Admitted& admitted, AdmissionState& state) {
  if (!admitted.may_administer()) state.places.Remove(admitted.claim);
}

std::string WhyRevoked(const AccessKeys& before, const AccessKeys& now, const Admitted& admitted) {
  const auto changed = [](const std::string& file, const std::string& then_token,
                          const std::string& now_token) -> std::string {
    if (then_token == now_token) return "";
    return now_token.empty() ? "revoked: the server has no " + file + " any more"
                             : "revoked: the token in the server's " + file +
                                   " was replaced; copy the new one to this client";
  };
  switch (admitted.grant) {
    case Grant::kAddress:
    case Grant::kUser:
      return "";
    case Grant::kToken:
      return changed("token_file", before.token, now.token);
    case Grant::kViewToken:
      return changed("view_token_file", before.view_token, now.view_token);
    case Grant::kCertificate:
      break;
  }
  const std::string& certificate = admitted.claim.certificate;
  const auto known = now.clients.find(certificate);
  if (known == now.clients.end()) {
    return "revoked: this client's certificate " + certificate +
           " was removed from the server's clients_file";
  }
  if (admitted.role <= known->second) return "";
  return "revoked: the server's clients_file gives this client's certificate only the role " +
         RoleName(known->second) + " now";
}

std::string PlainName(std::string name) {
  name.resize(std::min(name.size(), kMostNameBytes));
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return name;
}

}  // namespace footing::transport
