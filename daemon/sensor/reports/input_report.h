#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>

/// HID reports of Wiimote and Balance Board: bytes to counts, and back to bytes.
///
/// The layout is that of WiiBrew's page "Wiimote" and of the kernel's hid-wiimote, which agree. A
/// report is its id byte and a payload of at most 21 bytes; no Bluetooth header.
namespace footing::reports {

using Bytes = std::span<const std::uint8_t>;

inline constexpr std::size_t kMaxReportBytes = 22;

/// Bits of InputReport::buttons: the first byte of the two in bits 8 to 15.
enum Button : std::uint16_t {
  kLeft = 0x0100,
  kRight = 0x0200,
  kDown = 0x0400,
  kUp = 0x0800,
  kPlus = 0x1000,
  kTwo = 0x0001,
  kOne = 0x0002,
  kB = 0x0004,
  kA = 0x0008,  ///< Also the Balance Board's only button.
  kMinus = 0x0010,
  kHome = 0x0080,
};

/// A report that makes no sense: unknown id, empty, too long or too short for what it must hold.
struct Undecodable {
  const char* reason = "";
};

/// Id 0x20: the answer to a status request, or unasked when the extension changes. After it the
/// device sends no data until the mode is set again.
struct Status {
  bool battery_low = false;
  bool extension = false;
  bool speaker = false;
  bool ir_camera = false;
  std::uint8_t leds = 0;     ///< Bits 0 to 3.
  std::uint8_t battery = 0;  ///< Raw; see BatteryFraction.
};

/// Id 0x21: up to 16 bytes of a memory read.
struct MemoryData {
  std::uint8_t error = 0;    ///< 0 ok, 7 write-only or absent register, 8 no such memory.
  std::uint16_t offset = 0;  ///< Low 16 bits of the address.
  std::uint8_t size = 0;     ///< 1 to 16.
  std::array<std::uint8_t, 16> data{};
};

/// Id 0x22.
struct Acknowledgement {
  std::uint8_t report = 0;
  std::uint8_t error = 0;  ///< 0 ok; 2 busy or refused; 3, 7, 8 seen too.
};

/// Which part of an interleaved pair a report is.
enum class Half {
  kNone,    ///< A report that stands for itself, or a joined pair.
  kFirst,   ///< 0x3e: x, half of z, camera points 1 and 2.
  kSecond,  ///< 0x3f: y, the other half of z, camera points 3 and 4.
};

/// Ids 0x30 to 0x3f. Short forms, as the kernel accepts them, lack what their bytes do not reach.
struct Data {
  std::uint8_t id = 0;
  Half half = Half::kNone;
  bool has_acceleration = false;  ///< Never of a half: see Interleaver.
  /// x, y, z in counts of 10 bits; y and z carry 9 real bits, their lowest is 0. Of a joined pair
  /// 8 real bits, their lowest two are 0.
  std::array<std::uint16_t, 3> acceleration_counts{};
  std::uint8_t half_axis = 0;  ///< Of a half: its byte of x or y, 8 bits.
  std::uint8_t half_z = 0;     ///< Of a half: its four bits of z, the first's are the upper ones.
  std::array<std::uint8_t, 21> extension_bytes{};
  std::uint8_t extension_size = 0;
  std::array<std::uint8_t, 36> camera_bytes{};
  /// 10 basic, 12 extended, 18 half of full, 36 full (a joined pair); 0 when the report has none or
  /// was cut short in them.
  std::uint8_t camera_size = 0;

  Bytes extension() const { return Bytes(extension_bytes.data(), extension_size); }
  Bytes camera() const { return Bytes(camera_bytes.data(), camera_size); }
};

struct InputReport {
  bool has_buttons = false;
  std::uint16_t buttons = 0;  ///< Accelerometer bits masked.
  std::variant<Undecodable, Status, MemoryData, Acknowledgement, Data> body;
};

/// Never reads past the bytes. The ids 0x3e and 0x3f give halves, which an Interleaver joins.
InputReport Decode(Bytes report);

/// Joins the halves that come in turn: 0x3e, then 0x3f.
class Interleaver {
 public:
  /// A report that is not a half comes back as it is. A second half right after a first one gives
  /// the pair: acceleration, 36 bytes of camera, id 0x3f, Half::kNone. Anything else gives nothing:
  /// the first half, a half whose partner was lost, halves cut short.
  std::optional<Data> Take(const Data& data);

 private:
  std::optional<Data> first_;
};

/// Of a Wiimote's status, 0 to 1: bars at 0x33, 0x44, 0x55, full at 0x7c (hid-wiimote).
double BatteryFraction(std::uint8_t raw);

}  // namespace footing::reports
