#pragma once

#include <cstdint>

namespace footing::handshake {

/// Whether a remote's infrared camera is wanted, and in which format it was set up.
struct CameraSwitch {
  bool wanted = false;
  bool changed = false;     ///< Wanted otherwise than before, not yet applied.
  std::uint8_t format = 0;  ///< As it was set up; 0: off.

  void Want(bool on) {
    changed = changed || on != wanted;
    wanted = on;
  }
  bool NeedsSetUp(std::uint8_t wanted_format) const { return wanted && format != wanted_format; }
};

}  // namespace footing::handshake
