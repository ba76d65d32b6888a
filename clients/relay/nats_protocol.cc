#include "clients/relay/nats_protocol.h"

#include <algorithm>
#include <charconv>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/json_text.h"

namespace footing::relay::nats {
namespace {

constexpr std::string_view kEnd = "\r\n";
constexpr std::string_view kBlanks = " \t";
constexpr std::string_view kStatusLine = "NATS/1.0 ";

/// Takes the first word off `text`; empty when there is none.
std::string_view PopWord(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  const std::size_t end = std::min(text.find_first_of(kBlanks), text.size());
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(end);
  return word;
}

template <typename Number>
bool ParseNumber(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

Error Wrong(std::string_view what) {
  constexpr std::size_t kShown = 80;
  return InvalidData("not NATS: " + std::string(what.substr(0, kShown)));
}

Result<ServerInfo> ParseInfo(std::string_view text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) return Wrong("INFO without an object");
  ServerInfo info;
  const auto flag = [&](const char* key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_boolean() && found->get<bool>();
  };
  info.auth_required = flag("auth_required");
  info.tls_required = flag("tls_required");
  if (const auto found = json.find("max_payload"); found != json.end()) {
    if (!found->is_number_unsigned()) return Wrong("INFO with a wrong max_payload");
    info.max_payload = found->get<std::size_t>();
  }
  if (const auto found = json.find("version"); found != json.end() && found->is_string()) {
    info.version = found->get<std::string>();
  }
  return info;
}

}  // namespace

Result<void> Parser::Take(std::string_view bytes, const Handlers& handlers) {
  buffer_.append(bytes);
  std::size_t used = 0;
  while (used < buffer_.size()) {
    const auto step = Step(std::string_view(buffer_).substr(used), handlers);
    if (!step) return step.error();
    if (*step == 0) break;
    used += *step;
  }
  buffer_.erase(0, used);
  return {};
}

Result<std::size_t> Parser::Step(std::string_view rest, const Handlers& handlers) {
  if (waits_for_payload_) return OnPayload(rest, handlers);
  const std::size_t end = rest.find(kEnd);
  if (std::min(end, rest.size()) > kMaxLineBytes) return Wrong("a line without an end");
  if (end == std::string_view::npos) return std::size_t{0};
  if (auto taken = OnLine(rest.substr(0, end), handlers); !taken) return taken.error();
  return end + kEnd.size();
}

Result<void> Parser::OnLine(std::string_view line, const Handlers& handlers) {
  std::string_view words = line;
  const std::string_view name = PopWord(words);
  if (name == "MSG") return OnAnnounced(words, false);
  if (name == "HMSG") return OnAnnounced(words, true);
  if (name == "PING") {
    handlers.on_ping();
  } else if (name == "PONG") {
    handlers.on_pong();
  } else if (name == "INFO") {
    const auto info = ParseInfo(words);
    if (!info) return info.error();
    handlers.on_info(*info);
  } else if (name == "-ERR") {
    const std::size_t begin = std::min(words.find_first_not_of(" '"), words.size());
    const std::size_t end = words.find_last_not_of(" '");
    handlers.on_error(begin < words.size() ? words.substr(begin, end + 1 - begin) : words);
  } else if (name != "+OK") {
    return Wrong(line);
  }
  return {};
}

Result<void> Parser::OnAnnounced(std::string_view words, bool has_header) {
  std::vector<std::string_view> parts;
  constexpr std::size_t kMostParts = 5;
  for (std::string_view word = PopWord(words); !word.empty(); word = PopWord(words)) {
    if (parts.size() == kMostParts) return Wrong("a message of too many parts");
    parts.push_back(word);
  }
  const std::size_t numbers = has_header ? 2 : 1;
  if (parts.size() != 2 + numbers && parts.size() != 3 + numbers) {
    return Wrong("a message without its parts");
  }
  announced_ = {};
  announced_.subject = parts[0];
  if (parts.size() == 3 + numbers) announced_.reply = parts[2];
  const bool right = ParseNumber(parts[1], announced_.subscription) &&
                     ParseNumber(parts.back(), announced_.total_bytes) &&
                     (!has_header || ParseNumber(parts[parts.size() - 2], announced_.header_bytes));
  if (!right || announced_.header_bytes > announced_.total_bytes) {
    return Wrong("a message with wrong numbers");
  }
  if (announced_.total_bytes > max_payload_) {
    return InvalidData("NATS announces a message of " + std::to_string(announced_.total_bytes) +
                       " bytes; at most " + std::to_string(max_payload_) + " are taken");
  }
  waits_for_payload_ = true;
  return {};
}

Result<std::size_t> Parser::OnPayload(std::string_view rest, const Handlers& handlers) {
  const std::size_t total = announced_.total_bytes;
  if (rest.size() < total + kEnd.size()) return std::size_t{0};
  if (rest.substr(total, kEnd.size()) != kEnd) return Wrong("a message without its end");
  Message message;
  message.subject = announced_.subject;
  message.subscription = announced_.subscription;
  message.reply = announced_.reply;
  message.payload = rest.substr(announced_.header_bytes, total - announced_.header_bytes);
  const std::string_view header = rest.substr(0, announced_.header_bytes);
  message.no_responders =
      header.starts_with(kStatusLine) && header.substr(kStatusLine.size()).starts_with("503");
  waits_for_payload_ = false;
  handlers.on_message(message);
  return total + kEnd.size();
}

std::string Connect(const std::string& client_name, const Login& login) {
  nlohmann::ordered_json options = {{"verbose", false},     {"pedantic", false}, {"lang", "c++"},
                                    {"name", client_name},  {"headers", true},   {"echo", false},
                                    {"no_responders", true}};
  if (!login.token.empty()) options["auth_token"] = login.token;
  if (!login.user.empty()) {
    options["user"] = login.user;
    options["pass"] = login.password;
  }
  // A name need not be UTF-8.
  return "CONNECT " + text::ToText(options) + "\r\n";
}

std::string Subscribe(const std::string& subject, std::uint64_t subscription) {
  return "SUB " + subject + " " + std::to_string(subscription) + "\r\n";
}

std::string Publish(const std::string& subject, const std::string& reply,
                    std::string_view payload) {
  std::string bytes = "PUB " + subject + " ";
  if (!reply.empty()) bytes += reply + " ";
  bytes += std::to_string(payload.size()) + "\r\n";
  bytes.append(payload);
  return bytes += "\r\n";
}

bool IsPart(std::string_view text) {
  constexpr std::size_t kLongest = 64;
  return !text.empty() && text.size() <= kLongest &&
         std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  c == '-' || c == '_';
         });
}

}  // namespace footing::relay::nats
