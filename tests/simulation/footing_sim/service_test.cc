#include "daemon/simulation/footing_sim/service.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/common/temporary_folder.h"

namespace footing::footing_sim {
namespace {

using testing::HasSubstr;

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
