#include "daemon/offline/learning/own_take.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

#include "common/base/result.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/devices/noise.h"
#include "common/virtual/devices/scene.h"
#include "common/virtual/motion/edit.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::learning {
namespace {

constexpr int kRounds = 8;
constexpr double kOutlierMedians = 2.5;  // Limit in multiples of the median distance.

Eigen::Matrix2d Turn(double yaw_rad) {
  return body::AxisRotation(body::Axis::kZ, yaw_rad).topLeftCorner<2, 2>();
}

FloorPlacement Fit(const Eigen::Matrix2Xd& from, const Eigen::Matrix2Xd& to,
                   const std::vector<Eigen::Index>& counts) {
  const Eigen::Matrix2Xd a = from(Eigen::all, counts), b = to(Eigen::all, counts);
  const Eigen::Vector2d a_mean = a.rowwise().mean(), b_mean = b.rowwise().mean();
  const Eigen::Matrix2d moment = (b.colwise() - b_mean) * (a.colwise() - a_mean).transpose();
  FloorPlacement placement;
  placement.yaw_rad = std::atan2(moment(1, 0) - moment(0, 1), moment(0, 0) + moment(1, 1));
  placement.shift_m = b_mean - Turn(placement.yaw_rad) * a_mean;
  return placement;
}

}  // namespace

FloorPlacement PlaceFloor(const Eigen::Matrix2Xd& from, const Eigen::Matrix2Xd& to) {
  FOOTING_CHECK(from.cols() == to.cols() && from.cols() >= 3);
  std::vector<Eigen::Index> counts(static_cast<std::size_t>(from.cols()));
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = static_cast<Eigen::Index>(i);
  FloorPlacement placement = Fit(from, to, counts);
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::Matrix2Xd moved = (Turn(placement.yaw_rad) * from).colwise() + placement.shift_m;
    const Eigen::VectorXd off_m = (moved - to).colwise().norm();
    const double median_m = text::Median({off_m.begin(), off_m.end()});
    counts.clear();
    double squares = 0;
    for (Eigen::Index i = 0; i < off_m.size(); ++i) {
      if (off_m(i) > kOutlierMedians * median_m + 1e-9) continue;
      counts.push_back(i);
      squares += off_m(i) * off_m(i);
    }
    placement = Fit(from, to, counts);
    placement.points = std::ssize(counts);
    placement.rms_m = std::sqrt(squares / static_cast<double>(counts.size()));
  }
  return placement;
}

motion::Motion Placed(const motion::Motion& motion, const FloorPlacement& placement) {
  motion::Motion placed = motion;
  const Eigen::Matrix3d R = body::AxisRotation(body::Axis::kZ, placement.yaw_rad);
  const Eigen::Vector3d shift_m(placement.shift_m.x(), placement.shift_m.y(), 0);
  const body::Joint& root = motion.skeleton.joint(0);
  for (Eigen::Index t = 0; t < motion.frames(); ++t) {
    const Eigen::Matrix3d R_WJ = body::JointRotation(root, motion.q.col(t));
    body::SetJointRotation(root, R * R_WJ, placed.q.col(t));
    placed.q.col(t).head<3>() = R * motion.q.col(t).head<3>() + shift_m;
  }
  return motion::Continuous(std::move(placed));
}

