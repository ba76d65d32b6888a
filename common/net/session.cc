#include "common/net/session.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <google/protobuf/descriptor.h>
#include <sys/resource.h>
#include <unistd.h>
#include <boost/asio/post.hpp>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/net/admission.h"
#include "common/net/framing.h"
#include "common/runtime/clock.h"
#include "common/wire/wire.h"

namespace footing::transport {

Decimator::Decimator(double max_hz, std::int64_t tick_ns)
    : interval_ns_(max_hz > 0 ? PeriodNanoseconds(max_hz) : 0),
      slack_ns_(std::min(tick_ns, interval_ns_) / 2) {}

bool Decimator::Take(std::int64_t host_ns) {
  if (interval_ns_ == 0) return true;
  const bool restarted = last_ns_ == INT64_MIN || host_ns < last_ns_;
  last_ns_ = host_ns;
  if (!restarted && host_ns < due_ns_ - slack_ns_) return false;
  const std::int64_t earliest = host_ns + interval_ns_ - slack_ns_;
  due_ns_ = restarted ? host_ns + interval_ns_ : std::max(due_ns_ + interval_ns_, earliest);
  return true;
}

namespace {

const char* NameOf(QueueRule rule) {
  switch (rule) {
    case QueueRule::kLatest:
      return "latest";
    case QueueRule::kDropOldest:
      return "drop_oldest";
    case QueueRule::kReliable:
      return "reliable";
  }
  return "";
}

}  // namespace

void SessionRecord::TakePong(const v1::Pong& pong, std::int64_t arrived_ns) {
  const bool answers = ping.unanswered && pong.id() == ping.id;
  ping.unanswered = false;
  if (answers) clock.Add({ping.sent_ns, pong.t1_ns(), pong.t2_ns(), arrived_ns});
}

stream::SessionStats Session::Stats() const {
  const std::int64_t now_ns = shared_.NowNs();
  stream::SessionStats stats;
  stats.session = info_.session;
  stats.client_name = info_.client_name;
  stats.role = RoleName(info_.role);
  stats.local = peer_.known;
  stats.connected_s = NanosecondsToSeconds(now_ns - record_.began_ns);
  stats.ticks_sent = ticks_.sent();
  stats.ticks_dropped = ticks_.dropped();
  stats.slowed = record_.slowed;
  const OffsetEstimate clock = record_.clock.estimate();
  stats.clock_valid = clock.valid;
  stats.clock_offset_s = NanosecondsToSeconds(clock.offset_ns);
  stats.clock_uncertainty_s = NanosecondsToSeconds(clock.uncertainty_ns);
  if (phase_ != Phase::kSubscribed) return stats;
  stats.policy = NameOf(ticks_.subscription().rule);
  stats.queue_capacity = static_cast<std::uint32_t>(ticks_.subscription().queue_ticks);
  const auto [waiting, oldest] = ticks_.Waiting();
  stats.queue_ticks = static_cast<std::uint32_t>(waiting);
  if (oldest != nullptr) stats.lag_s = NanosecondsToSeconds(now_ns - oldest->host_ns);
  return stats;
}

v1::ConnectedSession Session::Describe() const {
  v1::ConnectedSession described;
  *described.mutable_stats() = wire::ToProto(Stats());
  if (peer_.known) described.set_user(peer_.user);
  described.set_host(peer_.host);
  described.set_granted_by(Name(admitted_.grant));
  described.set_certificate(admitted_.claim.certificate);
  return described;
}

namespace {

constexpr std::size_t kMaxQueuedAnswers = 64;
constexpr std::size_t kRememberedAnswers = 256;
constexpr double kCommandCost = 2;  // In messages.
/// In messages: a device sends hundreds a second. An attachment costs as much as a command.
constexpr double kDeviceCost = 0.02;

FramedLimits LimitsOf(const ServerOptions& options) {
  FramedLimits limits;
  limits.max_in_bytes = options.max_message_in_bytes;
  limits.max_out_bytes = options.max_message_out_bytes;
  limits.max_queued_bytes = 2 * options.max_message_out_bytes;  // A snapshot, and answers.
  limits.max_queued_frames = kMaxQueuedAnswers;
  limits.input = options.sessions.Input();
  return limits;
}

/// The server answers these itself, whatever its program does with others.
bool IsOfServer(const v1::Command& command) {
  return command.has_list_sessions() || command.has_end_sessions() || command.has_marker();
}

/// Why a session of this role may not send the command; empty: it may. A marker changes nothing but
/// the recordings, so a recorder may send it.
std::string WhyNotPermitted(const v1::Command& command, v1::Role role) {
  if (role >= (command.has_marker() ? v1::ROLE_LOG : v1::ROLE_CONTROL)) return "";
  const std::string needed = command.has_marker() ? "log" : "control";
  return (command.has_marker() ? "a marker needs the role " : "commands need the role ") + needed +
         ", and this session has a lower one: request " + needed +
         " in Hello, over the server's Unix socket, or with its token or a certificate for this "
         "role";
}

std::string Seconds(double seconds) {
  std::string text = std::to_string(seconds);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text + " s";
}

}  // namespace

Session::Session(Socket socket, std::uint64_t number, Shared& shared,
                 std::function<void(Session&)> on_end)
    : shared_(shared),
      on_end_(std::move(on_end)),
      connection_(
          std::move(socket), LimitsOf(shared.options),
          {[this](std::string_view payload) { OnFrame(payload); },
           [this](const std::string&) { on_end_(*this); },
           [this](WriteBatch& batch) { Fill(batch); }, [this] { heard_ns_ = shared_.NowNs(); },
           [this](const std::string& why) { BadMessage(why); },
           [this](double wait_s) { OnSlowed(wait_s); }},
          shared.loop),
      timer_(connection_.executor()),
      heard_ns_(shared.NowNs()),
      messages_per_s_(shared.options.sessions.session_messages_per_s),
      answers_(kRememberedAnswers),
      ticks_(shared.publication, shared.epoch) {
  info_.session = number;
  record_.began_ns = heard_ns_;
  peer_ = PeerOf(connection_.native_handle());
}

void Session::Start() {
  connection_.Start();
  ArmTimer(shared_.options.hello_deadline_s);
}

void Session::StartRefused(v1::Refused::Reason reason, const std::string& message) {
  connection_.Start();
  Refused(reason, message);
}

void Session::ArmTimer(double seconds) {
  timer_.After(seconds, [this] {
    const auto self = shared_from_this();  // It may end.
    OnTimer();
  });
}

void Session::GrantTime() {
  heard_ns_ = shared_.NowNs();
  ArmTimer(phase_ == Phase::kHello ? shared_.options.hello_deadline_s
                                   : shared_.options.ping_interval_s);
}

void Session::OnTimer() {
  if (!connection_.open()) return;
  if (guessing()) return AnswerGuess();
  const ServerOptions& options = shared_.options;
  // A pause of this program itself: what the client sent during it has not been read yet.
  if (WasLate(timer_)) return GrantTime();
  if (phase_ == Phase::kHello) {
    Refused(v1::Refused::REASON_HELLO_TIMEOUT,
            "no Hello within " + Seconds(options.hello_deadline_s));
    return;
  }
  if (shared_.NowNs() - heard_ns_ > SecondsToNanoseconds(options.dead_after_s)) {
    End("nothing was heard from this client for " + Seconds(options.dead_after_s) +
        "; connect again");
    return;
  }
  if (!record_.ping.unanswered) {
    record_.ping = {record_.ping.id + 1, shared_.NowNs(), true};
    v1::Envelope message;
    message.mutable_ping()->set_id(record_.ping.id);
    message.mutable_ping()->set_t0_ns(record_.ping.sent_ns);
    Send(message);
  }
  if (connection_.open()) ArmTimer(options.ping_interval_s);
}

void Session::OnFrame(std::string_view payload) {
  if (guessing()) return;
  v1::Envelope message;
  if (!message.ParseFromArray(payload.data(), static_cast<int>(payload.size()))) {
    BadMessage("this is not a message of Footing's protocol");
    return;
  }
  if (phase_ != Phase::kHello) {
    Dispatch(message, heard_ns_);
  } else if (message.has_hello()) {
    OnHello(message.hello());
  } else {
    BadMessage("the first message must be Hello");
  }
}

void Session::Dispatch(const v1::Envelope& message, std::int64_t arrived_ns) {
  switch (message.body_case()) {
    case v1::Envelope::kSubscribe:
      return OnSubscribe(message.subscribe());
    case v1::Envelope::kRefill:
      return OnRefill(message.refill());
    case v1::Envelope::kPing:
      return OnPing(message.ping(), arrived_ns);
    case v1::Envelope::kPong:
      return record_.TakePong(message.pong(), arrived_ns);
    case v1::Envelope::kCommand:
      return OnCommand(message.command(), arrived_ns);
    case v1::Envelope::kDevice:
      return OnDevice(message.device(), arrived_ns);
    case v1::Envelope::BODY_NOT_SET:
      return;  // Message of a later minor version.
    case v1::Envelope::kHello:
      return BadMessage("Hello came twice");
    case v1::Envelope::kGoodbye:
      return End("goodbye");
    case v1::Envelope::kWelcome:
    case v1::Envelope::kRefused:
    case v1::Envelope::kSubscribed:
    case v1::Envelope::kCommandResult:
    case v1::Envelope::kTick:
    case v1::Envelope::kGap:
    case v1::Envelope::kNotice:
      return BadMessage("this message is the server's to send");
  }
}

void Session::OnPing(const v1::Ping& ping, std::int64_t arrived_ns) {
  v1::Envelope message;
  v1::Pong& pong = *message.mutable_pong();
  pong.set_id(ping.id());
  pong.set_t0_ns(ping.t0_ns());
  pong.set_t1_ns(arrived_ns);
  pong.set_t2_ns(shared_.NowNs());
  Send(message);
}

void Session::OnCommand(const v1::Command& command, std::int64_t arrived_ns) {
  connection_.Charge(kCommandCost - 1);
  if (const v1::CommandResult* first = answers_.Find(command.id())) {
    v1::Envelope message;
    *message.mutable_command_result() = *first;
    return Send(message);
  }
  if (open_commands_.contains(command.id())) return;  // Its answer is on its way.
  open_commands_.insert(command.id());
  if (auto result = Carry(command, arrived_ns)) {
    result->set_id(command.id());
    Answer(*result, !command.has_list_sessions());
  }
}

void Session::Answer(const v1::CommandResult& result, bool remember) {
  if (open_commands_.erase(result.id()) == 0 || !connection_.open()) return;
  if (remember) answers_.Remember(result);
  v1::Envelope message;
  *message.mutable_command_result() = result;
  Send(message);
}

std::optional<v1::CommandResult> Session::Carry(const v1::Command& command,
                                                std::int64_t arrived_ns) {
  v1::CommandResult failed;
  const std::uint32_t deadline_ms =
      command.deadline_ms() == 0 ? kDefaultDeadlineMs : command.deadline_ms();
  if (open_commands_.size() > kMaxQueuedAnswers) {
    failed.set_message("not carried out: too many commands of this session wait for the disk");
  } else if (const auto why = WhyNotPermitted(command, info_.role); !why.empty()) {
    failed.set_message(why);
  } else if (shared_.NowNs() - arrived_ns >
             std::int64_t{deadline_ms} * kNanosecondsPerMillisecond) {
    failed.set_message("not carried out: its deadline of " + std::to_string(deadline_ms) +
                       " ms had passed");
  } else if (IsOfServer(command) ? !shared_.on_own_command : !shared_.handlers.on_command) {
    failed.set_message(shared_.options.server_id + " takes no commands");
  } else if (const auto content = CheckContent(command); !content) {
    failed.set_message(content.error().message);
  } else if (IsOfServer(command)) {
    return shared_.on_own_command(info_, command, arrived_ns);
  } else {
    return shared_.handlers.on_command(info_, command);
  }
  return failed;
}

void Session::OnDevice(const v1::DeviceEnvelope& message, std::int64_t arrived_ns) {
  connection_.Charge((message.has_attach() ? kCommandCost : kDeviceCost) - 1);
  if (!shared_.handlers.on_device) {
    return BadMessage(shared_.options.server_id +
                      " takes no devices here; start footingd with --source stream:tls:HOST:PORT");
  }
  if (info_.role < v1::ROLE_CONTROL) {
    return BadMessage(
        "to attach devices a session needs the role control, and this one has a lower one: request "
        "control in Hello, with the server's token or a certificate for this role");
  }
  if (message.ByteSizeLong() > kMaxDeviceBytes) {
    return BadMessage("a message of a device has at most " + std::to_string(kMaxDeviceBytes) +
                      " bytes");
  }
  shared_.handlers.on_device(info_, arrived_ns, message);
}

void Session::SendDevice(const v1::DeviceEnvelope& message) {
  v1::Envelope envelope;
  *envelope.mutable_device() = message;
  connection_.Send(envelope.SerializeAsString());
}

void Session::SendPayload(std::string_view payload) {
  if (connection_.Send(payload) || !connection_.open()) return;
  End("this client does not read the answers it asked for: " + std::to_string(kMaxQueuedAnswers) +
      " wait");
}

void Session::Refused(v1::Refused::Reason reason, const std::string& message) {
  ++shared_.statistics.refused;
  // Who lacks a token or a certificate is said already (SayDenied).
  if (reason != v1::Refused::REASON_TOKEN) shared_.SayRefused(reason, peer_, message);
  phase_ = Phase::kRefused;
  timer_.cancel();
  v1::Envelope envelope;
  *envelope.mutable_refused() = Refuse(reason, message);
  connection_.Finish(envelope.SerializeAsString(), message);
}

void Session::BadMessage(const std::string& why) {
  if (guessing()) {
    AnswerGuess();
  } else if (phase_ == Phase::kHello) {
    Refused(v1::Refused::REASON_BAD_MESSAGE, why);
  } else {
    SayEnded(why);
    End(why);
  }
}

void Session::End(const std::string& reason) {
  timer_.cancel();
  v1::Envelope message;
  message.mutable_goodbye()->set_reason(reason);
  connection_.Finish(message.SerializeAsString(), reason);
}

/// The part of Session that lets a client in.
void Session::OnHello(const v1::Hello& hello) {
  const Caller caller{peer_, connection_.secured(), connection_.peer_fingerprint()};
  auto admission = Admit(shared_.options, {geteuid(), getegid()}, caller, hello, shared_.NowNs(),
                         shared_.admission);
  if (const auto* why = std::get_if<NotAdmitted>(&admission)) {
    if (why->lack != Lack::kNone) shared_.SayDenied(peer_.host, why->lack, why->lack_text);
    if (!why->waits) return Refused(why->answer.reason(), why->answer.message());
    phase_ = Phase::kGuessed;
    guess_answer_ = why->answer.message();
    return ArmTimer(shared_.options.wrong_token_wait_s);
  }
  admitted_ = std::get<Admitted>(std::move(admission));
  info_.client_name = admitted_.client_name;
  info_.role = admitted_.role;
  phase_ = Phase::kWelcomed;
  v1::Envelope message;
  *message.mutable_welcome() = MakeWelcome(shared_.options, shared_.epoch, info_.role);
  message.mutable_welcome()->set_host_ns(shared_.NowNs());
  message.mutable_welcome()->set_wall_time_ns(clock::WallNs());
  Send(message);
  ArmTimer(shared_.options.ping_interval_s);
}

void Session::GiveWay(const std::string& message) {
  if (guessing()) return AnswerGuess();
  Refused(v1::Refused::REASON_TOO_MANY_SESSIONS, message);
}

void Session::AnswerGuess() { Refused(v1::Refused::REASON_TOKEN, guess_answer_); }

/// The part of Session that says what slows it, and what all sessions share.
std::int64_t Shared::NowNs() const {
  return options.now_ns ? options.now_ns() : clock::MonotonicNs();
}

void Shared::SayOverload(const OverloadLine& line) {
  if (handlers.on_overload && overload_lines.Spend(NowNs())) handlers.on_overload(line);
}

void Shared::SayDenied(const std::string& host, Lack lack, const std::string& why) {
  ++statistics.denied;
  TokenBucket& lines = denied_lines.try_emplace(lack, 0.1, 1).first->second;
  if (!handlers.on_overload || !lines.Spend(NowNs())) return;
  handlers.on_overload({"refused a client from " + host + ": " + why + " (" +
                        std::to_string(statistics.denied) + " since start)"});
}

void Shared::SayRefused(v1::Refused::Reason reason, const Peer& peer, const std::string& why) {
  TokenBucket& lines = refused_lines.try_emplace(reason, 0.1, 1).first->second;
  if (!handlers.on_overload || !lines.Spend(NowNs())) return;
  const std::string who = peer.known ? "of user " + std::to_string(peer.user) : "from " + peer.host;
  handlers.on_overload({"refused a client " + who + ": " + why + " (" +
                        std::to_string(statistics.refused) + " since start)"});
}

void Session::SayEnded(const std::string& why) {
  if (!shared_.handlers.on_overload || !shared_.ended_lines.Spend(shared_.NowNs())) return;
  shared_.handlers.on_overload(
      {"session " + std::to_string(info_.session) + " (" + info_.client_name + ") is ended: " + why,
       info_.session});
}

void Session::OnSlowed(double wait_s) {
  ++record_.slowed;
  record_.slowed_until_ns = shared_.NowNs() + SecondsToNanoseconds(wait_s);
  ++shared_.statistics.slowed;
  const std::string name = info_.client_name.empty() ? "" : " (" + info_.client_name + ")";
  shared_.SayOverload({"session " + std::to_string(info_.session) + name + " sends more than " +
                           std::to_string(static_cast<int>(messages_per_s_)) +
                           " messages a second and is slowed",
                       info_.session});
  if (!welcomed() || !slowed_notices_.Spend(shared_.NowNs())) return;
  Notify(v1::Notice::KIND_SLOWED,
         "this client exceeds the server's rate limit; its messages are delayed", record_.slowed);
}

bool Session::SlowedLately(std::int64_t now_ns) const {
  const std::int64_t until_ns = record_.slowed_until_ns;
  return until_ns != 0 && now_ns - until_ns < kNanosecondsPerSecond;
}

int Session::PlaceInLine(std::int64_t now_ns) const {
  if (SlowedLately(now_ns)) return kLastPlace;
  return ticks_.subscription().max_hz > 0 ? 1 : 0;
}

void Session::Notify(v1::Notice::Kind kind, const std::string& text, std::uint64_t count) {
  if (!welcomed() || !connection_.open()) return;
  v1::Envelope message;
  message.mutable_notice()->set_kind(kind);
  message.mutable_notice()->set_text(text);
  message.mutable_notice()->set_count(count);
  Send(message);
}

namespace {

/// Unanswered requests to refill; each is a few bytes, but there must be an end.
constexpr std::size_t kMaxRefills = 16;
/// In messages: a snapshot is made and sent for it.
constexpr double kSubscribeCost = 20;
/// In messages, of a tick out of the ring: the whole ring of 3000 is within a session's burst.
constexpr double kReplayCost = 0.02;
constexpr int kReplayTicksInATurn = 32;

void AddGap(std::uint64_t from, std::uint64_t to, v1::Gap::Reason reason, WriteBatch& batch) {
  v1::Envelope message;
  message.mutable_gap()->set_from_sequence(from);
  message.mutable_gap()->set_to_sequence(to);
  message.mutable_gap()->set_reason(reason);
  batch.AddOwned(Frame(message.SerializeAsString()));
}

/// Adds the part of the hole in front of a tick that is not before `from`: the rest is known
/// already.
void AddMissing(const Tick& tick, std::uint64_t from, WriteBatch& batch) {
  from = std::max(from, tick.missing_from);
  if (tick.missing_from == 0 || from >= tick.sequence) return;
  AddGap(from, tick.sequence - 1, v1::Gap::REASON_UNSPECIFIED, batch);
}

}  // namespace

std::uint64_t TickStream::FirstSequence(const v1::Subscribe& wish) const {
  const std::uint64_t next = publication_.last_sequence() + 1;
  const bool resumes = wish.has_from_sequence() && wish.from_epoch() == epoch_;
  if (!resumes || wish.from_sequence() >= next) return next;
  const TickRing& ring = publication_.ring();
  const std::uint64_t oldest = ring.empty() ? next : ring.first();
  return std::max(wish.from_sequence(), oldest);
}

void TickStream::Begin(Subscription subscription, std::uint64_t first_sequence,
                       double tick_rate_hz) {
  dropped_before_ += queue_.dropped_ticks();
  subscription_ = std::move(subscription);
  queue_ = TickQueue(subscription_.rule, subscription_.queue_ticks, publication_.retained());
  decimator_.emplace(subscription_.max_hz, SecondsToNanoseconds(1 / tick_rate_hz));
  refills_.clear();
  catch_up_ = first_sequence <= publication_.last_sequence() ? first_sequence : 0;
}

TickStream::Offered TickStream::Offer(const SharedTick& tick) {
  if (catch_up_ != 0) return Offered::kFromRing;
  if (Takes(*tick)) return queue_.Push(tick) ? Offered::kQueued : Offered::kFull;
  queue_.Skip(tick);
  return Offered::kLeftOut;
}

/// For max_hz; the one behind a hole always comes, since the Gap comes with it.
bool TickStream::Takes(const Tick& tick) {
  const bool due = decimator_->Take(tick.host_ns);
  return due || tick.missing_from != 0;
}

bool TickStream::Refill(std::uint64_t first, std::uint64_t last) {
  if (refills_.size() >= kMaxRefills) return false;
  refills_.push_back({first, last});
  return true;
}

std::pair<std::size_t, const Tick*> TickStream::Waiting() const {
  if (catch_up_ == 0) return {queue_.size(), queue_.oldest()};
  const TickRing& ring = publication_.ring();
  const std::uint64_t next = ring.empty() ? catch_up_ : std::max(catch_up_, ring.first());
  const SharedTick* tick = ring.AtOrAfter(next);
  if (tick == nullptr) return {queue_.size(), queue_.oldest()};
  return {ring.CountFrom(next), tick->get()};
}

void TickStream::Add(const TickQueue::Entry& entry, bool refilled, WriteBatch& batch) {
  TickHead head;
  head.epoch = epoch_;
  head.refilled = refilled;
  AddTick(entry, subscription_, head, batch);
  ++sent_;
}

bool TickStream::FillLive(WriteBatch& batch) {
  TickQueue::Entry entry;
  if (!queue_.Pop(entry)) return false;
  const std::uint64_t missing = entry.tick->missing_from;
  if (const auto dropped = queue_.TakeDropped()) {
    const std::uint64_t to = missing != 0 ? entry.tick->sequence - 1 : dropped->to;
    AddGap(dropped->from, to, v1::Gap::REASON_QUEUE_FULL, batch);
  } else {
    AddMissing(*entry.tick, 0, batch);
  }
  Add(entry, false, batch);
  return true;
}

bool TickStream::FillCatchUp(WriteBatch& batch) {
  if (catch_up_ == 0) return false;
  const TickRing& ring = publication_.ring();
  if (catch_up_ > ring.last()) {
    catch_up_ = 0;
    return false;
  }
  if (catch_up_ < ring.first()) {  // It read so slowly that the ring went past it.
    AddGap(catch_up_, ring.first() - 1, v1::Gap::REASON_RING_PASSED, batch);
    catch_up_ = ring.first();
    return true;
  }
  const SharedTick& tick = *ring.AtOrAfter(catch_up_);
  const std::uint64_t from = std::exchange(catch_up_, tick->sequence + 1);
  if (Takes(*tick)) {
    AddMissing(*tick, from, batch);
    Add({tick, {}}, true, batch);
  } else {
    queue_.Skip(tick);
  }
  return true;
}

bool TickStream::FillRefill(WriteBatch& batch) {
  if (refills_.empty()) return false;
  Range& range = refills_.front();
  const TickRing& ring = publication_.ring();
  if (range.next < ring.first()) {
    const std::uint64_t gone = std::min(range.last, ring.first() - 1);
    AddGap(range.next, gone, v1::Gap::REASON_RING_PASSED, batch);
    range.next = gone + 1;
  } else {
    const SharedTick* tick = ring.AtOrAfter(range.next);
    range.next = range.last + 1;
    if (tick != nullptr && (*tick)->sequence <= range.last) {
      Add({*tick, {}}, true, batch);
      range.next = (*tick)->sequence + 1;
    }
  }
  if (range.next > range.last) refills_.pop_front();
  return true;
}

void Session::OnSubscribe(const v1::Subscribe& wish) {
  connection_.Charge(kSubscribeCost - 1);
  EffectiveSubscription settled = Settle(wish, shared_.options);
  const std::uint64_t first = ticks_.FirstSequence(wish);
  settled.answer.set_first_sequence(first);
  v1::Envelope message;
  *message.mutable_subscribed() = settled.answer;
  Send(message);

  ticks_.Begin(std::move(settled.subscription), first, shared_.options.tick_rate_hz);
  SendSnapshot(first - 1);
  if (wish.has_from_sequence()) {
    if (wish.from_epoch() != shared_.epoch) {
      SendGap(wish.from_sequence(), 0, v1::Gap::REASON_NEW_EPOCH);
    } else if (wish.from_sequence() != 0 && wish.from_sequence() < first) {
      SendGap(wish.from_sequence(), first - 1, v1::Gap::REASON_RING_PASSED);
    }
  }
  phase_ = Phase::kSubscribed;
  connection_.Wake();
}

void Session::SendSnapshot(std::uint64_t sequence) {
  const SharedTick tick = shared_.publication.Snapshot(sequence, shared_.NowNs());
  std::string fields;
  for (const Slice& slice : tick->slices) {
    if (ticks_.subscription().fields.count(slice.field) == 0) continue;
    fields.append(tick->bytes, slice.begin, slice.size);
  }
  TickHead head;
  head.epoch = shared_.epoch;
  head.sequence = tick->sequence;
  head.host_ns = tick->host_ns;
  head.snapshot = true;
  char bytes[kMaxTickHeadBytes];
  const std::size_t head_bytes = EncodeTickHead(head, fields.size(), bytes);
  fields.insert(0, bytes + kLengthBytes, head_bytes - kLengthBytes);
  SendPayload(fields);
}

void Session::SendGap(std::uint64_t from, std::uint64_t to, v1::Gap::Reason reason) {
  v1::Envelope message;
  message.mutable_gap()->set_from_sequence(from);
  message.mutable_gap()->set_to_sequence(to);
  message.mutable_gap()->set_reason(reason);
  Send(message);
}

void Session::OnRefill(const v1::Refill& wish) {
  if (phase_ != Phase::kSubscribed) return BadMessage("Refill came before Subscribe");
  const std::uint64_t last = std::min(wish.to_sequence(), shared_.publication.last_sequence());
  const std::uint64_t first = std::max<std::uint64_t>(wish.from_sequence(), 1);
  if (first > last) return SayNothingToRefill(wish);
  if (!ticks_.Refill(first, last)) {
    return End("this client asks for missing ticks faster than it reads them: " +
               std::to_string(kMaxRefills) +
               " Refills wait; send the next one after the ticks of "
               "an earlier one");
  }
  JoinReplays();
}

void Session::SayNothingToRefill(const v1::Refill& wish) {
  const std::string from = std::to_string(wish.from_sequence());
  Notify(v1::Notice::KIND_NOTHING_TO_REFILL,
         wish.from_sequence() > wish.to_sequence()
             ? "Refill: from_sequence " + from + " is above to_sequence " +
                   std::to_string(wish.to_sequence())
             : "Refill: tick " + from + " is not published yet; the newest is " +
                   std::to_string(shared_.publication.last_sequence()),
         wish.from_sequence());
}

void Session::Offer(const SharedTick& tick) {
  if (phase_ != Phase::kSubscribed || !connection_.open()) return;
  const std::uint64_t dropped_before = ticks_.dropped();
  switch (ticks_.Offer(tick)) {
    case TickStream::Offered::kLeftOut:
      return;
    case TickStream::Offered::kFromRing:
      return JoinReplays();
    case TickStream::Offered::kFull:
      return End("this client reads too slowly for the policy reliable: " +
                 std::to_string(ticks_.subscription().queue_ticks) +
                 " ticks wait; resume from the last sequence received, or use drop_oldest");
    case TickStream::Offered::kQueued:
      shared_.statistics.ticks_dropped += ticks_.dropped() - dropped_before;
      return connection_.Wake();
  }
}

void Session::Fill(WriteBatch& batch) {
  // A tick and a Gap in front of it.
  while (batch.free_buffers() > kBuffersPerTick) {
    if (ticks_.FillLive(batch)) continue;
    if (replay_allowance_ > 0 && ticks_.FillFromRing(batch)) {
      --replay_allowance_;
      connection_.Charge(kReplayCost);
      continue;
    }
    if (ticks_.wants_ring()) return JoinReplays();
    if (!record_.drain_reason.empty() && batch.empty()) EndLater();
    return;
  }
}

/// In turns with all other sessions, since the ring has far more ticks than the present.
void Session::JoinReplays() {
  if (replay_allowance_ > 0 || std::exchange(waits_to_replay_, true)) return;
  shared_.replays->Add([weak = weak_from_this()] {
    const auto self = weak.lock();
    if (!self) return false;
    self->waits_to_replay_ = false;
    self->replay_allowance_ = kReplayTicksInATurn;
    self->connection_.Wake();
    return false;
  });
}

void Session::Drain(const std::string& reason) {
  if (phase_ != Phase::kSubscribed || !connection_.open()) return End(reason);
  record_.drain_reason = reason;
  connection_.Wake();
}

/// Not from within the filling of a batch.
void Session::EndLater() {
  boost::asio::post(connection_.executor(), [weak = weak_from_this()] {
    if (const auto self = weak.lock()) self->End(self->record_.drain_reason);
  });
}

namespace {

constexpr int kMostListed = 500;  // Sessions in an answer: about 100 kB.
constexpr std::size_t kMostReasonBytes = 200;
/// The right token of a host that guesses must get in, so there may be more of these.
constexpr std::int64_t kMostLingeringGuesses = 4 * SessionTable::kMostLingering;

}  // namespace

std::int64_t SessionTable::lingering() const {
  return std::count_if(sessions_.begin(), sessions_.end(),
                       [](const auto& one) { return one->refused(); });
}

std::shared_ptr<Session> SessionTable::Remove(const Session& session) {
  const auto found = std::find_if(sessions_.begin(), sessions_.end(),
                                  [&](const auto& one) { return one.get() == &session; });
  std::shared_ptr<Session> removed = *found;
  sessions_.erase(found);
  return removed;
}

std::shared_ptr<Session> SessionTable::Find(std::uint64_t number) const {
  const auto found = std::find_if(sessions_.begin(), sessions_.end(),
                                  [&](const auto& one) { return one->info().session == number; });
  return found == sessions_.end() ? nullptr : *found;
}

std::size_t SessionTable::SetKeys(const AccessKeys& keys) {
  AccessKeys& own = shared_.options;
  std::vector<std::pair<std::shared_ptr<Session>, std::string>> revoked;
  for (const auto& session : sessions_) {
    if (!session->live()) continue;
    auto why = WhyRevoked(own, keys, session->admitted());
    if (!why.empty()) revoked.emplace_back(session, std::move(why));
  }
  if (keys.token != own.token || keys.view_token != own.view_token) {
    shared_.admission.token = TokenGuard(keys.token, keys.view_token);
  }
  own = keys;
  for (const auto& [session, why] : revoked) session->End(why);
  return revoked.size();
}

v1::CommandResult SessionTable::CarryOut(const SessionInfo& who, const v1::Command& command) {
  return command.has_end_sessions() ? End(who, command.end_sessions())
                                    : List(who, command.list_sessions().after());
}

SessionCounts SessionTable::CountsFor(const Session& one) const {
  SessionCounts taken;
  for (const auto& other : sessions_) {
    if (other->refused()) continue;
    const Peer &a = one.peer(), &b = other->peer();
    const bool entering = other->secured() && !other->welcomed();
    ++taken.all;
    taken.of_user += a.known == b.known && a.user == b.user ? 1 : 0;
    taken.entering_of_host += one.secured() && entering && a.host == b.host ? 1 : 0;
  }
  return taken;
}

/// The oldest guess of the host, or of any, has its answer now. False without one.
bool SessionTable::EndAGuess(const std::optional<std::string>& host) {
  const auto guess = std::find_if(sessions_.begin(), sessions_.end(), [&](const auto& one) {
    return one->guessing() && (!host || one->peer().host == *host);
  });
  if (guess == sessions_.end() || lingering() >= kMostLingeringGuesses) return false;
  (*guess)->AnswerGuess();
  return true;
}

/// Who came last may be quick where others stall: the oldest of the host gives way.
void SessionTable::BoundEntering(const Session& session) {
  const SessionLimits& limits = shared_.options.sessions;
  const std::string& host = session.peer().host;
  if (CountsFor(session).entering_of_host < limits.max_entering_per_host) return;
  if (lingering() >= kMostLingering) return;  // Each lingers for up to a second.
  const auto oldest = std::find_if(sessions_.begin(), sessions_.end(), [&](const auto& one) {
    return one->secured() && !one->welcomed() && !one->refused() && one->peer().host == host;
  });
  (*oldest)->GiveWay(shared_.options.server_id + " has " +
                     WhyNoPlace(limits, session.peer(), geteuid(), CountsFor(session)) +
                     "; end one or try again later");
}

std::string SessionTable::WhyFull(const Session& session) {
  const std::string& host = session.peer().host;
  const auto why = [&] {
    return WhyNoPlace(shared_.options.sessions, session.peer(), geteuid(), CountsFor(session));
  };
  BoundGuesses(host);
  BoundEntering(session);
  std::string full = why();
  if (!full.empty() && (EndAGuess(host) || EndAGuess(std::nullopt))) full = why();
  return full;
}

/// At most so many guesses of one host wait for their answers.
void SessionTable::BoundGuesses(const std::string& host) {
  const auto waiting = std::count_if(sessions_.begin(), sessions_.end(), [&](const auto& one) {
    return one->guessing() && one->peer().host == host;
  });
  if (waiting >= shared_.options.sessions.max_entering_per_host) EndAGuess(host);
}

v1::CommandResult SessionTable::List(const SessionInfo& who, std::uint64_t after) const {
  v1::CommandResult result;
  result.set_ok(true);
  for (const auto& session : sessions_) {  // In the order of their numbers.
    if (!session->live() || session->info().session <= after) continue;
    if (result.sessions_size() == kMostListed) {
      result.set_more_sessions(true);
      break;
    }
    *result.add_sessions() = session->Describe();
    const bool own = session->info().session == who.session;
    result.mutable_sessions()->rbegin()->set_own(own);
  }
  return result;
}

v1::CommandResult SessionTable::End(const SessionInfo& who, const v1::EndSessions& wish) {
  v1::CommandResult result;
  const std::set<std::uint64_t> numbers(wish.sessions().begin(), wish.sessions().end());
  if (who.role != v1::ROLE_ADMIN) {
    result.set_message(
        "end_sessions needs the role admin: connect over the server's Unix socket as its user or "
        "root, and request admin in Hello");
  } else if (numbers.empty() || wish.sessions_size() > kMostListed) {
    result.set_message("end_sessions names 1 to " + std::to_string(kMostListed) + " sessions");
  } else if (numbers.contains(who.session)) {
    result.set_message("end_sessions: session " + std::to_string(who.session) +
                       " is the one that asks; it ends when its client does");
  } else if (wish.reason().size() > kMostReasonBytes) {
    result.set_message("end_sessions: reason has at most " + std::to_string(kMostReasonBytes) +
                       " bytes");
  } else {
    result.set_ok(true);
    const std::string reason =
        "ended by an administrator" + (wish.reason().empty() ? "" : ": " + wish.reason());
    for (const auto& session : std::vector(sessions_)) {
      if (!session->live() || !numbers.contains(session->info().session)) continue;
      *result.add_sessions() = session->Describe();
      session->End(reason);
    }
  }
  return result;
}

void ReserveDescriptors(std::size_t count) {
  rlimit limit{};
  if (count == 0 || getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur == 0) return;
  const int any = open("/", O_PATH | O_CLOEXEC);
  if (any < 0) return;
  // The table never shrinks again.
  const auto last = static_cast<int>(std::min<rlim_t>(count, limit.rlim_cur) - 1);
  const int high = fcntl(any, F_DUPFD_CLOEXEC, last);
  if (high >= 0) close(high);
  close(any);
}

namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// The value of a field, or of the `index`-th of a repeated one.
class Value {
 public:
  Value(const Message& message, const FieldDescriptor* field, int index)
      : message_(message), with_(*message.GetReflection()), field_(field), index_(index) {}

