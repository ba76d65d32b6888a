#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <thread>

#include "common/runtime/bounded_queue.h"
#include "common/runtime/flag.h"
#include "common/runtime/heartbeat.h"
#include "daemon/sensor/devices/hid_opening.h"
#include "daemon/sensor/devices/hid_reader.h"
#include "daemon/sensor/devices/node_monitor.h"

namespace footing::devices {

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
  bool Take(Found& found) { return found_.Pop(found); }
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
  std::int64_t changed_ns_ = 0;  ///< Of udev's newest report.
  int event_;                    ///< eventfd: stop, or a path was closed.
  std::set<std::string> open_paths_;
  std::map<std::string, Waiting> waiting_;  ///< Nodes that could not be opened, by path.
  exchange::Heartbeat heartbeat_;
  std::thread thread_;
};

}  // namespace footing::devices
