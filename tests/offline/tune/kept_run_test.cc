#include "daemon/offline/tune/kept_run.h"

#include <gtest/gtest.h>

#include <cmath>

namespace footing::tune {
namespace {

const RunKey kKey{"walk", {0.5, 1.5}, 7, "cmaes", 24, 1, "gains"};

std::vector<double> Roughly(const std::vector<Eigen::VectorXd>& points) {
  std::vector<double> values;
  for (const auto& point : points) values.push_back(std::sin(point.sum()) + point.squaredNorm());
  return values;
}

std::vector<SearchState> Searched() {
  std::vector<SearchState> searches{StartSearch(3), StartSearch(3)};
  for (int i = 0; i < 4; ++i) {
    Evolve(
        searches[0], [](const auto& points, std::uint64_t) { return Roughly(points); }, 5);
  }
  return searches;
}

TEST(KeptRun, GoesOnBitForBit) {
  auto unbroken = Searched();
  auto resumed = ResumeRun(KeepRun(kKey, unbroken), kKey, "x");
  ASSERT_TRUE(resumed.ok()) << resumed.error().message;
  ASSERT_EQ(resumed->size(), 2u);
  const auto evaluate = [](const auto& points, std::uint64_t) { return Roughly(points); };
  for (int i = 0; i < 4; ++i) {
    Evolve(unbroken[0], evaluate, 5);
    Evolve((*resumed)[0], evaluate, 5);
  }
  EXPECT_EQ((*resumed)[0].point, unbroken[0].point);
  EXPECT_EQ((*resumed)[0].covariance, unbroken[0].covariance);
  EXPECT_EQ((*resumed)[0].step, unbroken[0].step);
  EXPECT_EQ((*resumed)[0].history.size(), 8u);
}

TEST(KeptRun, RefusesAnotherRunsStateAndSaysWhatDiffers) {
  RunKey other = kKey;
  other.seed = 8;
  const auto resumed = ResumeRun(KeepRun(kKey, Searched()), other, "walk.csv.state.json");
  ASSERT_FALSE(resumed.ok());
  EXPECT_EQ(resumed.error().message,
            "walk.csv.state.json is of a run with another seed; remove it to start again, or name "
            "another --out");
}

TEST(KeptRun, RefusesDamagedText) {
  const std::string whole = KeepRun(kKey, Searched());
  std::string short_point = whole;
  short_point.replace(short_point.find("\"step_path\""), 12, "\"step_path_\":");
  for (const std::string& text : {std::string(), std::string("[]"), whole.substr(0, 200),
                                  std::string("{\"key\": 3}"), short_point}) {
    const auto resumed = ResumeRun(text, kKey, "state");
    ASSERT_FALSE(resumed.ok()) << text;
    EXPECT_EQ(resumed.error().kind, ErrorKind::kInvalidData);
  }
}

}  // namespace
}  // namespace footing::tune
