#include "clients/study/session/measure_ranges.h"

#include <vector>

#include "common/base/number.h"
#include "common/net/client.h"
#include "common/net/run_folder.h"

namespace footing::study {
namespace {

constexpr double kSensorWithinS = 5;
/// Long enough to see which devices send.
constexpr double kLookS = 1.5;
constexpr std::uint32_t kSensorQueueTicks = 1024;

/// footingd's ticks, to whichever feed is set.
class SensorLink {
 public:
  SensorLink(Console& console, const transport::Address& address)
      : client_(console.io(), OptionsOf(address), HandlersOf(*this)) {
    client_.Start();
  }
  ~SensorLink() { client_.Stop(); }
  SensorLink(const SensorLink&) = delete;
  SensorLink& operator=(const SensorLink&) = delete;

  void Feed(RangeFeed* feed) { feed_ = feed; }
  bool ticked() const { return ticked_; }
  bool live() const { return state_ == transport::LinkState::kLive; }
  const std::string& why() const { return why_; }
  /// The newest device status and setup, which a new feed begins with.
  const v1::Tick& known() const { return known_; }

 private:
  static transport::ClientOptions OptionsOf(const transport::Address& address) {
    transport::ClientOptions options;
    options.address = address;
    options.client_name = "footing-study ranges";
    options.role = v1::ROLE_VIEW;
    options.channels = RangeChannels();
    options.policy = v1::QUEUE_POLICY_RELIABLE;
    options.queue_ticks = kSensorQueueTicks;
    return options;
  }

  static transport::ClientHandlers HandlersOf(SensorLink& link) {
    transport::ClientHandlers handlers;
    handlers.on_tick = [&link](const v1::Tick& tick) {
      link.ticked_ = true;
      if (tick.has_status()) *link.known_.mutable_status() = tick.status();
      if (tick.has_setup()) *link.known_.mutable_setup() = tick.setup();
      if (link.feed_ != nullptr) link.feed_->Take(tick);
    };
    handlers.on_state = [&link](transport::LinkState state, const std::string& why) {
      link.state_ = state;
      link.why_ = why;
    };
    return handlers;
  }

  RangeFeed* feed_ = nullptr;
  bool ticked_ = false;
  v1::Tick known_;
  transport::LinkState state_ = transport::LinkState::kConnecting;
  std::string why_ = "not connected";
  transport::Client client_;
};

/// Which of the devices are there, before anybody is asked to move.
Result<std::string> FindRig(Console& console, SensorLink& link, const std::string& rig,
                            const ranges::Played& played) {
  RangeFeed look(played, rig);
  look.Take(link.known());
  link.Feed(&look);
  const Waited waited = console.RunUntil([] { return false; }, kLookS);
  link.Feed(nullptr);
  if (waited == Waited::kInterrupted) return Interrupted();
  const auto seen = look.meter().Measure();
  if (!seen && seen.error().kind == ErrorKind::kNoDevice) return seen.error();
  return look.rig();
}

}  // namespace

Result<RecordedRanges> MeasureRanges(Console& console, const transport::Address& sensor,
                                     const std::string& rig, const ranges::Played& played) {
  SensorLink link(console, sensor);
  const Waited waited = console.RunUntil([&] { return link.ticked(); }, kSensorWithinS);
  if (waited == Waited::kInterrupted) return Interrupted();
  if (waited == Waited::kTimeUp) {
    return NoDevice(
        "no footingd at " + sensor.Text() + ": " + link.why() +
        transport::RemedyFor(link.why(), "start it, or name its address with --sensor"));
  }
  const auto found = FindRig(console, link, rig, played);
  if (!found) return found.error();
  RangeFeed feed(played, *found);
  feed.Take(link.known());
  link.Feed(&feed);
  const std::vector<ranges::Motion> motions = ranges::MotionsOf(played);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    console.Print("[" + std::to_string(i + 1) + "/" + std::to_string(motions.size()) + "] " +
                  motions[i].prompt + " (" + text::Fixed(motions[i].duration_s, 1) + " s)");
    const Waited moved = console.RunUntil([&] { return !link.live(); }, motions[i].duration_s);
    if (moved == Waited::kInterrupted) return Interrupted();
    if (moved == Waited::kDone) return NoDevice("footingd is gone: " + link.why());
  }
  auto measured = feed.meter().Measure();
  if (!measured) return measured.error();
  return RecordedRanges{std::move(*measured), feed.meter().simulated()};
}

}  // namespace footing::study