  const Message& message() const {
    return repeated() ? with_.GetRepeatedMessage(message_, field_, index_)
                      : with_.GetMessage(message_, field_);
  }
  bool printable() const {
    return text::IsPrintable(repeated() ? with_.GetRepeatedString(message_, field_, index_)
                                        : with_.GetString(message_, field_));
  }
  bool finite_double() const {
    return std::isfinite(repeated() ? with_.GetRepeatedDouble(message_, field_, index_)
                                    : with_.GetDouble(message_, field_));
  }
  bool finite_float() const {
    return std::isfinite(repeated() ? with_.GetRepeatedFloat(message_, field_, index_)
                                    : with_.GetFloat(message_, field_));
  }

 private:
  bool repeated() const { return field_->is_repeated(); }

  const Message& message_;
  const google::protobuf::Reflection& with_;
  const FieldDescriptor* field_;
  int index_;
};

/// Problem of the first field that has one; empty: none. `within` names what `message` is.
std::string Problem(const Message& message, const std::string& within) {
  std::vector<const FieldDescriptor*> fields;
  message.GetReflection()->ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    const std::string name = within + std::string(field->name());
    const int count = field->is_repeated() ? message.GetReflection()->FieldSize(message, field) : 1;
    for (int i = 0; i < count; ++i) {
      const Value value(message, field, i);
      const auto type = field->type();
      if (type == FieldDescriptor::TYPE_MESSAGE) {
        const std::string inner = Problem(value.message(), name + ".");
        if (!inner.empty()) return inner;
      } else if (type == FieldDescriptor::TYPE_STRING && !value.printable()) {
        return name + " has control characters, which a text must not have";
      } else if ((type == FieldDescriptor::TYPE_DOUBLE && !value.finite_double()) ||
                 (type == FieldDescriptor::TYPE_FLOAT && !value.finite_float())) {
        return name + " is not a finite number";
      }
    }
  }
  return "";
}

}  // namespace

Result<void> CheckContent(const v1::Command& command) {
  if (command.has_set_interface()) {
    v1::SetInterface without_table = command.set_interface();
    without_table.clear_table();
    const std::string problem = Problem(without_table, "set_interface.");
    return problem.empty() ? Result<void>() : UsageError(problem);
  }
  const std::string problem = Problem(command, "");
  return problem.empty() ? Result<void>() : UsageError(problem);
}

}  // namespace footing::transport
