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

namespace {

constexpr std::uint32_t kRows = 768;
constexpr std::size_t kBasicPairBytes = 5;
constexpr std::size_t kExtendedBytes = 3;
constexpr std::size_t kFullBytes = 9;

void AppendSeen(std::vector<stream::CameraPoint>& points, int x, int y, int size) {
  const stream::CameraPoint point{static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                  static_cast<std::uint32_t>(size)};
  if (point.y < kRows) points.push_back(point);
}

/// Two points in five bytes: x1, y1, upper bits of y1 x1 y2 x2, x2, y2.
void AppendBasicPair(std::vector<stream::CameraPoint>& points, Bytes pair) {
  const int upper = pair[2];
  AppendSeen(points, pair[0] | (upper >> 4 & 3) << 8, pair[1] | (upper >> 6 & 3) << 8, 0);
  AppendSeen(points, pair[3] | (upper & 3) << 8, pair[4] | (upper >> 2 & 3) << 8, 0);
}

/// x, y, then the upper bits of y and x and the size; the full format goes on with the bounding box
/// and the brightness.
void AppendExtended(std::vector<stream::CameraPoint>& points, Bytes point) {
  const int upper = point[2];
  AppendSeen(points, point[0] | (upper >> 4 & 3) << 8, point[1] | (upper >> 6 & 3) << 8,
             upper & 0x0f);
}

}  // namespace

std::vector<stream::CameraPoint> DecodeCamera(Bytes camera) {
  std::vector<stream::CameraPoint> points;
  switch (camera.size()) {
    case 2 * kBasicPairBytes:
      AppendBasicPair(points, camera.first(kBasicPairBytes));
      AppendBasicPair(points, camera.subspan(kBasicPairBytes));
      break;
    case 4 * kExtendedBytes:
      for (std::size_t at = 0; at < camera.size(); at += kExtendedBytes) {
        AppendExtended(points, camera.subspan(at, kExtendedBytes));
      }
      break;
    case 2 * kFullBytes:
    case 4 * kFullBytes:
      for (std::size_t at = 0; at < camera.size(); at += kFullBytes) {
        AppendExtended(points, camera.subspan(at, kFullBytes));
      }
      break;
    default:
      break;
  }
  return points;
}

namespace {

struct Identity {
  std::uint8_t bus;  ///< Byte 2: a4 answers data reports, a6 is a MotionPlus that is not active.
  std::uint8_t mode;
  std::uint8_t type;
  Extension extension;
};

constexpr Identity kIdentities[] = {
    // byte 2, 4, 5
    {0xa4, 0x00, 0x00, Extension::kNunchuk},
    {0xa4, 0x01, 0x01, Extension::kClassic},
    {0xa4, 0x04, 0x02, Extension::kBalanceBoard},
    {0xa4, 0x04, 0x05, Extension::kMotionPlus},
    {0xa4, 0x05, 0x05, Extension::kMotionPlusNunchuk},
    {0xa4, 0x07, 0x05, Extension::kMotionPlusClassic},
};

}  // namespace

Extension IdentifyExtension(Bytes id) {
  if (id.size() < 6 || id[3] != 0x20) return Extension::kNotReady;
  // One that was active before keeps its old mode in byte 4.
  if (id[2] == 0xa6 && id[5] == 0x05) return Extension::kMotionPlusInactive;
  if (id[2] != 0xa4) return Extension::kNotReady;
  for (const Identity& known : kIdentities) {
    if (id[4] == known.mode && id[5] == known.type) return known.extension;
  }
  return Extension::kOther;
}

std::optional<BoardCounts> DecodeBoard(Bytes extension) {
  if (extension.size() < 2 * kCorners) return std::nullopt;
  BoardCounts counts;
  for (std::size_t i = 0; i < kCorners; ++i) {
    counts.corners[i] = static_cast<std::uint16_t>(extension[2 * i] << 8 | extension[2 * i + 1]);
  }
  if (extension.size() > 8) {
    counts.has_temperature = true;
    counts.temperature = extension[8];
  }
  if (extension.size() > 10) {
    counts.has_battery = true;
    counts.battery = extension[10];
  }
  return counts;
}

double BoardBatteryFraction(std::uint8_t raw) {
  // Empty just below the first bar, full at 0xa0; the bars are not evenly spaced in volts.
  struct Point {
    double raw;
    double fraction;
  };
  constexpr Point kPoints[] = {{0x60, 0.0},  {0x6a, 0.25}, {0x78, 0.5},
                               {0x7d, 0.75}, {0x82, 0.9},  {0xa0, 1.0}};
  if (raw <= kPoints[0].raw) return 0;
  for (std::size_t i = 1; i < std::size(kPoints); ++i) {
    const Point& low = kPoints[i - 1];
    const Point& high = kPoints[i];
    if (raw <= high.raw) {
      return low.fraction + (high.fraction - low.fraction) * (raw - low.raw) / (high.raw - low.raw);
    }
  }
  return 1;
}

