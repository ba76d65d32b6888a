#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "common/stream/device.h"
#include "common/stream/sensor.h"
#include "daemon/sensor/mounting/mounting.h"
#include "daemon/sensor/mounting/slip.h"
#include "daemon/sensor/service/recent.h"

namespace footing::sensor {

struct MountingStretches {
  std::int64_t still_from_ns = 0;
  std::int64_t still_to_ns = 0;
  std::int64_t steps_from_ns = 0;
  std::int64_t steps_to_ns = 0;
};

/// How a device sits on its wearer: from samples as measured (frame S) to those of a perfect
/// mounting (frame M), and whether it has slipped since. A plain value.
class MountedSensor {
 public:
  /// None: S is taken for M, as of a device held in the hand.
  void SetMounting(const std::optional<Eigen::Quaterniond>& rotation_MS, stream::DeviceRole role);
  const std::optional<Eigen::Quaterniond>& rotation_MS() const { return rotation_MS_; }
  bool slipped() const { return slip_.slipped(); }

  /// The sample in M.
  stream::MotionSample Take(const stream::MotionSample& sample_S);
  /// A new uninterrupted stream begins; the mounting stays.
  void Restart() { recent_.Clear(); }
  /// From the newest 60 s.
  mounting::Mounting Solve(stream::DeviceRole role, const MountingStretches& stretches) const;

 private:
  std::optional<Eigen::Quaterniond> rotation_MS_;
  mounting::SlipWatch slip_{stream::DeviceRole::kUnspecified};
  Recent<stream::MotionSample> recent_;
};

}  // namespace footing::sensor
