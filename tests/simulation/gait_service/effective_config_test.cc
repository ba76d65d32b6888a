#include "daemon/simulation/gait_service/config.h"

#include <gtest/gtest.h>

namespace footing::gait_service {
namespace {

using nlohmann::json;

TEST(EffectiveConfig, HasVersionSettingsGainsAndTheTableWithItsValues) {
  const auto texts = *engine_files::ReadTexts();
  serving::Config common;
  common.version = "9.8.7";
  Config config;
  config.fall_shown_s = 0.25;
  engine::EngineConfig engine;
  EffectiveConfig effective(common, config, texts, engine);
  const json shown = json::parse(effective.Message().json());
  EXPECT_EQ(shown["version"], "9.8.7");
  EXPECT_EQ(shown["settings"]["fall_shown_s"], 0.25);
  EXPECT_EQ(shown["settings"]["track"], "endless");
  for (const char* name : engine::kGainFiles) {
    EXPECT_EQ(shown["sha256"][name].get<std::string>().size(), 64u) << name;
  }
  for (const char* name : engine::kStyleFiles) {
    EXPECT_EQ(shown["sha256"][name].get<std::string>().size(), 64u) << name;
  }
  EXPECT_EQ(shown["sha256"][engine::kChoicesFile].get<std::string>().size(), 64u);
  EXPECT_EQ(shown["interface"]["name"], "wrist");
  EXPECT_EQ(shown["interface"]["table_by"], kBuiltInTable);
  EXPECT_EQ(shown["interface"]["table"], json::parse(texts.mapping));
}

TEST(EffectiveConfig, NamesThePapersGaitsForAReplay) {
  const auto texts = *engine_files::ReadTexts({.gaits = "paper"});
  ASSERT_EQ(texts.gains.back().origin, engine::kPaperGainFiles.back());
  EXPECT_TRUE(texts.style.empty());
  EXPECT_EQ(texts.choices.text, "");
  Config config;
  EXPECT_EQ(GaitsIn(EffectiveConfig({}, config, texts, {}).Message()), "best");
  config.gaits = "paper";
  const auto message = EffectiveConfig({}, config, texts, {}).Message();
  EXPECT_EQ(GaitsIn(message), "paper");
  for (const char* name : engine::kPaperGainFiles) {
    EXPECT_TRUE(json::parse(message.json())["sha256"].contains(name)) << name;
  }
  EXPECT_EQ(GaitsIn({}), "best");
  for (const char* torn : {R"({"settings":7})", R"({"settings":{"gaits":[]}})", "[1]", "{"}) {
    v1::EffectiveConfig config_of_a_file;
    config_of_a_file.set_json(torn);
    EXPECT_EQ(GaitsIn(config_of_a_file), "best") << torn;
  }
  config.gaits = "papers";
  EXPECT_NE(Check(config).error().message.find("best, plain, paper"), std::string::npos);
  EXPECT_FALSE(engine_files::ReadTexts({.gaits = "papers"}).ok());
}

TEST(EffectiveConfig, SaysThatThePictureRollsWhoeverChoseIt) {
  const auto texts = *engine_files::ReadTexts();
  EffectiveConfig effective({}, {}, texts, {});
  const auto rolls = [&](const mapping::InterfaceOptions& options, const std::string& table) {
    effective.SetInterface(1, options, table, "a client");
    return json::parse(effective.Message().json())["interface"]["camera_roll"];
  };
  mapping::InterfaceOptions leg{.interface = stream::UserInterface::kLeg};
  EXPECT_EQ(rolls(leg, "{}"), false);
  EXPECT_EQ(rolls(leg, R"({"camera_roll": true})"), true);
  leg.leg.camera_roll = true;
  EXPECT_EQ(rolls(leg, "{}"), true);
}

TEST(EffectiveConfig, ShowsAnotherInterfaceAndItsTable) {
  const auto texts = *engine_files::ReadTexts();
  EffectiveConfig effective({}, {}, texts, {});
  json table = json::parse(texts.mapping);
  table["turn_above_deg"] = 17.5;
  effective.SetInterface(
      3, {.interface = stream::UserInterface::kLeg, .leg = {.turn_by = stream::TurnSource::kTrunk}},
      table.dump(), "footing-ctl");
  const json shown = json::parse(effective.Message().json())["interface"];
  EXPECT_EQ(shown["name"], "leg");
  EXPECT_EQ(shown["turn_by"], "trunk");
  EXPECT_EQ(shown["number"], 3);
  EXPECT_EQ(shown["table_by"], "footing-ctl");
  EXPECT_EQ(shown["table"]["turn_above_deg"], 17.5);
  EXPECT_EQ(json::parse(TableIn(effective.Message(), 3)), table);
  EXPECT_EQ(TableIn(effective.Message(), 2), "");
  v1::EffectiveConfig torn;
  torn.set_json("{");
  EXPECT_EQ(TableIn(torn, 0), "");
}

}  // namespace
}  // namespace footing::gait_service
