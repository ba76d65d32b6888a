// Layout, records and roles, and what outlives a restart.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/virtual/devices/wiimote.h"
#include "daemon/sensor/setup/setup_store.h"
#include "tests/sensor/service/kept.h"

namespace footing::sensor {
namespace {

using stream::DeviceRole;
using testing::HasSubstr;
using virtual_devices::PsMove;
using virtual_devices::Wiimote;

TEST(HubLayout, IsCheckedKeptAndPublished) {
  Kept kept;
  {
    Bench bench({}, kept.storage());
    ASSERT_TRUE(bench.hub().setup().SetBoardLayout(OneFootEach()));
    ASSERT_TRUE(bench.hub().setup().RecordSetup("", Passed("layout"), false));
    auto wider = OneFootEach();
    wider.gap_mm = 120;
    EXPECT_FALSE(bench.hub().setup().SetBoardLayout(wider)) << "the poses leave 20 mm";
    wider.left.y_m += 0.1;
    ASSERT_TRUE(bench.hub().setup().SetBoardLayout(wider));
    bench.Advance(0.1);
    EXPECT_TRUE(ItemOf(bench, "layout").stale) << "set anew, not checked";
  }
  Bench again({}, kept.storage());
  again.Advance(0.1);
  ASSERT_EQ(again.content.setup.size(), 1u);
  EXPECT_EQ(again.content.setup[0].rig, "main");
  EXPECT_EQ(again.content.setup[0].layout.gap_mm, 120);
  EXPECT_EQ(again.content.setup[0].items.size(), 1u);
}

TEST(HubRecord, ForgetsAndRefusesWhatIsTooLong) {
  Bench bench;
  ASSERT_TRUE(bench.hub().setup().RecordSetup("main", Passed("weigh"), false));
  bench.Advance(0.1);
  EXPECT_TRUE(ItemOf(bench, "weigh").passed);
  EXPECT_FALSE(bench.hub().setup().RecordSetup("main", Passed(""), false));
  EXPECT_FALSE(bench.hub().setup().RecordSetup(std::string(65, 'r'), Passed("weigh"), false));
  ASSERT_TRUE(bench.hub().setup().RecordSetup("main", {}, true));
  bench.Advance(0.1);
  EXPECT_TRUE(bench.content.setup.empty());
}

TEST(HubPrompts, ArePublishedUntilTheSetupOrItsSessionEnds) {
  Kept kept;
  Bench bench({}, kept.storage());
  const stream::SetupPrompt shake{"roles", "Shake the left wrist now.", stream::Gesture::kShake,
                                  DeviceRole::kLeftHand};
  const auto published = [&bench] {
    bench.Advance(0.1);
    const auto& setup = bench.content.setup;
    return setup.empty() ? std::nullopt : setup[0].prompt;
  };
  ASSERT_TRUE(bench.hub().setup().ShowPrompt(7, "", shake));
  ASSERT_TRUE(published());
  EXPECT_EQ(bench.content.setup[0].rig, "main");
  EXPECT_EQ(published()->text, shake.text);
  EXPECT_EQ(published()->gesture, stream::Gesture::kShake);
  EXPECT_EQ(published()->role, DeviceRole::kLeftHand);
  EXPECT_EQ(published()->number, 1u);
  ASSERT_TRUE(bench.hub().setup().ShowPrompt(7, "main", shake));
  EXPECT_EQ(published()->number, 2u) << "asked for again";
  bench.hub().EndSession(6);
  EXPECT_TRUE(published());
  bench.hub().EndSession(7);
  EXPECT_FALSE(published());
  ASSERT_TRUE(bench.hub().setup().ShowPrompt(8, "main", shake));
  ASSERT_TRUE(published());
  ASSERT_TRUE(bench.hub().setup().ShowPrompt(8, "main", std::nullopt));
  EXPECT_FALSE(published());
  stream::SetupPrompt long_one = shake;
  long_one.text = std::string(1025, 'x');
  EXPECT_FALSE(bench.hub().setup().ShowPrompt(8, "main", long_one));
  Bench again({}, kept.storage());
  again.Advance(0.1);
  EXPECT_TRUE(again.content.setup.empty()) << "nothing of it is kept";
}

TEST(HubRoles, GivenByCommandOutliveARestartAndTheConfig) {
  Kept kept;
  Config config;
  config.roles["a"] = "main/left_hand";
  {
    Bench bench(config, kept.storage());
    bench.Attach(Wiimote(1), "a");
    bench.Attach(Wiimote(2), "b");
    bench.Advance(0.3);
    ASSERT_TRUE(bench.hub().AssignRole("a", {"main", DeviceRole::kRightHand}));
  }
  Bench again(config, kept.storage());
  EXPECT_THAT(again.log, testing::Contains(HasSubstr("no longer main/left_hand")));
  again.Attach(Wiimote(2), "b");
  again.Attach(Wiimote(1), "a");
  again.Advance(0.3);
  EXPECT_EQ(again.StatusOf("a").role, DeviceRole::kRightHand);
  EXPECT_EQ(again.StatusOf("b").role, DeviceRole::kLeftHand) << "it was given a's role in exchange";
}

/// A PS Move that comes over USB once and over Bluetooth afterwards, where its calibration can't be
/// read.
class StoredMove : public testing::Test {
 protected:
  Hub MakeHub(bool readable) {
    Hub::Ports ports;
    ports.send = [](devices::DeviceHandle, const reports::OutputReport&) {};
    ports.log = [](const LogLine&) {};
    ports.now_ns = [this] { return now_ns_; };
    ports.request_feature = [this, readable](devices::DeviceHandle handle, std::uint8_t id,
                                             std::size_t size) {
      auto piece = readable ? move_.Feature(id, size) : std::nullopt;
      features_.emplace_back(handle, piece.value_or(virtual_devices::Report()));
    };
    ports.load_calibration = [this](const std::string& serial) {
      return calibrations_.Load(serial);
    };
    ports.save_calibration = [this](const std::string& serial,
                                    const std::vector<std::uint8_t>& bytes) {
      calibrations_.Save(serial, bytes);
    };
    return Hub({}, ports);
  }
  stream::DeviceStatus Run(Hub& hub, devices::Bus bus, const std::string& serial = "a") {
    devices::DeviceIdentity identity;
    identity.bus = bus;
    identity.vendor = devices::kVendorSony;
    identity.product = devices::kProductZcm1;
    identity.serial = serial;
    hub.OnAttach(1, identity);
    stream::DeviceStatus status;
    for (int tick = 0; tick < 500; ++tick) {
      now_ns_ += 10'000'000;
      for (const auto& [handle, bytes] : std::exchange(features_, {})) {
        hub.OnReport(handle, {now_ns_, bytes, 0, true});
      }
      const TickContent content = hub.Tick(now_ns_);
      if (content.has_status) status = content.status.at(0);
    }
    return status;
  }

  Kept kept_;
  setup::CalibrationStore calibrations_{kept_.storage()};
  PsMove move_{1, virtual_devices::MoveModel::kZcm1};
  std::vector<std::pair<devices::DeviceHandle, virtual_devices::Report>> features_;
  std::int64_t now_ns_ = 1'000'000'000;
};

TEST_F(StoredMove, IsCalibratedOverBluetoothByWhatWasReadOverUsb) {
  Hub usb = MakeHub(true);
  EXPECT_EQ(Run(usb, devices::Bus::kUsb).calibration, stream::CalibrationOrigin::kDevice);
  Hub bluetooth = MakeHub(false);
  EXPECT_EQ(Run(bluetooth, devices::Bus::kBluetooth).calibration,
            stream::CalibrationOrigin::kStored);
  Hub other = MakeHub(false);
  const auto status = Run(other, devices::Bus::kBluetooth, "b");
  EXPECT_EQ(status.calibration, stream::CalibrationOrigin::kDefaults);
  EXPECT_THAT(status.note, HasSubstr("USB"));
}

}  // namespace
}  // namespace footing::sensor
