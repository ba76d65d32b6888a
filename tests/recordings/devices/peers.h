#pragma once

#include <functional>
#include <span>
#include <vector>

#include "common/virtual/devices/wiimote.h"
#include "daemon/sensor/devices/source.h"

/// Device models in motion, for captures.
namespace footing::recordings {

using virtual_devices::Report;

/// A device model at the other end of the link.
struct Peer {
  devices::DeviceIdentity identity;
  std::function<std::vector<Report>(double t_s, std::span<const std::uint8_t>)> answer;
  std::function<std::vector<Report>(double t_s)> sample;
  /// The answer to a request for a feature report; a device without them leaves it empty.
  std::function<Report(std::uint8_t id, std::size_t size)> feature = nullptr;
};

/// Swung forwards and backwards at 2 Hz, A and up pressed for 0.1 s each 0.5 s.
Peer MakePlainWiimote();
/// Its camera sees two points that move to and fro, after 1.2 s one.
Peer MakeCamera();
/// Swung, turned past the slow range of a MotionPlus, a Nunchuk's stick in circles. `accessory` is
/// in the port and is pulled at `pulled_at_s`, unless that is 0.
Peer MakeExtended(virtual_devices::Accessory accessory, const virtual_devices::Wiimote& fresh,
                  double pulled_at_s = 0);
Peer MakeMove(std::uint64_t seed, virtual_devices::MoveModel which);
/// Empty for 0.8 s, then 60 kg that lean to the left and back; warmer than at its calibration.
Peer MakeBoard();

}  // namespace footing::recordings
