#include "daemon/simulation/reconstruction/posture.h"

namespace footing::reconstruction {

LikelyPosture::LikelyPosture(const SubjectModel& model, double step_s)
    : model_(&model),
      step_s_(step_s),
      features_(step_s, model.root_height_m(), model.body.mass_kg),
      workspace_(model.posture.regression.MakeWorkspace()),
      likely_q_(model.t_pose) {}

void LikelyPosture::Start() {
  features_ = Features(step_s_, model_->root_height_m(), model_->body.mass_kg);
}

void LikelyPosture::Advance(const std::array<Eigen::Vector3d, kHands>& hands_W_m,
                            const momentum::Estimate& estimate) {
  const momentum::Estimate bare = WithoutLoads(estimate, model_->subject.com_height_m);
  middle_W_m_ = bare.p_WC_m;
  features_.Advance(hands_W_m, bare);
}

const Eigen::VectorXd& LikelyPosture::Predict(const Eigen::Vector3d& origin_m) {
  model_->posture.regression.Predict(features_.values(), workspace_, likely_q_);
  likely_q_.head<3>() = likely_q_.head<3>() * model_->root_height_m() + middle_W_m_ - origin_m;
  return likely_q_;
}

}  // namespace footing::reconstruction
