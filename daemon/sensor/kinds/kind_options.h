#pragma once

#include <cstdint>
#include <string>

#include "common/base/units.h"
#include "daemon/sensor/reports/sequencer.h"

namespace footing::decode {

struct KindOptions {
  double local_gravity_mps2 = kStandardGravityMps2;  ///< Where boards stand.
  handshake::HandshakeConfig handshake;
};

/// How a device presents itself.
struct Product {
  std::uint32_t vendor = 0;
  std::uint32_t product = 0;
  std::string name;
};

/// Where a kind of device is used, which decides the roles it can have.
enum class Placement {
  kOnBody,       ///< Worn or held: hands, legs, head.
  kUnderFeet,    ///< A board.
  kInBothHands,  ///< A gamepad: says nothing about the body.
};

/// Typical intervals of a kind, before they are estimated.
struct Timing {
  double report_period_s = 0.01;
  double sensor_period_s = 0.01;
};

struct FeatureRequest {
  std::uint8_t id = 0;
  std::size_t size = 0;  ///< The id byte included.
};

}  // namespace footing::decode
