#pragma once

#include <hidapi/hidapi.h>

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "common/exchange/bounded_queue.h"
#include "common/exchange/flag.h"

namespace footing::devices {

struct HidClose {
  void operator()(hid_device* device) const { hid_close(device); }
};
using HidHandle = std::unique_ptr<hid_device, HidClose>;

/// One open device and the one thread that reads it, stamps what it reads and writes what is to be
/// written. hidapi's handle is never shared by two threads.
class HidReader {
 public:
  struct Item {
    std::int64_t received_ns = 0;
    bool feature = false;  ///< The answer to RequestFeature; empty when the device refuses.
    std::size_t size = 0;
    std::array<std::uint8_t, 64> bytes;
  };

  /// `wake` is called on the reader's thread when there is something to pop, or when it ended.
  HidReader(HidHandle device, std::function<void()> wake);
  ~HidReader();  ///< Ends the thread: at most 10 ms.
  HidReader(const HidReader&) = delete;
  HidReader& operator=(const HidReader&) = delete;

  /// io thread: the next report.
  bool Pop(Item& item) { return incoming_.Pop(item); }
  /// io thread: false when 64 reports wait already.
  bool Push(std::vector<std::uint8_t> report) { return outgoing_.Push(std::move(report)); }
  /// io thread: false when eight requests wait already.
  bool RequestFeature(std::uint8_t id, std::size_t size) { return requests_.Push({id, size}); }
  /// The device is gone; what was read before can still be popped.
  bool ended() const { return ended_.raised(); }

 private:
  struct FeatureRequest {
    std::uint8_t id = 0;
    std::size_t size = 0;
  };

  void Run();
  void WriteWaiting();
  void ReadFeatures();

  HidHandle device_;
  std::function<void()> wake_;
  exchange::BoundedQueue<Item> incoming_{256};
  exchange::BoundedQueue<std::vector<std::uint8_t>> outgoing_{64};
  exchange::BoundedQueue<FeatureRequest> requests_{8};
  exchange::Flag stop_;
  exchange::Flag ended_;
  std::thread thread_;
};

}  // namespace footing::devices
