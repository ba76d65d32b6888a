#include "common/wire/wire.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/wire/scalar.h"

namespace footing::wire {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// Sets every field of a message to a value of its own (enums to 1), so that a forgotten or swapped
/// field shows. Two elements in every repeated field.
class Filler {
 public:
  void Fill(Message& message) {
    for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
      const FieldDescriptor* field = message.GetDescriptor()->field(i);
      for (int count = field->is_repeated() ? 2 : 1; count > 0; --count) Set(message, field);
    }
  }

 private:
  void Set(Message& message, const FieldDescriptor* field) {
    const auto* reflection = message.GetReflection();
    const bool add = field->is_repeated();
    const int next = ++counter_;
    switch (field->cpp_type()) {
      case FieldDescriptor::CPPTYPE_MESSAGE:
        Fill(*(add ? reflection->AddMessage(&message, field)
                   : reflection->MutableMessage(&message, field)));
        return;
      case FieldDescriptor::CPPTYPE_STRING:
        if (add) return reflection->AddString(&message, field, "text" + std::to_string(next));
        return reflection->SetString(&message, field, "text" + std::to_string(next));
      case FieldDescriptor::CPPTYPE_INT32:
        if (add) return reflection->AddInt32(&message, field, next);
        return reflection->SetInt32(&message, field, next);
      case FieldDescriptor::CPPTYPE_INT64:
        return reflection->SetInt64(&message, field, next);
      case FieldDescriptor::CPPTYPE_UINT32:
        return reflection->SetUInt32(&message, field, static_cast<std::uint32_t>(next));
      case FieldDescriptor::CPPTYPE_UINT64:
        return reflection->SetUInt64(&message, field, static_cast<std::uint64_t>(next));
      case FieldDescriptor::CPPTYPE_DOUBLE:
        return reflection->SetDouble(&message, field, next + 0.25);
      case FieldDescriptor::CPPTYPE_BOOL:
        return reflection->SetBool(&message, field, true);
      case FieldDescriptor::CPPTYPE_ENUM:
        return reflection->SetEnumValue(&message, field, 1);
      case FieldDescriptor::CPPTYPE_FLOAT:
        return reflection->SetFloat(&message, field, static_cast<float>(next) + 0.25f);
    }
  }
  int counter_ = 0;
};

template <typename M>
class RoundTrip : public testing::Test {};
using Messages =
    testing::Types<v1::Vector3, v1::Quaternion, v1::DeviceStatus, v1::RawReport, v1::MotionSample,
                   v1::RigFeatures, v1::BoardSample, v1::NunchukSample, v1::CameraPoint,
                   v1::CameraSample, v1::BoardGeometry, v1::BoardPose, v1::BoardLayout,
                   v1::SetupItem, v1::RigSetup, v1::Skeleton, v1::Track, v1::LinkPose,
                   v1::HandFrame, v1::HandSample, v1::ReferencePose, v1::ContactFrame,
                   v1::ContactSample, v1::InterfaceState, v1::GameState, v1::StudyState>;
TYPED_TEST_SUITE(RoundTrip, Messages);

TYPED_TEST(RoundTrip, EveryFieldOfTheMessageSurvives) {
  TypeParam message;
  Filler().Fill(message);
  EXPECT_EQ(ToProto(FromProto(message)).DebugString(), message.DebugString());
}

TEST(Wire, ContactAndGaitStateCarryEveryField) {
  const v1::Contact contact = ToProto(stream::Contact{true, {1, 2, 3}, 4});
  EXPECT_EQ(contact.position_m().z(), 3);
  EXPECT_TRUE(contact.touching());
  EXPECT_EQ(contact.normal_force_n(), 4);

  stream::GaitState state{stream::Gait::kRun,
                          stream::Gait::kJump,
                          true,
                          "flight",
                          1,
                          2,
                          3,
                          4,
                          5,
                          6,
                          7,
                          {11, 12, 13, 15, 16},
                          14,
                          8,
                          true,
                          {9, 10}};
  const v1::GaitState message = ToProto(state);
  for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
    const FieldDescriptor* field = message.GetDescriptor()->field(i);
    EXPECT_TRUE(message.GetReflection()->HasField(message, field)) << field->name();
  }
  EXPECT_EQ(message.gait(), v1::GAIT_RUN);
  EXPECT_EQ(message.commanded_gait(), v1::GAIT_JUMP);
  EXPECT_EQ(message.speed_mps(), 4);
  EXPECT_EQ(message.distance_m(), 8);
  EXPECT_EQ(message.next_foothold_y_m(), 10);
}

TEST(Wire, ATrialCarriesEveryFieldAndTheSumOfItsFailures) {
  v1::TrialState filled;
  Filler().Fill(filled);
  v1::TrialState back = ToProto(FromProto(filled));
  EXPECT_EQ(back.failed_attempts(),
            filled.failures().simulation() + filled.failures().curve() + filled.failures().jump() +
                filled.failures().straightness() + filled.failures().transition());
  back.set_failed_attempts(filled.failed_attempts());
  EXPECT_EQ(back.DebugString(), filled.DebugString());
}

TEST(Wire, APhaseOfALaterVersionIsUnspecified) {
  v1::TrialState message;
  message.set_phase(static_cast<v1::TrialState::Phase>(77));
  message.set_task_phase(static_cast<v1::TrialState::TaskPhase>(-1));
  EXPECT_EQ(FromProto(message).progress.phase, stream::TrialPhase::kUnspecified);
  EXPECT_EQ(FromProto(message).progress.task_phase, stream::TaskPhase::kUnspecified);
}

