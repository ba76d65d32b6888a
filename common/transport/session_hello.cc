#include <algorithm>
#include <utility>

#include "common/clock/clock.h"
#include "common/transport/session.h"

/// The part of Session that decides who comes in, and as what.
namespace footing::transport {
namespace {

constexpr std::size_t kMostNameBytes = 64;

/// For logs and other people's screens: at most 64 bytes, printable.
std::string PlainName(std::string name) {
  name.resize(std::min(name.size(), kMostNameBytes));
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return name;
}

}  // namespace

std::optional<v1::Refused> Session::Authenticate(const v1::Hello& hello) {
  if (peer_.known) return std::nullopt;  // The kernel vouches for it.
  const ServerOptions& options = shared_.options;
  const std::string certificate = connection_.peer_fingerprint();
  if (const auto client = options.clients.find(certificate); client != options.clients.end()) {
    highest_role_ = client->second;
    return std::nullopt;
  }
  const bool needs_proof = options.insecure_lan || connection_.secured();
  if (needs_proof && (hello.token().empty() || options.token.empty())) {
    shared_.SayDenied(peer_.host, certificate.empty() ? "no token" : certificate + " is not known");
    return Refuse(v1::Refused::REASON_TOKEN, HowToComeIn(certificate));
  }
  if (hello.token().empty() || options.token.empty()) return std::nullopt;
  if (!shared_.token.Accepts(hello.token(), peer_.host, shared_.NowNs())) {
    shared_.SayDenied(peer_.host, "wrong token");
    return Refuse(v1::Refused::REASON_TOKEN,
                  "the token is wrong, or there were too many wrong ones: try again in 5 s");
  }
  highest_role_ = v1::ROLE_CONTROL;
  return std::nullopt;
}

std::string Session::HowToComeIn(const std::string& certificate) const {
  const ServerOptions& options = shared_.options;
  std::string text = connection_.secured() ? "this server wants" : "this server wants its token";
  if (!connection_.secured()) {
    return text +
           ": FOOTING_TOKEN_FILE=FILE names it, and FOOTING_INSECURE_LAN=1 allows a client to send "
           "it without encryption";
  }
  if (!options.token.empty()) text += " its token, which FOOTING_TOKEN_FILE=FILE names";
  if (!options.token.empty() && !options.clients.empty()) text += ", or";
  if (!options.clients.empty()) {
    text += certificate.empty()
                ? " a certificate that it knows; footing-ctl trust --client makes one"
                : " a certificate that it knows; it does not know yours, " + certificate;
  }
  return text;
}

std::string Session::HowToGetMore() const {
  const ServerOptions& options = shared_.options;
  if (options.clients.contains(connection_.peer_fingerprint())) {
    return "the server's clients_file gives this client's certificate that role: change it there";
  }
  return std::string(
             "connect over the server's Unix socket as its user (admin) or as a member of its "
             "group (control)") +
         (options.token.empty() ? "" : ", or over TCP with the server's token (control)");
}

void Session::OnHello(const v1::Hello& hello) {
  if (const auto refused = Authenticate(hello))
    return Refused(refused->reason(), refused->message());
  const auto answer = AnswerHello(hello, highest_role_, HowToGetMore(), shared_.options.server_id);
  if (const auto* refused = std::get_if<v1::Refused>(&answer)) {
    Refused(refused->reason(), refused->message());
    return;
  }
  info_.client_name = PlainName(hello.client_name());
  const v1::Role role = std::get<v1::Role>(answer);
  if (!may_administer()) {
    const auto taken = WhyRoleIsTaken(shared_.options.sessions, role, shared_.with_role[role]);
    if (!taken.empty()) {
      return Refused(v1::Refused::REASON_TOO_MANY_SESSIONS,
                     shared_.options.server_id + " has " + taken + "; end one or try again later");
    }
    ++shared_.with_role[role];
  }
  info_.role = role;
  phase_ = Phase::kWelcomed;
  v1::Envelope message;
  *message.mutable_welcome() = MakeWelcome(shared_.options, shared_.epoch, info_.role);
  message.mutable_welcome()->set_host_ns(shared_.NowNs());
  message.mutable_welcome()->set_wall_time_ns(clock::WallNs());
  Send(message);
  ArmTimer(shared_.options.ping_interval_s);
}

}  // namespace footing::transport
