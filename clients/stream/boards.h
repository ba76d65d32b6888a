#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <Eigen/Core>

#include "clients/stream/body_stage.h"
#include "clients/stream/plan.h"
#include "common/base/result.h"
#include "common/body/kinematics.h"
#include "common/frames/camera_file.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/devices/held_device.h"

namespace footing::stream_client {

/// Options of a simulated person on boards.
struct BoardsOptions {
  StageOptions stage;
  std::string hands = "none";          ///< none, move, wiimote, straps, kinect or camera.
  std::string camera_file, frames_to;  ///< With hands "camera": camera file, frame FIFO.
  bool moves = false;         ///< With hands "camera": PS Moves in the fists light the spheres.
  std::string head = "none";  ///< none, or sphere: one on a cap, as a tracker sees it.
  /// Roles of Wiimotes with MotionPlus that are worn on the body (JointOfRole).
  std::vector<std::string> segment_roles;
  /// A hand that is lost for a while: its Wiimote out of reach, or not seen.
  std::string lost_hand;  ///< left or right; empty: none is.
  double lost_from_s = 0, lost_for_s = 0;
  double hand_noise_m = 0.01;  ///< Standard deviation along each axis, of hands "move".
  virtual_sensors::CellErrorConfig errors;  ///< Its seed is not used.
};

/// Two Balance Boards under a body in motion, its true pose, and its hands: as a tracker sees them
/// ("move"), as a Kinect does ("kinect"), or as two Wiimotes with MotionPlus in the fists feel them
/// ("wiimote"), each held so that it points forward with its buttons up in the T-pose, give or take
/// the errors of virtual_sensors::HeldErrors, or strapped on upper arms and forearms ("straps"); or
/// as rendered frames for footing-camera ("camera").
Result<Plan> PlanBoards(const BoardsOptions& options, const Common& common);

/// Readings of a Wiimote in the fist of side 0 (left) or 1 (right). A copy starts from the
/// beginning.
SimulatedDevice::WiimoteMotion InFist(std::shared_ptr<const Stage> stage, int side,
                                      std::uint64_t seed);

/// The joint whose segment a device of this role is worn on; nothing for other roles.
std::optional<body::Landmark> JointOfRole(stream::DeviceRole role);
/// Readings of a Wiimote worn on the segment that turns with a joint.
SimulatedDevice::WiimoteMotion OnBody(std::shared_ptr<const Stage> stage, body::Landmark joint,
                                      std::uint64_t seed);

/// Readings of a Wiimote strapped to a segment of that arm.
SimulatedDevice::WiimoteMotion OnSegment(std::shared_ptr<const Stage> stage, int side,
                                         virtual_sensors::ArmSegment segment, std::uint64_t seed);

/// Errors of an insole's cells.
struct InsoleErrors {
  double noise_kg = 0;     ///< White, of each cell and frame.
  double gain_spread = 0;  ///< Standard deviation of each cell's gain.
};

/// Options of a simulated person with insoles.
struct InsolesOptions {
  StageOptions stage;
  std::string hands = "none";  ///< none or move.
  double hand_noise_m = 0.01;  ///< Standard deviation along each axis.
  InsoleErrors errors;
};

/// A pressure insole in each shoe of a body in motion, its true pose, and its hands as a tracker
/// sees them. It may walk anywhere.
Result<Plan> PlanInsoles(const InsolesOptions& options, const Common& common);

/// The cells under one foot, 100 times a second: virtual_sensors::LoadInsole of the motion, with
/// errors.
Feed InsoleFeed(std::shared_ptr<const Stage> stage, std::size_t foot, const InsoleErrors& errors,
                std::uint64_t seed);

/// The subcommand boards and its flags. `options` must outlive the parsing.
CLI::App* AddBoardsCommand(CLI::App& app, BoardsOptions& options);
/// Adds the subcommand for a person with insoles.
CLI::App* AddInsolesCommand(CLI::App& app, InsolesOptions& options);

/// Options of the terrain game's synthetic players.
struct PlayersOptions {
  std::string simulation;  ///< Address of footing-sim, which the runner sees; empty: the default.
  bool pits = false;       ///< The builder lays pits, too.
};

/// Add the subcommands for the synthetic runner and the synthetic builder.
CLI::App* AddRunnerCommand(CLI::App& app, PlayersOptions& options);
CLI::App* AddBuilderCommand(CLI::App& app, PlayersOptions& options);

/// Both fists 60 times a second as a tracker with white noise sees them.
Feed HandFeed(std::shared_ptr<const Stage> stage, double noise_m, std::uint64_t seed);

/// Both fists and all joints as a Kinect's skeleton tracker measures them
/// (virtual_sensors::KinectSkeleton); what the body hides from it is inferred and said to be
/// hidden.
Feed KinectFeed(std::shared_ptr<const Stage> stage, std::uint64_t seed);

/// The sphere of a cap as a tracker with white noise that shows nothing else of a skeleton sees it.
Feed HeadFeed(std::shared_ptr<const Stage> stage, double noise_m, std::uint64_t seed);

/// The true pose 60 times a second: all joints, or of a skeleton of more than 64 those on the way
/// to a landmark.
Feed PoseFeed(std::shared_ptr<const Stage> stage);

/// A point of the body, in W.
Eigen::Vector3d PlaceAt(const Stage& stage, const body::Point& point, double t_s);

/// The sphere of a cap, 12 cm above the middle of the head.
body::Point CapSphere(const Stage& stage);

/// Ends a plan of what is under the feet: the fists where `hands` is "move" or "kinect", the true
/// pose, and how long it takes.
void AddBodyFeeds(const std::shared_ptr<const Stage>& stage, const std::string& hands,
                  double hand_noise_m, const Common& common, Plan& plan);

/// Joints of a skeleton that fit into a reference frame, parents first.
std::vector<int> ShownJoints(const body::Body& body);

/// Frames of a simulated camera in front of the body, with a luminous sphere in the middle of each
/// fist, for footing-camera: PGM images, each with the time of its exposure on the host's monotonic
/// clock. They are rendered in a thread of their own, since that takes longer than a report may
/// wait; a frame that is due while one is rendered is left out. `fifo` is opened for writing,
/// which waits for its reader. The camera file must say where the camera is. A sphere has the
/// file's colour, or that of the light of the PS Move in its fist.
Result<Feed> RenderedHandsFeed(std::shared_ptr<const Stage> stage, const std::string& camera_file,
                               const std::string& fifo, std::uint64_t seed);

/// A camera file for it: 2.2 m in front of the boards, 20 frames a second.
std::string DemoCameraFile();

}  // namespace footing::stream_client
