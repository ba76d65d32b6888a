#include "daemon/offline/pose_run/felt_forces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/body/kinematics.h"
#include "daemon/offline/pose_run/pose_run.h"

namespace footing::pose_run {
namespace {

namespace sensors = virtual_sensors;
using sensors::kFeet;

/// The clip's frame in the scene's: columns before it, and how W of its file lies in W.
struct Placed {
  Eigen::Index before = 0;
  Eigen::Matrix3d R_WV = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_WV = Eigen::Vector3d::Zero();

  Placed(const motion::Motion& clip, const sensors::Scene& scene)
      : before(scene.motion.frames() - clip.frames()) {
    body::Kinematics in_file(clip.skeleton), in_scene(scene.motion.skeleton);
    body::ComputeKinematics(clip.skeleton, clip.q.col(0), in_file);
    body::ComputeKinematics(scene.motion.skeleton, scene.motion.q.col(before), in_scene);
    R_WV = in_scene.R_WJ[0] * in_file.R_WJ[0].transpose();
    p_WV = in_scene.p_WJ[0] - R_WV * in_file.p_WJ[0];
  }
};

/// How far a point of the ground is from the line between the middles of heel and ball.
double Beside(const sensors::BodyCourse& course, std::size_t foot, Eigen::Index column,
              const Eigen::Vector2d& p) {
  const auto& sole = course.sole_m[foot];
  const Eigen::Vector3d heel = 0.5 * (sole[0].col(column) + sole[1].col(column));
  const Eigen::Vector3d ball = 0.5 * (sole[2].col(column) + sole[3].col(column));
  const Eigen::Vector3d along = ball - heel, at(p.x(), p.y(), 0);
  const double share =
      std::clamp((at - heel).dot(along) / std::max(along.squaredNorm(), 1e-9), 0.0, 1.0);
  return (at - heel - share * along).norm();
}

/// Calls `use` with a sample, the next one and the share of the next, at points spread evenly over
/// `span_s` around a time; returns their number.
template <typename Use>
int Sample(double time_s, double span_s, double rate_hz, Eigen::Index count, const Use& use) {
  const int points = std::max(1, static_cast<int>(std::ceil(span_s * rate_hz)));
  for (int i = 0; i < points; ++i) {
    const double off_s = span_s * ((i + 0.5) / points - 0.5);
    const double at = std::clamp((time_s + off_s) * rate_hz, 0.0, static_cast<double>(count - 1));
    const auto low = static_cast<Eigen::Index>(at);
    use(low, std::min(low + 1, count - 1), at - static_cast<double>(low));
  }
  return points;
}

/// One plate's part, added to what the feet feel.
class PlateFeeler {
 public:
  PlateFeeler(const motion::Motion& clip, const sensors::Scene& scene,
              const motion::GroundForces& forces)
      : clip_(clip), scene_(scene), forces_(forces), placed_(clip, scene) {}

  PlateUse Add(const motion::PlateForces& plate, Eigen::Index first, FeltForces& felt) const {
    PlateUse use;
    use.plate = plate.name;
    double load_sum = 0, beside_sum = 0;
    const Eigen::Index count = felt.load_n[0].size();
    for (Eigen::Index begin = 0; begin < count;) {
      if (!(plate.force_W(2, first + begin) > kLoadedN)) {
        ++begin;
        continue;
      }
      Eigen::Index end = begin;
      std::array<double, kFeet> beside{};
      double load = 0;
      for (; end < count && plate.force_W(2, first + end) > kLoadedN; ++end) {
        const double force_n = plate.force_W(2, first + end);
        load += force_n;
        for (std::size_t f = 0; f < kFeet; ++f) {
          beside[f] += force_n * Beside(scene_.course, f, Column(end), CopOf(plate, first + end));
        }
      }
      const std::size_t foot = beside[1] < beside[0] ? 1 : 0;
      for (Eigen::Index i = begin; i < end; ++i) {
        const double force_n = plate.force_W(2, first + i);
        felt.load_n[foot](i) += force_n;
        felt.moment_nm[foot].col(i) += force_n * CopOf(plate, first + i);
        felt.shear_n.col(i) += (placed_.R_WV * plate.force_W.col(first + i)).head<2>();
      }
      use.loaded_s[foot] += static_cast<double>(end - begin) / forces_.rate_hz;
      load_sum += load;
      beside_sum += beside[foot];
      begin = end;
    }
    use.beside_m = load_sum > 0 ? beside_sum / load_sum : 0;
    return use;
  }

 private:
  Eigen::Vector2d CopOf(const motion::PlateForces& plate, Eigen::Index sample) const {
    return (placed_.R_WV * plate.cop_W.col(sample) + placed_.p_WV).head<2>();
  }
  Eigen::Index Column(Eigen::Index sample) const {
    const double time_s = static_cast<double>(sample) / forces_.rate_hz;
    return std::min(placed_.before + static_cast<Eigen::Index>(std::lround(time_s * clip_.rate_hz)),
                    scene_.motion.frames() - 1);
  }

  const motion::Motion& clip_;
  const sensors::Scene& scene_;
  const motion::GroundForces& forces_;
  Placed placed_;
};

}  // namespace

sensors::FootForce FeltForces::Mean(std::size_t foot, double time_s, double span_s) const {
  const Eigen::VectorXd& loads = load_n[foot];
  sensors::FootForce force;
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  const int points = Sample(
      time_s, span_s, rate_hz, loads.size(), [&](Eigen::Index low, Eigen::Index high, double part) {
        force.load_n += (1 - part) * loads(low) + part * loads(high);
        moment += (1 - part) * moment_nm[foot].col(low) + part * moment_nm[foot].col(high);
      });
  force.load_n /= points;
  if (force.load_n > 0) {
    force.cop_m = moment / points / force.load_n;
  } else {
    force.cop_m.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return force;
}

Eigen::Vector2d FeltForces::MeanShear(double time_s, double span_s) const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  const int points = Sample(time_s, span_s, rate_hz, shear_n.cols(),
                            [&](Eigen::Index low, Eigen::Index high, double part) {
                              sum += (1 - part) * shear_n.col(low) + part * shear_n.col(high);
                            });
  return sum / points;
}

FeltForces FeelPlates(const motion::Motion& clip, const sensors::Scene& scene,
                      const motion::GroundForces& forces) {
  FeltForces felt;
  felt.rate_hz = forces.rate_hz;
  const Eigen::Index all = forces.plates.front().force_W.cols();
  const auto first = std::clamp<Eigen::Index>(
      static_cast<Eigen::Index>(std::lround((clip.start_s - forces.start_s) * forces.rate_hz)), 0,
      all - 1);
  const double span_s = static_cast<double>(clip.frames() - 1) / clip.rate_hz;
  const Eigen::Index count =
      std::min(static_cast<Eigen::Index>(std::lround(span_s * forces.rate_hz)) + 1, all - first);
  for (std::size_t f = 0; f < kFeet; ++f) {
    felt.load_n[f] = Eigen::VectorXd::Zero(count);
    felt.moment_nm[f] = Eigen::Matrix2Xd::Zero(2, count);
  }
  felt.shear_n = Eigen::Matrix2Xd::Zero(2, count);
  const PlateFeeler feeler(clip, scene, forces);
  for (const motion::PlateForces& plate : forces.plates) {
    felt.plates.push_back(feeler.Add(plate, first, felt));
  }
  return felt;
}

}  // namespace footing::pose_run
