#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/board/geometry.h"
#include "common/stream/gait.h"
#include "common/stream/user_interface.h"
#include "common/virtual/devices/accelerometer.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/people/style.h"
#include "daemon/offline/analysis/features_chain.h"
#include "daemon/offline/eval/gait.h"
#include "daemon/offline/eval/gait_trial.h"
#include "daemon/offline/eval/held_devices.h"
#include "daemon/simulation/engine/engine.h"
#include "daemon/simulation/mapping/inputs.h"

namespace footing::eval {

/// How the commanded gait follows the one that the user's motion means.
class Agreement {
 public:
  using Table = std::array<std::array<std::uint64_t, stream::kGaits.size()>, stream::kGaits.size()>;

  /// One moment. The command agrees when it is what the motion has meant at some time within
  /// `delay_s`, or a command of the past that still stands.
  void Add(double time_s, stream::Gait meant, stream::Gait commanded, double delay_s,
           bool still_stands);
  /// Begins again, without what was meant before.
  void Restart() { meant_.clear(); }
  void Pool(const Agreement& other);

  std::uint64_t count() const { return count_; }
  double share() const {
    return count_ > 0 ? static_cast<double>(agree_) / static_cast<double>(count_) : 1;
  }
  /// Moments by the gait meant (row), once it has been meant for the delay, and the gait commanded.
  const Table& table() const { return table_; }

 private:
  struct Meant {
    double time_s = 0;  ///< From then on.
    stream::Gait gait = stream::Gait::kStep;
  };
  std::deque<Meant> meant_;
  std::uint64_t count_ = 0, agree_ = 0;
  Table table_{};
};

/// Mean and spread of a time.
struct Delay {
  std::uint64_t count = 0;
  double sum_s = 0, sum_s2 = 0;

  void Add(double time_s);
  void Pool(const Delay& other);
  double mean_s() const { return count > 0 ? sum_s / static_cast<double>(count) : 0; }
  double sd_s() const;
};

/// Where the time of a jump goes: from the begin of the user's gesture to the command, which is the
/// interface's part, and from the command until the character leaves the ground, which is the
/// gait's. It is the spread of both, not their mean, that a user cannot learn.
class JumpDelays {
 public:
  /// One moment, every few milliseconds: whether the user means, the interface commands and the
  /// character does a jump. A gesture without a command within `delay_s` of its end does not count,
  /// nor does a command that ends without a jump.
  void Add(double time_s, bool meant, bool commanded, bool jumps, double delay_s);
  /// The character fell: what was under way does not count.
  void Restart();
  void Pool(const JumpDelays& other);

  const Delay& to_command() const { return to_command_; }
  const Delay& to_take_off() const { return to_take_off_; }  ///< From the command.

 private:
  bool meant_ = false, commanded_ = false;  ///< Flags of the last moment.
  double meant_s_ = 0;                      ///< When a jump was last meant.
  std::optional<double> begun_s_;           ///< Start of a gesture without a command yet.
  std::optional<double> commanded_s_;  ///< Time of its command, while the character does not jump.
  Delay to_command_, to_take_off_;
};

/// Which of a user's gestures of a jump became a command, and which commanded jumps nobody meant.
/// The share of time that Agreement counts does not show them: a gesture may be shorter than the
/// delay that a command is allowed.
class JumpEvents {
 public:
  /// One moment, every few milliseconds. A gesture is recognised when a jump is commanded while it
  /// lasts or within `delay_s` of its end, and late when that is longer than `delay_s` after its
  /// begin. A command was meant when it begins at most that long after a moment of a gesture.
  void Add(double time_s, bool meant, bool commanded, double delay_s);
  /// The character fell: a gesture that had no command yet does not count, unless the delay was
  /// over.
  void Restart();
  void Pool(const JumpEvents& other);

  std::uint64_t meant() const { return meant_count_; }
  std::uint64_t recognised() const { return recognised_; }
  std::uint64_t late() const { return late_; }  ///< Those of recognised() that came late.
  std::uint64_t commanded() const { return commanded_count_; }
  std::uint64_t not_meant() const { return not_meant_; }
  /// Share of meant(); 1 of none.
  double recall() const {
    return meant_count_ > 0 ? static_cast<double>(recognised_) / static_cast<double>(meant_count_)
                            : 1;
  }

 private:
  void Decide(bool recognised, bool late);

