#include "clients/relay/requests.h"

#include "common/base/json_text.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace footing::relay::nats {

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
