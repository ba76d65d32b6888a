#include "clients/stream/boards.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "clients/stream/feeds.h"
#include "clients/stream/rendered_hands.h"
#include "common/body/held_frame.h"
#include "common/virtual/devices/held_device.h"

namespace footing::stream_client {
namespace {

using stream::DeviceRole;
namespace sensors = virtual_sensors;

/// What the cells of one board read; a copy starts from the beginning.
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

/// What a device on that course measures, in its own frame: x left, y front, z down.
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
    plan.devices.push_back(MakeWiimote(common, link, device, role,
                                       motion_of(DeviceSeed(common, device) + 700), {true, false}));
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

}  // namespace footing::stream_client
