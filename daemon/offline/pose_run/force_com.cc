#include "daemon/offline/pose_run/force_com.h"

#include <Eigen/QR>

#include "common/base/result.h"
#include "common/base/units.h"

namespace footing::pose_run {
namespace {

/// From 0 on, by trapezoids.
Eigen::VectorXd Integrated(const Eigen::VectorXd& rate, double step_s) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(rate.size());
  for (Eigen::Index i = 1; i < rate.size(); ++i) {
    sum(i) = sum(i - 1) + 0.5 * step_s * (rate(i - 1) + rate(i));
  }
  return sum;
}

Eigen::VectorXd IntegratedTwice(const Eigen::VectorXd& rate, double step_s) {
  return Integrated(Integrated(rate, step_s), step_s);
}

Eigen::VectorXd Times(Eigen::Index frames, double step_s) {
  return Eigen::VectorXd::LinSpaced(frames, 0, step_s * static_cast<double>(frames - 1));
}

struct Vertical {
  double mass_kg = 0;
  Eigen::VectorXd height_m;
};

Vertical VerticalPath(const ForceCourse& course, const Eigen::VectorXd& height_m) {
  const Eigen::Index frames = height_m.size();
  const double step_s = 1 / course.rate_hz;
  const Eigen::VectorXd t_s = Times(frames, step_s);
  const Eigen::VectorXd fall_m = -0.5 * kStandardGravityMps2 * t_s.cwiseAbs2();
  Eigen::MatrixX3d terms(frames, 3);  // Of the height, the velocity, and the mass inverted.
  terms << Eigen::VectorXd::Ones(frames), t_s, IntegratedTwice(course.force_n.row(2), step_s);
  const Eigen::Vector3d constants = terms.colPivHouseholderQr().solve(height_m - fall_m);
  return {1 / constants(2), terms * constants + fall_m};
}

/// Along one axis of the ground. `lever_s2`: z / (g + z'').
Eigen::VectorXd LevelPath(const Eigen::VectorXd& acceleration_mps2, const Eigen::VectorXd& cop_m,
                          const Eigen::VectorXd& lever_s2, const Eigen::VectorXd& load_n,
                          double step_s) {
  const Eigen::Index frames = cop_m.size();
  const Eigen::VectorXd t_s = Times(frames, step_s);
  Eigen::MatrixX3d terms(frames, 3);  // Of the place, the velocity and a constant acceleration.
  terms << Eigen::VectorXd::Ones(frames), t_s, 0.5 * t_s.cwiseAbs2();
  const Eigen::VectorXd moved_m = IntegratedTwice(acceleration_mps2, step_s);
  Eigen::MatrixX3d of_cop = terms;
  of_cop.col(2) -= lever_s2;
  const Eigen::VectorXd rest_m = cop_m - moved_m + lever_s2.cwiseProduct(acceleration_mps2);
  const Eigen::Vector3d constants =
      (load_n.asDiagonal() * of_cop).colPivHouseholderQr().solve(load_n.asDiagonal() * rest_m);
  return moved_m + terms * constants;
}

}  // namespace

Eigen::Matrix3Xd ComByForce(const ForceCourse& course, const Eigen::VectorXd& height_m) {
  const Eigen::Index frames = course.force_n.cols();
  FOOTING_CHECK(course.rate_hz > 0 && course.cop_m.cols() == frames && height_m.size() == frames);
  const Vertical up = VerticalPath(course, height_m);
  const Eigen::VectorXd load_n = course.force_n.row(2).cwiseMax(0);
  // z / (g + z'') is z m / F. In the air the load weighs the row with 0.
  const Eigen::VectorXd lever_s2 = load_n.binaryExpr(
      up.height_m,
      [&up](double load, double height) { return load > 0 ? height * up.mass_kg / load : 0; });
  Eigen::Matrix3Xd com_m(3, frames);
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    com_m.row(axis) = LevelPath(course.force_n.row(axis) / up.mass_kg, course.cop_m.row(axis),
                                lever_s2, load_n, 1 / course.rate_hz);
  }
  com_m.row(2) = up.height_m;
  return com_m;
}

}  // namespace footing::pose_run
