#include "daemon/simulation/reconstruction/best_solver.h"

#include "common/body/points.h"

namespace footing::reconstruction {

BestSolver::BestSolver(const SubjectModel& model, const Options& options)
    : model_(&model),
      options_(options),
      plain_(model.body, model.basis, BasisSolverOptions(options)),
      features_(options.step_s(), model.root_height_m(), model.body.mass_kg),
      posture_(model, options.step_s()),
      likely_q_(model.t_pose) {
  hands_W_m_.fill(Eigen::Vector3d::Zero());
  if (!model.posture.empty()) {
    posed_.emplace(model.body, model.posture.rest, RegressedSolverOptions(options));
  }
  if (model.regression.empty()) return;
  regressed_.emplace(model.body, model.rest, RegressedSolverOptions(options));
  workspace_ = model.regression.MakeWorkspace();
}

void BestSolver::Start(double mass_kg) {
  Reset();
  first_ = true;
  source_ = Source::kMean;
  placed_by_arms_ = false;
  posture_.Start();
  features_ = Features(options_.step_s(), model_->root_height_m(), mass_kg);
  for (std::size_t side = 0; side < kHands; ++side) {
    const auto joint = static_cast<std::size_t>(model_->fists[side].joint);
    hands_W_m_[side] = model_->t_pose_at.p_WJ[joint];
  }
}

void BestSolver::Reset() {
  plain_.Reset();
  if (regressed_) regressed_->Reset();
  if (posed_) posed_->Reset();
}

BestSolver::Source BestSolver::Choose(const Measurement& then) const {
  if (then.skeleton()) return Source::kMean;
  const bool hands =
      (then.hands[0].valid || then.arms[0].valid) && (then.hands[1].valid || then.arms[1].valid);
  if (hands && regressed_ && (then.momentum.trusted || !posed_)) return Source::kRegression;
  return hands && posed_ ? Source::kPosture : Source::kMean;
}

pose::GaussNewton& BestSolver::Solver(Source source) {
  if (source == Source::kRegression) return *regressed_;
  return source == Source::kPosture ? *posed_ : plain_;
}

void BestSolver::PlaceHandsByArms(const Measurement& then, const pose::PoseTargets& targets,
                                  const Eigen::Vector3d& origin_m) {
  const bool plain_goes_on = placed_by_arms_ || source_ == Source::kMean;
  placed_by_arms_ = Choose(then) != Source::kMean && !then.both_hands();
  if (!placed_by_arms_) return;
  if (!plain_goes_on) plain_.ContinueFrom(solver().q());
  plain_.Solve(targets);
  for (std::size_t side = 0; side < kHands; ++side) {
    const body::Point& fist = model_->fists[side];
    const auto joint = static_cast<std::size_t>(fist.joint);
    hands_W_m_[side] =
        origin_m + body::Place(fist, plain_.at().R_WJ[joint], plain_.at().p_WJ[joint]);
  }
}

void BestSolver::SolveAboutRegression(const Measurement& then, const pose::PoseTargets& targets,
                                      const Eigen::Vector3d& origin_m) {
  model_->regression.Predict(features_.values(), workspace_, likely_q_);
  likely_q_.head<3>() =
      likely_q_.head<3>() * model_->root_height_m() + then.momentum.p_WC_m - origin_m;
  regressed_->Solve(targets, likely_q_);
}

void BestSolver::Solve(const Measurement& then, const pose::PoseTargets& targets,
                       const Eigen::Vector3d& origin_m, SolvedPose& pose) {
  PlaceHandsByArms(then, targets, origin_m);
  for (std::size_t side = 0; side < kHands; ++side) {
    if (then.hands[side].valid) hands_W_m_[side] = then.hands[side].p_W_m;
  }
  features_.Advance(hands_W_m_, then.momentum);
  if (posed_) posture_.Advance(hands_W_m_, then.momentum);
  const Source source = Choose(then);
  if (source != source_ && !first_) Solver(source).ContinueFrom(solver().q());
  first_ = false;
  source_ = source;
  if (source == Source::kRegression) {
    SolveAboutRegression(then, targets, origin_m);
  } else if (source == Source::kPosture) {
    likely_q_ = posture_.Predict(origin_m);
    posed_->Solve(targets, likely_q_);
  } else {
    plain_.Solve(targets);
  }
  pose.q = solver().q();
  pose.at = solver().at();
}

PriorOfPose BestSolver::prior() const {
  const double weight = options_.best.regressed_prior_weight;
  if (source_ == Source::kRegression) return {model_->rest, weight, likely_q_, regressed_->q()};
  if (source_ == Source::kPosture) {
    return {model_->posture.rest, weight, likely_q_, posed_->q()};
  }
  return {model_->basis, options_.best.prior_weight, model_->basis.mean, plain_.q()};
}

}  // namespace footing::reconstruction
