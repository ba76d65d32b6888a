#include "clients/skeleton/tracking/dialects.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "clients/skeleton/tracking/decoder.h"
#include "tests/clients/skeleton/clips.h"
#include "tests/clients/skeleton/send.h"

namespace footing::skeleton {
namespace {

constexpr Dialect kWritten[] = {Dialect::kSensebloom, Dialect::kQuartz, Dialect::kZillode,
                                Dialect::kKinectSdk2, Dialect::kFooting};

/// Confidence as the dialect can state it.
double Said(Dialect dialect, double confidence) {
  const double least = dialect == Dialect::kSensebloom || dialect == Dialect::kQuartz ? 0.5 : 0.1;
  if (confidence < least && dialect != Dialect::kFooting) return 0;
  if (dialect == Dialect::kSensebloom || dialect == Dialect::kQuartz) return 1;
  return static_cast<double>(static_cast<float>(confidence));
}

/// Half a step of a float of this size, in metres, and the double's own rounding.
double Rounding(Dialect dialect, double p_m) {
  const double unit_m = dialect == Dialect::kFooting                                     ? 1
                        : dialect == Dialect::kSensebloom || dialect == Dialect::kQuartz ? 2.56
                                                                                         : 1e-3;
  // Normalised coordinates are below 8, so their steps are at most 2^-21.
  const double number = unit_m > 2 ? 4 : std::abs(p_m) / unit_m;
  return unit_m * number * std::ldexp(1.0, -24) + 1e-15;
}

TEST(Dialects, CarryRealSkeletonsWithoutLossButForFloatRounding) {
  const auto clips = RealClips();
  if (clips.empty()) GTEST_SKIP() << "needs FOOTING_TEST_DATA";
  for (const Dialect dialect : kWritten) {
    std::size_t frames = 0, joints = 0;
    for (const auto& clip : clips) {
      Decoder decoder({});
      std::int64_t now_ns = 0;
      for (const ClipFrame& frame : clip) {
        Skeleton sent = frame.skeleton;
        sent.sent_ns = 1'700'000'000'000'000'000 + frame.time_ns;
        std::vector<Decoded> complete;
        now_ns += 33'000'000;
        Send(decoder, Encode(dialect, {}, sent), now_ns, complete);
        ASSERT_EQ(complete.size(), 1u) << NameOf(dialect);
        const Skeleton& got = complete[0].skeleton;
        EXPECT_EQ(complete[0].dialect, dialect);
        EXPECT_EQ(got.user, 1);
        if (dialect == Dialect::kFooting) {
          EXPECT_EQ(got.sequence, sent.sequence);
          EXPECT_EQ(got.sent_ns, sent.sent_ns);
        }
        for (std::size_t i = 0; i < kJoints; ++i) {
          ASSERT_EQ(got.joints[i].confidence, Said(dialect, sent.joints[i].confidence));
          if (!got.joints[i].present()) continue;
          ++joints;
          for (int axis = 0; axis < 3; ++axis) {
            const double p_m = sent.joints[i].p_K_m[axis];
            ASSERT_NEAR(got.joints[i].p_K_m[axis], p_m, Rounding(dialect, p_m)) << NameOf(dialect);
          }
        }
        ++frames;
      }
      EXPECT_EQ(decoder.counts().unknown + decoder.counts().rejected, 0u);
    }
    EXPECT_EQ(frames, 858u);
    EXPECT_GT(joints, 9'000u);
  }
}

TEST(Dialects, CarryScaledShiftedAndMirroredNumbers) {
  DialectOptions options;
  options.factor = {2, -1, 0.5};
  options.offset = {0.1, 0.2, 0.3};
  options.mirrored = true;
  options.flip_y = true;
  for (const Dialect dialect : kWritten) {
    Decoder decoder(options);
    std::vector<Decoded> complete;
    Send(decoder, Encode(dialect, options, Standing()), 1, complete);
    ASSERT_EQ(complete.size(), 1u);
    for (std::size_t i = 0; i < kJoints; ++i)
      EXPECT_LT((complete[0].skeleton.joints[i].p_K_m - Standing().joints[i].p_K_m).norm(), 1e-5);
  }
}

TEST(Dialects, MeanWhatTheirSendersMean) {
  // OSCeleton.cpp: x = (1280 - X)/2560, y = (960 - Y)/1920, z = Z 7.8125/10000, in mm, where X
  // points to the camera's right: 0.64 m right, 0.48 m up, 2 m away.
  const Eigen::Vector3d p_K(-0.64, 0.48, 2);
  const auto near = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    EXPECT_LT((a - b).norm(), 1e-12) << a.transpose();
  };
  near(FromCamera(Dialect::kSensebloom, {}, p_K),
       {(1280 - 640) / 2560.0, (960 - 480) / 1920.0, 1.5625});
  near(FromCamera(Dialect::kZillode, {}, p_K), {640, 480, 2000});
  // TrackingInformation.cs: (x, -y, z) of Kinect times 1000.
  near(FromCamera(Dialect::kKinectSdk2, {}, p_K), {-640, -480, 2000});
  near(FromCamera(Dialect::kFooting, {}, p_K), p_K);
}

TEST(Dialects, ReadTheBytesThatTheDocumentationShows) {
  std::stringstream page;
  for (const char* file : {"/docs/skeleton.md", "/docs/examples/osceleton.txt"}) {
    page << std::ifstream(std::string(FOOTING_SOURCE_DIR) + file).rdbuf();
  }
  std::string line, name, bytes;
  std::size_t shown = 0;
  while (std::getline(page, line)) {
    if (line.starts_with("```osc ")) {
      name = line.substr(7);
      bytes.clear();
    } else if (line == "```" && !name.empty()) {
      Decoder decoder({});
      std::vector<Decoded> complete;
      Send(decoder, {bytes}, 1, complete);
      decoder.Flush(Decoder::kPatienceNs + 1, complete);
      ASSERT_EQ(complete.size(), 1u) << name;
      EXPECT_EQ(NameOf(complete[0].dialect), name);
      EXPECT_EQ(complete[0].skeleton.user, 1);
      const auto& hand = complete[0].skeleton[Joint::kLeftHand];
      EXPECT_LT((hand.p_K_m - Eigen::Vector3d(-0.64, 0.48, 2)).norm(), 1e-6) << name;
      if (name == "footing") {
        EXPECT_EQ(complete[0].skeleton.sequence, 7);
        EXPECT_EQ(complete[0].skeleton.sent_ns, 1'790'000'000'500'000'000);
        EXPECT_EQ(hand.confidence, 0.75);
      }
      ++shown;
      name.clear();
    } else if (!name.empty()) {
      std::istringstream digits(line.substr(0, line.find('#')));
      for (std::string byte; digits >> byte;)
        bytes.push_back(static_cast<char>(std::stoi(byte, nullptr, 16)));
    }
  }
  EXPECT_EQ(shown, kDialects - 1) << "all but vmc, which has no joints";
}

/// Packets of KinectV2-OSC for a person: 25 joints and two hands, one each.
std::vector<std::string> FromKinectV2Osc(const Skeleton& skeleton, std::string_view state) {
  constexpr std::pair<const char*, Joint> kSent[] = {{"SpineBase", Joint::kLeftHip},
                                                     {"SpineMid", Joint::kTorso},
                                                     {"Neck", Joint::kHead},
                                                     {"Head", Joint::kHead},
                                                     {"ShoulderLeft", Joint::kLeftShoulder},
                                                     {"ElbowLeft", Joint::kLeftElbow},
                                                     {"WristLeft", Joint::kLeftElbow},
                                                     {"HandLeft", Joint::kLeftHand},
                                                     {"ShoulderRight", Joint::kRightShoulder},
                                                     {"ElbowRight", Joint::kRightElbow},
                                                     {"WristRight", Joint::kRightElbow},
                                                     {"HandRight", Joint::kRightHand},
                                                     {"HipLeft", Joint::kLeftHip},
                                                     {"KneeLeft", Joint::kLeftKnee},
                                                     {"AnkleLeft", Joint::kLeftFoot},
                                                     {"FootLeft", Joint::kLeftKnee},
                                                     {"HipRight", Joint::kRightHip},
                                                     {"KneeRight", Joint::kRightKnee},
                                                     {"AnkleRight", Joint::kRightFoot},
                                                     {"FootRight", Joint::kRightKnee},
                                                     {"SpineShoulder", Joint::kNeck},
                                                     {"HandTipLeft", Joint::kLeftElbow},
                                                     {"ThumbLeft", Joint::kLeftElbow},
                                                     {"HandTipRight", Joint::kRightElbow},
                                                     {"ThumbRight", Joint::kRightElbow}};
  const std::string person = "/bodies/72057594037928017";  // Beyond 32 bits, 81 in the lower 31.
  std::vector<std::string> packets;
  for (const auto& [name, joint] : kSent) {
    const Eigen::Vector3f p = skeleton[joint].p_K_m.cast<float>();
    const osc::Argument arguments[] = {p.x(), p.y(), p.z(), state};
    packets.push_back(osc::WriteMessage(person + "/joints/" + name, arguments));
  }
  for (const char* hand : {"Left", "Right"}) {
    const osc::Argument arguments[] = {std::string_view("Open"), std::string_view("High")};
    packets.push_back(osc::WriteMessage(person + "/hands/" + hand, arguments));
  }
  return packets;
}

TEST(Decoder, TakesTheBestOfKinectV2OscAndEndsAPersonWithItsHands) {
  Decoder decoder({});
  std::vector<Decoded> complete;
  for (const std::string_view state : {"Tracked", "Inferred", "NotTracked"}) {
    Send(decoder, FromKinectV2Osc(Standing(), state), 1, complete);
  }
  ASSERT_EQ(complete.size(), 3u) << "none waits for the next one";
  const double confidences[] = {1, 0.5, 0.1};
  for (std::size_t i = 0; i < complete.size(); ++i) {
    EXPECT_EQ(complete[i].dialect, Dialect::kKinectV2);
    EXPECT_EQ(complete[i].skeleton.user, 81);
    for (std::size_t k = 0; k < kJoints; ++k) {
      const JointReading& got = complete[i].skeleton.joints[k];
      EXPECT_LT((got.p_K_m - Standing().joints[k].p_K_m).norm(), 1e-6) << kJointNames[k];
      EXPECT_EQ(got.confidence, confidences[i]);
    }
  }
  EXPECT_EQ(decoder.counts().unknown + decoder.counts().rejected, 0u);
}

TEST(Decoder, KnowsTheNumbersOfAzureKinectOscAndEndsAPersonWithTheLast) {
  // k4abt_joint_id_t; the others of its 32 are of no use here.
  constexpr std::pair<int, Joint> kNumbers[] = {
      {1, Joint::kTorso},       {3, Joint::kNeck},       {5, Joint::kLeftShoulder},
      {6, Joint::kLeftElbow},   {8, Joint::kLeftHand},   {12, Joint::kRightShoulder},
      {13, Joint::kRightElbow}, {15, Joint::kRightHand}, {18, Joint::kLeftHip},
      {19, Joint::kLeftKnee},   {20, Joint::kLeftFoot},  {22, Joint::kRightHip},
      {23, Joint::kRightKnee},  {24, Joint::kRightFoot}, {26, Joint::kHead}};
  Decoder decoder({});
  std::vector<Decoded> complete;
  for (const bool with_orientation : {false, true}) {
    for (int number = 0; number < 32; ++number) {
      Eigen::Vector3f p(9000, 9000, 9000);
      for (const auto& [known, joint] : kNumbers) {
        const Eigen::Vector3d p_K_m = Standing()[joint].p_K_m;  // x left, y up.
        if (known == number)
          p = (1e3 * Eigen::Vector3d(-p_K_m.x(), -p_K_m.y(), p_K_m.z())).cast<float>();
      }
      std::vector<osc::Argument> arguments = {p.x(), p.y(), p.z()};
      if (with_orientation) arguments.insert(arguments.end(), {0.f, 0.f, 0.f, 1.f});
      Send(decoder, {osc::WriteMessage("/bodies/0/joints/" + std::to_string(number), arguments)}, 1,
           complete);
    }
  }
  ASSERT_EQ(complete.size(), 2u);
  for (const Decoded& one : complete) {
    EXPECT_EQ(one.dialect, Dialect::kAzure);
    EXPECT_EQ(one.skeleton.user, 0);
    for (std::size_t k = 0; k < kJoints; ++k)
      EXPECT_LT((one.skeleton.joints[k].p_K_m - Standing().joints[k].p_K_m).norm(), 1e-5)
          << kJointNames[k];
  }
  EXPECT_EQ(decoder.counts().unknown + decoder.counts().rejected, 0u);
}

TEST(Decoder, BodiesThatAreNoneAreCountedWithAReason) {
  Decoder decoder({});
  std::vector<Decoded> complete;
  const osc::Argument three[] = {0.f, 0.f, 2.f};
  for (const char* address : {"/bodies/", "/bodies/1", "/bodies/1/", "/bodies/x/joints/Head",
                              "/bodies/1/joints", "/bodies/1/feet/Left", "/bodies/-1/joints/Head"})
    Send(decoder, {osc::WriteMessage(address, three)}, 1, complete);
  EXPECT_EQ(decoder.counts().unknown, 7u);
  Send(decoder, {osc::WriteMessage("/bodies/1/joints/32", three)}, 1, complete);
  EXPECT_EQ(decoder.counts().unknown, 8u) << "neither a number of Azure Kinect nor a name";
  decoder.Flush(1'000'000'000, complete);
  EXPECT_TRUE(complete.empty());
  ASSERT_FALSE(decoder.TakeProblems().empty());
}

TEST(Decoder, CompletesAPersonWhenTheNextFrameBegins) {
  // KinectSDK2 sends a packet a joint; here half of the joints are not sent.
  Skeleton half = Standing();
  half[Joint::kHead].confidence = half[Joint::kRightFoot].confidence = 0;
  half.sent_ns = 5'000'000;
  Decoder decoder({});
  std::vector<Decoded> complete;
  Send(decoder, Encode(Dialect::kKinectSdk2, {}, half), 100, complete);
  EXPECT_TRUE(complete.empty());
  half.sent_ns = 38'000'000;
  Send(decoder, Encode(Dialect::kKinectSdk2, {}, half), 33'000'100, complete);
  ASSERT_EQ(complete.size(), 1u);
  EXPECT_EQ(complete[0].skeleton.sent_ns, 5'000'000);
  EXPECT_EQ(complete[0].arrived_ns, 100);
  EXPECT_EQ(complete[0].skeleton.present(), 13u);
  decoder.Flush(34'000'000, complete);
  EXPECT_EQ(complete.size(), 1u);
  decoder.Flush(33'000'100 + Decoder::kPatienceNs, complete);
  EXPECT_EQ(complete.size(), 2u);
}

TEST(Decoder, TakesATimeOf0ForNone) {
  // Milliseconds of 0, and the time tags 0 and 1: every frame is one of its own, however many come.
  for (const Dialect dialect : {Dialect::kZillode, Dialect::kKinectSdk2, Dialect::kFooting}) {
    Skeleton whole = Standing();
    whole.sent_ns.reset();
    Decoder decoder({});
    std::vector<Decoded> complete;
    for (std::int64_t i = 0; i < 3; ++i) {
      std::vector<std::string> packets = Encode(dialect, {}, whole);
      // Clears the last byte of the time tag: 8 of "#bundle" and 8 of the tag.
      if (dialect == Dialect::kFooting && i == 1) packets[0][15] = 0;
      Send(decoder, packets, i * 33'000'000, complete);
    }
    decoder.Flush(1'000'000'000, complete);
    ASSERT_EQ(complete.size(), 3u) << NameOf(dialect);
    for (const Decoded& one : complete) {
      EXPECT_FALSE(one.skeleton.sent_ns) << NameOf(dialect);
      EXPECT_EQ(one.skeleton.present(), kJoints);
    }
    EXPECT_EQ(decoder.counts().late, 0u) << NameOf(dialect);
  }
}

TEST(Decoder, LeavesALateJointOfACompleteFrameOut) {
  Skeleton whole = Standing();
  whole.sent_ns = 5'000'000;
  Decoder decoder({});
  std::vector<Decoded> complete;
  const auto packets = Encode(Dialect::kKinectSdk2, {}, whole);
  Send(decoder, packets, 100, complete);
  ASSERT_EQ(complete.size(), 1u) << "at once when all 15 are there";
  const osc::Argument tip[] = {std::string_view("r_foot"), 0, 1, 0.f, 0.f, 0.f, 1.f, 5.0};
  Send(decoder, {osc::WriteMessage("/osceleton2/joint", tip)}, 101, complete);
  decoder.Flush(1'000'000'000, complete);
  EXPECT_EQ(complete.size(), 1u);
  EXPECT_EQ(decoder.counts().late, 1u);
}

TEST(Decoder, KeepsPersonsApartAndTheirNumberBounded) {
  Decoder decoder({});
  std::vector<Decoded> complete;
  std::vector<std::string> messages;
  for (std::int32_t user = 1; user <= 100; ++user) {
    const osc::Argument hand[] = {std::string_view("l_hand"), user, 0.5f, 0.5f, 1.f};
    messages.push_back(osc::WriteMessage("/joint", hand));
  }
  Send(decoder, {osc::WriteBundle({}, messages)}, 1, complete);
  EXPECT_EQ(complete.size(), Decoder::kMostPeople);
  EXPECT_EQ(decoder.counts().rejected, 100 - Decoder::kMostPeople);
}

TEST(Decoder, RejectsNumbersThatMakeNoSense) {
  Decoder decoder({});
  std::vector<Decoded> complete;
  for (const float wrong : {std::nanf(""), INFINITY, 1e9f}) {
    const osc::Argument hand[] = {std::string_view("l_hand"), 1, wrong, 0.5f, 1.f};
    Send(decoder, {osc::WriteMessage("/joint", hand)}, 1, complete);
  }
  const osc::Argument unsure[] = {std::string_view("l_hand"), 0.f, 0.f, 1.f, 1.5f};
  Send(decoder, {osc::WriteMessage("/footing/joint", unsure)}, 1, complete);
  decoder.Flush(1'000'000'000, complete);
  EXPECT_TRUE(complete.empty());
  EXPECT_EQ(decoder.counts().rejected, 4u);
}

TEST(Decoder, SaysWhatItDoesNotUnderstand) {
  Decoder decoder({});
  std::vector<Decoded> complete;
  const osc::Argument flat[] = {std::string_view("l_hand1"), 0.5f, 0.5f};
  Send(decoder, {osc::WriteMessage("/joint", flat)}, 1, complete);
  // The first of a kind is said, the others are counted.
  EXPECT_THAT(decoder.TakeProblems(),
              testing::ElementsAre(testing::HasSubstr("kitchen mode has two dimensions")));
  Send(decoder, {osc::WriteMessage("/tempo", {})}, 1, complete);
  const osc::Argument one[] = {1.f, 2.f, 3.f};
  Send(decoder, {osc::WriteMessage("/joint/l_hand/x", one)}, 1, complete);
  EXPECT_THAT(decoder.TakeProblems(), testing::IsEmpty());
  EXPECT_EQ(decoder.counts().unknown, 3u);
  // Events that OSCeleton sends, in hand mode without arguments, are nothing to report.
  Send(decoder, {osc::WriteMessage("/new_user", {}), osc::WriteMessage("/lost_user", {})}, 1,
       complete);
  EXPECT_EQ(decoder.counts().unknown, 3u);
}

TEST(WithSides, UndoesEachWayInWhichASenderMayMixThem) {
  Skeleton sent = Standing();
  sent[Joint::kLeftHand].p_K_m.y() = 0.6;  // The left one is raised.
  for (const bool mirrored : {false, true}) {
    for (const bool swap_sides : {false, true}) {
      const DialectOptions options{.mirrored = mirrored, .swap_sides = swap_sides};
      Decoder decoder(options);
      std::vector<Decoded> complete;
      Send(decoder, Encode(Dialect::kFooting, options, sent), 1, complete);
      ASSERT_EQ(complete.size(), 1u);
      for (std::size_t i = 0; i < kJoints; ++i) {
        EXPECT_LT((complete[0].skeleton.joints[i].p_K_m - sent.joints[i].p_K_m).norm(), 1e-6);
      }
    }
  }
  const Skeleton names = WithSides({.swap_sides = true}, sent);
  EXPECT_EQ(names[Joint::kRightHand].p_K_m, sent[Joint::kLeftHand].p_K_m);
  const Skeleton picture = WithSides({.mirrored = true, .swap_sides = true}, sent);
  EXPECT_EQ(picture[Joint::kLeftHand].p_K_m,
            sent[Joint::kLeftHand].p_K_m.cwiseProduct(Eigen::Vector3d(-1, 1, 1)));
}

}  // namespace
}  // namespace footing::skeleton
