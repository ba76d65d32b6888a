#include "clients/study/session/range_run.h"

#include <utility>
#include <vector>

#include "clients/study/session/run_session.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/board/geometry.h"
#include "common/net/address.h"
#include "common/net/client.h"
#include "common/recording/recorded_session.h"
#include "common/runtime/clock.h"
#include "common/runtime/files.h"
#include "common/wire/wire.h"

namespace footing::study {
namespace {

using stream::DeviceRole;

/// A board that has been silent for longer is missing, as for the interface.
constexpr double kBoardTimeoutS = 0.25;

}  // namespace

std::vector<std::string> RangeChannels() {
  return {"status", "features", "nunchuk", "boards", "setup"};
}

RangeFeed::RangeFeed(const ranges::Played& played, std::string rig)
    : played_(played),
      sensors_(std::move(rig), stream::DrivingRoles(stream::UserInterfaceNamed(played.interface))),
      meter_(played) {}

void RangeFeed::TakeBoards(const rig::Tick& tick) {
  bool taken = false;
  for (const stream::BoardSample& sample : tick.boards) {
    const DeviceRole role = sensors_.RoleOf(sample.device);
    if (role == DeviceRole::kUnspecified) continue;
    const stream::BoardLayout layout = sensors_.Layout();
    const bool left = role == DeviceRole::kLeftBoard;
    const double forward_m =
        board::InWorld(left ? layout.left : layout.right, sample.cop_x_m, sample.cop_y_m).x();
    const double load_n =
        sample.top_left_n + sample.top_right_n + sample.bottom_left_n + sample.bottom_right_n;
    (left ? left_ : right_) = {{load_n, sample.cop_valid, forward_m},
                               {true, tick.host_ns, sample.simulated}};
    taken = true;
  }
  if (!taken || !left_.heard.IsLive(tick.host_ns, kBoardTimeoutS) ||
      !right_.heard.IsLive(tick.host_ns, kBoardTimeoutS)) {
    return;
  }
  meter_.AddStance(NanosecondsToSeconds(tick.host_ns), board::StanceOn(left_.load, right_.load),
                   left_.heard.simulated || right_.heard.simulated);
}

void RangeFeed::Take(const rig::Tick& tick) {
  sensors_.Take(tick);
  if (tick.snapshot) return;
  const double time_s = NanosecondsToSeconds(tick.host_ns);
  if (played_.interface == "boards") return TakeBoards(tick);
  if (played_.interface == "joystick") {
    for (const stream::NunchukSample& sample : tick.nunchuks) {
      if (sensors_.RoleOf(sample.device) == DeviceRole::kUnspecified) continue;
      meter_.AddStick(time_s, sample.stick_x, sample.stick_y, sample.simulated);
    }
    return;
  }
  const stream::RigFeatures* features = sensors_.FeaturesIn(tick);
  if (features != nullptr) meter_.Add(time_s, *features, sensors_.MountedRoles());
}

Result<RecordedRanges> RangesInRecording(const std::string& path, const ranges::Played& played,
                                         const std::string& rig, double from_s, double to_s) {
  const auto session = recording::RecordedSession::Open(path);
  if (!session) return session.error();
  const recording::RecordedServer* sensors = session->Find("footingd");
  if (sensors == nullptr || sensors->ticks.empty()) {
    return InvalidData(path + " has no messages of footingd");
  }
  RangeFeed feed(played, rig);
  const std::int64_t start_ns = sensors->ticks.front().host_ns;
  for (const recording::RecordedTick& recorded : sensors->ticks) {
    const auto message =
        recording::ReadTick(recorded, {v1::Tick::kStatusFieldNumber, v1::Tick::kFeaturesFieldNumber,
                                       v1::Tick::kNunchukFieldNumber, v1::Tick::kBoardsFieldNumber,
                                       v1::Tick::kSetupFieldNumber});
    if (!message) return InvalidData(path + ": " + message.error().message);
    rig::Tick tick = wire::SensorTick(*message);
    const double time_s = NanosecondsToSeconds(recorded.host_ns - start_ns);
    if (time_s < from_s || (to_s > 0 && time_s > to_s)) {
      tick.features.clear();
      tick.nunchuks.clear();
      tick.boards.clear();
    }
    feed.Take(tick);
  }
  auto measured = feed.meter().Measure();
  if (!measured) return Error{measured.error().kind, path + ": " + measured.error().message};
  return RecordedRanges{std::move(*measured), feed.meter().simulated()};
}

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
  const rig::Tick& known() const { return known_; }

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
    handlers.on_tick = [&link](const v1::Tick& message) {
      const rig::Tick tick = wire::SensorTick(message);
      link.ticked_ = true;
      link.known_.epoch = tick.epoch;
      if (tick.devices) link.known_.devices = tick.devices;
      if (tick.setup) link.known_.setup = tick.setup;
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
  rig::Tick known_;
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

namespace {

using nlohmann::ordered_json;
using records::EventKind;

constexpr const char* kByMeasurement = "measured";
constexpr const char* kByProtocol = "protocol";
constexpr const char* kByBuiltIn = "built-in";

}  // namespace

Result<std::string> SessionRun::TableOf(const std::string& interface) {
  const std::vector<records::Event>& events = context_.journal.events();
  for (auto event = events.rbegin(); event != events.rend(); ++event) {
    if (event->kind != EventKind::kRanges || event->Text("interface") != interface) continue;
    const auto table = event->fields.find("table");
    return table == event->fields.end() || table->is_null() ? std::string() : table->dump();
  }
  const auto given = context_.options.tables.find(interface);
  if (given == context_.options.tables.end()) return std::string();
  const auto noted = NoteTable(interface, kByProtocol, given->second, "");
  if (!noted) return noted.error();
  return TableOf(interface);  // As the journal has it.
}

Result<std::string> SessionRun::TableToSend(const std::string& interface) {
  auto table = TableOf(interface);
  if (!table || interface != "leg" || !context_.protocol.settings.camera_roll) return table;
  if (table->empty()) table = config::ReadDataFile(interface + "_mapping.json");
  if (!table) return table;
  ordered_json values = ordered_json::parse(*table, nullptr, false, true);
  if (!values.is_object()) return InvalidData("the table of " + interface + " is not JSON");
  values["camera_roll"] = true;
  return values.dump();
}

Result<void> SessionRun::NoteTable(const std::string& interface, const std::string& by,
                                   const std::string& table, const std::string& reason) {
  ordered_json fields = {
      {"interface", interface}, {"by", by}, {"synthetic", context_.options.unattended}};
  if (!reason.empty()) fields["reason"] = reason;
  fields["table"] =
      table.empty() ? ordered_json() : ordered_json::parse(table, nullptr, false, true);
  return context_.journal.Append(EventKind::kRanges, std::move(fields));
}

Result<void> SessionRun::MeasureRanges(const plan::Phase& phase) {
  const std::string& interface = phase.interface;
  if (context_.options.unattended) {
    const auto before = TableOf(interface);
    if (!before) return before.error();
    return NoteTable(interface, before->empty() ? kByBuiltIn : kByProtocol, *before,
                     "no person takes part");
  }
  const auto servers = UseInterface(interface);
  if (!servers) return servers.error();
  const auto built_in = config::ReadDataFile(interface + "_mapping.json");
  if (!built_in) return built_in.error();
  const ranges::Played played{interface, context_.protocol.settings.turn_by};
  for (;;) {
    Show(stream::StudyActivity::kRanges,
         "Measure the participant's own ranges: read each motion aloud.", "Enter begins");
    const auto ready = context_.console.Ask("Next: the participant's own ranges, " +
                                            text::Fixed(ranges::DurationOf(played), 0) +
                                            " s. Read each motion aloud. Press Enter to begin:");
    if (!ready) return ready.error();
    const auto measured =
        study::MeasureRanges(context_.console, context_.options.sensor, "", played);
    if (context_.console.interrupted()) return Interrupted();
    auto table = measured ? ranges::TableOf(played, measured->ranges,
                                            {.participants = {context_.session.participant},
                                             .when = text::Utc(clock::WallNs()),
                                             .how = "live",
                                             .by = "footing-study " + context_.options.version,
                                             .simulated = measured->simulated},
                                            *built_in)
                          : Result<ordered_json>(measured.error());
    if (table) {
      context_.console.Print("Measured: " + (*table)["measured"]["ranges"].dump());
      return NoteTable(interface, kByMeasurement, table->dump(), "");
    }
    context_.console.Print(table.error().message);
    const auto next = context_.console.Ask(
        "Press Enter to measure again, or type b to go on without own ranges:");
    if (!next) return next.error();
    if (next->empty()) continue;
    if (*next != "b") {
      context_.console.Print(text::Quoted(*next) + " is neither; measuring again");
      continue;
    }
    const auto given = context_.options.tables.find(interface);
    const bool protocol = given != context_.options.tables.end();
    return NoteTable(interface, protocol ? kByProtocol : kByBuiltIn, protocol ? given->second : "",
                     table.error().message);
  }
}

}  // namespace footing::study
