#pragma once

#include "common/net/client.h"
#include "common/runtime/clock.h"
#include "tests/common/net/server_fixture.h"

namespace footing::transport {

/// A server, and a client that writes down what its handlers are told.
class ClientTest : public ServerFixture {
 protected:
  ClientOptions ClientOn(const Address& address) {
    ClientOptions options;
    options.address = address;
    options.client_name = "client under test";
    options.backoff_min_s = 0.001;
    options.backoff_max_s = 0.01;
    options.ping_interval_s = 0.01;
    options.now_ns = [this] { return client_now_ns_ ? client_now_ns_() : clock::MonotonicNs(); };
    return options;
  }
  void StartClient(ClientOptions options) {
    ClientHandlers handlers;
    handlers.on_welcome = [this](const v1::Welcome&) { ++welcomes_; };
    handlers.on_tick = [this](const v1::Tick& tick) {
      (tick.snapshot() ? snapshots_ : sequences_).push_back(tick.sequence());
    };
    handlers.on_gap = [this](const v1::Gap& gap) { gaps_.push_back(gap); };
    handlers.on_state = [this](LinkState state, const std::string& why) {
      states_.emplace_back(state, why);
    };
    client_ = std::make_unique<Client>(io_, std::move(options), std::move(handlers));
    client_->Start();
  }
  bool RunUntilState(LinkState state) {
    return RunUntil([&] { return client_->state() == state; });
  }

  std::function<std::int64_t()> client_now_ns_;
  std::unique_ptr<Client> client_;
  int welcomes_ = 0;
  std::vector<std::uint64_t> snapshots_;
  std::vector<std::uint64_t> sequences_;
  std::vector<v1::Gap> gaps_;
  std::vector<std::pair<LinkState, std::string>> states_;
};

}  // namespace footing::transport
