#include "daemon/offline/eval/momentum_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/body/kinematics.h"
#include "common/config/data_file.h"
#include "common/motion/asf.h"
#include "common/motion/bvh.h"
#include "common/motion/edit.h"
#include "common/virtual_sensors/ground_reaction.h"

namespace footing::eval {
namespace {

using body::Landmark;
namespace sensors = virtual_sensors;

constexpr std::size_t kMostBytes = 64u << 20;
constexpr double kLeaveS = 1.5;
constexpr double kFloorShare = 0.02;  // Of the frames have something lower than the floor.

Result<motion::Motion> Read(const MomentumOptions& options) {
  const auto text = config::ReadTextFile(options.motion, kMostBytes);
  if (!text) return text.error();
  if (options.skeleton.empty()) return motion::ParseBvh(*text, options.motion);
  const auto asf = config::ReadTextFile(options.skeleton, kMostBytes);
  if (!asf) return asf.error();
  const auto skeleton = motion::ParseAsf(*asf, options.skeleton);
  if (!skeleton) return skeleton.error();
  return motion::ParseAmc(*text, options.motion, *skeleton);
}

// Lowest joint of each frame; the floor is the height that few frames are below.
double FloorOf(const motion::Motion& motion) {
  body::Kinematics at(motion.skeleton);
  std::vector<double> lowest;
  for (Eigen::Index i = 0; i < motion.frames(); ++i) {
    body::ComputeKinematics(motion.skeleton, motion.q.col(i), at);
    double low = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& p : at.p_WJ) low = std::min(low, p.z());
    lowest.push_back(low);
  }
  const auto place = lowest.begin() +
                     static_cast<std::ptrdiff_t>(kFloorShare * static_cast<double>(lowest.size()));
  std::nth_element(lowest.begin(), place, lowest.end());
  return *place;
}

// A T-pose of straight lines has its weight over the heels. A person leans ahead until it is over
// the rest point of the soles: all but the feet turn about the ankles.
void Lean(const body::Body& body, double rest_share, Eigen::VectorXd& pose) {
  motion::Motion still;
  still.skeleton = body.skeleton;
  still.rate_hz = 100;
  still.q = pose.replicate(1, 2);
  const sensors::BodyCourse course = sensors::Follow(body, still);
  double rest_x = 0;
  for (const auto& sole : course.sole_m)
    rest_x += (1 - rest_share) * 0.25 * (sole[0](0, 0) + sole[1](0, 0)) +
              rest_share * 0.25 * (sole[2](0, 0) + sole[3](0, 0));
  const double angle = (rest_x - course.com_m(0, 0)) / course.com_m(2, 0);
  const body::Skeleton& skeleton = body.skeleton;
  const Eigen::Matrix3d turn = body::AxisRotation(body::Axis::kY, angle);
  body::SetJointRotation(skeleton.joint(0), turn * body::JointRotation(skeleton.joint(0), pose),
                         pose);
  pose(0) += angle * pose(2);
  body::Kinematics at(skeleton);
  for (const Landmark landmark : {Landmark::kLeftAnkle, Landmark::kRightAnkle}) {
    const int ankle = body.landmarks[landmark];
    const body::Joint& joint = skeleton.joint(ankle);
    body::ComputeKinematics(skeleton, pose, at);
    const Eigen::Matrix3d& R_WP = at.R_WJ[static_cast<std::size_t>(joint.parent)];
    const Eigen::Matrix3d& R_WJ = at.R_WJ[static_cast<std::size_t>(ankle)];
    body::SetJointRotation(joint, R_WP.transpose() * turn.transpose() * R_WJ, pose);
  }
}

// The T-pose where the clip begins, held, then the clip.
motion::Motion WithTPose(const motion::Motion& clip, const body::Body& body) {
  Eigen::VectorXd pose = body::TPose(clip.skeleton, body.landmarks);
  Lean(body, momentum::FootShape{}.rest_share, pose);
  pose.head<2>() = clip.q.col(0).head<2>();
  const auto hold = static_cast<Eigen::Index>(std::lround(kCalibrationS * clip.rate_hz));
  const auto leave = static_cast<Eigen::Index>(std::lround(kLeaveS * clip.rate_hz));
  motion::Motion out = clip;
  out.q.resize(clip.q.rows(), hold + leave + clip.q.cols());
  for (Eigen::Index i = 0; i < hold + leave; ++i) {
    const double u = std::max(0.0, static_cast<double>(i - hold) / static_cast<double>(leave));
    const double s = u * u * u * (10 - 15 * u + 6 * u * u);
    out.q.col(i) = pose + s * (clip.q.col(0) - pose);
  }
  out.q.rightCols(clip.q.cols()) = clip.q;
  return out;
}

double YawOf(const sensors::BodyCourse& course, std::size_t foot) {
  const Eigen::Vector3d ahead = course.sole_m[foot][2].col(0) + course.sole_m[foot][3].col(0) -
                                course.sole_m[foot][0].col(0) - course.sole_m[foot][1].col(0);
  return std::atan2(ahead.y(), ahead.x());
}

}  // namespace

