#include "tests/clients/view/made_stream.h"

#include <cmath>

#include "common/base/rotation.h"
#include "common/base/units.h"

namespace footing::scene::made {
namespace {

constexpr double kCadenceHz = 1.3;  // Full cycles of both legs.
constexpr double kHalfHipM = 0.10;
constexpr std::int64_t kStartNs = 1'000'000'000'000;
constexpr std::int64_t kDelayNs = 1'000'000;

struct Leg {
  double ahead_m, height_m;
  bool touching;
};

/// A foot that stands for the first half of its cycle and swings forward in the second.
Leg FootAt(double cycles, double stride_m) {
  const double at = cycles - std::floor(cycles);
  if (at < 0.5) return {stride_m * (0.5 - 2 * at), 0.02, true};
  const double swing = 2 * (at - 0.5);
  return {stride_m * (swing - 0.5), 0.02 + 0.22 * std::sin(kPi * swing), false};
}

/// A belief with something on every gauge.
stream::InterfaceState BeliefAt(double time_s, const Wish& wish) {
  stream::InterfaceState state;
  state.interface = wish.interface;
  state.activity = stream::Activity::kAlternate;
  state.gait = wish.gait;
  state.frequency_valid = state.phase_valid = state.turn.valid = true;
  state.frequency_hz = 2 * kCadenceHz;
  state.border_hz = 2;
  state.phase_rad = kPi - 0.2 + 0.15 * std::sin(time_s);
  state.together_rad = DegreesToRadians(75);
  state.forearms.valid = wish.interface == stream::UserInterface::kArm;
  state.forearms.elevation_rad = DegreesToRadians(-12);
  state.forearms.bent_rad = DegreesToRadians(-38);
  state.stick.valid = wish.interface == stream::UserInterface::kJoystick;
  state.stick.x = 0.5;
  state.stick.y = 0.7;
  state.load_valid = wish.interface == stream::UserInterface::kBoards;
  state.left_share = 0.8;
  state.turn.source = stream::TurnSource::kHands;
  state.turn.share = 1.3;
  if (wish.missing_roles != 0) {
    state.missing_roles = wish.missing_roles;
    state.activity = stream::Activity::kAbsent;
    state.gait = stream::Gait::kStep;
    state.frequency_valid = state.phase_valid = state.turn.valid = false;
    state.turn.share = 0;
  }
  return state;
}

CharacterPose PoseAt(double time_s, const Wish& wish) {
  CharacterPose pose;
  pose.character = 1;
  pose.valid = true;
  pose.simulated_input = wish.simulated;
  const double cycles = kCadenceHz * time_s;
  const double x_m = wish.speed_mps * time_s;
  const double hip_m = kHipHeightM + 0.03 * std::cos(4 * kPi * cycles);
  const double stride_m = std::min(wish.speed_mps / (2 * kCadenceHz), 0.85);
  const Eigen::Quaterniond tilt(Eigen::AngleAxisd(0.06, Eigen::Vector3d::UnitY()));
  pose.links.resize(5);
  pose.links[0] = {{x_m, 0, hip_m}, tilt};
  pose.contacts.resize(2);
  for (int leg = 0; leg < 2; ++leg) {
    const double side = leg == 0 ? 1 : -1;
    const Leg foot = FootAt(cycles + 0.5 * leg, stride_m);
    const Eigen::Vector3d hip(x_m, side * kHalfHipM, hip_m);
    const Eigen::Vector3d end(x_m + foot.ahead_m, side * kHalfHipM, foot.height_m);
    const Eigen::Quaterniond turn = LeastTurn(Eigen::Vector3d(0, 0, -1), end - hip);
    pose.links[static_cast<std::size_t>(1 + 2 * leg)] = {hip, turn};
    pose.links[static_cast<std::size_t>(2 + 2 * leg)] = {0.4 * hip + 0.6 * end, turn};
    pose.contacts[static_cast<std::size_t>(leg)] = {foot.touching, end, foot.touching ? 450.0 : 0};
  }
  pose.com_m = {x_m, 0, hip_m};
  pose.com_velocity_mps = {wish.speed_mps, 0, 0};
  pose.gait.gait = wish.gait;
  pose.gait.commanded_gait = wish.missing_roles != 0 ? stream::Gait::kStep : wish.gait;
  pose.gait.speed_mps = wish.speed_mps + 0.05 * std::sin(time_s);
  pose.gait.commanded_speed_mps = wish.speed_mps;
  pose.gait.commanded_turn_rad = DegreesToRadians(5);
  pose.gait.steps = static_cast<std::uint64_t>(2 * cycles);
  pose.gait.distance_m = x_m;
  pose.gait.commanded_by_stream = true;
  pose.interface = BeliefAt(time_s, wish);
  pose.gait.next_foothold_m = {x_m + 0.75, -kHalfHipM};
  static constexpr const char* kPhases[] = {"COMP", "EXT", "UP", "DOWN"};
  pose.phase = kPhases[static_cast<int>(8 * cycles) % 4];
  return pose;
}

std::vector<stream::DeviceStatus> Devices(const Wish& wish) {
  const auto device = [&wish](std::uint32_t number, const char* serial, stream::DeviceKind kind,
                              stream::DeviceRole role, double rate_hz, double battery) {
    stream::DeviceStatus status;
    status.device = number;
    status.serial = serial;
    status.kind = kind;
    status.state = stream::DeviceState::kLive;
    status.rig = "one";
    status.role = role;
    status.simulated = wish.simulated;
    status.report_rate_hz = rate_hz;
    status.battery_fraction = battery;
    return status;
  };
  std::vector<stream::DeviceStatus> devices{
      device(1, "00:1e:35:00:00:01", stream::DeviceKind::kWiimote, stream::DeviceRole::kLeftHand,
             98.7, 0.83),
      device(2, "00:1e:35:00:00:02", stream::DeviceKind::kWiimote, stream::DeviceRole::kRightHand,
             99.2, 0.15)};
  if (wish.board) {
    devices.push_back(device(3, "00:23:cc:00:00:03", stream::DeviceKind::kBalanceBoard,
                             stream::DeviceRole::kLeftBoard, 61.0, -1));
  }
  return devices;
}

void AddMotion(double time_s, const Wish& wish, Update& update) {
  stream::RigFeatures rig;
  rig.rig = "one";
  for (std::uint32_t device = 1; device <= 2; ++device) {
    const double angle = 2 * kPi * 2 * kCadenceHz * time_s + (device == 2 ? kPi : 0);
    stream::MotionSample sample;
    sample.device = device;
    sample.received_ns = update.host_ns - 2'000'000;
    sample.simulated = wish.simulated;
    sample.specific_force_mps2 = {2 * std::sin(angle + 1), 3 * std::cos(angle),
                                  -9.81 + 11 * std::sin(angle) + 0.8 * std::sin(37 * time_s)};
    sample.filtered_mps2 = {2 * std::sin(angle + 1), 3 * std::cos(angle),
                            -9.81 + 11 * std::sin(angle)};
    update.motion.push_back(sample);
    stream::DeviceFeatures features;
    features.device = device;
    features.role = device == 1 ? stream::DeviceRole::kLeftHand : stream::DeviceRole::kRightHand;
    features.moving = time_s > 2;
    features.frequency_valid = time_s > 2.5;
    features.frequency_hz = 2 * kCadenceHz;
    features.amplitude_valid = time_s > 2.5;
    features.amplitude_mps2 = 11.3 + 0.5 * std::sin(time_s);
    features.inclination_valid = true;
    features.roll_rad = 0.25 * std::sin(0.7 * time_s);
    features.pitch_rad = 0.1;
    rig.devices.push_back(features);
  }
  rig.pairs.push_back({1, 2, time_s > 2.5, kPi - 0.2 + 0.15 * std::sin(time_s)});
  update.features.push_back(rig);
}

void AddBoard(double time_s, const Wish& wish, Update& update) {
  stream::BoardSample sample;
  sample.device = 3;
  sample.simulated = wish.simulated;
  const double weight_n = KilogramsToNewtons(72.4);
  const double left = 0.5 + 0.06 * std::sin(0.9 * time_s),
               front = 0.5 + 0.05 * std::cos(1.7 * time_s);
  sample.top_left_n = weight_n * left * front;
  sample.top_right_n = weight_n * (1 - left) * front;
  sample.bottom_left_n = weight_n * left * (1 - front);
  sample.bottom_right_n = weight_n * (1 - left) * (1 - front);
  sample.total_n = weight_n;
  sample.cop_valid = true;
  sample.cop_x_m = 0.433 / 2 * (1 - 2 * left) + 0.01 * std::sin(5 * time_s);
  sample.cop_y_m = 0.238 / 2 * (2 * front - 1) + 0.008 * std::sin(3.1 * time_s);
  sample.contact = true;
  update.boards.push_back(sample);
}

}  // namespace

std::int64_t ClockAt(double time_s) { return kStartNs + SecondsToNanoseconds(time_s) + kDelayNs; }

stream::Track StraightTrack(double length_m) {
  stream::Track track;
  track.name = "straight";
  stream::TrackSegment segment;
  segment.start_m = {-2, 0, 0};
  segment.length_m = length_m;
  segment.width_m = 4;
  track.segments.push_back(segment);
  return track;
}

stream::Skeleton Biped() {
  stream::Skeleton skeleton;
  skeleton.character = 1;
  skeleton.name = "bird";
  skeleton.links = {{"body", -1, {}},
                    {"left_hip", 0, {}},
                    {"left_knee", 1, {}},
                    {"right_hip", 0, {}},
                    {"right_knee", 3, {}}};
  skeleton.contact_points = {"left_foot", "right_foot"};
  return skeleton;
}

Update TickAt(double time_s, const Wish& wish) {
  Update update;
  update.received_ns = ClockAt(time_s);
  update.host_ns = update.received_ns - kDelayNs;
  if (time_s == 0) {
    update.skeletons = {Biped()};
    update.track = StraightTrack(120);
    update.devices = Devices(wish);
  }
  WorldFrame frame;
  frame.time_s = time_s;
  frame.characters.push_back(PoseAt(time_s, wish));
  update.frame = frame;
  AddMotion(time_s, wish, update);
  if (wish.board) AddBoard(time_s, wish, update);
  return update;
}

Model ModelAfter(double seconds, const Wish& wish) {
  Model model;
  model.links = {
      {"unix:/run/user/1000/footing/simulation.sock", "footing-sim", LinkState::kLive, ""},
      {"unix:/run/user/1000/footing/sensor.sock", "footingd", LinkState::kLive, ""}};
  const auto ticks = static_cast<int>(100 * seconds);
  for (int tick = 0; tick <= ticks; ++tick) Apply(model, TickAt(0.01 * tick, wish));
  Note response;
  response.kind = NoteKind::kResponse;
  response.response = {stream::Gait::kWalk, stream::Gait::kRun, 1'000'000,   1'400'000,  3'000'000,
                       4'100'000,           5'000'000,          182'000'000, 190'000'000};
  model.last.response = response;
  return model;
}

}  // namespace footing::scene::made
