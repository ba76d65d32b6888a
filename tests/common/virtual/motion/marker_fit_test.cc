#include "common/virtual/motion/marker_fit.h"

#include <gmock/gmock.h>

#include "common/base/units.h"
#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/virtual/devices/noise.h"
#include "common/virtual/motion/edit.h"
#include "common/virtual/motion/markers.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/motion/table.h"
#include "tests/common/virtual/motion/shared_data.h"

namespace footing::motion {
namespace {

using body::Landmark;
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

/// A standard person who squats and swings, and OpenCap's markers on him: place of each in the
/// frame of its landmark's joint (in a T-pose: x ahead, y left, z up), the left ones.
struct Made {
  Motion motion{body::StandardPerson(1.72), 60, 0, {}};
  body::Landmarks landmarks = body::FindLandmarks(motion.skeleton).value();
  MarkerTracks tracks;

  Made() {
    const Eigen::VectorXd pose = body::TPose(motion.skeleton, landmarks);
    motion.q.resize(motion.skeleton.dof, 60);
    for (Eigen::Index i = 0; i < 60; ++i) {
      const double phase = 2 * kPi * static_cast<double>(i) / 60;
      motion.q.col(i) = pose;
      Bend("ltibia", 0.5 - 0.5 * std::cos(phase), i);
      Bend("rtibia", 0.5 - 0.5 * std::cos(phase), i);
      Bend("lradius", 0.6 + 0.4 * std::sin(phase), i);
      Bend("rradius", 0.6 - 0.4 * std::sin(phase), i);
      motion.q(5, i) = 0.3 * std::sin(phase);
      motion.q(3, i) = 0.4;  // Not straight ahead.
    }
    const struct {
      const char* left;
      const char* right;
      Landmark joint;
      Eigen::Vector3d place_m;
    } kMarkers[] = {
        {"L_knee", "r_knee", Landmark::kLeftKnee, {0, 0.055, 0}},
        {"L_mknee", "r_mknee", Landmark::kLeftKnee, {0, -0.055, 0}},
        {"L_ankle", "r_ankle", Landmark::kLeftAnkle, {0, 0.04, 0}},
        {"L_mankle", "r_mankle", Landmark::kLeftAnkle, {0, -0.04, 0}},
        {"L_calc", "r_calc", Landmark::kLeftAnkle, {-0.06, 0, -0.03}},
        {"L_toe", "r_toe", Landmark::kLeftToe, {0, 0, 0.01}},
        {"L_5meta", "r_5meta", Landmark::kLeftAnkle, {0.1, 0.05, -0.04}},
        {"L_Shoulder", "R_Shoulder", Landmark::kLeftClavicle, {0, 0.18, 0.12}},
        {"L_elbow_lat", "R_elbow_lat", Landmark::kLeftElbow, {-0.04, 0, 0}},
        {"L_elbow_med", "R_elbow_med", Landmark::kLeftElbow, {0.04, 0, 0}},
        {"L_wrist_radius", "R_wrist_radius", Landmark::kLeftWrist, {0.03, 0, 0}},
        {"L_wrist_ulna", "R_wrist_ulna", Landmark::kLeftWrist, {-0.03, 0, 0}},
        {"L_Sternum", "R_Sternum", Landmark::kChest, {0.1, 0.02, 0.1}},
        {"C7", nullptr, Landmark::kChest, {-0.06, 0, 0.2}},
    };
    tracks.rate_hz = 60;
    body::Kinematics at(motion.skeleton), rest(motion.skeleton);
    ComputeKinematics(motion.skeleton, pose, rest);
    const auto add = [&](const char* name, Landmark landmark, const Eigen::Vector3d& offset_W) {
      const auto joint = static_cast<std::size_t>(landmarks[landmark]);
      const Eigen::Vector3d p_J = rest.R_WJ[joint].transpose() * offset_W;
      tracks.names.emplace_back(name);
      tracks.p.emplace_back(3, 60);
      for (Eigen::Index i = 0; i < 60; ++i) {
        ComputeKinematics(motion.skeleton, motion.q.col(i), at);
        tracks.p.back().col(i) = at.p_WJ[joint] + at.R_WJ[joint] * p_J;
      }
    };
    for (const auto& marker : kMarkers) {
      add(marker.left, marker.joint, marker.place_m);
      if (marker.right == nullptr) continue;
      add(marker.right, Mirrored(marker.joint),
          Eigen::Vector3d(marker.place_m.x(), -marker.place_m.y(), marker.place_m.z()));
    }
    // Iliac spines where Harrington's regression gives this person's hips back: with the width w of
    // the front ones, 0.33 w + 7.3 mm = half the hips' distance, and so on; depth 0.15 m.
    const Eigen::Vector3d hip =
        rest.p_WJ[static_cast<std::size_t>(landmarks[Landmark::kLeftHip])] - rest.p_WJ[0];
    const double width_m = (hip.y() - 0.0073) / 0.33, depth_m = 0.15;
    const double front_m = hip.x() + 0.24 * depth_m + 0.0099;
    const double height_m = hip.z() + 0.30 * width_m + 0.0109;
    add("L.ASIS", Landmark::kHips, {front_m, width_m / 2, height_m});
    add("r.ASIS", Landmark::kHips, {front_m, -width_m / 2, height_m});
    add("L.PSIS", Landmark::kHips, {front_m - depth_m, 0.05, height_m});
    add("r.PSIS", Landmark::kHips, {front_m - depth_m, -0.05, height_m});
  }

