#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/result.h"
#include "common/net/admission.h"
#include "common/net/client.h"
#include "common/net/clock_offset.h"
#include "common/net/framing.h"
#include "common/net/limits.h"
#include "common/net/server.h"
#include "common/net/turn_queue.h"
#include "common/runtime/timer.h"
#include "footing/v1/command.pb.h"
#include "footing/v1/session.pb.h"

namespace footing::transport {

/// Picks the ticks that a session with max_hz gets: on the average at most that many a second, as
/// evenly as the ticks allow. A plain value.
class Decimator {
 public:
  /// `max_hz` 0 takes every tick. `tick_ns` is the nominal interval between ticks.
  Decimator(double max_hz, std::int64_t tick_ns);

  /// Whether the tick of this instant goes out. An instant before the last one resets it.
  bool Take(std::int64_t host_ns);

 private:
  std::int64_t interval_ns_;
  std::int64_t slack_ns_;  ///< Half a tick: a tick that comes a little early is as good.
  std::int64_t due_ns_ = INT64_MIN;
  std::int64_t last_ns_ = INT64_MIN;
};

/// The ticks that one subscribed session gets: live ones, which wait in its queue, and past ones
/// out of the ring, after it resumed or asked for a refill. It has neither a connection nor a
/// clock.
class TickStream {
 public:
  /// Outcome of an offered tick.
  enum class Offered {
    kQueued,
    kLeftOut,   ///< By max_hz.
    kFromRing,  ///< Live ticks come out of the ring, too, until the client has caught up.
    kFull,      ///< The client reads too slowly for the policy reliable: it has to end.
  };

  /// Both outlive it.
  TickStream(const Publication& publication, const std::uint64_t& epoch)
      : publication_(publication), epoch_(epoch) {}

  /// The first live tick of a subscription: the next one, or one of the ring where it resumes.
  std::uint64_t FirstSequence(const v1::Subscribe& wish) const;
  /// A new subscription takes the place of an earlier one, whose ticks and refills are dropped.
  void Begin(Subscription subscription, std::uint64_t first_sequence, double tick_rate_hz);
  Offered Offer(const SharedTick& tick);
  /// Queues ticks that went by. False when too many requests wait.
  bool Refill(std::uint64_t first, std::uint64_t last);

  /// Adds the oldest live tick with the gap in front of it. False when none waits.
  bool FillLive(WriteBatch& batch);
  /// Whether FillFromRing has something to do.
  bool wants_ring() const { return catch_up_ != 0 || !refills_.empty(); }
  /// Adds a tick, or the gap where the ring has passed. False when there is nothing more.
  bool FillFromRing(WriteBatch& batch) { return FillCatchUp(batch) || FillRefill(batch); }

  const Subscription& subscription() const { return subscription_; }
  /// The ticks that wait, and the oldest of them; null: none.
  std::pair<std::size_t, const Tick*> Waiting() const;
  std::uint64_t sent() const { return sent_; }
  std::uint64_t dropped() const { return dropped_before_ + queue_.dropped_ticks(); }

 private:
  struct Range {
    std::uint64_t next = 0;
    std::uint64_t last = 0;
  };

  bool Takes(const Tick& tick);
  bool FillCatchUp(WriteBatch& batch);
  bool FillRefill(WriteBatch& batch);
  void Add(const TickQueue::Entry& entry, bool refilled, WriteBatch& batch);

  const Publication& publication_;
  const std::uint64_t& epoch_;
  Subscription subscription_;
  TickQueue queue_;
  std::optional<Decimator> decimator_;
  /// While not 0 live ticks come out of the ring, from this sequence on, until it is caught up.
  std::uint64_t catch_up_ = 0;
  std::deque<Range> refills_;
  std::uint64_t sent_ = 0;            ///< Handed to the socket.
  std::uint64_t dropped_before_ = 0;  ///< By queues of earlier subscriptions.
};

/// Counts and measurements of a session about itself. A plain value.
struct SessionRecord {
  /// The server's own ping, once a second: it shows that the client lives, and its clock.
  struct OwnPing {
    std::uint64_t id = 0;
    std::int64_t sent_ns = 0;
    bool unanswered = false;
  };

  std::int64_t began_ns = 0;
  std::uint64_t slowed = 0;          ///< Times that it had to wait for its budget.
  std::int64_t slowed_until_ns = 0;  ///< The end of the last of these times; 0: it never had to.
  std::string drain_reason;          ///< The reason for which it is drained; empty: it is not.
  OwnPing ping;
  ClockOffsetEstimator clock;  ///< Offset of the client's clock.

