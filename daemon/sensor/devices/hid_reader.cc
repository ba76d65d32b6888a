#include "daemon/sensor/devices/hid_reader.h"

#include <algorithm>

#include "common/clock/clock.h"

namespace footing::devices {
namespace {

constexpr int kReadTimeoutMs = 10;

}  // namespace

HidReader::HidReader(HidHandle device, std::function<void()> wake)
    : device_(std::move(device)), wake_(std::move(wake)), thread_([this] { Run(); }) {}

HidReader::~HidReader() {
  stop_.Raise();
  thread_.join();
}

void HidReader::Run() {
  Item item;
  while (!stop_.raised()) {
    WriteWaiting();
    ReadFeatures();
    const int size =
        hid_read_timeout(device_.get(), item.bytes.data(), item.bytes.size(), kReadTimeoutMs);
    if (size < 0) break;
    if (size == 0) continue;
    item.received_ns = clock::MonotonicNs();
    item.feature = false;
    item.size = static_cast<std::size_t>(size);
    incoming_.Push(item);
    wake_();
  }
  WriteWaiting();  // The last word may be "rumble off".
  ended_.Raise();
  wake_();
}

/// A write that fails is no end: the read says when the device is gone.
void HidReader::WriteWaiting() {
  std::vector<std::uint8_t> report;
  while (outgoing_.Pop(report)) hid_write(device_.get(), report.data(), report.size());
}

void HidReader::ReadFeatures() {
  FeatureRequest request;
  while (requests_.Pop(request)) {
    Item item;
    item.bytes[0] = request.id;
    const int size = hid_get_feature_report(device_.get(), item.bytes.data(),
                                            std::min(request.size, item.bytes.size()));
    item.received_ns = clock::MonotonicNs();
    item.feature = true;
    item.size = size < 0 ? 0 : static_cast<std::size_t>(size);
    incoming_.Push(item);
    wake_();
  }
}

}  // namespace footing::devices
