#pragma once

#include <cstdint>
#include <string>
#include <string_view>

/// What a client of NATS sends.
namespace footing::relay::nats {

/// By what it shows that it may come in; all empty: by nothing.
struct Login {
  std::string user;
  std::string password;
  std::string token;
};

std::string Connect(const std::string& client_name, const Login& login);
std::string Subscribe(const std::string& subject, std::uint64_t subscription);
/// A message; `reply` may be empty.
std::string Publish(const std::string& subject, const std::string& reply, std::string_view payload);

/// Whether it can be one part of a subject, and of a topic of MQTT: 1 to 64 letters, digits, - and
/// _.
bool IsPart(std::string_view text);

}  // namespace footing::relay::nats
