#include "daemon/simulation/reconstruction/insole_walk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "daemon/simulation/reconstruction/pose_targets.h"

namespace footing::reconstruction {
namespace {

constexpr double kNewest = 0.4;  // Part of the newest step in the mean.
constexpr double kLeastStanceS = 0.35, kMostStanceS = 1.3;
constexpr double kLeastSwingS = 0.2, kMostSwingS = 0.8;

constexpr double kWalkRatioMMin = 0.0065;
constexpr double kMostUsualMps = 2;

// Heights through a swing, m, for a half step of kUsualHalfStepM: after mass_bvh/walk.bvh, rounded,
// and 3 cm for feet that clear the ground.
constexpr std::array<double, 5> kShares{0, 0.25, 0.5, 0.8, 1};
constexpr std::array<double, 5> kAnkleM{0.07, 0.12, 0.08, 0.02, 0.01};
constexpr std::array<double, 5> kBallM{0.02, 0.04, 0.03, 0.08, 0.04};
constexpr double kClearM = 0.03;
constexpr double kUsualHalfStepM = 0.33;
constexpr double kMostSize = 1.3;

void Approach(double value, double least, double most, double& mean) {
  if (value > least && value < most) mean += kNewest * (value - mean);
}

double Between(const std::array<double, 5>& values, double share) {
  std::size_t i = 1;
  while (i + 1 < kShares.size() && share > kShares[i]) ++i;
  const double part = (share - kShares[i - 1]) / (kShares[i] - kShares[i - 1]);
  return values[i - 1] + std::clamp(part, 0.0, 1.0) * (values[i] - values[i - 1]);
}

}  // namespace

void StepTimes::Bore(double lasted_s) { Approach(lasted_s, kLeastStanceS, kMostStanceS, stance_s); }

void StepTimes::Swung(double lasted_s) { Approach(lasted_s, kLeastSwingS, kMostSwingS, swing_s); }

FootRise SwingRise(double share, double half_step_m) {
  const double size = std::min(kMostSize, std::abs(half_step_m) / kUsualHalfStepM);
  const double at = half_step_m < 0 ? 1 - share : share;
  return {kClearM + size * Between(kAnkleM, at), kClearM + size * Between(kBallM, at)};
}

double StepTimes::UsualSpeedMps() const {
  const double cadence_hz = 2 / (stance_s + swing_s);
  return std::min(kMostUsualMps, 60 * kWalkRatioMMin * cadence_hz * cadence_hz);
}

double SwingWay(double share) { return share * share * (3 - 2 * share); }

namespace {

constexpr momentum::FootContactConfig kContact{40, 25, 2, 10};
// Parts of the weight: a swinging foot may brush the ground with less.
constexpr double kBearsShare = 0.22, kBearsNoMoreShare = 0.11;
constexpr double kFrameRadps = 8;  // Rate of the moving frame, which is critically damped.
constexpr double kSettleS = 0.12;  // After which a landing's place is known as well as later.
constexpr double kPlacedSdM = 0.03, kLandingSdM = 0.05, kSwingSdM = 0.05, kLiftedSdM = 0.12;
constexpr double kHandsAheadM = 0.07;  // Hands ahead of the hips, in the mean of a stride.
constexpr double kAsideM = 0.08;       // A walking foot from the middle.
constexpr double kStandsS = 10;        // Since the last landing of somebody who has not stepped.
constexpr double kHipsSdM = 0.06;      // The frame, as the centre of mass' place.
// The height of the centre of mass, of somebody who walks this fast or faster, and who stands.
constexpr double kUprightSdM = 0.04, kStandingSdM = 0.34, kWalkingMps = 0.5;
constexpr double kArmsHangM = 0.028;  // Lower than in the T-pose by that (momentum::Subject).
// A foot whose cells are silent: how fast its place becomes unknown, and how far off it is at most.
constexpr double kSilentSdMps = 0.5, kSilentSdM = 0.6;
constexpr double kHeelShare = 0.25, kBallShare = 0.75;  // Parts of the sole: COP behind or ahead.

Eigen::Vector3d Up(double z) { return {0, 0, z}; }

Eigen::Vector3d Flat(const Eigen::Vector2d& p) { return {p.x(), p.y(), 0}; }

}  // namespace

double TotalLoadN(const InsoleFoot& foot) {
  double total_n = 0;
  for (std::size_t i = 0; i < std::min(foot.count, momentum::kMaxCells); ++i)
    total_n += foot.load_n[i];
  return foot.valid && std::isfinite(total_n) ? total_n : 0;
}

Result<InsoleWalk> InsoleWalk::Create(const body::Body& body, const Models& models,
                                      const Options& options) {
  if (options.mode != Mode::kBest || options.lag_s > 0) {
    return UsageError("insoles: only the best mode without lag walks");
  }
  if (const auto checked = CheckOptions(options); !checked) return checked.error();
  auto made = WalkSubjectModel(body, models, options);
  if (!made) return made.error();
  return InsoleWalk(std::make_shared<const SubjectModel>(std::move(made).value()), options);
}

InsoleWalk::InsoleWalk(std::shared_ptr<const SubjectModel> model, const Options& options)
    : model_(std::move(model)), options_(options), mode_(*model_, options) {
  Recalibrate();
}

void InsoleWalk::Recalibrate() {
  calibration_ = {};
  ReportTPose(*model_, options_, in_frame_);
  output_ = in_frame_;
  frame_m_.setZero();
  frame_mps_.setZero();
  placed_ = walking_ = false;
  times_ = {};
  since_landing_s_ = kStandsS;
  for (std::size_t f = 0; f < feet_.size(); ++f) {
    Foot foot;
    foot.contact = momentum::FootContact(kContact);
    foot.place_m = PlaceInPose(f);
    feet_[f] = foot;
  }
}

/// Where F is when the pose's ankle is where it is.
Eigen::Vector2d InsoleWalk::PlaceInPose(std::size_t f) const {
  const FootGeometry& geometry = model_->feet[f];
  const auto joint = static_cast<std::size_t>(geometry.ankle.joint);
  const Eigen::Vector3d ankle =
      body::Place(geometry.ankle, output_.R_WJ[joint], output_.p_WJ_m[joint]);
  return (ankle - geometry.R_WF * geometry.ankle_F_m).head<2>();
}

/// The T-pose under the hands: where in W it is stood.
void InsoleWalk::StandUnder(const std::array<HandInput, kHands>& hands) {
  Eigen::Vector2d off = Eigen::Vector2d::Zero();
  for (std::size_t side = 0; side < kHands; ++side) {
    if (!hands[side].valid || !hands[side].p_W_m.allFinite()) return;
    const body::Point& fist = model_->fists[side];
    const auto joint = static_cast<std::size_t>(fist.joint);
    off += 0.5 * (hands[side].p_W_m - body::Place(fist, output_.R_WJ[joint], output_.p_WJ_m[joint]))
                     .head<2>();
  }
  for (Foot& foot : feet_) foot.place_m += off;
  frame_m_ = 0.5 * (feet_[0].place_m + feet_[1].place_m);
  placed_ = true;
}

FootPrior InsoleWalk::Bearing(std::size_t f, const InsoleFoot& cells) const {
  const FootGeometry& geometry = model_->feet[f];
  const Eigen::Vector3d place = Flat(feet_[f].place_m - frame_m_);
  FootPrior foot{place + geometry.R_WF * geometry.ankle_F_m,
                 place + geometry.R_WF * geometry.toe_F_m};
  const double settled = std::min(1.0, feet_[f].bearing.since_s() / kSettleS);
  foot.ankle_sd_m = foot.toe_sd_m = kLandingSdM + settled * (kPlacedSdM - kLandingSdM);
  double total = 0, moment = 0;
  for (std::size_t i = 0; i < cells.count; ++i) {
    total += cells.load_n[i];
    moment += cells.load_n[i] * cells.p_S_m[i].x();
  }
  // The COP under the ball: the heel may be up; under the heel: the toes.
  const double share = moment / total / geometry.shape.length_m;
  if (!cells.valid || total <= 0 || !std::isfinite(share)) return foot;
  const auto beyond = [](double by, double over) { return std::clamp(by / over, 0.0, 1.0); };
  foot.ankle_sd_m += kLiftedSdM * beyond(share - kBallShare, 1 - kBallShare);
  foot.toe_sd_m += kLiftedSdM * beyond(kHeelShare - share, kHeelShare);
  return foot;
}

/// How far ahead of the hips a foot lands, and how far behind it leaves the ground.
double InsoleWalk::HalfStepM() const { return 0.5 * times_.stance_s * frame_mps_.x(); }

/// Between where the pose has it and where walking people do: the pose alone would drift.
double InsoleWalk::AsideM(std::size_t f) const {
  return 0.5 * (PlaceInPose(f).y() + frame_m_.y() + (f == 0 ? kAsideM : -kAsideM));
}

/// The ankle half a step ahead of where the hips will be. A pose that lags behind would place it
/// behind, and lag the more: it is not asked.
Eigen::Vector2d InsoleWalk::LandingPlace(std::size_t f, double after_s) const {
  const double ankle_ahead_m = (model_->feet[f].R_WF * model_->feet[f].ankle_F_m).x();
  return {frame_m_.x() + after_s * frame_mps_.x() + HalfStepM() - ankle_ahead_m, AsideM(f)};
}

FootPrior InsoleWalk::Swinging(std::size_t f) const {
  const FootGeometry& geometry = model_->feet[f];
  const double share = std::min(1.0, feet_[f].bearing.since_s() / times_.swing_s);
  const Eigen::Vector2d to = LandingPlace(f, (1 - share) * times_.swing_s);
  Eigen::Vector2d place = feet_[f].stood_m + SwingWay(share) * (to - feet_[f].stood_m);
  place.y() = to.y();
  const Eigen::Vector3d at = Flat(place - frame_m_);
  const FootRise rise = SwingRise(share, HalfStepM());
  return {at + geometry.R_WF * geometry.ankle_F_m + Up(rise.ankle_m),
          at + geometry.R_WF * geometry.toe_F_m + Up(rise.ball_m), kSwingSdM, kSwingSdM};
}

FootPrior InsoleWalk::Expected(std::size_t f, const InsoleFoot& cells) const {
  FootPrior foot = feet_[f].bearing.contact() ? Bearing(f, cells) : Swinging(f);
  const double silent_sd_m = kSilentSdMps * feet_[f].silent_s;
  for (double* sd_m : {&foot.ankle_sd_m, &foot.toe_sd_m})
    *sd_m = std::min(kSilentSdM, std::hypot(*sd_m, silent_sd_m));
  return foot;
}

/// The frame is where the hips are.
WalkPrior::Com InsoleWalk::ComOverHips() const {
  WalkPrior::Com com{body::CentreOfMass(model_->body, model_->t_pose_at) - Up(kArmsHangM), {}};
  com.p_W_m.head<2>() -= model_->t_pose_at.p_WJ[0].head<2>();
  const double stands = std::max(0.0, 1 - std::abs(frame_mps_.x()) / kWalkingMps);
  com.sd_m << kHipsSdM, kHipsSdM, kUprightSdM + stands * (kStandingSdM - kUprightSdM);
  return com;
}

WalkPrior InsoleWalk::Expected(const InsoleInputs& inputs) {
  WalkPrior prior;
  if (inputs.hands[0].valid && inputs.hands[1].valid) prior.com = ComOverHips();
  for (std::size_t f = 0; f < momentum::kFeet; ++f)
    prior.feet[f] = feet_[f].prior = Expected(f, inputs.feet[f]);
  return prior;
}

Inputs InsoleWalk::InMovingFrame(const InsoleInputs& inputs) const {
  Inputs out;
  out.loads.time_s = inputs.time_s;
  out.hands = inputs.hands;
  out.arms = inputs.arms;
  for (HandInput& hand : out.hands) hand.p_W_m -= Flat(frame_m_);
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    const InsoleFoot& cells = inputs.feet[f];
    momentum::FootLoads& loads = out.loads.feet[f];
    loads.valid = cells.valid;
    loads.count = std::min(cells.count, momentum::kMaxCells);
    for (std::size_t i = 0; i < loads.count; ++i) {
      const Eigen::Vector3d p_F =
          Flat(cells.p_S_m[i]) - Eigen::Vector3d(model_->feet[f].RestM(), 0, 0);
      loads.cells[i] = {Flat(feet_[f].place_m - frame_m_) + model_->feet[f].R_WF * p_F,
                        cells.load_n[i]};
    }
  }
  return out;
}

