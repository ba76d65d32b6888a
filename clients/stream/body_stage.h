#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <boost/asio/io_context.hpp>

#include "clients/stream/plan.h"
#include "common/base/result.h"
#include "common/net/address.h"
#include "common/net/client.h"
#include "common/runtime/timer.h"
#include "common/stream/device.h"
#include "common/stream/setup.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/devices/controller.h"
#include "common/virtual/devices/noise.h"
#include "common/virtual/devices/scene.h"
#include "footing/v1/session.pb.h"

namespace footing::stream_client {

/// A synthetic person on boards with a remote in each hand, on each wrist or on each shin, who does
/// what a guided setup asks for. Boards and limbs are numbered 0 (left) and 1 (right) by what the
/// person calls them.
///
/// A limb that hangs feels (0, 0, -g) in its frame M (x left, y front, z down) and swings in the
/// plane of front and down, from rest: left leg and right hand to the front first, the left hand to
/// the back, the right leg half a cycle later. Remotes on wrists and shins are strapped on askew,
/// each in its own way, so that nothing is right before the mounting is found; those in the hands
/// are held as they should be.
class SetupBody {
 public:
  enum class Place { kHands, kWrists, kShins };
  /// One who stands on `boards` boards. They lie one foot each until Lay() says otherwise.
  explicit SetupBody(Place place, double mass_kg = 70, int boards = 2);

  stream::DeviceRole Role(int limb) const;

  /// One line: off | left | right | both | lean | shake left | shake right | still | walk | run |
  /// jump | swap (the boards) | turn left | turn right (a board, by half) | slip left DEGREES |
  /// slip right DEGREES (a strap, about the limb) | loose left | loose right (a strap; again:
  /// tight). False when it is not known.
  bool Do(const std::string& line);

  /// Sets how the boards lie: their yaw in W, as in stream::BoardPose.
  void Lay(double left_yaw_rad, double right_yaw_rad) { yaw_rad_ = {left_yaw_rad, right_yaw_rad}; }

  /// Corner forces of the board that lies in this place in the beginning. Times never go back.
  virtual_devices::CornerForces Board(int board, double t_s);
  /// Specific force on the limb's remote, m/s2, in the remote's own axes.
  Eigen::Vector3d Limb(int limb, double t_s);

 private:
  struct Swing {
    double frequency_hz = 0;
    double amplitude_mps2 = 0;
    bool in_turns = false;
  };
  struct Strap {
    double slip_rad = 0;  // About the limb.
    bool loose = false;
  };
  double Share(int place) const;
  double Wave(int limb) const;

  Place place_;
  double weight_n_;
  int boards_;
  std::array<double, 2> yaw_rad_;
  std::string stance_ = "off";
  double lean_m_ = 0;
  std::array<Swing, 2> swing_;
  std::array<Strap, 2> strap_;
  std::array<bool, 2> turned_{};
  bool swapped_ = false;
  std::array<double, 2> share_{};  // As it is now; follows Share() within a third of a second.
  std::array<double, 2> leaning_m_{};
  std::array<double, 2> board_s_{};
  std::array<double, 2> limb_s_{};
  std::array<double, 2> swinging_s_{};  // Since the swing began.
  noise::Random random_{7};
};

/// Person who performs a guided setup, and the devices.
struct SetupPersonOptions {
  std::string interface = {};  ///< Interface with the devices; empty: two remotes, two boards.
  std::optional<int> boards = std::nullopt;  ///< 0 to 2; nothing: those of the interface.
  double mass_kg = 70;
  std::string rig = "main";
  bool strapped = false;  ///< Remotes of hands are strapped on the wrists askew, not held.
  bool jumbled = false;   ///< The devices ask for the roles of the other side.
  bool once = false;      ///< One setup only.
};

/// Record of the prompts of guided setups.
struct SetupRecord {
  struct Asked {
    stream::SetupPrompt prompt;
    bool performed = false;  ///< The prompt says which gesture it is about.
  };
  std::vector<Asked> asked;
  int setups = 0;  ///< Ended so far.
};

/// Performs what a guided setup asks for. It follows the prompt that footingd publishes with the
/// rig's set-up, so it does nothing before it is asked, and again what is asked for again.
class SetupPerson {
 public:
  /// `on_end` is called when a setup has ended, and nothing was asked for a while.
  SetupPerson(boost::asio::io_context& io, std::shared_ptr<SetupBody> body, std::string rig,
              std::shared_ptr<SetupRecord> record, std::function<void()> on_end);

