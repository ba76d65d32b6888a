#include "daemon/simulation/reconstruction/models.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/cascade/network.h"
#include "daemon/simulation/momentum/horizontal_network.h"

namespace footing::reconstruction {
namespace {

constexpr double kHandS = 0.03, kSlowHandS = 0.1;  // Smoothing of the hands, and for their speed.
constexpr std::array<double, Features::kHistories> kHistoriesS{0.1, 0.3, 1.0};
constexpr double kMostAcceleration = 15, kMostAngular = 20, kMostTorque = 60;
constexpr double kMostAirS = 0.6;
constexpr double kLeastLoadShare = 0.1;  // Below, the centre of pressure is taken to be under C.
constexpr double kMostScaled = 4;

/// Appends to a vector of fixed size.
template <typename Vector>
struct Appender {
  Vector& values;
  Eigen::Index at = 0;

  template <typename Derived>
  void Add(const Eigen::MatrixBase<Derived>& part) {
    values.segment(at, part.size()) = part;
    at += part.size();
  }
  void Add(double value) { values(at++) = value; }
};

Eigen::Vector3d Clipped(const Eigen::Vector3d& value, double most) {
  return value.cwiseMax(-most).cwiseMin(most);
}

}  // namespace

const Features::Values& Features::Advance(const std::array<Eigen::Vector3d, 2>& hands_W_m,
                                          const momentum::Estimate& estimate) {
  const double unit = 1 / root_height_m_;
  const double weight_n = mass_kg_ * kStandardGravityMps2;
  Eigen::Matrix<double, 6, 1> hands;
  hands << hands_W_m[0], hands_W_m[1];
  if (!started_) hands_ = slow_hands_ = hands;
  hands_ += (1 - std::exp(-step_s_ / kHandS)) * (hands - hands_);
  slow_hands_ += (1 - std::exp(-step_s_ / kSlowHandS)) * (hands - slow_hands_);

  const Eigen::Vector3d& c = estimate.p_WC_m;
  std::array<double, 2> share{};
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  for (std::size_t f = 0; f < 2; ++f) {
    const momentum::FootEstimate& foot = estimate.feet[f];
    share[f] = std::clamp(foot.load_n / weight_n, -0.2, 4.0);
    const Eigen::Vector3d& p = foot.cop_valid ? foot.p_WP_m : foot.p_WF_m;
    moment += std::max(share[f], 0.0) * p.head<2>();
  }
  const double total = std::max(share[0], 0.0) + std::max(share[1], 0.0);
  const Eigen::Vector2d cop =
      total > kLeastLoadShare ? Eigen::Vector2d(moment / total) : Eigen::Vector2d(c.head<2>());

  Changing changing;
  Appender<Changing> change{changing};
  change.Add(unit * hands_);
  change.Add(unit * cop);
  change.Add(Eigen::Vector2d(share[0], share[1]));
  for (const momentum::FootEstimate& foot : estimate.feet) change.Add(unit * foot.p_WF_m.head<2>());
  change.Add(unit * c);

  Eigen::Matrix<double, kShape, 1> shape;
  shape << unit * (hands_.head<3>() - c), unit * (hands_.tail<3>() - c), unit * c.z();

  Appender<Values> out{values_};
  out.Add(shape);
  out.Add(unit / kSlowHandS * (hands_ - slow_hands_));
  out.Add(unit * estimate.v_WC_mps);
  out.Add(Clipped(estimate.a_WC_mps2, kMostAcceleration));
  out.Add(Clipped(estimate.angular_momentum_kgm2ps, kMostAngular) / mass_kg_);
  out.Add(Clipped(estimate.angular_momentum_rate_nm, kMostTorque) / mass_kg_);
  for (const momentum::FootEstimate& foot : estimate.feet) {
    out.Add(unit * (foot.p_WF_m - c).head<2>());
    out.Add(foot.contact ? 1.0 : 0.0);
    out.Add(std::min(foot.airborne_s, kMostAirS));
  }
  out.Add(unit * (cop - c.head<2>()));
  out.Add(Eigen::Vector2d(share[0], share[1]));
  for (std::size_t i = 0; i < kHistories; ++i) {
    if (!started_) slow_[i] = changing;
    slow_[i] += (1 - std::exp(-step_s_ / kHistoriesS[i])) * (changing - slow_[i]);
    out.Add(changing - slow_[i]);
  }
  for (int i = 0; i < kShape; ++i) {
    for (int k = i; k < kShape; ++k) out.Add(shape(i) * shape(k));
  }
  started_ = true;
  return values_;
}

momentum::Estimate WithoutLoads(const std::array<momentum::FootEstimate, momentum::kFeet>& feet,
                                double com_height_m) {
  momentum::Estimate bare;
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    const momentum::FootEstimate& foot = feet[f];
    momentum::FootEstimate& shown = bare.feet[f];
    shown.contact = foot.contact;
    shown.valid = foot.valid;
    shown.p_WF_m = foot.p_WF_m;
    shown.airborne_s = foot.airborne_s;
    bare.p_WC_m += foot.p_WF_m / double{momentum::kFeet};
  }
  bare.p_WC_m.z() = com_height_m;
  return bare;
}