void InsoleWalk::AdvancePose(const InsoleInputs& inputs) {
  const Inputs moved = InMovingFrame(inputs);
  if (std::isfinite(inputs.time_s)) in_frame_.time_s = inputs.time_s;
  if (in_frame_.calibrated) {
    mode_.Advance(moved, Expected(inputs), in_frame_);
  } else if (Calibrate(moved, options_.step_s(), calibration_, in_frame_)) {
    mode_.Start(calibration_.result());
  }
}

/// The load of a foot that bears weight is a share of the weight, which is known by now.
void InsoleWalk::BeginWalking(const InsoleInputs& inputs) {
  const double weight_n = KilogramsToNewtons(output_.mass_kg);
  momentum::FootContactConfig bears = kContact;
  bears.on_n = kBearsShare * weight_n;
  bears.off_n = kBearsNoMoreShare * weight_n;
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    feet_[f].bearing = momentum::FootContact(bears);
    feet_[f].bearing.Advance(TotalLoadN(inputs.feet[f]), options_.step_s());
    feet_[f].stood_m = feet_[f].place_m;
  }
  walking_ = true;
}

/// A foot has left the ground (`bore`) or landed; what it did before lasted `lasted_s`.
void InsoleWalk::Step(std::size_t f, bool bore, double lasted_s) {
  if (bore) {
    times_.Bore(lasted_s);
    feet_[f].stood_m = feet_[f].place_m;
  } else {
    times_.Swung(lasted_s);
    feet_[f].place_m = LandingPlace(f, 0);
    since_landing_s_ = 0;
  }
}

