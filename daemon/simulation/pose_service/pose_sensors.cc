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

using stream::DeviceRole;

constexpr double kLongestStepS = 0.1;  // Between two ticks.

}  // namespace

PoseArms::PoseArms(std::optional<arms::ArmModel> model,
                   std::optional<arm_network::ArmNetwork> network)
    : model_(std::move(model)), network_(std::move(network)), tracker_(model_, network_) {}

void PoseArms::UseNetwork(bool use) {
  uses_network_ = use;
  tracker_.UseNetwork(use);
}

void PoseArms::Bind(std::size_t side, std::optional<std::uint32_t> device, arms::Place place) {
  Device& bound = devices_[side][static_cast<std::size_t>(place)];
  if (bound.device == device) return;
  bound = {};
  bound.device = device;
  tracker_.Lose(side, place);
}

void PoseArms::Take(const stream::MotionSample& sample, std::int64_t now_ns) {
  for (std::size_t side = 0; side < devices_.size(); ++side) {
    for (std::size_t place = 0; place < arms::kPlaces; ++place) Take(sample, now_ns, side, place);
  }
}

void PoseArms::Take(const stream::MotionSample& sample, std::int64_t now_ns, std::size_t side,
                    std::size_t place) {
  Device& device = devices_[side][place];
  if (device.device != sample.device) return;
  device.heard = {true, now_ns, sample.simulated};
  if (!sample.has_angular_velocity) return;
  const double step_s = NanosecondsToSeconds(sample.sampled_ns - device.sampled_ns);
  const bool first = !device.turned.ever;
  if (!first && step_s <= 0) return;
  device.turned = device.heard;
  device.sampled_ns = sample.sampled_ns;
  const auto where = static_cast<arms::Place>(place);
  if (first || step_s > kTimeoutS) {
    tracker_.Lose(side, where);
    return;
  }
  const Eigen::Vector3d turn_S = sample.angular_velocity_radps + sample.gyroscope_bias_radps;
  tracker_.Add(
      side,
      {body::AsHeld(sample.specific_force_mps2), body::AsHeld(turn_S), sample.clipped_axes != 0},
      step_s, where);
}

void PoseArms::Follow(bool calibrated, double calibration_progress) {
  const bool was_calibrated = std::exchange(calibrated_, calibrated);
  const double before = std::exchange(progress_, calibration_progress);
  if (calibrated && !was_calibrated) {
    tracker_.Align();
  } else if (!calibrated && was_calibrated) {
    tracker_ = arms::ArmTracker(model_, network_);
    tracker_.UseNetwork(uses_network_);
  } else if (!calibrated && (calibration_progress <= 0 || calibration_progress < before)) {
    tracker_.BeginTPose();
  }
}

HandTrouble PoseArms::TroubleOf(std::size_t side, std::size_t place, std::int64_t now_ns) const {
  const Device& device = devices_[side][place];
  if (!device.heard.IsLive(now_ns, kTimeoutS)) return HandTrouble::kSilent;
  if (!device.turned.IsLive(now_ns, kTimeoutS)) return HandTrouble::kNoGyroscope;
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
    const bool can = uses_network_ ? network_.has_value() : model_.has_value();
    trouble = can ? TroubleOf(side, fist, now_ns) : HandTrouble::kNoModel;
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
      inputs.simulated |= inputs.sensors.arms[side].valid && heard[side][place] &&
                          devices_[side][place].heard.simulated;
    }
  }
}

namespace {

/// Attitude at a site, by its index, before its T-pose.
arms::SegmentAttitude Unaligned(std::size_t site) {
  return arms::SegmentAttitude(
      reconstruction::SquatTurnOf(static_cast<reconstruction::BodySite>(site)));
}

}  // namespace

PoseSegments::PoseSegments() {
  for (std::size_t site = 0; site < sensors_.size(); ++site)
    sensors_[site].attitude = Unaligned(site);
}

void PoseSegments::Bind(reconstruction::BodySite site, std::optional<std::uint32_t> device) {
  const auto index = static_cast<std::size_t>(site);
  if (sensors_[index].device == device) return;
  sensors_[index] = Sensor();
  sensors_[index].device = device;
  sensors_[index].attitude = Unaligned(index);
}

