// Accessories that come and go at the extension port, before and while data flow.
#include <gtest/gtest.h>

#include "tests/sensor/reports/fixture.h"
#include "tests/sensor/reports/port_model.h"

namespace footing::handshake {
namespace {

using Child = PortModel::Child;
using stream::CalibrationOrigin;
using stream::Extension;
using Talk = Conversation<PortModel>;

Talk With(Child child, bool motion_plus) {
  Talk talk(PortModel(child, motion_plus), "Nintendo RVL-CNT-01");
  talk.sample = [](PortModel& model) { return model.Sample(); };
  return talk;
}

void Say(Talk& talk, const std::vector<virtual_devices::Report>& reports) {
  for (const auto& report : reports) talk.Receive(report);
}

/// Counts the data reports with acceleration that arrive in that time.
int CoreReports(Talk& talk, double seconds) {
  int count = 0;
  talk.on_input = [&count](virtual_devices::Report& report) {
    count += report[0] >= 0x31 && report[0] <= 0x37 ? 1 : 0;
    return true;
  };
  talk.Advance(seconds);
  talk.on_input = nullptr;
  return count;
}

TEST(ExtensionPort, ANunchukIsLiveWithItsOwnCalibration) {
  Talk talk = With(Child::kNunchuk, false);
  talk.Advance(0.5);
  EXPECT_EQ(talk.handshake().extension(), Extension::kNunchuk);
  EXPECT_TRUE(talk.handshake().port().ready());
  EXPECT_EQ(talk.handshake().extension_origin(), CalibrationOrigin::kDevice);
  EXPECT_EQ(talk.handshake().port().nunchuk.zero_counts[0],
            0x7d << 2);  // Low bits 0a: x 0, y 2, z 2.
  EXPECT_EQ(talk.device().controller().mode(), 0x35);
}

TEST(ExtensionPort, AMotionPlusIsSwitchedOnWithItsOwnCalibration) {
  Talk talk = With(Child::kNone, true);
  talk.Advance(1);
  EXPECT_EQ(talk.handshake().extension(), Extension::kMotionPlus);
  EXPECT_EQ(talk.handshake().gyroscope_origin(), CalibrationOrigin::kDevice);
  EXPECT_EQ(talk.handshake().motion_plus().calibration.slow.zero[0], 0x760f);
  EXPECT_EQ(talk.device().active_mode(), 0x04);
  EXPECT_EQ(talk.device().controller().mode(), 0x35);
}

TEST(ExtensionPort, TheNunchuksCalibrationIsReadBeforeTheMotionPlusHidesIt) {
  Talk talk = With(Child::kNunchuk, true);
  talk.Advance(1);
  EXPECT_EQ(talk.handshake().extension(), Extension::kMotionPlusNunchuk);
  EXPECT_EQ(talk.handshake().extension_origin(), CalibrationOrigin::kDevice);
  EXPECT_EQ(talk.handshake().gyroscope_origin(), CalibrationOrigin::kDevice);
  EXPECT_EQ(talk.device().active_mode(), 0x05);
}

/// As hid_wiimote does when it looks for a MotionPlus: the key, which switches an active one off.
void SwitchOffByAnother(Talk& talk) {
  virtual_devices::Report key(22, 0);
  key[0] = 0x16;
  key[1] = 0x04;
  key[2] = 0xa4;
  key[4] = 0xf0;
  key[5] = 1;
  key[6] = 0x55;
  Say(talk, talk.device().HandleOutput(key));
}

TEST(ExtensionPort, AMotionPlusThatAnotherKeepsSwitchingOffIsLeftAlone) {
  Talk talk = With(Child::kNone, true);
  talk.Advance(1);
  for (int i = 0; i < 60; ++i) {
    if (talk.device().active()) SwitchOffByAnother(talk);
    talk.Advance(0.5);
  }
  EXPECT_FALSE(talk.device().active());
  EXPECT_NE(talk.Note().find("ignore_special_drivers"), std::string::npos);
  const int activations = talk.device().activations();
  EXPECT_LE(activations, 6);
  EXPECT_GE(CoreReports(talk, 20), 3990);  // 200 a second here.
  EXPECT_EQ(talk.device().activations(), activations);
}

TEST(ExtensionPort, AMotionPlusThatIsSwitchedOffNowAndThenComesBack) {
  Talk talk = With(Child::kNone, true);
  talk.Advance(1);
  for (int i = 0; i < 20; ++i) {
    SwitchOffByAnother(talk);
    talk.Advance(15);
    ASSERT_TRUE(talk.device().active()) << i;
  }
  EXPECT_EQ(talk.Note(), "");
}

TEST(ExtensionPort, WithoutTheConfigAMotionPlusIsLeftAlone) {
  decode::KindOptions options;
  options.handshake.motion_plus = false;
  const auto kind = kinds::MakeKind(options, {0, 0, "Nintendo RVL-CNT-01"}, {});
  PortModel model(Child::kNone, true);
  for (int i = 1; i < 3000; ++i) {
    kinds::Outputs outputs;
    kind->Advance(i * 10'000'000LL, outputs);
    if (auto report = model.Sample()) {
      (void)kind->Take(i * 10'000'000LL, *report, outputs);
    }
    for (std::size_t k = 0; k < outputs.size(); ++k) {
      const auto output = outputs[k];
      EXPECT_FALSE(output[0] == 0x16 && output[2] == 0xa6);
      for (auto& answer : model.HandleOutput(output)) {
        (void)kind->Take(i * 10'000'000LL, answer, outputs);
      }
    }
  }
  EXPECT_TRUE(kind->live());
  EXPECT_FALSE(model.active());
}

TEST(ExtensionPort, TheDeadWindowOfAnActivationIsNoPull) {
  Talk talk = With(Child::kNone, true);
  talk.Advance(20);
  EXPECT_EQ(talk.device().activations(), 1);
  EXPECT_EQ(talk.handshake().port().changes(), 0u);
}

TEST(ExtensionPort, PlugsInMidStreamHardlyCostCoreData) {
  Talk talk = With(Child::kNone, false);
  talk.Advance(1);
  for (int i = 0; i < 3; ++i) {
    Say(talk, talk.device().SetChild(Child::kNunchuk));
    EXPECT_GE(CoreReports(talk, 15), 15 * 200 - 8);  // 200 steps a second; 40 ms.
    EXPECT_EQ(talk.handshake().extension(), Extension::kNunchuk);
    EXPECT_EQ(talk.handshake().extension_origin(), CalibrationOrigin::kDevice);
    Say(talk, talk.device().SetChild(Child::kNone));
    EXPECT_FALSE(talk.handshake().port().ready());  // Its bytes are rubbish from now on.
    EXPECT_GE(CoreReports(talk, 15), 15 * 200 - 8);
    EXPECT_EQ(talk.handshake().extension(), Extension::kNone);
    EXPECT_EQ(talk.device().controller().mode(), 0x31);
  }
  EXPECT_EQ(talk.handshake().port().changes(), 6u);
}

TEST(ExtensionPort, AChildThatComesOrGoesUnderAMotionPlusShowsInItsPackets) {
  Talk talk = With(Child::kNone, true);
  talk.Advance(12);
  Say(talk, talk.device().SetChild(Child::kNunchuk));
  EXPECT_GE(CoreReports(talk, 12), 12 * 200 - 40);
  EXPECT_EQ(talk.handshake().extension(), Extension::kMotionPlusNunchuk);
  EXPECT_EQ(talk.handshake().extension_origin(), CalibrationOrigin::kDevice);
  Say(talk, talk.device().SetChild(Child::kNone));
  talk.Advance(12);
  EXPECT_EQ(talk.handshake().extension(), Extension::kMotionPlus);
  EXPECT_EQ(talk.device().activations(), 3);
}

TEST(ExtensionPort, AMotionPlusPulledWhileActiveIsGoneAndFoundAgain) {
  Talk talk = With(Child::kNone, true);
  talk.Advance(12);
  Say(talk, talk.device().SetMotionPlus(false));
  EXPECT_GE(CoreReports(talk, 3), 3 * 200 - 40);
  EXPECT_EQ(talk.handshake().extension(), Extension::kNone);
  EXPECT_EQ(talk.device().controller().mode(), 0x31);
  // Plugged into an empty port it says nothing: it is looked for every ten seconds.
  Say(talk, talk.device().SetMotionPlus(true));
  talk.Advance(12);
  EXPECT_EQ(talk.handshake().extension(), Extension::kMotionPlus);
}

TEST(ExtensionPort, AnIdentityThatIsNotReadyIsAskedAgain) {
  for (const int reads : {1, 2, 5}) {  // The last: more than one look takes.
    PortModel model(Child::kNunchuk, false);
    model.not_ready = reads;
    Talk talk(std::move(model), "Nintendo RVL-CNT-01");
    talk.sample = [](PortModel& one) { return one.Sample(); };
    talk.Advance(4);
    EXPECT_EQ(talk.handshake().extension(), Extension::kNunchuk) << reads;
  }
}

TEST(ExtensionPort, ACloneThatLoopsAttachAndDetachIsAskedMoreAndMoreRarely) {
  Talk talk = With(Child::kNone, false);
  talk.Advance(1);
  for (int i = 0; i < 60; ++i) {  // A minute.
    Say(talk, talk.device().SetChild(i % 2 == 0 ? Child::kNunchuk : Child::kNone));
    talk.Advance(1);
  }
  const int reads = talk.Sent(0x17);
  EXPECT_GE(CoreReports(talk, 1), 180);
  EXPECT_LE(reads, 80);  // Some ten looks in a minute, not sixty.
}

TEST(ExtensionPort, AMotionPlusThatWillNotSwitchOnDoesNotStopTheRest) {
  PortModel model(Child::kNunchuk, true);
  model.activates = false;
  Talk talk(std::move(model), "Nintendo RVL-CNT-01");
  talk.sample = [](PortModel& one) { return one.Sample(); };
  talk.Advance(3);
  EXPECT_TRUE(talk.handshake().live());
  EXPECT_GE(CoreReports(talk, 60), 60 * 200 - 20);
  EXPECT_LE(talk.Sent(0x16), 150);
}

TEST(ExtensionPort, AClassicAndAnUnknownExtensionKeepTheCoreData) {
  for (const Child child : {Child::kClassic, Child::kUnknown}) {
    Talk talk = With(child, false);
    talk.Advance(1);
    EXPECT_TRUE(talk.handshake().live());
    EXPECT_EQ(talk.handshake().extension(),
              child == Child::kClassic ? Extension::kClassic : Extension::kUnknown);
    EXPECT_GE(CoreReports(talk, 5), 5 * 200 - 2);
  }
}

TEST(ExtensionPort, TheCameraIsSwitchedOnInTheFormatOfItsMode) {
  for (const Child child : {Child::kNone, Child::kNunchuk}) {
    Talk talk = With(child, false);
    talk.Advance(1);
    talk.kind().SetCamera(true);
    talk.Advance(1);
    const bool nunchuk = child == Child::kNunchuk;
    EXPECT_EQ(talk.device().controller().mode(), nunchuk ? 0x37 : 0x33);
    EXPECT_EQ(talk.device().camera_register(0x33), nunchuk ? 1 : 3);
    EXPECT_EQ(talk.device().camera_register(0x30), 0x08);
    EXPECT_EQ(talk.device().camera_register(0x1a), 0x63);
    talk.kind().SetCamera(false);
    talk.Advance(1);
    EXPECT_EQ(talk.device().controller().mode(), nunchuk ? 0x35 : 0x31);
  }
}

TEST(ExtensionPort, OnlyOneMemoryReadIsOutAtATime) {
  Talk talk = With(Child::kNunchuk, true);
  int missing = 0;
  talk.on_output = [&missing](reports::OutputReport& output) {
    if (output[0] == 0x17) {
      EXPECT_LE(missing, 0);
      missing = output[5] << 8 | output[6];
    }
    return true;
  };
  talk.on_input = [&missing](virtual_devices::Report& report) {
    if (report[0] == 0x21) missing = (report[3] & 0xf) != 0 ? 0 : missing - (report[3] >> 4) - 1;
    return true;
  };
  talk.Advance(30);
  EXPECT_EQ(talk.handshake().extension(), Extension::kMotionPlusNunchuk);
}

}  // namespace
}  // namespace footing::handshake
