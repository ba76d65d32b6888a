#include "clients/relay/options.h"

#include <gmock/gmock.h>

namespace footing::relay {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(RelayMetrics, APublisherShowsItsServersBrokersAndMessages) {
  PublisherReport report;
  report.ticks = 700;
  report.missing = 3;
  report.published = 690;
  report.dropped = 10;
  report.sources = {{"unix:/run/s", "footingd", true}, {"unix:/run/t", "", false}};
  report.nats_up = true;
  const std::string text = MetricsText(report, "1.2");
  EXPECT_THAT(text,
              AllOf(HasSubstr("footing_build_info{program=\"footing-relay\",version=\"1.2\"} 1\n"),
                    HasSubstr("footing_relay_ticks_total 700\n"),
                    HasSubstr("footing_relay_ticks_missing_total 3\n"),
                    HasSubstr("{address=\"unix:/run/s\",server=\"footingd\"} 1\n"),
                    HasSubstr("{address=\"unix:/run/t\",server=\"\"} 0\n"),
                    HasSubstr("footing_relay_broker_up{broker=\"nats\"} 1\n"),
                    HasSubstr("footing_relay_published_total 690\n"),
                    HasSubstr("footing_relay_dropped_total 10\n"), HasSubstr("process_open_fds ")));
  EXPECT_THAT(text, Not(HasSubstr("mqtt"))) << "a broker that it does not use has no line";
}

TEST(RelayMetrics, AnEdgeShowsItsViewersAndWhatItLeftOut) {
  EdgeReport report;
  report.ticks = 1000;
  report.left_out = 670;
  report.dropped = 2;
  report.accepted = 5;
  report.sessions = 4;
  report.serving = true;
  EXPECT_THAT(
      MetricsText(report, "1.2"),
      AllOf(HasSubstr("footing_relay_ticks_total 1000\n"),
            HasSubstr("footing_relay_broker_up{broker=\"nats\"} 0\n"),
            HasSubstr("footing_relay_serving 1\n"),
            HasSubstr("footing_relay_ticks_left_out_total 670\n"),
            HasSubstr("footing_sessions 4\n"), HasSubstr("footing_connections_accepted_total 5\n"),
            HasSubstr("footing_ticks_dropped_total 2\n")));
}

}  // namespace
}  // namespace footing::relay
