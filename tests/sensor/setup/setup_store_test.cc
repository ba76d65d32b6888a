#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "daemon/sensor/setup/setup_store.h"
#include "daemon/sensor/setup/state_directory.h"

namespace footing::setup {
namespace {

TEST(SetupJson, ItemsReadBackAsTheyWereWritten) {
  stream::SetupItem item{"tare", "bb:02", true, 1'700'000'000'000'000'000, 0.5, "N", "cold", true};
  const auto read = ItemsFromJson(ToJson(Items{{"main", {item}}, {"other", {}}}));
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->at("main").size(), 1u);
  const stream::SetupItem& one = read->at("main")[0];
  EXPECT_EQ(one.name, item.name);
  EXPECT_EQ(one.serial, item.serial);
  EXPECT_TRUE(one.passed);
  EXPECT_EQ(one.wall_time_ns, item.wall_time_ns);
  EXPECT_EQ(one.residual, item.residual);
  EXPECT_EQ(one.unit, item.unit);
  EXPECT_EQ(one.note, item.note);
  EXPECT_TRUE(one.stale);
}

TEST(SetupJson, AResidualThatIsNotFiniteIsWrittenAsZero) {
  stream::SetupItem item;
  item.residual = std::numeric_limits<double>::infinity();
  const auto read = ItemsFromJson(ToJson(Items{{"main", {item}}}));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->at("main").at(0).residual, 0);
}

TEST(SetupJson, TextThatIsNotUtf8IsReplaced) {
  const auto read = RolesFromJson(ToJson(Roles{{"aa:\xff", "main/left_leg"}}));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->begin()->first, "aa:\xef\xbf\xbd");  // U+FFFD
}

TEST(SetupJson, AMountingThatIsNotARotationIsLeftOut) {
  const auto read = MountingsFromJson(
      R"({"aa:01": {"role": "main/left_leg", "w": 1, "x": 0, "y": 0, "z": 0.5,
                    "residual_rad": 0, "slipped": false},
          "bb:02": {"role": "main/right_leg", "w": 1, "x": 0, "y": 0, "z": 0.05,
                    "residual_rad": 0, "slipped": true}})");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), 1u);
  EXPECT_TRUE(read->at("bb:02").slipped);
  EXPECT_NEAR(read->at("bb:02").rotation_MS.norm(), 1, 1e-15);
}

TEST(SetupJson, AMissingKeyRefusesThePart) {
  EXPECT_FALSE(TaresFromJson(R"({"aa:01": {"top_left_n": 1}})"));
  EXPECT_FALSE(LayoutsFromJson("[1]"));
  EXPECT_FALSE(MovedBoardsFromJson(R"({"aa:01": "yes"})"));
  EXPECT_FALSE(RolesFromJson("{"));
}

TEST(SetupJson, CalibrationBytesAreWholeLowerCaseHex) {
  const auto read = CalibrationFromJson(ToJson(StoredCalibration{"aa:01", {0x10, 0x00, 0xff}}));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->serial, "aa:01");
  EXPECT_EQ(read->bytes, (std::vector<std::uint8_t>{0x10, 0x00, 0xff}));
  for (const char* hex : {"", "1", "1g", "FF"}) {
    const std::string text = R"({"serial": "aa:01", "hex": ")" + std::string(hex) + "\"}";
    EXPECT_FALSE(CalibrationFromJson(text)) << text;
  }
}

namespace fs = std::filesystem;

class SetupTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = fs::temp_directory_path() / "footing-setup-XXXXXX";
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  StateDirectory Directory() {
    return StateDirectory(folder_ / "state",
                          [this](const std::string& line) { said_.push_back(line); });
  }
  std::string Read(const fs::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  fs::path folder_;
  std::vector<std::string> said_;
};

TEST_F(SetupTest, EverythingSurvivesARestart) {
  auto directory = Directory();
  {
    SetupStore store(StorageIn(directory));
    store.SetRole("aa:01", "main/left_leg");
    store.SetTare("bb:02", StoredTare{{1, -2, 3, -4}, 0.5});
    StoredMounting mounting{"main/left_leg", Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), 0.02};
    store.SetMounting("aa:01", mounting);
    stream::BoardLayout layout;
    layout.rig = "main";
    layout.gap_mm = 40;
    layout.left = {0, 0.25, 0.1};
    layout.preset = "one_foot_each";
    store.SetLayout(layout);
    stream::SetupItem item;
    item.name = "tare";
    item.serial = "bb:02";
    item.passed = true;
    item.wall_time_ns = 1'700'000'000'000'000'000;
    item.residual = 0.5;
    item.unit = "N";
    store.Record("main", item);
    store.SetMoved("bb:02", true);
  }
  const SetupStore store(StorageIn(directory));
  EXPECT_EQ(store.roles().at("aa:01"), "main/left_leg");
  EXPECT_EQ(store.TareOf("bb:02")->offset, (board::CornerForces{1, -2, 3, -4}));
  EXPECT_NEAR(store.MountingOf("aa:01", "main/left_leg")->rotation_MS.y(), -0.5, 1e-12);
  EXPECT_FALSE(store.MountingOf("aa:01", "main/right_leg")) << "found for another role";
  ASSERT_EQ(store.Rigs().size(), 1u);
  EXPECT_EQ(store.Rigs()[0].layout.gap_mm, 40);
  EXPECT_EQ(store.Rigs()[0].items.at(0).wall_time_ns, 1'700'000'000'000'000'000);
  EXPECT_TRUE(store.Moved("bb:02"));
  EXPECT_TRUE(said_.empty());
}

