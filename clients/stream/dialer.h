#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <boost/asio/io_context.hpp>

#include "clients/stream/plan.h"
#include "common/net/address.h"
#include "common/stream/track.h"
#include "common/stream/user_interface.h"
#include "common/virtual/devices/accelerometer.h"
#include "common/virtual/people/driver.h"
#include "common/virtual/people/person.h"
#include "common/virtual/people/style.h"
#include "footing/v1/session.pb.h"

namespace footing::stream_client {

/// Character as a person in front of the screen sees it, in W.
struct RunnerSight {
  Eigen::Vector2d p_W_m = Eigen::Vector2d::Zero();
  double heading_rad = 0;
  double speed_mps = 0;
};

/// Alternate swing of both hands.
struct RunnerSwing {
  double frequency_hz = 0;  ///< 0: at rest.
  double amplitude_mps2 = 0;
  double roll_rad = 0;  ///< Left side higher is positive: turn right.
};

/// A synthetic player of the wrist interface who runs along a track that grows: sees the character
/// and the track as they were a reaction time ago, reckons with the turns commanded since, steers
/// for the centre line by inclining both hands, runs where it is straight and walks where it bends.
class Runner {
 public:
  /// Draws the reaction time, 0.2 to 0.3 s, and the favourite speed of running.
  explicit Runner(std::uint64_t seed);

  void SeeTrack(const stream::Track& track);
  void See(double time_s, const RunnerSight& sight);
  /// Swing of the hands at that time, which never runs back; at rest until there is something to
  /// see.
  RunnerSwing Want(double time_s);

 private:
  /// The centre line, in even steps.
  struct Point {
    Eigen::Vector2d p_W_m;
    double heading_rad = 0;
  };
  struct Seen {
    double time_s = 0;
    RunnerSight sight;
  };
  struct Turned {
    double time_s = 0;
    int side = 0;  ///< 1 to the left.
  };

  RunnerSight Reckon(double time_s) const;
  std::size_t NearestTo(const Eigen::Vector2d& p_W_m) const;
  const Point& Ahead(std::size_t from, double ahead_m) const;
  double BendAhead(std::size_t from, double speed_mps) const;

  double reaction_s_;
  double favourite_mps_;
  std::vector<Point> line_;
  std::deque<Seen> seen_;
  std::deque<Turned> turned_;
  int side_ = 0;
  bool runs_ = false;
};

/// A Runner's two hands as their sensors feel them. Its clock is that of its devices.
class LiveRunner {
 public:
  explicit LiveRunner(std::uint64_t seed);

  /// Takes a tick of footing-sim with the character and its track.
  void See(const v1::Tick& tick);
  /// The hands at t_s since the motion began; a time before the last one gives the last ones.
  wrists::Hands At(double t_s);

 private:
  Runner runner_;
  wrists::HandMotion unit_;  ///< One cycle a second of 1 m/s2.
  RunnerSwing swing_;        ///< As it is now, on its way to what is wanted.
  double cycles_ = 0;
  double time_s_ = 0;
};

/// The two Wiimotes of a synthetic player, and who moves them.
struct RunnerPlan {
  Plan plan;
  std::shared_ptr<LiveRunner> runner;
};
/// Plans the two Wiimotes and the player.
Result<RunnerPlan> PlanRunner(const Common& common);

/// A synthetic user in real time: sees what footing-sim publishes of the character, its track and
/// its trial, and moves the devices of one interface. Its clock is that of its devices. Stands
/// still while it sees nothing.
class LiveUser {
 public:
  /// `turn_by` is what turns with the interface leg. A user with `acts` performs these again and
  /// again, whatever it sees.
  LiveUser(stream::UserInterface interface, stream::TurnSource turn_by, const users::Style& style,
           std::uint64_t seed, std::vector<users::Act> acts = {});

  void See(const v1::Tick& tick);
  /// Readings of the devices at t_s since the motion began; after a new connection that is 0 again.
  /// Each device asks at its own times, which may be somewhat before another's.
  const users::Felt& At(double t_s);

 private:
  struct Moment {
    double time_s = 0;
    users::Felt felt;
  };

  users::Intention Want();

  /// Time without a frame after which the user sees nothing.
  static constexpr double kBlindS = 0.5;
  static constexpr double kRecentS = 0.2;

  stream::Track track_;
  std::vector<users::Act> acts_;
  users::Driver driver_;
  users::Person person_;
  users::Observation seen_;
  users::Intention wanted_;
  bool decides_ = false;
  std::deque<Moment> recent_;
  double seen_s_ = -1e9;
  double time_s_ = 0;
  double before_s_ = 0;  ///< Duration of the connections before this one.
  double at_s_ = 0;
};

/// The devices of a synthetic user, and the user who moves them.
struct LiveUserPlan {
  Plan plan;
  std::shared_ptr<LiveUser> user;
};
/// User, as the options describe them.
struct LiveUserOptions {
  std::string interface = "wrist";
  std::string turn_by = "head";
  std::optional<double> grip_deg = {};  ///< None: drawn with the style.
  std::string grip_way = "mirrored";
  users::StyleWish style = {};
  bool ranges = false;  ///< Performs the motions of `footing-study ranges`.
  HeldKind devices = HeldKind::kWiimote;
};
/// A usage error lists what there is. `style_seed` is that of the user, common.seed that of the
/// devices.
Result<LiveUserPlan> PlanLiveUser(const LiveUserOptions& options, const Common& common,
                                  std::uint64_t style_seed);

/// Options of a synthetic user of one interface.
struct UserOptions {
  std::string script = "demo";
  std::string interface = "wrist";
  std::string turn_by = "head";
  std::optional<double> grip_deg;
  std::string grip_way = "mirrored";
  std::string see;  ///< Address of footing-sim; empty: the user follows the script.
  bool ranges = false;
  std::optional<std::uint64_t> style_seed;
  users::StyleWish style;
  std::string devices = "wiimote";
  Held held;  ///< Extensions plugged in.
};

/// The subcommand user and its flags. `options` must outlive the parsing.
CLI::App* AddUserCommand(CLI::App& app, UserOptions& options);

/// Options of the connection of simulated devices to footingd.
struct DialerOptions {
  transport::Address to;
  double rate_scale = 1;  ///< The devices' clocks run this much faster than nominal.
};

/// Attaches the simulated devices to footingd's device socket, delivers their reports in real time,
/// passes its output reports to them, and sends the feeds. Dials again whenever the connection is
/// lost; the motion then starts from the beginning, as with a device that reconnects.
class Dialer {
 public:
  /// `on_end` is called when the motion has come to its end.
  Dialer(boost::asio::io_context& io, DialerOptions options, Plan plan,
         std::function<void()> on_end);
  ~Dialer();
  Dialer(const Dialer&) = delete;
  Dialer& operator=(const Dialer&) = delete;

  void Start();
  /// Detaches every device and closes.
  void Stop(const std::string& reason);
  /// Whether footingd has been there at any time.
  bool has_attached() const;
  /// Why it has not been, for a program that has waited in vain.
  Error NeverAttached() const;
  /// Whether footingd has refused every device, on the present or the last connection.
  bool all_refused() const;

 private:
  class Implementation;
  std::shared_ptr<Implementation> implementation_;
};

}  // namespace footing::stream_client
