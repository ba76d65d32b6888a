#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "common/net/admission.h"

namespace footing::transport {
namespace {

constexpr char kRightToken[] = "0123456789abcdef";
constexpr char kRightViewToken[] = "view-0123456789abcdef";
constexpr ServerUser kOwnUser{1000, 1000};
constexpr std::int64_t kHelloNs = 1'000'000'000;

const Caller kServersUser{{true, 1000, {1000}}};
const Caller kRoot{{true, 0, {0}}};
const Caller kMember{{true, 2000, {2000, 1000}}};
const Caller kStranger{{true, 2000, {2000}}};
const Caller kOverTcp{{false, 0, {}, "10.0.0.1"}};
const Caller kOverTls{{false, 0, {}, "10.0.0.1"}, true};
const Caller kViewersCertificate{{false, 0, {}, "10.0.0.1"}, true, "sha256:view"};
const Caller kOperatorsCertificate{{false, 0, {}, "10.0.0.1"}, true, "sha256:control"};
const Caller kUnknownCertificate{{false, 0, {}, "10.0.0.1"}, true, "sha256:unknown"};

ServerOptions GuardedServer() {
  ServerOptions options;
  options.server_id = "test-server";
  options.token = kRightToken;
  options.view_token = kRightViewToken;
  options.clients = {{"sha256:view", v1::ROLE_VIEW}, {"sha256:control", v1::ROLE_CONTROL}};
  return options;
}

ServerOptions OpenServer() {
  ServerOptions options;
  options.server_id = "test-server";
  return options;
}

ServerOptions InsecureLanServer() {
  ServerOptions options = GuardedServer();
  options.insecure_lan = true;
  return options;
}

v1::Hello HelloFor(v1::Role role, const std::string& token = "") {
  v1::Hello hello;
  hello.set_protocol_major(1);
  hello.set_role(role);
  hello.set_token(token);
  hello.set_client_name("viewer");
  return hello;
}

AdmissionState StateOf(const ServerOptions& options) {
  return {TokenGuard(options.token, options.view_token)};
}

Admission AdmitAlone(const ServerOptions& options, const Caller& caller, const v1::Hello& hello) {
  AdmissionState state = StateOf(options);
  return Admit(options, kOwnUser, caller, hello, kHelloNs, state);
}

/// The highest role that is granted, and the reason for which the next higher one is refused.
struct AccessRow {
  const char* what;
  ServerOptions options;
  Caller caller;
  std::string token;
  v1::Role highest;  ///< ROLE_UNSPECIFIED: not even view.
  v1::Refused::Reason above;
};

TEST(Admission, EachCallerGetsItsHighestRoleAndNoMore) {
  constexpr auto kRole = v1::Refused::REASON_ROLE, kProof = v1::Refused::REASON_TOKEN;
  const std::vector<AccessRow> rows = {
      {"server's user", GuardedServer(), kServersUser, "", v1::ROLE_ADMIN, kRole},
      {"root", GuardedServer(), kRoot, "", v1::ROLE_ADMIN, kRole},
      {"member of its group", GuardedServer(), kMember, "", v1::ROLE_CONTROL, kRole},
      {"another user", GuardedServer(), kStranger, "", v1::ROLE_LOG, kRole},
      {"another user with the token", GuardedServer(), kStranger, kRightToken, v1::ROLE_LOG, kRole},
      {"another user with a wrong token", GuardedServer(), kStranger, "wrong", v1::ROLE_LOG, kRole},
      {"TCP", GuardedServer(), kOverTcp, "", v1::ROLE_LOG, kRole},
      {"TCP, token", GuardedServer(), kOverTcp, kRightToken, v1::ROLE_CONTROL, kRole},
      {"TCP, wrong token", GuardedServer(), kOverTcp, "wrong", v1::ROLE_UNSPECIFIED, kProof},
      {"TCP, a part of the token", GuardedServer(), kOverTcp, "0123456789", v1::ROLE_UNSPECIFIED,
       kProof},
      {"TCP, token where there is none", OpenServer(), kOverTcp, kRightToken, v1::ROLE_LOG, kRole},
      {"insecure_lan", InsecureLanServer(), kOverTcp, "", v1::ROLE_UNSPECIFIED, kProof},
      {"insecure_lan, token", InsecureLanServer(), kOverTcp, kRightToken, v1::ROLE_CONTROL, kRole},
      {"TLS", GuardedServer(), kOverTls, "", v1::ROLE_UNSPECIFIED, kProof},
      {"TLS, token", GuardedServer(), kOverTls, kRightToken, v1::ROLE_CONTROL, kRole},
      {"TLS, view token", GuardedServer(), kOverTls, kRightViewToken, v1::ROLE_VIEW, kRole},
      {"TCP, view token", GuardedServer(), kOverTcp, kRightViewToken, v1::ROLE_LOG, kRole},
      {"insecure_lan, view token", InsecureLanServer(), kOverTcp, kRightViewToken, v1::ROLE_VIEW,
       kRole},
      {"TLS where nothing is known", OpenServer(), kOverTls, kRightToken, v1::ROLE_UNSPECIFIED,
       kProof},
      {"viewer's certificate", GuardedServer(), kViewersCertificate, "", v1::ROLE_VIEW, kRole},
      {"viewer's, token", GuardedServer(), kViewersCertificate, kRightToken, v1::ROLE_VIEW, kRole},
      {"operator's", GuardedServer(), kOperatorsCertificate, "", v1::ROLE_CONTROL, kRole},
      {"operator's, wrong", GuardedServer(), kOperatorsCertificate, "x", v1::ROLE_CONTROL, kRole},
      {"unknown certificate", GuardedServer(), kUnknownCertificate, "", v1::ROLE_UNSPECIFIED,
       kProof},
      {"unknown, token", GuardedServer(), kUnknownCertificate, kRightToken, v1::ROLE_CONTROL,
       kRole},
  };
  for (const AccessRow& row : rows) {
    for (int role = v1::ROLE_VIEW; role <= v1::ROLE_ADMIN + 1; ++role) {
      const auto hello = HelloFor(static_cast<v1::Role>(role), row.token);
      const Admission answer = AdmitAlone(row.options, row.caller, hello);
      const auto* admitted = std::get_if<Admitted>(&answer);
      ASSERT_EQ(admitted != nullptr, role <= row.highest) << row.what << ", role " << role;
      if (admitted != nullptr) {
        EXPECT_EQ(admitted->role, role) << row.what;
        EXPECT_EQ(admitted->highest, row.highest) << row.what;
      } else {
        EXPECT_EQ(std::get<NotAdmitted>(answer).answer.reason(), row.above) << row.what;
        EXPECT_EQ(std::get<NotAdmitted>(answer).lack == Lack::kNone, row.above == kRole)
            << row.what;
      }
    }
  }
}

TEST(Admission, NoRoleIsViewAndAnImpossibleOneIsRefused) {
  const Admission none = AdmitAlone(OpenServer(), kStranger, HelloFor(v1::ROLE_UNSPECIFIED));
  ASSERT_TRUE(std::holds_alternative<Admitted>(none));
  EXPECT_EQ(std::get<Admitted>(none).role, v1::ROLE_VIEW);
  for (const int role : {-1, -2147483647 - 1, 5, 2147483647}) {
    const Admission answer =
        AdmitAlone(OpenServer(), kServersUser, HelloFor(static_cast<v1::Role>(role)));
    ASSERT_TRUE(std::holds_alternative<NotAdmitted>(answer)) << role;
    EXPECT_EQ(std::get<NotAdmitted>(answer).answer.reason(), v1::Refused::REASON_ROLE);
  }
}

TEST(Admission, WhoIsNotKnownDoesNotLearnTheVersion) {
  v1::Hello hello = HelloFor(v1::ROLE_VIEW);
  hello.set_protocol_major(2);
  const auto stranger = std::get<NotAdmitted>(AdmitAlone(GuardedServer(), kOverTls, hello));
  EXPECT_EQ(stranger.answer.reason(), v1::Refused::REASON_TOKEN);
  hello.set_token(kRightToken);
  const auto known = std::get<NotAdmitted>(AdmitAlone(GuardedServer(), kOverTls, hello));
  EXPECT_EQ(known.answer.reason(), v1::Refused::REASON_PROTOCOL_VERSION);
}

TEST(Admission, RolesHaveCountedPlacesThatComeBack) {
  ServerOptions options = OpenServer();
  options.sessions.max_log_sessions = 1;
  options.sessions.max_control_sessions = 1;
  AdmissionState state = StateOf(options);
  const auto ask = [&](const Caller& caller, v1::Role role) -> std::optional<Admitted> {
    const auto answer = Admit(options, kOwnUser, caller, HelloFor(role), kHelloNs, state);
    if (const auto* admitted = std::get_if<Admitted>(&answer)) return *admitted;
    EXPECT_EQ(std::get<NotAdmitted>(answer).answer.reason(), v1::Refused::REASON_TOO_MANY_SESSIONS);
    return std::nullopt;
  };
  const auto first = ask(kStranger, v1::ROLE_LOG);
  ASSERT_TRUE(first);
  EXPECT_FALSE(ask(kOverTcp, v1::ROLE_LOG)) << "one log session already";
  EXPECT_TRUE(ask(kMember, v1::ROLE_CONTROL)) << "another role has its own places";
  EXPECT_FALSE(ask(kMember, v1::ROLE_CONTROL));
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(ask(kOverTcp, v1::ROLE_VIEW)) << "viewers are not counted";
    const auto administrator = ask(kServersUser, v1::ROLE_LOG);
    ASSERT_TRUE(administrator) << "administrators have places of their own";
    Leave(*administrator, state);
  }
  EXPECT_FALSE(ask(kOverTcp, v1::ROLE_LOG)) << "an administrator's end frees no place of others";
  Leave(*first, state);
  EXPECT_TRUE(ask(kOverTcp, v1::ROLE_LOG));
}

TEST(Admission, WhoIsRefusedTakesNoPlace) {
  ServerOptions options = GuardedServer();
  options.sessions.max_control_sessions = 1;
  AdmissionState state = StateOf(options);
  v1::Hello other_version = HelloFor(v1::ROLE_CONTROL, kRightToken);
  other_version.set_protocol_major(2);
  for (const auto& hello : {HelloFor(v1::ROLE_CONTROL, "wrong"), HelloFor(v1::ROLE_CONTROL),
                            HelloFor(v1::ROLE_ADMIN, kRightToken), other_version}) {
    const auto answer = Admit(options, kOwnUser, kOverTcp, hello, kHelloNs, state);
    EXPECT_TRUE(std::holds_alternative<NotAdmitted>(answer));
  }
  const auto answer =
      Admit(options, kOwnUser, kOverTcp, HelloFor(v1::ROLE_CONTROL, kRightToken), kHelloNs, state);
  EXPECT_TRUE(std::holds_alternative<Admitted>(answer));
}

TEST(Admission, AWrongTokenShowsNowhere) {
  for (const std::string& wrong : {std::string("0123456789abcdeX"), std::string("X")}) {
    const auto refused = std::get<NotAdmitted>(
        AdmitAlone(GuardedServer(), kOverTls, HelloFor(v1::ROLE_VIEW, wrong)));
    const std::string all = refused.answer.message() + refused.lack_text;
    EXPECT_EQ(all.find(wrong), std::string::npos) << all;
    EXPECT_EQ(all.find(kRightToken), std::string::npos) << all;
  }
}

TEST(Admission, ARightTokenComesInWhileItsHostGuesses) {
  const ServerOptions options = GuardedServer();
  AdmissionState state = StateOf(options);
  const auto ask = [&](const std::string& token) {
    return Admit(options, kOwnUser, kOverTls, HelloFor(v1::ROLE_VIEW, token), kHelloNs, state);
  };
  for (int i = 0; i < 100; ++i) {
    const auto wrong = std::get<NotAdmitted>(ask("wrong"));
    EXPECT_EQ(wrong.waits, i >= 5) << "the first ones may be typing errors";
    const auto right = ask(i % 2 == 0 ? kRightToken : kRightViewToken);
    ASSERT_TRUE(std::holds_alternative<Admitted>(right));
    Leave(std::get<Admitted>(right), state);
  }
}

TEST(Admission, AnUnknownCertificateIsNamedWithWhatLetsItIn) {
  const auto refused =
      std::get<NotAdmitted>(AdmitAlone(GuardedServer(), kUnknownCertificate, HelloFor({})));
  EXPECT_EQ(refused.lack, Lack::kKnownCertificate);
  EXPECT_NE(refused.lack_text.find("add the line \"sha256:unknown view\""), std::string::npos)
      << refused.lack_text;
  EXPECT_EQ(refused.lack_text.find("no token"), std::string::npos);
  const auto nothing = std::get<NotAdmitted>(AdmitAlone(GuardedServer(), kOverTls, HelloFor({})));
  EXPECT_EQ(nothing.lack_text, "neither a token nor a certificate");
}

/// Asks again and again; how often it came in.
int TimesIn(const ServerOptions& options, const Caller& caller, v1::Role role,
            const std::string& token, int times, AdmissionState& state) {
  int admitted = 0;
  for (int i = 0; i < times; ++i) {
    const auto answer = Admit(options, kOwnUser, caller, HelloFor(role, token), kHelloNs, state);
    admitted += std::holds_alternative<Admitted>(answer) ? 1 : 0;
  }
  return admitted;
}

TEST(Admission, OneCertificateOrAddressLeavesPlacesToOthers) {
  const ServerOptions options = GuardedServer();  // With the default limits.
  AdmissionState state = StateOf(options);
  const Caller elsewhere{{false, 0, {}, "10.0.0.2"}, true};
  EXPECT_EQ(TimesIn(options, kViewersCertificate, v1::ROLE_VIEW, "", 250, state), 16);
  EXPECT_EQ(TimesIn(options, kOverTls, v1::ROLE_VIEW, kRightViewToken, 250, state), 64 - 16)
      << "of the same address";
  EXPECT_EQ(TimesIn(options, kOperatorsCertificate, v1::ROLE_CONTROL, "", 50, state), 16)
      << "control is counted apart, half of its places";
  EXPECT_EQ(TimesIn(options, kOverTls, v1::ROLE_CONTROL, kRightToken, 50, state), 0);
  EXPECT_EQ(TimesIn(options, elsewhere, v1::ROLE_CONTROL, kRightToken, 50, state), 16);
  EXPECT_EQ(TimesIn(options, elsewhere, v1::ROLE_VIEW, kRightViewToken, 250, state), 64);
  for (int host = 3; host < 10; ++host) {
    const Caller other{{false, 0, {}, "10.0.0." + std::to_string(host)}, true};
    TimesIn(options, other, v1::ROLE_VIEW, kRightViewToken, 100, state);
  }
  EXPECT_EQ(state.places.with_role(v1::ROLE_VIEW), 224 - 16) << "16 places wait for control";
  EXPECT_EQ(TimesIn(options, kMember, v1::ROLE_VIEW, "", 1, state), 1) << "a local user";
}

TEST(Admission, PlacesComeBackWithTheLastSession) {
  ServerOptions options = GuardedServer();
  options.sessions.max_sessions_per_certificate = 1;
  AdmissionState state = StateOf(options);
  for (int i = 0; i < 3; ++i) {
    const auto one =
        Admit(options, kOwnUser, kViewersCertificate, HelloFor(v1::ROLE_VIEW), kHelloNs, state);
    ASSERT_TRUE(std::holds_alternative<Admitted>(one));
    const auto other =
        Admit(options, kOwnUser, kViewersCertificate, HelloFor(v1::ROLE_VIEW), kHelloNs, state);
    const auto& refused = std::get<NotAdmitted>(other).answer;
    EXPECT_EQ(refused.reason(), v1::Refused::REASON_TOO_MANY_SESSIONS);
    EXPECT_NE(refused.message().find("1 sessions of this certificate already"), std::string::npos);
    Leave(std::get<Admitted>(one), state);
    EXPECT_TRUE(state.places.empty());
  }
}

TEST(Admission, FewPlacesAreNotKeptForControl) {
  ServerOptions options = GuardedServer();
  options.sessions.max_sessions = 3;  // A quarter of them is none.
  AdmissionState state = StateOf(options);
  EXPECT_EQ(TimesIn(options, kOverTls, v1::ROLE_VIEW, kRightViewToken, 5, state), 3);
}

TEST(Admission, WhatGaveTheRoleIsRevoked) {
  const ServerOptions before = GuardedServer();
  ServerOptions now = before;
  const auto admit = [&](const Caller& caller, v1::Role role, const std::string& token) {
    return std::get<Admitted>(AdmitAlone(before, caller, HelloFor(role, token)));
  };
  const auto by_token = admit(kOverTls, v1::ROLE_CONTROL, kRightToken);
  const auto by_view_token = admit(kOverTls, v1::ROLE_VIEW, kRightViewToken);
  const auto by_certificate = admit(kOperatorsCertificate, v1::ROLE_LOG, "");
  const auto viewer = admit(kViewersCertificate, v1::ROLE_VIEW, "");
  const auto local = admit(kMember, v1::ROLE_CONTROL, "");
  const auto all = {by_token, by_view_token, by_certificate, viewer, local};
  for (const Admitted& one : all) EXPECT_EQ(WhyRevoked(before, now, one), "");

  now.token = "another-0123456789";
  now.view_token.clear();
  now.clients["sha256:control"] = v1::ROLE_VIEW;
  now.clients.erase("sha256:view");
  const auto says = [&](const Admitted& one, const std::string& text) {
    return WhyRevoked(before, now, one).find(text) != std::string::npos;
  };
  EXPECT_TRUE(says(by_token, "the token in the server's token_file was replaced"));
  EXPECT_TRUE(says(by_view_token, "no view_token_file any more"));
  EXPECT_TRUE(says(by_certificate, "only the role view now"));
  EXPECT_TRUE(says(viewer, "sha256:view was removed from the server's clients_file"));
  EXPECT_EQ(WhyRevoked(before, now, local), "");
  now.clients["sha256:control"] = v1::ROLE_LOG;
  EXPECT_EQ(WhyRevoked(before, now, by_certificate), "") << "the role that it has";
}

TEST(Admission, NamesAreShortAndPrintable) {
  v1::Hello hello = HelloFor(v1::ROLE_VIEW);
  hello.set_client_name("a\x1b[2J\n" + std::string(100, 'b'));
  const auto admitted = std::get<Admitted>(AdmitAlone(OpenServer(), kOverTcp, hello));
  EXPECT_EQ(admitted.client_name, "a?[2J?" + std::string(58, 'b'));
}

constexpr std::uint32_t kRetained = 16;
constexpr std::uint32_t kStream = 17;

SharedTick MakeTick(std::uint64_t sequence, const std::string& retained = "") {
  auto tick = std::make_shared<Tick>();
  tick->sequence = sequence;
  AppendField(kStream, "s", *tick);
  if (!retained.empty()) AppendField(kRetained, retained, *tick);
  return tick;
}

std::uint64_t PopSequence(TickQueue& queue) {
  TickQueue::Entry entry;
  return queue.Pop(entry) ? entry.tick->sequence : 0;
}

TEST(TickQueue, DropOldestKeepsTheNewestAndSaysWhatIsMissing) {
  TickQueue queue(QueueRule::kDropOldest, 3, {});
  for (std::uint64_t sequence = 1; sequence <= 8; ++sequence) {
    EXPECT_TRUE(queue.Push(MakeTick(sequence)));
  }
  EXPECT_EQ(queue.size(), 3u);
  const auto dropped = queue.TakeDropped();
  ASSERT_TRUE(dropped.has_value());
  EXPECT_EQ(dropped->from, 1u);
  EXPECT_EQ(dropped->to, 5u);
  EXPECT_FALSE(queue.TakeDropped().has_value());
  EXPECT_EQ(queue.dropped_ticks(), 5u);
  EXPECT_EQ(PopSequence(queue), 6u);
}

TEST(TickQueue, LatestHoldsOne) {
  TickQueue queue(QueueRule::kLatest, 100, {});
  queue.Push(MakeTick(1));
  queue.Push(MakeTick(2));
  EXPECT_EQ(queue.size(), 1u);
  EXPECT_EQ(PopSequence(queue), 2u);
}

TEST(TickQueue, ReliableRefusesOneTooMany) {
  TickQueue queue(QueueRule::kReliable, 2, {});
  EXPECT_TRUE(queue.Push(MakeTick(1)));
  EXPECT_TRUE(queue.Push(MakeTick(2)));
  EXPECT_FALSE(queue.Push(MakeTick(3)));
  EXPECT_EQ(PopSequence(queue), 1u);
  EXPECT_EQ(queue.dropped_ticks(), 0u);
}

TEST(TickQueue, ARetainedValueOutlivesTheTickItWasDroppedWith) {
  TickQueue queue(QueueRule::kDropOldest, 2, {kRetained});
  const SharedTick newest = MakeTick(2, "newest");
  queue.Push(MakeTick(1, "older"));
  queue.Push(newest);
  for (std::uint64_t sequence = 3; sequence <= 6; ++sequence) queue.Push(MakeTick(sequence));
  TickQueue::Entry entry;
  ASSERT_TRUE(queue.Pop(entry));
  EXPECT_EQ(entry.tick->sequence, 5u);
  ASSERT_EQ(entry.retained.size(), 1u);
  EXPECT_EQ(entry.retained[0].tick, newest);
  ASSERT_TRUE(queue.Pop(entry));
  EXPECT_TRUE(entry.retained.empty());
}

TEST(TickQueue, ASkippedTickLeavesItsRetainedValueToTheNextOne) {
  TickQueue queue(QueueRule::kDropOldest, 2, {kRetained});
  queue.Push(MakeTick(1));
  queue.Skip(MakeTick(2, "status"));
  queue.Push(MakeTick(3));
  TickQueue::Entry entry;
  queue.Pop(entry);
  EXPECT_TRUE(entry.retained.empty());  // It is older than the value.
  queue.Pop(entry);
  ASSERT_EQ(entry.retained.size(), 1u);
  EXPECT_EQ(entry.retained[0].tick->sequence, 2u);
  EXPECT_FALSE(queue.TakeDropped().has_value());  // Decimation is no Gap.
}

TEST(TickQueue, ASkippedValueIsNewerThanADroppedOne) {
  TickQueue queue(QueueRule::kLatest, 1, {kRetained});
  queue.Push(MakeTick(1, "dropped"));
  queue.Skip(MakeTick(2, "skipped"));
  queue.Push(MakeTick(3));
  TickQueue::Entry entry;
  ASSERT_TRUE(queue.Pop(entry));
  ASSERT_EQ(entry.retained.size(), 1u);
  EXPECT_EQ(entry.retained[0].tick->sequence, 2u);
}

}  // namespace
}  // namespace footing::transport
