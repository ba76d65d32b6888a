#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

#include "common/runtime/bounded_queue.h"
#include "common/runtime/flag.h"
#include "common/runtime/heartbeat.h"
#include "daemon/sensor/devices/hid_opening.h"

namespace footing::devices {

/// One open device and the one thread that reads it, stamps what it reads and writes what is to be
/// written, at most one report per 9 ms. hidapi's handle is never shared by two threads.
class HidReader {
 public:
  /// The kernel waits up to 10 s for a Bluetooth device to acknowledge a report.
  static constexpr std::int64_t kLongestCallNs = 12'000'000'000;

  struct Item {
    std::int64_t received_ns = 0;
    bool feature = false;  ///< The answer to RequestFeature; empty when the device refuses.
    std::uint64_t writes_failed = 0;  ///< So far.
    std::size_t size = 0;
    std::array<std::uint8_t, 64> bytes;
  };

  /// `wake` is called on the reader's thread when there is something to pop, or when it ended.
  HidReader(HidHandle device, std::function<void()> wake);
  /// Ends the thread, at most 25 ms; the newest report that waits is still written.
  ~HidReader();
  HidReader(const HidReader&) = delete;
  HidReader& operator=(const HidReader&) = delete;

  /// io thread: the next report.
  bool Pop(Item& item) { return incoming_.Pop(item); }
  /// io thread: false when 64 reports wait already.
  bool Push(std::vector<std::uint8_t> report) { return outgoing_.Push(std::move(report)); }
  /// io thread: false when eight requests wait already.
  bool RequestFeature(std::uint8_t id, std::size_t size) { return requests_.Push({id, size}); }
  /// io thread: reports lost because they were not popped in time.
  std::uint64_t dropped() const { return incoming_.refused(); }
  /// The device is gone; what was read before can still be popped.
  bool ended() const { return ended_.raised(); }
  /// The device's driver has kept the thread for longer than the kernel waits for any device.
  bool Stuck(std::int64_t now_ns) const {
    return !ended() && heartbeat_.StuckFor(kLongestCallNs, now_ns);
  }
  /// io thread, after it ended: the device, to be closed where it was opened.
  HidHandle Release();

 private:
  struct FeatureRequest {
    std::uint8_t id = 0;
    std::size_t size = 0;
  };

  void Run();
  void WriteOne();
  void WriteLast();
  int TimeoutMs() const;
  void Write(const std::vector<std::uint8_t>& report);
  void ReadFeatures();

  HidHandle device_;
  std::vector<std::uint8_t> next_;  ///< Taken from outgoing_ and not due yet; empty: none.
  std::int64_t written_ns_ = 0;
  std::uint64_t writes_failed_ = 0;
  std::function<void()> wake_;
  exchange::BoundedQueue<Item> incoming_{256};
  exchange::BoundedQueue<std::vector<std::uint8_t>> outgoing_{64};
  exchange::BoundedQueue<FeatureRequest> requests_{8};
  exchange::Flag stop_;
  exchange::Flag ended_;
  exchange::Heartbeat heartbeat_;
  std::thread thread_;
};

}  // namespace footing::devices
