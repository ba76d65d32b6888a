#pragma once

#include <memory>
#include <variant>

#include "common/base/result.h"
#include "common/body/body.h"
#include "daemon/simulation/momentum/calibration.h"
#include "daemon/simulation/reconstruction/best_mode.h"
#include "daemon/simulation/reconstruction/models.h"
#include "daemon/simulation/reconstruction/pose_targets.h"
#include "daemon/simulation/reconstruction/report.h"
#include "daemon/simulation/reconstruction/subject_model.h"

/// From the cells under two feet and the places of two hands to the pose of the whole body (Ha, Bai
/// & Liu 2011, section 6, and what goes beyond it: docs/pose.md). Steps, each a function or a small
/// class: calibrate, estimate and targets (pose_targets.h), solve (best_mode.h,
/// pose::FibonacciSearch), clean up and report (report.h). Modes compose them.
namespace footing::reconstruction {

/// A person on the cells: calibrates in a T-pose, then reconstructs in best or paper mode. A value
/// that can be copied; no allocation in Advance and Recalibrate. The body's layout must be that of
/// the basis (motion::WithLandmarksOnly, body::StandardPerson).
class Reconstruction {
 public:
  /// UsageError when an option is out of range; InvalidData when the models do not fit the body.
  static Result<Reconstruction> Create(const body::Body& body, const Models& models,
                                       const Options& options);

  /// One frame, 1 / rate_hz after the one before.
  const Output& Advance(const Inputs& inputs) { return Advance(inputs, Truth{}); }
  /// For evaluation: with parts of the truth in place of their estimates.
  const Output& Advance(const Inputs& inputs, const Truth& truth);
  /// Takes over the T-pose of the same person, if it is complete: the momentum starts as it was
  /// then. No allocation.
  void ContinueFrom(const Reconstruction& other);
  /// Forgets the T-pose.
  void Recalibrate();

  const body::Body& body() const { return model_->body; }
  const Output& output() const { return output_; }
  /// Features of the last frame of best mode, for training; only when calibrated.
  const Features& features() const { return std::get<BestMode>(mode_).features(); }
  const LikelyPosture& posture() const { return std::get<BestMode>(mode_).posture(); }

 private:
  using AnyMode = std::variant<BestMode, PaperMode>;

  Reconstruction(std::shared_ptr<const SubjectModel> model, AnyMode mode, const Options& options);

  std::shared_ptr<const SubjectModel> model_;  ///< Copies share it; the steps point into it.
  Options options_;
  momentum::TPoseCalibration calibration_;
  AnyMode mode_;
  Output output_;
};

}  // namespace footing::reconstruction
