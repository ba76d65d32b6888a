#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/stream/sensor.h"
#include "daemon/sensor/board/displacement.h"
#include "daemon/sensor/board/plate.h"
#include "daemon/sensor/board/tare.h"
#include "daemon/sensor/board/uniform_stream.h"
#include "daemon/sensor/service/recent.h"

namespace footing::sensor {

struct BoardOptions {
  board::PlateConfig plate;
  board::UniformConfig uniform;
};

/// One board's forces from the measured ones to the published ones: tare, centre of pressure, the
/// uniform stream, and whether it was moved since it was tared. A plain value.
class BoardChain {
 public:
  explicit BoardChain(const BoardOptions& options = {});

  /// A new uninterrupted stream begins; the tare stays.
  void Restart();
  /// None: forces are published as measured. The watch for displacement begins anew.
  void SetTare(const std::optional<board::CornerForces>& tare);
  /// What has moved so far was on purpose.
  void WatchAnew() { displacement_ = board::Displacement(); }

  /// Fills in forces, total, COP, contact, repeated and tared; device, stamps and flags are there
  /// already.
  void Take(const board::CornerForces& measured, stream::BoardSample& sample);
  /// The next sample of the uniform rate, if it is complete at `now_ns`.
  std::optional<stream::UniformBoardSample> NextUniform(std::int64_t now_ns);
  /// From the newest `window_s` before `now_ns`, as measured.
  board::Tare SolveTare(std::int64_t now_ns, double window_s) const;

  bool tared() const { return tare_.has_value(); }
  bool moved() const { return displacement_.moved(); }

 private:
  struct Measured {
    std::int64_t received_ns = 0;
    board::TareSample sample;
  };

  BoardOptions options_;
  std::optional<board::CornerForces> tare_;
  board::Plate plate_;
  board::UniformStream uniform_;
  board::Displacement displacement_;
  Recent<Measured> recent_;
};

}  // namespace footing::sensor