  void Bend(const char* joint, double angle_rad, Eigen::Index frame) {
    const int index = body::FindJoint(motion.skeleton, joint);
    motion.q(motion.skeleton.joint(index).first_dof, frame) = angle_rad;
  }
};

TEST(PoseFit, FindsAPoseFromPointsOnAllSegments) {
  const body::Skeleton skeleton = body::StandardPerson(1.7);
  noise::Random random(4);
  Eigen::VectorXd truth(skeleton.dof), q = Eigen::VectorXd::Zero(skeleton.dof);
  for (int i = 0; i < skeleton.dof; ++i) truth(i) = random.Uniform(-0.4, 0.4);
  body::Kinematics at(skeleton);
  ComputeKinematics(skeleton, truth, at);
  std::vector<body::PointTarget> targets;
  for (int joint = 0; joint < skeleton.size(); ++joint) {
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d p_J = 0.1 * Eigen::Vector3d::Unit(axis);
      const auto here = static_cast<std::size_t>(joint);
      targets.push_back({joint, p_J, at.p_WJ[here] + at.R_WJ[here] * p_J, 1});
    }
  }
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(skeleton.dof);
  body::PoseFit fit(skeleton);
  EXPECT_LT(fit.Fit(targets, {.iterations = 50, .hold = &none, .neutral = &none, .still = 0}, q),
            1e-6);
  EXPECT_LT((q - truth).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(PoseFit, CoordinatesThatNoPointShowsStay) {
  const body::Skeleton skeleton = body::StandardPerson(1.7);
  Eigen::VectorXd q = Eigen::VectorXd::Constant(skeleton.dof, 0.1);
  body::PoseFit fit(skeleton);
  fit.Fit({{0, Eigen::Vector3d::Zero(), Eigen::Vector3d(1, 2, 3), 1}}, {}, q);
  EXPECT_LT((q.head<3>() - Eigen::Vector3d(1, 2, 3)).norm(), 1e-6);
  EXPECT_LT((q.tail(skeleton.dof - 3).array() - 0.1).abs().maxCoeff(), 1e-9);
}

TEST(JointCentres, HarringtonsHipsAndMiddlesAreMet) {
  const Made made;
  const MarkerSet set = FindMarkerSet(made.tracks).value();
  EXPECT_EQ(set.name, "opencap");
  body::Kinematics at(made.motion.skeleton);
  for (Eigen::Index frame : {0, 20, 45}) {
    ComputeKinematics(made.motion.skeleton, made.motion.q.col(frame), at);
    const Centres centres = JointCentres(made.tracks, set, frame);
    for (Landmark l : {Landmark::kLeftHip, Landmark::kRightHip, Landmark::kLeftKnee,
                       Landmark::kRightAnkle, Landmark::kLeftElbow, Landmark::kRightWrist}) {
      const auto& centre = centres[static_cast<std::size_t>(l)];
      ASSERT_TRUE(centre.has_value()) << LandmarkName(l);
      EXPECT_LT((*centre - at.p_WJ[static_cast<std::size_t>(made.landmarks[l])]).norm(), 1e-9)
          << LandmarkName(l);
    }
  }
}

TEST(MarkerSets, AnUnknownSetIsListedWithWhatTheNearestOneNeeds) {
  Made made;
  for (std::string& name : made.tracks.names) {
    if (name == "L_ankle" || name == "L_elbow_lat") name = "other_" + name;
  }
  const auto set = FindMarkerSet(made.tracks);
  ASSERT_FALSE(set.ok());
  const std::string& said = set.error().message;
  for (const char* part : {"other_L_ankle", "opencap, the nearest, also needs", "docs/body.md"}) {
    EXPECT_NE(said.find(part), std::string::npos) << said;
  }
}

/// The made person's arms are spread further than he is high: in a static trial the widest extent
/// is not the height.
TEST(MarkerSets, TheShouldersAreOverTheHeelsWhicheverAxisIsUp) {
  Made made;
  for (std::size_t i = 0; i < made.tracks.p.size(); ++i) {
    if (made.tracks.names[i].find("wrist") == std::string::npos) continue;
    made.tracks.p[i].row(1) *= 3;
  }
  EXPECT_EQ(GuessAxes(made.tracks), FileAxes::kZUp);
  MarkerTracks turned = made.tracks;  // y up, x ahead, z right: as OpenSim has it.
  for (Eigen::Matrix3Xd& p : turned.p) {
    const Eigen::Matrix3Xd before = p;
    p.row(1) = before.row(2);
    p.row(2) = -before.row(1);
  }
  EXPECT_EQ(GuessAxes(turned), FileAxes::kYUp);
  EXPECT_LT((ToWorld(FileAxes::kYUp, turned).p[0] - made.tracks.p[0]).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(MarkerFit, AMarkerThatJumpsByFiveMetresIsNamed) {
  Made made;
  const int knee = FindMarker(made.tracks, "L_knee");
  made.tracks.p[static_cast<std::size_t>(knee)](0, 20) += 5;  // It moves by itself, too.
  const auto fit = FitMarkers(made.tracks);
  ASSERT_FALSE(fit.ok());
  EXPECT_EQ(fit.error().kind, ErrorKind::kInvalidData);
  EXPECT_THAT(fit.error().message,
              HasSubstr("marker L_knee moves by 5.0 m between frames 20 and 21"));
}

TEST(MarkerFit, FindsLengthsAndMotionOfAMadePerson) {
  const Made made;
  const auto fit = FitMarkers(made.tracks);
  ASSERT_TRUE(fit.ok()) << fit.error().message;
  EXPECT_LT(fit->rms_m, 0.004);
  EXPECT_NEAR(fit->height_m, 1.72, 0.06);
  ASSERT_EQ(fit->motion.frames(), 60);
  body::Kinematics here(made.motion.skeleton), there(fit->motion.skeleton);
  double sum = 0, count = 0;
  for (Eigen::Index frame = 0; frame < 60; ++frame) {
    ComputeKinematics(made.motion.skeleton, made.motion.q.col(frame), here);
    ComputeKinematics(fit->motion.skeleton, fit->motion.q.col(frame), there);
    for (Landmark l : {Landmark::kLeftHip, Landmark::kRightHip, Landmark::kLeftKnee,
                       Landmark::kRightKnee, Landmark::kLeftAnkle, Landmark::kRightAnkle,
                       Landmark::kLeftElbow, Landmark::kRightWrist}) {
      const auto joint = static_cast<std::size_t>(made.landmarks[l]);
      sum += (here.p_WJ[joint] - there.p_WJ[joint]).norm();
      ++count;
    }
  }
  EXPECT_LT(sum / count, 0.01);
}

TEST(MarkerFit, AMarkerThatIsHiddenForAWhileHardlyMatters) {
  Made made;
  const auto whole = FitMarkers(made.tracks).value();
  const auto knee = static_cast<std::size_t>(FindMarker(made.tracks, "L_mknee"));
  made.tracks.p[knee].middleCols(20, 15).setConstant(std::nan(""));
  const auto gap = FitMarkers(made.tracks);
  ASSERT_TRUE(gap.ok()) << gap.error().message;
  EXPECT_TRUE(gap->motion.q.allFinite());
  body::Kinematics here(whole.motion.skeleton), there(gap->motion.skeleton);
  ComputeKinematics(whole.motion.skeleton, whole.motion.q.col(27), here);
  ComputeKinematics(gap->motion.skeleton, gap->motion.q.col(27), there);
  const auto ankle = static_cast<std::size_t>(made.landmarks[Landmark::kLeftAnkle]);
  EXPECT_LT((here.p_WJ[ankle] - there.p_WJ[ankle]).norm(), 0.01);
}

TEST(MarkerFit, WhatIsNotSeenForLongIsNoMotion) {
  Made made;
  MarkerTracks& tracks = made.tracks;
  ASSERT_GT(tracks.frames(), 30);
  tracks.rate_hz = 10;
  for (auto& track : tracks.p) track.middleCols(5, 10).setConstant(std::nan(""));
  EXPECT_TRUE(FitMarkers(tracks).ok()) << "a second is bridged";
  for (auto& track : tracks.p) track.middleCols(5, 12).setConstant(std::nan(""));
  const auto gap = FitMarkers(tracks);
  ASSERT_FALSE(gap.ok());
  EXPECT_EQ(gap.error().kind, ErrorKind::kInvalidData);
  EXPECT_THAT(gap.error().message, HasSubstr("for more than 1.0 s from "));
}

TEST(MarkerFit, ErrorsSayWhatIsMissing) {
  Made made;
  EXPECT_THAT(FitMarkers(made.tracks, {.set = "plug-in-gait"}).error().message,
              HasSubstr("which also needs LASI, RASI"));
  EXPECT_THAT(FitMarkers(made.tracks, {.set = "mine"}).error().message,
              HasSubstr("there are opencap, plug-in-gait"));
  // One of several markers is enough; C7 has no side.
  EXPECT_THAT(FitMarkers(made.tracks, {.set = "vicon53"}).error().message,
              AllOf(HasSubstr("LMT1 or LMT5, RMT1 or RMT5"), Not(HasSubstr("@"))));
  MarkerTracks no_neck = made.tracks;
  for (std::string& name : no_neck.names) name = name == "C7" ? "D7" : name;
  EXPECT_THAT(FitMarkers(no_neck, {.set = "opencap"}).error().message, EndsWith("also needs C7"));
  MarkerTracks unknown = made.tracks;
  for (std::string& name : unknown.names) name = "M" + name;
  EXPECT_THAT(FitMarkers(unknown).error().message, HasSubstr("match no known set (opencap, "));
  EXPECT_THAT(FitMarkers(unknown).error().message, HasSubstr(", the nearest, also needs "));
  MarkerTracks far = made.tracks;
  for (auto& track : far.p) track *= 1000;
  EXPECT_THAT(FitMarkers(far).error().message, HasSubstr("make a person of"));
}

MarkerTracks Trial(const std::string& name) {
  return ToWorld(
      FileAxes::kYUp,
      ParseTrc(test::ReadShared("forces/opencap_s4/MarkerData/" + name + ".trc"), name).value());
}

TEST(MarkerFit, ForcesOfAFittedSquatAreThoseOfThePlates) {
  SKIP_WITHOUT_SHARED_DATA();
  const MarkerTracks still = Trial("static1");
  const auto fit = FitMarkers(Trial("squats1"), {.still = &still});
  ASSERT_TRUE(fit.ok()) << fit.error().message;
  EXPECT_LT(fit->rms_m, 0.008);
  constexpr double kMassKg = 60.0;  // By the plates of the static trial.
  const auto body =
      body::MakeBody(fit->motion.skeleton, {.mass_kg = kMassKg, .height_m = fit->height_m});
  ASSERT_TRUE(body.ok()) << body.error().message;
  const std::string path = "forces/opencap_s4/ID/squats1_grf.mot";
  const auto forces =
      ToGroundForces(ParseTable(test::ReadShared(path), path).value(), path).value();
  const Motion motion = Smoothed(fit->motion, 8);
  const MotionRates rates = Rates(motion);
  body::Kinematics at(motion.skeleton);
  body::JointVelocities velocities(motion.skeleton);
  const auto momentum_z = [&](Eigen::Index frame) {
    ComputeKinematics(motion.skeleton, motion.q.col(frame), at);
    ComputeVelocities(motion.skeleton, at, rates.q_dot.col(frame), velocities);
    return ComputeMomentum(*body, at, velocities).linear_W.z();
  };
  double squares = 0;
  for (Eigen::Index i = 5; i + 5 < motion.frames(); ++i) {
    const double made_n = (momentum_z(i + 1) - momentum_z(i - 1)) * motion.rate_hz / 2 +
                          kMassKg * kStandardGravityMps2;
    double plates_n = 0;
    for (const PlateForces& plate : forces.plates) plates_n += plate.force_W(2, i);
    squares += (made_n - plates_n) * (made_n - plates_n);
  }
  const double rms_n = std::sqrt(squares / static_cast<double>(motion.frames() - 10));
  EXPECT_LT(rms_n / (kMassKg * kStandardGravityMps2), 0.02);
}

TEST(MarkerFit, ThePaperLaboratorysMarkersAreFitted) {
  SKIP_WITHOUT_SHARED_DATA();
  const std::string text = test::ReadShared("mocap/c3d/squat.c3d");
  auto c3d = ParseC3d({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, "squat");
  ASSERT_TRUE(c3d.ok()) << c3d.error().message;
  EXPECT_EQ(GuessAxes(c3d->points), FileAxes::kYUp);
  for (auto& track : c3d->points.p) {  // Every eighth frame: the pelvis is hidden in many.
    track = Eigen::Matrix3Xd(track(Eigen::all, Eigen::seq(0, track.cols() - 1, 8)));
  }
  const auto fit = FitMarkers(ToWorld(FileAxes::kYUp, std::move(c3d->points)));
  ASSERT_TRUE(fit.ok()) << fit.error().message;
  EXPECT_EQ(fit->set, "vicon53");
  EXPECT_LT(fit->rms_m, 0.010);
}

}  // namespace
}  // namespace footing::motion
