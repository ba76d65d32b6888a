#include "daemon/sensor/reports/output_report.h"

#include <algorithm>

namespace footing::reports {
namespace {

constexpr std::uint8_t kRumbleBit = 0x01;
constexpr std::uint8_t kRegisterBit = 0x04;
constexpr std::uint8_t kContinuousBit = 0x04;
constexpr std::size_t kWriteBytes = 16;

void AppendAddress(OutputReport& report, Space space, std::uint32_t address) {
  report.push_back(space == Space::kRegisters ? kRegisterBit : 0);
  report.push_back(static_cast<std::uint8_t>(address >> 16));
  report.push_back(static_cast<std::uint8_t>(address >> 8));
  report.push_back(static_cast<std::uint8_t>(address));
}

}  // namespace

OutputReport RumbleOnly() { return {0x10, 0x00}; }

OutputReport SetLeds(std::uint8_t leds) { return {0x11, static_cast<std::uint8_t>(leds << 4)}; }

OutputReport SetMode(std::uint8_t data_report_id, bool continuous) {
  return {0x12, continuous ? kContinuousBit : std::uint8_t{0}, data_report_id};
}

OutputReport RequestStatus() { return {0x15, 0x00}; }

OutputReport WriteMemory(Space space, std::uint32_t address, Bytes data) {
  OutputReport report = {0x16};
  AppendAddress(report, space, address);
  const std::size_t size = std::min(data.size(), kWriteBytes);
  report.push_back(static_cast<std::uint8_t>(size));
  report.insert(report.end(), data.begin(), data.begin() + static_cast<std::ptrdiff_t>(size));
  report.resize(kMaxReportBytes, 0);
  return report;
}

OutputReport ReadMemory(Space space, std::uint32_t address, std::uint16_t size) {
  OutputReport report = {0x17};
  AppendAddress(report, space, address);
  report.push_back(static_cast<std::uint8_t>(size >> 8));
  report.push_back(static_cast<std::uint8_t>(size));
  return report;
}

void SetRumbleBit(OutputReport& report, bool on) {
  if (report.size() < 2) return;
  report[1] = static_cast<std::uint8_t>(on ? report[1] | kRumbleBit : report[1] & ~kRumbleBit);
}

OutputReport MemoryRead::Request() const {
  return ReadMemory(space_, address_ + static_cast<std::uint32_t>(bytes_.size()),
                    static_cast<std::uint16_t>(size_ - bytes_.size()));
}

MemoryRead::Progress MemoryRead::Take(const MemoryData& reply) {
  const std::size_t missing = size_ - bytes_.size();
  const auto due = static_cast<std::uint16_t>(address_ + bytes_.size());
  if (missing == 0 || reply.offset != due) return Progress::kForeign;
  if (reply.error != 0) {
    error_ = reply.error;
    return Progress::kRefused;
  }
  if (reply.size > missing) return Progress::kForeign;
  bytes_.insert(bytes_.end(), reply.data.begin(), reply.data.begin() + reply.size);
  return bytes_.size() == size_ ? Progress::kDone : Progress::kMore;
}

}  // namespace footing::reports
