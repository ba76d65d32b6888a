#include "daemon/simulation/momentum/vertical_com.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "daemon/simulation/momentum/best_estimator.h"
#include "daemon/simulation/momentum/vertical_bank.h"
#include "tests/simulation/momentum/made_body.h"

namespace footing::momentum {
namespace {

// The greatest height in four seconds in which the cells measure `share` of what they measured in
// the T-pose, by a filter that takes that weight for granted and sees a posture of `posture_m`.
double GreatestHeight(double share, double posture_m) {
  MadeBody body;
  body.noise_n = 0.5;
  const TPose pose = body.Calibrate();
  VerticalConfig config = TrustingVertical(0.028, pose.cell_noise_n);
  config.posture = LearnedHeightPosture();
  VerticalCom filter(config, pose.mass_kg, kMadeStepS);
  filter.Start(pose.mean_loads);
  double greatest_m = 0;
  for (int i = 0; i < 4 * 60; ++i) {
    VerticalInput input = ToVerticalInput(body.At(i * kMadeStepS), 20);
    for (double& load : input.load_n) load *= share;
    filter.Advance(input);
    filter.SeePosture(posture_m);
    greatest_m = std::max(greatest_m, filter.Height(0).mean);
  }
  return greatest_m;
}

TEST(VerticalCom, LoadsThatTellTooMuchDoNotLiftABodyOffItsLegs) {
  // 0.5 m/s^2 that nothing corrects moves it that far between two looks half a second apart.
  for (const double posture_m : {0.0, -0.1, -0.3}) {
    EXPECT_LT(GreatestHeight(1.05, posture_m), 0.4) << posture_m;
  }
}

TEST(VerticalBank, APostureThatStaysShowsThatTheTPoseWeighedWrong) {
  for (const double share : {0.95, 1.05}) {
    MadeBody body;
    body.noise_n = 0.5;
    body.com_m = [](double t) {  // From side to side, so that its COP never rests.
      return Eigen::Vector3d(0, t > 0 ? 0.03 * std::sin(4.4 * t) : 0, kMadeHeightM);
    };
    const TPose pose = body.Calibrate();
    VerticalBank bank(pose.mass_kg, kMadeStepS, 0.028, pose.cell_noise_n, LearnedHeightPosture());
    bank.Start(pose.mean_loads);
    double worst_m = 0;
    for (int i = 0; i < 4 * 60; ++i) {
      VerticalInput input = ToVerticalInput(body.At(i * kMadeStepS), 20);
      for (double& load : input.load_n) load *= share;
      bank.Advance(input);
      bank.SeePosture(0);
      worst_m = std::max(worst_m, std::abs(bank.Height(0).mean));
    }
    // The 0.5 m/s^2 that nobody stands still with move the body 0.5 m within 1.4 s.
    EXPECT_LT(worst_m, 0.2) << share;
  }
}

}  // namespace
}  // namespace footing::momentum
