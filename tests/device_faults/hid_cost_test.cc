#include <iostream>

#include "tests/device_faults/fault.h"

namespace footing::device_faults {
namespace {

constexpr double kMostRatio = 3;  // Ratio of issue 3.
constexpr int kDevices = 8;
constexpr double kSeconds = 12;

/// CPU time and reports of one thread that reads a node.
struct Cost {
  double cpu_s = 0;
  double reports = 0;
};

class HidCost : public Fault {
 protected:
  /// Cost of all nodes: the openings from `first` on, up to `end`, that are read.
  static Cost Of(const std::vector<Device*>& devices, const std::vector<std::uint32_t>& first,
                 const std::vector<std::uint32_t>& end) {
    Cost cost;
    for (std::size_t i = 0; i < devices.size(); ++i) {
      const NodePage& page = devices[i]->node().page();
      for (std::uint32_t opening = first[i]; opening < end[i]; ++opening) {
        cost.cpu_s += static_cast<double>(page.cpu_ns[opening].load()) * 1e-9;
        cost.reports += page.cpu_reads[opening].load();
      }
    }
    return cost;
  }
};

TEST_F(HidCost, DrainLoopsOfEightDevicesCostAtMostThreeBareReadLoops) {
  std::vector<Device*> devices;
  for (int i = 0; i < kDevices; ++i) {
    devices.push_back(&bench.Plug(std::make_shared<WiimoteModel>(800 + i)));
  }
  ASSERT_TRUE(bench.Start());
  for (Device* device : devices) ASSERT_TRUE(bench.UntilLive(*device));
  // Both read the same nodes at the same time: each opening gets a copy of every report.
  std::vector<std::string> command = {"../tests/bare_reader"};
  std::vector<std::uint32_t> none, ours, bare;
  for (Device* device : devices) {
    command.push_back("/dev/hidraw" + std::to_string(device->number()));
    none.push_back(0);
    ours.push_back(device->node().page().opens.load());
    bare.push_back(ours.back() + 1);
  }
  const auto reader = bench.Run(command, "bare_reader");
  ASSERT_TRUE(bench.Until([&] { return Of(devices, ours, bare).reports >= kDevices * 32; }));
  const Cost ours_before = Of(devices, none, ours), bare_before = Of(devices, ours, bare);
  bench.Run(kSeconds);
  const Cost ours_after = Of(devices, none, ours), bare_after = Of(devices, ours, bare);
  const auto per_report_us = [](const Cost& before, const Cost& after) {
    return (after.cpu_s - before.cpu_s) * 1e6 / (after.reports - before.reports);
  };
  EXPECT_GT(ours_after.reports - ours_before.reports, 0.95 * kDevices * 100 * kSeconds);
  EXPECT_GT(bare_after.reports - bare_before.reports, 0.95 * kDevices * 100 * kSeconds);
  const double ours_us = per_report_us(ours_before, ours_after);
  const double bare_us = per_report_us(bare_before, bare_after);
  std::cout << "hid_cost: " << ours_us << " us of CPU time a report in footingd's drain loops, "
            << bare_us << " us in a bare hid_read loop, ratio " << ours_us / bare_us << "\n";
  RecordProperty("ratio", std::to_string(ours_us / bare_us));
  EXPECT_LE(ours_us / bare_us, kMostRatio);
  for (Device* device : devices) EXPECT_EQ(Status(*device).queue_drops(), 0u);
}

}  // namespace
}  // namespace footing::device_faults
