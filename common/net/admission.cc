#include "common/net/admission.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "common/base/result.h"

namespace footing::transport {
namespace {

void Set(std::vector<RetainedField>& retained, std::uint32_t field, const SharedTick& tick) {
  for (RetainedField& one : retained) {
    if (one.field == field) {
      one.tick = tick;
      return;
    }
  }
  retained.push_back({field, tick});
}

}  // namespace

TickQueue::TickQueue(QueueRule rule, std::size_t capacity, std::set<std::uint32_t> retained)
    : rule_(rule),
      capacity_(rule == QueueRule::kLatest ? 1 : std::max<std::size_t>(1, capacity)),
      retained_(std::move(retained)) {}

void TickQueue::Retain(const SharedTick& tick, std::vector<RetainedField>& retained) const {
  for (const Slice& slice : tick->slices) {
    if (retained_.count(slice.field) > 0) Set(retained, slice.field, tick);
  }
}

void TickQueue::Skip(const SharedTick& tick) { Retain(tick, for_next_); }

bool TickQueue::Push(SharedTick tick) {
  if (entries_.size() >= capacity_) {
    if (rule_ == QueueRule::kReliable) return false;
    Add(std::move(tick));
    DropOldest();
    return true;
  }
  Add(std::move(tick));
  return true;
}

void TickQueue::Add(SharedTick tick) {
  if (entries_.full()) entries_.set_capacity(std::max<std::size_t>(2, 2 * entries_.capacity()));
  entries_.push_back({std::move(tick), std::exchange(for_next_, {})});
}

void TickQueue::DropOldest() {
  Entry oldest = std::move(entries_.front());
  entries_.pop_front();
  const std::uint64_t sequence = oldest.tick->sequence;
  const std::uint64_t missing = oldest.tick->missing_from;
  dropped_ = Dropped{dropped_ ? dropped_->from : missing != 0 ? missing : sequence, sequence};
  ++dropped_ticks_;
  // Fields of the dropped one first, then its own, then those that its heir has already: the newest
  // stays.
  std::vector<RetainedField> retained = std::move(oldest.retained);
  Retain(oldest.tick, retained);
  Entry& heir = entries_.front();
  for (const RetainedField& one : heir.retained) Set(retained, one.field, one.tick);
  heir.retained = std::move(retained);
}

bool TickQueue::Pop(Entry& entry) {
  if (entries_.empty()) return false;
  entry = std::move(entries_.front());
  entries_.pop_front();
  return true;
}

namespace {

constexpr std::uint32_t kDefaultQueueTicks = 256;
constexpr double kSlowestHz = 0.001;

QueueRule RuleOf(v1::QueuePolicy policy) {
  switch (policy) {
    case v1::QUEUE_POLICY_LATEST:
      return QueueRule::kLatest;
    case v1::QUEUE_POLICY_RELIABLE:
      return QueueRule::kReliable;
    default:  // Unspecified, or one of a later minor version.
      return QueueRule::kDropOldest;
  }
}

void SettleChannels(const v1::Subscribe& wish, const ServerOptions& options,
                    EffectiveSubscription& settled) {
  const std::set<std::string> wished(wish.channels().begin(), wish.channels().end());
  std::set<std::string> unknown = wished;
  for (const Channel& channel : options.channels) {
    unknown.erase(channel.name);
    if (!wished.empty() && wished.count(channel.name) == 0) continue;
    settled.subscription.fields.insert(channel.field);
    settled.answer.add_channels(channel.name);
  }
  settled.subscription.all = settled.subscription.fields.size() == options.channels.size();
  for (const std::string& name : unknown) settled.answer.add_unknown_channels(name);
}

}  // namespace

std::string RoleName(v1::Role role) {
  switch (role) {
    case v1::ROLE_VIEW:
      return "view";
    case v1::ROLE_LOG:
      return "log";
    case v1::ROLE_CONTROL:
      return "control";
    case v1::ROLE_ADMIN:
      return "admin";
    default:
      return std::to_string(static_cast<int>(role));
  }
}

v1::Refused Refuse(v1::Refused::Reason reason, const std::string& message) {
  v1::Refused refused;
  refused.set_reason(reason);
  refused.set_message(message);
  return refused;
}

v1::Welcome MakeWelcome(const ServerOptions& options, std::uint64_t epoch, v1::Role role) {
  v1::Welcome welcome;
  welcome.set_server_id(options.server_id);
  welcome.set_version(options.version);
  welcome.set_epoch(epoch);
  welcome.set_protocol_major(kProtocolMajor);
  welcome.set_protocol_minor(kProtocolMinor);
  welcome.set_granted_role(role);
  for (const auto& capability : options.capabilities) welcome.add_capabilities(capability);
  for (const auto& channel : options.channels) welcome.add_channels(channel.name);
  v1::Limits& limits = *welcome.mutable_limits();
  limits.set_max_message_in_bytes(options.max_message_in_bytes);
  limits.set_max_message_out_bytes(options.max_message_out_bytes);
  limits.set_max_queue_ticks(options.max_queue_ticks);
  limits.set_ring_s(options.ring_s);
  limits.set_tick_rate_hz(options.tick_rate_hz);
  limits.set_max_messages_per_s(options.sessions.session_messages_per_s);
  limits.set_max_message_burst(static_cast<std::uint32_t>(options.sessions.Input().message_burst));
  return welcome;
}

EffectiveSubscription Settle(const v1::Subscribe& wish, const ServerOptions& options) {
  EffectiveSubscription settled;
  SettleChannels(wish, options, settled);
  Subscription& subscription = settled.subscription;
  const bool slower = wish.max_hz() > 0 && wish.max_hz() < options.tick_rate_hz;
  subscription.max_hz = slower ? std::max(wish.max_hz(), kSlowestHz) : 0;
  subscription.rule = RuleOf(wish.policy());
  const std::uint32_t queue = wish.queue_ticks() == 0 ? kDefaultQueueTicks : wish.queue_ticks();
  subscription.queue_ticks =
      subscription.rule == QueueRule::kLatest ? 1 : std::min(queue, options.max_queue_ticks);
  subscription.max_channel_bytes = options.max_message_out_bytes - kMaxTickHeadBytes;
  settled.answer.set_max_hz(slower ? subscription.max_hz : options.tick_rate_hz);
  settled.answer.set_policy(static_cast<v1::QueuePolicy>(subscription.rule));
  settled.answer.set_queue_ticks(static_cast<std::uint32_t>(subscription.queue_ticks));
  return settled;
}

void WriteBatch::AddOwned(std::string bytes) {
  FOOTING_CHECK(free_buffers() > 0);
  if (bytes.size() <= kHeadBytes) {
    AddHead(bytes.data(), bytes.size());
    return;
  }
  owned_.push_back(std::make_unique<const std::string>(std::move(bytes)));
  buffers_.emplace_back(owned_.back()->data(), owned_.back()->size());
}

void WriteBatch::AddHead(const char* bytes, std::size_t size) {
  FOOTING_CHECK(free_buffers() > 0 && size <= kHeadBytes);
  auto& head = heads_[heads_used_++];
  std::copy(bytes, bytes + size, head.begin());
  buffers_.emplace_back(head.data(), size);
}

void WriteBatch::AddShared(std::shared_ptr<const void> owner, const char* bytes, std::size_t size) {
  FOOTING_CHECK(free_buffers() > 0);
  if (shared_.empty() || shared_.back() != owner) shared_.push_back(std::move(owner));
  buffers_.emplace_back(bytes, size);
}

void WriteBatch::Consume(std::size_t bytes) {
  while (first_ < buffers_.size() && bytes >= buffers_[first_].size()) {
    bytes -= buffers_[first_].size();
    ++first_;
  }
  if (first_ < buffers_.size()) {
    buffers_[first_] += bytes;
    return;
  }
  buffers_.clear();
  first_ = 0;
  heads_used_ = 0;
  owned_.clear();
  shared_.clear();
}

std::unique_ptr<WriteBatch> BatchPool::Take() {
  if (free_.empty()) return std::make_unique<WriteBatch>();
  std::unique_ptr<WriteBatch> batch = std::move(free_.back());
  free_.pop_back();
  return batch;
}

void BatchPool::Give(std::unique_ptr<WriteBatch> batch) {
  constexpr std::size_t kMaxFree = 16;
  FOOTING_CHECK(batch->empty());
  if (free_.size() < kMaxFree) free_.push_back(std::move(batch));
}

namespace {

/// A stretch of one tick's bytes.
struct Piece {
  const SharedTick* tick = nullptr;
  std::size_t begin = 0;
  std::size_t size = 0;
};

void Add(const SharedTick& tick, const Slice& slice, std::vector<Piece>& pieces) {
  if (!pieces.empty()) {
    Piece& last = pieces.back();
    if (last.tick->get() == tick.get() && last.begin + last.size == slice.begin) {
      last.size += slice.size;  // Neighbours go out as one.
      return;
    }
  }
  pieces.push_back({&tick, slice.begin, slice.size});
}

std::vector<Piece> PiecesOf(const TickQueue::Entry& entry, const Subscription& subscription) {
  std::vector<Piece> pieces;
  for (const Slice& slice : entry.tick->slices) {
    if (subscription.fields.count(slice.field) > 0) Add(entry.tick, slice, pieces);
  }
  std::size_t size = entry.tick->fields().size();
  for (const RetainedField& retained : entry.retained) {
    const bool wanted = subscription.fields.count(retained.field) > 0;
    if (!wanted || entry.tick->Find(retained.field) != nullptr) continue;
    const Slice& slice = *retained.tick->Find(retained.field);
    if (size + slice.size > subscription.max_channel_bytes) continue;
    size += slice.size;
    Add(retained.tick, slice, pieces);
  }
  return pieces;
}

void AddHead(const TickHead& head, std::size_t channel_bytes, WriteBatch& batch) {
  char bytes[kMaxTickHeadBytes];
  batch.AddHead(bytes, EncodeTickHead(head, channel_bytes, bytes));
}

}  // namespace

void AddTick(const TickQueue::Entry& entry, const Subscription& subscription, TickHead head,
             WriteBatch& batch) {
  static_assert(kMaxTickHeadBytes <= WriteBatch::kHeadBytes);
  head.sequence = entry.tick->sequence;
  head.host_ns = entry.tick->host_ns;
  if (subscription.all && entry.retained.empty()) {  // The usual case.
    const std::string& bytes = entry.tick->bytes;
    if (!head.refilled) return batch.AddShared(entry.tick, bytes.data(), bytes.size());
    const std::string_view fields = entry.tick->fields();
    AddHead(head, fields.size(), batch);
    if (!fields.empty()) batch.AddShared(entry.tick, fields.data(), fields.size());
    return;
  }
  const std::vector<Piece> pieces = PiecesOf(entry, subscription);
  std::size_t size = 0;
  for (const Piece& piece : pieces) size += piece.size;
  AddHead(head, size, batch);
  if (pieces.size() < kBuffersPerTick) {
    for (const Piece& piece : pieces) {
      batch.AddShared(*piece.tick, (*piece.tick)->bytes.data() + piece.begin, piece.size);
    }
    return;
  }
  std::string copied;
  copied.reserve(size);
  for (const Piece& piece : pieces) copied.append((*piece.tick)->bytes, piece.begin, piece.size);
  batch.AddOwned(std::move(copied));
}

namespace {

constexpr std::size_t kMostNameBytes = 64;

std::string VersionText(std::uint32_t major, std::uint32_t minor) {
  return std::to_string(major) + "." + std::to_string(minor);
}

NotAdmitted Without(v1::Refused::Reason reason, const std::string& message) {
  return {Refuse(reason, message)};
}

/// Without a right token or a known certificate.
NotAdmitted Unproved(const std::string& message, Lack lack, const std::string& lack_text,
                     bool waits = false) {
  return {Refuse(v1::Refused::REASON_TOKEN, message), lack, lack_text, waits};
}

std::string HowToComeIn(const ServerOptions& options, const Caller& caller) {
  if (!caller.secured) {
    return "this server wants its token: FOOTING_TOKEN_FILE=FILE names it, and "
           "FOOTING_INSECURE_LAN=1 allows a client to send it without encryption";
  }
  std::string text = "this server wants";
  if (options.has_token()) text += " its token, which FOOTING_TOKEN_FILE=FILE names";
  if (options.has_token() && !options.clients.empty()) text += ", or";
  if (!options.clients.empty()) {
    text += caller.certificate.empty()
                ? " a certificate that it knows; footing-ctl trust --client makes one"
                : " a certificate that it knows; it does not know yours, " + caller.certificate;
  }
  return text;
}

std::string HowToGetMore(const ServerOptions& options, Grant grant) {
  if (grant == Grant::kCertificate) {
    return "the server's clients_file gives this client's certificate that role: change it there";
  }
  if (grant == Grant::kViewToken) {
    return "it came with the token of the server's view_token_file; that of its token_file gives "
           "control";
  }
  return std::string(
             "connect over the server's Unix socket as its user (admin) or as a member of its "
             "group (control)") +
         (options.token.empty() ? ", or give the server a token_file, and the client its token"
                                : ", or over TCP with the server's token (control)");
}

/// Refusal that says how an administrator lets in a client whose certificate the server does not
/// know.
NotAdmitted UnknownCertificate(const ServerOptions& options, const Caller& caller) {
  return Unproved(HowToComeIn(options, caller), Lack::kKnownCertificate,
                  "its certificate is not in the clients_file; to let it in add the line \"" +
                      caller.certificate +
                      " view\" there and reload (footing-ctl trust --client prints it)");
}

/// The highest role of a caller, and by what it has it.
struct Known {
  v1::Role highest = v1::ROLE_UNSPECIFIED;
  Grant grant = Grant::kAddress;
};

/// Who the caller is, or why it may not come in.
std::variant<Known, NotAdmitted> Authenticate(const ServerOptions& options, const ServerUser& own,
                                              const Caller& caller, const std::string& token,
                                              std::int64_t now_ns, TokenGuard& guard) {
  const v1::Role without_proof = HighestRole(caller.peer, own.user, own.group);
  if (caller.peer.known) return Known{without_proof, Grant::kUser};  // The kernel vouches for it.
  if (const auto known = options.clients.find(caller.certificate); known != options.clients.end()) {
    return Known{known->second, Grant::kCertificate};
  }
  const bool needs_proof = options.insecure_lan || caller.secured;
  if (token.empty() || !options.has_token()) {
    if (!needs_proof) return Known{without_proof, Grant::kAddress};
    if (!caller.certificate.empty()) return UnknownCertificate(options, caller);
    return Unproved(HowToComeIn(options, caller), Lack::kAnyProof,
                    caller.secured ? "neither a token nor a certificate" : "no token");
  }
  const TokenGuard::Verdict verdict = guard.Check(token, caller.peer.host, now_ns);
  if (verdict.role == v1::ROLE_CONTROL) return Known{v1::ROLE_CONTROL, Grant::kToken};
  if (verdict.role == v1::ROLE_VIEW) {
    // It takes away nothing that this host's users have without it.
    return Known{needs_proof ? v1::ROLE_VIEW : without_proof, Grant::kViewToken};
  }
  const std::string text =
      "the token is wrong; compare the file that FOOTING_TOKEN_FILE names with the server's";
  return Unproved(text, Lack::kRightToken, "wrong token", verdict.waits);
}

/// Another minor version is fine: both sides leave out what they do not know.
std::optional<NotAdmitted> CheckVersion(const ServerOptions& options, const v1::Hello& hello) {
  if (hello.protocol_major() == kProtocolMajor) return std::nullopt;
  if (hello.protocol_major() == 0) {
    return Without(v1::Refused::REASON_PROTOCOL_VERSION,
                   "Hello has no protocol_major: send " + std::to_string(kProtocolMajor) +
                       " for protocol " + VersionText(kProtocolMajor, kProtocolMinor));
  }
  const bool client_older = hello.protocol_major() < kProtocolMajor;
  return Without(v1::Refused::REASON_PROTOCOL_VERSION,
                 options.server_id + " speaks protocol " +
                     VersionText(kProtocolMajor, kProtocolMinor) + ", this client " +
                     VersionText(hello.protocol_major(), hello.protocol_minor()) + "; update the " +
                     (client_older ? "client" : "server"));
}

std::optional<NotAdmitted> CheckRole(const ServerOptions& options, v1::Role wished,
                                     const Known& known) {
  // An enum of the protocol may have any number, a negative one as well.
  if (wished >= v1::ROLE_VIEW && wished <= known.highest) return std::nullopt;
  if (!v1::Role_IsValid(wished)) {
    return Without(v1::Refused::REASON_ROLE,
                   "Hello has the unknown role " + std::to_string(wished) +
                       "; there are 1 (view), 2 (log), 3 (control) and 4 (admin)");
  }
  return Without(v1::Refused::REASON_ROLE,
                 "the role " + RoleName(wished) + " is not given to this connection, at most " +
                     RoleName(known.highest) + "; " + HowToGetMore(options, known.grant));
}

}  // namespace

std::string Name(Grant grant) {
  switch (grant) {
    case Grant::kAddress:
      return "address";
    case Grant::kUser:
      return "user";
    case Grant::kCertificate:
      return "certificate";
    case Grant::kToken:
      return "token";
    case Grant::kViewToken:
      return "view_token";
  }
  return "";
}

Admission Admit(const ServerOptions& options, const ServerUser& own, const Caller& caller,
                const v1::Hello& hello, std::int64_t now_ns, AdmissionState& state) {
  auto answer = Authenticate(options, own, caller, hello.token(), now_ns, state.token);
  if (auto* unknown = std::get_if<NotAdmitted>(&answer)) return std::move(*unknown);
  const auto& known = std::get<Known>(answer);
  const v1::Role wished = hello.role() == v1::ROLE_UNSPECIFIED ? v1::ROLE_VIEW : hello.role();
  if (auto other = CheckVersion(options, hello)) return std::move(*other);
  if (auto too_high = CheckRole(options, wished, known)) return std::move(*too_high);
  Admitted admitted{wished, known.highest, PlainName(hello.client_name()), known.grant};
  const bool by_certificate = known.grant == Grant::kCertificate;
  admitted.claim = {wished, !caller.peer.known, caller.peer.host,
                    by_certificate ? caller.certificate : ""};
  if (admitted.may_administer()) return admitted;
  const auto taken = state.places.WhyNotOneMore(options.sessions, admitted.claim);
  if (!taken.empty()) {
    return Without(v1::Refused::REASON_TOO_MANY_SESSIONS,
                   options.server_id + " has " + taken + "; end one or try again later");
  }
  state.places.Add(admitted.claim);
  return admitted;
}

void Leave(const Admitted& admitted, AdmissionState& state) {
  if (!admitted.may_administer()) state.places.Remove(admitted.claim);
}

std::string WhyRevoked(const AccessKeys& before, const AccessKeys& now, const Admitted& admitted) {
  const auto changed = [](const std::string& file, const std::string& then_token,
                          const std::string& now_token) -> std::string {
    if (then_token == now_token) return "";
    return now_token.empty() ? "revoked: the server has no " + file + " any more"
                             : "revoked: the token in the server's " + file +
                                   " was replaced; copy the new one to this client";
  };
  switch (admitted.grant) {
    case Grant::kAddress:
    case Grant::kUser:
      return "";
    case Grant::kToken:
      return changed("token_file", before.token, now.token);
    case Grant::kViewToken:
      return changed("view_token_file", before.view_token, now.view_token);
    case Grant::kCertificate:
      break;
  }
  const std::string& certificate = admitted.claim.certificate;
  const auto known = now.clients.find(certificate);
  if (known == now.clients.end()) {
    return "revoked: this client's certificate " + certificate +
           " was removed from the server's clients_file";
  }
  if (admitted.role <= known->second) return "";
  return "revoked: the server's clients_file gives this client's certificate only the role " +
         RoleName(known->second) + " now";
}

std::string PlainName(std::string name) {
  name.resize(std::min(name.size(), kMostNameBytes));
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return name;
}

}  // namespace footing::transport
