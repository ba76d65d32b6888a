#include "daemon/simulation/reconstruction/insole_walk.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/body/kinematics.h"
#include "common/body/momentum.h"
#include "common/units/units.h"

namespace footing::reconstruction {
namespace {

constexpr momentum::FootContactConfig kContact{40, 25, 2, 10};
// Of the weight: a swinging foot may brush the ground with less.
constexpr double kBearsShare = 0.22, kBearsNoMoreShare = 0.11;
constexpr double kFrameRadps = 8;  // Of the moving frame, which is critically damped.
constexpr double kSettleS = 0.12;  // A landing's place is doubted so long.
constexpr double kPlacedSdM = 0.03, kLandingSdM = 0.05, kSwingSdM = 0.05, kLiftedSdM = 0.12;
constexpr double kHandsAheadM = 0.07;  // Of the hips, in the mean of a stride.
constexpr double kAsideM = 0.08;       // A walking foot from the middle.
constexpr double kStandsS = 10;        // Who has not stepped yet, for so long.
constexpr double kHipsSdM = 0.06;      // The frame, as the centre of mass' place.
// The height of the centre of mass, of somebody who walks this fast or faster, and who stands.
constexpr double kUprightSdM = 0.04, kStandingSdM = 0.34, kWalkingMps = 0.5;
constexpr double kArmsHangM = 0.028;  // Lower than in the T-pose by that (momentum::Subject).
// A foot that nobody tells of: how fast its place becomes unknown, and how far off it is at most.
constexpr double kSilentSdMps = 0.5, kSilentSdM = 0.6;
constexpr double kHeelShare = 0.25, kBallShare = 0.75;  // Of the sole: COP behind or ahead.

Eigen::Vector3d Up(double z) { return {0, 0, z}; }

/// Of the T-pose: from the hips, over the ground.
Eigen::Vector3d CentreOverHips(const body::Body& body) {
  body::Kinematics at(body.skeleton);
  body::ComputeKinematics(body.skeleton, body::TPose(body.skeleton, body.landmarks), at);
  Eigen::Vector3d com_m = body::CentreOfMass(body, at);
  com_m.head<2>() -= at.p_WJ[0].head<2>();
  return com_m;
}

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
  // The momentum's priors are of people in place: they hold C back, and no sensor here says more
  // of it than the hands.
  Options walking = options;
  walking.use_momentum = walking.use_angular_momentum = false;
  auto made = Reconstruction::Create(body, models, walking);
  if (!made) return made.error();
  return InsoleWalk(std::move(*made), options);
}

InsoleWalk::InsoleWalk(Reconstruction reconstruction, const Options& options)
    : reconstruction_(std::move(reconstruction)),
      step_s_(1 / options.rate_hz),
      geometry_(StandingFeet(reconstruction_.body())),
      com_m_(CentreOverHips(reconstruction_.body())),
      output_(reconstruction_.output()) {
  Recalibrate();
}

void InsoleWalk::Recalibrate() {
  reconstruction_.Recalibrate();
  output_ = reconstruction_.output();
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
  const FootGeometry& geometry = geometry_[f];
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
    const body::Point fist = body::Fist(reconstruction_.body(), static_cast<int>(side));
    const auto joint = static_cast<std::size_t>(fist.joint);
    off += 0.5 * (hands[side].p_W_m - body::Place(fist, output_.R_WJ[joint], output_.p_WJ_m[joint]))
                     .head<2>();
  }
  for (Foot& foot : feet_) foot.place_m += off;
  frame_m_ = 0.5 * (feet_[0].place_m + feet_[1].place_m);
  placed_ = true;
}

Known::Foot InsoleWalk::Carrying(std::size_t f, const InsoleFoot& cells) const {
  const FootGeometry& geometry = geometry_[f];
  const Eigen::Vector3d place = Flat(feet_[f].place_m - frame_m_);
  Known::Foot foot{place + geometry.R_WF * geometry.ankle_F_m,
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
  const double ankle_ahead_m = (geometry_[f].R_WF * geometry_[f].ankle_F_m).x();
  return {frame_m_.x() + after_s * frame_mps_.x() + HalfStepM() - ankle_ahead_m, AsideM(f)};
}

Known::Foot InsoleWalk::Swinging(std::size_t f) const {
  const FootGeometry& geometry = geometry_[f];
  const double share = std::min(1.0, feet_[f].bearing.since_s() / times_.swing_s);
  const Eigen::Vector2d to = LandingPlace(f, (1 - share) * times_.swing_s);
  Eigen::Vector2d place = feet_[f].stood_m + SwingWay(share) * (to - feet_[f].stood_m);
  place.y() = to.y();
  const Eigen::Vector3d at = Flat(place - frame_m_);
  const FootRise rise = SwingRise(share, HalfStepM());
  return {at + geometry.R_WF * geometry.ankle_F_m + Up(rise.ankle_m),
          at + geometry.R_WF * geometry.toe_F_m + Up(rise.ball_m), kSwingSdM, kSwingSdM};
}

Known::Foot InsoleWalk::Believed(std::size_t f, const InsoleFoot& cells) const {
  Known::Foot foot = feet_[f].bearing.contact() ? Carrying(f, cells) : Swinging(f);
  const double doubt_m = kSilentSdMps * feet_[f].silent_s;
  for (double* sd_m : {&foot.ankle_sd_m, &foot.toe_sd_m})
    *sd_m = std::min(kSilentSdM, std::hypot(*sd_m, doubt_m));
  return foot;
}

/// The centre of mass over the hips, which are where the frame is.
void InsoleWalk::LeanOnFrame(Known& known) const {
  const double stands = std::max(0.0, 1 - std::abs(frame_mps_.x()) / kWalkingMps);
  known.com_W_m = com_m_ - Up(kArmsHangM);
  known.com_sd_m << kHipsSdM, kHipsSdM, kUprightSdM + stands * (kStandingSdM - kUprightSdM);
}

Inputs InsoleWalk::InMovingFrame(const InsoleInputs& inputs) {
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
          Flat(cells.p_S_m[i]) - Eigen::Vector3d(geometry_[f].RestM(), 0, 0);
      loads.cells[i] = {Flat(feet_[f].place_m - frame_m_) + geometry_[f].R_WF * p_F,
                        cells.load_n[i]};
    }
  }
  if (!reconstruction_.output().calibrated) return out;
  if (inputs.hands[0].valid && inputs.hands[1].valid) LeanOnFrame(out.known);
  out.known.feet.emplace();
  for (std::size_t f = 0; f < momentum::kFeet; ++f)
    (*out.known.feet)[f] = feet_[f].known = Believed(f, inputs.feet[f]);
  return out;
}