/// The six bytes of Nunchuk, Classic and MotionPlus (WiiBrew's pages "Wiimote/Extension
/// Controllers").
namespace {

bool AllAre(Bytes bytes, std::uint8_t value) {
  return std::all_of(bytes.begin(), bytes.end(), [value](std::uint8_t b) { return b == value; });
}

/// The six bytes of an extension that answers, or none.
Bytes Answered(Bytes extension) {
  if (extension.size() < kExtensionDataBytes) return {};
  const Bytes bytes = extension.first(kExtensionDataBytes);
  return AllAre(bytes, 0xff) ? Bytes() : bytes;
}

std::uint16_t WithLow(int high, int low) { return static_cast<std::uint16_t>(high << 2 | low); }

std::uint8_t Small(int value) { return static_cast<std::uint8_t>(value); }

}  // namespace

std::optional<NunchukCounts> DecodeNunchuk(Bytes extension) {
  const Bytes b = Answered(extension);
  if (b.empty()) return std::nullopt;
  const int low = b[5];
  NunchukCounts counts;
  counts.stick_x = b[0];
  counts.stick_y = b[1];
  counts.acceleration = {WithLow(b[2], low >> 2 & 3), WithLow(b[3], low >> 4 & 3),
                         WithLow(b[4], low >> 6 & 3)};
  counts.c = (low & 0x02) == 0;
  counts.z = (low & 0x01) == 0;
  return counts;
}

std::optional<NunchukCounts> DecodePassedNunchuk(Bytes extension) {
  const Bytes b = Answered(extension);
  if (b.empty()) return std::nullopt;
  const int low = b[5];
  NunchukCounts counts;
  counts.stick_x = b[0];
  counts.stick_y = b[1];
  // Byte 4 has bits 9 to 3 of z above the flag of the port.
  counts.acceleration = {WithLow(b[2], (low >> 4 & 1) << 1), WithLow(b[3], (low >> 5 & 1) << 1),
                         static_cast<std::uint16_t>((b[4] & 0xfe) << 2 | (low >> 6 & 3) << 1)};
  counts.c = (low & 0x08) == 0;
  counts.z = (low & 0x04) == 0;
  return counts;
}

std::optional<ClassicCounts> DecodeClassic(Bytes extension) {
  const Bytes b = Answered(extension);
  if (b.empty()) return std::nullopt;
  ClassicCounts counts;
  counts.left_x = Small(b[0] & 0x3f);
  counts.left_y = Small(b[1] & 0x3f);
  counts.right_x = Small((b[0] >> 6) << 3 | (b[1] >> 6) << 1 | b[2] >> 7);
  counts.right_y = Small(b[2] & 0x1f);
  counts.left_trigger = Small((b[2] >> 5 & 3) << 3 | b[3] >> 5);
  counts.right_trigger = Small(b[3] & 0x1f);
  // 0 is pressed; bit 0 of byte 4 is unused.
  counts.buttons = static_cast<std::uint16_t>((~b[4] & 0xfe) << 8 | (~b[5] & 0xff));
  return counts;
}

std::optional<ClassicCounts> DecodePassedClassic(Bytes extension) {
  const Bytes b = Answered(extension);
  if (b.empty()) return std::nullopt;
  // Up and left move to where the left stick's lowest bits are otherwise.
  const std::array<std::uint8_t, kExtensionDataBytes> usual = {
      Small(b[0] & 0xfe),
      Small(b[1] & 0xfe),
      b[2],
      b[3],
      b[4],
      Small((b[5] & 0xfc) | (b[1] & 1) << 1 | (b[0] & 1))};
  return DecodeClassic(usual);
}

PassedPacket PacketOf(Bytes extension) {
  const Bytes b = Answered(extension);
  if (b.empty() || AllAre(b, 0x00) || (b[5] & 0x01) != 0) return PassedPacket::kRubbish;
  return (b[5] & 0x02) != 0 ? PassedPacket::kMotionPlus : PassedPacket::kExtension;
}

std::optional<MotionPlusCounts> DecodeMotionPlus(Bytes extension) {
  if (PacketOf(extension) != PassedPacket::kMotionPlus) return std::nullopt;
  MotionPlusCounts counts;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    counts.counts[axis] =
        static_cast<std::uint16_t>((extension[3 + axis] & 0xfc) << 6 | extension[axis]);
  }
  counts.slow[kYaw] = extension[3] & 0x02;
  counts.slow[kPitch] = extension[3] & 0x01;
  counts.slow[kRoll] = extension[4] & 0x02;
  counts.extension_connected = extension[4] & 0x01;
  return counts;
}

std::optional<bool> ChildConnected(Bytes extension) {
  if (PacketOf(extension) == PassedPacket::kRubbish) return std::nullopt;
  return (extension[4] & 0x01) != 0;
}

}  // namespace footing::reports