  /// The answer to `ping`; any other one says only that the client lives. Stamps without sense, as
  /// those of a client that sends none, are ignored.
  void TakePong(const v1::Pong& pong, std::int64_t arrived_ns);
};

inline constexpr TurnPace kReplayPace = {
    .share = 0.2, .longest_rest_ns = 10'000'000, .rests_when_empty = true};

/// State that all sessions of one server share.
struct Shared {
  Shared(const boost::asio::any_io_executor& executor, ServerOptions with, ServerHandlers and_with)
      : options(std::move(with)),
        handlers(std::move(and_with)),
        publication(options),
        admission{TokenGuard(options.token, options.view_token)} {
    loop.turns = std::make_shared<TurnQueue>(executor);
    replays = std::make_shared<TurnQueue>(executor, kReplayPace);
  }
  ServerOptions options;
  ServerHandlers handlers;
  Publication publication;
  AdmissionState admission;
  ServerStatistics statistics;
  std::uint64_t epoch = 0;
  SharedLoop loop;
  /// Queue of what goes out of the ring, to all sessions together: a fifth of the loop's time.
  std::shared_ptr<TurnQueue> replays;
  std::int64_t NowNs() const;
  /// Logs the line, unless another was logged within the last 10 s.
  void SayOverload(const OverloadLine& line);
  TokenBucket overload_lines{0.1, 1};
  /// The same for who is kept out, for each kind of it; the line says how many there were of all.
  void SayDenied(const std::string& host, Lack lack, const std::string& why);
  std::map<Lack, TokenBucket> denied_lines;
  /// And for each kind of refusal; the line says how many there were of all kinds.
  void SayRefused(v1::Refused::Reason reason, const Peer& peer, const std::string& why);
  std::map<v1::Refused::Reason, TokenBucket> refused_lines;
  /// And for sessions that are ended since their client sent what it must not.
  TokenBucket ended_lines{0.1, 1};
  /// Carries out what the server does itself (IsOfServer); the command's arrival is its third
  /// argument.
  std::function<v1::CommandResult(const SessionInfo&, const v1::Command&, std::int64_t)>
      on_own_command;
};

/// One client's connection on the server's side, from Hello to Goodbye.
class Session : public std::enable_shared_from_this<Session> {
 public:
  /// `on_end` is called once, from the io loop. Held by a shared_ptr, which its timer prolongs.
  Session(Socket socket, std::uint64_t number, Shared& shared,
          std::function<void(Session&)> on_end);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  void Start();
  /// Answers with Refused and ends, whatever the client says.
  void StartRefused(v1::Refused::Reason reason, const std::string& message);

  /// A tick has just been published.
  void Offer(const SharedTick& tick);

  /// Answers a command that was left open. `remember`: for a repeated id; not what is long and
  /// does no harm when it is asked for again.
  void Answer(const v1::CommandResult& result, bool remember = true);

  /// A message to the devices of this session; dropped if it does not read, as a device out of
  /// range loses its outputs.
  void SendDevice(const v1::DeviceEnvelope& message);

  /// Something slows this session, or all of them.
  void Notify(v1::Notice::Kind kind, const std::string& text, std::uint64_t count);

  /// Sends what waits for the client, then says goodbye and ends.
  void Drain(const std::string& reason);

  /// Says goodbye and ends.
  void End(const std::string& reason);

  /// How it fares, for the channel `stats`.
  stream::SessionStats Stats() const;
  /// The same with where it comes from and why it may, for an administrator.
  v1::ConnectedSession Describe() const;

  const SessionInfo& info() const { return info_; }
  const Peer& peer() const { return peer_; }
  bool secured() const { return connection_.secured(); }
  /// Once it is welcomed.
  const Admitted& admitted() const { return admitted_; }
  /// Its token is wrong, and the answer waits: it takes a place until then.
  bool guessing() const { return phase_ == Phase::kGuessed; }
  /// The answer at once, for somebody else needs the place.
  void AnswerGuess();
  /// Has not said who it is, and somebody else needs its place: refuses it with this message, or
  /// answers its guess.
  void GiveWay(const std::string& message);
  /// It was refused, and lingers until the client has seen why.
  bool refused() const { return phase_ == Phase::kRefused; }
  /// When its turn comes at each tick, from 0: whoever takes every tick works with them, and comes
  /// before whoever takes fewer, such as a picture; who floods the server comes last.
  static constexpr int kLastPlace = 2;
  int PlaceInLine(std::int64_t now_ns) const;
  bool welcomed() const { return phase_ == Phase::kWelcomed || phase_ == Phase::kSubscribed; }
  /// It is welcomed, and nobody has ended it yet.
  bool live() const { return welcomed() && connection_.open(); }

 private:
  enum class Phase { kHello, kGuessed, kWelcomed, kSubscribed, kRefused };

