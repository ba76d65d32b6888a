#include "clients/game/host.h"

#include <chrono>
#include <cmath>
#include <iostream>
#include <optional>

#include <boost/asio/io_context.hpp>
#include <nlohmann/json.hpp>

#include "clients/game/rules/director.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/net/address.h"
#include "common/net/client.h"
#include "common/runtime/clock.h"
#include "common/runtime/service_manager.h"
#include "common/runtime/timer.h"
#include "common/wire/scalar.h"
#include "common/wire/wire.h"

namespace footing::game {
namespace {

/// Bits of buttons A and B in a Wiimote's two button bytes.
constexpr std::uint32_t kButtonA = 0x0008, kButtonB = 0x0004;

Fault FaultOf(const v1::Failure& failure) {
  const auto cause = v1::FailureCause_IsValid(failure.cause())
                         ? static_cast<stream::FailureCause>(failure.cause())
                         : stream::FailureCause::kUnspecified;
  return {failure.number(), cause, failure.trial(), wire::Finite(failure.distance_m()),
          failure.withdrawn()};
}

/// Editor of the first rig whose editor sends samples; footingd sorts the rigs by name. Null when
/// none.
const v1::DeviceFeatures* EditorOf(const v1::Tick& tick) {
  for (const v1::RigFeatures& rig : tick.features().rigs()) {
    for (const v1::DeviceFeatures& one : rig.devices()) {
      if (one.role() == v1::DEVICE_ROLE_EDITOR && one.inclination_valid()) return &one;
    }
  }
  return nullptr;
}

}  // namespace

void Take(const v1::Tick& tick, Collector& collector) {
  if (tick.has_track()) collector.OnTrack(wire::FromProto(tick.track()));
  for (const v1::Event& event : tick.events().events()) {
    if (event.has_failure()) collector.OnFault(FaultOf(event.failure()));
  }
  if (tick.characters().characters_size() > 0) {
    collector.OnTrial(wire::FromProto(tick.characters().characters(0).trial()));
  }
}

bool Take(const v1::Tick& tick, std::uint32_t& device, Hand& hand) {
  const v1::DeviceFeatures* editor = EditorOf(tick);
  if (editor != nullptr) {
    device = editor->device();
    hand.roll_rad = wire::Finite(editor->roll_rad());
    hand.pitch_rad = wire::Finite(editor->pitch_rad());
  }
  for (const v1::MotionSample& sample : tick.motion().samples()) {
    if (device == 0 || sample.device() != device) continue;
    hand.a = (sample.buttons() & kButtonA) != 0;
    hand.b = (sample.buttons() & kButtonB) != 0;
  }
  return editor != nullptr;
}

Frame FrameOf(const v1::Tick& tick) {
  const v1::Character& character = tick.characters().characters(0);
  const stream::InterfaceState interface = wire::FromProto(character.interface());
  Frame frame;
  frame.time_s = wire::Finite(tick.characters().time_s());
  frame.commanded_speed_mps = wire::Finite(character.gait().commanded_speed_mps());
  frame.commanded = character.gait().commanded_by_stream();
  frame.runner_silent =
      interface.activity == stream::Activity::kAbsent || interface.missing_roles != 0;
  frame.trial = wire::FromProto(character.trial());
  return frame;
}

v1::Command ToCommand(const Piece& piece) {
  v1::Command command;
  v1::AppendSegment& append = *command.mutable_append_segment();
  append.set_length_m(piece.length_m);
  append.set_slope_rad(piece.slope_rad);
  append.set_curve_rad(piece.curve_rad);
  append.set_step_m(piece.step_m);
  append.set_pit(piece.pit);
  return command;
}

namespace {

using nlohmann::ordered_json;

/// Less is not a slope, curve or step that anybody made.
constexpr double kLeast = 1e-6;

ordered_json Failures(const stream::FailureCounts& counts) {
  ordered_json failures;
  for (const stream::FailureCause cause : stream::kFailureCauses) {
    failures[stream::Name(cause)] = stream::CountOf(cause, counts);
  }
  return failures;
}

ordered_json RoundOf(const stream::GameState& game, const stream::GameRound& round) {
  return {{"runner", game.players[round.runner].name},
          {"builder", game.players[1 - round.runner].name},
          {"trial", round.trial},
          {"time_s", round.time_s},
          {"distance_m", round.distance_m},
          {"failures", Failures(round.failures)},
          {"segments_laid", round.segments_laid},
          {"segments_passed", round.segments_passed},
          {"difficulty", round.difficulty},
          {"runner_points", round.runner_points},
          {"builder_points", round.builder_points}};
}

std::string PlayerText(const stream::GameState& game, std::size_t player, const char* does,
                       double points) {
  return game.players[player].name + " " + does + " " + text::Fixed(points, 0);
}

}  // namespace

Report MakeReport(const stream::GameState& game, const Collector& seen, double seconds) {
  Report report;
  report.game = game;
  report.seconds = seconds;
  for (const stream::GameRound& round : game.results) {
    const RoundFacts* const facts = seen.Find(round.trial);
    if (facts == nullptr) continue;
    for (const Stretch& stretch : facts->laid) {
      report.slopes += std::fabs(stretch.slope_rad) > kLeast;
      report.curves += std::fabs(stretch.curve_rad) > kLeast;
      report.steps += std::fabs(stretch.step_m) > kLeast;
      report.pits += stretch.pit;
    }
  }
  return report;
}

std::string ToJson(const Report& report) {
  const stream::GameState& game = report.game;
  ordered_json players = ordered_json::array();
  for (const stream::GamePlayer& player : game.players) {
    players.push_back({{"name", player.name}, {"points", player.points}});
  }
  ordered_json rounds = ordered_json::array();
  for (const stream::GameRound& round : game.results) rounds.push_back(RoundOf(game, round));
  const auto winner = stream::WinnerOf(game);
  return ordered_json{{"seconds", report.seconds},
                      {"phase", stream::Name(game.phase)},
                      {"players", players},
                      {"rounds", rounds},
                      {"winner", winner ? game.players[*winner].name : ""},
                      {"slopes", report.slopes},
                      {"curves", report.curves},
                      {"steps", report.steps},
                      {"pits", report.pits},
                      {"segments_refused", game.refused}}
      .dump();
}

std::string ToLine(const stream::GameState& game) {
  std::string line = stream::Name(game.phase);
  if (game.phase == stream::GamePhase::kRound) {
    line += " " + std::to_string(game.results.size()) + " of " + std::to_string(game.rounds);
  }
  if (game.left_s > 0) line += "  " + text::Fixed(std::ceil(game.left_s), 0) + " s left";
  if (!game.results.empty()) {
    const stream::GameRound& round = game.results.back();
    line += "  " + PlayerText(game, round.runner, "runs", round.runner_points) + "  " +
            PlayerText(game, 1 - round.runner, "builds", round.builder_points) + "  " +
            text::Fixed(round.distance_m, 1) + " m  failures " +
            std::to_string(stream::Total(round.failures));
  }
  if (game.ghost) {
    line += "  next: slope " + text::Fixed(RadiansToDegrees(game.ghost->slope_rad), 1) +
            " deg, curve " + text::Fixed(RadiansToDegrees(game.ghost_curve_rad), 1) +
            " deg, step " + text::Fixed(100 * game.ghost_step_m, 1) + " cm";
    if (game.ghost->pit) line += ", pit";
  }
  return game.note.empty() ? line : line + "  (" + game.note + ")";
}

std::string ToText(const Report& report) {
  std::string text;
  for (std::size_t i = 0; i < report.game.results.size(); ++i) {
    const stream::GameRound& round = report.game.results[i];
    text += "round " + std::to_string(i + 1) + ": " +
            PlayerText(report.game, round.runner, "ran", round.runner_points) + ", " +
            PlayerText(report.game, 1 - round.runner, "built", round.builder_points) + "; " +
            text::Fixed(round.distance_m, 1) + " m, " +
            std::to_string(stream::Total(round.failures)) + " failures, " +
            std::to_string(round.segments_passed) + " of " + std::to_string(round.segments_laid) +
            " segments passed\n";
  }
  for (const stream::GamePlayer& player : report.game.players) {
    text += player.name + ": " + text::Fixed(player.points, 0) + " points\n";
  }
  if (report.game.phase != stream::GamePhase::kOver) return text + "the game did not end\n";
  const auto winner = stream::WinnerOf(report.game);
  return text + (winner ? report.game.players[*winner].name + " wins\n" : "a draw\n");
}

namespace {

bool Equal(const stream::GameRound& a, const stream::GameRound& b) {
  return a.runner_points == b.runner_points && a.builder_points == b.builder_points &&
         a.distance_m == b.distance_m && a.failures == b.failures &&
         a.segments_laid == b.segments_laid && a.segments_passed == b.segments_passed;
}

}  // namespace

Result<Recount> RecountGame(const recording::RecordedSession& session) {
  const recording::RecordedServer* const server = session.Find("footing-sim");
  if (server == nullptr) return InvalidData(session.path() + " holds no ticks of footing-sim");
  Collector seen;
  std::optional<stream::GameState> game;
  std::int64_t first_ns = 0, last_ns = 0;
  for (const recording::RecordedTick& recorded : server->ticks) {
    const auto tick = recording::ReadTick(
        recorded, {v1::Tick::kTrackFieldNumber, v1::Tick::kEventsFieldNumber,
                   v1::Tick::kCharactersFieldNumber, v1::Tick::kGameFieldNumber});
    if (!tick) return tick.error();
    Take(*tick, seen);
    if (!tick->has_game()) continue;
    stream::GameState next = wire::FromProto(tick->game());
    if (const char* why = stream::WhyNotAGame(next); why != nullptr) {
      return InvalidData(session.path() + ", game: " + why);
    }
    if (!game) first_ns = recorded.host_ns;
    last_ns = recorded.host_ns;
    game = std::move(next);
  }
  if (!game) return InvalidData(session.path() + " holds no terrain game");
  const double seconds = NanosecondsToSeconds(last_ns - first_ns);
  Recount recount;
  recount.published = MakeReport(*game, seen, seconds);
  recount.equal = true;
  for (stream::GameRound& round : game->results) {
    const RoundFacts* const facts = seen.Find(round.trial);
    // The published result of a round that was broken off is a moment old.
    if (facts != nullptr && facts->phase != stream::TrialPhase::kStopped) continue;
    stream::GameRound counted = facts == nullptr ? stream::GameRound() : Score(*facts);
    counted.runner = round.runner;
    counted.trial = round.trial;
    recount.equal = recount.equal && Equal(counted, round);
    round = std::move(counted);
  }
  AddUp(*game);
  recount.counted = MakeReport(*game, seen, seconds);
  return recount;
}

namespace {

namespace asio = boost::asio;

/// Inclinations older than this are not the builder's any more.
constexpr double kHandS = 0.5;
constexpr std::uint32_t kQueueTicks = 1024;
constexpr auto kLine = std::chrono::seconds(1);
/// Time at the end within which the last orders are still sent and their answers awaited.
constexpr auto kLeaveWithin = std::chrono::milliseconds(500);

class Host {
 public:
  explicit Host(const HostOptions& options)
      : options_(options),
        director_(options.game),
        signals_(io_, [this] { End(); }),
        line_(io_),
        started_ns_(clock::MonotonicNs()),
        sensor_(io_, SensorOptions(), SensorHandlers()),
        simulation_(io_, SimulationOptions(), SimulationHandlers()) {}

