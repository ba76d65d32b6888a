#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "common/base/units.h"
#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/options/load.h"
#include "tests/common/virtual/motion/shared_data.h"

namespace footing::motion {
namespace {

using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

/// Writes C3D files of any processor, for the tests alone.
class Writer {
 public:
  explicit Writer(Processor processor) : processor_(processor) {}

  void Word(std::uint16_t value, Bytes& to) const {
    const bool big = processor_ == Processor::kMips;
    to.push_back(static_cast<std::uint8_t>(big ? value >> 8 : value));
    to.push_back(static_cast<std::uint8_t>(big ? value : value >> 8));
  }
  void Float(float value, Bytes& to) const {
    const auto bits =
        std::bit_cast<std::uint32_t>(processor_ == Processor::kDec ? value * 4 : value);
    const auto low = static_cast<std::uint16_t>(bits),
               high = static_cast<std::uint16_t>(bits >> 16);
    Word(processor_ == Processor::kIntel ? low : high, to);
    Word(processor_ == Processor::kIntel ? high : low, to);
  }
  void Group(int id, const std::string& name, Bytes& to) const {
    Head(-id, name, 3, to);
    to.push_back(0);  // No description.
  }
  void Texts(int id, const std::string& name, const std::vector<std::string>& texts,
             Bytes& to) const {
    const std::size_t width = texts[0].size();
    Head(id, name, 2 + 4 + width * texts.size() + 1, to);
    for (int byte : {-1, 2}) to.push_back(static_cast<std::uint8_t>(byte));
    to.push_back(static_cast<std::uint8_t>(width));
    to.push_back(static_cast<std::uint8_t>(texts.size()));
    for (const std::string& text : texts) to.insert(to.end(), text.begin(), text.end());
    to.push_back(0);
  }
  void Floats(int id, const std::string& name, const std::vector<float>& values, Bytes& to) const {
    Head(id, name, 2 + 3 + 4 * values.size() + 1, to);
    for (int byte : {4, 1}) to.push_back(static_cast<std::uint8_t>(byte));
    to.push_back(static_cast<std::uint8_t>(values.size()));
    for (float value : values) Float(value, to);
    to.push_back(0);
  }
  void Words(int id, const std::string& name, const std::vector<int>& values, Bytes& to) const {
    Head(id, name, 2 + 3 + 2 * values.size() + 1, to);
    for (int byte : {2, 1}) to.push_back(static_cast<std::uint8_t>(byte));
    to.push_back(static_cast<std::uint8_t>(values.size()));
    for (int value : values) Word(static_cast<std::uint16_t>(value), to);
    to.push_back(0);
  }

 private:
  void Head(int id, const std::string& name, std::size_t link, Bytes& to) const {
    to.push_back(static_cast<std::uint8_t>(name.size()));
    to.push_back(static_cast<std::uint8_t>(id));
    to.insert(to.end(), name.begin(), name.end());
    Word(static_cast<std::uint16_t>(link), to);
  }