Result<MomentumScene> MakeMomentumScene(const MomentumOptions& options) {
  auto read = Read(options);
  if (!read) return read.error();
  const auto landmarks = body::FindLandmarks(read->skeleton);
  if (!landmarks) return landmarks.error();
  body::PersonParameters person;
  person.mass_kg = options.mass_kg;
  const auto made = body::MakeBody(read->skeleton, person);
  if (!made) return made.error();

  motion::Motion clip = motion::FacingForward(motion::Continuous(std::move(*read)), *landmarks);
  if (clip.frames() < 2) return InvalidData(options.motion + ": a motion needs two frames");
  clip.q.row(2).array() -= FloorOf(clip);
  if (options.loop_minutes > 0) clip = motion::Looped(clip, options.loop_minutes * 60);
  const motion::Motion motion = motion::Continuous(WithTPose(clip, *made));
  const sensors::BodyCourse course = sensors::Follow(*made, motion);
  const sensors::GroundReaction reaction = sensors::React(course);

  MomentumScene scene;
  scene.rate_hz = options.rate_hz;
  scene.subject.com_height_m = course.com_m(2, 0);
  std::array<sensors::BoardPlace, sensors::kFeet> boards = sensors::SideBySide();
  std::vector<sensors::CellErrors> cells;
  for (std::size_t f = 0; f < sensors::kFeet; ++f) {
    scene.subject.feet[f].yaw_rad = YawOf(course, f);
    // Each foot begins in its board's middle.
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const auto& point : course.sole_m[f]) middle += point.col(0) / sensors::kFootPoints;
    boards[f].middle_m = middle.head<2>();
    sensors::CellErrorConfig errors = options.errors;
    errors.seed = 2 * options.errors.seed + f;
    cells.emplace_back(errors);
  }
  const double step_s = 1 / options.rate_hz;
  const auto frames = static_cast<std::size_t>(motion.duration_s() * options.rate_hz);
  std::size_t loaded = 0, outside = 0;
  for (std::size_t i = 0; i < frames; ++i) {
    const auto at = std::min<Eigen::Index>(
        static_cast<Eigen::Index>(std::lround(static_cast<double>(i) * step_s * motion.rate_hz)),
        motion.frames() - 1);
    const auto feet = sensors::ShareBetweenFeet(course, reaction, at);
    MomentumFrame frame;
    frame.loads.time_s = static_cast<double>(i) * step_s;
    frame.com_m = course.com_m.col(at);
    frame.angular_momentum = course.angular_momentum.col(at);
    for (std::size_t f = 0; f < sensors::kFeet; ++f) {
      const auto load = sensors::LoadBoard(boards[f], feet[f], !options.unlimited);
      const auto read_n = cells[f].Advance(load.corners_n, step_s);
      const auto places = sensors::SensorPlaces(boards[f]);
      momentum::FootLoads& foot = frame.loads.feet[f];
      foot.valid = true;
      foot.count = places.size();
      for (std::size_t k = 0; k < places.size(); ++k)
        foot.cells[k] = {{places[k].x(), places[k].y(), 0}, read_n[k]};
      frame.feet[f].load_n = feet[f].load_n;
      for (const auto& point : course.sole_m[f])
        frame.feet[f].middle_m += point.col(at) / sensors::kFootPoints;
      if (feet[f].load_n > 20) {
        ++loaded;
        outside += load.outside ? 1 : 0;
      }
    }
    scene.frames.push_back(frame);
  }
  scene.outside_share = loaded > 0 ? static_cast<double>(outside) / static_cast<double>(loaded) : 0;
  return scene;
}

}  // namespace footing::eval
