#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "common/runtime/exchange.h"
#include "daemon/sensor/devices/source.h"

namespace footing::devices {

/// One open device and the one thread that reads it, stamps what it reads and writes what is to be
/// written, at most one report per `write_interval_ns`. hidapi's handle is never shared by two
/// threads.
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
  HidReader(HidHandle device, std::int64_t write_interval_ns, std::function<void()> wake);
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
  std::int64_t write_interval_ns_;
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

/// Finds and opens devices on a thread of its own, since both may block in the kernel. It looks
/// when udev reports a change, every 5 s besides, and every 1 s where udev reports nothing or a
/// node could not be opened. A node that is new and not ready (no serial, no permission yet) is
/// tried every 50 ms for a second before anything is said.
class HidSearch {
 public:
  /// A device just opened, or else a line for a person.
  struct Found {
    HidHandle device;
    DeviceIdentity identity;
    std::string trouble;
  };

  /// `wake` is called on the search's thread when there is something to take.
  explicit HidSearch(std::function<void()> wake);
  ~HidSearch();  ///< Ends the thread: at once, or after the call into the kernel that it is in.
  HidSearch(const HidSearch&) = delete;
  HidSearch& operator=(const HidSearch&) = delete;

  /// io thread.
  bool Pop(Found& found) { return found_.Pop(found); }
  /// As HidReader::Stuck(): it is kept by a node that it lists or opens.
  bool Stuck(std::int64_t now_ns) const {
    return heartbeat_.StuckFor(HidReader::kLongestCallNs, now_ns);
  }
  /// io thread: closes the device of this path, which may then be opened again. hidapi keeps its
  /// newest error in one place for the whole process, so one thread opens and closes.
  void Close(std::string path, HidHandle device);

 private:
  struct Closed {
    std::string path;
    HidHandle device;
  };
  struct Waiting {
    std::int64_t since_ns = 0;
    bool said = false;
  };

  void Run();
  int PauseMs(std::int64_t now_ns) const;
  void Look(std::int64_t now_ns);
  void Open(const HidNode& node, std::int64_t now_ns);
  void Say(const std::string& line);

  std::function<void()> wake_;
  NodeMonitor monitor_;
  exchange::BoundedQueue<Found> found_{64};
  exchange::BoundedQueue<Closed> closed_{64};
  exchange::Flag stop_;
  std::int64_t changed_ns_ = 0;  ///< Time of udev's newest report.
  int event_;                    ///< eventfd: stop, or a path was closed.
  std::set<std::string> open_paths_;
  std::map<std::string, Waiting> waiting_;  ///< Nodes that could not be opened, by path.
  exchange::Heartbeat heartbeat_;
  std::thread thread_;
};

/// Real devices through hidapi's hidraw backend, as HidSearch finds them. A device that is gone and
/// comes back attaches again under its serial, also before the old node has ended. A device that
/// may not be opened is said once, with the udev rule that helps.
class HidSource : public DeviceSource {
 public:
  HidSource(boost::asio::io_context& io, std::function<DeviceHandle()> new_handle,
            SourceHandlers handlers);
  ~HidSource() override;

  Result<void> Start() override;
  void Send(DeviceHandle device, const reports::OutputReport& report) override;
  void RequestFeature(DeviceHandle device, std::uint8_t id, std::size_t size) override;
  void Refuse(DeviceHandle, const std::string&) override {}
  std::string Stuck() const override;
  void Stop() override;

 private:
  class Implementation;
  std::shared_ptr<Implementation> implementation_;
};

}  // namespace footing::devices
