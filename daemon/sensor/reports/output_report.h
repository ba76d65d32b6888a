#pragma once

#include <cstdint>
#include <vector>

#include "daemon/sensor/reports/input_report.h"

namespace footing::reports {

/// Id byte and payload, as hid_write takes it.
using OutputReport = std::vector<std::uint8_t>;

enum class Space {
  kEeprom,     ///< 0x0000 to 0x16ff.
  kRegisters,  ///< 0xa20000 speaker, 0xa40000 extension, 0xa60000 MotionPlus, 0xb00000 camera.
};

OutputReport RumbleOnly();
/// `leds`: bits 0 to 3.
OutputReport SetLeds(std::uint8_t leds);
/// `continuous`: reports come at the device's own rate, also when nothing changes.
OutputReport SetMode(std::uint8_t data_report_id, bool continuous);
OutputReport RequestStatus();
/// `data`: 1 to 16 bytes.
OutputReport WriteMemory(Space space, std::uint32_t address, Bytes data);
OutputReport ReadMemory(Space space, std::uint32_t address, std::uint16_t size);

/// Every output report carries the rumble bit; the motor stops at one without it. Called at the
/// single place that sends.
void SetRumbleBit(OutputReport& report, bool on);

}  // namespace footing::reports
