#include "common/transport/admission.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "common/transport/handshake.h"

namespace footing::transport {
namespace {

constexpr std::size_t kMostNameBytes = 64;

std::string VersionText(std::uint32_t major, std::uint32_t minor) {
  return std::to_string(major) + "." + std::to_string(minor);
}

NotAdmitted Without(v1::Refused::Reason reason, const std::string& message,
                    const std::string& proof = "") {
  return {Refuse(reason, message), proof};
}

std::string HowToComeIn(const ServerOptions& options, const Caller& caller) {
  if (!caller.secured) {
    return "this server wants its token: FOOTING_TOKEN_FILE=FILE names it, and "
           "FOOTING_INSECURE_LAN=1 allows a client to send it without encryption";
  }
  std::string text = "this server wants";
  if (!options.token.empty()) text += " its token, which FOOTING_TOKEN_FILE=FILE names";
  if (!options.token.empty() && !options.clients.empty()) text += ", or";
  if (!options.clients.empty()) {
    text += caller.certificate.empty()
                ? " a certificate that it knows; footing-ctl trust --client makes one"
                : " a certificate that it knows; it does not know yours, " + caller.certificate;
  }
  return text;
}

std::string HowToGetMore(const ServerOptions& options, const Caller& caller) {
  if (options.clients.contains(caller.certificate)) {
    return "the server's clients_file gives this client's certificate that role: change it there";
  }
  return std::string(
             "connect over the server's Unix socket as its user (admin) or as a member of its "
             "group (control)") +
         (options.token.empty() ? ", or give the server a token_file, and the client its token"
                                : ", or over TCP with the server's token (control)");
}

/// The highest role of the caller, or why it may not come in.
std::variant<v1::Role, NotAdmitted> Authenticate(const ServerOptions& options,
                                                 const ServerUser& own, const Caller& caller,
                                                 const std::string& token, std::int64_t now_ns,
                                                 TokenGuard& guard) {
  const v1::Role without_proof = HighestRole(caller.peer, own.user, own.group);
  if (caller.peer.known) return without_proof;  // The kernel vouches for it.
  if (const auto known = options.clients.find(caller.certificate); known != options.clients.end()) {
    return known->second;
  }
  const bool has_token = !token.empty() && !options.token.empty();
  if (!has_token && (options.insecure_lan || caller.secured)) {
    return Without(v1::Refused::REASON_TOKEN, HowToComeIn(options, caller),
                   caller.certificate.empty() ? "no token" : caller.certificate + " is not known");
  }
  if (!has_token) return without_proof;
  if (guard.Accepts(token, caller.peer.host, now_ns)) return v1::ROLE_CONTROL;
  return Without(v1::Refused::REASON_TOKEN,
                 "the token is wrong, or there were too many wrong ones: try again in 5 s",
                 "wrong token");
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

std::optional<NotAdmitted> CheckRole(const ServerOptions& options, const Caller& caller,
                                     v1::Role wished, v1::Role highest) {
  // An enum of the protocol may have any number, a negative one as well.
  if (wished >= v1::ROLE_VIEW && wished <= highest) return std::nullopt;
  if (!v1::Role_IsValid(wished)) {
    return Without(v1::Refused::REASON_ROLE,
                   "Hello has the unknown role " + std::to_string(wished) +
                       "; there are 1 (view), 2 (log), 3 (control) and 4 (admin)");
  }
  return Without(v1::Refused::REASON_ROLE,
                 "the role " + RoleName(wished) + " is not given to this connection, at most " +
                     RoleName(highest) + "; " + HowToGetMore(options, caller));
}

}  // namespace

Admission Admit(const ServerOptions& options, const ServerUser& own, const Caller& caller,
                const v1::Hello& hello, std::int64_t now_ns, AdmissionState& state) {
  auto known = Authenticate(options, own, caller, hello.token(), now_ns, state.token);
  if (auto* unknown = std::get_if<NotAdmitted>(&known)) return std::move(*unknown);
  const v1::Role wished = hello.role() == v1::ROLE_UNSPECIFIED ? v1::ROLE_VIEW : hello.role();
  const Admitted admitted{wished, std::get<v1::Role>(known), PlainName(hello.client_name())};
  if (auto other = CheckVersion(options, hello)) return std::move(*other);
  if (auto too_high = CheckRole(options, caller, wished, admitted.highest)) {
    return std::move(*too_high);
  }
  if (admitted.may_administer()) return admitted;
  const auto with = state.with_role.find(wished);
  const auto taken =
      WhyRoleIsTaken(options.sessions, wished, with == state.with_role.end() ? 0 : with->second);
  if (!taken.empty()) {
    return Without(v1::Refused::REASON_TOO_MANY_SESSIONS,
                   options.server_id + " has " + taken + "; end one or try again later");
  }
  ++state.with_role[wished];
  return admitted;
}

void Leave(const Admitted& admitted, AdmissionState& state) {
  if (!admitted.may_administer()) --state.with_role[admitted.role];
}

std::string PlainName(std::string name) {
  name.resize(std::min(name.size(), kMostNameBytes));
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return name;
}

}  // namespace footing::transport