  bool meant_ = false, commanded_ = false;  ///< Flags of the last moment.
  std::optional<double> begun_s_;           ///< Start of a gesture that is not decided yet.
  std::optional<double> meant_s_;           ///< When a jump was last meant.
  bool overdue_ = false;                    ///< The delay of that gesture is over.
  std::uint64_t meant_count_ = 0, recognised_ = 0, late_ = 0;
  std::uint64_t commanded_count_ = 0, not_meant_ = 0;
};

/// A CSV of what a trial's user meant, what the interface made of it and what the character did:
/// one row per look of the user (10 ms), a row of units under the names.
class TrackTrace {
 public:
  /// Nothing is written to an empty path. Fails when the file cannot be created.
  static Result<TrackTrace> Create(const std::string& path);

  /// The rows that follow are of this trial.
  void Begin(std::uint64_t seed) { seed_ = seed; }
  void Add(stream::Gait wanted, stream::Gait meant, double turn_rad,
           const engine::EngineOutput& output);
  /// Whether all rows so far are in the file: fails where the disk is full.
  Result<void> Flush();

 private:
  Error CannotWrite() const;

  std::string path_;
  int error_ = 0;  ///< errno of the first row that could not be written.
  std::ofstream file_;
  std::uint64_t seed_ = 0;
};

/// Who runs a trial, and with what.
struct TrackUser {
  /// None: the user's intention reaches the engine as a command, at once. Else by body, sensors,
  /// footingd's features and the interface.
  std::optional<stream::UserInterface> interface = {};
  /// How the remotes are rotated in the hands; none: as the user's style has it.
  std::optional<users::GripWish> grip = {};
  users::StyleWish style = {};
  HeldKind devices = HeldKind::kWiimote;                   ///< Not with boards.
  std::string mapping_table = {};                          ///< Path; empty: the built-in one.
  stream::TurnSource turn_by = stream::TurnSource::kHead;  ///< Used by the leg interface.
  std::uint64_t seed = 1;  ///< Seed of the user's style and noise, the task and the push.
  /// Begins in mid-run: nobody has seen the limbs at rest. Else stands before the start line.
  bool starts_running = false;
  /// Ends after this time at the latest; without it a trial ends at the finish line.
  std::optional<double> seconds = {};
};

/// Measures of one run along a track.
struct TrackResult {
  bool completed = false;  ///< Crossed the finish line.
  double time_s = 0;       ///< From the start line to there.
  double distance_m = 0;   ///< Along its way.
  double off_track_s = 0;  ///< Beside the track, but for falls.
  std::string task;        ///< The one that was drawn; empty: none.
  stream::FailureCounts failures;
  Agreement agreement;           ///< Motion and command compared, but for falls; no direct user.
  JumpEvents jumps;              ///< The same, gesture by gesture.
  JumpDelays jump_delays;        ///< Where their time goes.
  RootMeanSquare heading_error;  ///< Body's yaw against the heading, rad, but for falls.
  RootMeanSquare line_heading;   ///< Body's yaw against the centre line, rad, but for falls.
  RootMeanSquare off_centre;     ///< COM's distance from the centre line, m.
};

/// One trial on a track, put back after each failure, kicked once by 2 N s. UsageError when the
/// track has no finish line and the user no `seconds`.
Result<TrackResult> RunTrack(const std::string& track, const TrackUser& user, TrackTrace& trace);

/// The devices of a synthetic user and footingd's chain behind them: what the sensors make of what
/// they feel, then features, stick, or corner forces and COP. Of the kinds that the user has.
/// Joy-Cons and phones go through their protocol and footingd's hub (HeldDevices).
class UserDevices {
 public:
  static constexpr double kTickS = 0.01;

  /// `turn_by` is of the leg interface; `at_rest` is what Joy-Cons and phones feel until they are
  /// live.
  UserDevices(stream::UserInterface interface, stream::TurnSource turn_by, std::uint64_t seed,
              HeldKind kind = HeldKind::kWiimote, const users::Felt& at_rest = {});

  /// Half a tick before Take.
  void Feel(const users::Felt& felt);
  /// The inputs of the next tick.
  mapping::Inputs Take(const users::Felt& felt);

 private:
  void TakeRemotes(const users::Felt& felt);
  void TakePublished(const users::Felt& felt);
  void TakeFeatures(const stream::RigFeatures& features);
  void TakeStick(const users::Felt& felt);
  void TakeBoards(const users::Felt& felt);

  stream::UserInterface interface_;
  noise::Random random_;
  wrists::SensorModel sensor_;
  Chain chain_;
  std::unique_ptr<HeldDevices> held_;  ///< Null: Wiimotes or boards.
  std::vector<virtual_sensors::CellErrors> cells_;
  std::array<board::Plate, 2> plates_;
  std::int64_t ticks_ = 0;
  double board_due_s_ = 0;
  mapping::Inputs inputs_;
};

}  // namespace footing::eval
