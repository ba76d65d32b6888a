#pragma once

#include <cstdint>
#include <optional>

#include "daemon/sensor/kinds/kind.h"
#include "daemon/sensor/reports/inertial_report.h"

namespace footing::inertial {

/// An inertial sensor that is not a HID device: a phone, a microcontroller, or a simulated one. It
/// sends its samples without being asked, with times of its own, already in SI units.
class InertialSensor : public kinds::Kind {
 public:
  static bool Matches(const decode::Product& product);

  stream::DeviceKind kind() const override { return stream::DeviceKind::kInertial; }
  decode::Placement placement() const override { return decode::Placement::kOnBody; }
  /// A phone measures at 60 Hz, and sends several samples at once.
  decode::Timing timing() const override { return {0.05, 1 / 60.0}; }
  bool live() const override { return true; }

  void Restart() override;
  std::optional<decode::Decoded> Take(std::int64_t received_ns, reports::Bytes report,
                                      kinds::Outputs& outputs) override;
  std::optional<reports::OutputReport> NextOutput(std::int64_t now_ns,
                                                  link::Outbox& outbox) override;
  reports::OutputReport MotorOff() const override;
  void AddTo(stream::DeviceStatus& status) const override;
  std::string Note(std::int64_t now_ns) const override;

 private:
  std::optional<reports::InertialSample> last_;
  std::optional<std::uint16_t> number_;
  reports::RangeEnd range_end_;
  std::uint64_t lost_ = 0;  ///< Reports by their numbers.
  double battery_fraction_ = -1;
  bool vibrates_ = false;
  std::int64_t sent_ns_ = 0;
};

}  // namespace footing::inertial
