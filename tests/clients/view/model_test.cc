#include "clients/view/scene/model.h"

#include <gtest/gtest.h>

#include "clients/view/scene/stage.h"
#include "clients/view/scene/text.h"
#include "common/base/units.h"
#include "tests/clients/view/made_stream.h"

namespace footing::scene {
namespace {

TEST(Model, AgeIsTheTimeSinceTheNewestStamp) {
  const Model model = made::ModelAfter(1, {});
  // The made stream arrives 1 ms after its stamp.
  EXPECT_NEAR(AgeMs(model, made::ClockAt(1)), 1, 1e-9);
  EXPECT_NEAR(AgeMs(model, made::ClockAt(1.06)), 61, 1e-6);
}

TEST(Model, IsSimulatedWhenACharacterOrADeviceIs) {
  EXPECT_TRUE(IsSimulated(made::ModelAfter(0.1, {})));
  made::Wish real;
  real.simulated = false;
  EXPECT_FALSE(IsSimulated(made::ModelAfter(0.1, real)));
  EXPECT_FALSE(IsSimulated({}));
}

TEST(Model, AStatusListReplacesItsOwnServersDevicesOnly) {
  Model model;
  Update first;
  first.source = 0;
  first.devices.emplace(2);
  Update second;
  second.source = 1;
  second.devices.emplace(1);
  Apply(model, first);
  Apply(model, second);
  EXPECT_EQ(model.devices.size(), 3u);
  first.devices->clear();
  Apply(model, first);
  EXPECT_EQ(model.devices.size(), 1u);
  EXPECT_EQ(model.devices[0].source, 1);
}

stream::DeviceStatus StatusOf(std::uint32_t device, stream::DeviceRole role,
                              stream::DeviceState state = stream::DeviceState::kLive) {
  stream::DeviceStatus status;
  status.device = device;
  status.rig = "main";
  status.role = role;
  status.state = state;
  return status;
}

Update SampleOf(std::uint32_t device) {
  Update update;
  stream::MotionSample sample;
  sample.device = device;
  update.motion.push_back(sample);
  stream::BoardSample board;
  board.device = device;
  update.boards.push_back(board);
  return update;
}

TEST(Model, AHandHasOneStripAfterItsDeviceOrItsServerWasStartedAgain) {
  using stream::DeviceRole;
  Model model;
  Update status;
  status.devices = {StatusOf(1, DeviceRole::kLeftHand), StatusOf(2, DeviceRole::kRightHand)};
  Apply(model, status);
  for (const std::uint32_t device : {1u, 2u}) Apply(model, SampleOf(device));
  Update other = SampleOf(1);  // From another server.
  other.source = 1;
  Apply(model, other);
  EXPECT_EQ(model.strips.devices.size(), 3u);
  // The left hand's device came back as number 3.
  status.devices = {StatusOf(1, DeviceRole::kLeftHand, stream::DeviceState::kLost),
                    StatusOf(2, DeviceRole::kRightHand), StatusOf(3, DeviceRole::kLeftHand)};
  Apply(model, status);
  Apply(model, SampleOf(3));
  const auto keys = [](const auto& map) {
    std::vector<std::pair<int, std::uint32_t>> all;
    for (const auto& [key, value] : map) all.push_back(key);
    return all;
  };
  using Keys = std::vector<std::pair<int, std::uint32_t>>;
  EXPECT_EQ(keys(model.strips.devices), (Keys{{0, 2}, {0, 3}, {1, 1}}));
  EXPECT_EQ(keys(model.boards), (Keys{{0, 2}, {0, 3}, {1, 1}}));
  // A device that is only lost keeps its strip: it may come back.
  status.devices->at(1).state = stream::DeviceState::kLost;
  Apply(model, status);
  EXPECT_EQ(model.strips.devices.size(), 3u);
  // footingd was started again, and counts from the beginning.
  status.devices = {StatusOf(1, DeviceRole::kRightHand)};
  Apply(model, status);
  EXPECT_EQ(keys(model.strips.devices), (Keys{{1, 1}}));
}

TEST(Model, NothingIsKnownOfADeviceWhoseServerIsNotThere) {
  Model model = made::ModelAfter(1, {});
  ASSERT_FALSE(model.devices.empty());
  EXPECT_TRUE(IsCurrent(model, model.devices[0]));  // A recording.
  model.links = {{"unix:/s", "footingd", LinkState::kLive, ""}};
  EXPECT_TRUE(IsCurrent(model, model.devices[0]));
  for (const LinkState state : {LinkState::kConnecting, LinkState::kStale}) {
    model.links[0].state = state;
    EXPECT_FALSE(IsCurrent(model, model.devices[0]));
    for (const std::string& line : StatusScreen(model, made::ClockAt(8))) {
      EXPECT_EQ(line.find(" live "), std::string::npos) << line;
    }
  }
}

TEST(Model, ThePhaseStripFollowsTheGaitController) {
  const Model model = made::ModelAfter(6, {});
  EXPECT_EQ(model.phases, (std::vector<std::string>{"COMP", "EXT", "UP", "DOWN"}));
  EXPECT_GT(model.phase_spans.size(), 40u);  // 1.3 Hz, eight states a cycle, 6 s: 62.
}

Update BoardTick(std::uint32_t device, double left_n, double right_n) {
  Update update;
  update.host_ns = 1;
  stream::BoardSample sample;
  sample.device = device;
  sample.top_left_n = sample.bottom_left_n = left_n / 2;
  sample.top_right_n = sample.bottom_right_n = right_n / 2;
  sample.total_n = left_n + right_n;
  update.boards.push_back(sample);
  return update;
}

TEST(Stance, OneBoardIsSplitByItsCells) {
  Model model;
  Apply(model, BoardTick(1, 300, 100));
  const Stance stance = StanceOf(model);
  EXPECT_TRUE(stance.valid);
  EXPECT_DOUBLE_EQ(stance.total_n, 400);
  EXPECT_DOUBLE_EQ(stance.left_share, 0.75);
}

TEST(Stance, TwoBoardsAreOneFootEach) {
  Model model;
  Update status;
  status.devices.emplace(2);
  (*status.devices)[0].device = 1;
  (*status.devices)[0].role = stream::DeviceRole::kLeftBoard;
  (*status.devices)[1].device = 2;
  (*status.devices)[1].role = stream::DeviceRole::kRightBoard;
  Apply(model, status);
  Apply(model, BoardTick(1, 100, 140));
  Apply(model, BoardTick(2, 260, 100));
  const Stance stance = StanceOf(model);
  EXPECT_DOUBLE_EQ(stance.total_n, 600);
  EXPECT_DOUBLE_EQ(stance.left_share, 240.0 / 600);
}

TEST(Stance, AnEmptyBoardCarriesNobody) {
  Model model;
  Apply(model, BoardTick(1, 2, 1));
  EXPECT_FALSE(StanceOf(model).valid);
  EXPECT_FALSE(StanceOf({}).valid);
}

TEST(Show, ASnapshotsAgeIsNoLatency) {
  Show show;
  Update update;
  update.host_ns = 1;
  update.live = false;
  show.Take(update, 1'000'000'000);
  EXPECT_EQ(show.model().tally.publish_to_view.QuantileMs(1), 0);
  update.live = true;
  show.Take(update, 2'000'001);
  EXPECT_DOUBLE_EQ(show.model().tally.publish_to_view.QuantileMs(1), 2);
}

TEST(Show, AFrozenPictureStandsStillAndGoesOnWhereTheStreamIs) {
  Show show;
  const auto feed_until = [&show](int from, int to) {
    for (int i = from; i <= to; ++i) show.Take(made::TickAt(0.01 * i, {}), made::ClockAt(0.01 * i));
  };
  feed_until(0, 100);
  const double before_s = show.At(made::ClockAt(1), false, {}).frame.time_s;
  feed_until(101, 150);
  EXPECT_EQ(show.At(made::ClockAt(1.5), true, {}).frame.time_s, before_s);
  EXPECT_NEAR(show.At(made::ClockAt(1.51), false, {}).frame.time_s, 1.5, 1e-9);
}

}  // namespace
}  // namespace footing::scene
