#include "clients/stream/insoles.h"

#include <array>
#include <utility>

#include "clients/stream/feeds.h"
#include "common/base/units.h"
#include "common/virtual/devices/random.h"
#include "common/virtual/devices/insole_cells.h"

namespace footing::stream_client {
namespace {

namespace sensors = virtual_sensors;

constexpr double kInsoleRateHz = 100;

}  // namespace

Feed InsoleFeed(std::shared_ptr<const Stage> stage, std::size_t foot, const InsoleErrors& errors,
                std::uint64_t seed) {
  const auto places =
      sensors::InsolePlaces(sensors::PlaceOfSole(stage->scene.course, foot, 0).length_m);
  noise::Random random(seed);
  std::array<double, sensors::kInsoleCells> gains{};
  for (double& gain : gains) gain = 1 + errors.gain_spread * random.Normal();
  const double noise_n = KilogramsToNewtons(errors.noise_kg);
  Feed feed;
  feed.rate_hz = kInsoleRateHz;
  feed.contacts = [=](double t_s) mutable {
    const Stage::Instant at = stage->At(t_s);
    const sensors::SolePlace sole =
        sensors::PlaceOfSole(stage->scene.course, foot, at.share < 0.5 ? at.frame : at.frame + 1);
    const auto loads_n = sensors::LoadInsole(places, sole, stage->FootAt(foot, t_s));
    stream::ContactFrame frame;
    frame.source = foot == 0 ? "sim-insole-left" : "sim-insole-right";
    frame.body = foot == 0 ? stream::ContactBody::kLeftFoot : stream::ContactBody::kRightFoot;
    frame.simulated = true;
    for (std::size_t i = 0; i < places.size(); ++i) {
      frame.cells.push_back(
          {{places[i].x(), places[i].y(), 0}, gains[i] * loads_n[i] + noise_n * random.Normal()});
    }
    return frame;
  };
  return feed;
}

Result<Plan> PlanInsoles(const InsolesOptions& options, const Common& common) {
  if (options.hands != "none" && options.hands != "move") {
    return UsageError("--hands " + options.hands + ": with insoles there are none and move");
  }
  StageOptions wanted = options.stage;
  wanted.on_boards = false;
  wanted.seconds = common.seconds;
  const auto made = MakeStage(wanted);
  if (!made) return made.error();
  const std::shared_ptr<const Stage>& stage = *made;
  Plan plan;
  for (const std::size_t foot : {0u, 1u}) {
    plan.feeds.push_back(
        InsoleFeed(stage, foot, options.errors, DeviceSeed(common, foot + 1) + 700));
  }
  AddBodyFeeds(stage, options.hands, options.hand_noise_m, common, plan);
  return plan;
}

}  // namespace footing::stream_client
