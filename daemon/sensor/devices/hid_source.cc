#include "daemon/sensor/devices/hid_source.h"

#include <hidapi/hidapi.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <cerrno>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <thread>
#include <utility>

#include "common/exchange/bounded_queue.h"
#include "common/exchange/flag.h"
#include "daemon/sensor/devices/hid_reader.h"

namespace footing::devices {
namespace {

constexpr int kEnumerationMs = 1000;

constexpr const char* kUdevRule =
    "KERNEL==\"hidraw*\", KERNELS==\"0005:057E:0306.*|0005:057E:0330.*\", GROUP=\"input\", "
    "MODE=\"0660\"";

/// hidapi's texts are ASCII in practice; what is not becomes '?'.
std::string Narrow(const wchar_t* text) {
  std::string narrow;
  for (; text != nullptr && *text != 0; ++text) {
    narrow += *text >= ' ' && *text <= '~' ? static_cast<char>(*text) : '?';
  }
  return narrow;
}

/// The kernel driver behind "/dev/hidrawN", for the log: hid-wiimote talks to the device too.
std::string DriverOf(const std::string& path) {
  const std::string name = path.substr(path.rfind('/') + 1);
  char target[256];
  const ssize_t size =
      readlink(("/sys/class/hidraw/" + name + "/device/driver").c_str(), target, sizeof(target));
  if (size <= 0) return "unknown";
  const std::string driver(target, static_cast<std::size_t>(size));
  return driver.substr(driver.rfind('/') + 1);
}

void Signal(int descriptor) {
  const std::uint64_t one = 1;
  // It can only fail when the counter is full, and then the other side wakes anyway.
  [[maybe_unused]] const ssize_t written = write(descriptor, &one, sizeof(one));
}

/// What the enumerating thread found: a device just opened, or a line for a person.
struct Found {
  std::string path;
  DeviceIdentity identity;
  HidHandle device;
  std::string trouble;
};

}  // namespace

/// Three kinds of threads: this one's io thread, one that enumerates and opens (both may block in
/// the kernel, and hidapi's global error text is not thread-safe), and one reader a device.
class HidSource::Implementation : public std::enable_shared_from_this<Implementation> {
 public:
  Implementation(boost::asio::io_context& io, std::function<DeviceHandle()> new_handle,
                 SourceHandlers handlers)
      : wake_(io), new_handle_(std::move(new_handle)), handlers_(std::move(handlers)) {}

  ~Implementation() { Stop(); }

  Result<void> Start() {
    wake_descriptor_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    stop_descriptor_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (wake_descriptor_ < 0 || stop_descriptor_ < 0 || hid_init() != 0) {
      return Failure(std::string("cannot start hidapi: ") + std::strerror(errno));
    }
    wake_.assign(wake_descriptor_);
    Wait();
    enumerator_ = std::thread([this] { Enumerate(); });
    return {};
  }

  void Send(DeviceHandle device, const reports::OutputReport& report) {
    const auto found = readers_.find(device);
    if (found != readers_.end()) found->second.reader->Push(report);
  }

  void RequestFeature(DeviceHandle device, std::uint8_t id, std::size_t size) {
    const auto found = readers_.find(device);
    if (found != readers_.end()) found->second.reader->RequestFeature(id, size);
  }

  void Stop() {
    if (!enumerator_.joinable()) return;
    stop_.Raise();
    Signal(stop_descriptor_);
    enumerator_.join();
    readers_.clear();
    boost::system::error_code ignored;
    wake_.close(ignored);
    close(stop_descriptor_);
    hid_exit();
  }

 private:
  struct Open {
    std::string path;
    std::unique_ptr<HidReader> reader;
  };

  void Wait() {
    wake_.async_read_some(boost::asio::buffer(&wakes_, sizeof(wakes_)),
                          [weak = weak_from_this()](boost::system::error_code error, std::size_t) {
                            const auto self = weak.lock();
                            if (error || !self) return;
                            self->Drain();
                            self->Wait();
                          });
  }