  /// Takes a tick that footingd published.
  void See(const v1::Tick& tick);

 private:
  void Follow(const stream::RigSetup& setup);
  bool Perform(const stream::SetupPrompt& prompt);
  void End();

  std::shared_ptr<SetupBody> body_;
  const std::string rig_;
  const std::shared_ptr<SetupRecord> record_;
  const std::function<void()> on_end_;
  timer::Timer steps_;  ///< Until the three steps are over.
  timer::Timer over_;
  std::uint64_t number_ = 0;  ///< Number of the newest prompt.
  std::string item_;          ///< Item of the newest prompt; empty: no setup is under way.
};

/// The devices of the person and the body that moves them.
struct SetupPersonPlan {
  Plan plan;
  std::shared_ptr<SetupBody> body;
};
/// Plans the person and the devices of a guided setup.
Result<SetupPersonPlan> PlanSetupPerson(const SetupPersonOptions& options, const Common& common);

/// Options of a simulated person who follows a guided setup.
struct RehearseOptions {
  SetupPersonOptions person;
  std::string sensor;  ///< Address of footingd, whose setup is followed; empty: the default.
  bool json = false;
};

/// The subcommand rehearse and its flags. `options` must outlive the parsing.
CLI::App* AddRehearseCommand(CLI::App& app, RehearseOptions& options);

/// Prints what was asked for and performed.
void PrintAsked(const SetupRecord& record, bool json);

/// The eyes of a synthetic user, player or person: calls `see` with what the server publishes in
/// these channels. Everything runs on the io_context's one thread.
std::unique_ptr<transport::Client> Watch(boost::asio::io_context& io,
                                         const transport::Address& server,
                                         std::vector<std::string> channels,
                                         std::function<void(const v1::Tick&)> see);

/// Movement of the body, and where the body stands.
struct StageOptions {
  std::string motion;    ///< A built-in name, or a path: .json, .bvh, .amc, .trc, .c3d.
  std::string skeleton;  ///< ASF of an AMC.
  std::optional<double> bvh_unit_m = {};
  double mass_kg = 75;
  double height_m = 1.75;     ///< Height of the performer of a script; recordings have their own.
  bool on_boards = true;      ///< False: it may walk anywhere, and nothing is said of boards.
  bool place_boards = false;  ///< Lay the boards under the feet instead of 20 mm apart.
  double seconds = 0;         ///< A recording plays forwards and backwards for this time; 0: once.
};

/// A body in motion over two boards, ready to be felt. Immutable once made.
struct Stage {
  virtual_sensors::Scene scene;
  std::vector<std::array<virtual_sensors::FootForce, virtual_sensors::kFeet>> feet;  ///< A frame.
  std::array<virtual_sensors::BoardPlace, virtual_sensors::kFeet> boards;
  double gap_m = 0.02;       ///< Between the boards' facing edges.
  double outside_share = 0;  ///< Share of loaded feet with a COP beyond the board's sensors.
  bool repeats = false;      ///< Ends as it begins; goes on and on.

  double duration_s() const;
  /// A time as a frame and the way to the next one, 0 to 1. After the end the last frame stays,
  /// unless it repeats.
  struct Instant {
    Eigen::Index frame = 0;
    double share = 0;
  };
  Instant At(double t_s) const;
  /// Load and COP under a foot; between frames as the forces go over.
  virtual_sensors::FootForce FootAt(std::size_t foot, double t_s) const;
};

/// Loads or performs the motion and stands it on the boards: the middle of both soles at the start
/// is W's origin, the boards are 20 mm apart, left and right of it. Logs what it does and how the
/// boards would have to lie.
Result<std::shared_ptr<const Stage>> MakeStage(const StageOptions& options);

}  // namespace footing::stream_client
