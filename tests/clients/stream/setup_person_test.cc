#include "clients/stream/body_stage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/board/geometry.h"
#include "common/wire/wire.h"

namespace footing::stream_client {
namespace {

using stream::DeviceRole;
using stream::Gesture;

/// A person whom a setup asks, in time that the test gives.
class Asked {
 public:
  explicit Asked(const SetupPersonOptions& options = {})
      : planned_(PlanSetupPerson(options, {})),
        person_(io_, planned_->body, "main", record_, [] {}) {}

  void Ask(Gesture gesture, DeviceRole role = DeviceRole::kUnspecified,
           const stream::BoardLayout& layout = {}) {
    stream::RigSetup rig;
    rig.rig = "main";
    rig.layout = layout;
    rig.prompt = stream::SetupPrompt{"item", "text", gesture, role, ++number_};
    v1::Tick tick;
    *tick.mutable_setup()->add_rigs() = wire::ToProto(rig);
    person_.See(tick);
    person_.See(tick);  // Published again with another change of the set-up.
  }
  double LoadN(int board) { return board::Total(planned_->body->Board(board, time_s_ += 5)); }
  /// Largest difference from gravity that the remote feels during a second.
  double ShakeMps2(int limb) {
    double most_mps2 = 0;
    for (int i = 0; i < 100; ++i) {
      const double off_mps2 = planned_->body->Limb(limb, time_s_ += 0.01).norm() - 9.80665;
      most_mps2 = std::max(most_mps2, std::abs(off_mps2));
    }
    return most_mps2;
  }
  const SetupRecord& record() const { return *record_; }

 private:
  boost::asio::io_context io_;
  Result<SetupPersonPlan> planned_;
  std::shared_ptr<SetupRecord> record_ = std::make_shared<SetupRecord>();
  SetupPerson person_;
  std::uint64_t number_ = 0;
  double time_s_ = 0;
};

TEST(SetupPerson, DoesWhatIsAskedForAndNothingBefore) {
  Asked asked;
  EXPECT_NEAR(asked.LoadN(0) + asked.LoadN(1), 0, 5);
  asked.Ask(Gesture::kStepOn, DeviceRole::kRightBoard);
  EXPECT_NEAR(asked.LoadN(0), 0, 5);
  EXPECT_NEAR(asked.LoadN(1), 70 * 9.80665, 5);
  asked.Ask(Gesture::kStand);
  EXPECT_NEAR(asked.LoadN(0), 35 * 9.80665, 5);
  asked.Ask(Gesture::kStepOff);
  EXPECT_NEAR(asked.LoadN(1), 0, 5);
  EXPECT_LT(asked.ShakeMps2(0), 1);
  asked.Ask(Gesture::kShake, DeviceRole::kLeftHand);
  EXPECT_GT(asked.ShakeMps2(0), 4);
  EXPECT_LT(asked.ShakeMps2(1), 1);
  asked.Ask(Gesture::kUnspecified);
  ASSERT_EQ(asked.record().asked.size(), 5u) << "each prompt once";
  EXPECT_TRUE(asked.record().asked[3].performed);
  EXPECT_FALSE(asked.record().asked[4].performed);
}

TEST(SetupPerson, StandsWithItsWholeWeightOnOneBoardAlone) {
  Asked asked({.boards = 1, .mass_kg = 50});
  asked.Ask(Gesture::kStand);
  EXPECT_NEAR(asked.LoadN(0), 50 * 9.80665, 5);
}

TEST(SetupPerson, HasTheDevicesOfItsInterface) {
  const auto roles = [](const SetupPersonOptions& options) {
    std::vector<DeviceRole> all;
    const auto planned = PlanSetupPerson(options, {});
    if (!planned) return all;
    for (const SimulatedDevice& device : planned->plan.devices) all.push_back(device.role());
    return all;
  };
  using enum stream::DeviceRole;
  EXPECT_EQ(roles({}), (std::vector{kLeftBoard, kRightBoard, kLeftHand, kRightHand}));
  EXPECT_EQ(roles({.interface = "leg"}), (std::vector{kLeftLeg, kRightLeg}));
  EXPECT_EQ(roles({.interface = "joystick"}), (std::vector{kRightHand}));
  EXPECT_EQ(roles({.interface = "boards"}), (std::vector{kLeftBoard, kRightBoard}));
  EXPECT_EQ(roles({.interface = "wrist", .boards = 1, .jumbled = true}),
            (std::vector{kLeftBoard, kRightHand, kLeftHand}));
  EXPECT_FALSE(PlanSetupPerson({.interface = "telepathy"}, {}));
  EXPECT_FALSE(PlanSetupPerson({.interface = "boards", .boards = 0}, {}));
}

}  // namespace
}  // namespace footing::stream_client
