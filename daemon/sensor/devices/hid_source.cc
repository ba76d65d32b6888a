#include "daemon/sensor/devices/hid_source.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include <hidapi/hidapi.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>
#include <boost/asio/buffer.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>

#include "common/runtime/clock.h"
#include "common/runtime/exchange.h"
#include "common/stream/product_ids.h"
#include "daemon/sensor/reports/joycon_report.h"
#include "daemon/sensor/reports/outbox.h"

namespace footing::devices {
namespace {

// Longer than the time between two reports, or many reads would time out first, for nothing.
constexpr int kReadTimeoutMs = 15;
// A device chokes on more writes than the outbox gives it. Here what two threads bunched up is
// spread again; were this the slower of the two, a flood would fill the queue between them and its
// newest, the one that counts, would be refused.
constexpr std::int64_t kFasterNs = 1'000'000;

std::int64_t WriteIntervalNs(const DeviceIdentity& device) {
  const bool of_switch = stream::IsOfSwitch(device.vendor, device.product);
  return (of_switch ? reports::kJoyconWriteIntervalNs : link::Writing().interval_ns) - kFasterNs;
}

}  // namespace

HidReader::HidReader(HidHandle device, std::int64_t write_interval_ns, std::function<void()> wake)
    : device_(std::move(device)),
      write_interval_ns_(write_interval_ns),
      wake_(std::move(wake)),
      thread_([this] { Run(); }) {}

HidReader::~HidReader() {
  stop_.Raise();
  if (thread_.joinable()) thread_.join();
}

HidHandle HidReader::Release() {
  stop_.Raise();
  thread_.join();
  return std::move(device_);
}

void HidReader::Run() {
  Item item;
  while (!stop_.raised()) {
    heartbeat_.Beat(clock::MonotonicNs());
    WriteOne();
    ReadFeatures();
    const int size =
        hid_read_timeout(device_.get(), item.bytes.data(), item.bytes.size(), TimeoutMs());
    if (size < 0) break;
    if (size == 0) continue;
    item.received_ns = clock::MonotonicNs();
    item.feature = false;
    item.writes_failed = writes_failed_;
    item.size = static_cast<std::size_t>(size);
    incoming_.Push(item);
    wake_();
  }
  if (stop_.raised()) WriteLast();
  ended_.Raise();
  wake_();
}

void HidReader::WriteOne() {
  if (next_.empty() && !outgoing_.Pop(next_)) return;
  if (clock::MonotonicNs() - written_ns_ < write_interval_ns_) return;
  Write(next_);
  next_.clear();
}

/// Until a report comes, or the next one may be written.
int HidReader::TimeoutMs() const {
  if (next_.empty()) return kReadTimeoutMs;
  const std::int64_t left_ns = written_ns_ + write_interval_ns_ - clock::MonotonicNs();
  return static_cast<int>(std::clamp<std::int64_t>(left_ns / 1'000'000 + 1, 0, kReadTimeoutMs));
}

/// The last word may be "rumble off"; nobody waits for what comes before it.
void HidReader::WriteLast() {
  std::vector<std::uint8_t> report, last = std::move(next_);
  while (outgoing_.Pop(report)) last = report;
  if (last.empty()) return;
  clock::SleepUntil(written_ns_ + write_interval_ns_);
  Write(last);
}

/// A failed write does not end the device: the read shows when it is gone.
void HidReader::Write(const std::vector<std::uint8_t>& report) {
  if (hid_write(device_.get(), report.data(), report.size()) < 0) ++writes_failed_;
  written_ns_ = clock::MonotonicNs();
}

void HidReader::ReadFeatures() {
  FeatureRequest request;
  while (requests_.Pop(request)) {
    heartbeat_.Beat(clock::MonotonicNs());
    Item item;
    item.bytes[0] = request.id;
    const int size = hid_get_feature_report(device_.get(), item.bytes.data(),
                                            std::min(request.size, item.bytes.size()));
    item.received_ns = clock::MonotonicNs();
    item.feature = true;
    item.writes_failed = writes_failed_;
    item.size = size < 0 ? 0 : static_cast<std::size_t>(size);
    incoming_.Push(item);
    wake_();
  }
}

namespace {

using SearchOutcome = HidOpening::Outcome;

constexpr int kSoonMs = 50;
constexpr int kSlowlyMs = 1000;
constexpr int kWithMonitorMs = 5000;
constexpr std::int64_t kNewNs = 1'000'000'000;

// As systemd/70-footing.rules.
constexpr const char* kUdevRule =
    "KERNEL==\"hidraw*\", KERNELS==\"0005:057E:*|000[35]:054C:03D5.*|000[35]:054C:0C5E.*\", "
    "GROUP=\"footing\", MODE=\"0660\"";

/// Message for a node that stays shut; empty when there is nothing to say.
std::string Trouble(const HidOpening& opening) {
  const std::string node = opening.identity.place + " (" + opening.identity.name + ")";
  switch (opening.outcome) {
    case SearchOutcome::kDenied:
      return "cannot open " + node + ": " + opening.reason +
             "; put this line into /etc/udev/rules.d/70-footing.rules, join the group footing and "
             "reconnect the device: " +
             kUdevRule;
    case SearchOutcome::kInUse:
      return node +
             " belongs to another footingd; stop that one, or run this one with --source "
             "stream:ADDRESS only";
    case SearchOutcome::kUnidentified:
      return node + " has no serial; reconnect the device";
    case SearchOutcome::kFailed:
      return "cannot open " + node + ": " + opening.reason + "; reconnect the device";
    case SearchOutcome::kOpen:
    case SearchOutcome::kNobodyThere:
      break;
  }
  return "";
}

}  // namespace

HidSearch::HidSearch(std::function<void()> wake)
    : wake_(std::move(wake)),
      event_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      thread_([this] { Run(); }) {}

HidSearch::~HidSearch() {
  stop_.Raise();
  eventfd_write(event_, 1);
  thread_.join();
  close(event_);
}

void HidSearch::Close(std::string path, HidHandle device) {
  closed_.Push({std::move(path), std::move(device)});
  eventfd_write(event_, 1);
}

void HidSearch::Run() {
  while (!stop_.raised()) {
    const std::int64_t now_ns = clock::MonotonicNs();
    heartbeat_.Beat(now_ns);
    Look(now_ns);
    int pause_ms = PauseMs(now_ns);
    if (pause_ms == kWithMonitorMs && monitor_.descriptor() < 0) pause_ms = kSlowlyMs;
    pollfd events[] = {{event_, POLLIN, 0}, {monitor_.descriptor(), POLLIN, 0}};
    poll(events, 2, pause_ms);
    eventfd_t ignored = 0;
    eventfd_read(event_, &ignored);
    if (monitor_.Clear()) changed_ns_ = clock::MonotonicNs();
  }
}

int HidSearch::PauseMs(std::int64_t now_ns) const {
  // A node whose attributes are not all there yet is not listed.
  if (changed_ns_ != 0 && now_ns - changed_ns_ < kNewNs) return kSoonMs;
  int pause_ms = kWithMonitorMs;
  for (const auto& [path, waiting] : waiting_) {
    pause_ms = kSlowlyMs;
    if (now_ns - waiting.since_ns < kNewNs) return kSoonMs;
  }
  return pause_ms;
}

void HidSearch::Look(std::int64_t now_ns) {
  Closed closed;
  while (closed_.Pop(closed)) {
    closed.device.reset();
    open_paths_.erase(closed.path);
  }
  std::set<std::string> seen;
  for (const HidNode& node : monitor_.Nodes()) {
    // On its cable a controller of the Switch speaks another protocol.
    const bool other = node.bus == Bus::kUsb && stream::IsOfSwitch(node.vendor, node.product);
    if (other || !stream::IsKnownDevice(node.vendor, node.product) ||
        open_paths_.contains(node.path)) {
      continue;
    }
    seen.insert(node.path);
    Open(node, now_ns);
  }
  std::erase_if(waiting_, [&seen](const auto& one) { return !seen.contains(one.first); });
}

void HidSearch::Open(const HidNode& node, std::int64_t now_ns) {
  HidOpening opening = OpenHid(node);
  if (opening.outcome != SearchOutcome::kOpen) {
    const bool is_new = waiting_.try_emplace(node.path, Waiting{now_ns, false}).second;
    Waiting& waiting = waiting_[node.path];
    if (is_new || waiting.said || now_ns - waiting.since_ns < kNewNs) return;
    waiting.said = true;
    if (const std::string line = Trouble(opening); !line.empty()) Say(line);
    return;
  }
  Found found;
  found.identity = std::move(opening.identity);
  found.device = std::move(opening.device);
  if (!found_.Push(std::move(found))) return;
  waiting_.erase(node.path);
  open_paths_.insert(node.path);
  wake_();
}

void HidSearch::Say(const std::string& line) {
  Found found;
  found.trouble = line;
  found_.Push(std::move(found));
  wake_();
}

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
    while (search_->Pop(found)) {
      if (!found.trouble.empty()) {
        handlers_.on_trouble(found.trouble);
        continue;
      }
      const DeviceHandle device = new_handle_();
      readers_[device] = {
          found.identity.place,
          std::make_unique<HidReader>(std::move(found.device), WriteIntervalNs(found.identity),
                                      [this] { Wake(); })};
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
