#include "clients/log/record.h"

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <memory>
#include <utility>

#include "common/runtime/clock.h"
#include "common/runtime/data_file.h"
#include "common/recording/recording_writer.h"
#include "common/recording/server_recorder.h"
#include "common/runtime/timer.h"

namespace footing::log_client {
namespace {

namespace asio = boost::asio;

constexpr auto kFlushPeriod = std::chrono::milliseconds(50);
constexpr auto kCatchUpPeriod = std::chrono::milliseconds(5);
constexpr std::int64_t kLongestCatchUpNs = 2'000'000'000;
constexpr auto kProgressPeriod = std::chrono::seconds(5);
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
    Keep(
        recording::DescribeRecording(writer_, "footing-log", options_.version, options_.addresses));
    for (const std::string& path : options_.attachments) Keep(Attach(path));
    if (!written_) return written_.error();
    for (const transport::Address& address : options_.addresses) Link(address);
    for (const auto& link : links_) link->Start();
    signals_.async_wait([this](const boost::system::error_code& error, int) {
      if (!error) CatchUp(clock::MonotonicNs());
    });
    if (options_.seconds > 0) {
      end_.expires_after(std::chrono::duration_cast<std::chrono::nanoseconds>(
          std::chrono::duration<double>(options_.seconds)));
      end_.async_wait([this](const boost::system::error_code& error) {
        if (!error) CatchUp(clock::MonotonicNs());
      });
    }
    FlushLater();
    ProgressLater();
    io_.run();
    return Finish();
  }

 private:
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
    recording::ServerRecorderOptions server;
    server.address = address;
    server.client_name = "footing-log";
    server.from_ring_start = options_.from_ring;
    server.on_written = [this](Result<void> written) { Keep(std::move(written)); };
    server.on_link = [](const recording::StreamRecorder& recorder) {
      std::cerr << recorder.address() << ": " << recorder.link() << std::endl;
    };
    server.on_notice = [](const recording::StreamRecorder& recorder) {
      std::cerr << recorder.address() << ": notice: " << recorder.notice() << std::endl;
    };
    links_.push_back(
        std::make_unique<recording::ServerRecorder>(io_, writer_, names_, std::move(server)));
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
        const recording::StreamRecorder& recorder = link->recorder();
        std::cerr << ", " << recorder.address() << " " << recorder.ticks() << " ticks";
        if (recorder.missing_ticks() > 0) {
          std::cerr << " (" << recorder.missing_ticks() << " missing)";
        }
      }
      std::cerr << std::endl;
      ProgressLater();
    });
  }

  /// Ends once everything has come that was sent up to then, or soon.
  void CatchUp(std::int64_t until_ns) {
    const bool has_all = std::all_of(links_.begin(), links_.end(),
                                     [&](const auto& link) { return link->HasAllUntil(until_ns); });
    if (has_all || clock::MonotonicNs() - until_ns > kLongestCatchUpNs) return End();
    end_.expires_after(kCatchUpPeriod);
    end_.async_wait([this, until_ns](const boost::system::error_code& error) {
      if (!error) CatchUp(until_ns);
    });
  }

  void End() {
    for (const auto& link : links_) link->Stop();
    io_.stop();
  }

  Result<RecordReport> Finish() {
    if (!written_) {
      return Failure(written_.error().message +
                     (writer_.empty() ? "; nothing was recorded"
                                      : "; what was written before is kept: footing-log repair " +
                                            writer_.path() + " --out NEW.mcap"));
    }
    RecordReport report;
    std::string waited_for;
    bool any_reached = false;
    for (const auto& link : links_) {
      if (const Result<void> ended = link->End(); !ended) return ended.error();
      const recording::StreamRecorder& recorder = link->recorder();
      report.ticks += recorder.ticks();
      report.missing_ticks += recorder.missing_ticks();
      waited_for +=
          (waited_for.empty() ? "" : ", ") + recorder.address() + " (" + recorder.link() + ")";
      any_reached = any_reached || recorder.reached();
    }
    const mcap::Statistics& statistics = writer_.statistics();
    if (statistics.message_count == 0) {
      const std::string why =
          "nothing came to record from " + waited_for + "; " + writer_.path() + " was not written";
      return any_reached ? Failure(why)
                         : NoDevice(why + "; start the server, or name it with --connect");
    }
    if (const Result<void> finished = writer_.Finish(); !finished) return finished.error();
    report.messages = statistics.message_count;
    report.duration_s = 1e-9 * static_cast<double>(statistics.message_end_time_ns -
                                                   statistics.message_start_time_ns);
    return report;
  }

  asio::io_context& io_;
  const RecordOptions& options_;
  recording::RecordingWriter writer_;
  recording::ServerNames names_;
  std::vector<std::unique_ptr<recording::ServerRecorder>> links_;
  Result<void> written_;
  std::int64_t written_down_ns_ = clock::MonotonicNs();
  timer::Timer flush_;
  timer::Timer progress_;
  timer::Timer end_;
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
