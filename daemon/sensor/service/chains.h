#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "common/board/geometry.h"
#include "common/stream/device.h"
#include "common/stream/sensor.h"
#include "daemon/sensor/features/kalman_filter.h"
#include "daemon/sensor/mounting/mounting.h"
#include "daemon/sensor/mounting/tare.h"
#include "daemon/sensor/reports/wiimote_calibration.h"

namespace footing::sensor {

/// The newest 60 s of a device's samples, oldest first; bounded against a device that floods.
template <typename Sample>
class Recent {
 public:
  static constexpr std::int64_t kSpanNs = 60'000'000'000;
  static constexpr std::size_t kCapacity = 16'384;  // 60 s of 200 samples a second, and some.

  void Add(const Sample& sample) {
    samples_.push_back(sample);
    while (samples_.size() > kCapacity ||
           sample.received_ns - samples_.front().received_ns > kSpanNs) {
      samples_.pop_front();
    }
  }
  void Clear() { samples_.clear(); }

  const std::deque<Sample>& samples() const { return samples_; }

 private:
  std::deque<Sample> samples_;
};

/// One board's forces from the measured ones to the published ones: tare, centre of pressure, and
/// whether it was moved since it was tared. A plain value.
class BoardChain {
 public:
  explicit BoardChain(const board::PlateConfig& config = {}) : config_(config), plate_(config) {}

  /// A new uninterrupted stream begins; the tare stays.
  void Restart();
  /// None: forces are published as measured. The watch for displacement restarts.
  void SetTare(const std::optional<board::CornerForces>& tare);
  /// Forgets displacement so far: it was on purpose.
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

/// A device's motion samples from the measured ones to the published ones: the filtered
/// acceleration beside the raw one, and the gyroscope's bias subtracted. A plain value.
class MotionChain {
 public:
  /// Fills in what is filtered; `measured`: not a repeat with other buttons.
  void Take(stream::MotionSample& sample, bool measured);

 private:
  signal::KalmanFilter filter_;
  calibration::GyroscopeBias gyroscope_bias_;
  Eigen::Vector3d filtered_mps2_ = Eigen::Vector3d::Zero();
};

/// Times of the mounting procedure's parts: standing still, then steps.
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
