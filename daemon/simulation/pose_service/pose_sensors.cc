#include "daemon/simulation/pose_service/pose_sensors.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "common/board/geometry.h"
#include "common/board/layout.h"
#include "common/body/skeleton_points.h"
#include "common/base/joined.h"
#include "common/base/units.h"
#include "common/wire/wire.h"

namespace footing::pose_service {
namespace {

bool IsOld(std::int64_t seen_ns, std::int64_t now_ns, double timeout_s) {
  return NanosecondsToSeconds(now_ns - seen_ns) > timeout_s;
}

void PlaceCells(const stream::BoardPose& pose, const std::optional<stream::BoardGeometry>& geometry,
                momentum::FootLoads& foot) {
  const auto places = board::SensorPlaces(pose, board::GeometryOr(geometry));
  foot.count = places.size();
  for (std::size_t i = 0; i < places.size(); ++i) {
    foot.cells[i].p_WS_m = {places[i].x(), places[i].y(), 0};
  }
}

/// 0 left, 1 right; -1: another role.
int SideOf(v1::DeviceRole role, v1::DeviceRole left, v1::DeviceRole right) {
  return role == left ? 0 : role == right ? 1 : -1;
}

int BoardSideOf(v1::DeviceRole role) {
  return SideOf(role, v1::DEVICE_ROLE_LEFT_BOARD, v1::DEVICE_ROLE_RIGHT_BOARD);
}

int HandSideOf(v1::DeviceRole role) {
  return SideOf(role, v1::DEVICE_ROLE_LEFT_HAND, v1::DEVICE_ROLE_RIGHT_HAND);
}

struct ArmRoles {
  arms::Place place;
  v1::DeviceRole left, right;
};
constexpr ArmRoles kArmRoles[] = {
    {arms::Place::kFist, v1::DEVICE_ROLE_LEFT_HAND, v1::DEVICE_ROLE_RIGHT_HAND},
    {arms::Place::kUpperArm, v1::DEVICE_ROLE_LEFT_UPPER_ARM, v1::DEVICE_ROLE_RIGHT_UPPER_ARM},
    {arms::Place::kForearm, v1::DEVICE_ROLE_LEFT_FOREARM, v1::DEVICE_ROLE_RIGHT_FOREARM}};

}  // namespace

PoseSensors::PoseSensors(std::string rig, exchange::Latest<PoseInputs>& out,
                         std::optional<arms::ArmModel> arm)
    : wanted_rig_(std::move(rig)), followed_rig_(wanted_rig_), out_(out), arms_(std::move(arm)) {
  Place({});
}

void PoseSensors::Bind(const v1::DeviceStatusList& status) {
  for (const v1::DeviceStatus& device : status.devices()) {
    if (followed_rig_.empty() && BoardSideOf(device.role()) >= 0) followed_rig_ = device.rig();
  }
  std::array<Board, momentum::kFeet> boards{};
  for (const v1::DeviceStatus& device : status.devices()) {
    if (device.rig() != followed_rig_) continue;
    const int side = BoardSideOf(device.role());
    if (side < 0) continue;
    Board& board = boards[static_cast<std::size_t>(side)];
    const Board& before = boards_[static_cast<std::size_t>(side)];
    if (before.bound && before.device == device.device()) board = before;
    board.bound = true;
    board.attached = device.state() != v1::DEVICE_STATE_LOST;
    board.device = device.device();
  }
  boards_ = boards;
  CheckLayout();
  BindArms(status);
  BindMoves(status);
}

void PoseSensors::BindMoves(const v1::DeviceStatusList& status) {
  std::array<std::optional<std::uint32_t>, reconstruction::kHands> moves;
  for (const v1::DeviceStatus& device : status.devices()) {
    const int side = HandSideOf(device.role());
    if (side >= 0 && device.rig() == followed_rig_ && device.kind() == v1::DEVICE_KIND_PS_MOVE)
      moves[static_cast<std::size_t>(side)] = device.device();
  }
  for (std::size_t side = 0; side < moves.size(); ++side) hands_[side].Bind(moves[side]);
}

void PoseSensors::BindArms(const v1::DeviceStatusList& status) {
  for (const ArmRoles& roles : kArmRoles) {
    std::array<std::optional<std::uint32_t>, reconstruction::kHands> wiimotes;
    for (const v1::DeviceStatus& device : status.devices()) {
      const int side = SideOf(device.role(), roles.left, roles.right);
      if (side < 0 || device.rig() != followed_rig_ || device.kind() != v1::DEVICE_KIND_WIIMOTE)
        continue;
      wiimotes[static_cast<std::size_t>(side)] = device.device();
    }
    for (std::size_t side = 0; side < wiimotes.size(); ++side)
      arms_.Bind(side, wiimotes[side], roles.place);
  }
}

void PoseSensors::CheckLayout() {
  const auto attached = std::count_if(boards_.begin(), boards_.end(),
                                      [](const Board& board) { return board.attached; });
  board_problem_ = board::ProblemWith(layout_, static_cast<std::size_t>(attached), followed_rig_);
}

void PoseSensors::Place(const v1::SetupState& setup) {
  stream::BoardLayout layout;
  for (const v1::RigSetup& message : setup.rigs()) {
    if (message.rig() == followed_rig_) layout = wire::FromProto(message).layout;
  }
  layout_ = board::LayoutOr(layout);
  PlaceCells(layout_.left, layout_.left_geometry, inputs_.sensors.loads.feet[0]);
  PlaceCells(layout_.right, layout_.right_geometry, inputs_.sensors.loads.feet[1]);
  CheckLayout();
}

void PoseSensors::TakeBoard(const v1::BoardSample& sample, std::int64_t now_ns) {
  const std::array<double, 4> corners_n{sample.top_left_n(), sample.top_right_n(),
                                        sample.bottom_left_n(), sample.bottom_right_n()};
  for (const double corner_n : corners_n) {
    if (!std::isfinite(corner_n)) return;
  }
  for (std::size_t side = 0; side < boards_.size(); ++side) {
    Board& board = boards_[side];
    if (!board.bound || board.device != sample.device()) continue;
    board.seen = true;
    board.seen_ns = now_ns;
    board.simulated = sample.simulated();
    board.meter.Add(NanosecondsToSeconds(sample.sampled_ns()), corners_n);
    for (std::size_t i = 0; i < corners_n.size(); ++i) {
      inputs_.sensors.loads.feet[side].cells[i].load_n = corners_n[i];
    }
  }
}

void PoseSensors::TakeHand(const v1::HandSample& sample, double age_s, std::int64_t now_ns) {
  const int side = HandSideOf(sample.role());
  if (side < 0 || sample.rig() != followed_rig_ || !IsSeenInWorld(sample)) return;
  hands_[static_cast<std::size_t>(side)].Add(
      sample, NanosecondsToSeconds(now_ns) - std::max(0.0, age_s), now_ns);
}

bool PoseSensors::FollowsJointsOf(const std::string& tracker, std::int64_t now_ns) {
  if (tracker != joint_tracker_) {
    if (joint_tracker_ns_ != 0 && !IsOld(joint_tracker_ns_, now_ns, kHandTimeoutS)) return false;
    joint_tracker_ = tracker;
    joints_ = {};
    joint_tracks_ = reconstruction::JointTracks();
  }
  joint_tracker_ns_ = now_ns;
  return true;
}

void PoseSensors::TakeJoint(const v1::HandSample& sample, double age_s, std::int64_t now_ns) {
  const auto joint = wire::FromProto(sample).joint;
  if (joint == stream::BodyJoint::kUnspecified || sample.rig() != followed_rig_) return;
  if (!FollowsJointsOf(sample.tracker(), now_ns)) return;
  const std::size_t index = body::IndexOf(joint);
  if (sample.confidence() == 0) joints_[index].seen = false;
  if (!IsSeenInWorld(sample)) return;
  joints_[index] = {true, now_ns, sample.simulated()};
  const CountedPoint point(sample);
  joint_tracks_[index].Add(NanosecondsToSeconds(now_ns) - std::max(0.0, age_s), point.p_W_m,
                           point.sd_m, point.covariance_m2);
}

void PoseSensors::TakeInsole(const v1::ContactSample& sample, std::int64_t now_ns) {
  const bool left = sample.body() == v1::CONTACT_BODY_LEFT_FOOT;
  if (!left && sample.body() != v1::CONTACT_BODY_RIGHT_FOOT) return;
  if (followed_rig_.empty()) followed_rig_ = sample.rig();
  if (sample.rig() != followed_rig_) return;
  if (sample.cells_size() < 1 || sample.cells_size() > static_cast<int>(momentum::kMaxCells))
    return;
  for (const v1::ContactCell& cell : sample.cells()) {
    if (!std::isfinite(cell.x_m()) || !std::isfinite(cell.y_m()) || !std::isfinite(cell.load_n()))
      return;
  }
  insoles_[left ? 0 : 1] = {true, now_ns, sample.simulated()};
  reconstruction::InsoleFoot& foot = inputs_.insoles[left ? 0 : 1];
  foot.count = static_cast<std::size_t>(sample.cells_size());
  for (std::size_t i = 0; i < foot.count; ++i) {
    const v1::ContactCell& cell = sample.cells(static_cast<int>(i));
    foot.p_S_m[i] = {cell.x_m(), cell.y_m()};
    foot.load_n[i] = cell.load_n();
  }
}

void PoseSensors::DropOld(std::int64_t now_ns) {
  inputs_.simulated = false;
  for (std::size_t side = 0; side < boards_.size(); ++side) {
    Board& board = boards_[side];
    if (board.seen && IsOld(board.seen_ns, now_ns, kBoardTimeoutS)) board.seen = false;
    const bool followed = board.seen && board_problem_.empty();
    inputs_.sensors.loads.feet[side].valid = followed;
    inputs_.impulses[side] = followed ? board.meter.impulse() : board::BoardImpulse{};
    inputs_.simulated |= board.seen && board.simulated;
  }
  const auto is_live = [&](BodySource& source, double timeout_s) {
    if (source.seen && IsOld(source.seen_ns, now_ns, timeout_s)) source.seen = false;
    inputs_.simulated |= source.seen && source.simulated;
    return source.seen;
  };
  for (std::size_t side = 0; side < insoles_.size(); ++side) {
    inputs_.insoles[side].valid = is_live(insoles_[side], kInsoleTimeoutS);
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const bool seen = is_live(joints_[i], kHandTimeoutS);
    if (seen) inputs_.sensors.joints[i] = joint_tracks_[i].At(NanosecondsToSeconds(now_ns));
    inputs_.sensors.joints[i].valid = seen;
  }
}

void PoseSensors::ReportHands(std::int64_t now_ns, std::int64_t host_ns) {
  std::set<std::string> trackers;
  for (std::size_t side = 0; side < hands_.size(); ++side) {
    const TrackedHand::Fused fused = hands_[side].At(now_ns, host_ns);
    reconstruction::HandInput& hand = inputs_.sensors.hands[side];
    if (fused.hand.valid) hand = fused.hand;
    hand.valid = fused.hand.valid;
    hand.of_skeleton = joint_tracker_ns_ != 0 && fused.trackers == std::set{joint_tracker_};
    inputs_.simulated |= fused.simulated;
    trackers.insert(fused.trackers.begin(), fused.trackers.end());
  }
  if (trackers.empty()) return;
  tracker_ = text::Joined(trackers);
}

void PoseSensors::OnTick(const v1::Tick& tick, std::int64_t now_ns) {
  if (tick.refilled()) return;
  const std::string rig_before = followed_rig_;
  if (tick.has_status()) Bind(tick.status());
  if (tick.has_setup()) setup_ = tick.setup();
  // Which rig is followed may be known after its set-up was published.
  if (tick.has_setup() || followed_rig_ != rig_before) Place(setup_);
  if (tick.snapshot()) return;
  for (const v1::BoardSample& sample : tick.boards().samples()) TakeBoard(sample, now_ns);
  for (const v1::ContactSample& sample : tick.contacts().samples()) TakeInsole(sample, now_ns);
  for (const v1::HandSample& sample : tick.hands().samples()) {
    // Both times are footingd's; its clock may be another one than ours.
    const double age_s = NanosecondsToSeconds(tick.host_ns() - sample.sampled_ns());
    TakeHand(sample, age_s, now_ns);
    TakeJoint(sample, age_s, now_ns);
  }
  for (const v1::MotionSample& sample : tick.motion().samples()) {
    arms_.Take(sample, now_ns);
    for (TrackedHand& hand : hands_) hand.Feel(sample);
  }
  DropOld(now_ns);
  ReportHands(now_ns, tick.host_ns());
  arms_.Report(now_ns, inputs_);
  inputs_.sensor_epoch = tick.epoch();
  inputs_.sensor_sequence = tick.sequence();
  out_.Write(inputs_);
}

void PoseSensors::Calibrate() {
  ++inputs_.calibrate_number;
  out_.Write(inputs_);
}

void PoseSensors::TakeSubject(std::uint64_t number) {
  inputs_.subject_number = number;
  out_.Write(inputs_);
}

}  // namespace footing::pose_service