StripMatrix::StripMatrix(const Eigen::MatrixXf& dense) : rows_(dense.rows()), cols_(dense.cols()) {
  strips_.setZero(kStrip, StripRows() / kStrip * cols_);
  if (dense.size() == 0) return;
  for (Eigen::Index row = 0; row < rows_; ++row) {
    strips_.row(row % kStrip).segment(row / kStrip * cols_, cols_) = dense.row(row);
  }
}

Eigen::MatrixXf StripMatrix::Dense() const {
  Eigen::MatrixXf dense(rows_, cols_);
  if (dense.size() == 0) return dense;
  for (Eigen::Index row = 0; row < rows_; ++row) {
    dense.row(row) = strips_.row(row % kStrip).segment(row / kStrip * cols_, cols_);
  }
  return dense;
}

void StripMatrix::AddProduct(const Eigen::VectorXf& x, Eigen::VectorXf& y) const {
  using Strip = Eigen::Array<float, kStrip, 1>;
  const float* column = strips_.data();
  for (Eigen::Index row = 0; row < StripRows(); row += kStrip) {
    Strip sum = Eigen::Map<const Strip>(y.data() + row);
    for (Eigen::Index i = 0; i < cols_; ++i, column += kStrip) {
      sum += x(i) * Eigen::Map<const Strip, Eigen::Aligned16>(column);
    }
    Eigen::Map<Strip>(y.data() + row) = sum;
  }
}

PoseRegression::Workspace PoseRegression::MakeWorkspace() const {
  return {Eigen::VectorXd::Zero(mean.size()), Eigen::VectorXf::Zero(mean.size()),
          Eigen::VectorXf::Zero(waves.StripRows()),
          Eigen::VectorXf::Zero(wave_weights.StripRows())};
}

Eigen::VectorXd PoseRegression::Scaled(const Features::Values& features) const {
  return (features - mean).cwiseProduct(scale).cwiseMax(-kMostScaled).cwiseMin(kMostScaled);
}

void PoseRegression::Predict(const Features::Values& features, Workspace& workspace,
                             Eigen::VectorXd& q) const {
  workspace.scaled =
      (features - mean).cwiseProduct(scale).cwiseMax(-kMostScaled).cwiseMin(kMostScaled);
  q = offset;
  q.noalias() += weights * workspace.scaled;
  if (phases.size() == 0) return;
  workspace.single = workspace.scaled.cast<float>();
  workspace.waved.head(phases.size()) = phases;
  waves.AddProduct(workspace.single, workspace.waved);
  workspace.waved = workspace.waved.array().cos();
  workspace.part.setZero();
  wave_weights.AddProduct(workspace.waved, workspace.part);
  q += workspace.part.head(q.size()).cast<double>();
}

namespace {

/// Below, a component is a degree of freedom that nobody moved: m or rad.
constexpr double kLeastSd = 1e-5;
constexpr std::uint32_t kMostWaves = 4096;

Result<Eigen::MatrixXd> Matrix(const model::Model& model, const std::string& name,
                               std::uint32_t rows, std::uint32_t columns,
                               const std::string& origin) {
  const std::vector<std::uint32_t> shape =
      columns == 1 ? std::vector<std::uint32_t>{rows} : std::vector<std::uint32_t>{rows, columns};
  const auto tensor = model::Find(model, name, shape, origin);
  if (!tensor) return tensor.error();
  Eigen::MatrixXd matrix(rows, columns);
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index k = 0; k < matrix.cols(); ++k) {
      matrix(i, k) = (*tensor)->values[static_cast<std::size_t>(i * matrix.cols() + k)];
    }
  }
  return matrix;
}

