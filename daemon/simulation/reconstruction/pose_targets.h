#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "daemon/simulation/pose/targets.h"
#include "daemon/simulation/reconstruction/inputs.h"
#include "daemon/simulation/reconstruction/measurement.h"
#include "daemon/simulation/reconstruction/subject_model.h"

/// The third step: what a frame's pose is solved for. Each function adds the terms of one source;
/// a mode calls those that it has. Places are in W until MoveOrigin.
namespace footing::reconstruction {

/// Fists where they are seen; of an arm whose hand is not seen, the arm-angle error of equation
/// (6): three of the shoulder, one of the elbow, as directions of the elbow from the shoulder, of a
/// point beside the upper arm, and of the fist from the elbow. Deviations are those of the inputs.
void AddHandTargets(const SubjectModel& model, const Measurement& then, const BestConstants& best,
                    pose::PoseTargets& targets);
/// The same with the fixed deviations of paper mode.
void AddPaperHandTargets(const SubjectModel& model, const Measurement& then,
                         pose::PoseTargets& targets);

/// How the belt shows the pelvis turned, as directions that were up and forward in the T-pose: the
/// way up has the deviation of the inclination, the way forward in level directions that of the
/// heading.
void AddBeltTargets(const SubjectModel& model, const arms::HandState& belt,
                    const BestConstants& best, pose::PoseTargets& targets);

/// Both feet by their estimates, with the deviations of recorded feet, or with those of paper mode.
void AddFeetTargets(const SubjectModel& model, const Measurement& then, const FootSpread& spread,
                    pose::PoseTargets& targets);
void AddPaperFeetTargets(const SubjectModel& model, const Measurement& then,
                         pose::PoseTargets& targets);
/// Both feet where a walk has them, or where they truly are.
void AddFeetTargets(const SubjectModel& model, const std::array<FootPrior, momentum::kFeet>& feet,
                    pose::PoseTargets& targets);
void AddFeetTargets(const SubjectModel& model, const std::array<Truth::Foot, momentum::kFeet>& feet,
                    pose::PoseTargets& targets);

/// COM and angular momentum by their estimates. `mass_kg`: as weighed, which the loads' angular
/// momentum is of; the solver's masses are the body's.
void SetMomentumTargets(const SubjectModel& model, const Measurement& then, double mass_kg,
                        const Options& options, pose::PoseTargets& targets);
void SetPaperMomentumTargets(const SubjectModel& model, const Measurement& then, double mass_kg,
                             const Options& options, pose::PoseTargets& targets);
/// The COM where a walk has it.
void SetMomentumTargets(const std::optional<WalkPrior::Com>& com, pose::PoseTargets& targets);
/// Puts the truth, where there is one, in place of the estimates.
void OverrideMomentumTargets(const Truth& truth, const Options& options,
                             pose::PoseTargets& targets);

/// Takes away all targets.
void Clear(pose::PoseTargets& targets);
/// From W to a frame whose origin is there in W.
void MoveOrigin(const Eigen::Vector3d& origin_m, pose::PoseTargets& targets);

/// Ankle and ball.
using FootPoints = std::array<pose::PointTarget, 2>;
/// Those of the targets, where both are.
std::optional<FootPoints> PointsOf(const FootGeometry& foot, const pose::PoseTargets& targets);

}  // namespace footing::reconstruction