  Processor processor_;
};

/// Two points and six analog channels (a plate), three frames at 100 Hz, two samples a frame. The
/// first point is at (1, 2, 3) m moving by 0.5 m a frame in x; the second is hidden in frame 2.
Bytes Example(Processor processor, bool floats) {
  const Writer writer(processor);
  Bytes file = {2, 0x50};
  writer.Word(2, file);   // Points.
  writer.Word(12, file);  // Analog values a frame.
  writer.Word(1, file);   // First and last frame.
  writer.Word(3, file);
  writer.Word(10, file);  // Gap.
  writer.Float(floats ? -0.5f : 0.5f, file);
  writer.Word(4, file);  // Data in block 4.
  writer.Word(2, file);  // Samples a frame.
  writer.Float(100, file);
  file.resize(512);
  file.insert(file.end(), {1, 0x50, 2, static_cast<std::uint8_t>(processor)});
  writer.Group(1, "POINT", file);
  writer.Group(2, "ANALOG", file);
  writer.Group(3, "FORCE_PLATFORM", file);
  writer.Texts(1, "LABELS", {"LTOE", "RTOE"}, file);
  writer.Texts(1, "UNITS", {"mm"}, file);
  writer.Texts(1, "Y_SCREEN", {"+Z"}, file);
  writer.Floats(2, "GEN_SCALE", {0.5f}, file);
  writer.Floats(2, "SCALE", {2, 2, 2, 200, 200, 200}, file);
  writer.Words(2, "OFFSET", {0, 0, 10, 0, 0, 0}, file);
  writer.Texts(2, "UNITS", {"N  ", "N  ", "N  ", "Nmm", "Nmm", "Nmm"}, file);
  writer.Words(3, "USED", {1}, file);
  writer.Words(3, "TYPE", {2}, file);
  // x along -x, y along y, z down: corners in the order of the quadrants.
  writer.Floats(3, "CORNERS", {0, 900, 0, 600, 900, 0, 600, 0, 0, 0, 0, 0}, file);
  writer.Floats(3, "ORIGIN", {0, 0, 0}, file);
  writer.Words(3, "CHANNEL", {1, 2, 3, 4, 5, 6}, file);
  file.resize(3 * 512);
  for (int frame = 0; frame < 3; ++frame) {
    const std::vector<float> point = {1000.0f + 500 * static_cast<float>(frame), 2000, 3000, 0};
    const std::vector<float> hidden = {1, 1, 1, frame == 1 ? -1.0f : 0.0f};
    for (const auto& values : {point, hidden}) {
      for (std::size_t i = 0; i < 4; ++i) {
        if (floats) {
          writer.Float(values[i], file);
        } else {  // Half millimetres.
          writer.Word(
              static_cast<std::uint16_t>(static_cast<int>(i < 3 ? values[i] / 0.5f : values[i])),
              file);
        }
      }
    }
    for (int sample = 0; sample < 2; ++sample) {
      // 800 N down on the plate at x = 0.1, y = 0.2 m of its axes: Mx = y Fz, My = -x Fz (N mm, in
      // steps of 100), and 5 N m about z.
      for (int raw : {0, 0, 810, 1600, -800, 50}) {
        if (floats) {
          writer.Float(static_cast<float>(raw), file);
        } else {
          writer.Word(static_cast<std::uint16_t>(raw), file);
        }
      }
    }
  }
  return file;
}

class EveryC3d : public testing::TestWithParam<std::tuple<Processor, bool>> {};

TEST_P(EveryC3d, IsReadAlike) {
  const auto [processor, floats] = GetParam();
  const auto c3d = ParseC3d(Example(processor, floats), "x.c3d");
  ASSERT_TRUE(c3d.ok()) << c3d.error().message;
  EXPECT_EQ(c3d->points.rate_hz, 100);
  ASSERT_EQ(c3d->points.frames(), 3);
  EXPECT_EQ(c3d->points.names, (std::vector<std::string>{"LTOE", "RTOE"}));
  EXPECT_TRUE(c3d->points.p[0].col(2).isApprox(Eigen::Vector3d(2, 2, 3), 1e-6));
  EXPECT_TRUE(Seen(c3d->points.p[1].col(0)));
  EXPECT_FALSE(Seen(c3d->points.p[1].col(1)));
  EXPECT_EQ(c3d->analog_rate_hz, 200);
  ASSERT_EQ(c3d->analog.cols(), 6);
  EXPECT_NEAR(c3d->analog(2, 3), 800, 1e-3);  // (810 - 10) * 2 * 0.5.
  EXPECT_EQ(c3d->y_screen, "+Z");
}

TEST_P(EveryC3d, ForcesOfItsPlateActOnThePerson) {
  const auto [processor, floats] = GetParam();
  const auto forces = ToGroundForces(ParseC3d(Example(processor, floats), "x").value(), "x.c3d");
  ASSERT_TRUE(forces.ok()) << forces.error().message;
  ASSERT_EQ(forces->plates.size(), 1u);
  const PlateForces& plate = forces->plates[0];
  EXPECT_LT((plate.force_W.col(0) - Eigen::Vector3d(0, 0, 800)).norm(), 1e-3);
  // The plate's middle (0.3, 0.45), its x is -x of the file, its y the file's.
  EXPECT_LT((plate.cop_W.col(0) - Eigen::Vector3d(0.3 - 0.1, 0.45 + 0.2, 0)).norm(), 1e-6);
  // On the plate 5 N m about down; on the person the opposite about down: 5 about up.
  EXPECT_LT((plate.moment_W.col(0) - Eigen::Vector3d(0, 0, 5)).norm(), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryC3d,
                         testing::Combine(testing::Values(Processor::kIntel, Processor::kDec,
                                                          Processor::kMips),
                                          testing::Bool()));

TEST(C3d, UnitsAreReadHoweverTheyAreSpelt) {
  const Bytes file = Example(Processor::kIntel, true);
  const std::string word = "mm";
  const auto units = std::search(file.begin(), file.end(), word.begin(), word.end());
  ASSERT_NE(units, file.end());
  const struct {
    const char* unit;
    double x_m;  // Place of the first point: 1000 of them.
  } kRows[] = {{"MM", 1}, {"Mm", 1}, {"cm", 10}, {"CM", 10}, {"m ", 1000}, {"M ", 1000}};
  for (const auto& row : kRows) {
    Bytes spelt = file;
    std::copy_n(row.unit, 2, spelt.begin() + (units - file.begin()));
    const auto read = ParseC3d(spelt, "x.c3d");
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_NEAR(read->points.p[0](0, 0), row.x_m, 1e-6 * row.x_m) << row.unit;
  }
  for (const char* name : {"Millimeters", "millimetre", " MILLIMETRES "}) {
    EXPECT_EQ(MetresOf(name), 1e-3) << name;
  }
  for (const char* name : {"meter", "Metres", "m"}) EXPECT_EQ(MetresOf(name), 1) << name;
  for (const char* name : {"", "s", "ms", "km", "feet"}) EXPECT_EQ(MetresOf(name), 0) << name;
}

TEST(C3d, EveryCutOfAFileIsRefused) {
  const Bytes file = Example(Processor::kIntel, true);
  for (std::size_t length = 0; length < file.size(); length += 7) {
    EXPECT_FALSE(ParseC3d(std::span(file).first(length), "cut").ok()) << length;
  }
}

/// The example with more parameters, of which later ones replace those of the same name.
Bytes With(const Bytes& parameters) {
  Bytes file = Example(Processor::kIntel, true);
  const std::string last = "CHANNEL";
  const auto named = std::search(file.begin(), file.end(), last.begin(), last.end());
  const auto link = static_cast<std::size_t>(named - file.begin()) + last.size();
  std::copy(parameters.begin(), parameters.end(),
            file.begin() + static_cast<std::ptrdiff_t>(link + file[link]));
  return file;
}

TEST(C3d, AnyNumberInAParameterIsReadOrRefused) {
  const Writer writer(Processor::kIntel);
  for (float value : {3.48966e9f, -3.48966e9f, 3.4e38f, -3.4e38f, 0.5f, -0.5f, NAN}) {
    for (const char* name : {"USED", "TYPE", "CORNERS", "ORIGIN", "CHANNEL"}) {
      Bytes changed;
      writer.Floats(3, name, std::vector<float>(12, value), changed);
      const auto c3d = ParseC3d(With(changed), "changed");
      ASSERT_TRUE(c3d.ok()) << c3d.error().message;
      for (const C3dPlate& plate : c3d->plates) {
        for (int channel : plate.channels) EXPECT_LT(static_cast<unsigned>(channel), 6u) << value;
      }
      const bool needed = name == std::string("TYPE") || name == std::string("CHANNEL");
      const auto forces = ToGroundForces(*c3d, "changed");
      EXPECT_FALSE(forces.ok() && needed) << name << " " << value;
    }
    Bytes span;
    writer.Group(4, "TRIAL", span);
    writer.Floats(4, "ACTUAL_START_FIELD", {1, 0}, span);
    writer.Floats(4, "ACTUAL_END_FIELD", {3, value}, span);
    const auto c3d = ParseC3d(With(span), "span");
    EXPECT_EQ(c3d.ok(), !(std::abs(value) >= 1)) << value;
  }
}

TEST(C3d, EveryChangedByteIsReadOrRefused) {
  const Bytes file = Example(Processor::kIntel, false);
  for (std::size_t at = 0; at < 3 * 512; ++at) {
    for (std::uint8_t value : {0x00, 0x7f, 0x80, 0xff}) {
      Bytes changed = file;
      changed[at] = value;
      const auto c3d = ParseC3d(changed, "changed");
      if (c3d.ok()) {
        EXPECT_LE(c3d->points.frames(), 3 * 512) << at;
        const auto forces = ToGroundForces(*c3d, "changed");
        EXPECT_TRUE(!forces.ok() || forces->plates.size() <= 100);
      }
    }
  }
}

TEST(C3d, WhatIsWrittenIsReadAgain) {
  const C3d c3d = ParseC3d(Example(Processor::kMips, true), "x").value();
  const auto bytes = WriteC3d(c3d);
  ASSERT_TRUE(bytes.ok()) << bytes.error().message;
  const auto read = ParseC3d(Bytes(bytes->begin(), bytes->end()), "written");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->points.names, c3d.points.names);
  EXPECT_EQ(read->points.rate_hz, 100);
  EXPECT_TRUE(read->points.p[0].isApprox(c3d.points.p[0], 1e-7));
  EXPECT_FALSE(Seen(read->points.p[1].col(1)));
  EXPECT_EQ(read->analog_rate_hz, 200);
  EXPECT_EQ(read->analog, c3d.analog);
  EXPECT_EQ(read->analog_names, c3d.analog_names);
  EXPECT_EQ(read->analog_units, c3d.analog_units);
  EXPECT_EQ(read->y_screen, "+Z");
  ASSERT_EQ(read->plates.size(), 1u);
  EXPECT_TRUE(read->plates[0].corners.isApprox(c3d.plates[0].corners, 1e-6));
  EXPECT_EQ(read->plates[0].channels, c3d.plates[0].channels);
}

TEST(C3d, MoreFramesAndNamesThanAWordAndAListHoldAreWritten) {
  C3d c3d;
  c3d.points.rate_hz = 100;
  constexpr Eigen::Index kFrames = 70'000;
  c3d.points.names = {"last"};
  c3d.points.p.emplace_back(Eigen::Matrix3Xd::Constant(3, kFrames, 0.5));
  c3d.points.p[0].col(kFrames - 1).setConstant(2);
  const std::string longest = WriteC3d(c3d).value();
  const auto read = ParseC3d(Bytes(longest.begin(), longest.end()), "long");
  ASSERT_TRUE(read.ok()) << read.error().message;
  ASSERT_EQ(read->points.frames(), kFrames);
  EXPECT_EQ(read->points.p[0](0, kFrames - 1), 2);
  EXPECT_TRUE(read->plates.empty());

  c3d.points.names.clear();
  c3d.points.p.assign(300, Eigen::Matrix3Xd::Ones(3, 1));
  for (int i = 0; i < 300; ++i) c3d.points.names.push_back("marker " + std::to_string(i));
  const std::string many = WriteC3d(c3d).value();
  EXPECT_EQ(ParseC3d(Bytes(many.begin(), many.end()), "many")->points.names, c3d.points.names);

  c3d.points.p.clear();
  EXPECT_EQ(WriteC3d(c3d).error().kind, ErrorKind::kInvalidData);
}

TEST(C3d, ErrorsSayWhatWasExpected) {
  Bytes file = Example(Processor::kIntel, true);
  file[1] = 0;
  EXPECT_THAT(ParseC3d(file, "x.c3d").error().message, HasSubstr("x.c3d: not a C3D file"));
  file = Example(Processor::kIntel, true);
  file[515] = 7;
  EXPECT_THAT(ParseC3d(file, "x.c3d").error().message, HasSubstr("expected processor 84"));
  file = Example(Processor::kIntel, true);
  file[8] = 0xff;  // Last frame.
  EXPECT_THAT(ParseC3d(file, "x.c3d").error().message, HasSubstr("the file ends before"));
}

using body::Landmark;

constexpr double kRateHz = 120;

std::size_t Index(int value) { return static_cast<std::size_t>(value); }

/// A standard person who squats as deep as knees bend, and comes up again.
Motion Squat() {
  Motion motion{body::StandardPerson(1.75), kRateHz, 0, {}};
  const auto landmarks = body::FindLandmarks(motion.skeleton).value();
  const auto dof = [&](Landmark left, int side) {
    return motion.skeleton.joint(landmarks[body::OfSide(left, side)]).first_dof;
  };
  motion.q.resize(motion.skeleton.dof, 240);
  for (Eigen::Index i = 0; i < motion.frames(); ++i) {
    const double down = 0.5 - 0.5 * std::cos(2 * kPi * static_cast<double>(i) / 240);
    Eigen::VectorXd q = body::TPose(motion.skeleton, landmarks);
    for (int side = 0; side < 2; ++side) {
      q.segment<3>(dof(Landmark::kLeftHip, side)) +=
          down * Eigen::Vector3d(0.4, side == 0 ? 0.5 : -0.5, 1.2);
      q(dof(Landmark::kLeftKnee, side)) += 2.7 * down;
      q(dof(Landmark::kLeftAnkle, side)) += 0.4 * down;
    }
    motion.q.col(i) = q;
  }
  return motion;
}

/// The other solution of the leg in these frames, as a fit to markers can find it.
void TurnByHalf(int side, Eigen::Index from, Eigen::Index to, Motion& motion) {
  const auto landmarks = body::FindLandmarks(motion.skeleton).value();
  const auto joint = [&](Landmark left) {
    return motion.skeleton.joint(landmarks[body::OfSide(left, side)]);
  };
  const body::Joint hip = joint(Landmark::kLeftHip), knee = joint(Landmark::kLeftKnee),
                    ankle = joint(Landmark::kLeftAnkle);
  const Eigen::Matrix3d half =
      Eigen::AngleAxisd(kPi, knee.offset_m.normalized()).toRotationMatrix();
  for (Eigen::Index i = from; i < to; ++i) {
    Eigen::VectorXd q = motion.q.col(i);
    const Eigen::Matrix3d thigh = JointRotation(hip, q);
    const Eigen::Matrix3d foot = thigh * JointRotation(knee, q) * JointRotation(ankle, q);
    SetJointRotation(hip, thigh * half, q);
    q(knee.first_dof) = 2 * kPi - q(knee.first_dof);
    const Eigen::Matrix3d shank = thigh * half * JointRotation(knee, q);
    SetJointRotation(ankle, shank.transpose() * foot, q);
    motion.q.col(i) = q;
  }
}

/// The furthest that a thigh turns from one frame to the next.
double LargestTurnRad(const Motion& motion) {
  const auto landmarks = body::FindLandmarks(motion.skeleton).value();
  double largest_rad = 0;
  for (int side = 0; side < 2; ++side) {
    const body::Joint& hip =
        motion.skeleton.joint(landmarks[body::OfSide(Landmark::kLeftHip, side)]);
    for (Eigen::Index i = 1; i < motion.frames(); ++i) {
      const Eigen::AngleAxisd turned(JointRotation(hip, motion.q.col(i - 1)).transpose() *
                                     JointRotation(hip, motion.q.col(i)));
      largest_rad = std::max(largest_rad, turned.angle());
    }
  }
  return largest_rad;
}

/// How far the landmark is from where the other motion has it, in any frame.
double FurthestM(const Motion& a, const Motion& b, Landmark landmark) {
  const auto landmarks = body::FindLandmarks(a.skeleton).value();
  body::Kinematics at_a(a.skeleton), at_b(b.skeleton);
  double furthest_m = 0;
  for (Eigen::Index i = 0; i < a.frames(); ++i) {
    ComputeKinematics(a.skeleton, a.q.col(i), at_a);
    ComputeKinematics(b.skeleton, b.q.col(i), at_b);
    const std::size_t joint = Index(landmarks[landmark]);
    furthest_m = std::max(furthest_m, (at_a.p_WJ[joint] - at_b.p_WJ[joint]).norm());
  }
  return furthest_m;
}

TEST(HalfTurns, AThighThatTurnsByHalfIsTurnedBack) {
  const Motion squat = Squat();
  Motion turned = squat;
  TurnByHalf(0, 100, 140, turned);
  TurnByHalf(1, 118, 119, turned);
  ASSERT_GT(LargestTurnRad(turned), 3);
  const Motion mended = WithoutHalfTurns(turned);
  EXPECT_LT(LargestTurnRad(mended), 0.1);
  for (const Landmark joint :
       {Landmark::kLeftKnee, Landmark::kRightKnee, Landmark::kLeftAnkle, Landmark::kRightAnkle}) {
    EXPECT_LT(FurthestM(turned, mended, joint), 1e-9) << body::LandmarkName(joint);
    EXPECT_LT(FurthestM(squat, mended, joint), 1e-9) << body::LandmarkName(joint);
  }
  // The ankle has two angles, which cannot turn a foot about the shank.
  EXPECT_LT(FurthestM(squat, mended, Landmark::kLeftToe), 0.02);
  EXPECT_LT(FurthestM(squat, mended, Landmark::kRightToe), 0.02);
}

TEST(HalfTurns, AMotionWithoutThemStaysAsItIs) {
  const Motion squat = Squat();
  EXPECT_EQ(WithoutHalfTurns(squat).q, squat.q);
}

TEST(HalfTurns, ALegWhoseOtherSolutionHasTheAnkleElsewhereStaysAsItIs) {
  Motion motion = Squat();
  TurnByHalf(0, 100, 140, motion);
  const auto landmarks = body::FindLandmarks(motion.skeleton).value();
  const int ankle = landmarks[Landmark::kLeftAnkle];
  motion.skeleton.joints[Index(ankle)].offset_m.x() += 0.05;  // No longer below the knee.
  EXPECT_EQ(WithoutHalfTurns(motion).q, motion.q);
}

TEST(HalfTurns, ASkeletonWithoutLegsStaysAsItIs) {
  Motion motion = Squat();
  TurnByHalf(0, 100, 140, motion);
  for (body::Joint& joint : motion.skeleton.joints) joint.name = "part of " + joint.name;
  EXPECT_EQ(WithoutHalfTurns(motion).q, motion.q);
}

TEST(HalfTurns, NoRecordedThighTurnsByHalfOnceItIsRead) {
  SKIP_WITHOUT_SHARED_DATA();
  const std::string folder = test::SharedData() + "/mocap/hdm05/";
  int clips = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.find("_dg_squat") == std::string::npos || entry.path().extension() != ".amc") continue;
    const auto loaded =
        motion_files::LoadMotion(entry.path().string(), {.skeleton = folder + "HDM_dg.asf"});
    ASSERT_TRUE(loaded.ok()) << loaded.error().message;
    EXPECT_LT(LargestTurnRad(loaded->motion), 0.5) << name;
    ++clips;
  }
  EXPECT_EQ(clips, 12);
}

}  // namespace
}  // namespace footing::motion
