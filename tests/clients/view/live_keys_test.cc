#include "clients/view/scene/model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/clients/view/made_person.h"
#include "tests/clients/view/made_stream.h"

namespace footing::scene {
namespace {

using ::testing::HasSubstr;

std::string KeysOf(const KeyContext& context) {
  std::string keys;
  for (const KeyLine& line : LiveKeyLines(context)) keys += " " + line.key + " ";
  return keys;
}

KeyContext Person() { return {Engine::kPerson, true, true, true}; }
KeyContext Biped() { return {Engine::kBiped, true, true, true}; }

TEST(LiveKeys, TheEngineIsKnownByWhatItSends) {
  EXPECT_EQ(EngineOf({}), Engine::kUnknown);
  EXPECT_EQ(EngineOf(made::ModelAfter(1, {})), Engine::kBiped);
  EXPECT_EQ(EngineOf(made::PersonModelAfter(1, {})), Engine::kPerson);
}

TEST(LiveKeys, OnlyTheKeysOfTheConnectedEngineAreListed) {
  for (const char* key : {" F ", " P ", " R "}) {
    EXPECT_THAT(KeysOf(Biped()), HasSubstr(key));
    EXPECT_EQ(KeysOf(Person()).find(key), std::string::npos) << key;
  }
  for (const char* key : {" T ", " N ", " O "}) {
    EXPECT_THAT(KeysOf(Person()), HasSubstr(key));
    EXPECT_EQ(KeysOf(Biped()).find(key), std::string::npos) << key;
  }
  EXPECT_EQ(KeysOf({}).find(" T "), std::string::npos);
  EXPECT_THAT(KeysOf({}), HasSubstr(" mouse "));
}

TEST(LiveKeys, AMarkerGoesToFootingdOrElseToFootingSimOnThisMachine) {
  EXPECT_THAT(KeysOf(Person()), HasSubstr(" E "));
  Model model;
  EXPECT_EQ(MarkedServer(model), "");
  const auto link = [](const std::string& address, const std::string& server, LinkState state) {
    LinkReport report;
    report.address = address;
    report.server_id = server;
    report.state = state;
    return report;
  };
  model.links = {link("unix:/a", "footing-sim", LinkState::kLive),
                 link("unix:/b", "footingd", LinkState::kConnecting)};
  EXPECT_EQ(MarkedServer(model), "footing-sim");
  model.links[1].state = LinkState::kLive;
  EXPECT_EQ(MarkedServer(model), "footingd");
  model.links = {link("tcp:192.168.1.5:7000", "footingd", LinkState::kLive)};
  EXPECT_EQ(MarkedServer(model), "");
}

TEST(LiveKeys, KeysThatNeedAFileAreListedWithIt) {
  EXPECT_THAT(KeysOf(Person()), HasSubstr(" C "));
  const std::string without = KeysOf({Engine::kPerson, false, false, true});
  EXPECT_EQ(without.find(" N "), std::string::npos);
  EXPECT_EQ(without.find(" C "), std::string::npos);
  EXPECT_THAT(without, HasSubstr(" T "));
}

TEST(LiveKeys, AKeyThatDoesNothingSaysWhyAndWhatToDo) {
  EXPECT_EQ(WhyNoKey('T', Person()), "");
  EXPECT_EQ(WhyNoKey('N', Person()), "");
  EXPECT_EQ(WhyNoKey('V', Biped()), "");
  EXPECT_EQ(WhyNoKey('F', {}), "");
  EXPECT_THAT(WhyNoKey('T', Biped()), HasSubstr("take the T-pose again"));
  EXPECT_THAT(WhyNoKey('T', Biped()), HasSubstr("--engine pose"));
  EXPECT_THAT(WhyNoKey('R', Person()), HasSubstr("--engine gait"));
  EXPECT_THAT(WhyNoKey('N', {Engine::kPerson, false, false, true}), HasSubstr("--next-subject"));
  EXPECT_THAT(WhyNoKey('T', {Engine::kPerson, true, false, false}),
              HasSubstr("the machine where footing-sim runs"));
}

TEST(LiveKeys, CommandsGoToASimulationServerOfThisMachineOnly) {
  Model model;
  model.links = {{"unix:/run/simulation.sock", "footing-sim", LinkState::kLive, ""}};
  EXPECT_TRUE(ContextOf(model, false, false).may_command);
  model.links[0].state = LinkState::kStale;
  EXPECT_FALSE(ContextOf(model, false, false).may_command);
  model.links[0] = {"tcp:127.0.0.1:7450", "footing-sim", LinkState::kLive, ""};
  EXPECT_FALSE(ContextOf(model, false, false).may_command);
}

}  // namespace
}  // namespace footing::scene
