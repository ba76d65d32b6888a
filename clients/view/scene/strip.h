#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <utility>

#include "clients/view/scene/update.h"

namespace footing::scene {

/// How much of the past the sliding strips show.
inline constexpr std::int64_t kStripNs = 10'000'000'000;
/// An older value is no longer the present one.
inline constexpr std::int64_t kCurrentNs = 500'000'000;

/// The instant up to which sliding curves are drawn: now, but where nothing has come since
/// `newest_ns` for longer than kCurrentNs they stand still, as the scene does.
std::int64_t ShownTime(std::int64_t newest_ns, std::int64_t now_ns);

/// One curve over the last 10 s.
class Strip {
 public:
  struct Point {
    std::int64_t time_ns = 0;  ///< On the viewer's own clock.
    float value = 0;
    bool joined = true;  ///< A line leads here from the point before.
  };

  /// A value that is not finite is left out. Points come in the order of time.
  void Add(std::int64_t time_ns, double value);
  /// The value is unknown at `time_ns`: the next point starts a new line.
  void Break(std::int64_t time_ns);
  const std::deque<Point>& points() const { return points_; }

 private:
  void DropBefore(std::int64_t time_ns);

  std::deque<Point> points_;
  bool broken_ = true;
};

/// The curves of one controller.
struct DeviceStrips {
  stream::DeviceRole role = stream::DeviceRole::kUnspecified;
  bool simulated = false;
  Strip magnitude_mps2;  ///< Of the raw specific force.
  Strip filtered_x_mps2, filtered_y_mps2, filtered_z_mps2;
  Strip moving;  ///< 0 or 1.
  Strip frequency_hz;
  Strip amplitude_mps2;
  Strip roll_rad, pitch_rad;
};

/// All curves; at most 16 devices and 8 rigs.
struct StripSet {
  std::map<std::pair<int, std::uint32_t>, DeviceStrips> devices;  ///< By {source, device}.
  std::map<std::string, Strip> phases_rad;                        ///< By rig.
  std::int64_t newest_ns = 0;                                     ///< When the last values came.

  void Add(const Update& update);
};

}  // namespace footing::scene
