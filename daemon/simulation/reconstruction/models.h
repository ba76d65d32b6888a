#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/model/model.h"
#include "daemon/simulation/cascade/network.h"
#include "daemon/simulation/momentum/estimate.h"
#include "daemon/simulation/pose/arm_model.h"
#include "daemon/simulation/pose/arm_network.h"
#include "daemon/simulation/pose/gauss_newton.h"

namespace footing::reconstruction {

/// Features of one frame's hands, feet and momentum for a linear regression of the pose: places
/// from the estimated centre of mass, their products, and how they differ from what they were.
/// Lengths are parts of the height of the root in the T-pose, so that persons of all sizes are
/// alike, and nothing depends on where they are in the world.
class Features {
 public:
  static constexpr int kHistories = 3;
  static constexpr int kNow = 37, kChanging = 17, kShape = 7;
  static constexpr int kCount = kNow + kHistories * kChanging + kShape * (kShape + 1) / 2;
  using Values = Eigen::Matrix<double, kCount, 1>;

  Features(double step_s, double root_height_m, double mass_kg)
      : step_s_(step_s), root_height_m_(root_height_m), mass_kg_(mass_kg) {}

  /// The next frame: fists in W, left and right.
  const Values& Advance(const std::array<Eigen::Vector3d, 2>& hands_W_m,
                        const momentum::Estimate& estimate);
  const Values& values() const { return values_; }

 private:
  using Changing = Eigen::Matrix<double, kChanging, 1>;

  double step_s_, root_height_m_, mass_kg_;
  bool started_ = false;
  using Hands = Eigen::Matrix<double, 6, 1>;
  Hands hands_ = Hands::Zero(), slow_hands_ = Hands::Zero();
  std::array<Changing, kHistories> slow_{Changing::Zero(), Changing::Zero(), Changing::Zero()};
  Values values_ = Values::Zero();
};

/// An instant as hands and feet alone show it: the centre of mass over the middle of the
/// feet, `com_height_m` high, without motion, no loads. Where the feet are and that they stand
/// stays.
momentum::Estimate WithoutLoads(const std::array<momentum::FootEstimate, momentum::kFeet>& feet,
                                double com_height_m);

/// A matrix in single precision that is read once a frame from first to last: strips of kStrip
/// rows, each a column after the other in memory. Its products are summed in the order of the
/// columns.
class StripMatrix {
 public:
  static constexpr int kStrip = 32;

  StripMatrix() = default;
  explicit StripMatrix(const Eigen::MatrixXf& dense);

  Eigen::Index rows() const { return rows_; }
  /// Rows of a vector of products, whole strips.
  Eigen::Index StripRows() const { return (rows_ + kStrip - 1) / kStrip * kStrip; }
  Eigen::MatrixXf Dense() const;
  /// y += matrix x; y has StripRows() rows, those beyond rows() stay.
  void AddProduct(const Eigen::VectorXf& x, Eigen::VectorXf& y) const;

 private:
  Eigen::Index rows_ = 0, cols_ = 0;
  Eigen::MatrixXf strips_;
};

/// A linear map from features to a pose: the root from the estimated centre of mass in parts of the
/// root's height, then the angles. Where it has waves, it is linear in random cosines of the
/// features, too (Rahimi & Recht 2007).
struct PoseRegression {
  Eigen::VectorXd mean, scale;  ///< Scaling of the features: (f - mean) scale, cut at +-4.
  Eigen::MatrixXd weights;      ///< dof x features.
  Eigen::VectorXd offset;       ///< dof.
  StripMatrix waves;            ///< waves x features: cos(waves f + phases).
  Eigen::VectorXf phases;
  StripMatrix wave_weights;  ///< dof x waves.

  /// Workspace of Predict, allocated once.
  struct Workspace {
    Eigen::VectorXd scaled;
    Eigen::VectorXf single, waved, part;
  };
  Workspace MakeWorkspace() const;
  bool empty() const { return offset.size() == 0; }
  Eigen::VectorXd Scaled(const Features::Values& features) const;
  /// Writes the pose to `q`, of its size.
  void Predict(const Features::Values& features, Workspace& workspace, Eigen::VectorXd& q) const;
};

/// A model with the name of the file that it comes from.
struct NamedModel {
  std::string origin;
  model::Model model;
};

/// Prefix of the tensors for hands and feet alone.
inline constexpr const char* kPosturePrefix = "posture.";

/// The pose that some features make likely, and what is left of it: components of the regression's
/// errors.
struct LikelyPoses {
  PoseRegression regression;
  pose::PoseBasis rest;  ///< About the mean of all poses.

  bool empty() const { return regression.empty(); }
};

/// Changes of a regression and of its errors by one person's own motion (docs/models.md).
struct PersonCorrection {
  Eigen::VectorXd offset;           ///< Added to those of the regression,
  Eigen::MatrixXd weights;          ///< of its scaled features,
  Eigen::MatrixXd wave_weights;     ///< and of its waves.
  Eigen::VectorXd scale;            ///< By which an entry of a pose counts in the components.
  Eigen::MatrixXd rest_components;  ///< Rows; in place of those of the regression's errors.
  Eigen::VectorXd rest_variances;
};

/// Learned models of how people move (docs/models.md).
struct Models {
  pose::PoseBasis basis;
  double root_height_m = 0;  ///< Root height of the basis' people, in the T-pose; 0: unknown.
  /// The pose that the features make likely, and what is left of it: components of the regression's
  /// errors, about the mean of `basis`. Where the model has them (kind "pose").
  PoseRegression regression;
  pose::PoseBasis rest;
  /// The same by hands and feet alone (WithoutLoads), where the model has it.
  LikelyPoses posture;
  std::vector<std::string> dofs;  ///< Layout of the bodies that the basis fits.
  std::string origin;             ///< File of the basis.
  /// Next C_x and C_y (section 4.2), where there are such networks.
  std::optional<std::array<cascade::CascadeNetwork, 2>> horizontal;
  /// For hands that hold a Wiimote, where there is one.
  std::optional<arms::ArmModel> arm;
  /// The same for paper mode (section 5.2).
  std::optional<arm_network::ArmNetwork> paper_arm;
};

/// The regression and its errors as the person's correction has them. Sizes must fit.
void Correct(const PersonCorrection& correction, PoseRegression& regression, pose::PoseBasis& rest);

/// Digest of all values of a model, by which a person's model names the one that it corrects.
model::Digest BaseDigest(const model::Model& model);

/// At most one model of each kind: "basis" or "pose" is necessary, "com", "arm", "arm_paper" and
/// "person" are not. A person's model needs the very pose model that it was made with. Errors name
/// the file.
Result<Models> MakeModels(const std::vector<NamedModel>& models);

}  // namespace footing::reconstruction
