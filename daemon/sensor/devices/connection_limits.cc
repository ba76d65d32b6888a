#include "daemon/sensor/devices/connection_limits.h"

namespace footing::devices {
namespace {

constexpr std::int64_t kAdminPlaces = 8;
/// 16 devices of 200 reports a second take two thirds.
constexpr transport::InputBudget kBudget = {5000, 5000, 1 << 20, 1 << 20};

}  // namespace

transport::FramedLimits LimitsOfOne() {
  transport::FramedLimits limits;
  limits.max_in_bytes = kMaxEnvelopeBytes;
  limits.max_out_bytes = kMaxEnvelopeBytes;
  limits.max_queued_bytes = 64 * kMaxEnvelopeBytes;
  limits.input = kBudget;
  return limits;
}

void ConnectionCounts::Add(const transport::Peer& there, const transport::Peer& comes) {
  ++all;
  if (there.known == comes.known && there.user == comes.user) ++of_user;
}

std::string WhyNoConnection(const ConnectionLimits& limits, const transport::Peer& peer,
                            uid_t own_user, const ConnectionCounts& taken) {
  const bool admin = peer.known && (peer.user == own_user || peer.user == 0);
  const std::int64_t places = limits.max_connections + (admin ? kAdminPlaces : 0);
  if (taken.all >= places) {
    return "the device socket has " + std::to_string(taken.all) +
           " connections already (max_device_connections); end one, or attach more devices over it";
  }
  if (admin || taken.of_user < limits.max_connections_per_user) return "";
  return "the device socket has " + std::to_string(taken.of_user) + " connections " +
         (peer.known ? "of this user" : "over TCP") +
         " already (max_device_connections_per_user); end one, or attach more devices over it";
}

}  // namespace footing::devices
