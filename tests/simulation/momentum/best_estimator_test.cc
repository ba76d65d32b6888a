#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "daemon/simulation/momentum/best_estimator.h"
#include "daemon/simulation/momentum/contact_loads.h"
#include "daemon/simulation/momentum/foot_place.h"
#include "daemon/simulation/momentum/horizontal_com.h"
#include "tests/simulation/momentum/made_body.h"

// People who are not where their boards measure them.
namespace footing::momentum {
namespace {

constexpr double kBodyN = kMadeMassKg * kStandardGravityMps2;

/// A board whose cells, in the order of board::Corners, carry these loads.
FootLoads Board(const std::array<double, 4>& loads_n) {
  FootLoads foot = MadeBody().At(0).feet[0];
  for (std::size_t i = 0; i < 4; ++i) foot.cells[i].load_n = loads_n[i];
  return foot;
}

TEST(AtEdge, IsWhereOneSideCarriesAll) {
  EXPECT_FALSE(AtEdge(Board({100, 100, 100, 100})));
  EXPECT_TRUE(AtEdge(Board({200, 200, 1, 2})));
  EXPECT_TRUE(AtEdge(Board({0, 1, 200, 200})));
  EXPECT_TRUE(AtEdge(Board({200, 0, 200, 0})));
  EXPECT_TRUE(AtEdge(Board({0, 200, 0, 200})));
  EXPECT_FALSE(AtEdge(Board({10, 10, 0, 0}))) << "too little load for a place";
  EXPECT_FALSE(AtEdge(Board({300, 300, -100, -100}))) << "a plate without an edge";
}

TEST(TPoseCalibration, RefusesAFootAtTheEdgeOfItsBoard) {
  TPoseCalibration calibration;
  for (int i = 0; i < 400; ++i) {
    ContactLoads loads = MadeBody().At(i * kMadeStepS);
    loads.feet[1] = Board({0, 0, 0.25 * kBodyN, 0.25 * kBodyN});
    ASSERT_FALSE(calibration.Advance(loads, kMadeStepS));
  }
  EXPECT_EQ(calibration.progress(), 0);
}

TEST(LoadShare, StaysWholeInHops) {
  LoadShare share;
  // Twice the weight for 0.35 s, then 0.35 s in the air.
  for (int i = 0; i < 1200; ++i) {
    share.Advance(std::fmod(i * kMadeStepS, 0.7) < 0.35 ? 2 : 0, kMadeStepS);
    ASSERT_TRUE(share.whole()) << i;
  }
}

TEST(LoadShare, IsNotWholeBesideABoardAndSoonIsAgain) {
  LoadShare share;
  int until = 0;
  while (share.whole()) {
    share.Advance(0.5, kMadeStepS);
    ASSERT_LT(++until * kMadeStepS, 1.5);
  }
  for (int i = 0; i < 120; ++i) share.Advance(0.5, kMadeStepS);
  until = 0;
  while (!share.whole()) {
    share.Advance(1, kMadeStepS);
    ASSERT_LT(++until * kMadeStepS, 1.5);
  }
}

TEST(BestEstimator, DoesNotTrustLoadsWhileAFootStandsBesideItsBoard) {
  MadeBody body;
  Estimators best({}, {}, body.Calibrate(), kMadeStepS);
  const auto stand = [&](double seconds, bool left_on_floor) {
    for (int i = 0; i < seconds / kMadeStepS; ++i) {
      ContactLoads loads = body.At(0);
      if (left_on_floor) loads.feet[0] = Board({0, 0, 0, 0});
      best.Advance(loads, {{0, {0, 0, kMadeHeightM}}});
    }
  };
  stand(2, false);
  EXPECT_TRUE(best.momentum.estimate().whole_weight);
  stand(2, true);
  for (int i = 0; i < 20; ++i) {
    stand(0.5, true);
    EXPECT_FALSE(best.momentum.estimate().whole_weight) << i;
    EXPECT_FALSE(best.momentum.estimate().trusted) << i;
    EXPECT_NEAR(best.momentum.estimate().load_share, 0.5, 0.05);
  }
  stand(2, false);
  EXPECT_TRUE(best.momentum.estimate().whole_weight);
  EXPECT_NEAR(best.momentum.estimate().p_WC_m.y(), 0, 0.03);
}

bool Finite(const Estimate& e) {
  bool finite = e.p_WC_m.allFinite() && e.v_WC_mps.allFinite() && e.a_WC_mps2.allFinite() &&
                e.position_variance_m2.allFinite() && e.velocity_variance_m2ps2.allFinite() &&
                e.angular_momentum_kgm2ps.allFinite() && e.angular_momentum_variance.allFinite();
  for (const FootEstimate& foot : e.feet)
    finite = finite && foot.p_WF_m.allFinite() && foot.variance_m2.allFinite();
  return finite;
}

TEST(BestEstimator, HeightOfSquatsDoesNotDriftInTenMinutes) {
  MadeBody body = Squatter();
  const TPose pose = body.Calibrate();
  Estimators best({}, {}, pose, kMadeStepS);
  double first = 0, last = 0;
  constexpr int kFrames = 10 * 60 * 60, kMinute = 3600;
  for (int i = 0; i < kFrames; ++i) {
    const double t = i * kMadeStepS;
    const double error = best.Advance(body.At(t)).p_WC_m.z() - body.com_m(t).z();
    if (i < kMinute) first += error * error;
    if (i >= kFrames - kMinute) last += error * error;
  }
  EXPECT_LT(std::sqrt(first / kMinute), 0.03);
  EXPECT_LT(std::sqrt(last / kMinute), 0.03);
}

TEST(BestEstimator, OutlivesCellsWhoseGainIsWrongByOnePercent) {
  MadeBody body = Squatter();
  const TPose pose = [&] {
    TPoseCalibration calibration;
    for (int i = -400; i < 0; ++i) {
      ContactLoads loads = body.At(i * kMadeStepS);
      loads.feet[0].cells[0].load_n *= 1.01;
      loads.feet[1].cells[3].load_n *= 0.99;
      if (calibration.Advance(loads, kMadeStepS)) break;
    }
    return calibration.result();
  }();
  Estimators best({}, {}, pose, kMadeStepS);
  double sum = 0;
  constexpr int kFrames = 3 * 60 * 60;
  for (int i = 0; i < kFrames; ++i) {
    ContactLoads loads = body.At(i * kMadeStepS);
    loads.feet[0].cells[0].load_n *= 1.01;
    loads.feet[1].cells[3].load_n *= 0.99;
    const double error = best.Advance(loads).p_WC_m.z() - body.com_m(i * kMadeStepS).z();
    sum += error * error;
  }
  EXPECT_LT(std::sqrt(sum / kFrames), 0.05);
}

TEST(BestEstimator, LagMakesTheHorizontalPlaceBetter) {
  double rms[2] = {0, 0};
  for (const int late : {0, 1}) {
    MadeBody body;
    body.com_m = [](double t) {
      return Eigen::Vector3d(0.03 * Ramp(t) * std::sin(3.1 * t), 0.05 * Ramp(t) * std::sin(4 * t),
                             kMadeHeightM);
    };
    BestConfig config;
    config.lag_s = late * 0.2;
    Estimators best(config, {}, body.Calibrate(), kMadeStepS);
    for (int i = 0; i < 1800; ++i) {
      const double t = i * kMadeStepS;
      const Estimate& now = best.Advance(body.At(t));
      if (i > 120) rms[late] += (now.p_WC_m - body.com_m(t - now.lag_s)).head<2>().squaredNorm();
    }
  }
  EXPECT_LT(rms[1], 0.6 * rms[0]);
}

TEST(BestEstimator, PassesOverAPostureThatIsNotOne) {
  MadeBody body;
  Estimators best({}, {}, body.Calibrate(), kMadeStepS);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const ContactLoads loads = body.At(0);
  ContactLoads lost = body.At(kMadeStepS);
  lost.feet[0].valid = false;
  const auto com_m = [&](const ContactLoads& of, const std::optional<PostureCom>& posture) {
    Estimators copy = best;
    return Eigen::Vector3d(copy.Advance(of, posture).p_WC_m);
  };
  const Eigen::Vector3d before_m = com_m(loads, {});
  EXPECT_EQ(com_m(loads, {{nan, {0, 0, 1}}}), before_m);
  EXPECT_EQ(com_m(loads, {{0, {nan, 0, 1}}}), before_m);
  EXPECT_EQ(com_m(loads, {{0, {0, 0, nan}}}), before_m);
  EXPECT_NE(com_m(loads, {{0.1, {0, 0.1, 1.1}}}), before_m);
  EXPECT_EQ(com_m(lost, {{0.1, {0, 0.1, 1.1}}}), com_m(lost, {}));
}

TEST(BestEstimator, IsFiniteAndSaysSoWhenTheSourceIsLostOrMad) {
  MadeBody body;
  Estimators best({}, {}, body.Calibrate(), kMadeStepS);
  const double before = best.Advance(body.At(0)).position_variance_m2.z();
  for (int i = 1; i < 300; ++i) {
    ContactLoads loads = body.At(i * kMadeStepS);
    if (i % 3 == 0) loads.feet[0].valid = false;
    if (i % 3 == 1) loads.feet[1].cells[2].load_n = std::numeric_limits<double>::quiet_NaN();
    if (i % 3 == 2) loads.feet[0].cells[1].p_WS_m.x() = std::numeric_limits<double>::infinity();
    const Estimate& now = best.Advance(loads);
    EXPECT_FALSE(now.valid);
    ASSERT_TRUE(Finite(now)) << i;
  }
  EXPECT_GT(best.momentum.estimate().position_variance_m2.z(), 10 * before);
  EXPECT_EQ(best.momentum.estimate().resets, 0u);
  const Estimate& back = best.Advance(body.At(6));
  EXPECT_TRUE(back.valid);
  EXPECT_EQ(back.resets, 1u);
  EXPECT_NEAR(back.p_WC_m.z(), 1.0, 0.02);
  EXPECT_FALSE(back.trusted) << "it may have come back at any height";
}

TEST(BestEstimator, StaysFiniteUnderAnyLoads) {
  MadeBody body;
  Estimators best({}, {}, body.Calibrate(), kMadeStepS);
  noise::Random random(11);
  for (int i = 0; i < 20000; ++i) {
    ContactLoads loads = body.At(i * kMadeStepS);
    const double size = std::pow(10, random.Uniform(-3, 5));
    for (FootLoads& foot : loads.feet)
      for (Cell& cell : foot.cells) cell.load_n = size * random.Uniform(-1, 1);
    ASSERT_TRUE(Finite(best.Advance(loads))) << i;
  }
}

TEST(BestEstimator, FollowsAFootThatIsPutElsewhere) {
  MadeBody body;
  Estimators best({}, {}, body.Calibrate(), kMadeStepS);
  const Eigen::Vector3d moved(0.12, -0.03, 0);
  for (int i = 0; i < 240; ++i) {
    ContactLoads loads = body.At(i * kMadeStepS);
    FootLoads& right = loads.feet[1];
    // Off for half a second, then 12 cm ahead: the same cells feel the load further in front.
    if (i >= 120 && i < 150)
      for (Cell& cell : right.cells) cell.load_n = 0;
    if (i >= 150)
      for (Cell& cell : right.cells) {
        const double front = cell.p_WS_m.x() > 0 ? 1 : -1;
        const double side = cell.p_WS_m.y() > -kBoardYM ? 1 : -1;
        cell.load_n *=
            (1 + front * moved.x() / kHalfLengthM) * (1 + side * moved.y() / kHalfWidthM);
      }
    best.Advance(loads);
    if (i == 140) {
      EXPECT_FALSE(best.momentum.estimate().feet[1].contact);
      EXPECT_NEAR(best.momentum.estimate().feet[1].airborne_s, 20 * kMadeStepS, 0.02);
    }
    if (i == 150) {
      EXPECT_TRUE(best.momentum.estimate().feet[1].contact);
    }
  }
  const FootEstimate& foot = best.momentum.estimate().feet[1];
  // The sole's COP may be up to 15 cm ahead of the rest point: a standing foot tells its place
  // over the time that its COP wanders, so most of the way, not all, is found. 2.5 cm of it are
  // FootPlaceConfig::ahead_m: this person presses where one in the T-pose does.
  EXPECT_NEAR(foot.p_WF_m.x(), moved.x(), 0.04);
  EXPECT_NEAR(foot.p_WF_m.y(), -kBoardYM + moved.y(), 0.01);
  EXPECT_LT(std::abs(foot.p_WF_m.x() - moved.x()), 2 * std::sqrt(foot.variance_m2.x()));
}

TEST(FootPlace, AllThatTheCopHasBeenSinceTheLandingBoundsTheFoot) {
  const FootShape shape;
  FootPlace place(shape);
  place.Start(Eigen::Vector3d::Zero());
  const double step_s = 1.0 / 60, place_m = 0.05;
  Pressure pressure{.total_n = 400, .cop_valid = true};
  for (int i = 0; i < 30; ++i) place.Advance({}, false, false, step_s);
  const double toes_m = place_m + (1 - shape.rest_share) * shape.length_m - 0.01;
  const double heel_m = place_m - shape.rest_share * shape.length_m + 0.01;
  for (int i = 0; i < 300; ++i) {
    // Five seconds on the toes, but for one visit to the heel.
    pressure.p_WP_m.x() = i >= 60 && i < 64 ? heel_m : toes_m;
    place.Advance(pressure, true, i == 0, step_s);
    // 1 cm to the sole's edge, 5 mm of the COP's own error, and 1 mm/s that the bounds loosen by.
    if (i > 64) {
      ASSERT_NEAR(place.position_m().x(), place_m, 0.015 + 0.001 * (i + 1) * step_s + 1e-6) << i;
    }
  }
  EXPECT_LT(std::sqrt(place.variance_m2().x()), 0.02);
}

// The greatest error of the height from 0.1 to 0.75 s after a fall of 2 m/s onto the cells, in
// reported deviations. The knees give way by 40 cm, of which the posture sees `seen`.
double WorstOfALanding(double seen) {
  constexpr double kLandS = 0.3, kFallMps = 2, kBrakeMps2 = 5;
  const auto height_m = [=](double t) {
    const double s = std::min(t - kLandS, kFallMps / kBrakeMps2);
    return kMadeHeightM - kFallMps * s + 0.5 * s * s * (s < 0 ? -kStandardGravityMps2 : kBrakeMps2);
  };
  MadeBody body;
  body.noise_n = 0.5;
  body.com_m = [&](double t) {
    return Eigen::Vector3d(0, 0, t < 0.5 * kMadeStepS ? kMadeHeightM : height_m(t));
  };
  BestConfig config;
  config.height_posture_m = kLearnedPostureM;
  Estimators best(config, {}, body.Calibrate(), kMadeStepS);
  double worst = 0;
  for (int i = 0; i < 63; ++i) {
    const double t = i * kMadeStepS;
    const double posture_m = kMadeHeightM + seen * (height_m(t) - kMadeHeightM);
    const Estimate& now = best.Advance(body.At(t), {{0, {0, 0, posture_m}}});
    if (t < kLandS + 0.1) continue;
    const double off_m = std::abs(now.p_WC_m.z() - height_m(t));
    worst = std::max(worst, off_m / std::sqrt(now.position_variance_m2.z()));
  }
  EXPECT_EQ(best.momentum.estimate().resets, 1u);
  return worst;
}

TEST(BestEstimator, KnowsThatAPostureDoesNotShowHowFarKneesGiveWayInALanding) {
  for (const double seen : {0.25, 1.0}) EXPECT_LT(WorstOfALanding(seen), 2) << seen;
}

// In the first frame in which a body is there again after two seconds: of silent cells, or of
// empty ones.
Estimate FirstFrameAfter(bool silence) {
  MadeBody body;
  Estimators best({}, {}, body.Calibrate(), kMadeStepS);
  for (int i = 0; i < 120; ++i) {
    ContactLoads loads = body.At(i * kMadeStepS);
    for (FootLoads& foot : loads.feet) {
      foot.valid = !silence;
      for (Cell& cell : foot.cells) cell.load_n = 0;
    }
    best.Advance(loads);
  }
  return best.Advance(body.At(2));
}

TEST(BestEstimator, ABodyThatComesDownMayBeAsFastAsFromABoxAndOneThatReappearsStands) {
  const Estimate landing = FirstFrameAfter(false), standing = FirstFrameAfter(true);
  EXPECT_EQ(landing.resets, 1u);
  EXPECT_EQ(standing.resets, 1u);
  const double landing_sd_mps = std::sqrt(landing.velocity_variance_m2ps2.z());
  for (const double mps : {0.0, -3.0}) {
    EXPECT_NEAR(landing.v_WC_mps.z(), mps, 1.2 * landing_sd_mps);
  }
  EXPECT_NEAR(standing.v_WC_mps.z(), 0, 0.05);
  EXPECT_LT(std::sqrt(standing.velocity_variance_m2ps2.z()), 0.6);
}

}  // namespace

// People who step ahead, or lunge.
namespace {

/// The made body's loads with the left foot `ahead_m` further ahead and `left_share` of the weight
/// on it.
ContactLoads Lunge(MadeBody& body, double ahead_m, double left_share) {
  constexpr double kWeightN = kMadeMassKg * kStandardGravityMps2;
  ContactLoads loads = body.At(0);
  for (std::size_t f = 0; f < kFeet; ++f) {
    const double share = f == 0 ? left_share : 1 - left_share;
    const double cop_m = f == 0 ? ahead_m : 0;
    for (Cell& cell : loads.feet[f].cells) {
      cell.load_n =
          0.25 * kWeightN * share * (1 + cop_m * cell.p_WS_m.x() / std::pow(kHalfLengthM, 2));
    }
  }
  return loads;
}

TEST(StepWatch, SeesAFootThatStandsElsewhereUntilItHasStoodThere) {
  StepWatch watch;
  watch.Start({0, 0});
  const auto stand = [&](double left_m, double seconds) {
    for (int i = 0; i < seconds / kMadeStepS; ++i) watch.Advance({left_m, 0}, kMadeStepS);
  };
  stand(0.18, 15);  // As far as a foot can stand on its board.
  EXPECT_FALSE(watch.stepped());
  stand(0.18 + 0.35, 0.02);
  EXPECT_TRUE(watch.stepped());
  stand(0.18 + 0.35, 3 * std::log(0.35 / 0.2) - 0.1);
  EXPECT_TRUE(watch.stepped());
  stand(0.18 + 0.35, 0.2);
  EXPECT_FALSE(watch.stepped());
  stand(0.18 + 0.35, 10);
  stand(0.18, 0.02);  // Back again.
  EXPECT_TRUE(watch.stepped());
}

TEST(BestEstimator, ReportsAStepAndDoubtsWhereTheBodyIs) {
  MadeBody body;
  Estimators best({}, {}, body.Calibrate(), kMadeStepS);
  const auto move = [&](double ahead_m, double left_share, double seconds) {
    for (int i = 0; i < seconds / kMadeStepS; ++i) best.Advance(Lunge(body, ahead_m, left_share));
  };
  move(0, 0.5, 2);
  move(0, 0, 0.4);  // A knee is raised, and the foot comes down where it was.
  move(0, 0.5, 0.4);
  EXPECT_FALSE(best.momentum.estimate().stepped);
  EXPECT_LT(std::sqrt(best.momentum.estimate().position_variance_m2.x()), 0.05);
  move(0, 0, 0.4);
  EXPECT_FALSE(best.momentum.estimate().stepped);
  move(0.4, 0.5, 0.2);
  EXPECT_TRUE(best.momentum.estimate().stepped);
  EXPECT_TRUE(best.momentum.estimate().trusted) << "the height is what it was";
  EXPECT_GT(std::sqrt(best.momentum.estimate().position_variance_m2.x()), 0.1);
  move(0.4, 0.5, 4);
  EXPECT_FALSE(best.momentum.estimate().stepped);
  EXPECT_LT(std::sqrt(best.momentum.estimate().position_variance_m2.x()), 0.05);
}

}  // namespace

// Bodies that do not stay in place, and what hands and feet show of them.
namespace {

constexpr double kPostureOffM = 0.05;  // By which hands and feet have C too far ahead.

constexpr double kPushS = 0.25, kFlightS = 0.3;

/// Where a push of `acceleration`, a flight under `gravity` and the push's contrary lead, from
/// rest.
double Hopped(double t, double acceleration, double gravity) {
  const double push = std::clamp(t, 0.0, kPushS), flight = std::clamp(t - kPushS, 0.0, kFlightS);
  const double land = std::clamp(t - kPushS - kFlightS, 0.0, kPushS);
  const double off = acceleration * kPushS, down = off - gravity * kFlightS;
  const double stop = down / kPushS;
  return 0.5 * acceleration * push * push + off * flight - 0.5 * gravity * flight * flight +
         down * land - 0.5 * stop * land * land;
}

/// Hops 0.55 m ahead, from t = 1 on.
MadeBody Hopper() {
  MadeBody body;
  const double up_mps2 = 0.5 * kStandardGravityMps2 * kFlightS / kPushS;
  body.com_m = [up_mps2](double t) {
    return Eigen::Vector3d(Hopped(t - 1, 4, 0), 0,
                           kMadeHeightM + Hopped(t - 1, up_mps2, kStandardGravityMps2));
  };
  return body;
}

MadeBody Swayer() {
  MadeBody body;
  body.com_m = [](double t) {
    return Eigen::Vector3d(t > 0 ? 0.03 * Ramp(t) * std::sin(3 * t) : 0, 0, kMadeHeightM);
  };
  return body;
}

struct Seen {
  double worst_m = 0;        ///< The forward place is off by.
  double worst_spreads = 0;  ///< And by so many of its standard deviations.
  double last_m = 0;         ///< The forward place in the end.
};

Seen Watch(MadeBody body, bool sees_posture, double lag_s = 0) {
  BestConfig config;
  config.lag_s = lag_s;
  Estimators best(config, {}, body.Calibrate(), kMadeStepS);
  Seen seen;
  for (double t = 0; t < 1.9; t += kMadeStepS) {
    std::optional<PostureCom> posture;
    if (sees_posture) posture = {0, {body.com_m(t).x() + kPostureOffM, 0, kMadeHeightM}};
    const Estimate& now = best.Advance(body.At(t), posture);
    const double off_m = std::abs(now.p_WC_m.x() - body.com_m(t - lag_s).x());
    seen.worst_m = std::max(seen.worst_m, off_m);
    seen.worst_spreads =
        std::max(seen.worst_spreads, off_m / std::sqrt(now.position_variance_m2.x()));
    seen.last_m = now.p_WC_m.x();
  }
  return seen;
}

TEST(BestEstimator, FollowsABodyThatHopsByHandsAndFeet) {
  const Seen alone = Watch(Hopper(), false), seen = Watch(Hopper(), true);
  EXPECT_GT(alone.worst_m, 0.3) << "the filter of bodies in place takes it for a lean";
  EXPECT_LT(alone.worst_spreads, 5) << "but doubts it (18 deviations without the doubt)";
  EXPECT_LT(seen.worst_m, 0.5 * alone.worst_m);
  EXPECT_LT(seen.worst_spreads, 3.5);
  const Seen lagged = Watch(Hopper(), true, 0.2);
  EXPECT_LT(lagged.worst_m, seen.worst_m);
}

TEST(BestEstimator, HandsAndFeetDoNotMoveABodyInPlaceForwards) {
  EXPECT_NEAR(Watch(Swayer(), true).last_m, Watch(Swayer(), false).last_m, 5e-4);
  EXPECT_LT(Watch(Swayer(), true).worst_m, 0.03);
}

TEST(HorizontalDoubt, MovesAsFarAsTheDoubtGoes) {
  const HorizontalCom::Filter::Scalar in_place{0, 1e-4}, travelling{0.2, 1e-2};
  const auto none = Weigh(in_place, 0, travelling);
  EXPECT_EQ(none.mean, in_place.mean);
  EXPECT_EQ(none.variance, in_place.variance);
  const auto half = Weigh(in_place, travelling.variance, travelling);
  EXPECT_NEAR(half.mean, 0.1, 1e-12);
  EXPECT_NEAR(half.variance, 0.25 * (1e-4 + 2e-2), 1e-12);
  const auto all = Weigh(in_place, 1e6, travelling);
  EXPECT_NEAR(all.mean, travelling.mean, 1e-6);
  EXPECT_NEAR(all.variance, travelling.variance, 1e-6);
}

}  // namespace

// A weight that changes while the body stands still, as of a person who leans on something or
// carries it in the T-pose and not after it.
namespace {

struct AfterChange {
  double height_rms_m = 0;
  double mass_kg = 0;  ///< When the body begins to move.
};

// It stands still in its T-pose until `stand_s`, then squats, of which hands and feet show a tenth.
AfterChange SquatAfterChange(double share, double stand_s) {
  constexpr double kChangeS = 0.2;
  MadeBody body;
  body.noise_n = 0.5;
  body.com_m = [stand_s](double t) {
    const double down = Ramp(t - stand_s) - Ramp(t - stand_s - 1.5);
    return Eigen::Vector3d(0, 0, kMadeHeightM - 0.3 * down);
  };
  BestConfig config;
  config.height_posture_m = kLearnedPostureM;
  Estimators best(config, {}, body.Calibrate(), kMadeStepS);
  AfterChange after;
  constexpr int kFrames = 300;
  int squatting = 0;
  for (int i = 0; i < kFrames; ++i) {
    const double t = i * kMadeStepS, height_m = body.com_m(t).z();
    ContactLoads loads = body.At(t);
    for (FootLoads& foot : loads.feet) {
      for (Cell& cell : foot.cells) cell.load_n *= t < kChangeS ? 1 : share;
    }
    const double posture_m = kMadeHeightM + 0.1 * (height_m - kMadeHeightM);
    const double error_m = best.Advance(loads, {{0, {0, 0, posture_m}}}).p_WC_m.z() - height_m;
    if (t < stand_s) {
      after.mass_kg = best.momentum.mass_kg();
      continue;
    }
    ++squatting;
    after.height_rms_m += error_m * error_m;
  }
  after.height_rms_m = std::sqrt(after.height_rms_m / squatting);
  return after;
}

TEST(BestEstimator, FindsAWeightThatChangesWhileTheBodyStands) {
  for (const double share : {0.95, 0.97, 1.03, 1.05}) {
    const AfterChange after = SquatAfterChange(share, 1.4);
    EXPECT_NEAR(after.mass_kg, share * kMadeMassKg, 0.003 * kMadeMassKg) << share;
    EXPECT_LT(after.height_rms_m, 0.06) << share;
  }
}

TEST(BestEstimator, FindsAWeightThatChangesShortlyBeforeTheTPoseIsLeft) {
  for (const double share : {0.95, 0.97, 1.03, 1.05}) {
    const AfterChange after = SquatAfterChange(share, 0.9);
    EXPECT_NEAR(after.mass_kg, share * kMadeMassKg, 0.003 * kMadeMassKg) << share;
    EXPECT_LT(after.height_rms_m, 0.03) << share;
  }
}

TEST(BestEstimator, AMotionThatBeginsEvenlyIsNoWeight) {
  for (const double mps2 : {-0.14, -0.1, 0.1, 0.14}) {
    MadeBody body;
    body.noise_n = 0.5;
    body.com_m = [mps2](double t) {  // From 1 s on for 0.4 s, then back to rest in the same time.
      constexpr double kS = 0.4;
      const double s = std::clamp(t - 1, 0.0, 2 * kS), left_s = 2 * kS - s;
      const double moved = s < kS ? 0.5 * s * s : kS * kS - 0.5 * left_s * left_s;
      return Eigen::Vector3d(0, 0, kMadeHeightM + mps2 * moved);
    };
    BestConfig config;
    config.height_posture_m = kLearnedPostureM;
    const TPose pose = body.Calibrate();
    Estimators best(config, {}, pose, kMadeStepS);
    for (int i = 0; i < 180; ++i) {
      const double t = i * kMadeStepS, height_m = body.com_m(t).z();
      best.Advance(body.At(t), {{0, {0, 0, kMadeHeightM + 0.3 * (height_m - kMadeHeightM)}}});
      EXPECT_NEAR(best.momentum.mass_kg(), pose.mass_kg, 0.002 * pose.mass_kg)
          << mps2 << " at " << t;
    }
  }
}

TEST(BestEstimator, AFootBesideTheBoardsInTheTPoseIsNoWeight) {
  EXPECT_GT(SquatAfterChange(0.7, 1.4).mass_kg, 0.9 * kMadeMassKg);
}

}  // namespace

// Weights that are wrong or change, postures, and landings.
namespace {

// Root mean square error of the height over a minute in which the cells tell `share` of what they
// told in the T-pose.
double HeightErrorAfter(MadeBody body, double share, double& mass_kg) {
  Estimators best({}, {}, body.Calibrate(), kMadeStepS);
  double sum = 0;
  constexpr int kFrames = 3600;
  for (int i = 0; i < kFrames; ++i) {
    ContactLoads loads = body.At(i * kMadeStepS);
    for (FootLoads& foot : loads.feet)
      for (Cell& cell : foot.cells) cell.load_n *= share;
    const double error = best.Advance(loads).p_WC_m.z() - body.com_m(i * kMadeStepS).z();
    sum += error * error;
  }
  mass_kg = best.momentum.mass_kg();
  return std::sqrt(sum / kFrames);
}

TEST(BestEstimator, FindsAWeightThatTheTPoseHadWrong) {
  for (const double share : {0.98, 1.02, 0.95}) {
    double mass_kg = 0;
    EXPECT_LT(HeightErrorAfter(Squatter(), share, mass_kg), 0.035) << share;
    EXPECT_NEAR(mass_kg, share * kMadeMassKg, 0.002 * kMadeMassKg) << share;
  }
}

TEST(BestEstimator, FindsTheWeightOfOneWhoNeverStandsStill) {
  MadeBody body;
  body.noise_n = 0.5;
  body.com_m = [](double t) {
    return Eigen::Vector3d(0, 0, kMadeHeightM - 0.08 * Ramp(t) * (1 - std::cos(2 * kPi * 0.8 * t)));
  };
  double mass_kg = 0;
  EXPECT_LT(HeightErrorAfter(body, 0.98, mass_kg), 0.10);
  EXPECT_NEAR(mass_kg, 0.98 * kMadeMassKg, 0.003 * kMadeMassKg);
}

TEST(BestEstimator, KeepsTheWeightThatTheTPoseHadRight) {
  double mass_kg = 0;
  EXPECT_LT(HeightErrorAfter(Squatter(), 1, mass_kg), 0.03);
  EXPECT_EQ(mass_kg, Squatter().Calibrate().mass_kg);
}

TEST(BestEstimator, KeepsTheWeightThatItFoundWhenTheBodyStepsOff) {
  MadeBody body = Squatter();
  Estimators best({}, {}, body.Calibrate(), kMadeStepS);
  for (int i = 0; i < 3600; ++i) {
    ContactLoads loads = body.At(i * kMadeStepS);
    const bool away = i >= 3000 && i < 3120;
    for (FootLoads& foot : loads.feet)
      for (Cell& cell : foot.cells) cell.load_n *= away ? 0 : 0.95;
    best.Advance(loads);
    if (i > 3120) {
      EXPECT_NEAR(best.momentum.mass_kg(), 0.95 * kMadeMassKg, 0.003 * kMadeMassKg) << i;
    }
  }
  EXPECT_EQ(best.momentum.estimate().resets, 1u);
}

// A posture that is wrong by a first-order process along each axis.
class WrongPosture {
 public:
  Eigen::Vector3d Of(const Eigen::Vector3d& com_m) {
    const Eigen::Vector3d time_s(0.25, 0.25, 3), spread_m(0.03, 0.03, 0.06);
    for (int i = 0; i < 3; ++i) {
      const double keep = std::exp(-kMadeStepS / time_s(i));
      error_m_(i) =
          keep * error_m_(i) + spread_m(i) * std::sqrt(1 - keep * keep) * random_.Normal();
    }
    return com_m + error_m_;
  }