TEST(Wire, NothingThatIsNotFiniteIsPublished) {
  stream::MotionSample motion;
  motion.specific_force_mps2 = {kNan, kInfinity, 1};
  EXPECT_EQ(ToProto(motion).specific_force_mps2().x(), 0);
  EXPECT_EQ(ToProto(motion).specific_force_mps2().y(), 0);
  EXPECT_EQ(ToProto(motion).specific_force_mps2().z(), 1);

  stream::BoardSample board;
  board.cop_x_m = kNan;
  board.total_n = -kInfinity;
  EXPECT_EQ(ToProto(board).cop_x_m(), 0);
  EXPECT_EQ(ToProto(board).total_n(), 0);

  stream::RigFeatures rig;
  rig.devices.emplace_back().frequency_hz = kNan;
  rig.pairs.emplace_back().phase_rad = kNan;
  EXPECT_EQ(ToProto(rig).devices(0).frequency_hz(), 0);
  EXPECT_EQ(ToProto(rig).pairs(0).phase_rad(), 0);

  stream::DeviceStatus status;
  status.jitter_ms = kNan;
  EXPECT_EQ(ToProto(status).jitter_ms(), 0);
}

TEST(Wire, AReferenceFrameKeepsItsJointsAndShowsWhatIsMissing) {
  stream::ReferenceFrame frame{"main", 7, {-1, 0}, {{1, 2, 3}, {4, 5, 6.5}}, {7, 8, 9}};
  v1::ReferenceFrame message = ToProto(frame);
  EXPECT_EQ(message.position_m_size(), 6);
  const stream::ReferenceFrame back = FromProto(message);
  EXPECT_EQ(back.rig, frame.rig);
  EXPECT_EQ(back.age_ns, frame.age_ns);
  EXPECT_EQ(back.parents, frame.parents);
  EXPECT_EQ(back.positions_m, frame.positions_m);
  EXPECT_EQ(back.com_m, frame.com_m);
  message.mutable_position_m()->RemoveLast();
  message.clear_com_m();
  EXPECT_TRUE(std::isnan(FromProto(message).positions_m[1].z()));
  EXPECT_TRUE(std::isnan(FromProto(message).com_m.x()));
}

TEST(Wire, AHandFrameComesInAsItIsSoThatItCanBeRefused) {
  v1::HandFrame message;
  message.add_points()->set_x_m(kNan);
  message.mutable_points(0)->set_confidence(kInfinity);
  EXPECT_TRUE(std::isnan(FromProto(message).points[0].position_m.x()));
  EXPECT_TRUE(std::isinf(FromProto(message).points[0].confidence));
  stream::HandFrame frame;
  frame.points.emplace_back().position_m.x() = kNan;
  EXPECT_EQ(ToProto(frame).points(0).x_m(), 0);
}

TEST(Wire, AContactFrameComesInAsItIsAndGoesOutFinite) {
  v1::ContactFrame message;
  message.add_cells()->set_load_n(kNan);
  message.set_body(static_cast<v1::ContactBody>(9));
  const stream::ContactFrame frame = FromProto(message);
  EXPECT_TRUE(std::isnan(frame.cells[0].load_n));
  EXPECT_EQ(frame.body, stream::ContactBody::kUnspecified);
  stream::ContactSample sample;
  sample.cells = {{{kNan, 1, kInfinity}, kNan}};
  EXPECT_EQ(ToProto(sample).cells(0).x_m(), 0);
  EXPECT_EQ(ToProto(sample).cells(0).y_m(), 1);
  EXPECT_EQ(ToProto(sample).cells(0).load_n(), 0);
}

TEST(Wire, ARotationThatIsNoneBecomesTheIdentity) {
  const v1::Quaternion broken = ToProto(Eigen::Quaterniond(kNan, 0, 0, 1));
  EXPECT_EQ(broken.w(), 1);
  EXPECT_EQ(broken.z(), 0);
  EXPECT_EQ(FromProto(v1::Quaternion()).w(), 1);  // An absent field.
}

TEST(Wire, AnUnknownEnumNumberBecomesUnspecified) {
  v1::DeviceStatus status;
  status.set_state(static_cast<v1::DeviceState>(99));
  status.set_role(static_cast<v1::DeviceRole>(99));
  EXPECT_EQ(FromProto(status).state, stream::DeviceState::kUnspecified);
  EXPECT_EQ(FromProto(status).role, stream::DeviceRole::kUnspecified);
}

TEST(Wire, TextFromADeviceIsMadeReadable) {
  EXPECT_EQ(Utf8("Grüße €, 𝄞"), "Grüße €, 𝄞");
  EXPECT_EQ(Utf8("a\xff\xc3"), "a??");
  EXPECT_EQ(Utf8("\xc0\x80"), "??");                   // Overlong zero.
  EXPECT_EQ(Utf8("\xed\xa0\x80"), "???");              // A surrogate.
  EXPECT_EQ(Utf8("\xf4\x90\x80\x80"), "????");         // Beyond U+10FFFF.
  EXPECT_EQ(Utf8(std::string("z\0z", 3)).size(), 3u);  // Zero is a character.
  stream::DeviceStatus status;
  status.name = "Nintendo\xff";
  v1::DeviceStatus parsed;
  ASSERT_TRUE(parsed.ParseFromString(ToProto(status).SerializeAsString()));
  EXPECT_EQ(parsed.name(), "Nintendo?");
}

}  // namespace
}  // namespace footing::wire
