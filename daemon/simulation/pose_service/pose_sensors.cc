#include "daemon/simulation/pose_service/pose_sensors.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <Eigen/Dense>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/board/geometry.h"
#include "common/board/layout.h"
#include "common/body/skeleton.h"
#include "common/body/skeleton_points.h"
#include "common/wire/wire.h"

namespace footing::pose_service {
namespace {

constexpr double kLongestStepS = 0.1;  // Between two ticks.

bool IsOld(std::int64_t seen_ns, std::int64_t now_ns) {
  return NanosecondsToSeconds(now_ns - seen_ns) > PoseArms::kTimeoutS;
}

}  // namespace

PoseArms::PoseArms(std::optional<arms::ArmModel> model)
    : model_(std::move(model)), tracker_(model_) {}

void PoseArms::Bind(std::size_t side, std::optional<std::uint32_t> device, arms::Place place) {
  Device& bound = devices_[side][static_cast<std::size_t>(place)];
  if (bound.device == device) return;
  bound = {};
  bound.device = device;
  tracker_.Lose(side, place);
}

void PoseArms::Take(const v1::MotionSample& sample, std::int64_t now_ns) {
  for (std::size_t side = 0; side < devices_.size(); ++side) {
    for (std::size_t place = 0; place < arms::kPlaces; ++place) Take(sample, now_ns, side, place);
  }
}

void PoseArms::Take(const v1::MotionSample& sample, std::int64_t now_ns, std::size_t side,
                    std::size_t place) {
  Device& device = devices_[side][place];
  if (device.device != sample.device()) return;
  device.seen = true;
  device.seen_ns = now_ns;
  device.simulated = sample.simulated();
  if (!sample.has_angular_velocity_radps()) return;
  const double step_s = NanosecondsToSeconds(sample.sampled_ns() - device.sampled_ns);
  const bool first = !device.turns;
  if (!first && step_s <= 0) return;
  device.turns = true;
  device.turned_ns = now_ns;
  device.sampled_ns = sample.sampled_ns();
  const auto where = static_cast<arms::Place>(place);
  if (first || step_s > kTimeoutS) {
    tracker_.Lose(side, where);
    return;
  }
  const Eigen::Vector3d turn_S = wire::FromProto(sample.angular_velocity_radps()) +
                                 wire::FromProto(sample.gyroscope_bias_radps());
  tracker_.Add(side,
               {body::AsHeld(wire::FromProto(sample.specific_force_mps2())), body::AsHeld(turn_S),
                sample.clipped_axes() != 0},
               step_s, where);
}

void PoseArms::Follow(bool calibrated, double calibration_progress) {
  const bool was_calibrated = std::exchange(calibrated_, calibrated);
  const double before = std::exchange(progress_, calibration_progress);
  if (calibrated && !was_calibrated) {
    tracker_.Align();
  } else if (!calibrated && was_calibrated) {
    tracker_ = arms::ArmTracker(model_);
  } else if (!calibrated && (calibration_progress <= 0 || calibration_progress < before)) {
    tracker_.BeginTPose();
  }
}

HandTrouble PoseArms::TroubleOf(std::size_t side, std::size_t place, std::int64_t now_ns) const {
  const Device& device = devices_[side][place];
  if (!device.seen || IsOld(device.seen_ns, now_ns)) return HandTrouble::kSilent;
  if (!device.turns || IsOld(device.turned_ns, now_ns)) return HandTrouble::kNoGyroscope;
  return calibrated_ && !tracker_.hand(side, static_cast<arms::Place>(place)).valid
             ? HandTrouble::kAwaitsTPose
             : HandTrouble::kNone;
}

HandTrouble PoseArms::TroubleOf(std::size_t side, std::int64_t now_ns) const {
  const auto& devices = devices_[side];
  const auto fist = static_cast<std::size_t>(arms::Place::kFist);
  const auto upper = static_cast<std::size_t>(arms::Place::kUpperArm);
  const auto forearm = static_cast<std::size_t>(arms::Place::kForearm);
  HandTrouble trouble = HandTrouble::kNone;
  if (devices[fist].device) {
    trouble = model_ ? TroubleOf(side, fist, now_ns) : HandTrouble::kNoModel;
    if (trouble == HandTrouble::kNone) return trouble;
  }
  if (!devices[upper].device && !devices[forearm].device) return trouble;
  if (!devices[upper].device || !devices[forearm].device) {
    return trouble == HandTrouble::kNone ? HandTrouble::kOneStrap : trouble;
  }
  const HandTrouble of_upper = TroubleOf(side, upper, now_ns);
  return of_upper != HandTrouble::kNone ? of_upper : TroubleOf(side, forearm, now_ns);
}

void PoseArms::Report(std::int64_t now_ns, PoseInputs& inputs) {
  const double step_s = std::clamp(NanosecondsToSeconds(now_ns - reported_ns_), 0.0, kLongestStepS);
  reported_ns_ = now_ns;
  arms::Heard heard;
  for (std::size_t side = 0; side < devices_.size(); ++side) {
    for (std::size_t place = 0; place < arms::kPlaces; ++place) {
      heard[side][place] = devices_[side][place].device.has_value() &&
                           TroubleOf(side, place, now_ns) == HandTrouble::kNone;
    }
  }
  inputs.sensors.arms = tracker_.Advance(step_s, heard);
  for (std::size_t side = 0; side < devices_.size(); ++side) {
    inputs.hand_trouble[side] = TroubleOf(side, now_ns);
    for (std::size_t place = 0; place < arms::kPlaces; ++place) {
      inputs.simulated |=
          inputs.sensors.arms[side].valid && heard[side][place] && devices_[side][place].simulated;
    }
  }
}

namespace {

/// A tracker that says less of itself is not believed.
constexpr double kLeastPointSdM = 0.002;
constexpr double kMostPointSdM = 1;
/// The name of the tracker that sees the Moves' spheres.
constexpr char kSphereTracker[] = "camera";
/// From a Move's inertial sensors to the middle of its sphere: 9 cm to the end of the handle
/// (Monado's driver) and the sphere's radius. The simulated body holds its spheres in the middle of
/// its fists, where its devices measure.
constexpr double kSphereAheadM = 0.09 + 0.0225;

bool IsFinite(const v1::Vector3& v) {
  return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}

/// The identity says that the tracker is not calibrated; none, that it has no frame of its own.
bool IsCalibrated(const v1::HandSample& sample) {
  if (!sample.has_tracker_pose()) return true;
  const v1::TrackerPose& pose = sample.tracker_pose();
  return pose.x_m() != 0 || pose.y_m() != 0 || pose.z_m() != 0 || pose.qx() != 0 ||
         pose.qy() != 0 || pose.qz() != 0;
}

Eigen::Matrix3d Matrix(const Eigen::Vector3d& sd_m, const Eigen::Vector3d& covariance_m2) {
  Eigen::Matrix3d matrix = sd_m.cwiseAbs2().asDiagonal();
  matrix(0, 1) = matrix(1, 0) = covariance_m2.x();
  matrix(0, 2) = matrix(2, 0) = covariance_m2.y();
  matrix(1, 2) = matrix(2, 1) = covariance_m2.z();
  return matrix;
}

}  // namespace

bool IsSeenInWorld(const v1::HandSample& sample) {
  return sample.confidence() > 0 && IsFinite(sample.position_m()) && IsFinite(sample.sd_m()) &&
         IsFinite(sample.covariance_m2()) && IsCalibrated(sample);
}

CountedPoint::CountedPoint(const v1::HandSample& sample)
    : p_W_m(wire::FromProto(sample.position_m())) {
  Eigen::Matrix3d matrix =
      Matrix(wire::FromProto(sample.sd_m()), wire::FromProto(sample.covariance_m2()));
  matrix /= std::min(1.0, sample.confidence());
  sd_m = matrix.diagonal().cwiseMax(0).cwiseSqrt().cwiseMax(kLeastPointSdM);
  covariance_m2 = {matrix(0, 1), matrix(0, 2), matrix(1, 2)};
  matrix_m2 = matrix;
  // Scaled as a whole, so that it stays a covariance.
  const double scale = std::min(1.0, kMostPointSdM / sd_m.maxCoeff());
  sd_m = (scale * sd_m).cwiseMax(kLeastPointSdM);
  covariance_m2 *= scale * scale;
}

TrackedHand::Source& TrackedHand::SourceOf(const std::string& tracker) {
  for (Source& source : sources_) {
    if (source.used && source.tracker == tracker) return source;
  }
  Source& oldest =
      *std::min_element(sources_.begin(), sources_.end(), [](const Source& a, const Source& b) {
        return a.used != b.used ? !a.used : a.seen_ns < b.seen_ns;
      });
  oldest = {};
  oldest.used = true;
  oldest.tracker = tracker;
  return oldest;
}

void TrackedHand::Add(const v1::HandSample& sample, double exposed_s, std::int64_t now_ns) {
  Source& source = SourceOf(sample.tracker());
  source.seen_ns = now_ns;
  source.simulated = sample.simulated();
  const CountedPoint point(sample);
  source.track.Add(exposed_s, point.p_W_m, point.sd_m, point.covariance_m2);
  if (inertial_ && source.tracker == kSphereTracker)
    inertial_->See(NanosecondsToSeconds(sample.sampled_ns()), {point.p_W_m, point.matrix_m2});
}

void TrackedHand::Bind(std::optional<std::uint32_t> move) {
  if (move_ == move) return;
  move_ = move;
  inertial_.reset();
}

void TrackedHand::Feel(const v1::MotionSample& sample) {
  if (move_ != sample.device() || !sample.has_angular_velocity_radps() || sample.uncalibrated() ||
      sample.gyroscope_uncalibrated())
    return;
  if (!inertial_) {
    const double ahead_m = sample.simulated() ? 0 : kSphereAheadM;
    inertial_.emplace(Eigen::Vector3d(ahead_m, 0, 0));
  }
  // With the bias that footingd has taken off: the filter follows it itself.
  const Eigen::Vector3d turn_radps = wire::FromProto(sample.angular_velocity_radps()) +
                                     wire::FromProto(sample.gyroscope_bias_radps());
  inertial_->Feel(
      NanosecondsToSeconds(sample.sampled_ns()),
      {body::AsHeld(wire::FromProto(sample.specific_force_mps2())), body::AsHeld(turn_radps),
       sample.clipped_axes() != 0 || sample.angular_velocity_clipped()});
}

reconstruction::HandInput TrackedHand::Inertial(const Source& source, std::int64_t host_ns) const {
  reconstruction::HandInput hand;
  if (!inertial_ || source.tracker != kSphereTracker) return hand;
  const inertial::Track::State state = inertial_->At(NanosecondsToSeconds(host_ns));
  hand.valid = state.valid;
  hand.p_W_m = state.p_W_m;
  hand.sd_m = state.covariance.diagonal().head<3>().cwiseSqrt().cwiseMax(kLeastPointSdM);
  hand.covariance_m2 = {state.covariance(0, 1), state.covariance(0, 2), state.covariance(1, 2)};
  return hand;
}

TrackedHand::Fused TrackedHand::At(std::int64_t now_ns, std::int64_t host_ns) const {
  Fused fused;
  std::array<reconstruction::HandInput, kMostTrackers> hands;
  std::array<Eigen::Matrix3d, kMostTrackers> weights;
  std::size_t count = 0;
  Eigen::Matrix3d weight = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
  for (const Source& source : sources_) {
    if (!source.used) continue;
    hands[count] = Inertial(source, host_ns);
    if (!hands[count].valid) {
      if (NanosecondsToSeconds(now_ns - source.seen_ns) > kPointTimeoutS) continue;
      hands[count] = source.track.At(NanosecondsToSeconds(now_ns));
    }
    weights[count] = Matrix(hands[count].sd_m, hands[count].covariance_m2).inverse();
    weight += weights[count];
    weighted += weights[count] * hands[count].p_W_m;
    ++count;
    fused.simulated |= source.simulated;
    fused.trackers.insert(source.tracker);
  }
  if (count == 0) return fused;
  fused.hand = hands[0];
  const Eigen::Matrix3d covariance = weight.inverse();
  if (count == 1 || !covariance.allFinite()) return fused;
  fused.hand.p_W_m = covariance * weighted;
  double squares = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d off_m = hands[i].p_W_m - fused.hand.p_W_m;
    squares += off_m.dot(weights[i] * off_m);
  }
  const double ratio = std::max(1.0, squares / (3 * static_cast<double>(count - 1)));
  fused.hand.sd_m = (ratio * covariance.diagonal()).cwiseSqrt();
  fused.hand.covariance_m2 =
      ratio * Eigen::Vector3d(covariance(0, 1), covariance(0, 2), covariance(1, 2));
  return fused;
}

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
