#include "common/net/admission.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "tests/fuzz/input.h"
#include "tests/fuzz/message.h"

/// Callers of every kind say any Hello to a server of any settings, wait, and leave. Nobody gets a
/// role that nothing gives him, no role, host or certificate has more sessions than the settings
/// allow, wrong tokens wait for their answer and right ones do not, and what a wrong token was
/// changes nothing that anybody sees.
namespace footing::fuzz {
namespace {

using transport::Admission;
using transport::Admitted;
using transport::Caller;
using transport::NotAdmitted;

constexpr const char* kToken = "0123456789abcdef";
constexpr const char* kViewToken = "fedcba9876543210";
constexpr transport::ServerUser kOwn{1000, 1000};

std::string Certificate(int number) { return "sha256:" + std::to_string(number); }

transport::ServerOptions Options(Input& input) {
  transport::ServerOptions options;
  options.server_id = "fuzzed";
  const std::uint8_t how = input.Byte();
  if ((how & 1) != 0) options.token = kToken;
  if (how % 3 == 1) options.view_token = kViewToken;
  options.sessions.max_sessions_per_host = 1 + how % 5;
  options.sessions.max_sessions_per_certificate = 1 + how % 4;
  options.insecure_lan = (how & 2) != 0;
  options.sessions.max_log_sessions = (how >> 2) % 4;
  options.sessions.max_control_sessions = (how >> 4) % 4;
  for (int i = 0; i < how >> 6; ++i) {
    options.clients[Certificate(i)] = static_cast<v1::Role>(v1::ROLE_VIEW + i);
  }
  return options;
}

Caller AnyCaller(Input& input) {
  const std::uint8_t who = input.Byte();
  Caller caller;
  caller.peer.host = "10.0.0." + std::to_string(who >> 5);
  switch (who % 4) {
    case 0:
      caller.peer.known = true;
      caller.peer.user = (who & 4) != 0 ? 2000 : (who & 8) != 0 ? 0 : 1000;
      caller.peer.groups = {(who & 16) != 0 ? 1000u : 2000u};
      caller.peer.host.clear();
      break;
    case 1:  // TCP.
      break;
    default:
      caller.secured = true;
      if (who % 4 == 3) caller.certificate = Certificate((who >> 2) % 4);
  }
  return caller;
}

v1::Hello AnyHello(Input& input) {
  v1::Hello hello;
  const std::uint8_t how = input.Byte();
  if (how >= 250) {
    Fill(input, hello);
    return hello;
  }
  hello.set_protocol_major((how & 128) != 0 ? 2 : 1);
  hello.set_role(static_cast<v1::Role>(how % 8 - 1));
  const Bytes name = (how & 64) != 0 ? input.String() : Bytes();
  hello.set_client_name(std::string(name.begin(), name.end()));
  if ((how & 8) == 0) return hello;
  const Bytes guess = (how & 16) != 0 ? Bytes() : input.String();
  hello.set_token((how & 16) == 0   ? std::string(guess.begin(), guess.end())
                  : (how & 32) == 0 ? kToken
                                    : kViewToken);
  return hello;
}

class Door {
 public:
  explicit Door(Input& input)
      : options_(Options(input)),
        state_{transport::TokenGuard(options_.token, options_.view_token)} {}

  void Step(Input& input) {
    const std::uint8_t what = input.Byte();
    if (what < 40) {
      now_ns_ += std::int64_t{what} * 250'000'000;
    } else if (what < 80) {
      EndOne(what);
    } else {
      Ask(AnyCaller(input), AnyHello(input));
    }
    CheckCounts();
  }

  void End() {
    while (!inside_.empty()) EndOne(0);
    Expect(state_.places.empty());
  }

 private:
  void Ask(const Caller& caller, const v1::Hello& hello) {
    const transport::AdmissionState before = state_;
    const Admission answer = Admit(options_, kOwn, caller, hello, now_ns_, state_);
    if (const auto* admitted = std::get_if<Admitted>(&answer)) {
      CheckRole(*admitted, caller, hello);
      inside_.push_back(*admitted);
    } else {
      CheckRefusal(std::get<NotAdmitted>(answer), caller, hello, before);
    }
  }

  bool HasToken(const v1::Hello& hello) const {
    return !options_.token.empty() && hello.token() == options_.token;
  }
  bool HasViewToken(const v1::Hello& hello) const {
    return !options_.view_token.empty() && hello.token() == options_.view_token;
  }

  /// Role by the rules, counted up from what the caller is.
  v1::Role Deserved(const Caller& caller, const v1::Hello& hello) const {
    if (caller.peer.known) {
      if (caller.peer.user == 0 || caller.peer.user == kOwn.user) return v1::ROLE_ADMIN;
      return caller.peer.groups[0] == kOwn.group ? v1::ROLE_CONTROL : v1::ROLE_LOG;
    }
    const auto known = options_.clients.find(caller.certificate);
    if (known != options_.clients.end()) return known->second;
    if (HasToken(hello)) return v1::ROLE_CONTROL;
    if (HasViewToken(hello) && (caller.secured || options_.insecure_lan)) return v1::ROLE_VIEW;
    return caller.secured || options_.insecure_lan ? v1::ROLE_UNSPECIFIED : v1::ROLE_LOG;
  }

