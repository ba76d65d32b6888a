#include "daemon/sensor/reports/sequencer.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/sensor/reports/fixture.h"
#include "tests/sensor/reports/port_model.h"

namespace footing::handshake {
namespace {

using virtual_devices::Report;
using KeepAliveTalk = Conversation<PortModel>;

constexpr std::int64_t kMs = 1'000'000;

TEST(KeepAlive, AStatusBringsTheModeAtOnceAndAgainWhenNoDataCame) {
  KeepAlive keep_alive;
  keep_alive.OnData(1000 * kMs);
  keep_alive.OnStatus(1000 * kMs);
  std::vector<std::int64_t> set_ms;
  for (std::int64_t ms = 1000; ms < 1190; ++ms) {
    if (keep_alive.Advance(ms * kMs) == KeepAlive::Action::kSetMode) set_ms.push_back(ms - 1000);
  }
  EXPECT_EQ(set_ms, (std::vector<std::int64_t>{5, 60}));
}

TEST(KeepAlive, WhenDataCameTheSecondTryIsSpared) {
  KeepAlive keep_alive;
  keep_alive.OnData(1000 * kMs);
  keep_alive.OnStatus(1000 * kMs);
  int set = 0;
  for (std::int64_t ms = 1000; ms < 3000; ++ms) {
    if (ms % 10 == 0) keep_alive.OnData(ms * kMs);
    set += keep_alive.Advance(ms * kMs) == KeepAlive::Action::kSetMode ? 1 : 0;
  }
  EXPECT_EQ(set, 1);
}

TEST(KeepAlive, SilenceBringsTheModeThenTheStatus) {
  KeepAlive keep_alive;
  keep_alive.OnData(0);
  std::vector<std::int64_t> asked_ms;
  int set = 0;
  for (std::int64_t ms = 0; ms < 12'000; ++ms) {
    const auto action = keep_alive.Advance(ms * kMs);
    if (action == KeepAlive::Action::kAskStatus) asked_ms.push_back(ms);
    set += action == KeepAlive::Action::kSetMode ? 1 : 0;
  }
  ASSERT_EQ(asked_ms.size(), 2u);
  EXPECT_NEAR(static_cast<double>(asked_ms[0]), 5000, 2000);  // With the try that is due.
  EXPECT_LE(set, 10);
}

KeepAliveTalk Live() {
  KeepAliveTalk talk(PortModel(), "Nintendo RVL-CNT-01");
  talk.sample = [](PortModel& model) { return model.Sample(); };
  talk.Advance(1);
  return talk;
}

TEST(KeepAlive, TheKernelsDriverLosesEveryTime) {
  // It sends 12 00 30 right after every status report, also after one that we asked for.
  KeepAliveTalk talk = Live();
  talk.Advance(1);
  talk.on_input = [&talk](Report& report) {
    if (report[0] == 0x20) talk.device().HandleOutput(Report{0x12, 0x00, 0x30});
    return true;
  };
  int data = 0;
  for (int i = 0; i < 6; ++i) {  // 30 s, a status request every 5 s.
    ASSERT_TRUE(talk.kind().RequestStatus(talk.now_ns()));
    for (int step = 0; step < 1000; ++step) {
      talk.Advance(0.005);
      data += talk.device().controller().mode() == 0x31 ? 1 : 0;
    }
  }
  EXPECT_GE(data, 6000 * 0.99);
}

TEST(KeepAlive, TheStatusIsAskedForAtMostOnceASecond) {
  KeepAliveTalk talk = Live();
  const int before = talk.Sent(0x15);
  for (int i = 0; i < 500; ++i) {
    talk.kind().RequestStatus(talk.now_ns());
    talk.Advance(0.01);
  }
  EXPECT_GE(talk.Sent(0x15) - before, 4);
  EXPECT_LE(talk.Sent(0x15) - before, 6);
}

TEST(KeepAlive, AnHourThatPassesUnseenIsNoSilence) {
  KeepAliveTalk talk = Live();
  const int modes = talk.Sent(0x12);
  talk.Jump(3600);
  talk.Advance(2);
  EXPECT_TRUE(talk.handshake().live());
  EXPECT_EQ(talk.Note(), "");
  EXPECT_LE(talk.Sent(0x12) - modes, 2);
}

TEST(KeepAlive, WhateverComesInOutputsAreBounded) {
  for (const int kind : {0, 1, 2, 3}) {
    KeepAliveTalk talk = Live();
    std::mt19937 random(static_cast<unsigned>(7 + kind));
    int sent = 0;
    talk.on_output = [&sent](reports::OutputReport&) { return ++sent > 0; };
    constexpr int kSeconds = 60;
    for (int i = 0; i < kSeconds * 200; ++i) {
      Report report(22);
      for (auto& byte : report) byte = static_cast<std::uint8_t>(random());
      if (kind == 0) report = {0x20, 0, 0, static_cast<std::uint8_t>(random() & 2), 0, 0, 0xc0};
      if (kind == 1) report[0] = 0x21;
      if (kind == 2) report = {0x22, 0, 0, static_cast<std::uint8_t>(0x10 + random() % 12), 0};
      if (kind == 3) report[0] = static_cast<std::uint8_t>(0x20 + random() % 32);
      talk.Receive(report);
      talk.Advance(0.005);
    }
    EXPECT_LE(sent, 40 + 10 * kSeconds) << kind;  // The budget: 40 at once, then 10 a second.
  }
}

}  // namespace
}  // namespace footing::handshake
