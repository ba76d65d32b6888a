#include "tests/device_faults/fault.h"

namespace footing::device_faults {
namespace {

FOOTING_FAULT(Fault01EmptyOneByteAndTruncatedReports) {
  auto model = std::make_shared<WiimoteModel>(1);
  Device& device = bench.Plug(model);
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  bench.seen().Forget();
  const std::uint64_t undecodable = Status(device).undecodable();
  const Report at_rest = *model->wiimote.Sample(model->specific_force_S_mps2);
  // Each kind of report cut at each length: what is there is right, what is cut off was. What the
  // buffer still holds behind its end is of another report.
  std::uint64_t hopeless = 0;
  for (const std::uint8_t id : {0x20, 0x21, 0x22, 0x31, 0x33, 0x35, 0x37, 0x3d}) {
    const std::size_t whole = id == 0x20 ? 7 : id == 0x22 ? 5 : id == 0x31 ? 6 : 22;
    for (std::size_t size = 0; size < whole; ++size) {
      Report report = at_rest;
      report.resize(size, 0x00);
      if (size > 0) report[0] = id;
      device.SendRaw(Report(22, 0xee));
      device.SendRaw(report);
      hopeless += size == 1 ? 2 : 1;
    }
    bench.Run(0.02);
  }
  ASSERT_TRUE(bench.UntilSamples(device, 30));
  ExpectAllAtRest(device, 30);
  EXPECT_TRUE(bench.Until([&] { return Status(device).undecodable() >= undecodable + hopeless; }));
  EXPECT_EQ(Status(device).state(), v1::DEVICE_STATE_LIVE);
}

FOOTING_FAULT(Fault02ReportsLongerThanAnyReport) {
  Device& device = bench.Plug(std::make_shared<WiimoteModel>(2));
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  const std::uint64_t before = Status(device).undecodable();
  // Every second report has a tail of rubbish: no device sends that, so nothing in it counts.
  device.outgoing = [count = 0](const Report& report) mutable {
    Report longer = report;
    if (++count % 2 == 0) longer.resize(count % 4 == 0 ? 64 : 300, 0xee);
    return std::vector<Report>{longer};
  };
  ASSERT_TRUE(bench.UntilSamples(device, 50));
  ExpectAllAtRest(device, 50);
  EXPECT_TRUE(bench.Until([&] { return Status(device).undecodable() >= before + 40; }));
  EXPECT_EQ(Status(device).state(), v1::DEVICE_STATE_LIVE);
}

FOOTING_FAULT(Fault03UnknownReportIds) {
  Device& device = bench.Plug(std::make_shared<WiimoteModel>(3));
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  bench.seen().Forget();
  const std::uint64_t before = Status(device).undecodable();
  for (const std::uint8_t id : {0x00, 0x01, 0x10, 0x1f, 0x23, 0x2f, 0x40, 0x7f, 0x80, 0xff}) {
    Report report(22, 0x33);
    report[0] = id;
    device.SendRaw(report);
  }
  EXPECT_TRUE(bench.Until([&] { return Status(device).undecodable() == before + 10; }))
      << Status(device).undecodable() - before;
  ASSERT_TRUE(bench.UntilSamples(device, 30));
  ExpectAllAtRest(device, 30);
}

FOOTING_FAULT(Fault04ButtonsOnlyModeSetByAnother) {
  auto model = std::make_shared<WiimoteModel>(4);
  Device& device = bench.Plug(model);
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  bench.Run(1);  // A MotionPlus was looked for, after which the mode is set once more.
  // As hid-wiimote does after every status report: 12 00 30, and no more acceleration.
  for (int round = 0; round < 2; ++round) {
    // A clone goes on to send, but buttons only.
    const std::uint8_t flags = round == 0 ? 0x00 : 0x04;
    const std::uint8_t foreign[] = {0x12, flags, 0x30};
    model->wiimote.HandleOutput(foreign);
    ASSERT_EQ(model->wiimote.controller().mode(), 0x30);
    const std::size_t wanted = bench.Samples(device) + 20;
    // Samples of before the foreign mode may still be on their way.
    ASSERT_TRUE(bench.Within(2, [&] {
      return model->wiimote.controller().mode() != 0x30 && bench.Samples(device) >= wanted;
    })) << "the mode was not set again";
  }
  ExpectAllAtRest(device, 40);
  EXPECT_GE(Status(device).gaps(), 1u);
}

FOOTING_FAULT(Fault05ShortFormsOfDataReports) {
  auto model = std::make_shared<WiimoteModel>(5);
  model->buttons = 0x0008;  // A.
  Device& device = bench.Plug(model);
  // Every third data report is cut to id and buttons, as the kernel's driver accepts it.
  device.outgoing = [count = 0](const Report& report) mutable {
    Report shorter = report;
    if (report[0] >= 0x31 && report[0] <= 0x37 && ++count % 3 == 0) shorter.resize(3);
    return std::vector<Report>{shorter};
  };
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  ASSERT_TRUE(bench.UntilSamples(device, 40));
  ExpectAllAtRest(device, 40);
  for (const auto& sample : Motion(device)) ASSERT_EQ(sample.buttons() & 0x0008, 0x0008u);
  EXPECT_EQ(Status(device).undecodable(), 0u);
}

FOOTING_FAULT(Fault06AccelerationBitsInTheButtonBytes) {
  auto model = std::make_shared<WiimoteModel>(6);
  Device& device = bench.Plug(model);
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  // Turned slowly so that the low bits take every value; no button is down.
  double largest_error_mps2 = 0;
  for (int i = 0; i < 60; ++i) {
    const double angle = 0.005 * i;
    model->specific_force_S_mps2 = {9.80665 * std::sin(angle), 0, -9.80665 * std::cos(angle)};
    bench.Run(0.01);
  }
  bench.Run(0.1);
  bench.seen().Forget();
  ASSERT_TRUE(bench.UntilSamples(device, 20));
  for (const auto& sample : Motion(device)) {
    EXPECT_EQ(sample.buttons(), 0u);
    largest_error_mps2 = std::max(largest_error_mps2, std::abs(sample.specific_force_mps2().x() -
                                                               model->specific_force_S_mps2.x()));
  }
  EXPECT_LT(largest_error_mps2, 0.06);  // Half a count of ten bits: 9.81 / 104 / 2.
  std::set<int> low_bits;
  for (const auto& raw : bench.seen().Raw(device.serial())) {
    if (raw.report().size() == 6) low_bits.insert(raw.report()[1] & 0x60);
  }
  EXPECT_FALSE(low_bits.empty());
}

FOOTING_FAULT(Fault07HalfAnInterleavedPair) {
  Device& device = bench.Plug(std::make_shared<WiimoteModel>(7));
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  bench.seen().Forget();
  // First halves alone: half an acceleration is none.
  Report half(22, 0x10);
  half[0] = 0x3e;
  for (int i = 0; i < 20; ++i) {
    device.SendRaw(half);
    bench.Run(0.01);
  }
  ASSERT_TRUE(bench.UntilSamples(device, 30));
  ExpectAllAtRest(device, 30);
  EXPECT_EQ(Status(device).state(), v1::DEVICE_STATE_LIVE);
}

FOOTING_FAULT(Fault08DataBeforeTheHandshakeIsDone) {
  auto model = std::make_shared<WiimoteModel>(8);
  Device& device = bench.Plug(model);
  // It streams from before, without a question; its memory answers after 0.3 s only.
  const std::uint8_t mode[] = {0x12, 0x04, 0x31};
  model->wiimote.HandleOutput(mode);
  device.incoming = [reads = 0](std::span<const std::uint8_t> report) mutable {
    return report[0] == 0x17 && ++reads == 1;  // The first question is lost.
  };
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  EXPECT_GE(device.Outputs(0x17), 2u);
  // Nothing was decoded with a calibration that was not there yet.
  ExpectAllAtRest(device, 1);
  for (const auto& sample : Motion(device)) EXPECT_FALSE(sample.uncalibrated());
  EXPECT_EQ(Status(device).calibration(), v1::CALIBRATION_ORIGIN_DEVICE);
  EXPECT_GT(bench.seen().Raw(device.serial()).size(), Motion(device).size());
}

FOOTING_FAULT(Fault09BurstAfterAStall) {
  auto model = std::make_shared<WiimoteModel>(9);
  Device& device = bench.Plug(model);
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  bench.Run(0.3);
  bench.seen().Forget();
  const std::uint64_t gaps = Status(device).gaps();
  // The radio is silent for 0.4 s, then 64 reports come at once and 36 more than the queue holds.
  device.sampling = false;
  bench.Run(0.4);
  bench.footingd().Signal(SIGSTOP);
  const std::uint64_t dropped = device.node().dropped();
  bench.Run(0.05);
  for (int i = 0; i < 100; ++i) device.SampleNow();
  // Two openings hold the node, the reader's and the lock's.
  EXPECT_GE(device.node().dropped() - dropped, 36u);
  bench.footingd().Signal(SIGCONT);
  ASSERT_TRUE(bench.UntilSamples(device, 64));
  bench.Run(0.1);
  EXPECT_LE(Motion(device).size(), 64u + 2u);
  device.sampling = true;
  ASSERT_TRUE(bench.UntilSamples(device, 30));
  ExpectAllAtRest(device, 94);
  EXPECT_TRUE(bench.Until([&] { return Status(device).gaps() > gaps; }));
}

FOOTING_FAULT(Fault10RepeatedSamples) {
  auto board = std::make_shared<BoardModel>(10);
  Device& device = bench.Plug(board);
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  bench.seen().Forget();
  // Each value twice, as a 60 Hz sensor on a faster link.
  for (int i = 0; i < 40; ++i) {
    if (i % 2 == 0) board->forces.top_left_n += 2;
    bench.Run(0.01);
  }
  ASSERT_TRUE(bench.UntilSamples(device, 5));
  const auto& samples = Boards(device);
  std::size_t repeated = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const bool same = samples[i].top_left_n() == samples[i - 1].top_left_n() &&
                      samples[i].total_n() == samples[i - 1].total_n();
    EXPECT_EQ(samples[i].repeated(), same) << i;
    repeated += samples[i].repeated() ? 1 : 0;
  }
  EXPECT_GE(repeated, 10u);
  EXPECT_TRUE(bench.Until([&] { return Status(device).repeats() >= repeated; }));
}

FOOTING_FAULT(Fault11SilenceWhileTheLinkIsUp) {
  auto model = std::make_shared<WiimoteModel>(11);
  Device& device = bench.Plug(model);
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  bench.Run(0.3);
  device.sampling = false;
  const std::size_t modes = device.Outputs(0x12);
  const auto is = [&](v1::DeviceState state) {
    return [&, state] { return bench.IsIn(device.serial(), state); };
  };
  ASSERT_TRUE(bench.Within(2, is(v1::DEVICE_STATE_STALE)));
  bench.Run(1);
  // It was asked again, but not flooded: at 0.2, 0.45, 0.95 s and so on.
  EXPECT_GE(device.Outputs(0x12), modes + 2);
  EXPECT_LE(device.Outputs(0x12), modes + 8);
  EXPECT_TRUE(bench.Until([&] { return !Status(device).note().empty(); }));
  device.sampling = true;
  ASSERT_TRUE(bench.Within(2, is(v1::DEVICE_STATE_LIVE)));
  ASSERT_TRUE(bench.UntilSamples(device, 20));
  ExpectAllAtRest(device, 20);
  EXPECT_GE(Status(device).gaps(), 1u);
}

}  // namespace
}  // namespace footing::device_faults