/// All components that vary at all.
pose::PoseBasis ToBasis(const Eigen::VectorXd& mean, const Eigen::VectorXd& scale,
                        const Eigen::MatrixXd& components, const Eigen::VectorXd& variances) {
  pose::PoseBasis basis;
  basis.mean = mean;
  const Eigen::VectorXd sd = variances.cwiseMax(0).cwiseSqrt();
  Eigen::Index count = 0;
  while (count < sd.size() && sd(count) > kLeastSd) ++count;
  const Eigen::MatrixXd rows = components.topRows(count);
  basis.modes = scale.cwiseInverse().asDiagonal() * rows.transpose();
  basis.inverse = rows * scale.asDiagonal();
  basis.sd = sd.head(count);
  return basis;
}

Result<void> ReadBasis(const NamedModel& named, Models& models) {
  const model::Tensor* mean = model::FindAny(named.model, "mean");
  if (mean == nullptr || mean->shape.size() != 1 || mean->labels.size() != mean->values.size()) {
    return InvalidData(named.origin + ": its tensor mean does not name the degrees of freedom");
  }
  const std::uint32_t dof = mean->shape[0];
  const auto read = [&](const char* name, std::uint32_t rows, std::uint32_t columns) {
    return Matrix(named.model, name, rows, columns, named.origin);
  };
  const auto scale = read("scale", dof, 1);
  if (!scale) return scale.error();
  const auto components = read("components", dof, dof);
  if (!components) return components.error();
  const auto variances = read("variances", dof, 1);
  if (!variances) return variances.error();
  if (!(scale->minCoeff() > 0)) {
    return InvalidData(named.origin + ": its tensor scale is not positive");
  }
  const Eigen::VectorXd middle =
      Eigen::Map<const Eigen::VectorXf>(mean->values.data(), dof).cast<double>();
  models.basis = ToBasis(middle, scale->col(0), *components, variances->col(0));
  const Eigen::Index count = models.basis.size();
  if (count == 0) return InvalidData(named.origin + ": its poses do not vary");
  models.dofs = mean->labels;
  if (model::FindAny(named.model, "root_height_m") != nullptr) {
    const auto height = read("root_height_m", 1, 1);
    if (!height) return height.error();
    models.root_height_m = (*height)(0, 0);
    if (!(models.root_height_m > 0.1)) {
      return InvalidData(named.origin + ": its tensor root_height_m is not a height");
    }
  }
  models.origin = named.origin;
  return {};
}

/// Older models have none.
Result<void> ReadWaves(const NamedModel& named, const std::string& prefix,
                       PoseRegression& regression) {
  const model::Tensor* phases = model::FindAny(named.model, prefix + "wave_phases");
  if (phases == nullptr) return {};
  if (phases->shape.size() != 1 || phases->shape[0] == 0 || phases->shape[0] > kMostWaves) {
    return InvalidData(named.origin + ": its tensor " + prefix +
                       "wave_phases is not a list of 1 to " + std::to_string(kMostWaves) +
                       " phases");
  }
  const std::uint32_t count = phases->shape[0];
  const auto read = [&](const char* name, std::uint32_t rows, std::uint32_t columns) {
    return Matrix(named.model, prefix + name, rows, columns, named.origin);
  };
  const auto waves = read("waves", count, Features::kCount);
  if (!waves) return waves.error();
  const auto weights =
      read("wave_weights", static_cast<std::uint32_t>(regression.offset.size()), count);
  if (!weights) return weights.error();
  regression.phases = Eigen::Map<const Eigen::VectorXf>(phases->values.data(), count);
  regression.waves = StripMatrix(waves->cast<float>());
  regression.wave_weights = StripMatrix(weights->cast<float>());
  return {};
}

