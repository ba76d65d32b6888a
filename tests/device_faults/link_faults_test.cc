#include <algorithm>
#include <cerrno>
#include <fstream>

#include "tests/device_faults/fault.h"

namespace footing::device_faults {
namespace {

/// The device with this seed again, as it is after a replug: all of its registers at rest.
std::shared_ptr<WiimoteModel> Wiimote(std::uint64_t seed) {
  return std::make_shared<WiimoteModel>(seed);
}

FOOTING_FAULT(Fault36UnplugAtAnyMoment) {
  // In each of the steps of its life: unasked, at the first question, in the memory read, live.
  const std::string serial = Wiimote(36)->identity().serial;
  ASSERT_TRUE(bench.Start());
  for (const std::uint8_t at : {0x15, 0x17, 0x12, 0x11}) {
    Device* device = &bench.Plug(Wiimote(36));
    ASSERT_TRUE(bench.Until([&] { return device->Outputs(at) > 0; })) << int{at};
    bench.Unplug(*device);
    ASSERT_TRUE(bench.UntilState(serial, v1::DEVICE_STATE_LOST)) << int{at};
  }
  Device& last = bench.Plug(Wiimote(36));
  ASSERT_TRUE(bench.UntilLive(last));
  ASSERT_TRUE(bench.UntilSamples(last, 20));
  ExpectAllAtRest(last, 20);
  EXPECT_EQ(bench.seen().devices(), 1u);  // One serial is one device, however often it came.
  // And one that goes while nodes are listed: its parent has no description any more.
  Device& going = bench.Plug(Wiimote(3600), {.open_errno = ENODEV});
  bench.testbed().HalfRemove(going.number(), going.model().identity());
  bench.testbed().Announce(going.number(), going.model().identity(), "change");
  bench.Run(0.2);
  EXPECT_FALSE(bench.footingd().Ended()) << "footingd's end";
  bench.Unplug(going);
  ASSERT_TRUE(bench.UntilSamples(last, 20));
  Device& second = bench.Plug(Wiimote(3601));
  ASSERT_TRUE(bench.UntilLive(second));
  EXPECT_EQ(bench.seen().devices(), 2u);
}

FOOTING_FAULT(Fault37ErrorsOfReadAndWrite) {
  Device* device = &bench.Plug(Wiimote(37));
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(*device));
  // Writes fail for a while, each way: counted, and no reason to let the device go.
  const std::uint64_t failed = Status(*device).writes_failed();
  for (const int error : {EAGAIN, EPIPE, EIO}) {
    device->node().page().write_errno = error;
    device->node().page().write_faults = 1;
    v1::Command command;
    command.mutable_set_leds()->set_device(Status(*device).device());
    command.mutable_set_leds()->set_leds(3);
    EXPECT_TRUE(bench.Send(command).ok());
    ASSERT_TRUE(bench.Until([&] { return device->node().page().write_faults == 0; }));
  }
  ASSERT_TRUE(bench.UntilSamples(*device, 20));
  EXPECT_TRUE(bench.Until([&] { return Status(*device).writes_failed() == failed + 3; }))
      << Status(*device).writes_failed();
  EXPECT_EQ(Status(*device).state(), v1::DEVICE_STATE_LIVE);
  // A read says EAGAIN: nothing was there, that is all.
  device->node().page().read_errno = EAGAIN;
  device->node().page().read_faults = 1;
  ASSERT_TRUE(bench.Until([&] { return device->node().page().read_faults == 0; }));
  ASSERT_TRUE(bench.UntilSamples(*device, 20));
  ExpectAllAtRest(*device, 40);
  // A read says EIO: the device is let go, and the node, still there, is opened anew.
  for (const int error : {EIO, ENODEV, EPIPE}) {
    bench.seen().Forget();
    device->node().page().read_errno = error;
    const std::size_t lost = bench.LogLines("lost: ");
    device->node().page().read_faults = 1;
    ASSERT_TRUE(bench.Until([&] { return bench.LogLines("lost: ") > lost; })) << error;
    ASSERT_TRUE(bench.UntilLive(*device)) << error;
    ASSERT_TRUE(bench.UntilSamples(*device, 10));
    ExpectAllAtRest(*device, 10);
  }
}

FOOTING_FAULT(Fault38SameSerialUnderAnotherNumber) {
  Device* old = &bench.Plug(Wiimote(38));
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(*old));
  const std::uint32_t number = Status(*old).device();
  const auto role = Status(*old).role();
  // It returns before the old node has ended.
  old->sampling = false;
  Device* next = &bench.Plug(Wiimote(38), {.number = 7});
  bench.seen().Forget();
  ASSERT_TRUE(bench.Within(1, [&] { return bench.Samples(*next) > 0; }));
  bench.Unplug(*old);
  bench.Run(0.3);
  ASSERT_TRUE(bench.UntilSamples(*next, 20));
  EXPECT_EQ(Status(*next).state(), v1::DEVICE_STATE_LIVE);
  // And once more, under a third number, after the old one is gone.
  const std::string serial = next->serial();
  bench.Unplug(*next);
  ASSERT_TRUE(bench.UntilState(serial, v1::DEVICE_STATE_LOST));
  bench.seen().Forget();
  Device& third = bench.Plug(Wiimote(38), {.number = 3});
  ASSERT_TRUE(bench.Within(1, [&] { return bench.Samples(third) > 0; }));
  EXPECT_EQ(Status(third).device(), number);
  EXPECT_EQ(Status(third).role(), role);
  EXPECT_EQ(bench.seen().devices(), 1u);
  ExpectAllAtRest(third, 1);
}

