#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/rig/follower.h"
#include "common/stream/device.h"
#include "common/stream/hands.h"
#include "common/stream/sensor.h"
#include "common/stream/setup.h"

/// The guided set-up and acceptance of a rig: what is asked of the person, and what the sensors
/// say. Everything is a plain value; the time is footingd's (host_ns of its ticks).
namespace footing::guide {

/// Load on a board during a stretch of time.
struct Load {
  int samples = 0;
  double mean_n = 0;
  double sd_n = 0;
  bool cop_valid = false;  ///< In every sample that counts.
  double cop_x_m = 0;      ///< Mean, plate frame P.
  double cop_y_m = 0;
  double cop_sd_m = 0;  ///< Standard deviation of both axes together.
};

/// How much a hand device moved during a stretch of time.
struct Motion {
  int samples = 0;
  double mean_mps2 = 0;   ///< Mean magnitude of the specific force.
  double shake_mps2 = 0;  ///< Root mean square distance of the specific force from its mean.
};

/// Statistics of the samples of a stretch.
Load LoadOf(const std::vector<stream::BoardSample>& samples);
Motion MotionOf(const std::vector<stream::MotionSample>& samples);

/// The newest 30 s of the stream.
class Recent {
 public:
  void Take(const rig::Tick& tick);
  void SetDevices(std::vector<stream::DeviceStatus> devices) { devices_ = std::move(devices); }
  void Add(const stream::MotionSample& sample);
  void Add(const stream::BoardSample& sample);
  void Add(const stream::HandSample& sample);

  const std::vector<stream::DeviceStatus>& devices() const { return devices_; }
  /// Attached devices of a rig: boards, or those mounted or held. In the order of their roles.
  std::vector<stream::DeviceStatus> Boards(const std::string& rig) const;
  std::vector<stream::DeviceStatus> BodyDevices(const std::string& rig) const;
  std::optional<stream::DeviceStatus> Holding(const std::string& rig,
                                              stream::DeviceRole role) const;

  /// Received in [from, to); none when the stretch is not covered by samples up to a tenth of it.
  Load BoardLoad(std::uint32_t device, std::int64_t from_ns, std::int64_t to_ns) const;
  Motion DeviceMotion(std::uint32_t device, std::int64_t from_ns, std::int64_t to_ns) const;
  /// Mean specific force, sensor frame S; nothing when the stretch is not covered.
  std::optional<Eigen::Vector3d> MeanForce(std::uint32_t device, std::int64_t from_ns,
                                           std::int64_t to_ns) const;
  /// Samples of trackers, received in [from, to), seen or not.
  std::vector<stream::HandSample> Hands(const std::string& rig, stream::DeviceRole role,
                                        std::int64_t from_ns, std::int64_t to_ns) const;

 private:
  std::vector<stream::DeviceStatus> devices_;
  std::map<std::uint32_t, std::vector<stream::MotionSample>> motion_;
  std::map<std::uint32_t, std::vector<stream::BoardSample>> boards_;
  std::vector<stream::HandSample> hands_;
};

/// The boards from above, drawn for a terminal; empty when there is no preset of that name.
std::string LayoutPicture(const std::string& preset);

/// Loads while the person did as asked. A board that is not there has no samples.
struct Stance {
  Load left;  ///< Load of the board that has the role left_board.
  Load right;
};

/// Loads in the poses of the layout check.
struct LayoutObserved {
  std::optional<Stance> left_alone;  ///< Both are needed to find swapped boards.
  std::optional<Stance> right_alone;
  Stance upright;
  Stance forward;
};

enum class LayoutFault { kNone, kNoContact, kSwapped, kLeftTurned, kRightTurned, kBothTurned };

/// Result of the layout check.
struct LayoutVerdict {
  LayoutFault fault = LayoutFault::kNone;
  bool degraded = false;
  double residual_mm = 0;  ///< Sideways movement of the COP while leaning forward: 0 is ideal.
  double rest_n = 0;       ///< Largest force on a board that should have been free.
  std::string note;        ///< Fault and remedy, or the figures.

  bool passed() const { return fault == LayoutFault::kNone; }
};

/// Leaning forward must move each board's COP forward in W; standing left must load the left one.
LayoutVerdict CheckLayout(const stream::BoardLayout& layout, const LayoutObserved& observed);

inline constexpr double kLeastLeanM = 0.015;  ///< Less movement than this does not count as a lean.

}  // namespace footing::guide