/// The tensors that begin with `prefix`, of a basis that has been read.
Result<LikelyPoses> ReadLikelyPoses(const NamedModel& named, const std::string& prefix,
                                    const Models& models) {
  const auto dof = static_cast<std::uint32_t>(models.basis.dof());
  constexpr auto kFeatures = static_cast<std::uint32_t>(Features::kCount);
  struct Part {
    const char* name;
    std::uint32_t rows, columns;
    Eigen::MatrixXd values;
  };
  const auto scale = Matrix(named.model, "scale", dof, 1, named.origin);
  if (!scale) return scale.error();
  std::array<Part, 6> parts{{{"feature_mean", kFeatures, 1, {}},
                             {"feature_scale", kFeatures, 1, {}},
                             {"regression_weights", dof, kFeatures, {}},
                             {"regression_offset", dof, 1, {}},
                             {"rest_components", dof, dof, {}},
                             {"rest_variances", dof, 1, {}}}};
  for (Part& part : parts) {
    auto read = Matrix(named.model, prefix + part.name, part.rows, part.columns, named.origin);
    if (!read) return read.error();
    part.values = std::move(*read);
  }
  LikelyPoses poses;
  poses.regression = {parts[0].values.col(0),
                      parts[1].values.col(0),
                      parts[2].values,
                      parts[3].values.col(0),
                      {},
                      {},
                      {}};
  if (const auto waves = ReadWaves(named, prefix, poses.regression); !waves) return waves.error();
  poses.rest = ToBasis(models.basis.mean, scale->col(0), parts[4].values, parts[5].values.col(0));
  if (poses.rest.size() == 0 || !(models.root_height_m > 0)) {
    return InvalidData(named.origin + ": its regression has no error, or its people no height");
  }
  return poses;
}

/// Those of a basis, too: in training postures are learned before the rest.
Result<void> ReadPostures(const NamedModel& named, Models& models) {
  if (const auto basis = ReadBasis(named, models); !basis) return basis;
  // Older models have none.
  if (model::FindAny(named.model, kPosturePrefix + std::string("feature_mean")) == nullptr) {
    return {};
  }
  auto posture = ReadLikelyPoses(named, kPosturePrefix, models);
  if (!posture) return posture.error();
  models.posture = *std::move(posture);
  return {};
}

Result<void> ReadRegression(const NamedModel& named, Models& models) {
  if (const auto read = ReadPostures(named, models); !read) return read;
  auto likely = ReadLikelyPoses(named, "", models);
  if (!likely) return likely.error();
  models.regression = std::move(likely->regression);
  models.rest = std::move(likely->rest);
  return {};
}

Result<void> ReadNetworks(const NamedModel& named, Models& models) {
  auto x = cascade::FromTensors(named.model, "x.", named.origin);
  if (!x) return x.error();
  auto y = cascade::FromTensors(named.model, "y.", named.origin);
  if (!y) return y.error();
  for (const cascade::CascadeNetwork* network : {&*x, &*y}) {
    if (network->weights().inputs != momentum::kNetworkInputs || network->weights().outputs != 1) {
      return InvalidData(named.origin + ": its networks have " +
                         std::to_string(network->weights().inputs) + " inputs and " +
                         std::to_string(network->weights().outputs) + " outputs; " +
                         std::to_string(momentum::kNetworkInputs) + " and 1 belong");
    }
  }
  models.horizontal = std::array{std::move(*x), std::move(*y)};
  return {};
}

Result<void> ReadArm(const NamedModel& named, Models& models) {
  auto arm = arms::MakeArmModel(named.model, named.origin);
  if (!arm) return arm.error();
  models.arm = *std::move(arm);
  return {};
}

Result<void> ReadPaperArm(const NamedModel& named, Models& models) {
  auto arm = arm_network::MakeArmNetwork(named.model, named.origin);
  if (!arm) return arm.error();
  models.paper_arm = *std::move(arm);
  return {};
}

}  // namespace

void Correct(const PersonCorrection& correction, PoseRegression& regression,
             pose::PoseBasis& rest) {
  regression.offset += correction.offset;
  regression.weights += correction.weights;
  if (correction.wave_weights.size() > 0) {
    regression.wave_weights =
        StripMatrix(regression.wave_weights.Dense() + correction.wave_weights.cast<float>());
  }
  rest =
      ToBasis(rest.mean, correction.scale, correction.rest_components, correction.rest_variances);
}

model::Digest BaseDigest(const model::Model& model) {
  std::string bytes;
  for (const model::Tensor& tensor : model.tensors) {
    bytes += tensor.name;
    const auto* values = reinterpret_cast<const char*>(tensor.values.data());
    bytes.append(values, tensor.values.size() * sizeof(float));
  }
  return model::Sha256(bytes);
}

