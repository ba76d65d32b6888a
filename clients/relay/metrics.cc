#include "clients/relay/metrics.h"

#include "common/net/metrics_writer.h"

namespace footing::relay {
namespace {

using monitoring::Braced;
using monitoring::MetricsWriter;

std::uint64_t Number(bool value) { return value ? 1 : 0; }

void WriteTicks(std::uint64_t ticks, std::uint64_t missing, MetricsWriter& to) {
  to.Counter("footing_relay_ticks_total", "Ticks received.");
  to.Sample(ticks);
  to.Counter("footing_relay_ticks_missing_total", "Ticks that never arrived; viewers get a Gap.");
  to.Sample(missing);
}

void BeginBrokers(MetricsWriter& to) {
  to.Gauge("footing_relay_broker_up", "1 while the broker is connected.");
}

}  // namespace

std::string MetricsText(const PublisherReport& report, const std::string& version) {
  MetricsWriter to;
  monitoring::WriteProgram({"footing-relay", version}, to);
  WriteTicks(report.ticks, report.missing, to);
  to.Gauge("footing_relay_source_up", "1 while the server is connected.");
  for (const PublisherReport::SourceState& source : report.sources) {
    to.Sample(Number(source.up), Braced({{"address", source.address}, {"server", source.server}}));
  }
  BeginBrokers(to);
  if (report.nats_up) to.Sample(Number(*report.nats_up), Braced({{"broker", "nats"}}));
  if (report.mqtt_up) to.Sample(Number(*report.mqtt_up), Braced({{"broker", "mqtt"}}));
  to.Counter("footing_relay_published_total", "Messages published.");
  to.Sample(report.published);
  to.Counter("footing_relay_dropped_total",
             "Messages that a broker did not take, since it was gone or slow.");
  to.Sample(report.dropped);
  monitoring::WriteProcess(monitoring::UsageOfThisProcess(), to);
  return to.Take();
}

std::string MetricsText(const EdgeReport& report, const std::string& version) {
  MetricsWriter to;
  monitoring::WriteProgram({"footing-relay", version}, to);
  WriteTicks(report.ticks, report.missing, to);
  BeginBrokers(to);
  to.Sample(Number(report.nats_up), Braced({{"broker", "nats"}}));
  to.Gauge("footing_relay_serving", "1 while viewers can connect.");
  to.Sample(Number(report.serving));
  to.Counter("footing_relay_ticks_left_out_total", "Ticks left out because of --rate-hz.");
  to.Sample(report.left_out);
  to.Gauge("footing_sessions", "Current sessions.");
  to.Sample(report.sessions);
  to.Counter("footing_connections_accepted_total", "Connections accepted.");
  to.Sample(report.accepted);
  to.Counter("footing_ticks_dropped_total", "Ticks dropped because a session's queue was full.");
  to.Sample(report.dropped);
  monitoring::WriteProcess(monitoring::UsageOfThisProcess(), to);
  return to.Take();
}

}  // namespace footing::relay
