#pragma once

#include <cstdint>
#include <string>

#include "footing/v1/device.pb.h"

namespace footing::recording {

/// How a recorded device presented itself to its host.
struct RecordedIdentity {
  std::uint32_t bus = 0;  ///< As in the kernel's input.h.
  std::uint32_t vendor = 0;
  std::uint32_t product = 0;
  std::string name;
  std::string serial;
};

/// As the status says; recordings of before 2026-11 say no bus, vendor and product: what devices of
/// its kind and name have then.
RecordedIdentity IdentityOf(const v1::DeviceStatus& status);

/// A feature report. Recordings of before 2026-11 do not flag those of a PS Move, which have ids of
/// their own.
bool IsFeature(const v1::RawReport& report, const v1::DeviceStatus& status);

}  // namespace footing::recording