  Result<Report> Run() {
    sensor_.Start();
    simulation_.Start();
    LineLater();
    io_.run();
    if (failed_) return *failed_;
    if (seen_.track().segments.empty()) return WhyNoTrack();
    if (!sensed_) {
      return NoDevice("no footingd: " + sensor_link_ +
                      transport::RemedyFor(sensor_link_,
                                           "start it with: footingd, or name its address with "
                                           "--sensor"));
    }
    return MakeReport(director_.game(), seen_, PassedS());
  }

 private:
  transport::ClientOptions SensorOptions() const {
    transport::ClientOptions client;
    client.address = options_.sensor;
    client.client_name = options_.game.host;
    client.channels = {"features", "motion"};
    return client;
  }

  transport::ClientHandlers SensorHandlers() {
    transport::ClientHandlers handlers;
    handlers.on_tick = [this](const v1::Tick& tick) {
      if (Take(tick, device_, hand_)) inclined_ns_ = clock::MonotonicNs();
    };
    handlers.on_state = [this](transport::LinkState, const std::string& why) {
      sensor_link_ = why;
    };
    handlers.on_welcome = [this](const v1::Welcome&) { sensed_ = true; };
    return handlers;
  }

  // Every tick of footing-sim counts: scores are those that a recording gives.
  transport::ClientOptions SimulationOptions() const {
    transport::ClientOptions client;
    client.address = options_.simulation;
    client.client_name = options_.game.host;
    client.role = v1::ROLE_CONTROL;
    client.channels = {"characters", "events", "track"};
    client.policy = v1::QUEUE_POLICY_RELIABLE;
    client.queue_ticks = kQueueTicks;
    return client;
  }