void PoseSegments::Take(const stream::MotionSample& sample, std::int64_t now_ns) {
  if (!sample.has_angular_velocity) return;
  for (std::size_t site = 0; site < sensors_.size(); ++site) {
    Sensor& sensor = sensors_[site];
    if (sensor.device != sample.device) continue;
    const bool is_hand = IsHand(static_cast<reconstruction::BodySite>(site));
    if (is_hand && (sample.uncalibrated || sample.gyroscope_uncalibrated)) continue;
    const double step_s = NanosecondsToSeconds(sample.sampled_ns - sensor.sampled_ns);
    const bool first = !sensor.heard.ever;
    if (!first && step_s <= 0) continue;
    sensor.heard = {true, now_ns, sample.simulated};
    sensor.sampled_ns = sample.sampled_ns;
    if (first || step_s > PoseArms::kTimeoutS) {
      sensor.attitude = Unaligned(site);  // Where it has turned meanwhile is not known.
      continue;
    }
    const Eigen::Vector3d turn_S = sample.angular_velocity_radps + sample.gyroscope_bias_radps;
    sensor.attitude.Advance({body::AsHeld(sample.specific_force_mps2), body::AsHeld(turn_S),
                             sample.clipped_axes != 0 || sample.angular_velocity_clipped},
                            step_s, squats_);
  }
}

void PoseSegments::Follow(bool calibrated, double calibration_progress,
                          const momentum::Estimate& body) {
  if (!calibrated) t_pose_height_m_ = 0;
  if (calibrated && body.valid && t_pose_height_m_ == 0) t_pose_height_m_ = body.p_WC_m.z();
  squats_ =
      calibrated && body.valid &&
      arms::IsSquat(body.p_WC_m.z(), t_pose_height_m_, body.feet[0].load_n, body.feet[1].load_n);
  const bool was_calibrated = std::exchange(calibrated_, calibrated);
  const double before = std::exchange(progress_, calibration_progress);
  for (std::size_t site = 0; site < sensors_.size(); ++site) {
    Sensor& sensor = sensors_[site];
    if (calibrated && !was_calibrated) {
      sensor.attitude.Align();
    } else if (!calibrated && was_calibrated) {
      sensor.attitude = Unaligned(site);
    } else if (!calibrated && (calibration_progress <= 0 || calibration_progress < before)) {
      sensor.attitude.BeginTPose();
    }
  }
}

void PoseSegments::Report(std::int64_t now_ns, PoseInputs& inputs) const {
  for (std::size_t site = 0; site < sensors_.size(); ++site) {
    const Sensor& sensor = sensors_[site];
    arms::HandState& turn = inputs.sensors.turns[site];
    turn = sensor.attitude.state();
    const bool live = sensor.heard.IsLive(now_ns, PoseArms::kTimeoutS);
    inputs.turn_awaits[site] = live && !turn.valid;
    turn.valid = turn.valid && live;
    inputs.simulated |= turn.valid && sensor.heard.simulated;
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

/// The identity says that the tracker is not calibrated; none, that it has no frame of its own.
bool IsCalibrated(const stream::HandSample& sample) {
  if (!sample.tracker_pose) return true;
  const stream::TrackerPose& pose = *sample.tracker_pose;
  return !pose.position_m.isZero(0) || !pose.rotation.vec().isZero(0);
}

Eigen::Matrix3d Matrix(const Eigen::Vector3d& sd_m, const Eigen::Vector3d& covariance_m2) {
  Eigen::Matrix3d matrix = sd_m.cwiseAbs2().asDiagonal();
  matrix(0, 1) = matrix(1, 0) = covariance_m2.x();
  matrix(0, 2) = matrix(2, 0) = covariance_m2.y();
  matrix(1, 2) = matrix(2, 1) = covariance_m2.z();
  return matrix;
}

}  // namespace

bool IsSeenInWorld(const stream::HandSample& sample) {
  return sample.confidence > 0 && IsCalibrated(sample);
}

CountedPoint::CountedPoint(const stream::HandSample& sample) : p_W_m(sample.position_m) {
  Eigen::Matrix3d matrix = stream::CovarianceOf(sample);
  matrix /= std::min(1.0, sample.confidence);
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
    if (source.heard.ever && source.tracker == tracker) return source;
  }
  Source& oldest =
      *std::min_element(sources_.begin(), sources_.end(), [](const Source& a, const Source& b) {
        return a.heard.ever != b.heard.ever ? !a.heard.ever : a.heard.at_ns < b.heard.at_ns;
      });
  oldest = {};
  oldest.tracker = tracker;
  return oldest;
}

