#include "daemon/simulation/reconstruction/insole_walk.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/body/kinematics.h"

namespace footing::reconstruction {
namespace {

constexpr momentum::FootContactConfig kContact{40, 25, 2, 10};
constexpr double kFrameRadps = 4;  // Of the moving frame, which is critically damped.
constexpr double kSettleS = 0.12;  // A landing's place is doubted so long.
constexpr double kPlacedSdM = 0.03, kLandingSdM = 0.05, kSwingSdM = 0.05, kLiftedSdM = 0.12;
constexpr double kSwingLiftM = 0.06;
// A foot leaves the ground this long behind the body and lands so long before it: half a step of
// 0.55 s; it is in the air for about so long.
constexpr double kHalfStepS = 0.28;
constexpr double kSwingS = 0.4;
constexpr double kHandsAheadM = 0.05;                   // Of the feet, in the mean of a stride.
constexpr double kHeelShare = 0.25, kBallShare = 0.75;  // Of the sole: COP behind or ahead.

Eigen::Vector3d Up(double z) { return {0, 0, z}; }

Eigen::Vector3d Flat(const Eigen::Vector2d& p) { return {p.x(), p.y(), 0}; }

}  // namespace

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
      output_(reconstruction_.output()) {
  for (Foot& foot : feet_) foot.contact = momentum::FootContact(kContact);
  for (std::size_t f = 0; f < feet_.size(); ++f) feet_[f].place_m = PlaceInPose(f);
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
  const double settled = std::min(1.0, feet_[f].contact.since_s() / kSettleS);
  foot.ankle_sd_m = foot.toe_sd_m = kLandingSdM + settled * (kPlacedSdM - kLandingSdM);
  double total = 0, moment = 0;
  for (std::size_t i = 0; i < cells.count; ++i) {
    total += cells.load_n[i];
    moment += cells.load_n[i] * cells.p_F_m[i].x();
  }
  if (total <= 0) return foot;
  // The COP under the ball: the heel may be up; under the heel: the toes.
  const double share = geometry.shape.rest_share + moment / total / geometry.shape.length_m;
  const auto beyond = [](double by, double over) { return std::clamp(by / over, 0.0, 1.0); };
  foot.ankle_sd_m += kLiftedSdM * beyond(share - kBallShare, 1 - kBallShare);
  foot.toe_sd_m += kLiftedSdM * beyond(kHeelShare - share, kHeelShare);
  return foot;
}

/// Half a step ahead of the body. A pose that lags behind would place it behind, and lag the more.
Eigen::Vector2d InsoleWalk::LandingPlace(std::size_t f) const {
  return {frame_m_.x() + kHalfStepS * frame_mps_.x(), PlaceInPose(f).y()};
}

Known::Foot InsoleWalk::Swinging(std::size_t f) const {
  const FootGeometry& geometry = geometry_[f];
  const double swung = std::min(1.0, feet_[f].contact.since_s() / kSwingS);
  Eigen::Vector2d place = feet_[f].place_m - frame_m_;
  place.x() = kHalfStepS * (2 * swung - 1) * frame_mps_.x();
  const Eigen::Vector3d at = Flat(place) + Up(kSwingLiftM);
  return {at + geometry.R_WF * geometry.ankle_F_m, at + geometry.R_WF * geometry.toe_F_m, kSwingSdM,
          kSwingSdM};
}

Inputs InsoleWalk::InMovingFrame(const InsoleInputs& inputs) const {
  Inputs out;
  out.loads.time_s = inputs.time_s;
  out.hands = inputs.hands;
  for (HandInput& hand : out.hands) hand.p_W_m -= Flat(frame_m_);
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    const InsoleFoot& cells = inputs.feet[f];
    momentum::FootLoads& loads = out.loads.feet[f];
    loads.valid = cells.valid;
    loads.count = std::min(cells.count, momentum::kMaxCells);
    for (std::size_t i = 0; i < loads.count; ++i) {
      const Eigen::Vector3d p_F = Flat(cells.p_F_m[i]);
      loads.cells[i] = {Flat(feet_[f].place_m - frame_m_) + geometry_[f].R_WF * p_F,
                        cells.load_n[i]};
    }
  }
  if (!reconstruction_.output().calibrated) return out;
  out.known.feet.emplace();
  for (std::size_t f = 0; f < momentum::kFeet; ++f)
    (*out.known.feet)[f] = feet_[f].contact.contact() ? Carrying(f, inputs.feet[f]) : Swinging(f);
  return out;
}

const Output& InsoleWalk::Advance(const InsoleInputs& inputs) {
  if (!placed_) StandUnder(inputs.hands);
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    Foot& foot = feet_[f];
    double total = 0;
    for (std::size_t i = 0; i < std::min(inputs.feet[f].count, momentum::kMaxCells); ++i)
      total += inputs.feet[f].load_n[i];
    if (inputs.feet[f].valid && std::isfinite(total)) {
      const bool before = foot.contact.contact();
      const bool now = foot.contact.Advance(total, step_s_);
      if (output_.calibrated && now && !before) foot.place_m = LandingPlace(f);
    }
    if (!output_.calibrated) continue;
    if (!foot.contact.contact()) foot.place_m.y() = PlaceInPose(f).y();
  }
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
  output_.momentum.p_WC_m += frame;
  output_.momentum.v_WC_mps += Flat(frame_mps_);
  for (momentum::FootEstimate& foot : output_.momentum.feet) {
    foot.p_WP_m += frame;
    foot.p_WF_m += frame;
    foot.p_WHeel_m += frame;
    foot.p_WToe_m += frame;
  }
}

/// Both hands' middle goes with the body, without the swing of the arms; without hands, the feet's.
void InsoleWalk::MoveFrame(const std::array<HandInput, kHands>& hands) {
  Eigen::Vector2d target = 0.5 * (PlaceInPose(0) + PlaceInPose(1));
  const Eigen::Vector2d middle = 0.5 * (hands[0].p_W_m + hands[1].p_W_m).head<2>();
  if (hands[0].valid && hands[1].valid && middle.allFinite()) {
    target = middle - Eigen::Vector2d(kHandsAheadM, 0);
  }
  // An observer of place and velocity: no lag behind somebody who walks evenly.
  const Eigen::Vector2d off = target - frame_m_;
  frame_mps_ += kFrameRadps * kFrameRadps * step_s_ * off;
  frame_m_ += (frame_mps_ + 2 * kFrameRadps * off) * step_s_;
}

}  // namespace footing::reconstruction