namespace {

namespace sensors = virtual_sensors;

constexpr double kPairRateHz = 20;
constexpr double kLoadedShare = 0.15;  // Least share of the weight on a foot whose place counts.
constexpr Eigen::Index kFewestPairs = 100;
constexpr double kMostYawRad = DegreesToRadians(60);
constexpr double kMostOffM = 0.1;

/// Ground reaction of a motion.
struct Felt {
  ForceTrace trace;
  std::array<Eigen::Matrix2Xd, 2> cop_m;  ///< A column a frame, as the trace.
};

Felt Feel(const body::Body& body, const motion::Motion& motion, const std::string& name) {
  const sensors::BodyCourse course = sensors::Follow(body, motion);
  const sensors::GroundReaction reaction = sensors::React(course);
  Felt felt;
  felt.trace.name = name;
  felt.trace.rate_hz = motion.rate_hz;
  felt.trace.weight_n = KilogramsToNewtons(body.mass_kg);
  felt.trace.load_n.resize(2, course.frames());
  felt.trace.valid.assign(static_cast<std::size_t>(course.frames()), true);
  for (auto& cop_m : felt.cop_m) cop_m.resize(2, course.frames());
  for (Eigen::Index i = 0; i < course.frames(); ++i) {
    const auto feet = sensors::ShareBetweenFeet(course, reaction, i);
    for (std::size_t f = 0; f < feet.size(); ++f) {
      felt.trace.load_n(static_cast<Eigen::Index>(f), i) = feet[f].load_n;
      felt.cop_m[f].col(i) = feet[f].cop_m;
    }
  }
  return felt;
}

/// Where each loaded foot presses in the motion, and where its board was pressed then.
std::pair<Eigen::Matrix2Xd, Eigen::Matrix2Xd> PressedPlaces(const RecordedSession& session,
                                                            const Felt& felt,
                                                            const TimeAlignment& alignment) {
  const double least_n = kLoadedShare * felt.trace.weight_n;
  const double step = std::max(1.0, felt.trace.rate_hz / kPairRateHz);
  std::vector<Eigen::Vector2d> from, to;
  for (double at = 0; at < static_cast<double>(felt.trace.load_n.cols()); at += step) {
    const auto i = static_cast<Eigen::Index>(at);
    const auto loads =
        LoadsAt(session, alignment.ToRecording(static_cast<double>(i) / felt.trace.rate_hz));
    for (std::size_t f = 0; f < momentum::kFeet; ++f) {
      const auto pressure = momentum::PressureOf(loads.feet[f], least_n);
      if (!pressure.cop_valid || felt.trace.load_n(static_cast<Eigen::Index>(f), i) < least_n) {
        continue;
      }
      from.emplace_back(felt.cop_m[f].col(i));
      to.emplace_back(pressure.p_WP_m.head<2>());
    }
  }
  std::pair<Eigen::Matrix2Xd, Eigen::Matrix2Xd> places;
  places.first.resize(2, std::ssize(from));
  places.second.resize(2, std::ssize(to));
  for (Eigen::Index i = 0; i < std::ssize(from); ++i) {
    places.first.col(i) = from[static_cast<std::size_t>(i)];
    places.second.col(i) = to[static_cast<std::size_t>(i)];
  }
  return places;
}

Result<FloorPlacement> PlaceFeet(const RecordedSession& session, const Felt& felt,
                                 const TimeAlignment& alignment) {
  const auto [from, to] = PressedPlaces(session, felt, alignment);
  const std::string both = session.name + " and " + felt.trace.name;
  if (from.cols() < kFewestPairs) {
    return InvalidData(both + ": feet stand on the boards in less than " +
                       std::to_string(static_cast<int>(kFewestPairs / kPairRateHz / 2)) +
                       " s of what both have");
  }
  const FloorPlacement placement = PlaceFloor(from, to);
  if (std::abs(placement.yaw_rad) <= kMostYawRad && placement.rms_m <= kMostOffM) return placement;
  std::ostringstream text;
  text.precision(2);
  text << both << ": the boards do not lie where the feet stand (turned by "
       << RadiansToDegrees(placement.yaw_rad) << " degrees, " << 100 * placement.rms_m
       << " cm off): were left and right changed, or the layout not set (footing-ctl layout)?";
  return InvalidData(text.str());
}

}  // namespace

Result<OwnTake> MakeOwnTake(RecordedSession session, motion::Motion motion,
                            const body::Body& person, const std::string& motion_name) {
  const auto t_pose = FindTPose(session);
  if (!t_pose) {
    std::ostringstream text;
    text.precision(3);
    text << session.name << ": nobody stands still on both boards for "
         << momentum::TPoseCalibration::kSeconds << " s in its " << session.duration_s
         << " s; record again and begin with the T-pose";
    return InvalidData(text.str());
  }
  motion = motion::FacingForward(motion::Continuous(std::move(motion)), person.landmarks);
  motion.q.row(2).array() -= motion::FloorHeight(motion, person.landmarks);
  OwnTake take;
  take.t_pose = *t_pose;
  take.body = body::WithMass(person, t_pose->mass_kg);
  const Felt felt = Feel(take.body, motion, motion_name);
  const auto alignment =
      AlignInTime(TraceOf(session, KilogramsToNewtons(t_pose->mass_kg)), felt.trace);
  if (!alignment) return alignment.error();
  take.alignment = *alignment;
  const auto placement = PlaceFeet(session, felt, take.alignment);
  if (!placement) return placement.error();
  take.placement = *placement;
  take.motion = Placed(motion, take.placement);
  take.session = std::move(session);
  return take;
}

Result<OwnTake> MirrorImage(const OwnTake& take) {
  OwnTake image = take;
  image.motion = motion::Mirrored(take.motion);
  body::PersonParameters person;
  person.mass_kg = take.body.mass_kg;
  person.height_m = take.body.height_m;
  auto body = body::MakeBody(image.motion.skeleton, person);
  if (!body) return body.error();
  image.body = *std::move(body);
  std::swap(image.session.boards[0], image.session.boards[1]);
  std::swap(image.session.cells_W_m[0], image.session.cells_W_m[1]);
  std::swap(image.session.hands[0], image.session.hands[1]);
  for (std::size_t side = 0; side < 2; ++side) {
    for (Eigen::Vector2d& cell : image.session.cells_W_m[side]) cell.y() *= -1;
    for (HandReading& hand : image.session.hands[side]) hand.p_W_m.y() *= -1;
  }
  const auto t_pose = FindTPose(image.session);
  if (!t_pose) return InvalidData(take.session.name + ": its T-pose hardly stands still");
  image.t_pose = *t_pose;
  return image;
}