  transport::ClientHandlers SimulationHandlers() {
    transport::ClientHandlers handlers;
    handlers.on_tick = [this](const v1::Tick& tick) { OnTick(tick); };
    handlers.on_state = [this](transport::LinkState, const std::string& why) { link_ = why; };
    handlers.on_welcome = [this](const v1::Welcome&) { welcomed_ = true; };
    return handlers;
  }

  /// Why there was nothing to play on until the end.
  Error WhyNoTrack() const {
    if (welcomed_) {
      return Failure(options_.simulation.Text() +
                     " has no track: the game needs the gait engine; start it with: footing-sim");
    }
    return NoDevice("no footing-sim: " + link_ +
                    transport::RemedyFor(link_,
                                         "start it with: footing-sim, or name its address with "
                                         "--simulation"));
  }

  double PassedS() const { return NanosecondsToSeconds(clock::MonotonicNs() - started_ns_); }

  void OnTick(const v1::Tick& tick) {
    for (const v1::Event& event : tick.events().events()) {
      if (event.segment_refused()) director_.OnRefused();
    }
    Take(tick, seen_);
    if (ending_ || tick.characters().characters_size() == 0) return;
    hand_.known =
        NanosecondsToSeconds(clock::MonotonicNs() - inclined_ns_) < kHandS && inclined_ns_ != 0;
    if (seen_.track().segments.empty()) return;
    Send(director_.Advance(FrameOf(tick), seen_, hand_));
    if (director_.game().phase == stream::GamePhase::kOver) End();
  }

