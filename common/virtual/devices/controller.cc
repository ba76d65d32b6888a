#include "common/virtual/devices/controller.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <zlib.h>

#include "common/base/units.h"
#include "common/virtual/devices/noise.h"

namespace footing::virtual_devices {
namespace {

constexpr std::size_t kEepromBytes = 0x1700;
constexpr std::size_t kRegisterPageBytes = 0x100;
constexpr std::uint32_t kSpeakerPage = 0xa200;
constexpr std::uint32_t kExtensionPage = 0xa400;
constexpr std::uint32_t kMotionPlusPage = 0xa600;
constexpr std::uint32_t kCameraPage = 0xb000;
constexpr std::size_t kKeyRegister = 0xf0;
constexpr std::size_t kPlainRegister = 0xfb;
constexpr std::size_t kModeRegister = 0xfe;
constexpr std::size_t kIdentity = 0xfa;

bool Holds(std::size_t size, std::size_t at, std::size_t count) {
  return count <= size && at <= size - count;
}

}  // namespace

Memory::Memory(bool extension)
    : eeprom_(kEepromBytes, 0),
      extension_(extension ? kRegisterPageBytes : 0, 0),
      speaker_(kRegisterPageBytes, 0),
      camera_(kRegisterPageBytes, 0) {}

const std::vector<std::uint8_t>* Memory::Page(std::uint32_t page) const {
  if (page == kSpeakerPage) return &speaker_;
  if (page == kCameraPage) return &camera_;
  if (!port_ready_) return nullptr;
  if (page == kExtensionPage) return motion_plus_mode_ != 0 ? &motion_plus_ : &extension_;
  if (page == kMotionPlusPage && motion_plus_mode_ == 0) return &motion_plus_;
  return nullptr;
}

std::uint8_t Memory::Read(bool registers, std::uint32_t address,
                          std::span<std::uint8_t> out) const {
  if (!registers) {
    if (!Holds(eeprom_.size(), address, out.size())) return kMemoryBeyond;
    std::copy_n(eeprom_.begin() + address, out.size(), out.begin());
    return kMemoryOk;
  }
  const std::size_t at = address & 0xff;
  const std::vector<std::uint8_t>* bytes = Page(address >> 8);
  if (bytes == nullptr || !Holds(bytes->size(), at, out.size())) return kMemoryAbsent;
  std::copy_n(bytes->begin() + static_cast<std::ptrdiff_t>(at), out.size(), out.begin());
  // Without the key the real bytes come encrypted; what matters is that they are of no use.
  if (bytes == &extension_ && !extension_plain_) std::fill(out.begin(), out.end(), 0xff);
  return kMemoryOk;
}

std::uint8_t Memory::Write(bool registers, std::uint32_t address,
                           std::span<const std::uint8_t> data) {
  if (!registers) {
    if (!Holds(eeprom_.size(), address, data.size())) return kMemoryBeyond;
    std::copy(data.begin(), data.end(), eeprom_.begin() + address);
    return kMemoryOk;
  }
  const std::size_t at = address & 0xff;
  const std::vector<std::uint8_t>* bytes = Page(address >> 8);
  if (bytes == nullptr || !Holds(bytes->size(), at, data.size())) return kMemoryAbsent;
  // Identities and calibrations are read-only; 0xf0, 0xfb and 0xfe are commands.
  if (bytes == &speaker_ || bytes == &camera_) {
    auto& page = bytes == &speaker_ ? speaker_ : camera_;
    std::copy(data.begin(), data.end(), page.begin() + static_cast<std::ptrdiff_t>(at));
  } else if (data.size() == 1) {
    if (bytes == &extension_) {
      WriteExtension(at, data[0]);
    } else {
      WriteMotionPlus(at, data[0]);
    }
  }
  return kMemoryOk;
}

void Memory::WriteExtension(std::size_t at, std::uint8_t value) {
  if (at == kKeyRegister) {
    extension_key_ = value == 0x55;
    extension_plain_ = false;
  } else if (at == kPlainRegister) {
    extension_plain_ = extension_key_ && value == 0x00;
  }
}

void Memory::WriteMotionPlus(std::size_t at, std::uint8_t value) {
  if (motion_plus_mode_ != 0) {
    // The key ends the pass-through, and begins the initialisation of the extension behind.
    if (at != kKeyRegister || value != 0x55) return;
    motion_plus_mode_ = 0;
    motion_plus_[kIdentity + 2] = 0xa6;
    motion_plus_[kIdentity + 4] = 0x00;
    WriteExtension(at, value);
  } else if (at == kModeRegister && (value == 4 || value == 5 || value == 7)) {
    motion_plus_mode_ = value;
    motion_plus_[kIdentity + 2] = 0xa4;
    motion_plus_[kIdentity + 4] = value;
    // It keeps a copy of the calibration of the extension that it passes through.
    if (value != 4 && !extension_.empty()) {
      std::copy_n(extension_.begin() + 0x20, 16, motion_plus_.begin() + 0x40);
    }
  }
}

void Memory::SetExtension(std::vector<std::uint8_t> page) {
  extension_ = std::move(page);
  extension_key_ = false;
  extension_plain_ = false;
}

void Memory::SetMotionPlus(std::vector<std::uint8_t> page) {
  motion_plus_ = std::move(page);
  motion_plus_mode_ = 0;
}

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

std::string MakeSerial(SerialOf kind, std::uint64_t seed) {
  constexpr char kDigits[] = "0123456789abcdef";
  noise::Random random(seed);
  const auto first = static_cast<unsigned>(kind);
  std::string serial = {kDigits[first >> 4], kDigits[first & 15]};
  for (int i = 0; i < 5; ++i) {
    serial += ':';
    serial += kDigits[static_cast<int>(random.Uniform(0, 16))];
    serial += kDigits[static_cast<int>(random.Uniform(0, 16))];
  }
  return serial;
}

namespace {

Memory MakeProMemory() {
  Memory memory(true);
  constexpr std::uint8_t kPro[] = {0x00, 0x00, 0xa4, 0x20, 0x01, 0x20};
  std::copy(std::begin(kPro), std::end(kPro), memory.extension().begin() + 0xfa);
  return memory;
}

/// 12 bits with 0x800 in the middle and 0x400 to either end.
void PutStick(double value, std::uint8_t* out) {
  const double finite = std::isfinite(value) ? std::clamp(value, -1.0, 1.0) : 0;
  const int counts = 0x800 + static_cast<int>(std::round(finite * 0x400));
  out[0] = static_cast<std::uint8_t>(counts & 0xff);
  out[1] = static_cast<std::uint8_t>(counts >> 8);
}

}  // namespace

ProController::ProController(std::uint64_t seed) : controller_(MakeProMemory()) {
  identity_.product = stream::kProductTr;
  identity_.name = "Nintendo RVL-CNT-01-UC";
  identity_.serial = MakeSerial(SerialOf::kProController, seed);
}

std::optional<Report> ProController::Sample(const ProControllerSensors& sensors) {
  Readings readings;
  readings.extension.fill(0xff);
  if (controller_.memory().extension_plain()) {
    const GamepadSensors& pad = sensors.gamepad;
    readings.extension.fill(0);
    PutStick(pad.left_x, &readings.extension[0]);
    PutStick(pad.right_x, &readings.extension[2]);
    PutStick(pad.left_y, &readings.extension[4]);
    PutStick(pad.right_y, &readings.extension[6]);
    // Buttons are 0 when pressed. Byte 10: 1, battery, not on USB, not charging, sticks.
    const int released = ~static_cast<int>(pad.buttons);
    readings.extension[8] = static_cast<std::uint8_t>((released >> 8 & 0xff) | 1);
    readings.extension[9] = static_cast<std::uint8_t>(released & 0xff);
    readings.extension[10] = static_cast<std::uint8_t>(
        0x8c | battery_ << 4 | (sensors.left_stick ? 0 : 2) | (sensors.right_stick ? 0 : 1));
  }
  return controller_.DataReport(readings);
}

namespace {

constexpr double kStepKg = 17;
constexpr double kFactor = 0.99908;
constexpr double kTemperatureSlope = 0.007 / 10;  // Relative, a step of the thermometer.

std::array<BalanceBoard::Points, BalanceBoard::kCorners> DrawPoints(std::uint64_t seed) {
  // Real boards: 2800 to 8300 counts empty, 9.8 to 11.5 g a count, another slope above 17 kg.
  noise::Random random(seed);
  std::array<BalanceBoard::Points, BalanceBoard::kCorners> points;
  for (BalanceBoard::Points& corner : points) {
    corner[0] = static_cast<int>(random.Uniform(2800, 8300));
    corner[1] = corner[0] + static_cast<int>(kStepKg / random.Uniform(0.0098, 0.0108));
    corner[2] = corner[1] + static_cast<int>(kStepKg / random.Uniform(0.0100, 0.0115));
  }
  return points;
}

Memory MakeMemory(const std::array<BalanceBoard::Points, BalanceBoard::kCorners>& points) {
  Memory memory(true);
  const std::span<std::uint8_t> page = memory.extension();
  page[0x20] = 0x01;
  page[0x21] = 0x69;
  for (std::size_t i = 0; i < 3 * BalanceBoard::kCorners; ++i) {
    const int count = points[i % BalanceBoard::kCorners][i / BalanceBoard::kCorners];
    page[0x24 + 2 * i] = static_cast<std::uint8_t>(count >> 8);
    page[0x25 + 2 * i] = static_cast<std::uint8_t>(count);
  }
  page[0x60] = BalanceBoard::kReferenceTemperature;
  page[0x61] = 0x01;
  uLong crc = crc32(0, page.data() + 0x24, 24);
  crc = crc32(crc, page.data() + 0x20, 2);
  crc = crc32(crc, page.data() + 0x60, 2);
  for (std::size_t i = 0; i < 4; ++i) {
    page[0x3c + i] = static_cast<std::uint8_t>(crc >> (24 - 8 * i));
  }
  constexpr std::uint8_t kBoard[] = {0x00, 0x00, 0xa4, 0x20, 0x04, 0x02};
  std::copy(std::begin(kBoard), std::end(kBoard), page.begin() + 0xfa);
  return memory;
}

/// `kg` as the cell has it, before the host's correction.
std::uint16_t Counts(const BalanceBoard::Points& points, double kg) {
  const std::size_t low = kg < kStepKg ? 0 : 1;
  const double counts = points[low] + (kg - kStepKg * static_cast<double>(low)) / kStepKg *
                                          (points[low + 1] - points[low]);
  return static_cast<std::uint16_t>(std::clamp(std::round(counts), 0.0, 65535.0));
}

}  // namespace

BalanceBoard::BalanceBoard(std::uint64_t seed) : BalanceBoard(seed, DrawPoints(seed)) {}

BalanceBoard::BalanceBoard(std::uint64_t seed, const std::array<Points, kCorners>& points)
    : points_(points), controller_(MakeMemory(points_)) {
  identity_.name = "Nintendo RVL-WBC-01";
  identity_.serial = MakeSerial(SerialOf::kBalanceBoard, seed);
}

std::optional<Report> BalanceBoard::Sample(const CornerForces& forces, bool button) {
  Readings readings;
  readings.buttons = button ? 0x0008 : 0;
  readings.extension.fill(0xff);
  if (controller_.memory().extension_plain()) {
    const double corners[kCorners] = {forces.top_right_n, forces.bottom_right_n, forces.top_left_n,
                                      forces.bottom_left_n};
    readings.extension.fill(0);
    const double correction =
        kFactor * (1 - kTemperatureSlope * (temperature_ - kReferenceTemperature));
    for (std::size_t i = 0; i < kCorners; ++i) {
      const double kg = std::isfinite(corners[i]) ? NewtonsToKilograms(corners[i]) : 0;
      const std::uint16_t counts = Counts(points_[i], kg / correction);
      readings.extension[2 * i] = static_cast<std::uint8_t>(counts >> 8);
      readings.extension[2 * i + 1] = static_cast<std::uint8_t>(counts);
    }
    readings.extension[8] = temperature_;
    readings.extension[10] = battery_;
  }
  return controller_.DataReport(readings);
}

}  // namespace footing::virtual_devices