std::vector<LoadClip> OwnLoads(const OwnTake& take) {
  const sensors::BodyCourse course = sensors::Follow(take.body, take.motion);
  const Eigen::Vector2d origin_m = momentum::NetworkOrigin(take.t_pose);
  const double weight_n = KilogramsToNewtons(take.t_pose.mass_kg);
  std::vector<LoadClip> clips;
  bool going_on = false;
  for (double t_s = 0;; t_s += 1 / momentum::kNetworkRateHz) {
    const auto at = static_cast<Eigen::Index>(std::lround(t_s * take.motion.rate_hz));
    if (at >= course.frames()) break;
    const auto loads = LoadsAt(take.session, take.alignment.ToRecording(t_s));
    if (!loads.feet[0].valid || !loads.feet[1].valid) {
      going_on = false;
      continue;
    }
    if (!std::exchange(going_on, true)) clips.emplace_back();
    clips.back().push_back({momentum::ToNetworkLoads(loads, origin_m, weight_n),
                            course.com_m.col(at).head<2>() - origin_m});
  }
  return clips;
}

namespace {

/// The pose between two frames; angles do not jump from one to the next.
Eigen::VectorXd PoseAt(const motion::Motion& motion, double time_s) {
  const double place = time_s * motion.rate_hz;
  const auto i = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(place), 0, motion.frames() - 2);
  const double share = std::clamp(place - static_cast<double>(i), 0.0, 1.0);
  return (1 - share) * motion.q.col(i) + share * motion.q.col(i + 1);
}

reconstruction::HandInput FistOf(const body::Body& body, const body::Kinematics& at, int side,
                                 double noise_m, noise::Random& random) {
  reconstruction::HandInput hand;
  hand.valid = true;
  hand.p_W_m = body::Place(body::Fist(body, side), at);
  for (double& value : hand.p_W_m) value += noise_m * random.Normal();
  hand.sd_m.setConstant(std::max(noise_m, 0.001));
  return hand;
}

}  // namespace

Result<void> AddOwnExamples(const OwnTake& take, const reconstruction::Models& basis,
                            const OwnExampleSettings& settings, PoseExamples& examples) {
  reconstruction::Options options;
  options.rate_hz = settings.rate_hz;
  auto made = reconstruction::Reconstruction::Create(take.body, basis, options);
  if (!made) return made.error();
  noise::Random random(settings.seed);
  body::Kinematics at(take.body.skeleton);
  const std::size_t before = examples.poses.size();
  const auto frames =
      static_cast<std::size_t>(std::min(take.session.duration_s, take.to_s()) * settings.rate_hz);
  double since_s = 0;  // Duration for which both the T-pose and the motion have been there.
  for (std::size_t i = 0; i < frames; ++i) {
    const double time_s = static_cast<double>(i) / settings.rate_hz;
    const bool moves = time_s >= take.from_s();
    Eigen::VectorXd pose;
    if (moves) {
      pose = PoseAt(take.motion, take.alignment.ToMotion(time_s));
      body::ComputeKinematics(take.body.skeleton, pose, at);
    }
    reconstruction::Inputs inputs;
    inputs.loads = LoadsAt(take.session, time_s);
    for (std::size_t side = 0; side < reconstruction::kHands; ++side) {
      if (const auto hand = HandAt(take.session, side, time_s)) {
        inputs.hands[side] = {true, hand->p_W_m, hand->sd_m};
      } else if (moves && take.session.hands[side].empty()) {
        inputs.hands[side] =
            FistOf(take.body, at, static_cast<int>(side), settings.hand_noise_m, random);
      }
    }
    const auto& output = made->Advance(inputs);
    since_s = moves && output.calibrated ? since_s + 1 / settings.rate_hz : 0;
    const bool measured = inputs.loads.feet[0].valid && inputs.loads.feet[1].valid &&
                          inputs.hands[0].valid && inputs.hands[1].valid;
    if (since_s < settings.settled_s || !measured) continue;
    const double into_s = take.alignment.ToMotion(time_s);
    const int piece = settings.first_piece + static_cast<int>(into_s / settings.piece_s);
    examples.Add(*made, settings.cues, pose, piece % kFolds);
  }
  if (examples.poses.size() > before) return {};
  return InvalidData(take.session.name +
                     ": nothing of the motion is left after its T-pose; stand in the T-pose before "
                     "moving, with both hands seen");
}

}  // namespace footing::learning
