#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/posturography/standing.h"
#include "common/posturography/sway.h"
#include "common/stream/device.h"
#include "common/stream/sensor.h"
#include "common/stream/setup.h"

/// Guided quiet standing: trials, when they begin and end, and what they measure. Times are those
/// of footingd's clock, so a recording gives the figures of the live session.
namespace footing::sway {

/// How the subject stands, by the words of the command line.
struct Condition {
  std::string eyes;     ///< open or closed.
  std::string surface;  ///< firm or foam.
  std::string feet;     ///< together, shoulder, tandem, left_leg or right_leg.

  bool operator==(const Condition&) const = default;
};
inline const std::vector<std::string> kEyes{"open", "closed"};
inline const std::vector<std::string> kSurfaces{"firm", "foam"};
inline const std::vector<std::string> kFeet{"together", "shoulder", "tandem", "left_leg",
                                            "right_leg"};

/// "eyes closed, foam, feet together".
std::string Title(const Condition& condition);
/// Instruction for the subject, in one sentence.
std::string Instruction(const Condition& condition, std::size_t boards);

/// A board under the subject. Its pose is in W; that of a single board is {}, whatever the layout.
struct Board {
  std::string serial;
  stream::DeviceRole role = stream::DeviceRole::kUnspecified;
  stream::BoardPose pose;
  stream::BoardGeometry geometry;
};

/// "left board".
std::string Name(const Board& board);

/// One attempt at a trial.
struct Trial {
  Condition condition;
  int repeat = 1;   ///< Number within its condition, from 1.
  int attempt = 1;  ///< Number within this repeat, from 1.
  std::int64_t from_ns = 0;
  std::int64_t to_ns = 0;
  std::string rejected;  ///< Why it does not count; empty: it counts.

  // By MeasureTrial, where it counts.
  double weight_n = 0;
  std::optional<double> left_share;  ///< Share of the load on the left one of two boards.
  double recorded_rate_hz = 0;
  bool simulated = false;  ///< Any sample is.
  bool tared = true;       ///< All samples are.
  bool calibrated = true;  ///< All samples are.
  posturography::Gaps gaps;
  posturography::Stretches cop;
  std::optional<posturography::Sway> measures;
};

/// Samples of each board, in the order of the boards.
using Tracks = std::vector<std::vector<stream::BoardSample>>;

/// Measures the COP between from_ns and to_ns, by the samples' own times. Where the samples do not
/// suffice, `rejected` says why. Two boards are merged at the filter's rate, which must not be 0.
void MeasureTrial(const std::vector<Board>& boards, const Tracks& tracks,
                  const posturography::CopFilter& filter, Trial& trial);

/// One board at one time.
struct BoardNow {
  std::int64_t sampled_ns = 0;  ///< Time of its newest sample; 0: none yet.
  double load_n = 0;
};

/// Leads one attempt from the step onto the boards to its end. A plain value.
class TrialGuide {
 public:
  enum class Phase { kWaiting, kSettling, kMeasuring, kDone, kRejected };

  struct Settings {
    double settle_s = 5;  ///< Standing before the measurement: the subject settles.
    double seconds = 30;
    bool wait_for_start = false;  ///< Somebody starts it, not the step onto the boards.
  };

  TrialGuide(const Settings& settings, std::vector<Board> boards, const Condition& condition)
      : settings_(settings), boards_(std::move(boards)), condition_(condition) {}

  /// `now` has one entry a board; times must not decrease. `start`: somebody pressed Enter.
  void Advance(std::int64_t now_ns, std::span<const BoardNow> now, bool start);
  /// Ends the attempt, if it is under way; else it waits again.
  void Interrupt(const std::string& reason);

  Phase phase() const { return phase_; }
  std::int64_t from_ns() const { return from_ns_; }
  std::int64_t to_ns() const { return to_ns_; }
  const std::string& rejected() const { return rejected_; }
  /// Request of the operator or the subject.
  const std::string& prompt() const { return prompt_; }
  /// Seconds that the phase still takes; 0 while it waits.
  double left_s() const { return left_s_; }

 private:
  void Wait(std::span<const BoardNow> now, const std::string& lost, bool start,
            std::int64_t now_ns);
  void Settle(std::int64_t now_ns, std::span<const BoardNow> now, const std::string& lost);
  void Watch(std::int64_t now_ns, std::span<const BoardNow> now, const std::string& lost);
  std::string Disturbance(std::span<const BoardNow> now) const;

  Settings settings_;
  std::vector<Board> boards_;
  Condition condition_;
  Phase phase_ = Phase::kWaiting;
  std::int64_t from_ns_ = 0, to_ns_ = 0;
  double weight_n_ = 0;
  std::vector<bool> loaded_;  ///< The boards that the subject stands on.
  std::int64_t disturbed_ns_ = 0;
  double left_s_ = 0;
  std::string prompt_;
  std::string rejected_;
};

/// Mean and standard deviation (divisor n - 1; nothing for one trial) of a measure over the trials
/// of a condition that count and have it. Angles have neither.
struct Averaged {
  const char* key = "";
  std::size_t trials = 0;
  std::optional<double> mean;
  std::optional<double> sd;
};

/// The trials of one condition.
struct Summary {
  Condition condition;
  std::size_t trials = 0;  ///< That count.
  std::vector<Averaged> measures;
};
/// In the order of the first trials.
std::vector<Summary> Summaries(const std::vector<Trial>& trials);

/// Romberg ratio: mean with eyes closed over mean with eyes open, on one surface with one position
/// of the feet.
struct Romberg {
  std::string surface, feet;
  double path = 0;       ///< Also of the mean velocity: trials of a session have one length.
  double ellipse95 = 0;  ///< Areas of the prediction ellipse.
};
std::vector<Romberg> RombergRatios(const std::vector<Summary>& summaries);

}  // namespace footing::sway
