#pragma once

#include <array>
#include <cstddef>
#include <memory>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/body/body.h"
#include "daemon/simulation/momentum/calibration.h"
#include "daemon/simulation/momentum/contact_loads.h"
#include "daemon/simulation/reconstruction/models.h"
#include "daemon/simulation/reconstruction/pose_targets.h"
#include "daemon/simulation/reconstruction/report.h"
#include "daemon/simulation/reconstruction/subject_model.h"

namespace footing::reconstruction {

/// How long a walking foot bears weight and how long it swings: what was assumed until it was seen,
/// then the newest steps of both feet. A plain value.
struct StepTimes {
  double stance_s = 0.65;
  double swing_s = 0.4;

  /// A foot bore weight, or swung, for that time. What is not a step does not count.
  void Bore(double lasted_s);
  void Swung(double lasted_s);
  /// Speed of somebody who walks ahead with such steps, by the walk ratio of step length over
  /// cadence, 0.0065 m min (Sekiya & Nagasaki 1998), which people keep at any speed.
  double UsualSpeedMps() const;
};

/// How much higher than on the ground a foot's ankle and ball are.
struct FootRise {
  double ankle_m = 0;
  double ball_m = 0;
};

/// Rise of a swinging foot, `share` (0 to 1) of its swing after it left the ground, in steps whose
/// feet come to be half a step ahead of the hips and behind. Backwards (a negative half step) it is
/// the same the other way round.
FootRise SwingRise(double share, double half_step_m);

/// Which part of the way from where it stood to where it will stand a foot has gone by then: it
/// rests at both ends.
double SwingWay(double share);

/// Cells in a shoe. Sole frame S: x from the heel to the toes, y left, origin under the heel's
/// middle. `valid` is false when nothing is known of them, which is not the same as no load.
struct InsoleFoot {
  bool valid = false;
  std::size_t count = 0;
  std::array<Eigen::Vector2d, momentum::kMaxCells> p_S_m{};
  std::array<double, momentum::kMaxCells> load_n{};
};

/// Sum of the cells' loads; 0 when nothing is known of them or they are not finite.
double TotalLoadN(const InsoleFoot& foot);

/// Measurements of insoles and hands in one frame.
struct InsoleInputs {
  double time_s = 0;
  std::array<InsoleFoot, momentum::kFeet> feet;
  std::array<HandInput, kHands> hands;  ///< W.
  std::array<arms::ArmEstimate, kHands> arms = {};
};

/// The reconstruction of somebody who walks away in shoes with cells (the paper's section 8). Cells
/// do not measure where they are: a foot that bears weight stays where it landed, and it lands as
/// far ahead of the hips as it will be behind them, by the walking speed and by how long the last
/// steps took. In between it swings there in a step's usual way. Both hands show where the hips are
/// and how fast they go; the centre of mass is over them, upright while they move. The load's place
/// in the sole shows when heel or toes may be up.
///
/// Everything happens in a frame that follows the hips smoothly, so that what was learned of people
/// in place holds; it moves evenly enough for the laws of motion. A foot whose cells are silent
/// stays where it was, with a deviation that grows. The person looks along W's x axis. Best mode's
/// steps, without its momentum. A value that can be copied.
class InsoleWalk {
 public:
  /// UsageError for other modes than the best one, for a lag, and as Reconstruction::Create.
  static Result<InsoleWalk> Create(const body::Body& body, const Models& models,
                                   const Options& options);

  /// One frame, 1 / rate_hz after the one before; the first ones are of a T-pose. Output is in W.
  const Output& Advance(const InsoleInputs& inputs);
  /// Forgets the T-pose.
  void Recalibrate();

  const Output& output() const { return output_; }
  /// Point F of a foot, W, and whether it touches the ground.
  const Eigen::Vector2d& place_m(std::size_t foot) const { return feet_[foot].place_m; }
  bool contact(std::size_t foot) const { return feet_[foot].contact.contact(); }

 private:
  struct Foot {
    Eigen::Vector2d place_m = Eigen::Vector2d::Zero();
    Eigen::Vector2d stood_m = Eigen::Vector2d::Zero();  ///< Where it last bore weight.
    momentum::FootContact contact;                      ///< It touches the ground,
    momentum::FootContact bearing;                      ///< and bears weight.
    double silent_s = 0;                                ///< Since its cells were heard.
    FootPrior prior;  ///< As the pose was solved for, in the moving frame.
  };

  InsoleWalk(std::shared_ptr<const SubjectModel> model, const Options& options);
  void StandUnder(const std::array<HandInput, kHands>& hands);
  Eigen::Vector2d PlaceInPose(std::size_t f) const;
  double HalfStepM() const;
  double AsideM(std::size_t f) const;
  Eigen::Vector2d LandingPlace(std::size_t f, double after_s) const;
  void BeginWalking(const InsoleInputs& inputs);
  void Step(std::size_t f, bool bore, double lasted_s);
  void AdvanceFoot(std::size_t f, const InsoleFoot& cells);
  Inputs InMovingFrame(const InsoleInputs& inputs) const;
  FootPrior Bearing(std::size_t f, const InsoleFoot& cells) const;
  FootPrior Swinging(std::size_t f) const;
  FootPrior Expected(std::size_t f, const InsoleFoot& cells) const;
  WalkPrior::Com ComOverHips() const;
  WalkPrior Expected(const InsoleInputs& inputs);
  void AdvancePose(const InsoleInputs& inputs);
  void ReportInWorld();
  void MoveFrame(const std::array<HandInput, kHands>& hands);

  std::shared_ptr<const SubjectModel> model_;  ///< Copies share it; the mode points into it.
  Options options_;
  momentum::TPoseCalibration calibration_;
  InsoleMode mode_;
  Output in_frame_;  ///< As `output_`, but in the moving frame.
  std::array<Foot, momentum::kFeet> feet_;
  bool placed_ = false;
  bool walking_ = false;  ///< The T-pose is over.
  StepTimes times_;
  double since_landing_s_ = 0;
  Eigen::Vector2d frame_m_ = Eigen::Vector2d::Zero();  ///< Origin of the moving frame, W.
  Eigen::Vector2d frame_mps_ = Eigen::Vector2d::Zero();
  Output output_;
};

}  // namespace footing::reconstruction