FOOTING_FAULT(Fault39TwoBoardsAtOnce) {
  ASSERT_TRUE(bench.Start());
  auto left = std::make_shared<BoardModel>(39);
  auto right = std::make_shared<BoardModel>(3900);
  right->forces = {50, 60, 70, 80};
  Device& first = bench.Plug(left);
  Device& second = bench.Plug(right);
  ASSERT_TRUE(bench.UntilLive(first));
  ASSERT_TRUE(bench.UntilLive(second));
  ASSERT_TRUE(bench.UntilSamples(first, 20));
  ASSERT_TRUE(bench.UntilSamples(second, 20));
  for (const auto& sample : Boards(first)) ASSERT_NEAR(sample.total_n(), 660, 7);
  for (const auto& sample : Boards(second)) ASSERT_NEAR(sample.total_n(), 260, 5);
  EXPECT_NE(Status(first).role(), Status(second).role());
  EXPECT_NE(Status(first).leds(), Status(second).leds());
}

FOOTING_FAULT(Fault41SlotsOfADolphinBar) {
  // Four slots on USB, one with a Wiimote; the others refuse the write or swallow it.
  ASSERT_TRUE(bench.Start());
  std::vector<Device*> slots;
  for (int slot = 0; slot < 4; ++slot) {
    auto model = std::make_shared<SlotModel>(41 + slot);
    slots.push_back(&bench.Plug(model, {.write_errno = slot == 0 ? EPIPE : 0}));
    if (slot == 1 || slot == 2) {
      slots.back()->incoming = [](std::span<const std::uint8_t>) { return true; };
    }
  }
  ASSERT_TRUE(bench.UntilLive(*slots[3]));
  ASSERT_TRUE(bench.UntilSamples(*slots[3], 20));
  ExpectAllAtRest(*slots[3], 20);
  EXPECT_EQ(bench.seen().devices(), 1u);
  // A Wiimote connects to an empty slot: no node appears, it only answers now.
  slots[0]->node().page().write_faults = 0;
  ASSERT_TRUE(bench.UntilLive(*slots[0]));
  EXPECT_EQ(bench.seen().devices(), 2u);
}

