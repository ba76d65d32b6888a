#include <algorithm>

#include "tests/device_faults/fault.h"

namespace footing::device_faults {
namespace {

constexpr std::uint8_t kReadReply = 0x21;

/// For the first `times` read replies, what is sent instead.
auto InsteadOfReplies(int times, std::function<std::vector<Report>(Report)> instead) {
  return [times, instead = std::move(instead)](const Report& report) mutable {
    if (report[0] != kReadReply || times <= 0) return std::vector<Report>{report};
    --times;
    return instead(report);
  };
}

FOOTING_FAULT(Fault12MemoryErrors7And8) {
  Device& device = bench.Plug(std::make_shared<WiimoteModel>(12));
  // Not ready at first: no such register, then no such memory; then the truth. An error ends the
  // reply: of 20 bytes the second piece does not come.
  device.outgoing = InsteadOfReplies(4, [error = 7](Report report) mutable {
    if (report[5] != 0x16) return std::vector<Report>{};
    report[3] = static_cast<std::uint8_t>(0xf0 | error++);
    std::fill(report.begin() + 6, report.end(), 0);
    return std::vector<Report>{report};
  });
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  ASSERT_TRUE(bench.UntilSamples(device, 20));
  ExpectAllAtRest(device, 20);
  EXPECT_EQ(Status(device).calibration(), v1::CALIBRATION_ORIGIN_DEVICE);
}

FOOTING_FAULT(Fault13RepliesToSomebodyElsesRead) {
  Device& device = bench.Plug(std::make_shared<WiimoteModel>(13));
  // Before each true reply one of the driver's reads: the extension's identity, full of FF.
  device.outgoing = InsteadOfReplies(1000, [](Report report) {
    Report foreign = {kReadReply, 0, 0, 0x50, 0x00, 0xfa};
    foreign.resize(22, 0xff);
    return std::vector<Report>{foreign, report};
  });
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  ASSERT_TRUE(bench.UntilSamples(device, 20));
  ExpectAllAtRest(device, 20);
  EXPECT_EQ(Status(device).calibration(), v1::CALIBRATION_ORIGIN_DEVICE);
}

FOOTING_FAULT(Fault14MissingAcknowledgementsAndDoubledReplies) {
  auto board = std::make_shared<BoardModel>(14);
  Device& device = bench.Plug(board);
  // As BigBen's boards: a write is never acknowledged. The first piece is lost, others come twice.
  device.outgoing = [pieces = 0](const Report& report) mutable {
    if (report[0] == 0x22) return std::vector<Report>{};
    if (report[0] != kReadReply) return std::vector<Report>{report};
    if (++pieces == 1) return std::vector<Report>{};
    return std::vector<Report>{report, report};
  };
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device, 10));
  ASSERT_TRUE(bench.UntilSamples(device, 20));
  EXPECT_EQ(Status(device).calibration(), v1::CALIBRATION_ORIGIN_DEVICE);
  EXPECT_EQ(Status(device).kind(), v1::DEVICE_KIND_BALANCE_BOARD);
  for (const auto& sample : Boards(device)) EXPECT_NEAR(sample.total_n(), 660, 7);
}

FOOTING_FAULT(Fault15ShortLastPiece) {
  Device& device = bench.Plug(std::make_shared<WiimoteModel>(15));
  // 20 bytes come as 16 and 4: cut shorter once, the read is asked anew.
  device.outgoing = [done = false](const Report& report) mutable {
    Report cut = report;
    if (report[0] == kReadReply && report[3] == 0x30 && !done) {
      done = true;
      cut[3] = 0x10;
    }
    return std::vector<Report>{cut};
  };
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  ASSERT_TRUE(bench.UntilSamples(device, 20));
  const auto reads = std::count_if(
      device.outputs().begin(), device.outputs().end(),
      [](const auto& output) { return output.report[0] == 0x17 && output.report[4] == 0x16; });
  EXPECT_EQ(reads, 2);
  ExpectAllAtRest(device, 20);
  EXPECT_EQ(Status(device).calibration(), v1::CALIBRATION_ORIGIN_DEVICE);
}

FOOTING_FAULT(Fault16AcknowledgementWithError2) {
  Device& device = bench.Plug(std::make_shared<WiimoteModel>(16));
  // As a -TR that is disturbed: the mode is refused once, and not set.
  device.incoming = [&device, refused = 0](std::span<const std::uint8_t> report) mutable {
    if (report[0] != 0x12 || ++refused > 1) return false;
    device.SendRaw({0x22, 0, 0, 0x12, 2});
    return true;
  };
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  EXPECT_GE(device.Outputs(0x12), 2u);
  EXPECT_EQ(Status(device).mode_reasserts(), 0u);  // It was not taken for set until silence told.
  ASSERT_TRUE(bench.UntilSamples(device, 20));
  ExpectAllAtRest(device, 20);
}

FOOTING_FAULT(Fault17DisconnectBetweenTwoPieces) {
  auto board = std::make_shared<BoardModel>(17);
  Device* device = &bench.Plug(board);
  // The first piece of the 24 bytes of corners comes, then the link is gone.
  bool cut = false;
  device->outgoing = [&cut, device, pieces = 0](const Report& report) mutable {
    if (report[0] != kReadReply || report[5] < 0x20 || report[5] > 0x24 || ++pieces > 1) {
      return cut ? std::vector<Report>{} : std::vector<Report>{report};
    }
    cut = true;
    return std::vector<Report>{report};
  };
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.Until([&] { return cut; }));
  const std::string serial = device->serial();
  bench.Unplug(*device);
  ASSERT_TRUE(bench.UntilState(serial, v1::DEVICE_STATE_LOST));
  EXPECT_TRUE(bench.seen().Boards(serial).empty());
  Device& again = bench.Plug(std::make_shared<BoardModel>(17));
  ASSERT_TRUE(bench.UntilLive(again));
  ASSERT_TRUE(bench.UntilSamples(again, 20));
  EXPECT_EQ(Status(again).calibration(), v1::CALIBRATION_ORIGIN_DEVICE);
  for (const auto& sample : Boards(again)) EXPECT_NEAR(sample.total_n(), 660, 7);
}

FOOTING_FAULT(Fault18ReadSizeThatIsNoMultipleOf16) {
  auto board = std::make_shared<BoardModel>(18);
  Device& device = bench.Plug(board);
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  ASSERT_TRUE(bench.UntilSamples(device, 20));
  // 32 and 2 bytes of calibration, 6 of identity: sizes as asked, pieces of at most 16.
  std::size_t odd = 0;
  for (const auto& output : device.outputs()) {
    if (output.report[0] == 0x17 && output.report[6] % 16 != 0) ++odd;
  }
  EXPECT_GE(odd, 1u);
  EXPECT_EQ(Status(device).calibration(), v1::CALIBRATION_ORIGIN_DEVICE);
  const auto& sample = Boards(device).back();
  EXPECT_NEAR(sample.top_left_n(), 150, 2);
  EXPECT_NEAR(sample.top_right_n(), 160, 2);
  EXPECT_NEAR(sample.bottom_left_n(), 170, 2);
  EXPECT_NEAR(sample.bottom_right_n(), 180, 2);
}

}  // namespace
}  // namespace footing::device_faults
