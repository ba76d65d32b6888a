#include "daemon/offline/pose_run/standing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/body/kinematics.h"
#include "common/body/momentum.h"
#include "common/base/units.h"
#include "common/virtual/motion/edit.h"

namespace footing::pose_run {
namespace {

constexpr double kLeastStandingS = 1;
constexpr double kWeightBand = 0.06;  // Of the mean load: breathing and sway stay far below.
constexpr double kSwayM = 0.04;
constexpr double kStandingMassOff = 0.1;
constexpr double kMostOffsetM = 0.08;

struct Felt {
  double load_n = 0;
  Eigen::Vector2d cop_m = Eigen::Vector2d::Zero();
};

/// Of all plates together at one sample.
Felt All(const motion::GroundForces& forces, Eigen::Index sample) {
  Felt felt;
  for (const motion::PlateForces& plate : forces.plates) {
    const double load_n = plate.force_W(2, sample);
    if (!(load_n > kLoadedN)) continue;
    felt.load_n += load_n;
    felt.cop_m += load_n * plate.cop_W.col(sample).head<2>();
  }
  if (felt.load_n > 0) felt.cop_m /= felt.load_n;
  return felt;
}

}  // namespace

Result<Eigen::Vector2d> StandingOffset(const motion::Motion& still,
                                       const motion::GroundForces& forces, const Settings& settings,
                                       const std::string& origin,
                                       const std::string& forces_origin) {
  const auto kept = motion::WithLandmarksOnly(still);
  if (!kept) return InvalidData(origin + ": " + kept.error().message);
  body::PersonParameters person;
  person.mass_kg = settings.mass_kg;
  person.height_m = settings.height_m;
  const auto body = body::MakeBody(kept->skeleton, person);
  if (!body) return InvalidData(origin + ": " + body.error().message);
  body::Kinematics at(body->skeleton);
  const Eigen::Index samples = forces.plates.front().force_W.cols();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero(), least, most;
  least.setConstant(std::numeric_limits<double>::infinity());
  most = -least;
  double load_n = 0, least_n = std::numeric_limits<double>::infinity(), most_n = 0, count = 0;
  for (Eigen::Index i = 0; i < kept->frames(); ++i) {
    const double time_s = kept->start_s + static_cast<double>(i) / kept->rate_hz;
    const auto sample =
        static_cast<Eigen::Index>(std::lround((time_s - forces.start_s) * forces.rate_hz));
    if (sample < 0 || sample >= samples) continue;
    const Felt felt = All(forces, sample);
    body::ComputeKinematics(body->skeleton, kept->q.col(i), at);
    const Eigen::Vector2d com = body::CentreOfMass(*body, at).head<2>();
    least = least.cwiseMin(com);
    most = most.cwiseMax(com);
    least_n = std::min(least_n, felt.load_n);
    most_n = std::max(most_n, felt.load_n);
    load_n += felt.load_n;
    sum += com - felt.cop_m;
    ++count;
  }
  if (count < kLeastStandingS * kept->rate_hz) {
    return InvalidData(forces_origin + ": has less than a second in common with " + origin);
  }
  load_n /= count;
  const double weight_n = settings.mass_kg * kStandardGravityMps2;
  if (most_n - least_n > 2 * kWeightBand * load_n || (most - least).norm() > 2 * kSwayM) {
    return InvalidData(origin + ": this person moves: give a trial of standing still");
  }
  if (std::abs(load_n - weight_n) > kStandingMassOff * weight_n) {
    return InvalidData(forces_origin + ": the plates carry " +
                       std::to_string(std::lround(NewtonsToKilograms(load_n))) +
                       " kg of a person of " + std::to_string(std::lround(settings.mass_kg)) +
                       ": both feet must be on them, and --mass-kg the person's");
  }
  const Eigen::Vector2d offset = sum / count;
  if (!(offset.norm() < kMostOffsetM)) {
    return InvalidData(forces_origin + ": its centre of pressure is " +
                       std::to_string(std::lround(100 * offset.norm())) +
                       " cm from under the body of " + origin +
                       ": forces and motion must be of one trial, in one frame");
  }
  return offset;
}

}  // namespace footing::pose_run