void TrackedHand::Add(const stream::HandSample& sample, double exposed_s, std::int64_t now_ns) {
  Source& source = SourceOf(sample.tracker);
  source.heard = {true, now_ns, sample.simulated};
  const CountedPoint point(sample);
  source.track.Add(exposed_s, point.p_W_m, point.sd_m, point.covariance_m2);
  if (inertial_ && source.tracker == kSphereTracker)
    inertial_->See(NanosecondsToSeconds(sample.sampled_ns), {point.p_W_m, point.matrix_m2});
}

void TrackedHand::Bind(std::optional<std::uint32_t> move) {
  if (move_ == move) return;
  move_ = move;
  inertial_.reset();
}

void TrackedHand::Feel(const stream::MotionSample& sample) {
  if (move_ != sample.device || !sample.has_angular_velocity || sample.uncalibrated ||
      sample.gyroscope_uncalibrated)
    return;
  if (!inertial_) {
    const double ahead_m = sample.simulated ? 0 : kSphereAheadM;
    inertial_.emplace(Eigen::Vector3d(ahead_m, 0, 0));
  }
  // With the bias that footingd has taken off: the filter follows it itself.
  const Eigen::Vector3d turn_radps = sample.angular_velocity_radps + sample.gyroscope_bias_radps;
  inertial_->Feel(NanosecondsToSeconds(sample.sampled_ns),
                  {body::AsHeld(sample.specific_force_mps2), body::AsHeld(turn_radps),
                   sample.clipped_axes != 0 || sample.angular_velocity_clipped});
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
    if (!source.heard.ever) continue;
    hands[count] = Inertial(source, host_ns);
    if (!hands[count].valid) {
      if (!source.heard.IsLive(now_ns, kPointTimeoutS)) continue;
      hands[count] = source.track.At(NanosecondsToSeconds(now_ns));
    }
    weights[count] = Matrix(hands[count].sd_m, hands[count].covariance_m2).inverse();
    weight += weights[count];
    weighted += weights[count] * hands[count].p_W_m;
    ++count;
    fused.simulated |= source.heard.simulated;
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

void PlaceCells(const stream::BoardPose& pose, const std::optional<stream::BoardGeometry>& geometry,
                momentum::FootLoads& foot) {
  const auto places = board::SensorPlaces(pose, board::GeometryOr(geometry));
  foot.count = places.size();
  for (std::size_t i = 0; i < places.size(); ++i) {
    foot.cells[i].p_WS_m = {places[i].x(), places[i].y(), 0};
  }
}

/// The left and the right one.
using Sides = std::array<DeviceRole, 2>;
constexpr Sides kBoardRoles{DeviceRole::kLeftBoard, DeviceRole::kRightBoard};
constexpr Sides kHandRoles{DeviceRole::kLeftHand, DeviceRole::kRightHand};
constexpr std::array<std::pair<arms::Place, Sides>, 3> kArmRoles{{
    {arms::Place::kFist, kHandRoles},
    {arms::Place::kUpperArm, {DeviceRole::kLeftUpperArm, DeviceRole::kRightUpperArm}},
    {arms::Place::kForearm, {DeviceRole::kLeftForearm, DeviceRole::kRightForearm}},
}};

constexpr std::array<std::pair<reconstruction::BodySite, DeviceRole>, reconstruction::kBodySites>
    kSegmentRoles{{
        {reconstruction::BodySite::kPelvis, DeviceRole::kPelvis},
        {reconstruction::BodySite::kChest, DeviceRole::kTrunk},
        {reconstruction::BodySite::kHead, DeviceRole::kHead},
        {reconstruction::BodySite::kLeftThigh, DeviceRole::kLeftThigh},
        {reconstruction::BodySite::kRightThigh, DeviceRole::kRightThigh},
        {reconstruction::BodySite::kLeftShank, DeviceRole::kLeftLeg},
        {reconstruction::BodySite::kRightShank, DeviceRole::kRightLeg},
        {reconstruction::BodySite::kLeftHand, DeviceRole::kLeftHand},
        {reconstruction::BodySite::kRightHand, DeviceRole::kRightHand},
    }};

/// Other devices lie in a fist at any angle.
bool PointsAheadInTheFist(stream::DeviceKind kind) {
  return kind == stream::DeviceKind::kPsMove || kind == stream::DeviceKind::kWiimote;
}

/// A device of that kind in that role.
std::optional<std::uint32_t> DeviceWith(const rig::Follower& follower, DeviceRole role,
                                        stream::DeviceKind kind) {
  const stream::DeviceStatus* device = follower.With(role);
  if (device == nullptr || device->kind != kind) return std::nullopt;
  return device->device;
}

}  // namespace