void InsoleWalk::AdvanceFoot(std::size_t f, const InsoleFoot& cells) {
  Foot& foot = feet_[f];
  foot.silent_s = cells.valid ? 0 : foot.silent_s + options_.step_s();
  if (cells.valid) {
    const double load_n = TotalLoadN(cells);
    foot.contact.Advance(load_n, options_.step_s());
    const bool bore = foot.bearing.contact();
    const double lasted_s = foot.bearing.since_s();
    if (walking_ && foot.bearing.Advance(load_n, options_.step_s()) != bore)
      Step(f, bore, lasted_s);
  }
  if (walking_ && !foot.bearing.contact()) foot.place_m.y() = AsideM(f);
}

const Output& InsoleWalk::Advance(const InsoleInputs& inputs) {
  if (!placed_) StandUnder(inputs.hands);
  if (output_.calibrated && !walking_) BeginWalking(inputs);
  since_landing_s_ += options_.step_s();
  for (std::size_t f = 0; f < momentum::kFeet; ++f) AdvanceFoot(f, inputs.feet[f]);
  AdvancePose(inputs);
  ReportInWorld();
  if (output_.calibrated) MoveFrame(inputs.hands);
  return output_;
}

void InsoleWalk::ReportInWorld() {
  output_ = in_frame_;
  const Eigen::Vector3d frame = Flat(frame_m_);
  output_.q.head<3>() += frame;
  for (Eigen::Vector3d& p : output_.p_WJ_m) p += frame;
  output_.com_W_m += frame;
  output_.momentum.p_WC_m += frame;
  output_.momentum.v_WC_mps += Flat(frame_mps_);
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    momentum::FootEstimate& foot = output_.momentum.feet[f];
    const FootPrior& prior = feet_[f].prior;
    foot.p_WP_m += frame;
    if (!walking_) continue;
    foot.p_WF_m = frame + prior.ankle_W_m - model_->feet[f].R_WF * model_->feet[f].ankle_F_m;
    foot.variance_m2.setConstant(std::pow(std::min(prior.ankle_sd_m, prior.toe_sd_m), 2));
  }
}

/// Both hands' middle goes with the body, without the swing of the arms. Without hands nothing
/// measures the place, and the speed is that of somebody who walks ahead with these steps.
void InsoleWalk::MoveFrame(const std::array<HandInput, kHands>& hands) {
  const Eigen::Vector2d middle = 0.5 * (hands[0].p_W_m + hands[1].p_W_m).head<2>();
  if (hands[0].valid && hands[1].valid && middle.allFinite()) {
    // An observer of place and velocity: no lag behind somebody who walks evenly.
    const Eigen::Vector2d off = middle - Eigen::Vector2d(kHandsAheadM, 0) - frame_m_;
    frame_mps_ += kFrameRadps * kFrameRadps * options_.step_s() * off;
    frame_m_ += (frame_mps_ + 2 * kFrameRadps * off) * options_.step_s();
    return;
  }
  const bool steps = since_landing_s_ < times_.stance_s + times_.swing_s;
  const Eigen::Vector2d usual(steps ? times_.UsualSpeedMps() : 0, 0);
  frame_mps_ += kFrameRadps * options_.step_s() * (usual - frame_mps_);
  frame_m_ += frame_mps_ * options_.step_s();
}

}  // namespace footing::reconstruction
