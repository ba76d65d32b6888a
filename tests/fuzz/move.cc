#include "daemon/sensor/reports/move_calibration.h"

#include <cmath>

#include "tests/fuzz/input.h"

/// A PS Move: model, feature reports that bring the calibration, then input reports.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace footing;
  using fuzz::Expect;
  fuzz::Input input(bytes, size);
  const std::uint8_t head = input.Byte();
  const auto model = (head & 1) != 0 ? reports::MoveModel::kZcm2 : reports::MoveModel::kZcm1;
  calibration::MoveBlob blob(model);
  for (int i = 0; i < (head >> 1 & 3); ++i) (void)blob.Take(input.String());
  Expect(!blob.complete() || !blob.bytes().empty());
  Expect(blob.bytes().empty() || blob.bytes().size() == calibration::MoveBlobBytes(model));
  const auto calibration = calibration::ParseMove(model, blob.bytes());
  Expect((calibration.origin == stream::CalibrationOrigin::kDefaults) !=
         calibration.problem.empty());
  (void)calibration::ParseMove(model, input.String());
  const std::uint32_t colour = head * 0x10101u;
  Expect(reports::MoveLights(colour, head).size() <= reports::kMaxReportBytes);
  while (!input.empty()) {
    const auto report = reports::DecodeMove(model, input.String());
    if (!report) continue;
    Expect(std::isfinite(reports::MoveTemperature(report->temperature)));
    const double battery = reports::MoveBatteryFraction(report->battery);
    Expect(battery == -1 || (battery >= 0 && battery <= 1));
    for (std::size_t half = 0; half < report->sample_count; ++half) {
      const auto reading = calibration::Calibrate(calibration, *report, half);
      Expect(reading.specific_force_S_mps2.allFinite());
      Expect(reading.angular_velocity_S_radps.allFinite());
      Expect(reading.trigger >= 0 && reading.trigger <= 1);
    }
    Expect(calibration::MagneticField(*report).allFinite());
  }
  return 0;
}
