#include "daemon/simulation/footing_sim/config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace footing::footing_sim {
namespace {

using testing::HasSubstr;

TEST(FootingSimConfig, SettingsOfTheOtherEngineAreRefusedNotIgnored) {
  Config config;
  config.engine = "gait";
  const auto subject = CheckApply(config, {"sensor=unix:/tmp/a", "subject=p07.json"});
  ASSERT_FALSE(subject);
  EXPECT_EQ(subject.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(subject.error().message, HasSubstr("subject does not apply to --engine gait"));
  EXPECT_THAT(subject.error().message, HasSubstr("--engine pose"));
  for (const char* setting : {"mode=paper", "lag_ms=100"}) {
    EXPECT_FALSE(CheckApply(config, {setting})) << setting;
  }
  config.engine = "pose";
  EXPECT_TRUE(CheckApply(config, {"subject=p07.json", "mode=paper", "lag_ms=100", "rig=one"}));
  for (const char* setting : {"interface=wrist", "turn_by=feet", "track=1", "frame_rate_hz=50",
                              "fall_shown_s=1", "features_timeout_s=1", "put_back_distance_m=2"}) {
    EXPECT_FALSE(CheckApply(config, {setting})) << setting;
  }
}

TEST(FootingSimConfig, AFileMayHoldTheSettingsOfBothEngines) {
  Config config;
  config::Binder binder;
  config.Bind(binder);
  ASSERT_TRUE(binder.ApplyText(R"({"engine": "pose", "track": "2", "lag_ms": 200})", "sim.json"));
  EXPECT_EQ(config.gait.track, "2");
  EXPECT_EQ(config.pose.lag_ms, 200);
  EXPECT_TRUE(Check(config));
}

TEST(FootingSimConfig, AnAddressThatIsNoneIsRefusedBeforeAnythingListens) {
  Config config;
  EXPECT_TRUE(Check(config));
  config.serving.sensor = "nonsense";
  const auto checked = Check(config);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(checked.error().message, HasSubstr("--sensor: \"nonsense\" is not an address"));
}

TEST(FootingSimConfig, MetricsStayOnThisHost) {
  Config config;
  config.serving.metrics = "unix:/tmp/metrics.sock";
  EXPECT_TRUE(Check(config));
  config.serving.metrics = "tcp:127.0.0.1:9100";
  EXPECT_TRUE(Check(config));
  config.serving.metrics = "tcp:0.0.0.0:9100";
  ASSERT_FALSE(Check(config));
  EXPECT_THAT(Check(config).error().message, HasSubstr("they stay on this host"));
}

TEST(FootingSimConfig, EveryInterfaceIsKnownAndCarriesItsOptions) {
  for (const auto interface : stream::kUserInterfaces) {
    Config config;
    config.gait.interface = stream::Name(interface);
    config.gait.turn_by = "trunk";
    EXPECT_TRUE(Check(config)) << config.gait.interface;
    EXPECT_EQ(gait_service::OptionsOf(config.gait).interface, interface);
    EXPECT_EQ(gait_service::OptionsOf(config.gait).leg.turn_by, stream::TurnSource::kTrunk);
  }
}

TEST(FootingSimConfig, UnknownValuesListWhatThereIs) {
  const auto message = [](auto change) {
    Config config;
    change(config);
    const auto checked = Check(config);
    return checked ? std::string() : checked.error().message;
  };
  EXPECT_THAT(message([](Config& c) { c.engine = "walkies"; }), HasSubstr("gait, pose"));
  EXPECT_THAT(message([](Config& c) { c.gait.interface = "telepathy"; }),
              HasSubstr("wrist, arm, leg, joystick, boards"));
  EXPECT_THAT(message([](Config& c) { c.gait.turn_by = "tail"; }), HasSubstr("head, feet, trunk"));
  EXPECT_THAT(message([](Config& c) { c.pose.mode = "fast"; }), HasSubstr("best, paper"));
  EXPECT_THAT(message([](Config& c) { c.pose.lag_ms = 50; }), HasSubstr("0, 100, 200"));
}

}  // namespace
}  // namespace footing::footing_sim
