#include "clients/stream/boards.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>

#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/body/skeleton.h"
#include "common/body/skeleton_points.h"
#include "common/frames/camera_file.h"
#include "common/runtime/exchange.h"
#include "common/virtual/camera/render.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/devices/held_device.h"
#include "common/virtual/devices/kinect_skeleton.h"
#include "common/virtual/devices/noise.h"
#include "common/virtual/options/sensor_options.h"

namespace footing::stream_client {
namespace {

using stream::DeviceRole;
namespace sensors = virtual_sensors;

/// Readings of one board's cells; a copy starts from the beginning.
SimulatedDevice::CornerForces UnderFoot(std::shared_ptr<const Stage> stage, std::size_t foot,
                                        sensors::CellErrorConfig errors, std::uint64_t seed) {
  errors.seed = seed;
  return [stage, foot, cells = sensors::CellErrors(errors), last_s = 0.0](double t_s) mutable {
    const auto load = sensors::LoadBoard(stage->boards[foot], stage->FootAt(foot, t_s));
    const sensors::Corners read = cells.Advance(load.corners_n, std::max(0.0, t_s - last_s));
    last_s = t_s;
    return virtual_devices::CornerForces{read[0], read[1], read[2], read[3]};
  };
}

/// Errors of the device and of its mounting; the device itself counts.
sensors::HeldErrors ErrorsOf(bool rolled, std::uint64_t seed) {
  sensors::HeldErrorConfig config;
  config.force_count_mps2 = config.turn_count_radps = 0;
  config.rolled = rolled;
  config.seed = seed;
  return sensors::HeldErrors(config);
}

/// Readings of a device on that course, in its own frame: x left, y front, z down.
template <typename Sensors>
std::function<Sensors(double)> Felt(std::shared_ptr<const Stage> stage,
                                    sensors::HeldCourse true_course,
                                    const sensors::HeldErrors& of_device) {
  const auto course = std::make_shared<const sensors::HeldCourse>(std::move(true_course));
  return [stage, course, errors = of_device, last_s = 0.0](double t_s) mutable {
    const Stage::Instant at = stage->At(t_s);
    const auto between = [&at](const Eigen::Matrix3Xd& values) -> Eigen::Vector3d {
      return (1 - at.share) * values.col(at.frame) + at.share * values.col(at.frame + 1);
    };
    const auto measured = errors.Advance(between(course->specific_force_S_mps2),
                                         between(course->angular_velocity_S_radps),
                                         std::max(0.0, t_s - std::exchange(last_s, t_s)));
    Sensors felt;
    felt.specific_force_S_mps2 = body::AsHeld(measured.specific_force_S_mps2);
    felt.angular_velocity_S_radps = body::AsHeld(measured.angular_velocity_S_radps);
    return felt;
  };
}

void AddWiimotes(const std::shared_ptr<const Stage>& stage, const std::string& hands,
                 const Common& common, virtual_devices::LinkQuality link, Plan& plan) {
  const auto add = [&](DeviceRole role, const auto& motion_of) {
    const std::uint64_t device = plan.devices.size() + 1;
    plan.devices.push_back(MakeRemote(common, link, device, role,
                                      motion_of(DeviceSeed(common, device) + 700),
                                      {HeldKind::kWiimote, true, false}));
  };
  for (const int side : {0, 1}) {
    const auto role = [side](DeviceRole left, DeviceRole right) {
      return side == 0 ? left : right;
    };
    if (hands == "wiimote") {
      add(role(DeviceRole::kLeftHand, DeviceRole::kRightHand),
          [&](std::uint64_t seed) { return InFist(stage, side, seed); });
    }
    if (hands != "straps") continue;
    add(role(DeviceRole::kLeftUpperArm, DeviceRole::kRightUpperArm), [&](std::uint64_t seed) {
      return OnSegment(stage, side, sensors::ArmSegment::kUpperArm, seed);
    });
    add(role(DeviceRole::kLeftForearm, DeviceRole::kRightForearm), [&](std::uint64_t seed) {
      return OnSegment(stage, side, sensors::ArmSegment::kForearm, seed);
    });
  }
}

Result<void> CheckHands(const BoardsOptions& options) {
  const std::string& hands = options.hands;
  if (hands != "none" && hands != "move" && hands != "wiimote" && hands != "kinect" &&
      hands != "camera" && hands != "straps") {
    return UsageError("--hands " + hands +
                      " is unknown; must be one of: none, move, wiimote, straps, kinect, camera");
  }
  if (options.head != "none" && options.head != "sphere") {
    return UsageError("--head " + options.head + " is unknown; must be none or sphere");
  }
  if (options.moves && hands != "camera") {
    return UsageError("--moves needs --hands camera: their lights are for a camera");
  }
  if (hands == "camera" && (options.camera_file.empty() || options.frames_to.empty())) {
    return UsageError("--hands camera needs --camera FILE and --frames-to FIFO");
  }
  const std::string& lost = options.lost_hand;
  if (!lost.empty() && lost != "left" && lost != "right") {
    return UsageError("--lose-hand " + lost + " is unknown; must be left or right");
  }
  if (!lost.empty() && (hands == "none" || hands == "camera" || hands == "straps")) {
    return UsageError("--lose-hand " + lost + ": with --hands " + hands +
                      " there is nothing to lose");
  }
  return {};
}

Result<void> AddSegmentSensors(const std::shared_ptr<const Stage>& stage,
                               const std::vector<std::string>& names, const Common& common,
                               virtual_devices::LinkQuality link, Plan& plan) {
  for (const std::string& name : names) {
    const DeviceRole role = stream::RoleNamed(name);
    const auto joint = JointOfRole(role);
    if (!joint || stage->scene.body.landmarks[*joint] < 0) {
      return UsageError("--worn " + name +
                        ": must be pelvis, trunk, head, left_thigh, right_thigh, left_leg or "
                        "right_leg");
    }
    const std::uint64_t device = plan.devices.size() + 1;
    plan.devices.push_back(MakeRemote(common, link, device, role,
                                      OnBody(stage, *joint, DeviceSeed(common, device) + 700),
                                      {HeldKind::kWiimote, true, false}));
  }
  return {};
}

/// PS Moves in both fists; a camera sees their lights.
void AddMoves(const std::shared_ptr<const Stage>& stage, const Common& common,
              virtual_devices::LinkQuality link, Plan& plan) {
  for (const int side : {0, 1}) {
    const std::uint64_t seed = DeviceSeed(common, 3 + static_cast<std::uint64_t>(side));
    auto course = sensors::FollowFist(stage->scene.body, stage->scene.motion, side);
    plan.devices.emplace_back(
        virtual_devices::PsMove(seed, virtual_devices::MoveModel::kZcm1),
        Felt<virtual_devices::MoveSensors>(stage, std::move(course), ErrorsOf(false, seed + 700)),
        side == 0 ? DeviceRole::kLeftHand : DeviceRole::kRightHand,
        virtual_devices::WiimoteLink(link, seed + 500));
  }
}

/// One hand is out of reach, or not seen, for a while.
void LoseHand(const BoardsOptions& options, Plan& plan) {
  if (options.lost_hand.empty()) return;
  const DeviceRole role =
      options.lost_hand == "left" ? DeviceRole::kLeftHand : DeviceRole::kRightHand;
  Silence silence{0, options.lost_from_s, options.lost_from_s + options.lost_for_s};
  for (; silence.device < plan.devices.size(); ++silence.device) {
    if (plan.devices[silence.device].role() == role) plan.silences.push_back(silence);
  }
  for (Feed& feed : plan.feeds) {
    if (!feed.hands) continue;
    feed.hands = [seen = std::move(feed.hands), role, silence](double t_s) mutable {
      stream::HandFrame frame = seen(t_s);
      std::erase_if(frame.points, [&](const stream::TrackedPoint& point) {
        return point.role == role && silence.Covers(t_s);
      });
      return frame;
    };
  }
}

}  // namespace

SimulatedDevice::WiimoteMotion InFist(std::shared_ptr<const Stage> stage, int side,
                                      std::uint64_t seed) {
  auto course = sensors::FollowFist(stage->scene.body, stage->scene.motion, side);
  return Felt<virtual_devices::WiimoteSensors>(std::move(stage), std::move(course),
                                               ErrorsOf(false, seed));
}

SimulatedDevice::WiimoteMotion OnSegment(std::shared_ptr<const Stage> stage, int side,
                                         sensors::ArmSegment segment, std::uint64_t seed) {
  auto course = sensors::FollowSegment(stage->scene.body, stage->scene.motion, side, segment);
  return Felt<virtual_devices::WiimoteSensors>(std::move(stage), std::move(course),
                                               ErrorsOf(true, seed));
}

std::optional<body::Landmark> JointOfRole(DeviceRole role) {
  using body::Landmark;
  constexpr std::pair<DeviceRole, Landmark> kJoints[] = {
      {DeviceRole::kPelvis, Landmark::kHips},         {DeviceRole::kTrunk, Landmark::kChest},
      {DeviceRole::kHead, Landmark::kHead},           {DeviceRole::kLeftThigh, Landmark::kLeftHip},
      {DeviceRole::kRightThigh, Landmark::kRightHip}, {DeviceRole::kLeftLeg, Landmark::kLeftKnee},
      {DeviceRole::kRightLeg, Landmark::kRightKnee}};
  for (const auto& [known, joint] : kJoints) {
    if (known == role) return joint;
  }
  return std::nullopt;
}

SimulatedDevice::WiimoteMotion OnBody(std::shared_ptr<const Stage> stage, body::Landmark joint,
                                      std::uint64_t seed) {
  constexpr double kBesideM = 0.1;
  auto course =
      sensors::FollowJoint(stage->scene.body, stage->scene.motion,
                           stage->scene.body.landmarks[joint], Eigen::Vector3d(kBesideM, 0, 0));
  return Felt<virtual_devices::WiimoteSensors>(std::move(stage), std::move(course),
                                               ErrorsOf(true, seed));
}

Result<Plan> PlanBoards(const BoardsOptions& options, const Common& common) {
  if (const auto checked = CheckHands(options); !checked) return checked.error();
  const auto link = ParseLink(common.link);
  if (!link) return link.error();
  StageOptions wanted = options.stage;
  wanted.seconds = common.seconds;
  const auto made = MakeStage(wanted);
  if (!made) return made.error();
  const std::shared_ptr<const Stage>& stage = *made;
  Plan plan;
  for (const std::size_t foot : {0u, 1u}) {
    const std::uint64_t seed = DeviceSeed(common, foot + 1);
    plan.devices.emplace_back(virtual_devices::BalanceBoard(seed),
                              UnderFoot(stage, foot, options.errors, seed + 700),
                              foot == 0 ? DeviceRole::kLeftBoard : DeviceRole::kRightBoard,
                              virtual_devices::BoardLink(*link, seed + 500));
  }
  AddWiimotes(stage, options.hands, common, *link, plan);
  if (const auto added = AddSegmentSensors(stage, options.segment_roles, common, *link, plan);
      !added) {
    return added.error();
  }
  if (options.moves) AddMoves(stage, common, *link, plan);
  AddBodyFeeds(stage, options.hands, options.hand_noise_m, common, plan);
  if (options.head == "sphere") {
    plan.feeds.push_back(HeadFeed(stage, options.hand_noise_m, DeviceSeed(common, 4) + 700));
  }
  if (options.hands == "camera") {
    auto frames = RenderedHandsFeed(stage, options.camera_file, options.frames_to,
                                    DeviceSeed(common, 3) + 700);
    if (!frames) return frames.error();
    plan.feeds.push_back(*std::move(frames));
  }
  LoseHand(options, plan);
  return plan;
}

namespace {

constexpr double kInsoleRateHz = 100;

}  // namespace

Feed InsoleFeed(std::shared_ptr<const Stage> stage, std::size_t foot, const InsoleErrors& errors,
                std::uint64_t seed) {
  const auto places =
      sensors::InsolePlaces(sensors::PlaceOfSole(stage->scene.course, foot, 0).length_m);
  noise::Random random(seed);
  std::array<double, sensors::kInsoleCells> gains{};
  for (double& gain : gains) gain = 1 + errors.gain_spread * random.Normal();
  const double noise_n = KilogramsToNewtons(errors.noise_kg);
  Feed feed;
  feed.rate_hz = kInsoleRateHz;
  feed.contacts = [=](double t_s) mutable {
    const Stage::Instant at = stage->At(t_s);
    const sensors::SolePlace sole =
        sensors::PlaceOfSole(stage->scene.course, foot, at.share < 0.5 ? at.frame : at.frame + 1);
    const auto loads_n = sensors::LoadInsole(places, sole, stage->FootAt(foot, t_s));
    stream::ContactFrame frame;
    frame.source = foot == 0 ? "sim-insole-left" : "sim-insole-right";
    frame.body = foot == 0 ? stream::ContactBody::kLeftFoot : stream::ContactBody::kRightFoot;
    frame.simulated = true;
    for (std::size_t i = 0; i < places.size(); ++i) {
      frame.cells.push_back(
          {{places[i].x(), places[i].y(), 0}, gains[i] * loads_n[i] + noise_n * random.Normal()});
    }
    return frame;
  };
  return feed;
}

Result<Plan> PlanInsoles(const InsolesOptions& options, const Common& common) {
  if (options.hands != "none" && options.hands != "move") {
    return UsageError("--hands " + options.hands + ": with insoles there are none and move");
  }
  StageOptions wanted = options.stage;
  wanted.on_boards = false;
  wanted.seconds = common.seconds;
  const auto made = MakeStage(wanted);
  if (!made) return made.error();
  const std::shared_ptr<const Stage>& stage = *made;
  Plan plan;
  for (const std::size_t foot : {0u, 1u}) {
    plan.feeds.push_back(
        InsoleFeed(stage, foot, options.errors, DeviceSeed(common, foot + 1) + 700));
  }
  AddBodyFeeds(stage, options.hands, options.hand_noise_m, common, plan);
  return plan;
}

namespace {

void AddMotion(CLI::App& command, StageOptions& stage) {
  command
      .add_option("--motion", stage.motion,
                  "Motion: a built-in name (demo, own_motion, quiet), a choreography script, or a "
                  "BVH, AMC, "
                  "TRC or C3D file")
      ->required();
  sensor_options::AddMotionFile(command, stage.skeleton, stage.bvh_unit_m);
  command.add_option("--mass-kg", stage.mass_kg, "Mass of the body, kg")
      ->check(CLI::Range(20.0, 250.0));
  command.add_option("--height-m", stage.height_m, "Height of the person who performs a script, m")
      ->check(CLI::Range(1.4, 2.1));
}

void AddHandNoise(CLI::App& command, double& hand_noise_m) {
  command
      .add_option("--hand-noise-m", hand_noise_m,
                  "Standard deviation of the noise of hand positions, m")
      ->check(CLI::Range(0.0, 0.5));
}

}  // namespace

CLI::App* AddBoardsCommand(CLI::App& app, BoardsOptions& options) {
  auto* boards =
      app.add_subcommand("boards", "Two Balance Boards, and hand devices, under a moving body");
  AddMotion(*boards, options.stage);
  boards->add_option("--hands", options.hands,
                     "Hand devices: none, move, wiimote, straps, kinect or camera");
  boards->add_option("--head", options.head,
                     "Head tracker: none, or sphere for one on a cap (default none)");
  boards
      ->add_option(
          "--worn", options.segment_roles,
          "Role of a Wiimote with MotionPlus that is worn on the body, such as pelvis (on a "
          "belt), trunk, head, left_thigh or left_leg; may be repeated")
      ->delimiter(',');
  boards->add_option("--camera", options.camera_file,
                     "With --hands camera: camera file of the simulated camera");
  boards->add_option("--frames-to", options.frames_to,
                     "FIFO for its rendered frames, which footing-camera reads");
  boards->add_flag("--moves", options.moves,
                   "PS Moves in the fists: their lights are the spheres that the camera sees");
  boards->add_option("--lose-hand", options.lost_hand, "Hand to lose for a while: left or right");
  boards->add_option("--lose-from-s", options.lost_from_s, "Start of the loss, s")
      ->check(CLI::Range(0.0, 1e6));
  boards->add_option("--lose-for-s", options.lost_for_s, "Duration of the loss, s")
      ->check(CLI::Range(0.0, 1e6));
  AddHandNoise(*boards, options.hand_noise_m);
  boards->add_flag("--place-boards", options.stage.place_boards, "Place the boards under the feet");
  sensor_options::AddBoardErrors(*boards, options.errors);
  return boards;
}

CLI::App* AddInsolesCommand(CLI::App& app, InsolesOptions& options) {
  auto* insoles = app.add_subcommand("insoles", "Pressure insoles in the shoes of a moving body");
  AddMotion(*insoles, options.stage);
  insoles->add_option("--hands", options.hands, "Hand devices: none or move");
  AddHandNoise(*insoles, options.hand_noise_m);
  sensor_options::AddCellErrors(*insoles, options.errors.noise_kg, options.errors.gain_spread);
  return insoles;
}

CLI::App* AddRunnerCommand(CLI::App& app, PlayersOptions& options) {
  CLI::App* const runner = app.add_subcommand(
      "runner", "A synthetic player who runs along the track, a Wiimote in each hand");
  runner->add_option(
      "--watch", options.simulation,
      "Address of footing-sim, which the player sees, unix:PATH, tcp:HOST:PORT or tls:HOST:PORT");
  return runner;
}

CLI::App* AddBuilderCommand(CLI::App& app, PlayersOptions& options) {
  CLI::App* const builder = app.add_subcommand(
      "builder", "A synthetic player who builds the track, a Wiimote in the role editor");
  builder->add_flag("--pits", options.pits, "Press B for pits, too");
  return builder;
}

namespace {

constexpr double kTruthRateHz = 60;
constexpr std::size_t kMostJoints = 64;  // Limit of a reference frame.
constexpr double kLeastSdM = 0.001;      // Nobody's tracker is exact.
constexpr double kCapM = 0.12;           // A sphere on a cap, above the middle of the head.

/// The body's pose between two frames.
Eigen::VectorXd PoseAt(const Stage& stage, double t_s) {
  const Stage::Instant at = stage.At(t_s);
  const Eigen::MatrixXd& q = stage.scene.motion.q;
  return (1 - at.share) * q.col(at.frame) + at.share * q.col(at.frame + 1);
}

body::Kinematics KinematicsAt(const Stage& stage, double t_s) {
  body::Kinematics at(stage.scene.body.skeleton);
  body::ComputeKinematics(stage.scene.body.skeleton, PoseAt(stage, t_s), at);
  return at;
}

}  // namespace

std::vector<int> ShownJoints(const body::Body& body) {
  const body::Skeleton& skeleton = body.skeleton;
  const auto size = static_cast<std::size_t>(skeleton.size());
  std::vector<bool> shown(size, size <= kMostJoints);
  for (const int landmark : body.landmarks.joint)
    for (int joint = landmark; joint >= 0; joint = skeleton.joint(joint).parent)
      shown[static_cast<std::size_t>(joint)] = true;
  std::vector<int> joints;
  for (std::size_t i = 0; i < size && joints.size() < kMostJoints; ++i)
    if (shown[i]) joints.push_back(static_cast<int>(i));
  return joints;
}

Eigen::Vector3d PlaceAt(const Stage& stage, const body::Point& point, double t_s) {
  return body::Place(point, KinematicsAt(stage, t_s));
}

body::Point CapSphere(const Stage& stage) { return body::AboveHead(stage.scene.body, kCapM); }

namespace {

/// Both fists where they are.
stream::HandFrame Fists(const Stage& stage, const char* tracker, double sd_m, double t_s) {
  const body::Kinematics at = KinematicsAt(stage, t_s);
  stream::HandFrame frame;
  frame.tracker = tracker;
  frame.simulated = true;
  for (const int side : {0, 1}) {
    stream::TrackedPoint point;
    point.role = side == 0 ? stream::DeviceRole::kLeftHand : stream::DeviceRole::kRightHand;
    point.position_m = body::Place(body::Fist(stage.scene.body, side), at);
    point.sd_m.setConstant(sd_m);
    point.confidence = 1;
    frame.points.push_back(point);
  }
  return frame;
}

}  // namespace

Feed HandFeed(std::shared_ptr<const Stage> stage, double noise_m, std::uint64_t seed) {
  Feed feed;
  feed.rate_hz = kTruthRateHz;
  feed.hands = [stage, noise_m, random = noise::Random(seed)](double t_s) mutable {
    stream::HandFrame frame = Fists(*stage, "move", std::max(noise_m, kLeastSdM), t_s);
    for (stream::TrackedPoint& point : frame.points)
      for (double& value : point.position_m) value += noise_m * random.Normal();
    return frame;
  };
  return feed;
}

Feed HeadFeed(std::shared_ptr<const Stage> stage, double noise_m, std::uint64_t seed) {
  Feed feed;
  feed.rate_hz = kTruthRateHz;
  feed.hands = [stage, noise_m, sphere = CapSphere(*stage),
                random = noise::Random(seed)](double t_s) mutable {
    stream::HandFrame frame;
    frame.tracker = "cap";
    frame.simulated = true;
    stream::TrackedPoint& point = frame.points.emplace_back();
    point.joint = stream::BodyJoint::kHead;
    point.position_m = PlaceAt(*stage, sphere, t_s);
    for (double& value : point.position_m) value += noise_m * random.Normal();
    point.sd_m.setConstant(std::max(noise_m, kLeastSdM));
    point.confidence = 1;
    return frame;
  };
  return feed;
}

Feed KinectFeed(std::shared_ptr<const Stage> stage, std::uint64_t seed) {
  using virtual_sensors::KinectErrors;
  using virtual_sensors::KinectSkeleton;
  constexpr double kTracked = 1, kInferred = 0.5;  // As NiTE says it.
  Feed feed;
  feed.rate_hz = 1 / KinectErrors::kPeriodS;
  feed.late_s = KinectErrors::kLateS;
  feed.hands = [stage, kinect = KinectSkeleton(stage->scene.body, seed)](double t_s) mutable {
    stream::HandFrame frame;
    frame.tracker = "kinect";
    frame.simulated = true;
    const auto& seen = kinect.Expose(KinematicsAt(*stage, t_s));
    for (std::size_t i = 0; i < seen.size(); ++i) {
      stream::TrackedPoint& point = frame.points.emplace_back();
      if (i < KinectSkeleton::kHands) {
        point.role = i == 0 ? stream::DeviceRole::kLeftHand : stream::DeviceRole::kRightHand;
      } else {
        point.joint = static_cast<stream::BodyJoint>(i - KinectSkeleton::kHands + 1);
      }
      point.position_m = seen[i].p_W_m;
      point.confidence = seen[i].hidden ? kInferred : kTracked;
      point.sd_m.setConstant(std::sqrt(point.confidence) * seen[i].sd_m);
      point.occluded = seen[i].hidden;
    }
    return frame;
  };
  return feed;
}

Feed PoseFeed(std::shared_ptr<const Stage> stage) {
  const std::vector<int> joints = ShownJoints(stage->scene.body);
  std::vector<int> parents;
  for (const int joint : joints) {
    const int parent = stage->scene.body.skeleton.joint(joint).parent;
    const auto found = std::find(joints.begin(), joints.end(), parent);
    parents.push_back(found == joints.end() ? -1 : static_cast<int>(found - joints.begin()));
  }
  Feed feed;
  feed.rate_hz = kTruthRateHz;
  feed.reference = [stage, joints, parents](double t_s) {
    const body::Kinematics at = KinematicsAt(*stage, t_s);
    stream::ReferenceFrame frame;
    frame.parents = parents;
    for (const int joint : joints)
      frame.positions_m.push_back(at.p_WJ[static_cast<std::size_t>(joint)]);
    frame.com_m = body::CentreOfMass(stage->scene.body, at);
    return frame;
  };
  return feed;
}

void AddBodyFeeds(const std::shared_ptr<const Stage>& stage, const std::string& hands,
                  double hand_noise_m, const Common& common, Plan& plan) {
  if (hands == "move") {
    plan.feeds.push_back(HandFeed(stage, hand_noise_m, DeviceSeed(common, 3) + 700));
  } else if (hands == "kinect") {
    plan.feeds.push_back(KinectFeed(stage, DeviceSeed(common, 3) + 700));
  }
  plan.feeds.push_back(PoseFeed(stage));
  plan.duration_s = common.seconds > 0 ? common.seconds : stage->repeats ? 0 : stage->duration_s();
}

namespace {

constexpr double kDemoRateHz = 20;

virtual_camera::Lens ToLens(const sphere::Lens& lens) {
  return {lens.width, lens.height, lens.fx_px, lens.fy_px, lens.cx_px, lens.cy_px,
          lens.k1,    lens.k2,     lens.p1,    lens.p2,    lens.k3};
}

/// Scenes become images in its thread.
class Renderer {
 public:
  Renderer(int descriptor, std::uint64_t seed)
      : descriptor_(descriptor),
        ended_(::eventfd(0, EFD_CLOEXEC)),
        random_(seed),
        work_(io_.get_executor()) {
    ::fcntl(descriptor_, F_SETFL, O_NONBLOCK);
    thread_ = std::thread([this] { io_.run(); });
  }

