#include "common/recording/server_recorder.h"

#include <utility>

#include "common/runtime/clock.h"

namespace footing::recording {
namespace {

constexpr std::uint32_t kQueueTicks = 1024;  // 10 s at 100 Hz; behind it stands the server's ring.

transport::ClientOptions ClientOf(const ServerRecorderOptions& options) {
  transport::ClientOptions client;
  client.address = options.address;
  client.client_name = options.client_name;
  client.role = v1::ROLE_LOG;
  client.policy = v1::QUEUE_POLICY_RELIABLE;
  client.queue_ticks = kQueueTicks;
  client.from_ring_start = options.from_ring_start;
  return client;
}

}  // namespace

Result<void> DescribeRecording(RecordingWriter& writer, const std::string& program,
                               const std::string& version,
                               const std::vector<transport::Address>& addresses) {
  std::string texts;
  for (const transport::Address& address : addresses) {
    texts += (texts.empty() ? "" : " ") + address.Text();
  }
  return writer.AddMetadata("recording",
                            {{"program", program},
                             {"version", version},
                             {"protobuf_package", "footing.v1"},
                             {"addresses", texts},
                             {"log_time", "CLOCK_MONOTONIC of the server, ns"},
                             {"publish_time", "CLOCK_MONOTONIC of the recorder, ns"},
                             {"recorder_host_ns", std::to_string(clock::MonotonicNs())},
                             {"recorder_wall_time_ns", std::to_string(clock::WallNs())}});
}

std::string ServerNames::Of(const std::string& id, const std::string& address) {
  for (int number = 1;; ++number) {
    const std::string name = number == 1 ? id : id + "_" + std::to_string(number);
    const auto [taken, fresh] = address_of_.emplace(name, address);
    if (fresh || taken->second == address) return name;
  }
}

ServerRecorder::ServerRecorder(boost::asio::io_context& io, RecordingWriter& writer,
                               ServerNames& names, ServerRecorderOptions options)
    : options_(std::move(options)),
      recorder_(writer, options_.address.Text(),
                [&names, address = options_.address.Text()](const std::string& id) {
                  return names.Of(id, address);
                }),
      client_(io, ClientOf(options_), Handlers()) {}

transport::ClientHandlers ServerRecorder::Handlers() {
  transport::ClientHandlers handlers;
  handlers.on_welcome = [this](const v1::Welcome& welcome) {
    options_.on_written(recorder_.OnWelcome(welcome, clock::MonotonicNs()));
  };
  handlers.on_tick = [this](const v1::Tick& tick) {
    options_.on_written(recorder_.OnTick(tick, clock::MonotonicNs()));
  };
  handlers.on_gap = [this](const v1::Gap& gap) {
    options_.on_written(recorder_.OnGap(gap, clock::MonotonicNs()));
  };
  handlers.on_state = [this](transport::LinkState state, const std::string& why) {
    options_.on_written(recorder_.OnState(state, why, clock::MonotonicNs()));
    if (options_.on_link) options_.on_link(recorder_);
  };
  handlers.on_notice = [this](const v1::Notice& notice) {
    options_.on_written(recorder_.OnNotice(notice, clock::MonotonicNs()));
    if (options_.on_notice) options_.on_notice(recorder_);
  };
  return handlers;
}

bool ServerRecorder::HasAllUntil(std::int64_t our_ns) const {
  if (client_.state() != transport::LinkState::kLive) return true;
  const transport::ClockOffset clock = client_.clock();
  return clock.valid && recorder_.last_host_ns() >= our_ns + clock.offset_ns;
}

Result<void> ServerRecorder::End() {
  return recorder_.OnEnd(client_.clock(), clock::MonotonicNs());
}

}  // namespace footing::recording