  void Drain() {
    Found found;
    while (found_.Pop(found)) {
      if (!found.trouble.empty()) {
        handlers_.on_trouble(found.trouble);
        continue;
      }
      const DeviceHandle device = new_handle_();
      handlers_.on_attach(device, found.identity);
      readers_[device] = {found.path, std::make_unique<HidReader>(std::move(found.device), [this] {
                            Signal(wake_descriptor_);
                          })};
    }
    HidReader::Item item;
    for (auto it = readers_.begin(); it != readers_.end();) {
      const DeviceHandle device = it->first;
      HidReader& reader = *it->second.reader;
      const bool ended = reader.ended();
      while (reader.Pop(item)) {
        IncomingReport report;
        report.received_ns = item.received_ns;
        report.bytes = {item.bytes.data(), item.size};
        report.feature = item.feature;
        handlers_.on_report(device, report);
      }
      if (!ended) {
        ++it;
        continue;
      }
      closed_.Push(it->second.path);
      it = readers_.erase(it);
      handlers_.on_detach(device, "device is gone");
    }
  }

  /// The enumerating thread.
  void Enumerate() {
    pollfd stop = {stop_descriptor_, POLLIN, 0};
    while (!stop_.raised()) {
      LookForDevices();
      poll(&stop, 1, kEnumerationMs);
    }
  }

  void LookForDevices() {
    std::string closed;
    while (closed_.Pop(closed)) open_paths_.erase(closed);
    std::set<std::string> seen;
    hid_device_info* const list = hid_enumerate(kVendorNintendo, 0);
    for (const hid_device_info* info = list; info != nullptr; info = info->next) {
      if (!IsKnownDevice(info->vendor_id, info->product_id) || info->path == nullptr) continue;
      seen.insert(info->path);
      if (!open_paths_.contains(info->path)) OpenDevice(*info);
    }
    hid_free_enumeration(list);
    std::erase_if(said_, [&seen](const std::string& path) { return !seen.contains(path); });
  }

  void OpenDevice(const hid_device_info& info) {
    Found found;
    found.path = info.path;
    found.identity.vendor = info.vendor_id;
    found.identity.product = info.product_id;
    found.identity.name = Narrow(info.product_string);
    found.identity.serial = Narrow(info.serial_number);
    if (found.identity.serial.empty()) found.identity.serial = found.path;
    found.identity.place = found.path;
    found.identity.driver = DriverOf(found.path);
    found.device.reset(hid_open_path(info.path));
    if (!found.device) {
      if (said_.insert(found.path).second) SayWhyNot(info.path, found.identity.name);
      return;
    }
    if (found_.Push(std::move(found))) {
      open_paths_.insert(info.path);
      Signal(wake_descriptor_);
    }
  }

  void SayWhyNot(const std::string& path, const std::string& name) {
    const std::string reason = Narrow(hid_error(nullptr));
    Found found;
    found.trouble = "cannot open " + path + " (" + name + "): " + reason;
    if (access(path.c_str(), R_OK | W_OK) != 0 && errno == EACCES) {
      found.trouble +=
          "; put this line into /etc/udev/rules.d/70-footing.rules, join the group "
          "input and reconnect the device: " +
          std::string(kUdevRule);
    }
    found_.Push(std::move(found));
    Signal(wake_descriptor_);
  }

  boost::asio::posix::stream_descriptor wake_;
  int wake_descriptor_ = -1;
  int stop_descriptor_ = -1;
  std::uint64_t wakes_ = 0;
  std::function<DeviceHandle()> new_handle_;
  SourceHandlers handlers_;
  std::map<DeviceHandle, Open> readers_;

  exchange::BoundedQueue<Found> found_{64};         // enumerator -> io
  exchange::BoundedQueue<std::string> closed_{64};  // io -> enumerator
  exchange::Flag stop_;
  std::thread enumerator_;
  std::set<std::string> open_paths_;  // Of the enumerator.
  std::set<std::string> said_;        // Of the enumerator: paths it complained about.
};

HidSource::HidSource(boost::asio::io_context& io, std::function<DeviceHandle()> new_handle,
                     SourceHandlers handlers)
    : implementation_(
          std::make_shared<Implementation>(io, std::move(new_handle), std::move(handlers))) {}

HidSource::~HidSource() { implementation_->Stop(); }

Result<void> HidSource::Start() { return implementation_->Start(); }

void HidSource::Send(DeviceHandle device, const reports::OutputReport& report) {
  implementation_->Send(device, report);
}

void HidSource::RequestFeature(DeviceHandle device, std::uint8_t id, std::size_t size) {
  implementation_->RequestFeature(device, id, size);
}

void HidSource::Stop() { implementation_->Stop(); }

}  // namespace footing::devices
