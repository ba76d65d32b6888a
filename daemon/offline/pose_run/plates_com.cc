#include "daemon/offline/pose_run/plates_com.h"

#include "daemon/offline/pose_run/force_com.h"

namespace footing::pose_run {
namespace {

constexpr double kLeastS = 5;
constexpr double kMostMps = 0.3;  // Of a COM at rest.

}  // namespace

Eigen::Matrix3Xd ComByPlates(const PoseRun& run, const FeltForces& felt, double begin_s) {
  const std::size_t first = run.judged_from;
  const auto frames = static_cast<Eigen::Index>(run.frames.size() - first);
  const auto speed_mps = [&](std::size_t i) {
    return (run.frames[i + 1].com_m - run.frames[i].com_m).norm() * run.rate_hz;
  };
  if (static_cast<double>(frames) < kLeastS * run.rate_hz || speed_mps(first) > kMostMps ||
      speed_mps(run.frames.size() - 2) > kMostMps) {
    return {};
  }
  ForceCourse course{run.rate_hz, Eigen::Matrix3Xd::Zero(3, frames),
                     Eigen::Matrix2Xd::Zero(2, frames)};
  Eigen::VectorXd height_m(frames);
  for (Eigen::Index i = 0; i < frames; ++i) {
    const std::size_t frame = first + static_cast<std::size_t>(i);
    const double clip_s = static_cast<double>(frame) / run.rate_hz - begin_s;
    Eigen::Vector2d moment_nm = Eigen::Vector2d::Zero();
    double load_n = 0;
    for (std::size_t f = 0; f < momentum::kFeet; ++f) {
      const virtual_sensors::FootForce foot = felt.Mean(f, clip_s, 1 / run.rate_hz);
      if (!foot.cop_m.allFinite()) continue;
      load_n += foot.load_n;
      moment_nm += foot.load_n * foot.cop_m;
    }
    course.force_n.col(i) << felt.MeanShear(clip_s, 1 / run.rate_hz), load_n;
    if (load_n > 0) course.cop_m.col(i) = moment_nm / load_n;
    height_m(i) = run.frames[frame].com_m.z();
  }
  return ComByForce(course, height_m);
}

}  // namespace footing::pose_run
