#include "common/wire/wire.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "common/rig/follower.h"
#include "common/wire/scalar.h"
#include "footing/v1/session.pb.h"

namespace footing::wire {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// Sets every field of a message to a value of its own (enums to one number), so that a forgotten
/// or swapped field shows. Two elements in every repeated field.
struct Filler {
  int enum_number = 1;
  double number = 0.25;  ///< Added to every real number.
  int counter = 0;

  void Fill(Message& message) {
    for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
      const FieldDescriptor* field = message.GetDescriptor()->field(i);
      for (int count = field->is_repeated() ? 2 : 1; count > 0; --count) Set(message, field);
    }
  }

  void Set(Message& message, const FieldDescriptor* field) {
    const auto* reflection = message.GetReflection();
    const bool add = field->is_repeated();
    const int next = ++counter;
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
        if (add) return reflection->AddDouble(&message, field, next + number);
        return reflection->SetDouble(&message, field, next + number);
      case FieldDescriptor::CPPTYPE_BOOL:
        if (add) return reflection->AddBool(&message, field, true);
        return reflection->SetBool(&message, field, true);
      case FieldDescriptor::CPPTYPE_ENUM:
        return reflection->SetEnumValue(&message, field, enum_number);
      case FieldDescriptor::CPPTYPE_FLOAT:
        return reflection->SetFloat(&message, field, static_cast<float>(next + number));
    }
  }
};

/// Calls `visit` for each field that is set, also within messages.
template <typename Visit>
void VisitFields(const Message& message, const Visit& visit) {
  const auto* reflection = message.GetReflection();
  std::vector<const FieldDescriptor*> fields;
  reflection->ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    visit(message, field);
    if (field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) continue;
    if (!field->is_repeated()) VisitFields(reflection->GetMessage(message, field), visit);
    const int count = field->is_repeated() ? reflection->FieldSize(message, field) : 0;
    for (int i = 0; i < count; ++i) {
      VisitFields(reflection->GetRepeatedMessage(message, field, i), visit);
    }
  }
}

/// Fields of a filled message that do not come back: all others do.
void LeaveOut(const Message&) {}
void LeaveOut(v1::GaitState& message) { message.clear_phase(); }  // Static storage: out only.
void LeaveOut(v1::BoardInput& message) { message.mutable_corners_n()->Resize(4, 0); }
void LeaveOut(v1::TrialState& message) {
  const v1::FailureCounts& failures = message.failures();
  message.set_failed_attempts(failures.simulation() + failures.curve() + failures.jump() +
                              failures.straightness() + failures.transition());
}

template <typename M>
class EveryMessage : public testing::Test {};
template <typename Tuple>
struct TypesOf;
template <typename... M>
struct TypesOf<std::tuple<M...>> {
  using Types = testing::Types<v1::Vector3, v1::Quaternion, M...>;
};
TYPED_TEST_SUITE(EveryMessage, TypesOf<Messages>::Types);

TYPED_TEST(EveryMessage, KeepsEveryField) {
  TypeParam message;
  Filler().Fill(message);
  const TypeParam back = ToProto(FromProto(message));
  LeaveOut(message);
  EXPECT_EQ(back.DebugString(), message.DebugString());
}

TYPED_TEST(EveryMessage, IsTheSameStructAgain) {
  TypeParam message;
  Filler().Fill(message);
  const auto value = FromProto(message);
  EXPECT_TRUE(FromProto(ToProto(value)) == value);
  EXPECT_TRUE(FromProto(TypeParam()) == FromProto(TypeParam()));
}

TYPED_TEST(EveryMessage, HasUnknownEnumNumbersAsUnspecified) {
  TypeParam message;
  Filler{.enum_number = 99}.Fill(message);
  VisitFields(ToProto(FromProto(message)), [](const Message&, const FieldDescriptor* field) {
    EXPECT_NE(field->cpp_type(), FieldDescriptor::CPPTYPE_ENUM) << field->full_name();
  });
}

TYPED_TEST(EveryMessage, IsPublishedWithFiniteNumbersOnly) {
  for (const double number : {kNan, kInfinity, -kInfinity}) {
    TypeParam message;
    Filler{.number = number}.Fill(message);
    const TypeParam back = ToProto(FromProto(message));
    VisitFields(back, [](const Message& owner, const FieldDescriptor* field) {
      if (field->cpp_type() != FieldDescriptor::CPPTYPE_DOUBLE || field->is_repeated()) return;
      EXPECT_TRUE(std::isfinite(owner.GetReflection()->GetDouble(owner, field)))
          << field->full_name();
    });
  }
}

TEST(Wire, AGaitStateCarriesTheNameOfItsPhase) {
  stream::GaitState state;
  state.phase = "flight";
  state.next_foothold_m = {9, 10};
  EXPECT_EQ(ToProto(state).phase(), "flight");
  EXPECT_EQ(ToProto(state).next_foothold_x_m(), 9);
  EXPECT_EQ(ToProto(state).next_foothold_y_m(), 10);
}

TEST(Wire, WhatIsZeroOrMissingIsAbsent) {
  EXPECT_FALSE(ToProto(stream::MotionSample()).has_gyroscope_bias_radps());
  EXPECT_FALSE(ToProto(stream::MotionSample()).has_angular_velocity_radps());
  EXPECT_FALSE(ToProto(stream::HandSample()).has_covariance_m2());
  EXPECT_FALSE(ToProto(stream::RigSetup()).has_prompt());
  EXPECT_FALSE(FromProto(v1::MotionSample()).has_magnetic_field);
  EXPECT_FALSE(FromProto(v1::HandFrame()).tracker_pose);
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

TEST(SensorTick, LeavesOutSamplesThatAreNotFinite) {
  v1::Tick tick;
  for (const double number : {1.0, kNan, kInfinity}) {
    tick.mutable_motion()->add_samples()->mutable_specific_force_mps2()->set_z(number);
    tick.mutable_nunchuk()->add_samples()->set_stick_x(number);
    tick.mutable_boards()->add_samples()->set_cop_x_m(number);
    tick.mutable_contacts()->add_samples()->add_cells()->set_load_n(number);
    v1::HandSample& seen = *tick.mutable_hands()->add_samples();
    seen.set_confidence(1);
    seen.mutable_sd_m()->set_y(number);
  }
  const rig::Tick read = SensorTick(tick);
  EXPECT_EQ(read.motion.size(), 1u);
  EXPECT_EQ(read.nunchuks.size(), 1u);
  EXPECT_EQ(read.boards.size(), 1u);
  EXPECT_EQ(read.contacts.size(), 1u);
  EXPECT_EQ(read.hands.size(), 1u);
  EXPECT_FALSE(read.devices || read.setup);
}

TEST(SensorTick, APointThatWasNotSeenNeedsNoPlace) {
  v1::Tick tick;
  tick.mutable_hands()->add_samples()->mutable_position_m()->set_x(kNan);
  EXPECT_EQ(SensorTick(tick).hands.size(), 1u);
}

TEST(SensorTick, AnEmptyListOfDevicesIsNews) {
  v1::Tick tick;
  tick.set_epoch(7);
  tick.set_snapshot(true);
  tick.mutable_status();
  const rig::Tick read = SensorTick(tick);
  EXPECT_EQ(read.epoch, 7u);
  EXPECT_TRUE(read.snapshot);
  ASSERT_TRUE(read.devices);
  EXPECT_TRUE(read.devices->empty());
}

}  // namespace
}  // namespace footing::wire
