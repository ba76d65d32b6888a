#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "daemon/sensor/board/plate.h"

namespace footing::board {

struct UniformConfig {
  double rate_hz = 100;
  /// Whole width of the averaging window. 50 ms hold three new samples of a 60 Hz board, pass 98 %
  /// of a 2 Hz sway and 90 % at 5 Hz.
  double window_s = 0.05;
  /// A window waits so long after its end for a newer sample to close it.
  double patience_s = 0.1;
  /// Without any sample for so long the stream ends; it begins anew with the next one.
  double longest_gap_s = 2;
};

struct UniformReading {
  std::int64_t sampled_ns = 0;
  CornerForces forces;
  std::uint32_t samples = 0;  ///< Raw ones in the window.
  bool gap = false;           ///< None there: the forces before are held and not valid.
};

/// A board's forces at an even rate, by SWARII (sliding window average with relevance interval
/// interpolation; Audiffren & Contal 2016, Sensors 16:1208).
///
/// | paper | here |
/// |---|---|
/// | s | an instant n / rate of the host's clock, so the rate is exact and never drifts |
/// | Delta, half the window | window_s / 2 |
/// | relevance interval of t_i | what of the window is nearer to t_i than to its neighbours in it |
/// | f(s) | sum of value times interval, over window_s |
///
/// The paper prints the intervals of the first and the last sample as instants less a half
/// difference, which are no lengths; here they reach to the ends of the window, as in the authors'
/// program. Latency: half a window, until the first newer sample arrives (or the patience ends).
/// A plain value.
class UniformStream {
 public:
  explicit UniformStream(const UniformConfig& config = {}) : config_(config) {}

  /// A sample at its sampled_ns; one not newer than the last is ignored.
  void Add(std::int64_t sampled_ns, const CornerForces& forces);
  /// The next reading that is due at `now_ns`, oldest first; call until there is none.
  std::optional<UniformReading> Next(std::int64_t now_ns);

 private:
  struct Sample {
    std::int64_t sampled_ns = 0;
    CornerForces forces;
  };
  std::int64_t InstantNs(std::int64_t n) const;
  UniformReading Average(std::int64_t at_ns);

  UniformConfig config_;
  std::deque<Sample> samples_;
  bool running_ = false;
  std::int64_t next_ = 0;     ///< Number of the next instant.
  std::int64_t last_ns_ = 0;  ///< Of the newest sample.
  CornerForces held_;
};

}  // namespace footing::board
