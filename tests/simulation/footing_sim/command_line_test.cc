#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/simulation/footing_sim/command_line.h"
#include "tests/common/temporary_folder.h"

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

TEST(FootingSimExport, WritesAModelOnceAndLeavesOtherCommandLinesAlone) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("hills.xml");
  const auto run = [](std::vector<std::string> words) {
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    return RunExport(static_cast<int>(argv.size()), argv.data());
  };
  EXPECT_EQ(run({"footing-sim", "--track", "hills"}), std::nullopt);
  EXPECT_EQ(run({"footing-sim", "export", "mjcf", "--track", "hills", "--out", path}), 0);
  std::ifstream file(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_THAT(text, HasSubstr("<motor name='left_hip_yaw'"));
  EXPECT_THAT(text, HasSubstr("<key name='start'"));
  EXPECT_EQ(run({"footing-sim", "export", "mjcf", "--out", path}), 2);
  EXPECT_EQ(run({"footing-sim", "export", "mjcf", "--track", "nowhere"}), 2);
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

using ::testing::ElementsAre;

TEST(Reload, TakesTheLimitsOfSessionsAndSaysWhatNeedsARestart) {
  Config before, wanted;
  wanted.serving.sessions.max_log_sessions = 9;
  wanted.engine = "pose";
  std::vector<std::string> lines;
  const Config next =
      Reloaded(before, wanted, {}, [&](const std::string& line) { lines.push_back(line); });
  EXPECT_EQ(next.serving.sessions.max_log_sessions, 9);
  EXPECT_EQ(next.engine, "gait");
  EXPECT_THAT(lines, ElementsAre("config reloaded: max_log_sessions 64 -> 9",
                                 "config: takes effect after a restart: engine \"gait\" -> "
                                 "\"pose\""));
}

std::string Why(const Config& config) {
  const auto checked = CheckService(config);
  return checked ? "" : checked.error().message;
}

TEST(FootingSimService, ItsFilesAreCheckedAsAtTheStart) {
  const test::TemporaryFolder folder;
  const std::string file = folder.Path("file.json");
  std::ofstream(file) << "{}";
  const auto with = [&](auto change) {
    Config config;
    change(config);
    return Why(config);
  };
  EXPECT_EQ(with([](Config&) {}), "");
  EXPECT_THAT(with([](Config& c) { c.gait.track = "none"; }), HasSubstr("tracks/none.json"));
  EXPECT_THAT(with([&](Config& c) { c.gait.track = file; }), HasSubstr(file));
  EXPECT_THAT(with([&](Config& c) { c.gait.mapping_table = file; }), HasSubstr(file));
  EXPECT_THAT(with([&](Config& c) { c.serving.data_folder = folder.Path("none"); }),
              HasSubstr(folder.Path("none")));
  EXPECT_THAT(with([&](Config& c) { c.serving.access.token_file = folder.Path("none"); }),
              HasSubstr("token file"));
  EXPECT_THAT(with([](Config& c) { c.serving.listen = {"nonsense"}; }), HasSubstr("nonsense"));
}

TEST(FootingSimService, TheSubjectIsCheckedForThePoseEngine) {
  const test::TemporaryFolder folder;
  Config config;
  config.pose.subject = folder.Path("none.json");
  EXPECT_EQ(Why(config), "") << "the gait engine has none";
  config.engine = "pose";
  EXPECT_THAT(Why(config), HasSubstr(config.pose.subject));
}

}  // namespace
}  // namespace footing::footing_sim
