#include "common/net/session.h"

#include <boost/asio/post.hpp>
#include <chrono>
#include <utility>

#include "common/runtime/clock.h"
#include "common/net/command_content.h"
#include "common/base/time.h"
#include "common/base/units.h"

namespace footing::transport {
namespace {

constexpr std::size_t kMaxQueuedAnswers = 64;
constexpr std::size_t kRememberedAnswers = 256;
constexpr double kCommandCost = 2;  // In messages.

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
bool ConcernsSessions(const v1::Command& command) {
  return command.has_list_sessions() || command.has_end_sessions();
}

std::chrono::nanoseconds Duration(double seconds) {
  return std::chrono::nanoseconds(SecondsToNanoseconds(seconds));
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
      answers_(kRememberedAnswers) {
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
  timer_.expires_after(Duration(seconds));
  timer_.async_wait([weak = weak_from_this()](const boost::system::error_code& error) {
    const auto self = weak.lock();
    if (!error && self) self->OnTimer();
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
    case v1::Envelope::BODY_NOT_SET:
      return;  // Of a later minor version.
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
  } else if (info_.role < v1::ROLE_CONTROL) {
    failed.set_message(
        "commands need the role control, and this session has a lower one: request control in "
        "Hello, over the server's Unix socket, or with its token or a certificate for this role");
  } else if (shared_.NowNs() - arrived_ns >
             std::int64_t{deadline_ms} * kNanosecondsPerMillisecond) {
    failed.set_message("not carried out: its deadline of " + std::to_string(deadline_ms) +
                       " ms had passed");
  } else if (ConcernsSessions(command) ? !shared_.on_sessions_command
                                       : !shared_.handlers.on_command) {
    failed.set_message(shared_.options.server_id + " takes no commands");
  } else if (const auto content = CheckContent(command); !content) {
    failed.set_message(content.error().message);
  } else if (ConcernsSessions(command)) {
    return shared_.on_sessions_command(info_, command);
  } else {
    return shared_.handlers.on_command(info_, command);
  }
  return failed;
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

}  // namespace footing::transport