TEST_F(SetupTest, ATruncatedFileIsNamedMovedAsideAndNotUsed) {
  auto directory = Directory();
  SetupStore(StorageIn(directory)).SetRole("aa:01", "main/left_leg");
  const fs::path file = folder_ / "state" / "roles.json";
  const auto whole = fs::file_size(file);
  for (const auto size : {std::uintmax_t{0}, whole / 2, whole - 3}) {
    SetupStore(StorageIn(directory)).SetRole("aa:01", "main/left_leg");
    fs::resize_file(file, size);
    said_.clear();
    const SetupStore store(StorageIn(directory));
    EXPECT_TRUE(store.roles().empty());
    ASSERT_EQ(said_.size(), 1u);
    EXPECT_NE(said_[0].find("roles"), std::string::npos) << said_[0];
    EXPECT_FALSE(fs::exists(file));
    EXPECT_TRUE(fs::exists(file.string() + ".damaged"));
  }
}

TEST_F(SetupTest, ACalibrationOfAnotherDeviceIsRefused) {
  auto directory = Directory();
  const CalibrationStore calibrations(StorageIn(directory));
  const std::vector<std::uint8_t> bytes = {0x10, 0x00, 0xff, 0x7a};
  calibrations.Save("00:11", bytes);
  EXPECT_EQ(calibrations.Load("00:11"), bytes);
  EXPECT_FALSE(calibrations.Load("00:22"));
  fs::copy_file(folder_ / "state/calibration-00-11.json", folder_ / "state/calibration-00-22.json");
  EXPECT_FALSE(calibrations.Load("00:22"));
  ASSERT_EQ(said_.size(), 1u);
  EXPECT_NE(said_[0].find("00:11"), std::string::npos) << said_[0];
  EXPECT_EQ(calibrations.Load("00:11"), bytes);
}

TEST_F(SetupTest, AChangedByteAndAnUnknownVersionAreRefused) {
  auto directory = Directory();
  const fs::path file = folder_ / "state" / "roles.json";
  for (const auto& [from, to] :
       {std::pair{"left_leg", "left_log"}, {"\"version\": 1", "\"version\": 9"}}) {
    SetupStore(StorageIn(directory)).SetRole("aa:01", "main/left_leg");
    std::string text = Read(file);
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos);
    std::ofstream(file) << text.replace(at, std::string(from).size(), to);
    said_.clear();
    EXPECT_TRUE(SetupStore(StorageIn(directory)).roles().empty());
    EXPECT_EQ(said_.size(), 1u);
  }
}

TEST_F(SetupTest, ContentOfAnotherFormIsRefusedAsAWhole) {
  auto directory = Directory();
  directory.Save("tares", R"({"aa:01": {"top_left_n": "much"}})");
  const SetupStore store(StorageIn(directory));
  EXPECT_FALSE(store.TareOf("aa:01"));
  EXPECT_EQ(said_.size(), 1u);
}

TEST_F(SetupTest, ADirectoryThatCannotBeWrittenIsSaidOnceAndMemoryGoesOn) {
  std::ofstream(folder_ / "state") << "a file is in the way";
  auto directory = Directory();
  SetupStore store(StorageIn(directory));
  store.SetRole("aa:01", "main/left_leg");
  store.SetRole("aa:02", "main/right_leg");
  EXPECT_EQ(said_.size(), 1u);
  EXPECT_EQ(store.roles().size(), 2u);
}

TEST_F(SetupTest, StaleItemsStayWithTheirReasonUntilTheyAreDoneAgain) {
  SetupStore store({});
  stream::SetupItem item;
  item.name = "layout";
  item.passed = true;
  store.Record("main", item);
  const auto before = store.revision();
  store.MarkStale("main", "layout", "", "the board was moved");
  EXPECT_GT(store.revision(), before);
  EXPECT_TRUE(store.Rigs()[0].items[0].stale);
  EXPECT_EQ(store.Rigs()[0].items[0].note, "the board was moved");
  store.Record("main", item);
  EXPECT_FALSE(store.Rigs()[0].items[0].stale);
  EXPECT_EQ(store.Rigs()[0].items.size(), 1u);
  store.Forget("main", "layout", "");
  EXPECT_TRUE(store.Rigs().empty());
}

TEST(StatePath, IsTheConfiguredOneFirst) { EXPECT_EQ(StatePath("/somewhere"), "/somewhere"); }

TEST_F(SetupTest, SerialsThatLookAlikeKeepAFileEach) {
  auto directory = Directory();
  const CalibrationStore store(StorageIn(directory));
  const std::vector<std::string> serials = {"00:07:aa", "00-07-aa",           "00_07_aa",
                                            "00/07/aa", std::string(64, ':'), std::string(64, '-')};
  for (std::size_t i = 0; i < serials.size(); ++i) {
    store.Save(serials[i], {static_cast<std::uint8_t>(i)});
  }
  for (std::size_t i = 0; i < serials.size(); ++i) {
    EXPECT_EQ(store.Load(serials[i]), (std::vector<std::uint8_t>{static_cast<std::uint8_t>(i)}))
        << serials[i];
  }
  EXPECT_TRUE(said_.empty()) << said_.front();
  EXPECT_TRUE(fs::exists(folder_ / "state/calibration-00-07-aa.json")) << "as it always was";
}

TEST_F(SetupTest, NotEndlesslyManyFilesAreMade) {
  auto directory = Directory();
  for (int i = 0; i < 320; ++i) directory.Save("calibration-" + std::to_string(i), "1");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "state"), {}), 300);
  ASSERT_EQ(said_.size(), 1u);
  EXPECT_NE(said_[0].find("300 files"), std::string::npos) << said_[0];
  directory.Save("calibration-7", "2");
  EXPECT_EQ(directory.Load("calibration-7"), "2") << "one that is there is replaced";
}

}  // namespace
}  // namespace footing::setup
