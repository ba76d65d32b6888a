#include "clients/log/record.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <utility>

#include "common/clock/clock.h"
#include "common/config/data_file.h"
#include "common/recording/recording_writer.h"
#include "common/recording/stream_recorder.h"
#include "common/transport/client.h"

namespace footing::log_client {
namespace {

namespace asio = boost::asio;

constexpr auto kFlushPeriod = std::chrono::milliseconds(50);
constexpr auto kProgressPeriod = std::chrono::seconds(5);
constexpr std::uint32_t kQueueTicks = 1024;  // 10 s at 100 Hz; behind it stands the server's ring.
constexpr std::size_t kMostAttachmentBytes = 16u << 20;

/// One recording: the file, the links to its servers, and the timers.
class Recording {
 public:
  Recording(asio::io_context& io, recording::RecordingWriter writer, const RecordOptions& options)
      : io_(io),
        options_(options),
        writer_(std::move(writer)),
        flush_(io),
        progress_(io),
        end_(io),
        signals_(io, SIGINT, SIGTERM) {}

  Result<RecordReport> Run() {
    Keep(Describe());
    for (const std::string& path : options_.attachments) Keep(Attach(path));
    if (!written_) return written_.error();
    for (const transport::Address& address : options_.addresses) Link(address);
    for (const auto& link : links_) link->client->Start();
    signals_.async_wait([this](const boost::system::error_code& error, int) {
      if (!error) End();
    });
    if (options_.seconds > 0) {
      end_.expires_after(std::chrono::duration_cast<std::chrono::nanoseconds>(
          std::chrono::duration<double>(options_.seconds)));
      end_.async_wait([this](const boost::system::error_code& error) {
        if (!error) End();
      });
    }
    FlushLater();
    ProgressLater();
    io_.run();
    return Finish();
  }

 private:
  struct Source {
    std::unique_ptr<recording::StreamRecorder> recorder;
    std::unique_ptr<transport::Client> client;
  };

  Result<void> Describe() {
    std::string addresses;
    for (const transport::Address& address : options_.addresses) {
      addresses += (addresses.empty() ? "" : " ") + address.Text();
    }
    return writer_.AddMetadata("recording",
                               {{"program", "footing-log"},
                                {"version", options_.version},
                                {"protobuf_package", "footing.v1"},
                                {"addresses", addresses},
                                {"log_time", "CLOCK_MONOTONIC of the server, ns"},
                                {"publish_time", "CLOCK_MONOTONIC of the recorder, ns"},
                                {"recorder_host_ns", std::to_string(clock::MonotonicNs())},
                                {"recorder_wall_time_ns", std::to_string(clock::WallNs())}});
  }

  Result<void> Attach(const std::string& path) {
    const Result<std::string> bytes = config::ReadTextFile(path, kMostAttachmentBytes);
    if (!bytes) return bytes.error();
    const std::filesystem::path name(path);
    const bool json = name.extension() == ".json";
    return writer_.Attach(name.filename().string(),
                          json ? "application/json" : "application/octet-stream", *bytes,
                          clock::MonotonicNs());
  }

  void Link(const transport::Address& address) {
    auto link = std::make_unique<Source>();
    link->recorder = std::make_unique<recording::StreamRecorder>(
        writer_, address.Text(),
        [this, text = address.Text()](const std::string& id) { return NameOf(id, text); });
    recording::StreamRecorder& recorder = *link->recorder;
    transport::ClientOptions client;
    client.address = address;
    client.client_name = "footing-log";
    client.role = v1::ROLE_LOG;
    // Reliable: when the queue is full the session ends, and resumes out of the server's ring.
    client.policy = v1::QUEUE_POLICY_RELIABLE;
    client.queue_ticks = kQueueTicks;
    client.from_ring_start = true;  // So that what began just before can be run again.
    transport::ClientHandlers handlers;
    handlers.on_welcome = [&](const v1::Welcome& welcome) {
      Keep(recorder.OnWelcome(welcome, clock::MonotonicNs()));
    };
    handlers.on_tick = [&](const v1::Tick& tick) {
      Keep(recorder.OnTick(tick, clock::MonotonicNs()));
    };
    handlers.on_gap = [&](const v1::Gap& gap) { Keep(recorder.OnGap(gap, clock::MonotonicNs())); };
    handlers.on_state = [&](transport::LinkState state, const std::string& why) {
      Keep(recorder.OnState(state, why, clock::MonotonicNs()));
      std::cerr << recorder.address() << ": " << recorder.link() << std::endl;
    };
    link->client = std::make_unique<transport::Client>(io_, client, handlers);
    links_.push_back(std::move(link));
  }