  void CheckRole(const Admitted& admitted, const Caller& caller, const v1::Hello& hello) {
    Expect(hello.protocol_major() == 1);
    Expect(admitted.role >= v1::ROLE_VIEW && admitted.role <= admitted.highest);
    Expect(admitted.highest == Deserved(caller, hello));
    Expect(admitted.role == std::max(hello.role(), v1::ROLE_VIEW));
    Expect(admitted.client_name.size() <= 64);
    for (const char c : admitted.client_name) Expect(c >= ' ' && c <= '~');
  }

  void CheckRefusal(const NotAdmitted& refused, const Caller& caller, const v1::Hello& hello,
                    transport::AdmissionState before) {
    using R = v1::Refused;
    const auto reason = refused.answer.reason();
    Expect(reason == R::REASON_TOKEN || reason == R::REASON_PROTOCOL_VERSION ||
           reason == R::REASON_ROLE || reason == R::REASON_TOO_MANY_SESSIONS);
    Expect(!refused.answer.message().empty() && refused.answer.message().size() < 1000);
    Expect((refused.lack == transport::Lack::kNone) == (reason != R::REASON_TOKEN));
    Expect(refused.lack_text.empty() == (reason != R::REASON_TOKEN));
    const std::string all = refused.answer.message() + refused.lack_text;
    Expect(all.find(kToken) == std::string::npos && all.find(kViewToken) == std::string::npos);
    if (reason != R::REASON_TOKEN || hello.token().empty()) return;
    const bool right = HasToken(hello) || HasViewToken(hello);
    Expect(!right);  // At any time, whatever its host has guessed.
    v1::Hello other = hello;
    other.set_token(hello.token() + "x");
    transport::AdmissionState same = before;
    if (!HasToken(other) && !HasViewToken(other)) {  // Another wrong token has the same answer.
      const Admission again = Admit(options_, kOwn, caller, other, now_ns_, same);
      const auto& answer = std::get<NotAdmitted>(again);
      Expect(answer.lack_text == refused.lack_text && answer.waits == refused.waits);
      Expect(answer.answer.SerializeAsString() == refused.answer.SerializeAsString());
    }
    if (refused.lack == transport::Lack::kRightToken && !refused.waits) {
      CheckGuesses(wrong_[caller.peer.host]);
    }
  }

  /// One more wrong token of a host was answered at once: five at once, then one in 5 s.
  void CheckGuesses(std::vector<std::int64_t>& guesses) {
    guesses.push_back(now_ns_);
    for (std::size_t i = 0; i < guesses.size(); ++i) {
      const double since_s = static_cast<double>(now_ns_ - guesses[i]) * 1e-9;
      Expect(static_cast<double>(guesses.size() - i) <= 5 + since_s / 5 + 1e-6);
    }
  }

  void EndOne(std::uint8_t which) {
    if (inside_.empty()) return;
    const auto one = inside_.begin() + static_cast<std::ptrdiff_t>(which % inside_.size());
    Leave(*one, state_);
    inside_.erase(one);
  }

  void CheckCounts() {
    std::int64_t logs = 0, controls = 0;
    for (const Admitted& one : inside_) {
      if (one.may_administer()) continue;
      logs += one.role == v1::ROLE_LOG ? 1 : 0;
      controls += one.role == v1::ROLE_CONTROL ? 1 : 0;
    }
    Expect(logs <= options_.sessions.max_log_sessions);
    Expect(controls <= options_.sessions.max_control_sessions);
    Expect(logs == state_.places.with_role(v1::ROLE_LOG));
    Expect(controls == state_.places.with_role(v1::ROLE_CONTROL));
    std::map<std::string, std::int64_t> of_host, of_certificate;
    for (const Admitted& one : inside_) {
      if (one.may_administer() || one.role == v1::ROLE_CONTROL) continue;
      const transport::Claim& claim = one.claim;
      Expect(claim.host.empty() ||
             ++of_host[claim.host] <= options_.sessions.max_sessions_per_host);
      Expect(claim.certificate.empty() ||
             ++of_certificate[claim.certificate] <= options_.sessions.max_sessions_per_certificate);
    }
  }

  transport::ServerOptions options_;
  transport::AdmissionState state_;
  std::int64_t now_ns_ = 1;
  std::vector<Admitted> inside_;
  std::map<std::string, std::vector<std::int64_t>> wrong_;  ///< Times of each host's guesses.
};

}  // namespace
}  // namespace footing::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace footing;
  fuzz::Input input(data, size);
  fuzz::Door door(input);
  while (!input.empty()) door.Step(input);
  door.End();
  return 0;
}