PoseSensors::PoseSensors(std::string rig, exchange::Latest<PoseInputs>& out,
                         std::optional<arms::ArmModel> arm,
                         std::optional<arm_network::ArmNetwork> paper_arm)
    : follower_(std::move(rig), stream::DrivingRoles(stream::UserInterface::kBoards)),
      out_(out),
      arms_(std::move(arm), std::move(paper_arm)) {
  Bind();
}

void PoseSensors::Bind() {
  std::size_t attached = 0;
  for (std::size_t side = 0; side < boards_.size(); ++side) {
    const stream::DeviceStatus* device = follower_.With(kBoardRoles[side]);
    Board& board = boards_[side];
    if (device == nullptr || board.device != device->device) board = {};
    if (device != nullptr) board.device = device->device;
    attached += device != nullptr && device->state != stream::DeviceState::kLost ? 1 : 0;
    hands_[side].Bind(DeviceWith(follower_, kHandRoles[side], stream::DeviceKind::kPsMove));
    for (const auto& [place, roles] : kArmRoles) {
      arms_.Bind(side, DeviceWith(follower_, roles[side], stream::DeviceKind::kWiimote), place);
    }
  }
  for (const auto& [site, role] : kSegmentRoles) {
    const stream::DeviceStatus* device = follower_.With(role);
    const bool counts = device != nullptr && (!IsHand(site) || PointsAheadInTheFist(device->kind));
    segments_.Bind(site, counts ? std::optional(device->device) : std::nullopt);
  }
  const stream::BoardLayout layout = follower_.Layout();
  PlaceCells(layout.left, layout.left_geometry, inputs_.sensors.loads.feet[0]);
  PlaceCells(layout.right, layout.right_geometry, inputs_.sensors.loads.feet[1]);
  board_problem_ = board::ProblemWith(layout, attached, follower_.rig());
}

void PoseSensors::TakeBoard(const stream::BoardSample& sample, std::int64_t now_ns) {
  const std::array<double, 4> corners_n{sample.top_left_n, sample.top_right_n, sample.bottom_left_n,
                                        sample.bottom_right_n};
  for (std::size_t side = 0; side < boards_.size(); ++side) {
    Board& board = boards_[side];
    if (board.device != sample.device) continue;
    board.heard = {true, now_ns, sample.simulated};
    board.meter.Add(NanosecondsToSeconds(sample.sampled_ns), corners_n);
    for (std::size_t i = 0; i < corners_n.size(); ++i) {
      inputs_.sensors.loads.feet[side].cells[i].load_n = corners_n[i];
    }
  }
}

void PoseSensors::TakeHand(const stream::HandSample& sample, double age_s, std::int64_t now_ns) {
  if (!IsSeenInWorld(sample)) return;
  for (std::size_t side = 0; side < hands_.size(); ++side) {
    if (sample.role != kHandRoles[side]) continue;
    hands_[side].Add(sample, NanosecondsToSeconds(now_ns) - std::max(0.0, age_s), now_ns);
  }
}

bool PoseSensors::FollowsJointsOf(const std::string& tracker, std::int64_t now_ns) {
  if (tracker != joint_tracker_) {
    if (joint_tracker_heard_.IsLive(now_ns, kHandTimeoutS)) return false;
    joint_tracker_ = tracker;
    joints_ = {};
    joint_tracks_ = reconstruction::JointTracks();
  }
  joint_tracker_heard_ = {true, now_ns, false};
  return true;
}

