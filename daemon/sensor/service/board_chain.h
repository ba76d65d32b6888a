#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/board/plate.h"
#include "common/stream/sensor.h"
#include "daemon/sensor/service/recent.h"
#include "daemon/sensor/mounting/displacement.h"
#include "daemon/sensor/mounting/tare.h"

namespace footing::sensor {

/// One board's forces from the measured ones to the published ones: tare, centre of pressure, and
/// whether it was moved since it was tared. A plain value.
class BoardChain {
 public:
  explicit BoardChain(const board::PlateConfig& config = {}) : config_(config), plate_(config) {}

  /// A new uninterrupted stream begins; the tare stays.
  void Restart();
  /// None: forces are published as measured. The watch for displacement restarts.
  void SetTare(const std::optional<board::CornerForces>& tare);
  /// What has moved so far was on purpose.
  void RestartWatch() { displacement_ = tare::Displacement(); }

  /// Fills in forces, total, COP, contact, repeated and tared; device, stamps and flags are there
  /// already.
  void Take(const board::CornerForces& measured, stream::BoardSample& sample);
  /// From the newest `window_s` before `now_ns`, as measured.
  tare::Tare SolveTare(std::int64_t now_ns, double window_s) const;

  bool tared() const { return tare_.has_value(); }
  bool moved() const { return displacement_.moved(); }

 private:
  struct Measured {
    std::int64_t received_ns = 0;
    tare::TareSample sample;
  };

  board::PlateConfig config_;
  std::optional<board::CornerForces> tare_;
  board::Plate plate_;
  tare::Displacement displacement_;
  Recent<Measured> recent_;
};

}  // namespace footing::sensor