  /// Two servers of one id differ by a number behind it.
  std::string NameOf(const std::string& id, const std::string& address) {
    for (int number = 1;; ++number) {
      const std::string name = number == 1 ? id : id + "_" + std::to_string(number);
      const auto [taken, fresh] = names_.emplace(name, address);
      if (fresh || taken->second == address) return name;
    }
  }

  /// Remembers the first failure of the file, and ends.
  void Keep(Result<void> written) {
    if (!written && written_) {
      written_ = std::move(written);
      End();
    }
  }

  void FlushLater() {
    flush_.expires_after(kFlushPeriod);
    flush_.async_wait([this](const boost::system::error_code& error) {
      if (error) return;
      const std::int64_t now_ns = clock::MonotonicNs();
      if (!writer_.pending()) written_down_ns_ = now_ns;
      if (now_ns - written_down_ns_ >= recording::kLongestUnwrittenNs) {
        Keep(writer_.Flush());
        written_down_ns_ = now_ns;
      }
      FlushLater();
    });
  }

  void ProgressLater() {
    progress_.expires_after(kProgressPeriod);
    progress_.async_wait([this](const boost::system::error_code& error) {
      if (error) return;
      std::cerr << writer_.path() << ": " << writer_.statistics().message_count << " messages";
      for (const auto& link : links_) {
        std::cerr << ", " << link->recorder->address() << " " << link->recorder->ticks()
                  << " ticks";
        if (link->recorder->missing_ticks() > 0) {
          std::cerr << " (" << link->recorder->missing_ticks() << " missing)";
        }
      }
      std::cerr << std::endl;
      ProgressLater();
    });
  }

  void End() {
    for (const auto& link : links_) link->client->Stop();
    io_.stop();
  }

  Result<RecordReport> Finish() {
    if (!written_) {
      return Failure(written_.error().message + "; what was written before is kept: footing-log " +
                     "repair " + writer_.path() + " --out NEW.mcap");
    }
    RecordReport report;
    std::string waited_for;
    for (const auto& link : links_) {
      const Result<void> ended = link->recorder->OnEnd(link->client->clock(), clock::MonotonicNs());
      if (!ended) return ended.error();
      report.ticks += link->recorder->ticks();
      report.missing_ticks += link->recorder->missing_ticks();
      waited_for += " " + link->recorder->address() + " (" + link->recorder->link() + ")";
    }
    if (const Result<void> finished = writer_.Finish(); !finished) return finished.error();
    const mcap::Statistics& statistics = writer_.statistics();
    report.messages = statistics.message_count;
    report.duration_s = 1e-9 * static_cast<double>(statistics.message_end_time_ns -
                                                   statistics.message_start_time_ns);
    if (report.messages == 0) {
      return Failure("nothing came to record from" + waited_for + "; " + writer_.path() +
                     " holds no message");
    }
    return report;
  }

  asio::io_context& io_;
  const RecordOptions& options_;
  recording::RecordingWriter writer_;
  std::vector<std::unique_ptr<Source>> links_;
  std::map<std::string, std::string> names_;
  Result<void> written_;
  std::int64_t written_down_ns_ = clock::MonotonicNs();
  asio::steady_timer flush_;
  asio::steady_timer progress_;
  asio::steady_timer end_;
  asio::signal_set signals_;
};

}  // namespace

Result<RecordReport> Record(const RecordOptions& options) {
  recording::WriterSettings settings;
  settings.library = "footing-log " + options.version;
  settings.replace = options.replace;
  Result<recording::RecordingWriter> writer =
      recording::RecordingWriter::Create(options.out, settings);
  if (!writer) return writer.error();
  asio::io_context io;
  return Recording(io, std::move(*writer), options).Run();
}

}  // namespace footing::log_client