  ~Renderer() {
    ::eventfd_write(ended_, 1);  // The thread may wait for a reader that reads no more.
    work_.reset();
    io_.stop();
    thread_.join();
    ::close(descriptor_);
    ::close(ended_);
  }

  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  void Take(const virtual_camera::Scene& scene, std::int64_t exposed_ns) {
    if (!busy_.RaiseIfLowered()) return;
    boost::asio::post(io_, [this, scene, exposed_ns] {
      RenderOnRenderThread(scene, exposed_ns);
      busy_.Lower();
    });
  }

 private:
  void RenderOnRenderThread(const virtual_camera::Scene& scene, std::int64_t exposed_ns) {
    if (closed_) return;
    const auto mosaic = virtual_camera::Render(scene, random_);
    const std::string image = frames::ToPgm(
        {sphere::PixelFormat::kSgrbg8, mosaic.width, mosaic.height, mosaic.bytes, exposed_ns});
    for (std::size_t at = 0; at < image.size();) {
      const ssize_t written = ::write(descriptor_, image.data() + at, image.size() - at);
      if (written > 0) at += static_cast<std::size_t>(written);
      if (written > 0 || (written < 0 && errno == EINTR)) continue;
      if (written == 0 || errno != EAGAIN || !WaitForReader()) {
        closed_ = true;  // Its reader has gone, or this program ends.
        return;
      }
    }
  }

