#include "daemon/sensor/kinds/inertial.h"

#include "common/stream/product_ids.h"
#include "tests/fuzz/input.h"

/// A phone or a microcontroller that sends anything at any time: each step is a time (of 5 ms) and
/// a report. A report that begins with FF is given the id, the count and the length of a real one.
namespace footing::fuzz {
namespace {

constexpr std::int64_t kStepNs = 5'000'000;
constexpr std::size_t kHeadBytes = 15, kSampleBytes = 28;

std::vector<std::uint8_t> Shaped(Bytes report) {
  std::vector<std::uint8_t> bytes(report.begin(), report.end());
  if (bytes.empty() || bytes[0] != 0xff) return bytes;
  bytes.resize(std::max(bytes.size(), kHeadBytes));
  bytes[0] = reports::kInertialInput;
  bytes[14] = static_cast<std::uint8_t>(1 + bytes[14] % reports::kMostInertialSamples);
  bytes.resize(kHeadBytes + bytes[14] * kSampleBytes);
  return bytes;
}

void CheckSamples(const decode::Decoded& decoded) {
  Expect(decoded.own_times && !decoded.motion.empty());
  Expect(decoded.motion.size() <= reports::kMostInertialSamples);
  std::int64_t before_ns = decoded.motion.front().sampled_ns;
  for (const stream::MotionSample& sample : decoded.motion) {
    Expect(sample.sampled_ns >= before_ns);
    before_ns = sample.sampled_ns;
    Expect(sample.specific_force_mps2.norm() <= 1000);
    Expect(sample.angular_velocity_radps.norm() <= 200);
    Expect(sample.clipped_axes < 8);
  }
}

}  // namespace
}  // namespace footing::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace footing;
  fuzz::Input input(bytes, size);
  inertial::InertialSensor sensor;
  link::Outbox outbox(sensor.writing());
  std::int64_t now_ns = fuzz::kStepNs;
  while (!input.empty()) {
    const std::uint8_t step = input.Byte();
    now_ns += (step + 1) * fuzz::kStepNs;
    kinds::Outputs outputs;
    const auto decoded = sensor.Take(now_ns, fuzz::Shaped(input.String()), outputs);
    if (decoded) fuzz::CheckSamples(*decoded);
    outbox.SetRumble((step & 1) != 0);
    if (const auto output = sensor.NextOutput(now_ns, outbox)) fuzz::Expect(output->size() == 2);
    stream::DeviceStatus status;
    sensor.AddTo(status);
    fuzz::Expect(status.battery_fraction <= 1);
    fuzz::Expect(sensor.Note(now_ns).size() < 200);
    if (step == 0xff) sensor.Restart();
  }
  return 0;
}