  /// It waits for its budget, or did within the last second.
  bool SlowedLately(std::int64_t now_ns) const;
  void OnFrame(std::string_view payload);
  void OnSlowed(double wait_s);
  void OnHello(const v1::Hello& hello);
  void Dispatch(const v1::Envelope& message, std::int64_t arrived_ns);
  void OnSubscribe(const v1::Subscribe& wish);
  void OnRefill(const v1::Refill& wish);
  void SayNothingToRefill(const v1::Refill& wish);
  void OnPing(const v1::Ping& ping, std::int64_t arrived_ns);
  void OnCommand(const v1::Command& command, std::int64_t arrived_ns);
  void OnDevice(const v1::DeviceEnvelope& message, std::int64_t arrived_ns);
  std::optional<v1::CommandResult> Carry(const v1::Command& command, std::int64_t arrived_ns);

  void SendSnapshot(std::uint64_t sequence);
  void SendGap(std::uint64_t from, std::uint64_t to, v1::Gap::Reason reason);
  /// A full queue of answers ends the session: it takes nothing that it asked for.
  void Send(const v1::Envelope& message) { SendPayload(message.SerializeAsString()); }
  void SendPayload(std::string_view payload);

  void EndLater();
  void Fill(WriteBatch& batch);
  void JoinReplays();

  void Refused(v1::Refused::Reason reason, const std::string& message);
  void BadMessage(const std::string& why);
  void SayEnded(const std::string& why);
  void ArmTimer(double seconds);
  void OnTimer();
  void GrantTime();

  Shared& shared_;
  SessionInfo info_;
  Phase phase_ = Phase::kHello;
  Peer peer_;
  Admitted admitted_;
  std::string guess_answer_;  ///< While it is guessing.
  std::function<void(Session&)> on_end_;
  FramedConnection connection_;
  timer::Timer timer_;
  std::int64_t heard_ns_ = 0;
  const double messages_per_s_;  ///< Its own input rate: a reload may change the limit.
  SessionRecord record_;
  TokenBucket slowed_notices_{1, 1};
  Answers answers_;
  std::set<std::uint64_t> open_commands_;  ///< Being carried out; their answers come later.

  TickStream ticks_;
  int replay_allowance_ = 0;      ///< Ticks of the ring that may still go out in this turn.
  bool waits_to_replay_ = false;  ///< For its turn.
};

/// All sessions of one server, in the order of their numbers: which have a place, and which an
/// administrator or a reload ends. Those that are being refused are among them.
class SessionTable {
 public:
  static constexpr std::int64_t kMostLingering = 64;  ///< Sessions that are being refused.

  explicit SessionTable(Shared& shared) : shared_(shared) {}

  const std::vector<std::shared_ptr<Session>>& all() const { return sessions_; }
  std::int64_t lingering() const;

  /// Why there is no place for one that is not in the table yet; empty when there is one. Makes
  /// place for it: the oldest connection of its host that has not said who it is gives way, and so
  /// does the oldest guess of a token.
  std::string WhyFull(const Session& session);
  void Add(const std::shared_ptr<Session>& session) { sessions_.push_back(session); }
  std::shared_ptr<Session> Remove(const Session& session);
  /// The one with that number; null: there is none.
  std::shared_ptr<Session> Find(std::uint64_t number) const;

  /// Other keys: ends the sessions that came in by what is gone, and returns how many.
  std::size_t SetKeys(const AccessKeys& keys);

  /// list_sessions and end_sessions.
  v1::CommandResult CarryOut(const SessionInfo& who, const v1::Command& command);

 private:
  SessionCounts CountsFor(const Session& one) const;
  bool EndAGuess(const std::optional<std::string>& host);
  void BoundGuesses(const std::string& host);
  void BoundEntering(const Session& session);
  v1::CommandResult List(const SessionInfo& who, std::uint64_t after) const;
  v1::CommandResult End(const SessionInfo& who, const v1::EndSessions& wish);

  Shared& shared_;
  std::vector<std::shared_ptr<Session>> sessions_;
};

/// Enlarges this process's table to hold `count` descriptors, as far as its limit of open files
/// permits. The kernel doubles the table when a descriptor does not fit, and where a process has
/// threads it then waits until every processor has passed a quiet point: the thread that accepts
/// the 257th connection would be stopped for 6 to 17 ms.
void ReserveDescriptors(std::size_t count);

/// Checks what holds for every command: its texts are printable (text::IsPrintable), since they go
/// to screens, logs and files, and its numbers are finite. A usage error names the field. A mapping
/// table (SetInterface.table) is a document: its reader checks it.
Result<void> CheckContent(const v1::Command& command);

}  // namespace footing::transport
