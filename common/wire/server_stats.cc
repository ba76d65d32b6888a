#include "common/wire/fields.h"

namespace footing::wire {
namespace {

v1::TickStats ToProto(const stream::TickStats& value);
stream::TickStats FromProto(const v1::TickStats& message);
v1::DeviceStats ToProto(const stream::DeviceStats& value);
stream::DeviceStats FromProto(const v1::DeviceStats& message);

template <typename Way>
void Fields(Way way, const stream::TickStats&) {
  FOOTING_FIELD(ticks);
  FOOTING_FIELD(rate_hz);
  FOOTING_FIELD(late_max_s);
  FOOTING_FIELD(overruns);
  FOOTING_FIELD(left_out);
}
FOOTING_BOTH_WAYS(TickStats)

template <typename Way>
void Fields(Way way, const stream::DeviceStats&) {
  FOOTING_FIELD(device);
  FOOTING_FIELD(serial);
  FOOTING_ENUM(DeviceKind, kind);
  FOOTING_ENUM(DeviceState, state);
  FOOTING_FIELD(rig);
  FOOTING_ENUM(DeviceRole, role);
  FOOTING_FIELD(simulated);
  FOOTING_FIELD(report_rate_hz);
  FOOTING_FIELD(jitter_s);
  FOOTING_FIELD(reports);
  FOOTING_FIELD(gaps);
  FOOTING_FIELD(queue_drops);
  FOOTING_FIELD(undecodable);
  FOOTING_FIELD(writes_failed);
  FOOTING_FIELD(battery_fraction);
}
FOOTING_BOTH_WAYS(DeviceStats)

}  // namespace

template <typename Way>
void Fields(Way way, const stream::SessionStats&) {
  FOOTING_FIELD(session);
  FOOTING_FIELD(client_name);
  FOOTING_FIELD(role);
  FOOTING_FIELD(local);
  FOOTING_FIELD(connected_s);
  FOOTING_FIELD(policy);
  FOOTING_FIELD(queue_ticks);
  FOOTING_FIELD(queue_capacity);
  FOOTING_FIELD(lag_s);
  FOOTING_FIELD(ticks_sent);
  FOOTING_FIELD(ticks_dropped);
  FOOTING_FIELD(slowed);
  FOOTING_FIELD(clock_valid);
  FOOTING_FIELD(clock_offset_s);
  FOOTING_FIELD(clock_uncertainty_s);
}
FOOTING_BOTH_WAYS(SessionStats)

template <typename Way>
void Fields(Way way, const stream::ServerStats&) {
  FOOTING_FIELD(uptime_s);
  FOOTING_MESSAGE(ticks);
  FOOTING_FIELD(session_count);
  FOOTING_FIELD(sessions_accepted);
  FOOTING_FIELD(sessions_refused);
  FOOTING_FIELD(ticks_dropped);
  FOOTING_FIELD(slowed);
  FOOTING_FIELD(channels_left_out);
  FOOTING_FIELD(ring_bytes);
  FOOTING_REPEATED(sessions);
  FOOTING_REPEATED(devices);
}
FOOTING_BOTH_WAYS(ServerStats)

}  // namespace footing::wire
