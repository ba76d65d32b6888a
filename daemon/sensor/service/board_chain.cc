#include "daemon/sensor/service/board_chain.h"

namespace footing::sensor {
namespace {

template <typename Sample>
void FillForces(const board::CornerForces& forces, Sample& sample) {
  sample.top_left_n = forces.top_left_n;
  sample.top_right_n = forces.top_right_n;
  sample.bottom_left_n = forces.bottom_left_n;
  sample.bottom_right_n = forces.bottom_right_n;
}

template <typename Sample>
void FillCop(const board::PlateReading& reading, Sample& sample) {
  sample.total_n = reading.total_n;
  sample.cop_valid = reading.cop_valid;
  sample.cop_x_m = reading.cop_x_m;
  sample.cop_y_m = reading.cop_y_m;
}

}  // namespace

BoardChain::BoardChain(const BoardOptions& options)
    : options_(options), plate_(options.plate), uniform_(options.uniform) {}

void BoardChain::Restart() {
  plate_ = board::Plate(options_.plate);
  uniform_ = board::UniformStream(options_.uniform);
  displacement_ = board::Displacement();
  recent_.Clear();
}

void BoardChain::SetTare(const std::optional<board::CornerForces>& tare) {
  if (tare == tare_) return;
  tare_ = tare;
  uniform_ = board::UniformStream(options_.uniform);  // No window mixes two zeros.
  WatchAnew();
}

void BoardChain::Take(const board::CornerForces& measured, stream::BoardSample& sample) {
  recent_.Add({sample.received_ns, {sample.sampled_ns, measured}});
  const board::CornerForces forces = tare_ ? measured - *tare_ : measured;
  const board::PlateReading reading = plate_.Advance(forces);
  FillForces(forces, sample);
  FillCop(reading, sample);
  sample.contact = reading.contact;
  sample.repeated = reading.repeated;
  sample.tared = tared();
  uniform_.Add(sample.sampled_ns, forces);
  if (tare_) displacement_.Advance(sample.sampled_ns, forces);
}

std::optional<stream::UniformBoardSample> BoardChain::NextUniform(std::int64_t now_ns) {
  const auto reading = uniform_.Next(now_ns);
  if (!reading) return std::nullopt;
  stream::UniformBoardSample sample;
  sample.sampled_ns = reading->sampled_ns;
  FillForces(reading->forces, sample);
  FillCop(board::Plate(options_.plate).Advance(reading->forces), sample);
  sample.samples = reading->samples;
  sample.gap = reading->gap;
  sample.cop_valid = sample.cop_valid && !sample.gap;
  if (!sample.cop_valid) sample.cop_x_m = sample.cop_y_m = 0;
  return sample;
}

board::Tare BoardChain::SolveTare(std::int64_t now_ns, double window_s) const {
  const std::int64_t from_ns = now_ns - static_cast<std::int64_t>(window_s * 1e9);
  std::vector<board::TareSample> samples;
  for (const Measured& measured : recent_.samples()) {
    if (measured.received_ns > from_ns) samples.push_back(measured.sample);
  }
  return board::SolveTare(samples, window_s);
}

}  // namespace footing::sensor
