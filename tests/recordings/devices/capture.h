#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "common/base/result.h"
#include "daemon/sensor/devices/source.h"

namespace footing::recordings {

/// One report that went between footingd and a device.
struct CapturedReport {
  std::int64_t at_ns = 0;  ///< Since the device was attached.
  bool to_device = false;
  bool feature = false;  ///< From the device: the answer to a feature request.
  std::vector<std::uint8_t> bytes;
};

/// A device's life on its link as a text file: a header, then a line a report.
///
///   # Device: Nintendo RVL-CNT-01           name, as the device gives it
///   # Identity: 057e:0306 bluetooth         vendor, product, bus (bluetooth or usb)
///   # Firmware: ...
///   # Motion: ...                           what was done with it
///   # Date: 2026-11-21
///   # Made: ...                             by whom, how, with which seed
///   # Camera: on                            only when footingd was told so
///   0.000 > 1500                            milliseconds, to the device, bytes in hex
///   10.000 < 20000002000060                 from the device
///   20.000 <f 1000...                       from the device, a feature report
struct Capture {
  std::vector<std::pair<std::string, std::string>> header;  ///< In the file's order.
  std::vector<CapturedReport> reports;                      ///< Times never go back.

  std::string Header(const std::string& key) const;  ///< Empty when there is none.
};

/// Errors name file and line.
Result<Capture> ReadCapture(const std::filesystem::path& path);
std::string Print(const Capture& capture);

/// Identity that the hub gets at its attachment.
Result<devices::DeviceIdentity> IdentityOf(const Capture& capture);

}  // namespace footing::recordings
