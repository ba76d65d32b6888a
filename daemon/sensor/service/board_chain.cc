#include "daemon/sensor/service/board_chain.h"

#include "common/base/units.h"

namespace footing::sensor {

void BoardChain::Restart() {
  plate_ = board::Plate(config_);
  displacement_ = tare::Displacement();
  recent_.Clear();
}

void BoardChain::SetTare(const std::optional<board::CornerForces>& tare) {
  if (tare == tare_) return;
  tare_ = tare;
  RestartWatch();
}

void BoardChain::Take(const board::CornerForces& measured, stream::BoardSample& sample) {
  recent_.Add({sample.received_ns, {sample.sampled_ns, measured}});
  const board::CornerForces forces = tare_ ? measured - *tare_ : measured;
  const board::PlateReading reading = plate_.Advance(forces);
  sample.top_left_n = forces.top_left_n;
  sample.top_right_n = forces.top_right_n;
  sample.bottom_left_n = forces.bottom_left_n;
  sample.bottom_right_n = forces.bottom_right_n;
  sample.total_n = reading.total_n;
  sample.cop_valid = reading.cop_valid;
  sample.cop_x_m = reading.cop_x_m;
  sample.cop_y_m = reading.cop_y_m;
  sample.contact = reading.contact;
  sample.repeated = reading.repeated;
  sample.tared = tared();
  if (tare_) displacement_.Advance(sample.sampled_ns, forces);
}

tare::Tare BoardChain::SolveTare(std::int64_t now_ns, double window_s) const {
  const std::int64_t from_ns = now_ns - SecondsToNanoseconds(window_s);
  std::vector<tare::TareSample> samples;
  for (const Measured& measured : recent_.samples()) {
    if (measured.received_ns > from_ns) samples.push_back(measured.sample);
  }
  return tare::SolveTare(samples, window_s);
}

}  // namespace footing::sensor
