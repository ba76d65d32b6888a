#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/stream/device.h"

/// How a server fares: proto/footing/v1/stats.proto says what each field means.
namespace footing::stream {

struct TickStats {
  std::uint64_t ticks = 0;
  double rate_hz = 0;
  double late_max_s = 0;
  std::uint64_t overruns = 0;
  std::uint64_t left_out = 0;
};

struct SessionStats {
  std::uint64_t session = 0;
  std::string client_name;
  std::string role;
  bool local = false;
  double connected_s = 0;
  std::string policy;
  std::uint32_t queue_ticks = 0;
  std::uint32_t queue_capacity = 0;
  double lag_s = 0;
  std::uint64_t ticks_sent = 0;
  std::uint64_t ticks_dropped = 0;
  std::uint64_t slowed = 0;
  bool clock_valid = false;
  double clock_offset_s = 0;
  double clock_uncertainty_s = 0;
};

struct DeviceStats {
  std::uint32_t device = 0;
  std::string serial;
  DeviceKind kind = DeviceKind::kUnspecified;
  DeviceState state = DeviceState::kUnspecified;
  std::string rig;
  DeviceRole role = DeviceRole::kUnspecified;
  bool simulated = false;
  double report_rate_hz = 0;
  double jitter_s = 0;
  std::uint64_t reports = 0;
  std::uint64_t gaps = 0;
  std::uint64_t queue_drops = 0;
  std::uint64_t undecodable = 0;
  std::uint64_t writes_failed = 0;
  double battery_fraction = -1;
};

struct ServerStats {
  double uptime_s = 0;
  TickStats ticks;
  std::uint64_t session_count = 0;
  std::uint64_t sessions_accepted = 0;
  std::uint64_t sessions_refused = 0;
  std::uint64_t ticks_dropped = 0;
  std::uint64_t slowed = 0;
  std::uint64_t channels_left_out = 0;
  std::uint64_t ring_bytes = 0;
  std::vector<SessionStats> sessions;
  std::vector<DeviceStats> devices;
};

}  // namespace footing::stream
