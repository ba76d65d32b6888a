#include "clients/web/foxglove_feed.h"

#include <algorithm>
#include <utility>

#include <openssl/evp.h>
#include <nlohmann/json.hpp>

#include "common/base/text.h"
#include "common/cli/cli.h"
#include "common/recording/recording_writer.h"

namespace footing::web {
namespace {

using nlohmann::json;

constexpr std::string_view kProtocols[] = {"foxglove.sdk.v1", "foxglove.websocket.v1"};
constexpr char kMessageData = 1;

template <typename Value>
void Append(Value value, std::string& to) {
  for (std::size_t i = 0; i < sizeof(value); ++i) {
    to += static_cast<char>(static_cast<unsigned char>(value >> (8 * i)));
  }
}

std::string InBase64(const std::string& bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');
  text.resize(static_cast<std::size_t>(EVP_EncodeBlock(
      reinterpret_cast<unsigned char*>(text.data()),
      reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()))));
  return text;
}

/// A number of the protocol; nothing where `from` has none by that name.
std::optional<std::uint32_t> NumberIn(const json& from, const char* name) {
  const auto found = from.is_object() ? from.find(name) : from.end();
  if (found == from.end() || !found->is_number_unsigned()) return std::nullopt;
  const auto value = found->get<std::uint64_t>();
  if (value > 0xffff'ffff) return std::nullopt;
  return static_cast<std::uint32_t>(value);
}

}  // namespace

std::string_view FoxgloveProtocol(std::string_view offered) {
  while (!offered.empty()) {
    const std::string_view name = text::Trim(offered.substr(0, offered.find(',')));
    for (const std::string_view known : kProtocols) {
      if (name == known) return known;
    }
    offered.remove_prefix(std::min(offered.find(','), offered.size() - 1) + 1);
  }
  return {};
}

FoxgloveFeed::FoxgloveFeed(const std::string& session)
    : scene_([this](const auto& topic, const auto& message, const auto& stamp) {
        return Write(topic, message, stamp);
      }) {
  texts_.push_back(json{
      {"op", "serverInfo"},
      {"name", std::string("Footing ") + cli::Version()},
      {"capabilities", json::array()},
      {"supportedEncodings", {"protobuf"}},
      {"metadata", json::object()},
      {"sessionId",
       session}}.dump());
}

Result<void> FoxgloveFeed::Take(std::string_view text) {
  const json said = json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!said.is_object() || !said.contains("op") || !said["op"].is_string()) {
    return InvalidData("a message is not a JSON object with \"op\"");
  }
  const auto op = said["op"].get<std::string>();
  if (op == "subscribe") {
    for (const json& one : said.value("subscriptions", json::array())) {
      const auto id = NumberIn(one, "id"), channel = NumberIn(one, "channelId");
      if (!id || !channel) return InvalidData("a subscription lacks \"id\" or \"channelId\"");
      Subscribe(*id, *channel);
    }
    return {};
  }
  if (op == "unsubscribe") {
    for (const json& id : said.value("subscriptionIds", json::array())) {
      if (id.is_number_unsigned()) subscriptions_.erase(id.get<std::uint32_t>());
    }
    return {};
  }
  Status("this server only sends; it does not know \"" + op.substr(0, 40) + "\"");
  return {};
}

void FoxgloveFeed::Subscribe(std::uint32_t id, std::uint32_t channel) {
  for (auto& [topic, known] : channels_) {
    if (known.id != channel) continue;
    if (subscriptions_.size() >= kMostSubscriptions) {
      return Status("more than " + std::to_string(kMostSubscriptions) + " subscriptions");
    }
    Subscription& subscription = subscriptions_[id];
    subscription.channel = &known;
    subscription.waiting.clear();
    // A track is sent once; who comes later needs it, too.
    if (!known.newest.empty()) subscription.waiting.push_back(known.newest);
    return;
  }
  Status("unknown channel " + std::to_string(channel));
}

void FoxgloveFeed::Status(const std::string& words) {
  constexpr int kWarning = 1;
  constexpr std::size_t kMostTexts = 1000;
  if (texts_.size() >= kMostTexts) return;
  texts_.push_back(json{{"op", "status"}, {"level", kWarning}, {"message", words}}.dump(
      -1, ' ', false, json::error_handler_t::replace));
}

void FoxgloveFeed::OnTick(const std::string& server, const v1::Tick& tick,
                          const recording::Stamp& stamp) {
  (void)scene_.OnTick(server, tick, stamp);  // Write() never fails.
}

FoxgloveFeed::Channel& FoxgloveFeed::Advertise(const std::string& topic,
                                               const google::protobuf::Message& message) {
  const auto [at, is_new] = channels_.try_emplace(topic);
  Channel& channel = at->second;
  if (!is_new) return channel;
  channel.id = static_cast<std::uint32_t>(channels_.size());
  channel.is_log = topic.ends_with("/log");
  const json advertised = {
      {"id", channel.id},
      {"topic", topic},
      {"encoding", "protobuf"},
      {"schemaName", message.GetDescriptor()->full_name()},
      {"schemaEncoding", "protobuf"},
      {"schema", InBase64(recording::DescribeWithImports(*message.GetDescriptor()))}};
  texts_.push_back(json{{"op", "advertise"}, {"channels", json::array({advertised})}}.dump());
  return channel;
}

Result<void> FoxgloveFeed::Write(const std::string& topic, const google::protobuf::Message& message,
                                 const recording::Stamp& stamp) {
  Channel& channel = Advertise(topic, message);
  channel.newest.clear();
  Append(static_cast<std::uint64_t>(stamp.log_ns), channel.newest);
  message.AppendToString(&channel.newest);
  for (auto& [id, subscription] : subscriptions_) {
    if (subscription.channel != &channel) continue;
    const std::size_t most = channel.is_log ? kMostLogs : 1;
    while (subscription.waiting.size() >= most) subscription.waiting.pop_front();
    subscription.waiting.push_back(channel.newest);
  }
  return {};
}

std::optional<FoxgloveFeed::Message> FoxgloveFeed::Next() {
  if (!texts_.empty()) {
    Message message{true, std::move(texts_.front())};
    texts_.pop_front();
    return message;
  }
  auto next = subscriptions_.upper_bound(sent_last_);
  for (std::size_t i = 0; i < subscriptions_.size(); ++i, ++next) {
    if (next == subscriptions_.end()) next = subscriptions_.begin();
    auto& [id, subscription] = *next;
    if (subscription.waiting.empty()) continue;
    sent_last_ = id;
    Message message{false, std::string(1, kMessageData)};
    Append(id, message.bytes);
    message.bytes += subscription.waiting.front();
    subscription.waiting.pop_front();
    return message;
  }
  return std::nullopt;
}

}  // namespace footing::web
