#include "clients/relay/nats_protocol.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

namespace footing::relay::nats {
namespace {

constexpr std::size_t kMaxPayload = 1000;

/// Output of a parser, a line each.
struct Seen {
  std::vector<std::string> lines;
  Handlers handlers() {
    return {[this](const ServerInfo& info) {
              lines.push_back("info " + info.version + " " + std::to_string(info.max_payload) +
                              (info.auth_required ? " auth" : "") +
                              (info.tls_required ? " tls" : ""));
            },
            [this](const Message& message) {
              lines.push_back("message " + std::string(message.subject) + " " +
                              std::to_string(message.subscription) + " <" +
                              std::string(message.reply) + "> <" + std::string(message.payload) +
                              ">" + (message.no_responders ? " nobody" : ""));
            },
            [this] { lines.emplace_back("ping"); }, [this] { lines.emplace_back("pong"); },
            [this](std::string_view text) { lines.push_back("error " + std::string(text)); }};
  }
};

const std::string kStream =
    "INFO {\"server_id\":\"x\",\"version\":\"2.9.10\",\"max_payload\":1048576,"
    "\"auth_required\":true,\"connect_urls\":[\"a\",\"b\"]} \r\n"
    "+OK\r\n"
    "PING\r\n"
    "MSG footing.lab.footingd.tick 1 5\r\nab\r\nc\r\n"
    "MSG a 2 reply.to 0\r\n\r\n"
    "HMSG inbox 3 16 16\r\nNATS/1.0 503\r\n\r\n\r\n"
    "HMSG a 1 back 20 23\r\nNATS/1.0\r\nKey: v\r\n\r\nxyz\r\n"
    "-ERR 'Authorization Violation'\r\n"
    "PONG\r\n";

const std::vector<std::string> kSeen = {"info 2.9.10 1048576 auth",
                                        "ping",
                                        "message footing.lab.footingd.tick 1 <> <ab\r\nc>",
                                        "message a 2 <reply.to> <>",
                                        "message inbox 3 <> <> nobody",
                                        "message a 1 <back> <xyz>",
                                        "error Authorization Violation",
                                        "pong"};

TEST(Parser, TakesEveryMessageOfTheProtocol) {
  Seen seen;
  Parser parser(kMaxPayload);
  const auto taken = parser.Take(kStream, seen.handlers());
  ASSERT_TRUE(taken.ok()) << taken.error().message;
  EXPECT_EQ(seen.lines, kSeen);
  EXPECT_EQ(parser.buffered(), 0u);
}

TEST(Parser, BytesMayBeCutAnywhere) {
  for (std::size_t piece = 1; piece <= 40; ++piece) {
    Seen seen;
    Parser parser(kMaxPayload);
    for (std::size_t at = 0; at < kStream.size(); at += piece) {
      ASSERT_TRUE(parser.Take(std::string_view(kStream).substr(at, piece), seen.handlers()).ok());
    }
    EXPECT_EQ(seen.lines, kSeen) << piece;
  }
}

TEST(Parser, ALongPayloadIsRefusedWhenItIsAnnounced) {
  for (const char* const line :
       {"MSG a 1 1001\r\n", "HMSG a 1 3 1001\r\n", "MSG a 1 18446744073709551615\r\n"}) {
    Seen seen;
    Parser parser(kMaxPayload);
    EXPECT_FALSE(parser.Take(line, seen.handlers()).ok()) << line;
  }
}

TEST(Parser, ALineWithoutAnEndIsRefused) {
  Seen seen;
  Parser parser(kMaxPayload);
  const std::string piece(1000, 'x');
  bool refused = false;
  for (std::size_t fed = 0; !refused && fed < 2 * Parser::kMaxLineBytes; fed += piece.size()) {
    refused = !parser.Take(piece, seen.handlers()).ok();
    EXPECT_LE(parser.buffered(), Parser::kMaxLineBytes + piece.size());
  }
  EXPECT_TRUE(refused);
}

TEST(Parser, WhatIsNotNatsIsRefused) {
  for (const char* const bytes :
       {"HTTP/1.1 400 Bad Request\r\n", "MSG\r\n", "MSG a\r\n", "MSG a b 1\r\n", "MSG a 1 -1\r\n",
        "MSG a 1 r s 1\r\n", "HMSG a 1 1\r\n", "HMSG a 1 5 4\r\n", "MSG a 1 1\r\nabc\r\n",
        "INFO\r\n", "INFO []\r\n", "INFO {\"max_payload\":-1}\r\n",
        "INFO {\"max_payload\":\"1\"}\r\n", "\r\n"}) {
    Seen seen;
    Parser parser(kMaxPayload);
    EXPECT_FALSE(parser.Take(bytes, seen.handlers()).ok()) << bytes;
  }
}

/// Streams with bytes changed, left out and repeated, in pieces of any size: the parser refuses
/// them or goes on, and never holds more than a message.
TEST(Parser, SurvivesDamagedStreams) {
  std::mt19937 random(7);
  const auto below = [&](std::size_t bound) {
    return std::uniform_int_distribution<std::size_t>(0, bound - 1)(random);
  };
  std::size_t refused = 0;
  for (int run = 0; run < 20'000; ++run) {
    std::string bytes = kStream;
    for (std::size_t i = below(6) + 1; i > 0; --i) {
      const std::size_t at = below(bytes.size());
      const std::size_t kind = below(4);
      if (kind == 0) bytes[at] = static_cast<char>(below(256));
      if (kind == 1) bytes.erase(at, below(8));
      if (kind == 2) bytes.insert(at, bytes.substr(below(bytes.size()), below(30)));
      if (kind == 3) bytes.insert(at, std::to_string(below(100'000)));
    }
    Seen seen;
    Parser parser(kMaxPayload);
    bool wrong = false;
    for (std::size_t at = 0; !wrong && at < bytes.size();) {
      const std::size_t piece = below(100) + 1;
      wrong = !parser.Take(std::string_view(bytes).substr(at, piece), seen.handlers()).ok();
      EXPECT_LE(parser.buffered(), Parser::kMaxLineBytes + kMaxPayload + 100);
      at += piece;
    }
    refused += wrong ? 1 : 0;
  }
  EXPECT_GT(refused, 5'000u);   // Most damage is seen,
  EXPECT_LT(refused, 20'000u);  // and some falls into what a payload may be.
}

TEST(Requests, AreWhatTheServerExpects) {
  EXPECT_EQ(Subscribe("a.b", 7), "SUB a.b 7\r\n");
  EXPECT_EQ(Publish("a.b", "", std::string_view("x\r\ny", 4)), "PUB a.b 4\r\nx\r\ny\r\n");
  EXPECT_EQ(Publish("a.b", "back", ""), "PUB a.b back 0\r\n\r\n");
  EXPECT_NE(Connect("n", {"anna", "secret", ""}).find("\"user\":\"anna\",\"pass\":\"secret\""),
            std::string::npos);
  EXPECT_EQ(Connect("n", {}).find("pass"), std::string::npos);
  EXPECT_NE(Connect("n", {"", "", "tok\"en"}).find("\"auth_token\":\"tok\\\"en\""),
            std::string::npos);
}

TEST(Requests, APartOfASubjectHasNoSeparator) {
  for (const char* const part : {"lab1", "footing-sim", "a_B"}) EXPECT_TRUE(IsPart(part)) << part;
  for (const char* const text : {"", "a.b", "*", ">", "a b", "a/b", "#", "+", "a\r\n"}) {
    EXPECT_FALSE(IsPart(text)) << text;
  }
  EXPECT_FALSE(IsPart(std::string(65, 'a')));
}

}  // namespace
}  // namespace footing::relay::nats
