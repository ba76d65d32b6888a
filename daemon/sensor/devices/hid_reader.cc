#include "daemon/sensor/devices/hid_reader.h"

#include <algorithm>

#include "common/runtime/clock.h"

namespace footing::devices {
namespace {

// Longer than the time between two reports, or many reads would time out first, for nothing.
constexpr int kReadTimeoutMs = 15;
// A device chokes on more than a write per 10 ms, which the outbox keeps to. Here what two threads
// bunched up is spread again; were this the slower of the two, a flood would fill the queue between
// them and its newest, the one that counts, would be refused.
constexpr std::int64_t kWriteIntervalNs = 9'000'000;

}  // namespace

HidReader::HidReader(HidHandle device, std::function<void()> wake)
    : device_(std::move(device)), wake_(std::move(wake)), thread_([this] { Run(); }) {}

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
  if (clock::MonotonicNs() - written_ns_ < kWriteIntervalNs) return;
  Write(next_);
  next_.clear();
}

/// Until a report comes, or the next one may be written.
int HidReader::TimeoutMs() const {
  if (next_.empty()) return kReadTimeoutMs;
  const std::int64_t left_ns = written_ns_ + kWriteIntervalNs - clock::MonotonicNs();
  return static_cast<int>(std::clamp<std::int64_t>(left_ns / 1'000'000 + 1, 0, kReadTimeoutMs));
}

/// The last word may be "rumble off"; nobody waits for what comes before it.
void HidReader::WriteLast() {
  std::vector<std::uint8_t> report, last = std::move(next_);
  while (outgoing_.Pop(report)) last = report;
  if (last.empty()) return;
  clock::SleepUntil(written_ns_ + kWriteIntervalNs);
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

}  // namespace footing::devices