/// How much load is a foot that bears is known when the weight is.
void InsoleWalk::BeginWalking(const InsoleInputs& inputs) {
  const double weight_n = KilogramsToNewtons(output_.mass_kg);
  momentum::FootContactConfig bears = kContact;
  bears.on_n = kBearsShare * weight_n;
  bears.off_n = kBearsNoMoreShare * weight_n;
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    feet_[f].bearing = momentum::FootContact(bears);
    feet_[f].bearing.Advance(TotalLoadN(inputs.feet[f]), step_s_);
    feet_[f].stood_m = feet_[f].place_m;
  }
  walking_ = true;
}

/// A foot has landed, or left the ground, after it did the other thing for so long.
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
  foot.silent_s = cells.valid ? 0 : foot.silent_s + step_s_;
  if (cells.valid) {
    const double load_n = TotalLoadN(cells);
    foot.contact.Advance(load_n, step_s_);
    const bool bore = foot.bearing.contact();
    const double lasted_s = foot.bearing.since_s();
    if (walking_ && foot.bearing.Advance(load_n, step_s_) != bore) Step(f, bore, lasted_s);
  }
  if (walking_ && !foot.bearing.contact()) foot.place_m.y() = AsideM(f);
}

const Output& InsoleWalk::Advance(const InsoleInputs& inputs) {
  if (!placed_) StandUnder(inputs.hands);
  if (output_.calibrated && !walking_) BeginWalking(inputs);
  since_landing_s_ += step_s_;
  for (std::size_t f = 0; f < momentum::kFeet; ++f) AdvanceFoot(f, inputs.feet[f]);
  reconstruction_.Advance(InMovingFrame(inputs));
  Tell();
  if (output_.calibrated) MoveFrame(inputs.hands);
  return output_;
}

void InsoleWalk::Tell() {
  output_ = reconstruction_.output();
  const Eigen::Vector3d frame = Flat(frame_m_);
  output_.q.head<3>() += frame;
  for (Eigen::Vector3d& p : output_.p_WJ_m) p += frame;
  output_.com_W_m += frame;
  output_.momentum.p_WC_m += frame;
  output_.momentum.v_WC_mps += Flat(frame_mps_);
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    momentum::FootEstimate& foot = output_.momentum.feet[f];
    const Known::Foot& known = feet_[f].known;
    foot.p_WP_m += frame;
    if (!walking_) continue;
    foot.p_WF_m = frame + known.ankle_W_m - geometry_[f].R_WF * geometry_[f].ankle_F_m;
    foot.variance_m2.setConstant(std::pow(std::min(known.ankle_sd_m, known.toe_sd_m), 2));
    momentum::PlaceHeelAndToe(geometry_[f].shape, foot);
  }
}

/// Both hands' middle goes with the body, without the swing of the arms. Without hands nothing
/// tells the place, and the speed is that of somebody who walks ahead with these steps.
void InsoleWalk::MoveFrame(const std::array<HandInput, kHands>& hands) {
  const Eigen::Vector2d middle = 0.5 * (hands[0].p_W_m + hands[1].p_W_m).head<2>();
  if (hands[0].valid && hands[1].valid && middle.allFinite()) {
    // An observer of place and velocity: no lag behind somebody who walks evenly.
    const Eigen::Vector2d off = middle - Eigen::Vector2d(kHandsAheadM, 0) - frame_m_;
    frame_mps_ += kFrameRadps * kFrameRadps * step_s_ * off;
    frame_m_ += (frame_mps_ + 2 * kFrameRadps * off) * step_s_;
    return;
  }
  const bool steps = since_landing_s_ < times_.stance_s + times_.swing_s;
  const Eigen::Vector2d usual(steps ? times_.UsualSpeedMps() : 0, 0);
  frame_mps_ += kFrameRadps * step_s_ * (usual - frame_mps_);
  frame_m_ += frame_mps_ * step_s_;
}

}  // namespace footing::reconstruction