void PoseSensors::TakeJoint(const stream::HandSample& sample, double age_s, std::int64_t now_ns) {
  if (sample.joint == stream::BodyJoint::kUnspecified) return;
  if (!FollowsJointsOf(sample.tracker, now_ns)) return;
  const std::size_t index = body::IndexOf(sample.joint);
  if (sample.confidence == 0) joints_[index].ever = false;
  if (!IsSeenInWorld(sample)) return;
  joints_[index] = {true, now_ns, sample.simulated};
  const CountedPoint point(sample);
  joint_tracks_[index].Add(NanosecondsToSeconds(now_ns) - std::max(0.0, age_s), point.p_W_m,
                           point.sd_m, point.covariance_m2);
}

void PoseSensors::TakeInsole(const stream::ContactSample& sample, std::int64_t now_ns) {
  if (sample.body == stream::ContactBody::kUnspecified) return;
  // Who has insoles need not have a board.
  if (!follower_.Follows(sample.rig, DeviceRole::kLeftBoard)) return;
  if (sample.cells.empty() || sample.cells.size() > momentum::kMaxCells) return;
  const std::size_t side = sample.body == stream::ContactBody::kLeftFoot ? 0 : 1;
  insoles_[side] = {true, now_ns, sample.simulated};
  reconstruction::InsoleFoot& foot = inputs_.insoles[side];
  foot.count = sample.cells.size();
  for (std::size_t i = 0; i < foot.count; ++i) {
    foot.p_S_m[i] = sample.cells[i].position_m.head<2>();
    foot.load_n[i] = sample.cells[i].load_n;
  }
}

void PoseSensors::DropOld(std::int64_t now_ns) {
  inputs_.simulated = false;
  const auto is_live = [&](const rig::LastHeard& heard, double timeout_s) {
    const bool live = heard.IsLive(now_ns, timeout_s);
    inputs_.simulated |= live && heard.simulated;
    return live;
  };
  for (std::size_t side = 0; side < boards_.size(); ++side) {
    const bool followed = is_live(boards_[side].heard, kBoardTimeoutS) && board_problem_.empty();
    inputs_.sensors.loads.feet[side].valid = followed;
    inputs_.impulses[side] = followed ? boards_[side].meter.impulse() : board::BoardImpulse{};
  }
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
    hand.of_skeleton = joint_tracker_heard_.ever && fused.trackers == std::set{joint_tracker_};
    inputs_.simulated |= fused.simulated;
    trackers.insert(fused.trackers.begin(), fused.trackers.end());
  }
  if (trackers.empty()) return;
  tracker_ = text::Joined(trackers);
}

void PoseSensors::OnTick(const v1::Tick& message, std::int64_t now_ns) {
  if (message.refilled()) return;
  const rig::Tick tick = wire::SensorTick(message);
  const rig::Changes changes = follower_.Take(tick);
  if (changes.devices || changes.setup) Bind();
  if (tick.snapshot) return;
  for (const stream::BoardSample& sample : tick.boards) TakeBoard(sample, now_ns);
  for (const stream::ContactSample& sample : tick.contacts) TakeInsole(sample, now_ns);
  for (const stream::HandSample& sample : tick.hands) {
    if (!follower_.Follows(sample.rig, sample.role)) continue;
    // Both times are footingd's; its clock may be another one than ours.
    const double age_s = NanosecondsToSeconds(tick.host_ns - sample.sampled_ns);
    TakeHand(sample, age_s, now_ns);
    TakeJoint(sample, age_s, now_ns);
  }
  for (const stream::MotionSample& sample : tick.motion) {
    arms_.Take(sample, now_ns);
    segments_.Take(sample, now_ns);
    for (TrackedHand& hand : hands_) hand.Feel(sample);
  }
  DropOld(now_ns);
  ReportHands(now_ns, tick.host_ns);
  arms_.Report(now_ns, inputs_);
  segments_.Report(now_ns, inputs_);
  inputs_.sensor_epoch = tick.epoch;
  inputs_.sensor_sequence = tick.sequence;
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
