#include "daemon/sensor/devices/hid_source.h"

#include <hidapi/hidapi.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <cerrno>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "common/runtime/clock.h"
#include "common/runtime/flag.h"
#include "daemon/sensor/devices/hid_reader.h"
#include "daemon/sensor/devices/hid_search.h"

namespace footing::devices {
namespace {

void Signal(int descriptor) {
  const std::uint64_t one = 1;
  // It can only fail when the counter is full, and then the other side wakes anyway.
  [[maybe_unused]] const ssize_t written = write(descriptor, &one, sizeof(one));
}

}  // namespace

/// Three kinds of threads: the io thread, one that finds and opens devices, and one reader a
/// device.
class HidSource::Implementation : public std::enable_shared_from_this<Implementation> {
 public:
  Implementation(boost::asio::io_context& io, std::function<DeviceHandle()> new_handle,
                 SourceHandlers handlers)
      : wake_(io), new_handle_(std::move(new_handle)), handlers_(std::move(handlers)) {}

  ~Implementation() { Stop(); }

  Result<void> Start() {
    wake_descriptor_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (wake_descriptor_ < 0 || hid_init() != 0) {
      return Failure(std::string("cannot start hidapi: ") + std::strerror(errno));
    }
    wake_.assign(wake_descriptor_);
    Wait();
    search_ = std::make_unique<HidSearch>([this] { Wake(); });
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

  std::string Stuck() const {
    const std::int64_t now_ns = clock::MonotonicNs();
    if (search_ && search_->Stuck(now_ns)) return "the search for devices";
    for (const auto& [device, open] : readers_) {
      if (open.reader->Stuck(now_ns)) return "the thread of " + open.path;
    }
    return "";
  }

  void Stop() {
    if (!search_) return;
    search_.reset();
    readers_.clear();
    boost::system::error_code ignored;
    wake_.close(ignored);
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

  /// Any thread. One wake is enough until the io thread has seen it.
  void Wake() {
    if (awake_.RaiseIfLowered()) Signal(wake_descriptor_);
  }

  void Drain() {
    awake_.Lower();
    HidSearch::Found found;
    while (search_->Take(found)) {
      if (!found.trouble.empty()) {
        handlers_.on_trouble(found.trouble);
        continue;
      }
      const DeviceHandle device = new_handle_();
      readers_[device] = {found.identity.place,
                          std::make_unique<HidReader>(std::move(found.device), [this] { Wake(); })};
      handlers_.on_attach(device, found.identity);  // It may send at once.
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
        report.dropped = reader.dropped();
        report.writes_failed = item.writes_failed;
        handlers_.on_report(device, report);
      }
      if (!ended) {
        ++it;
        continue;
      }
      search_->Close(it->second.path, reader.Release());
      it = readers_.erase(it);
      handlers_.on_detach(device, "device is gone");
    }
  }

  boost::asio::posix::stream_descriptor wake_;
  int wake_descriptor_ = -1;
  std::uint64_t wakes_ = 0;
  std::function<DeviceHandle()> new_handle_;
  SourceHandlers handlers_;
  std::map<DeviceHandle, Open> readers_;

  exchange::Flag awake_;
  std::unique_ptr<HidSearch> search_;
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

std::string HidSource::Stuck() const { return implementation_->Stuck(); }

void HidSource::Stop() { implementation_->Stop(); }

}  // namespace footing::devices