FOOTING_FAULT(Fault42NodeWithoutPermission) {
  Device& device = bench.Plug(Wiimote(42), {.open_errno = EACCES});
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.Until([&] { return bench.LogLines("70-footing.rules") > 0; }));
  bench.Run(1.2);
  EXPECT_EQ(bench.LogLines("70-footing.rules"), 1u);  // Said once.
  // The line that helps is the one that is installed.
  std::ifstream rules(FOOTING_SOURCE_DIR "/systemd/70-footing.rules");
  std::string rule;
  while (std::getline(rules, rule) && !rule.starts_with("KERNEL")) {
  }
  ASSERT_FALSE(rule.empty());
  EXPECT_EQ(bench.LogLines(rule), 1u) << rule;
  EXPECT_EQ(bench.LogLines("Permission denied"), 1u);
  EXPECT_EQ(bench.seen().devices(), 0u);
  // The rule is there now; udev says "change".
  device.node().page().open_errno = 0;
  bench.testbed().Announce(device.number(), device.model().identity(), "change");
  ASSERT_TRUE(bench.Within(1, [&] { return bench.IsLive(device); }));
  ExpectAllAtRest(device, 1);
}

FOOTING_FAULT(Fault43NodeBeforeItsAttributesAndPermissions) {
  ASSERT_TRUE(bench.Start());
  Device& shut = bench.Plug(Wiimote(43), {.open_errno = EACCES});
  Device& nameless = bench.Plug(Wiimote(4300), {.identified = false});
  bench.Run(0.1);
  EXPECT_EQ(bench.seen().devices(), 0u);
  // 0.1 s later all is set; no event tells, and the look at old nodes comes once a second.
  shut.node().page().open_errno = 0;
  bench.testbed().Identify(nameless.number(), nameless.model().identity());
  ASSERT_TRUE(bench.Within(0.9, [&] { return bench.IsLive(shut) && bench.IsLive(nameless); }));
  EXPECT_EQ(bench.LogLines("cannot open"), 0u);  // It was nothing to complain about.
  EXPECT_EQ(bench.seen().devices(), 2u);
  ExpectAllAtRest(nameless, 1);
}

FOOTING_FAULT(Fault44AdapterReset) {
  std::vector<Device*> devices;
  for (int i = 0; i < 4; ++i) devices.push_back(&bench.Plug(Wiimote(440 + i)));
  ASSERT_TRUE(bench.Start());
  std::vector<v1::DeviceStatus> before;
  for (Device* device : devices) {
    ASSERT_TRUE(bench.UntilLive(*device));
    before.push_back(Status(*device));
  }
  for (Device* device : devices) bench.Unplug(*device);
  for (const auto& status : before) {
    ASSERT_TRUE(bench.UntilState(status.serial(), v1::DEVICE_STATE_LOST));
  }
  bench.seen().Forget();
  // They return in another order.
  for (int i = 3; i >= 0; --i) devices[i] = &bench.Plug(Wiimote(440 + i));
  const auto sends = [&](const Device* device) { return bench.Samples(*device) > 0; };
  ASSERT_TRUE(bench.Within(1, [&] { return std::all_of(devices.begin(), devices.end(), sends); }));
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(Status(*devices[i]).device(), before[i].device());
    EXPECT_EQ(Status(*devices[i]).role(), before[i].role());
  }
  EXPECT_EQ(bench.seen().devices(), 4u);
}

FOOTING_FAULT(Fault45PauseOfTheWholeMachine) {
  Device& device = bench.Plug(Wiimote(45));
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  bench.Run(0.3);
  const std::uint64_t gaps = Status(device).gaps();
  bench.seen().Forget();
  // footingd stands still for 1.5 s, and so do the devices.
  bench.footingd().Signal(SIGSTOP);
  device.sampling = false;
  bench.Run(1.5);
  const std::int64_t resumed_ns = clock::MonotonicNs();
  bench.footingd().Signal(SIGCONT);
  device.sampling = true;
  ASSERT_TRUE(bench.UntilSamples(device, 50));
  ASSERT_TRUE(bench.UntilState(device.serial(), v1::DEVICE_STATE_LIVE));
  EXPECT_TRUE(bench.Until([&] { return Status(device).gaps() > gaps; }));
  ExpectAllAtRest(device, 50);
  // The clock took up the new time at once: no sample is stamped into the pause.
  for (const auto& sample : Motion(device)) {
    if (sample.received_ns() > resumed_ns) {
      EXPECT_GT(sample.sampled_ns(), resumed_ns - 50'000'000);
    }
  }
}

}  // namespace
}  // namespace footing::device_faults