 private:
  noise::Random random_{8};
  Eigen::Vector3d error_m_ = Eigen::Vector3d::Zero();
};

TEST(BestEstimator, APostureTellsWhatLoadsCannot) {
  const auto com_m = [](double t) {
    return Eigen::Vector3d(0, 0.05 * Ramp(t) * std::sin(4 * t) * std::sin(0.7 * t),
                           kMadeHeightM - 0.1 * Ramp(t) * (1 + std::sin(2.3 * t)));
  };
  Eigen::Vector3d rms[2] = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (const int seen : {0, 1}) {
    MadeBody body;
    body.com_m = com_m;
    BestConfig config;
    config.height_posture_m = 0.06;
    Estimators best(config, {}, body.Calibrate(), kMadeStepS);
    WrongPosture posture;
    for (int i = 0; i < 3600; ++i) {
      const double t = i * kMadeStepS;
      const Eigen::Vector3d seen_m = posture.Of(com_m(t));
      std::optional<PostureCom> told;
      if (seen == 1) told = {seen_m.y(), seen_m};
      const Eigen::Vector3d told_m = best.Advance(body.At(t), told).p_WC_m;
      rms[seen] += (told_m - com_m(t)).cwiseAbs2() / 3600;
    }
    rms[seen] = rms[seen].cwiseSqrt();
  }
  EXPECT_LT(rms[1].y(), 0.85 * rms[0].y());
  EXPECT_NEAR(rms[1].x(), rms[0].x(), 1e-3);
  EXPECT_LT(rms[1].z(), rms[0].z() + 1e-3);
}

// Errors of the height while the posture is seen, from the time `from_s` on: rms, and the greatest
// of frames that are trusted. From `change_s` on the cells measure `share` of the load.
struct HeightErrors {
  double rms_m = 0, greatest_trusted_m = 0, trusted_share = 0;
};
HeightErrors ErrorsAfterChange(double share, double change_s, double from_s) {
  MadeBody body = Squatter();
  BestConfig config;
  config.height_posture_m = kLearnedPostureM;
  Estimators best(config, {}, body.Calibrate(), kMadeStepS);
  WrongPosture posture;
  HeightErrors errors;
  int count = 0;
  for (int i = 0; i < 30 * 60; ++i) {
    const double t = i * kMadeStepS;
    ContactLoads loads = body.At(t);
    for (FootLoads& foot : loads.feet) {
      for (Cell& cell : foot.cells) cell.load_n *= t < change_s ? 1 : share;
    }
    const Eigen::Vector3d seen_m = posture.Of(body.com_m(t));
    const Estimate& now = best.Advance(loads, {{seen_m.y(), seen_m}});
    if (t < from_s) continue;
    const double error = now.p_WC_m.z() - body.com_m(t).z();
    ++count;
    errors.rms_m += error * error;
    errors.trusted_share += now.trusted ? 1 : 0;
    if (now.trusted)
      errors.greatest_trusted_m = std::max(errors.greatest_trusted_m, std::abs(error));
  }
  errors.rms_m = std::sqrt(errors.rms_m / count);
  errors.trusted_share /= count;
  return errors;
}

TEST(BestEstimator, AWeightThatChangesInMidMovementDoesNotCarryTheHeightAway) {
  for (const double share : {0.95, 0.99, 1.01, 1.05}) {
    const HeightErrors errors = ErrorsAfterChange(share, 5.3, 6.3);
    EXPECT_LT(errors.rms_m, 0.15) << share;
    EXPECT_LT(errors.greatest_trusted_m, 0.55) << share;
    EXPECT_GT(errors.trusted_share, 0.9) << share;
  }
}

// Greatest error of the height of a body that moves by `height_m` over the T-pose, seen by a
// posture that has half of a crouch.
double GreatestHeightError(double (*height_m)(double)) {
  MadeBody body;
  body.noise_n = 0.5;
  body.com_m = [height_m](double t) { return Eigen::Vector3d(0, 0, kMadeHeightM + height_m(t)); };
  BestConfig config;
  config.height_posture_m = kLearnedPostureM;
  Estimators best(config, {}, body.Calibrate(), kMadeStepS);
  double greatest_m = 0;
  for (int i = 0; i < 8 * 60; ++i) {
    const double t = i * kMadeStepS, now_m = height_m(t);
    const double told_m =
        best.Advance(body.At(t), {{0, {0, 0, kMadeHeightM + std::max(now_m, 0.5 * now_m)}}})
            .p_WC_m.z();
    greatest_m = std::max(greatest_m, std::abs(told_m - kMadeHeightM - now_m));
  }
  return greatest_m;
}

// The integral of Ramp.
double RampedRise(double t) {
  if (t <= 0) return 0;
  return t >= 1 ? t - 0.5 : t * t * t * t * (2.5 - 3 * t + t * t);
}

TEST(BestEstimator, DoesNotTakeASlowEvenDescentForStillness) {
  // 7 cm down at 5 cm/s, with an acceleration in the first and the last 0.4 s only.
  EXPECT_LT(GreatestHeightError([](double t) {
              return -0.05 * 0.4 * (RampedRise((t - 1) / 0.4) - RampedRise((t - 2.4) / 0.4));
            }),
            0.04);
}

TEST(BestEstimator, FollowsABodyThatRisesOverItsTPose) {
  // A raised knee, or arms over the head.
  EXPECT_LT(GreatestHeightError(
                [](double t) { return 0.08 * Ramp(2 * (t - 1)) * (1 - Ramp(2 * (t - 2.5))); }),
            0.025);
}

TEST(BestEstimator, ComesBackWithinASecondOfALandingThatItDidNotSeeComing) {
  MadeBody body;
  BestConfig config;
  config.height_posture_m = kLearnedPostureM;
  Estimators best(config, {}, body.Calibrate(), kMadeStepS);
  // Off the cells for three seconds; back on them out of a fall, knees giving way by 15 cm.
  const auto height_m = [](double t) {
    return kMadeHeightM - (t < 3 ? 0 : 0.15 * Ramp(2 * (t - 3)));
  };
  body.com_m = [&](double t) { return Eigen::Vector3d(0, 0, height_m(t)); };
  for (int i = 0; i < 5 * 60; ++i) {
    const double t = i * kMadeStepS;
    ContactLoads loads = body.At(t);
    if (t < 3) {
      for (FootLoads& foot : loads.feet) {
        for (Cell& cell : foot.cells) cell.load_n = 0;
      }
    }
    const Estimate& now = best.Advance(loads, {{0, {0, 0, height_m(t) + 0.04}}});
    if (t > 1.2 && t < 2.9) {
      EXPECT_FALSE(now.valid);
    }
    if (t > 4) {
      EXPECT_TRUE(now.trusted) << t;
      EXPECT_NEAR(now.p_WC_m.z(), height_m(t), 0.14) << t;
    }
  }
  EXPECT_EQ(best.momentum.estimate().resets, 1u);
}

TEST(BestEstimator, LandsAfterAShortFlightThatBeganElsewhere) {
  // Out of the T-pose onto a box, unseen, and from it at 2 m/s onto the boards, ahead of where the
  // body stood, knees giving way by 20 cm for a moment. The posture
  // has them half as low.
  constexpr double kLandS = 0.3, kFallMps = 2, kBrakeMps2 = 10;
  constexpr double kStopS = kLandS + kFallMps / kBrakeMps2;
  const auto height_m = [=](double t) {
    const double s = std::min(t, kStopS) - kLandS;
    const double fallen = -kFallMps * s;
    return kMadeHeightM + fallen + 0.5 * s * s * (s < 0 ? -kStandardGravityMps2 : kBrakeMps2) +
           0.2 * Ramp((t - kStopS) / 0.5);
  };
  MadeBody body;
  body.noise_n = 0.5;
  body.com_m = [&](double t) {
    return t < 0.5 * kMadeStepS ? Eigen::Vector3d(0, 0, kMadeHeightM)
                                : Eigen::Vector3d(0.08, 0, height_m(t));
  };
  BestConfig config;
  config.height_posture_m = kLearnedPostureM;
  Estimators best(config, {}, body.Calibrate(), kMadeStepS);
  for (int i = 0; i < 3 * 60; ++i) {
    const double t = i * kMadeStepS;
    const Estimate& now =
        best.Advance(body.At(t), {{0, {0, 0, 0.5 * (kMadeHeightM + height_m(t))}}});
    if (t < kLandS + 1) continue;
    EXPECT_TRUE(now.trusted) << t;
    EXPECT_TRUE(now.valid) << t;
    EXPECT_NEAR(now.p_WC_m.z(), height_m(t), 0.1) << t;
    EXPECT_NEAR(now.p_WC_m.x(), 0.08, 0.03) << t;
  }
  EXPECT_EQ(best.momentum.estimate().resets, 1u);
}

TEST(BestEstimator, AJumpOnTheSpotIsNoLandingElsewhere) {
  // Knees bend by 15 cm and throw the body up by 20; it lands as it left.
  MadeBody body;
  body.noise_n = 0.5;
  const double up_mps = std::sqrt(2 * kStandardGravityMps2 * 0.2);
  const double flight_s = 2 * up_mps / kStandardGravityMps2;
  const double push_s = 0.3;  // Down by 15 cm, then up to the speed of the lift-off.
  const auto height_m = [=](double t) {
    if (t < 0) return 0.0;
    if (t < 1) return -0.15 * Ramp(t);
    if (t < 1 + push_s) {
      const double u = (t - 1) / push_s;  // A quintic from rest at -15 cm to up_mps at 0.
      const double v = up_mps * push_s, g = -kStandardGravityMps2 * push_s * push_s;
      const double a3 = 1.5 - 4 * v + 0.5 * g, a4 = -2.25 + 7 * v - g, a5 = 0.9 - 3 * v + 0.5 * g;
      return -0.15 + u * u * u * (a3 + u * (a4 + u * a5));
    }
    const double s = t - 1 - push_s;
    if (s < flight_s) return up_mps * s - 0.5 * kStandardGravityMps2 * s * s;
    const double stop_s = 0.2, b = std::min(s - flight_s, stop_s);  // Braked evenly.
    return -up_mps * b + 0.5 * up_mps / stop_s * b * b;
  };
  body.com_m = [&](double t) { return Eigen::Vector3d(0, 0, kMadeHeightM + height_m(t)); };
  BestConfig config;
  config.height_posture_m = kLearnedPostureM;
  Estimators best(config, {}, body.Calibrate(), kMadeStepS);
  for (int i = 0; i < 3 * 60; ++i) {
    const double t = i * kMadeStepS;
    best.Advance(body.At(t),
                 {{0, {0, 0, kMadeHeightM + std::max(0.5 * height_m(t), height_m(t))}}});
    EXPECT_NEAR(best.momentum.estimate().p_WC_m.z(), kMadeHeightM + height_m(t), 0.1) << t;
  }
  EXPECT_EQ(best.momentum.estimate().resets, 0u);
}

}  // namespace
}  // namespace footing::momentum