namespace {

/// Correction of the likely pose, or of the posture with its prefix.
Result<PersonCorrection> ReadCorrection(const NamedModel& named, const std::string& prefix,
                                        const PoseRegression& regression) {
  const auto dof = static_cast<std::uint32_t>(regression.offset.size());
  const auto waves = static_cast<std::uint32_t>(regression.phases.size());
  constexpr auto kFeatures = static_cast<std::uint32_t>(Features::kCount);
  const auto read = [&](const char* name, std::uint32_t rows, std::uint32_t columns) {
    return Matrix(named.model, prefix + name, rows, columns, named.origin);
  };
  const auto scale = read("scale", dof, 1);
  if (!scale) return scale.error();
  const auto offset = read("regression_offset", dof, 1);
  if (!offset) return offset.error();
  const auto weights = read("regression_weights", dof, kFeatures);
  if (!weights) return weights.error();
  const auto components = read("rest_components", dof, dof);
  if (!components) return components.error();
  const auto variances = read("rest_variances", dof, 1);
  if (!variances) return variances.error();
  PersonCorrection correction{offset->col(0), *weights,    {},
                              scale->col(0),  *components, variances->col(0)};
  if (!(correction.scale.minCoeff() > 0)) {
    return InvalidData(named.origin + ": its tensor " + prefix + "scale is not positive");
  }
  if (waves == 0) return correction;
  const auto wave_weights = read("wave_weights", dof, waves);
  if (!wave_weights) return wave_weights.error();
  correction.wave_weights = *wave_weights;
  return correction;
}

/// `pose`: the model that the person's corrects; null where there is none.
Result<void> ReadPerson(const NamedModel& named, const NamedModel* pose, Models& models) {
  const auto& data = named.model.provenance.data;
  if (pose == nullptr || models.posture.empty()) {
    return UsageError(named.origin +
                      ": a person's model needs the pose model that it was made "
                      "with; give it too");
  }
  if (data.empty() || data.front().sha256 != BaseDigest(pose->model)) {
    return InvalidData(named.origin + ": was made with another pose model than " + pose->origin +
                       "; make it again from its recording (footing-train person)");
  }
  auto likely = ReadCorrection(named, "", models.regression);
  if (!likely) return likely.error();
  auto posture = ReadCorrection(named, kPosturePrefix, models.posture.regression);
  if (!posture) return posture.error();
  Correct(*likely, models.regression, models.rest);
  Correct(*posture, models.posture.regression, models.posture.rest);
  return {};
}

}  // namespace

Result<Models> MakeModels(const std::vector<NamedModel>& models) {
  Models made;
  std::vector<std::string> kinds;
  const NamedModel* pose = nullptr;
  const NamedModel* person = nullptr;
  for (const NamedModel& named : models) {
    const std::string& kind = named.model.kind;
    if (std::find(kinds.begin(), kinds.end(), kind) != kinds.end()) {
      return UsageError(named.origin + ": a second model of kind " + kind + "; give one of each");
    }
    kinds.push_back(kind);
    if ((kind == "basis" || kind == "pose") && !made.dofs.empty()) {
      return UsageError(named.origin + ": a pose model brings its basis; give one of the two");
    }
    if (kind == "person") person = &named;
    if (kind == "pose") pose = &named;
    const auto read =
        kind == "person"  ? Result<void>()
        : kind == "basis" ? ReadPostures(named, made)
        : kind == "pose"  ? ReadRegression(named, made)
        : kind == "com"   ? ReadNetworks(named, made)
        : kind == "arm"   ? ReadArm(named, made)
        : kind == "arm_paper"
            ? ReadPaperArm(named, made)
            : Result<void>(InvalidData(
                  named.origin + ": a model of kind " + kind +
                  "; the pose engine takes basis, pose, com, arm, arm_paper and person"));
    if (!read) return read.error();
  }
  if (made.dofs.empty()) {
    return UsageError(
        "no model of kind pose or basis: train one with footing-train pose or footing-train basis");
  }
  if (person != nullptr) {
    if (const auto read = ReadPerson(*person, pose, made); !read) return read.error();
  }
  return made;
}

}  // namespace footing::reconstruction
