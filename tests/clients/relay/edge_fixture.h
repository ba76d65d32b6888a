#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "clients/relay/channels.h"
#include "clients/relay/edge.h"
#include "common/net/client.h"
#include "common/runtime/clock.h"
#include "common/runtime/timer.h"
#include "tests/clients/relay/nats_server.h"
#include "tests/common/net/io_fixture.h"
#include "tests/common/runtime/simulated_time.h"

namespace footing::relay {

constexpr std::int64_t kTickNs = 10'000'000;  // 100 Hz.

/// Messages that one viewer of the edge got.
struct Viewed {
  std::vector<v1::Welcome> welcomes;
  std::vector<v1::Tick> ticks, snapshots;
  std::vector<v1::Gap> gaps;
  std::vector<std::string> lines;  ///< Lines of the link.

  /// The newest state that a tick or a snapshot brought; empty: none.
  std::string state;

  bool Has(std::uint64_t sequence) const {
    return std::any_of(ticks.begin(), ticks.end(),
                       [&](const v1::Tick& tick) { return tick.sequence() == sequence; });
  }
  bool HasLine(const std::string& text) const {
    return std::any_of(lines.begin(), lines.end(), [&](const std::string& line) {
      return line.find(text) != std::string::npos;
    });
  }
};

/// An edge on simulated time between a NATS server and a publisher that the test plays, and a
/// viewer. The viewer has this process's clock; the server's is ahead of it.
class EdgeTest : private timer::SimulatedTime, public transport::IoFixture {
 protected:
  EdgeTest()
      : nats_(io_, [this](const std::string&, const std::string& reply,
                          const std::string& payload) { OnAsked(reply, payload); }) {
    welcome_.set_server_id("footingd");
    welcome_.set_epoch(77);
    welcome_.set_version("1.0");
    for (const char* name : {"status", "motion", "events"}) welcome_.add_channels(name);
    welcome_.mutable_limits()->set_tick_rate_hz(100);
  }

  void TearDown() override {
    viewer_.reset();
    if (edge_) edge_->Stop();
    edge_.reset();
    nats_.Break();
    Settle();
    timer::DropWaits();
  }

  void Start(double rate_hz = 0) {
    EdgeOptions options;
    options.site = "lab";
    options.server = "footingd";
    options.nats.address = nats_.address();
    options.nats.client_name = "edge";
    options.listen = {UnixAddress()};
    options.rate_hz = rate_hz;
    edge_ = std::make_unique<Edge>(io_, options, [this](const Error& error) { broken_ = error; });
    edge_->Start();
  }

  /// Starts the edge, with the server at this sequence, and a viewer that is subscribed.
  bool Serve(std::uint64_t sequence, const std::string& state, double rate_hz = 0) {
    Stand(sequence, state);
    Start(rate_hz);
    if (!RunUntil([&] { return edge_->report().serving; })) return false;
    View();
    return RunUntil([&] { return !viewed_.snapshots.empty(); });
  }

  void View() {
    transport::ClientOptions options;
    options.address = UnixAddress();
    options.client_name = "viewer";
    viewer_ = std::make_unique<transport::Client>(
        io_, options,
        transport::ClientHandlers{
            [this](const v1::Welcome& welcome) { viewed_.welcomes.push_back(welcome); },
            [this](const v1::Tick& tick) {
              if (tick.has_status()) viewed_.state = tick.status().devices(0).serial();
              (tick.snapshot() ? viewed_.snapshots : viewed_.ticks).push_back(tick);
            },
            [this](const v1::Gap& gap) { viewed_.gaps.push_back(gap); },
            [this](transport::LinkState, const std::string& why) {
              viewed_.lines.push_back(why);
            }});
    viewer_->Start();
  }

  /// The server has this sequence and state; nothing is published.
  void Stand(std::uint64_t sequence, const std::string& state) {
    snapshot_.set_epoch(welcome_.epoch());
    snapshot_.set_sequence(sequence);
    snapshot_.set_host_ns(static_cast<std::int64_t>(sequence) * kTickNs);
    snapshot_.set_snapshot(true);
    if (state.empty()) return;
    snapshot_.clear_status();
    snapshot_.mutable_status()->add_devices()->set_serial(state);
  }

  v1::Tick TickOf(std::uint64_t sequence, const std::string& state = "") const {
    v1::Tick tick;
    tick.set_epoch(welcome_.epoch());
    tick.set_sequence(sequence);
    tick.set_host_ns(static_cast<std::int64_t>(sequence) * kTickNs);
    tick.mutable_motion()->add_samples()->set_device(static_cast<std::uint32_t>(sequence));
    if (!state.empty()) tick.mutable_status()->add_devices()->set_serial(state);
    return tick;
  }

  void Deliver(const v1::Tick& tick) {
    v1::Envelope message;
    *message.mutable_tick() = tick;
    nats_.Deliver(TickSubject("lab", "footingd"), message.SerializeAsString());
  }

  /// The server's next tick, perhaps with another state, through NATS.
  void Publish(std::uint64_t sequence, const std::string& state = "") {
    Stand(sequence, state);
    Deliver(TickOf(sequence, state));
  }
  /// The same, but it never comes.
  void Lose(std::uint64_t sequence, const std::string& state = "") { Stand(sequence, state); }

  /// A tick, and whether the viewer gets it.
  bool Arrives(std::uint64_t sequence) {
    Publish(sequence);
    return RunUntil([&] { return viewed_.Has(sequence); });
  }

  void RunFor(double seconds) {
    (void)timer::RunUntil(
        io_, [] { return false; }, seconds, [] { return false; });
  }

  NatsServer nats_;
  v1::Welcome welcome_;
  v1::Tick snapshot_;
  std::int64_t ahead_ns_ = 3'600'000'000'000;  ///< The server's clock, of ours.
  std::int64_t trip_ns_ = 0;                   ///< Trip of the answer to a ping, there and back.
  int answers_ = 1 << 20;                      ///< To requests for a snapshot, still to be given.
  int asked_ = 0;                              ///< How often a snapshot was requested.
  std::unique_ptr<Edge> edge_;
  std::unique_ptr<transport::Client> viewer_;
  Viewed viewed_;
  std::optional<Error> broken_;

 private:
  void OnAsked(const std::string& reply, const std::string& payload) {
    v1::Envelope question, answer;
    ASSERT_TRUE(question.ParseFromString(payload));
    if (question.has_ping()) {
      const std::int64_t now_ns = clock::MonotonicNs() + ahead_ns_;
      answer.mutable_pong()->set_id(question.ping().id());
      // An earlier stamp of its own: as if the ping had taken longer than no time.
      answer.mutable_pong()->set_t0_ns(question.ping().t0_ns() - trip_ns_);
      answer.mutable_pong()->set_t1_ns(now_ns - trip_ns_ / 2);
      answer.mutable_pong()->set_t2_ns(now_ns - trip_ns_ / 2);
      return nats_.Deliver(reply, answer.SerializeAsString());
    }
    ++asked_;
    if (answers_-- <= 0) return;
    *answer.mutable_welcome() = welcome_;
    nats_.Deliver(reply, answer.SerializeAsString());
    *answer.mutable_tick() = snapshot_;
    nats_.Deliver(reply, answer.SerializeAsString());
  }
};

}  // namespace footing::relay
