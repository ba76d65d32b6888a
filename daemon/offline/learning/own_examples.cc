#include <algorithm>
#include <cmath>

#include "common/body/kinematics.h"
#include "common/body/points.h"
#include "common/virtual/devices/random.h"
#include "daemon/offline/learning/own_take.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::learning {
namespace {

/// The pose between two frames; angles do not jump from one to the next.
Eigen::VectorXd PoseAt(const motion::Motion& motion, double time_s) {
  const double place = time_s * motion.rate_hz;
  const auto i = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(place), 0, motion.frames() - 2);
  const double share = std::clamp(place - static_cast<double>(i), 0.0, 1.0);
  return (1 - share) * motion.q.col(i) + share * motion.q.col(i + 1);
}

reconstruction::HandInput FistOf(const body::Body& body, const body::Kinematics& at, int side,
                                 double noise_m, noise::Random& random) {
  reconstruction::HandInput hand;
  hand.valid = true;
  hand.p_W_m = body::Place(body::Fist(body, side), at);
  for (double& value : hand.p_W_m) value += noise_m * random.Normal();
  hand.sd_m.setConstant(std::max(noise_m, 0.001));
  return hand;
}

}  // namespace

Result<void> AddOwnExamples(const OwnTake& take, const reconstruction::Models& basis,
                            const OwnExampleSettings& settings, PoseExamples& examples) {
  reconstruction::Options options;
  options.rate_hz = settings.rate_hz;
  auto made = reconstruction::Reconstruction::Create(take.body, basis, options);
  if (!made) return made.error();
  noise::Random random(settings.seed);
  body::Kinematics at(take.body.skeleton);
  const std::size_t before = examples.poses.size();
  const auto frames =
      static_cast<std::size_t>(std::min(take.session.duration_s, take.to_s()) * settings.rate_hz);
  double since_s = 0;  // Duration for which both the T-pose and the motion have been there.
  for (std::size_t i = 0; i < frames; ++i) {
    const double time_s = static_cast<double>(i) / settings.rate_hz;
    const bool moves = time_s >= take.from_s();
    Eigen::VectorXd pose;
    if (moves) {
      pose = PoseAt(take.motion, take.alignment.ToMotion(time_s));
      body::ComputeKinematics(take.body.skeleton, pose, at);
    }
    reconstruction::Inputs inputs;
    inputs.loads = LoadsAt(take.session, time_s);
    for (std::size_t side = 0; side < reconstruction::kHands; ++side) {
      if (const auto hand = HandAt(take.session, side, time_s)) {
        inputs.hands[side] = {true, hand->p_W_m, hand->sd_m};
      } else if (moves && take.session.hands[side].empty()) {
        inputs.hands[side] =
            FistOf(take.body, at, static_cast<int>(side), settings.hand_noise_m, random);
      }
    }
    const auto& output = made->Advance(inputs);
    since_s = moves && output.calibrated ? since_s + 1 / settings.rate_hz : 0;
    const bool measured = inputs.loads.feet[0].valid && inputs.loads.feet[1].valid &&
                          inputs.hands[0].valid && inputs.hands[1].valid;
    if (since_s < settings.settled_s || !measured) continue;
    const double into_s = take.alignment.ToMotion(time_s);
    const int piece = settings.first_piece + static_cast<int>(into_s / settings.piece_s);
    examples.Add(*made, settings.cues, pose, piece % kFolds);
  }
  if (examples.poses.size() > before) return {};
  return InvalidData(take.session.name +
                     ": nothing of the motion is left after its T-pose; stand in the T-pose before "
                     "moving, with both hands seen");
}

}  // namespace footing::learning
