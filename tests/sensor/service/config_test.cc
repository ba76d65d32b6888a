#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "common/cli/cli.h"
#include "common/cli/server.h"
#include "daemon/sensor/service/config.h"
#include "footing/v1/session.pb.h"
#include "tests/common/temporary_folder.h"
#include "tests/sensor/service/fixture.h"

namespace footing::sensor {
namespace {

using testing::HasSubstr;

struct Parsed {
  std::optional<Config> config;
  int exit_code = 0;
  std::string errors;
};

Parsed Parse(std::vector<std::string> words) {
  words.insert(words.begin(), "footingd");
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  Parsed parsed;
  testing::internal::CaptureStderr();
  cli::ServerLine line;
  const auto code =
      cli::ParseServerLine(Program(), static_cast<int>(arguments.size()), arguments.data(), line);
  parsed.exit_code = code.value_or(0);
  if (!code) {
    const auto config = ReadConfig(line);
    if (config) parsed.config = *config;
    if (!config) parsed.exit_code = cli::Report(config.error());
  }
  parsed.errors = testing::internal::GetCapturedStderr();
  return parsed;
}

TEST(CommandLine, CheckConfigReadsTheFilesAndEndsAsTheStartWould) {
  const test::TemporaryFolder folder;
  const std::string none = folder.Path("none");
  EXPECT_EQ(Parse({"--check-config"}).exit_code, 0);
  for (const std::string key : {"token_file", "clients_file"}) {
    const Parsed parsed = Parse({"--check-config", "--set", key + "=" + none});
    EXPECT_EQ(parsed.exit_code, 1);
    EXPECT_THAT(parsed.errors, HasSubstr(none));
  }
  const Parsed metrics = Parse({"--check-config", "--metrics", "tcp:0.0.0.0:9100"});
  EXPECT_EQ(metrics.exit_code, 2);
  EXPECT_THAT(metrics.errors, HasSubstr("they stay on this host"));
}

TEST(CommandLine, DevicesOfOtherHostsComeByTheRulesOfClients) {
  const test::TemporaryFolder folder;
  const std::string token = folder.Path("token");
  std::ofstream(token) << "0123456789abcdef";
  ASSERT_EQ(chmod(token.c_str(), 0600), 0);
  const auto check = [](std::vector<std::string> words) {
    words.insert(words.begin(), "--check-config");
    return Parse(std::move(words));
  };
  const std::string tls = "stream:tls:0.0.0.0:7432", tcp = "stream:tcp:192.168.1.5:7432";
  const Parsed keyless = check({"--source", tls});
  EXPECT_EQ(keyless.exit_code, 2);
  EXPECT_THAT(keyless.errors, HasSubstr("will not listen on tls:0.0.0.0:7432: anyone who"));
  EXPECT_EQ(check({"--source", tls, "--set", "token_file=" + token}).exit_code, 0);
  EXPECT_THAT(check({"--source", tcp, "--set", "token_file=" + token}).errors,
              HasSubstr("must be encrypted; use tls:HOST:PORT"));
  EXPECT_EQ(check({"--source", tcp, "--insecure-lan", "--set", "token_file=" + token}).exit_code,
            0);
  EXPECT_THAT(check({"--source", "stream:tcp:127.0.0.1:7432"}).errors,
              HasSubstr("every user of this host may attach devices"));
}

TEST(Config, AddressOfASourceByTlsIsOneOfThoseOfClientsOnce) {
  Config config;
  config.listen = {"unix:/tmp/a", "tls:127.0.0.1:1"};
  config.sources = {"hid", "stream:unix:/tmp/b", "stream:tls:127.0.0.1:1", "stream:tls:[::1]:2"};
  EXPECT_THAT(SessionAddresses(config),
              testing::ElementsAre("unix:/tmp/a", "tls:127.0.0.1:1", "tls:[::1]:2"));
  const auto capabilities = MakeServerOptions(config, "1", {}).capabilities;
  EXPECT_THAT(capabilities, testing::Contains("devices"));
  config.sources = {"hid", "stream:unix:/tmp/b"};
  EXPECT_EQ(SessionAddresses(config), config.listen);
  EXPECT_THAT(MakeServerOptions(config, "1", {}).capabilities,
              testing::Not(testing::Contains("devices")));
}

TEST(CommandLine, OriginNeedsPrintConfig) {
  const Parsed parsed = Parse({"--origin"});
  EXPECT_FALSE(parsed.config);
  EXPECT_EQ(parsed.exit_code, 2);
  EXPECT_THAT(parsed.errors, HasSubstr("--print-config"));
  EXPECT_TRUE(Parse({}).config);
}

TEST(CommandLine, AWrongRoleOrRigIsNamed) {
  EXPECT_THAT(
      Parse({"--set", R"(roles={"x": "main/nose"})"}).errors,
      HasSubstr("config: roles in --set: 'x': role 'nose' does not exist; there are left_"));
  EXPECT_THAT(Parse({"--set", "roles={\"x\": \"" + std::string(65, 'r') + "/head\"}"}).errors,
              HasSubstr("must be 1 to 64 bytes"));
  EXPECT_THAT(Parse({"--set", "default_rig=" + std::string(65, 'r')}).errors,
              HasSubstr("default_rig: the rig's name"));
}

TEST(CommandLine, AnOptionOfItsOwnGoesBeforeTheFileAndSet) {
  const test::TemporaryFolder folder;
  const std::string file = folder.Path("footingd.json");
  std::ofstream(file) << R"({"listen": ["unix:/tmp/file"], "metrics": "unix:/tmp/file"})";
  const auto config = Parse({"--listen", "unix:/tmp/a", "--listen", "unix:/tmp/b", "--metrics",
                             "unix:/tmp/own", "--insecure-lan", "--config", file, "--set",
                             "metrics=unix:/tmp/set", "--set", "token_file=" + file})
                          .config;
  ASSERT_TRUE(config);
  EXPECT_EQ(config->listen, (std::vector<std::string>{"unix:/tmp/a", "unix:/tmp/b"}));
  EXPECT_EQ(config->metrics, "unix:/tmp/own");
  EXPECT_TRUE(config->access.insecure_lan);
  EXPECT_THAT(Parse({"--listen", "unix:/tmp/\xff"}).errors, HasSubstr("not text in UTF-8"));
}

TEST(CommandLine, FeaturesAreBestOrPaper) {
  EXPECT_EQ(Parse({}).config->features, "best");
  EXPECT_EQ(Parse({"--features", "paper"}).config->features, "paper");
  EXPECT_EQ(Parse({"--set", "features=paper"}).config->features, "paper");
  const Parsed unknown = Parse({"--features", "papers"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.errors, HasSubstr("unknown --features papers; there are: best, paper"));
}

TEST(CommandLine, ReadAgainAnErrorIsReturnedAndNothingIsPrinted) {
  const test::TemporaryFolder folder;
  cli::ServerLine line;
  line.file = folder.Path("footingd.json");
  std::ofstream(line.file) << R"({"stale_after_s": 2})";
  EXPECT_EQ(ReadConfig(line)->stale_after_s, 2);
  std::ofstream(line.file) << R"({"stale_afer_s": 3})";
  testing::internal::CaptureStderr();
  const auto again = ReadConfig(line);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  ASSERT_FALSE(again);
  EXPECT_THAT(again.error().message, HasSubstr("unknown key \"stale_afer_s\""));
}

stream::HandFrame Fist(double x_m) {
  stream::HandFrame frame;
  frame.points = {{stream::DeviceRole::kLeftHand, {x_m, 0.3, 1.2}, {0.01, 0.01, 0.01}, 1}};
  frame.age_ns = 4'000'000;
  return frame;
}

stream::ReferenceFrame Joint() { return {"", 2'000'000, {-1}, {{0, 0, 1}}, {0, 0, 1}}; }

TEST(HubHands, EverySampleSinceTheLastTickIsPublishedOnce) {
  Bench bench;
  for (int i = 0; i < 5; ++i) bench.hub().trackers().OnHands(1'000'000'000 + i, Fist(0.1 * i));
  bench.hub().trackers().OnReference(1'000'000'000, Joint());
  bench.Advance(0.05);
  ASSERT_EQ(bench.content.hands.size(), 5u);
  EXPECT_EQ(bench.content.hands[3].position_m.x(), 0.1 * 3);
  EXPECT_EQ(bench.content.hands[3].received_ns, 1'000'000'003);
  EXPECT_EQ(bench.content.hands[3].sampled_ns, 996'000'003);
  EXPECT_EQ(bench.content.hands[3].rig, "main");
  ASSERT_EQ(bench.content.reference.size(), 1u);
  EXPECT_EQ(bench.content.reference[0].rig, "main");
  EXPECT_EQ(bench.content.reference[0].sampled_ns, 998'000'000);
}

TEST(HubHands, FramesThatAreReadTogetherHaveTheTimesAtWhichTheyWereExposed) {
  constexpr std::int64_t kMs = 1'000'000;
  const std::int64_t ages_ns[] = {0, 2 * kMs, 100'000, kMs};  // How late each was sent.
  for (const bool stated : {true, false}) {
    Bench bench;
    const auto send = [&](int i, std::int64_t received_ns) {
      stream::HandFrame frame = Fist(0.1);
      frame.tracker = "eye";
      frame.age_ns = ages_ns[i % 4];
      if (stated) frame.sent_ns = i * 16 * kMs + frame.age_ns;
      bench.hub().trackers().OnHands(received_ns, frame);
    };
    std::vector<std::int64_t> sampled_ns;
    const auto publish = [&] {
      bench.Advance(0.01);
      for (const auto& sample : bench.content.hands) sampled_ns.push_back(sample.sampled_ns);
      bench.content.hands.clear();
    };
    for (int i = 1; i < 10; ++i) send(i, i * 16 * kMs + ages_ns[i % 4]);
    publish();
    for (int i = 10; i < 14; ++i) send(i, (13 * 16 + 4) * kMs);  // footingd was busy.
    publish();
    send(14, (14 * 16 + 3) * kMs);
    publish();
    ASSERT_EQ(sampled_ns.size(), 14u);
    for (std::size_t k = 0; k < sampled_ns.size(); ++k) {
      const auto exposed_ms = static_cast<double>(16 * (k + 1));
      EXPECT_NEAR(1e-6 * static_cast<double>(sampled_ns[k]), exposed_ms, stated ? 0 : 8) << k;
      if (k == 0) continue;
      EXPECT_GT(sampled_ns[k], sampled_ns[k - 1]) << stated << " " << k;
    }
  }
}

TEST(HubHands, ABadFrameIsCountedSaidOnceAndLosesNothingElse) {
  Bench bench;
  const auto before = bench.log.size();
  for (int i = 0; i < 100; ++i) {
    bench.hub().trackers().OnHands(0, Fist(std::numeric_limits<double>::quiet_NaN()));
    bench.hub().trackers().OnHands(0, Fist(0.5));
    auto pose = Joint();
    pose.com_m.x() = std::numeric_limits<double>::infinity();
    bench.hub().trackers().OnReference(0, pose);
    bench.hub().trackers().OnReference(0, Joint());
    bench.Advance(0.01);
  }
  EXPECT_EQ(bench.hub().trackers().refused_frames(), 200u);
  EXPECT_EQ(bench.content.hands.size(), 100u);
  EXPECT_EQ(bench.content.reference.size(), 100u);
  ASSERT_EQ(bench.log.size(), before + 2);
  EXPECT_THAT(bench.log[before], HasSubstr("a hand frame is refused: point 1"));
  EXPECT_THAT(bench.log[before + 1], HasSubstr("a reference frame is refused"));
  bench.Advance(10);
  ASSERT_EQ(bench.log.size(), before + 4) << "the rest is counted when it is over, too";
  EXPECT_THAT(bench.log[before + 2], HasSubstr("(99 refused"));
  EXPECT_THAT(bench.log[before + 3], HasSubstr("(99 refused"));
}

TEST(HubHands, AFloodIsBoundedInEachTick) {
  Bench bench;
  for (std::size_t i = 0; i < 2 * kMaxSamplesPerTick; ++i)
    bench.hub().trackers().OnHands(0, Fist(0));
  for (std::size_t i = 0; i < 2 * kMaxReferencesPerTick; ++i)
    bench.hub().trackers().OnReference(0, Joint());
  bench.Advance(0.02);
  EXPECT_EQ(bench.content.hands.size(), kMaxSamplesPerTick);
  EXPECT_EQ(bench.content.reference.size(), kMaxReferencesPerTick);
}

stream::ContactFrame Insole(double load_n) {
  stream::ContactFrame frame;
  frame.source = "left";
  frame.age_ns = 3'000'000;
  frame.body = stream::ContactBody::kLeftFoot;
  frame.cells = {{{0.1, 0.02, 0}, load_n}};
  return frame;
}

TEST(HubHands, InsolesArePublishedWithTheirTimesAndBadOrTooManyFramesAreNot) {
  Bench bench;
  bench.hub().trackers().OnContacts(1'000'000'000, Insole(300));
  bench.hub().trackers().OnContacts(1'000'000'000,
                                    Insole(std::numeric_limits<double>::quiet_NaN()));
  bench.Advance(0.02);
  ASSERT_EQ(bench.content.contacts.size(), 1u);
  EXPECT_EQ(bench.content.contacts[0].rig, "main");
  EXPECT_EQ(bench.content.contacts[0].source, "left");
  EXPECT_EQ(bench.content.contacts[0].received_ns, 1'000'000'000);
  EXPECT_EQ(bench.content.contacts[0].sampled_ns, 997'000'000);
  EXPECT_EQ(bench.content.contacts[0].cells[0].load_n, 300);
  EXPECT_EQ(bench.hub().trackers().refused_frames(), 1u);
  bench.content.contacts.clear();
  for (std::size_t i = 0; i < 2 * kMaxContactsPerTick; ++i)
    bench.hub().trackers().OnContacts(0, Insole(1));
  bench.Advance(0.02);
  EXPECT_EQ(bench.content.contacts.size(), kMaxContactsPerTick);
  std::vector<std::string> names;
  for (const auto& channel : Channels()) names.push_back(channel.name);
  EXPECT_THAT(names, testing::Contains("contacts"));
  for (const auto& channel : ToChannels(bench.content)) {
    if (channel.field != v1::Tick::kContactsFieldNumber) continue;
    v1::ContactSamples list;
    ASSERT_TRUE(list.ParseFromString(channel.bytes));
    EXPECT_EQ(list.samples_size(), static_cast<int>(kMaxContactsPerTick));
    return;
  }
  FAIL() << "no channel carries them";
}

TEST(HubHands, ChannelsCarryThemInTheTicksFields) {
  TickContent content;
  content.hands.emplace_back().position_m.z() = 1.5;
  content.reference.emplace_back().parents = {-1};
  std::string bytes;
  v1::Tick tick;
  for (const auto& channel : ToChannels(content)) {
    if (channel.field == v1::Tick::kHandsFieldNumber)
      tick.mutable_hands()->ParseFromString(channel.bytes);
    if (channel.field == v1::Tick::kReferenceFieldNumber)
      tick.mutable_reference()->ParseFromString(channel.bytes);
  }
  ASSERT_EQ(tick.hands().samples_size(), 1);
  EXPECT_EQ(tick.hands().samples(0).position_m().z(), 1.5);
  ASSERT_EQ(tick.reference().poses_size(), 1);
  std::vector<std::string> names;
  for (const auto& channel : Channels()) names.push_back(channel.name);
  EXPECT_THAT(names, testing::IsSupersetOf({"hands", "reference"}));
}

using ::testing::ElementsAre;

TEST(Reload, TakesWhatNeedsNoRestartAndSaysWhatDoes) {
  Config before, wanted;
  wanted.stale_after_s = 2;
  wanted.sessions.max_sessions = 9;
  wanted.default_rig = "left";
  wanted.tick_rate_hz = 50;
  wanted.roles = {{"00:1f", "main/left_hand"}};
  std::vector<std::string> lines;
  const Config next =
      Reloaded(before, wanted, {}, [&](const std::string& line) { lines.push_back(line); });
  EXPECT_EQ(next.stale_after_s, 2);
  EXPECT_EQ(next.sessions.max_sessions, 9);
  EXPECT_EQ(next.default_rig, "left");
  EXPECT_EQ(next.tick_rate_hz, 100);
  EXPECT_TRUE(next.roles.empty());
  EXPECT_THAT(lines,
              ElementsAre("config reloaded: default_rig \"main\" -> \"left\", stale_after_s 0.5 -> "
                          "2.0, max_sessions 256 -> 9",
                          "config: takes effect after a restart: roles {} -> "
                          "{\"00:1f\":\"main/left_hand\"}, tick_rate_hz 100.0 -> 50.0"));
}

TEST(Reload, SaysWhichFilesHaveAnotherContent) {
  Config wanted;
  wanted.access.clients_file = "/etc/footing/clients";
  std::vector<std::string> lines;
  const Config next = Reloaded({}, wanted, {"token_file", "clients_file"},
                               [&](const std::string& line) { lines.push_back(line); });
  EXPECT_EQ(next.access.clients_file, "/etc/footing/clients");
  EXPECT_THAT(lines, ElementsAre("config reloaded: clients_file \"\" -> \"/etc/footing/clients\", "
                                 "contents of token_file, contents of clients_file"));
}

TEST(Reload, HoldsForADeviceThatIsThere) {
  Bench bench;
  bench.Attach(virtual_devices::Wiimote(1), "a");
  bench.Advance(0.5);
  bench.silent = true;
  bench.Advance(0.8);
  EXPECT_EQ(bench.StatusOf("a").state, stream::DeviceState::kStale) << "after 0.5 s";
  Config wanted;
  wanted.stale_after_s = 2;
  bench.hub().Reload(Reloaded({}, wanted, {}, [](const std::string&) {}));
  bench.Advance(0.1);
  EXPECT_EQ(bench.StatusOf("a").state, stream::DeviceState::kLive);
  bench.Advance(1.5);
  EXPECT_EQ(bench.StatusOf("a").state, stream::DeviceState::kStale) << "after 2 s";
}

TEST(Reload, SaysWhenNothingHasChanged) {
  std::vector<std::string> lines;
  Reloaded({}, {}, {}, [&](const std::string& line) { lines.push_back(line); });
  EXPECT_THAT(lines, ElementsAre("config reloaded: nothing has changed"));
}

}  // namespace
}  // namespace footing::sensor