  /// False when the destructor waits.
  bool WaitForReader() const {
    std::array<pollfd, 2> waited = {{{descriptor_, POLLOUT, 0}, {ended_, POLLIN, 0}}};
    while (::poll(waited.data(), waited.size(), -1) < 0 && errno == EINTR) {
    }
    return (waited[1].revents & POLLIN) == 0;
  }

  const int descriptor_;
  const int ended_;
  noise::Random random_;
  exchange::Flag busy_;
  bool closed_ = false;  // Used by the render thread.
  boost::asio::io_context io_;
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_;
  std::thread thread_;
};

/// Colour of a sphere in the simulated camera at a colour of its light, digital numbers: each of
/// three LEDs on the sensor's red, green and blue, whose filters overlap, and ambient light on the
/// white plastic.
Eigen::Vector3d ShownColour(std::uint32_t rgb) {
  Eigen::Matrix3d sensor_dn;  // A column for each LED at its brightest.
  sensor_dn << 150, 20, 12,   //
      22, 150, 30,            //
      12, 30, 150;
  const Eigen::Vector3d light((rgb >> 16) & 0xff, (rgb >> 8) & 0xff, rgb & 0xff);
  return Eigen::Vector3d(16, 15, 17) + sensor_dn * light / 255;
}

/// Where on the body the sphere of that role is.
body::Point SphereOf(const Stage& stage, stream::DeviceRole role) {
  if (role == stream::DeviceRole::kHead) return CapSphere(stage);
  return body::Fist(stage.scene.body, role == stream::DeviceRole::kLeftHand ? 0 : 1);
}

/// A sphere where it is when the row on which it appears is exposed. It rests meanwhile: at
/// the exposure of 1 ms that is meant here, a hand moves by a millimetre.
virtual_camera::Ball BallOn(const Stage& stage, const frames::CameraFile& camera,
                            const virtual_camera::Scene& scene, std::size_t sphere,
                            const body::Point& point, const SphereLights& lights, double t_s) {
  const Eigen::Isometry3d X_CW = camera.X_WC->inverse();
  virtual_camera::Ball ball;
  const auto light = lights.find(camera.spheres[sphere].role);
  ball.colour_dn =
      light == lights.end() ? camera.spheres[sphere].target.colour_dn : ShownColour(light->second);
  ball.radius_m = camera.spheres[sphere].target.radius_m;
  ball.p_C_m = X_CW * PlaceAt(stage, point, t_s);
  if (ball.p_C_m.z() <= 0.1) return ball;  // Behind the camera: not drawn.
  const double row_px = virtual_camera::Project(scene.lens, ball.p_C_m).y();
  ball.p_C_m = X_CW * PlaceAt(stage, point, t_s + virtual_camera::RowTime(scene, row_px));
  return ball;
}

Result<frames::CameraFile> ReadPlacedCamera(const std::string& path) {
  auto camera = frames::ReadCameraFile(path);
  if (!camera) return camera;
  if (!camera->X_WC)
    return InvalidData(path + " does not say where the camera is (position_W_m, rotation_WC)");
  if (camera->format != sphere::PixelFormat::kSgrbg8)
    return InvalidData(path + ", key format: frames are rendered in SGRBG8 only");
  return camera;
}

}  // namespace

Result<Feed> RenderedHandsFeed(std::shared_ptr<const Stage> stage, const std::string& camera_file,
                               const std::string& fifo, std::uint64_t seed) {
  auto read = ReadPlacedCamera(camera_file);
  if (!read) return read.error();
  const auto camera = std::make_shared<const frames::CameraFile>(*std::move(read));
  std::signal(SIGPIPE, SIG_IGN);  // NOLINT: a reader that goes ends the frames, not the program.
  const int descriptor = ::open(fifo.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor < 0)
    return Failure("cannot write frames to " + fifo + ": " + std::string(std::strerror(errno)) +
                   "; make it with mkfifo");
  const auto renderer = std::make_shared<Renderer>(descriptor, seed);
  std::vector<body::Point> points;
  for (const frames::HeldSphere& held : camera->spheres)
    points.push_back(SphereOf(*stage, held.role));
  Feed feed;
  feed.rate_hz = camera->rate_hz;
  feed.frames = [stage, camera, renderer, points](double t_s, std::int64_t exposed_ns,
                                                  const SphereLights& lights) {
    virtual_camera::Scene scene;
    scene.lens = ToLens(camera->lens);
    scene.sensor.readout_s = camera->readout_s;
    scene.sensor.exposure_s = 0.001;
    scene.sensor.read_noise_dn = camera->settings.noise.read_dn;
    scene.sensor.dn_per_electron = camera->settings.noise.dn_per_electron;
    for (std::size_t i = 0; i < camera->spheres.size(); ++i)
      scene.balls.push_back(BallOn(*stage, *camera, scene, i, points[i], lights, t_s));
    renderer->Take(scene, exposed_ns);
  };
  return feed;
}

std::string DemoCameraFile() {
  frames::CameraFile camera;
  camera.rate_hz = kDemoRateHz;
  camera.X_WC = Eigen::Isometry3d::Identity();
  camera.X_WC->linear() << 0, 0, -1, 1, 0, 0, 0, -1, 0;  // Looks along -x of W.
  camera.X_WC->translation() << 2.2, 0, 1.2;
  camera.calibrated = "by construction: of a simulated camera";
  const std::array<Eigen::Vector3d, 2> colours = {{{170, 40, 150}, {40, 170, 160}}};
  for (std::size_t i = 0; i < colours.size(); ++i) {
    frames::HeldSphere held;
    held.role = i == 0 ? stream::DeviceRole::kLeftHand : stream::DeviceRole::kRightHand;
    held.target.colour_dn = colours[i];
    camera.spheres.push_back(held);
  }
  return frames::ToJson(camera);
}

}  // namespace footing::stream_client
