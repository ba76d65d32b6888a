#include "daemon/sensor/reports/input_report.h"

#include <algorithm>
#include <utility>

namespace footing::reports {
namespace {

/// Where a data report keeps what, counted from the id byte; 0 means it has none.
struct Layout {
  std::uint8_t id;
  bool buttons;
  std::uint8_t acceleration;
  std::uint8_t camera;
  std::uint8_t camera_size;
  std::uint8_t extension;
  std::uint8_t extension_size;
  Half half = Half::kNone;
};

constexpr Layout kLayouts[] = {
    // id  buttons accel camera size ext size
    {0x30, true, 0, 0, 0, 0, 0},
    {0x31, true, 3, 0, 0, 0, 0},
    {0x32, true, 0, 0, 0, 3, 8},
    {0x33, true, 3, 6, 12, 0, 0},
    {0x34, true, 0, 0, 0, 3, 19},
    {0x35, true, 3, 0, 0, 6, 16},
    {0x36, true, 0, 3, 10, 13, 9},
    {0x37, true, 3, 6, 10, 16, 6},
    {0x3d, false, 0, 0, 0, 1, 21},
    {0x3e, true, 0, 4, 18, 0, 0, Half::kFirst},
    {0x3f, true, 0, 4, 18, 0, 0, Half::kSecond},
};

const Layout* FindLayout(std::uint8_t id) {
  const auto* found = std::find_if(std::begin(kLayouts), std::end(kLayouts),
                                   [id](const Layout& layout) { return layout.id == id; });
  return found == std::end(kLayouts) ? nullptr : found;
}

/// Bits 5 and 6 of the button bytes carry the low bits of the acceleration.
constexpr std::uint8_t kFirstButtons = 0x1f;
constexpr std::uint8_t kSecondButtons = 0x9f;

std::array<std::uint16_t, 3> AccelerationCounts(Bytes report, std::size_t at) {
  const int first = report[1];
  const int second = report[2];
  return {static_cast<std::uint16_t>(report[at] << 2 | (first >> 5 & 3)),
          static_cast<std::uint16_t>(report[at + 1] << 2 | (second >> 4 & 2)),
          static_cast<std::uint16_t>(report[at + 2] << 2 | (second >> 5 & 2))};
}

/// Bits 5 and 6 of both button bytes are four bits of z.
void DecodeHalf(Bytes report, Data& data) {
  data.half_axis = report[3];
  data.half_z = static_cast<std::uint8_t>((report[1] >> 5 & 3) | (report[2] >> 5 & 3) << 2);
}

void DecodeData(Bytes report, const Layout& layout, InputReport& out) {
  Data data;
  data.id = report[0];
  data.half = layout.half;
  if (layout.half != Half::kNone && report.size() > 3) DecodeHalf(report, data);
  if (layout.camera != 0 && report.size() >= std::size_t{layout.camera} + layout.camera_size) {
    data.camera_size = layout.camera_size;
    std::copy_n(report.begin() + layout.camera, layout.camera_size, data.camera_bytes.begin());
  }
  if (layout.acceleration != 0 && report.size() >= layout.acceleration + 3u) {
    data.has_acceleration = true;
    data.acceleration_counts = AccelerationCounts(report, layout.acceleration);
  }
  if (layout.extension != 0 && report.size() > layout.extension) {
    const std::size_t there = report.size() - layout.extension;
    data.extension_size =
        static_cast<std::uint8_t>(std::min<std::size_t>(there, layout.extension_size));
    std::copy_n(report.begin() + layout.extension, data.extension_size,
                data.extension_bytes.begin());
  }
  out.body = data;
}

void DecodeStatus(Bytes report, InputReport& out) {
  if (report.size() < 7) {
    out.body = Undecodable{"status report is cut short"};
    return;
  }
  const std::uint8_t flags = report[3];
  Status status;
  status.battery_low = flags & 0x01;
  status.extension = flags & 0x02;
  status.speaker = flags & 0x04;
  status.ir_camera = flags & 0x08;
  status.leds = flags >> 4;
  status.battery = report[6];
  out.body = status;
}

void DecodeMemoryData(Bytes report, InputReport& out) {
  MemoryData memory;
  if (report.size() < 6) {
    out.body = Undecodable{"memory report is cut short"};
    return;
  }
  memory.error = report[3] & 0x0f;
  memory.size = static_cast<std::uint8_t>((report[3] >> 4) + 1);
  memory.offset = static_cast<std::uint16_t>(report[4] << 8 | report[5]);
  const std::size_t there = report.size() - 6;
  if (memory.error == 0 && there < memory.size) {
    out.body = Undecodable{"memory report has fewer bytes than it says"};
    return;
  }
  std::copy_n(report.begin() + 6, std::min<std::size_t>(there, memory.size), memory.data.begin());
  out.body = memory;
}

void DecodeAcknowledgement(Bytes report, InputReport& out) {
  if (report.size() < 5) {
    out.body = Undecodable{"acknowledgement is cut short"};
    return;
  }
  out.body = Acknowledgement{report[3], report[4]};
}

}  // namespace

InputReport Decode(Bytes report) {
  InputReport out;
  if (report.empty()) {
    out.body = Undecodable{"report is empty"};
    return out;
  }
  if (report.size() > kMaxReportBytes) {
    out.body = Undecodable{"report is longer than 22 bytes"};
    return out;
  }
  const std::uint8_t id = report[0];
  const Layout* layout = FindLayout(id);
  if (layout == nullptr && id != 0x20 && id != 0x21 && id != 0x22) {
    out.body = Undecodable{"report id is unknown"};
    return out;
  }
  if (layout == nullptr || layout->buttons) {
    if (report.size() < 3) {
      out.body = Undecodable{"report ends within its buttons"};
      return out;
    }
    out.has_buttons = true;
    out.buttons =
        static_cast<std::uint16_t>((report[1] & kFirstButtons) << 8 | (report[2] & kSecondButtons));
  }
  if (layout != nullptr) DecodeData(report, *layout, out);
  if (id == 0x20) DecodeStatus(report, out);
  if (id == 0x21) DecodeMemoryData(report, out);
  if (id == 0x22) DecodeAcknowledgement(report, out);
  return out;
}

std::optional<Data> Interleaver::Take(const Data& data) {
  if (data.half == Half::kNone) {
    first_.reset();
    return data;
  }
  const std::optional<Data> first = std::exchange(first_, std::nullopt);
  if (data.half == Half::kFirst) {
    if (data.camera_size != 0) first_ = data;
    return std::nullopt;
  }
  if (!first || data.camera_size == 0) return std::nullopt;
  Data pair = *first;
  pair.id = data.id;
  pair.half = Half::kNone;
  pair.has_acceleration = true;
  const int z = first->half_z << 4 | data.half_z;
  pair.acceleration_counts = {static_cast<std::uint16_t>(first->half_axis << 2),
                              static_cast<std::uint16_t>(data.half_axis << 2),
                              static_cast<std::uint16_t>(z << 2)};
  std::copy_n(data.camera_bytes.begin(), data.camera_size,
              pair.camera_bytes.begin() + first->camera_size);
  pair.camera_size = static_cast<std::uint8_t>(first->camera_size + data.camera_size);
  return pair;
}

double BatteryFraction(std::uint8_t raw) { return std::min(1.0, raw / double{0x7c}); }

}  // namespace footing::reports
