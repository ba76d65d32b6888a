#pragma once

#include <Eigen/Core>

/// The pose solver: hands, feet, centre of mass and momentum in, a full-body pose out (Ha, Bai and
/// Liu 2011, section 6, and what goes beyond it: docs/pose.md).
///
/// | paper            | here           | unit, frame                        |
/// |------------------|----------------|------------------------------------|
/// | q                | q              | m and rad, common/body             |
/// | P, by c          | com_W_m        | m, W                               |
/// | L                | angular_W      | kg m^2/s about the centre of mass  |
/// | G                | points         | m, W                               |
/// | principal compon.| PoseBasis      | q = mean + modes a                 |
namespace footing::pose {

/// Principal components of poses, in the order of their variance.
struct PoseBasis {
  Eigen::VectorXd mean;     ///< A pose.
  Eigen::MatrixXd modes;    ///< A column a component; q = mean + modes a.
  Eigen::MatrixXd inverse;  ///< a = inverse (q - mean), for poses of the space.
  Eigen::VectorXd sd;       ///< Of each coefficient.

  int dof() const { return static_cast<int>(mean.size()); }
  int size() const { return static_cast<int>(sd.size()); }
};

struct BasisOptions {
  /// A metre of the root counts as so many radians.
  double translation_weight = 2.5;
  /// As many components as explain this share of the variance; 1: all that vary at all.
  double variance_share = 1;
};

/// Principal component analysis of poses, a column each. At least two poses.
PoseBasis FitBasis(const Eigen::Ref<const Eigen::MatrixXd>& poses, const BasisOptions& options);

/// The same poses of a person whose root is so many times as high: angles stay.
PoseBasis Resized(PoseBasis basis, double scale);
/// The components that hold this share of the variance.
PoseBasis Leading(PoseBasis basis, double share);
/// No basis: every degree of freedom for itself, with its own spread.
PoseBasis Unconnected(const PoseBasis& basis);

}  // namespace footing::pose
