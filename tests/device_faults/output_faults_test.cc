#include "common/base/units.h"
#include "tests/device_faults/fault.h"

namespace footing::device_faults {
namespace {

v1::Command Rumble(std::uint32_t device, bool on, std::uint32_t lease_ms) {
  v1::Command command;
  command.mutable_set_rumble()->set_device(device);
  command.mutable_set_rumble()->set_on(on);
  command.mutable_set_rumble()->set_lease_ms(lease_ms);
  return command;
}

v1::Command Leds(std::uint32_t device, std::uint32_t leds) {
  v1::Command command;
  command.mutable_set_leds()->set_device(device);
  command.mutable_set_leds()->set_leds(leds);
  return command;
}

FOOTING_FAULT(Fault46RumbleBitInEveryReport) {
  auto model = std::make_shared<WiimoteModel>(46);
  Device& device = bench.Plug(model);
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  const std::uint32_t number = Status(device).device();
  ASSERT_TRUE(bench.Send(Rumble(number, true, 5000)).ok());
  ASSERT_TRUE(bench.Until([&] { return model->wiimote.rumble(); }));
  const std::size_t from = device.outputs().size();
  // LEDs, a mode that has to be set again, an unasked status: the motor never stops.
  ASSERT_TRUE(bench.Send(Leds(number, 0x5)).ok());
  const std::uint8_t foreign[] = {0x12, 0x01, 0x30};
  model->wiimote.HandleOutput(foreign);
  ASSERT_TRUE(bench.UntilSamples(device, 20));
  device.Send(model->wiimote.controller().UnaskedStatus());
  ASSERT_TRUE(bench.UntilSamples(device, 40));
  ASSERT_GE(device.outputs().size(), from + 3);
  for (std::size_t i = from; i < device.outputs().size(); ++i) {
    EXPECT_EQ(device.outputs()[i].report[1] & 1, 1)
        << "report " << int{device.outputs()[i].report[0]};
  }
  EXPECT_TRUE(model->wiimote.rumble());
  ASSERT_TRUE(bench.Send(Rumble(number, false, 0)).ok());
  EXPECT_TRUE(bench.Until([&] { return !model->wiimote.rumble(); }));
}

FOOTING_FAULT(Fault47RumbleOfAClientThatDied) {
  auto model = std::make_shared<WiimoteModel>(47);
  Device& device = bench.Plug(model);
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  const std::uint32_t number = Status(device).device();
  // The lease runs out.
  ASSERT_TRUE(bench.Send(Rumble(number, true, 300)).ok());
  ASSERT_TRUE(bench.Until([&] { return model->wiimote.rumble(); }));
  const std::int64_t from_ns = clock::MonotonicNs();
  ASSERT_TRUE(bench.Until([&] { return !model->wiimote.rumble(); }, 5));
  EXPECT_GT(clock::MonotonicNs() - from_ns, 150'000'000);
  // Its client is gone.
  ASSERT_TRUE(bench.Send(Rumble(number, true, 9000)).ok());
  ASSERT_TRUE(bench.Until([&] { return model->wiimote.rumble(); }));
  bench.Disconnect();
  EXPECT_TRUE(bench.Until([&] { return !model->wiimote.rumble(); }, 5));
  ASSERT_TRUE(bench.Connect());
  // footingd itself ends.
  ASSERT_TRUE(bench.Send(Rumble(number, true, 9000)).ok());
  ASSERT_TRUE(bench.Until([&] { return model->wiimote.rumble(); }));
  EXPECT_EQ(bench.Stop(), 0);
  EXPECT_TRUE(bench.Until([&] { return !model->wiimote.rumble(); }, 5));
}

FOOTING_FAULT(Fault48FightOverTheLeds) {
  auto model = std::make_shared<WiimoteModel>(48);
  Device& device = bench.Plug(model);
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  ASSERT_TRUE(bench.Send(Leds(Status(device).device(), 0x6)).ok());
  EXPECT_TRUE(bench.Until([&] { return model->wiimote.leds() == 0x6; }));
  // Another program sets LED 1 all the time and asks for the status, which tells of it.
  const std::size_t before = device.Outputs(0x11);
  for (int i = 0; i < 20; ++i) {
    const std::uint8_t foreign[] = {0x11, 0x10};
    model->wiimote.HandleOutput(foreign);
    const std::uint8_t status[] = {0x15, 0x00};
    for (const Report& report : model->wiimote.HandleOutput(status)) device.Send(report);
    bench.Run(0.05);
  }
  EXPECT_LE(device.Outputs(0x11), before + 3);  // No loop of writes.
  ASSERT_TRUE(bench.UntilSamples(device, 20));
  ExpectAllAtRest(device, 20);
}

FOOTING_FAULT(Fault49FloodOfWrites) {
  auto model = std::make_shared<WiimoteModel>(49);
  Device& device = bench.Plug(model);
  // So that the flood meets the device's limit and not that of the session.
  ASSERT_TRUE(bench.Start({"--set", "session_messages_per_s=10000"}));
  ASSERT_TRUE(bench.UntilLive(device));
  bench.Run(0.1);
  const std::uint32_t number = Status(device).device();
  const std::size_t from = device.outputs().size();
  device.node().page().closest_writes_ns = 1'000'000'000;
  // For so long that a queue anywhere on the way would be full.
  const std::int64_t from_ns = clock::MonotonicNs();
  std::uint32_t wishes = 0;
  bench.Within(3, [&] {
    bench.Send(Leds(number, wishes % 16));
    bench.Send(Rumble(number, wishes % 2 == 0, 1000));
    ++wishes;
    return false;
  });
  EXPECT_GT(wishes, 200u);
  bench.Send(Leds(number, 0x9));
  EXPECT_TRUE(bench.Within(2, [&] { return model->wiimote.leds() == 0x9; }))
      << "the newest wish comes through at once";
  bench.Run(0.3);
  EXPECT_GE(device.node().page().closest_writes_ns, 8'000'000) << "a report per 10 ms";
  const auto outputs = static_cast<double>(device.outputs().size() - from);
  EXPECT_LE(outputs, 100 * NanosecondsToSeconds(clock::MonotonicNs() - from_ns) + 20);
  EXPECT_GE(outputs, 50);
  EXPECT_EQ(model->wiimote.leds(), 0x9) << "the newest wish wins";
  ASSERT_TRUE(bench.UntilSamples(device, 20));
  ExpectAllAtRest(device, 20);
}

}  // namespace
}  // namespace footing::device_faults
