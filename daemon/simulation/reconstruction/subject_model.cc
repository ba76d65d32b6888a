#include "daemon/simulation/reconstruction/subject_model.h"

#include <algorithm>
#include <string>

#include "common/body/skeleton_points.h"

namespace footing::reconstruction {
namespace {

// Of the variance, in the components that paper mode searches.
constexpr double kPaperVarianceShare = 0.99;

/// A landmark's joint on one side and the joints below it.
std::vector<std::size_t> JointsFrom(const body::Body& body, body::Landmark left, int side) {
  const int top = body.landmarks[side == 0 ? left : body::Mirrored(left)];
  std::vector<std::size_t> joints;
  for (int joint = 0; joint < body.skeleton.size(); ++joint) {
    int up = joint;
    while (up >= 0 && up != top) up = body.skeleton.joint(up).parent;
    if (up == top) joints.push_back(static_cast<std::size_t>(joint));
  }
  return joints;
}

Result<void> CheckLayout(const body::Body& body, const Models& models) {
  const std::vector<std::string> dofs = body::DofNames(body.skeleton);
  if (dofs == models.dofs) return {};
  std::size_t i = 0;
  while (i < std::min(dofs.size(), models.dofs.size()) && dofs[i] == models.dofs[i]) ++i;
  return InvalidData(models.origin + ": its poses have another layout than the body: " +
                     std::to_string(models.dofs.size()) + " degrees of freedom for " +
                     std::to_string(dofs.size()) +
                     (i < dofs.size() ? ", and no " + dofs[i] + " where the body has it" : "") +
                     "; train a basis of this layout");
}

/// All that does not depend on the mode; the basis has all components.
Result<SubjectModel> CommonSubjectModel(const body::Body& body, const Models& models) {
  if (const auto checked = CheckLayout(body, models); !checked) return checked.error();
  SubjectModel model;
  model.body = body;
  model.t_pose = body::TPose(body.skeleton, body.landmarks);
  model.t_pose_at = body::Kinematics(body.skeleton);
  body::ComputeKinematics(body.skeleton, model.t_pose, model.t_pose_at);
  model.basis = models.root_height_m > 0
                    ? pose::Resized(models.basis, model.root_height_m() / models.root_height_m)
                    : models.basis;
  model.subject = SubjectOf(body);
  model.feet = StandingFeet(body);
  model.joints = body::SkeletonPoints(body);
  for (int side = 0; side < 2; ++side) {
    model.fists[static_cast<std::size_t>(side)] = body::Fist(body, side);
    model.shanks[static_cast<std::size_t>(side)] =
        JointsFrom(body, body::Landmark::kLeftKnee, side);
    model.arm_joints[static_cast<std::size_t>(side)] =
        JointsFrom(body, body::Landmark::kLeftShoulder, side);
    model.arms.emplace_back(body, side);
  }
  return model;
}

}  // namespace

Result<SubjectModel> WalkSubjectModel(const body::Body& body, const Models& models,
                                      const Options& options) {
  auto model = CommonSubjectModel(body, models);
  if (model && !options.use_basis) model->basis = pose::Unconnected(model->basis);
  return model;
}

Result<SubjectModel> BestSubjectModel(const body::Body& body, const Models& models,
                                      const Options& options) {
  auto model = WalkSubjectModel(body, models, options);
  if (!model || !options.use_basis) return model;
  const double size = model->root_height_m() / models.root_height_m;
  if (options.use_momentum && !models.regression.empty()) {
    model->regression = models.regression;
    model->rest = pose::Resized(models.rest, size);
  }
  if (options.use_posture && !models.posture.empty()) {
    model->posture = {models.posture.regression, pose::Resized(models.posture.rest, size)};
  }
  return model;
}

Result<SubjectModel> PaperSubjectModel(const body::Body& body, const Models& models,
                                       const Options& options) {
  auto model = CommonSubjectModel(body, models);
  if (!model) return model;
  model->basis = options.use_basis ? pose::Leading(model->basis, kPaperVarianceShare)
                                   : pose::Unconnected(model->basis);
  model->horizontal = models.horizontal;
  return model;
}

pose::LegIk LegOf(const SubjectModel& model, std::size_t foot) {
  const body::Landmark hip =
      foot == 0 ? body::Landmark::kLeftHip : body::Mirrored(body::Landmark::kLeftHip);
  return {model.body, model.body.landmarks[hip], model.feet[foot].toe.joint};
}

Eigen::Vector3d BasisOrigin(const SubjectModel& model, const momentum::TPose& pose) {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    const FootGeometry& foot = model.feet[f];
    const Eigen::Vector3d middle_m =
        pose.p_WP_m[f] + 0.5 * foot.R_WF * (foot.ankle_F_m + foot.toe_F_m);
    origin_m.head<2>() += 0.5 * middle_m.head<2>();
  }
  return origin_m;
}

}  // namespace footing::reconstruction
