#include "common/virtual/devices/controller.h"

#include <algorithm>

namespace footing::virtual_devices {
namespace {

constexpr std::size_t kMemoryPieceBytes = 16;
constexpr std::uint8_t kErrorNoSuchMode = 3;

/// Lengths of the output reports, id byte included, from 0x10 on; 0 is not a report.
constexpr std::uint8_t kOutputBytes[] = {2, 2, 3, 2, 2, 2, 22, 7, 22, 2, 2};

/// Payload of each data report: what follows the id, from left to right.
struct ReportLayout {
  std::uint8_t id;
  bool buttons;
  bool acceleration;
  std::uint8_t camera;  ///< Bytes.
  std::uint8_t extension;
};
constexpr ReportLayout kReportLayouts[] = {
    {0x30, true, false, 0, 0},  {0x31, true, true, 0, 0},   {0x32, true, false, 0, 8},
    {0x33, true, true, 12, 0},  {0x34, true, false, 0, 19}, {0x35, true, true, 0, 16},
    {0x36, true, false, 10, 9}, {0x37, true, true, 10, 6},  {0x3d, false, false, 0, 21},
};

const ReportLayout* FindLayout(std::uint8_t id) {
  for (const ReportLayout& layout : kReportLayouts) {
    if (layout.id == id) return &layout;
  }
  return nullptr;
}

bool Interleaved(std::uint8_t mode) { return mode == 0x3e || mode == 0x3f; }

/// Two points in five bytes: x, y, upper bits (y1 x1 y2 x2), x, y. FF for a point that is not
/// there.
void PutBasicPair(const std::optional<CameraPoint>* points, std::uint8_t* out) {
  int x[2], y[2];
  for (int i = 0; i < 2; ++i) {
    x[i] = points[i] ? std::clamp(points[i]->x, 0, 1023) : 1023;
    y[i] = points[i] ? std::clamp(points[i]->y, 0, 767) : 1023;
  }
  out[0] = static_cast<std::uint8_t>(x[0]);
  out[1] = static_cast<std::uint8_t>(y[0]);
  out[2] =
      static_cast<std::uint8_t>((y[0] >> 8) << 6 | (x[0] >> 8) << 4 | (y[1] >> 8) << 2 | x[1] >> 8);
  out[3] = static_cast<std::uint8_t>(x[1]);
  out[4] = static_cast<std::uint8_t>(y[1]);
}

/// Three bytes: x, y, upper bits of both and the size.
void PutExtended(const CameraPoint& point, std::uint8_t* out) {
  const int x = std::clamp(point.x, 0, 1023), y = std::clamp(point.y, 0, 767);
  out[0] = static_cast<std::uint8_t>(x);
  out[1] = static_cast<std::uint8_t>(y);
  out[2] = static_cast<std::uint8_t>((y >> 8) << 6 | (x >> 8) << 4 | std::clamp(point.size, 0, 15));
}

/// Nine bytes: extended, then the bounding box in 128 by 96, 0, brightness.
void PutFull(const CameraPoint& point, std::uint8_t* out) {
  PutExtended(point, out);
  const int column = std::clamp(point.x, 0, 1023) / 8, row = std::clamp(point.y, 0, 767) / 8;
  out[3] = out[5] = static_cast<std::uint8_t>(column);
  out[4] = out[6] = static_cast<std::uint8_t>(row);
  out[7] = 0;
  out[8] = 0x60;
}

std::uint32_t Address(std::span<const std::uint8_t> report) {
  return std::uint32_t{report[2]} << 16 | std::uint32_t{report[3]} << 8 | report[4];
}

}  // namespace

bool CarriesExtension(std::uint8_t mode) {
  const ReportLayout* layout = FindLayout(mode);
  return layout != nullptr && layout->extension > 0;
}

std::vector<Report> Controller::HandleOutput(std::span<const std::uint8_t> report) {
  std::vector<Report> answers;
  if (report.empty() || report[0] < 0x10 || report[0] > 0x1a) return answers;
  const std::uint8_t id = report[0];
  if (report.size() < kOutputBytes[id - 0x10]) return answers;
  rumble_ = report[1] & 0x01;
  const bool wants_answer = report[1] & 0x02;
  const bool enable = report[1] & 0x04;
  if (id == 0x11) leds_ = report[1] >> 4;
  if (id == 0x13) camera_clock_ = enable;
  if (id == 0x14) speaker_ = enable;
  if (id == 0x1a) camera_logic_ = enable;
  if (id == 0x12) {
    AnswerMode(report, answers);
  } else if (id == 0x15) {
    answers.push_back(StatusReport());
  } else if (id == 0x16) {
    AnswerWrite(report, answers);
  } else if (id == 0x17) {
    AnswerRead(report, answers);
  } else if (wants_answer && id != 0x10) {
    answers.push_back(Acknowledge(id, 0));
  }
  return answers;
}

void Controller::AnswerMode(std::span<const std::uint8_t> report, std::vector<Report>& answers) {
  if (FindLayout(report[2]) == nullptr && !Interleaved(report[2])) {
    answers.push_back(Acknowledge(0x12, kErrorNoSuchMode));
    return;
  }
  continuous_ = report[1] & 0x04;
  mode_ = report[2];
  last_data_.clear();
  second_half_ = false;
  answers.push_back(Acknowledge(0x12, 0));
}

void Controller::AnswerWrite(std::span<const std::uint8_t> report, std::vector<Report>& answers) {
  const std::size_t size = report[5];
  if (size == 0 || size > kMemoryPieceBytes) {
    answers.push_back(Acknowledge(0x16, kMemoryBeyond));
    return;
  }
  const bool registers = report[1] & 0x04;
  answers.push_back(
      Acknowledge(0x16, memory_.Write(registers, Address(report), report.subspan(6, size))));
}

void Controller::AnswerRead(std::span<const std::uint8_t> report,
                            std::vector<Report>& answers) const {
  const bool registers = report[1] & 0x04;
  std::uint32_t address = Address(report);
  std::size_t left = static_cast<std::size_t>(report[5] << 8 | report[6]);
  while (left > 0) {
    const std::size_t size = std::min(left, kMemoryPieceBytes);
    Report piece(22, 0);
    piece[0] = 0x21;
    piece[1] = static_cast<std::uint8_t>(buttons_ >> 8);
    piece[2] = static_cast<std::uint8_t>(buttons_);
    piece[4] = static_cast<std::uint8_t>(address >> 8);
    piece[5] = static_cast<std::uint8_t>(address);
    const std::uint8_t error =
        memory_.Read(registers, address, std::span<std::uint8_t>(piece).subspan(6, size));
    const std::size_t said = error == kMemoryOk ? size : kMemoryPieceBytes;
    piece[3] = static_cast<std::uint8_t>((said - 1) << 4 | error);
    answers.push_back(std::move(piece));
    if (error != kMemoryOk) return;
    address += static_cast<std::uint32_t>(size);
    left -= size;
  }
}

std::optional<Report> Controller::DataReport(const Readings& readings) {
  buttons_ = readings.buttons;
  if (Interleaved(mode_)) return InterleavedReport(readings);
  const ReportLayout* layout = FindLayout(mode_);
  if (layout == nullptr) return std::nullopt;
  Report report = {layout->id};
  const auto& counts = readings.acceleration_counts;
  if (layout->buttons) {
    int first = readings.buttons >> 8 & 0x1f;
    int second = readings.buttons & 0x9f;
    if (layout->acceleration) {
      first |= (counts[0] & 3) << 5;
      second |= (counts[1] >> 1 & 1) << 5 | (counts[2] >> 1 & 1) << 6;
    }
    report.push_back(static_cast<std::uint8_t>(first));
    report.push_back(static_cast<std::uint8_t>(second));
  }
  if (layout->acceleration) {
    for (const std::uint16_t count : counts)
      report.push_back(static_cast<std::uint8_t>(count >> 2));
  }
  const auto camera = CameraBytes(readings, layout->camera);
  report.insert(report.end(), camera.begin(), camera.end());
  report.insert(report.end(), readings.extension.begin(),
                readings.extension.begin() + layout->extension);
  if (!continuous_ && report == last_data_) return std::nullopt;
  last_data_ = report;
  return report;
}

/// Acceleration of 8 bits: x in 0x3e, y in 0x3f, z in the free bits of all four button bytes.
Report Controller::InterleavedReport(const Readings& readings) {
  const bool second = second_half_;
  second_half_ = !second_half_;
  if (!second) held_ = readings;
  const int z = held_.acceleration_counts[2] >> 2;
  const int bits = second ? z : z >> 4;
  Report report = {static_cast<std::uint8_t>(second ? 0x3f : 0x3e),
                   static_cast<std::uint8_t>((readings.buttons >> 8 & 0x1f) | (bits & 3) << 5),
                   static_cast<std::uint8_t>((readings.buttons & 0x9f) | (bits >> 2 & 3) << 5),
                   static_cast<std::uint8_t>(held_.acceleration_counts[second ? 1 : 0] >> 2)};
  const auto camera = CameraBytes(held_, 36);
  const auto half = camera.begin() + (second ? 18 : 0);
  report.insert(report.end(), half, half + 18);
  return report;
}

std::vector<std::uint8_t> Controller::CameraBytes(const Readings& readings,
                                                  std::size_t size) const {
  std::vector<std::uint8_t> bytes(size, 0xff);
  const std::uint8_t format = size == 10 ? 1 : size == 12 ? 3 : 5;
  if (size == 0 || !camera_on() || memory_.camera()[0x33] != format) return bytes;
  if (format == 1) {
    PutBasicPair(&readings.camera[0], &bytes[0]);
    PutBasicPair(&readings.camera[2], &bytes[5]);
    return bytes;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    if (!readings.camera[i]) continue;
    if (format == 3) {
      PutExtended(*readings.camera[i], &bytes[3 * i]);
    } else {
      PutFull(*readings.camera[i], &bytes[9 * i]);
    }
  }
  return bytes;
}

Report Controller::UnaskedStatus() {
  mode_ = 0;
  return StatusReport();
}

Report Controller::StatusReport() const {
  const bool low = battery_ < 0x20;
  const bool plugged = memory_.has_extension();
  return {0x20,
          static_cast<std::uint8_t>(buttons_ >> 8),
          static_cast<std::uint8_t>(buttons_),
          static_cast<std::uint8_t>(leds_ << 4 | (camera_on() ? 8 : 0) | (speaker_ ? 4 : 0) |
                                    (plugged ? 2 : 0) | (low ? 1 : 0)),
          0,
          0,
          battery_};
}

Report Controller::Acknowledge(std::uint8_t report, std::uint8_t error) const {
  return {0x22, static_cast<std::uint8_t>(buttons_ >> 8), static_cast<std::uint8_t>(buttons_),
          report, error};
}

}  // namespace footing::virtual_devices
