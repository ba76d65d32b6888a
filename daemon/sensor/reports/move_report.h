#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "daemon/sensor/reports/output_report.h"

/// Reports of a PS Move over Bluetooth: bytes to counts, and back.
///
/// The layout is that of the moveonpc wiki ("Input report") and of psmoveapi and Monado, which
/// agree. Axes as psmoveapi names them: x to the right, y to the ball, z out of the buttons.
namespace footing::reports {

/// Models of the PS Move.
enum class MoveModel {
  kZcm1,  ///< 054c:03d5, mini USB: two samples a report, magnetometer.
  kZcm2,  ///< 054c:0c5e, micro USB: one sample a report (sent twice), no magnetometer.
};

inline constexpr std::uint8_t kMoveInput = 0x01;
inline constexpr std::uint8_t kMoveLights = 0x06;
inline constexpr std::uint8_t kMoveCalibrationFeature = 0x10;
inline constexpr std::size_t kMoveCalibrationFeatureBytes = 49;  ///< With its id byte.

enum MoveButton : std::uint32_t {
  kMoveTriangle = 0x10,
  kMoveCircle = 0x20,
  kMoveCross = 0x40,
  kMoveSquare = 0x80,
  kMoveSelect = 0x100,
  kMoveStart = 0x800,
  kMovePs = 0x10000,
  kMoveMove = 0x80000,
  kMoveTrigger = 0x100000,
};

/// Raw values of one sample; axes as above.
struct MoveSample {
  std::array<std::int16_t, 3> acceleration{};
  std::array<std::int16_t, 3> angular_velocity{};
  std::uint8_t trigger = 0;  ///< 0 to 255.
};

/// A decoded input report of a PS Move.
struct MoveReport {
  std::uint32_t buttons = 0;  ///< Bits of MoveButton.
  std::uint8_t sequence = 0;  ///< 4 bits; rises by one a report.
  std::uint16_t timestamp = 0;
  std::uint8_t battery = 0;             ///< Raw; see MoveBatteryFraction.
  std::array<MoveSample, 2> samples{};  ///< Older first.
  std::size_t sample_count = 0;         ///< 2 of a ZCM1, 1 of a ZCM2.
  std::uint16_t temperature = 0;        ///< 12 bits; see MoveTemperature.
  bool has_magnetic_field = false;
  std::array<std::int16_t, 3>
      magnetic_field{};  ///< 12 bits signed; its y points away from the ball.
};

/// None when the id is another or the bytes end too early; longer ones are taken.
std::optional<MoveReport> DecodeMove(MoveModel model, Bytes report);

/// 0 to 1: five steps, and full at the charger. Charging (0xee) says nothing: -1, as unknown ones.
double MoveBatteryFraction(std::uint8_t raw);

/// In degrees Celsius, -10 to 69; psmoveapi's table of the thermistor, every tenth degree.
double MoveTemperature(std::uint16_t raw);

/// `rgb`: 0xRRGGBB. `rumble`: 0 to 255; a ZCM1's motor starts near 64. The sphere goes out unless
/// this is sent again: at least every 4 s, at most every 0.12 s (psmoveapi).
OutputReport MoveLights(std::uint32_t rgb, std::uint8_t rumble);

}  // namespace footing::reports