  /// The state goes first: nobody else starts a trial from then on.
  void Send(const Orders& orders) {
    if (orders.publish) {
      v1::Command command;
      *command.mutable_set_game()->mutable_game() = wire::ToProto(director_.game());
      Send(std::move(command), true);
    }
    if (!orders.start_trial.empty()) {
      v1::Command command;
      command.mutable_start_trial()->set_trial(orders.start_trial);
      command.mutable_start_trial()->set_track(orders.track);
      Send(std::move(command), true);
    }
    if (!orders.stop_trial.empty()) {
      v1::Command command;
      command.mutable_stop_trial()->set_trial(orders.stop_trial);
      Send(std::move(command), false);
    }
    if (orders.append) Send(ToCommand(*orders.append), false);
  }

  void Send(v1::Command command, bool vital) {
    const bool append = command.has_append_segment();
    simulation_.Send(std::move(command), [this, vital, append](const v1::CommandResult& result) {
      if (result.ok() || ending_) return;
      if (append) director_.OnRefused();
      // Without the link there is no game to lose: it goes on when footing-sim is back.
      if (!vital || simulation_.state() != transport::LinkState::kLive) return;
      failed_ = Failure("the game cannot go on: " + result.message());
      End();
    });
  }

  std::string Line() const {
    if (seen_.track().segments.empty()) return "waiting for footing-sim: " + link_;
    if (sensor_.state() != transport::LinkState::kLive)
      return "waiting for footingd: " + sensor_link_;
    return ToLine(director_.game());
  }

  void LineLater() {
    line_.After(kLine, [this] {
      std::ostream& out = options_.text ? std::cout : std::cerr;
      out << Line() << std::endl;
      if (options_.seconds > 0 && PassedS() >= options_.seconds) return End();
      LineLater();
    });
  }

  void End() {
    if (std::exchange(ending_, true)) return;
    signals_.cancel();
    sensor_.Stop();
    v1::Command leave;
    leave.mutable_set_game()->set_leave(true);
    simulation_.Send(std::move(leave), [this](const v1::CommandResult&) { Leave(); });
    line_.After(kLeaveWithin, [this] { Leave(); });
  }

  void Leave() {
    line_.cancel();
    simulation_.Stop();
    io_.stop();
  }

  const HostOptions& options_;
  Director director_;
  Collector seen_;
  Hand hand_;
  std::uint32_t device_ = 0;
  std::int64_t inclined_ns_ = 0;
  asio::io_context io_{1};
  service_manager::ProgramEnd signals_;
  timer::Timer line_;
  std::int64_t started_ns_;
  std::string link_ = "not connected", sensor_link_ = link_;
  bool welcomed_ = false, sensed_ = false;  ///< By footing-sim; by footingd.
  bool ending_ = false;
  std::optional<Error> failed_;
  transport::Client sensor_, simulation_;
};

}  // namespace

Result<Report> RunGame(const HostOptions& options) { return Host(options).Run(); }

}  // namespace footing::game
