#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "common/stream/sensor.h"

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
  std::uint8_t half_axis = 0;  ///< In a half: its byte of x or y, 8 bits.
  std::uint8_t half_z = 0;     ///< In a half: its four bits of z, the first's are the upper ones.
  std::array<std::uint8_t, 21> extension_bytes{};
  std::uint8_t extension_size = 0;
  std::array<std::uint8_t, 36> camera_bytes{};
  /// 10 basic, 12 extended, 18 half of full, 36 full (a joined pair); 0 when the report has none or
  /// was cut short in them.
  std::uint8_t camera_size = 0;

  Bytes extension() const { return Bytes(extension_bytes.data(), extension_size); }
  Bytes camera() const { return Bytes(camera_bytes.data(), camera_size); }
};

/// A decoded input report.
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

/// Charge in a Wiimote's status, 0 to 1: bars at 0x33, 0x44, 0x55, full at 0x7c (hid-wiimote).
double BatteryFraction(std::uint8_t raw);

// The bright points that a Wiimote's infrared camera sees.

/// At most four, only those seen. The format is known by the size (WiiBrew, "Wiimote/IR camera"):
/// 10 bytes basic (no sizes), 12 extended, 18 half of full (points 1 and 2, or 3 and 4), 36 full;
/// any other size gives none. A point that is not seen is all FF; one whose row or column is
/// outside the camera's 1024 x 768 is not seen either.
std::vector<stream::CameraPoint> DecodeCamera(Bytes camera);

/// Device in the extension port, and the Balance Board's bytes.
enum class Extension {
  kNotReady,  ///< All FF, or encrypted leftovers: ask again, do not conclude that there is none.
  kNunchuk,
  kClassic,  ///< Classic Controller or Classic Controller Pro.
  kBalanceBoard,
  kMotionPlusInactive,  ///< Answers at 0xa600fa only.
  kMotionPlus,          ///< Active, alone; from here on it answers at 0xa400fa.
  kMotionPlusNunchuk,   ///< Active, with a Nunchuk's packets in between.
  kMotionPlusClassic,   ///< Active, with a Classic's packets in between.
  kOther,
};

/// From the six bytes at 0xa400fa (0xa600fa of an inactive MotionPlus). The first byte varies
/// between units and does not count.
Extension IdentifyExtension(Bytes id);

/// Corners in the order in which the board's bytes and calibration have them.
enum Corner : std::size_t { kTopRight = 0, kBottomRight = 1, kTopLeft = 2, kBottomLeft = 3 };
inline constexpr std::size_t kCorners = 4;

/// Raw values of a Balance Board's cells.
struct BoardCounts {
  std::array<std::uint16_t, kCorners> corners{};
  bool has_temperature = false;
  std::uint8_t temperature = 0;
  bool has_battery = false;
  std::uint8_t battery = 0;  ///< Raw; see BoardBatteryFraction.
};

/// From the extension bytes of report 0x32 (no battery) or 0x34; none when fewer than 8.
std::optional<BoardCounts> DecodeBoard(Bytes extension);

/// 0 to 1, from byte 10: four bars begin at 0x6a, 0x78, 0x7d, 0x82, and 0xa0 is full.
double BoardBatteryFraction(std::uint8_t raw);

/// Every extension's data is six bytes; a report may carry more, which are padding.
inline constexpr std::size_t kExtensionDataBytes = 6;

/// Raw values of a Nunchuk.
struct NunchukCounts {
  std::uint8_t stick_x = 0;                     ///< Rises to the right.
  std::uint8_t stick_y = 0;                     ///< Rises to the front.
  std::array<std::uint16_t, 3> acceleration{};  ///< x, y, z of 10 bits.
  bool c = false;
  bool z = false;
};

/// None when fewer than six bytes, or all FF (the port does not answer).
std::optional<NunchukCounts> DecodeNunchuk(Bytes extension);
/// The form in which a MotionPlus passes it on: the lowest bit of each axis is lost, and 0 here.
std::optional<NunchukCounts> DecodePassedNunchuk(Bytes extension);

/// Bits of ClassicCounts::buttons: data byte 4 in bits 8 to 15, byte 5 in bits 0 to 7.
enum ClassicButton : std::uint16_t {
  kClassicRightTrigger = 0x0200,
  kClassicPlus = 0x0400,
  kClassicHome = 0x0800,
  kClassicMinus = 0x1000,
  kClassicLeftTrigger = 0x2000,
  kClassicDown = 0x4000,
  kClassicRight = 0x8000,
  kClassicUp = 0x0001,
  kClassicLeft = 0x0002,
  kClassicZr = 0x0004,
  kClassicX = 0x0008,
  kClassicA = 0x0010,
  kClassicY = 0x0020,
  kClassicB = 0x0040,
  kClassicZl = 0x0080,
};

/// Raw values of a Classic Controller.
struct ClassicCounts {
  std::uint8_t left_x = 0;  ///< 6 bits; sticks rise to the right and to the front.
  std::uint8_t left_y = 0;
  std::uint8_t right_x = 0;  ///< 5 bits.
  std::uint8_t right_y = 0;
  std::uint8_t left_trigger = 0;  ///< 5 bits; rise when pressed.
  std::uint8_t right_trigger = 0;
  std::uint16_t buttons = 0;
};

/// None when fewer than six bytes, or all FF.
std::optional<ClassicCounts> DecodeClassic(Bytes extension);
/// The form in which a MotionPlus passes it on: the lowest bits of the left stick are lost.
std::optional<ClassicCounts> DecodePassedClassic(Bytes extension);

/// Kind of a packet of an active MotionPlus.
enum class PassedPacket {
  kMotionPlus,
  kExtension,  ///< From the child: Nunchuk or Classic.
  kRubbish,    ///< Short, all 00, or with the bit set that is always 0: right after activation.
};

PassedPacket PacketOf(Bytes extension);

/// Order of the axes in packets and calibration.
enum MotionPlusAxis : std::size_t { kYaw = 0, kRoll = 1, kPitch = 2 };

/// Raw values of a MotionPlus' gyroscope.
struct MotionPlusCounts {
  std::array<std::uint16_t, 3> counts{};  ///< In the order of MotionPlusAxis, 14 bits.
  std::array<bool, 3> slow{};             ///< The axis uses its slow (fine) range in this packet.
  bool extension_connected = false;       ///< A child is in the MotionPlus' own port.
};

/// None unless PacketOf says kMotionPlus.
std::optional<MotionPlusCounts> DecodeMotionPlus(Bytes extension);

/// Whether a child is plugged into the MotionPlus: packets of both kinds say so. None for rubbish.
std::optional<bool> ChildConnected(Bytes extension);

}  // namespace footing::reports
