#include "clients/log/record.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <utility>

#include <boost/asio/post.hpp>

#include "clients/log/lsl.h"
#include "common/runtime/files.h"
#include "common/runtime/service_manager.h"

namespace footing::log_client {
namespace {

constexpr auto kFlushPeriod = std::chrono::milliseconds(50);
constexpr auto kCatchUpPeriod = std::chrono::milliseconds(5);
constexpr std::int64_t kLongestCatchUpNs = 2'000'000'000;
constexpr auto kProgressPeriod = std::chrono::seconds(5);
constexpr std::size_t kMostAttachmentBytes = 16u << 20;

}  // namespace

Result<std::vector<transport::Address>> RecordedAddresses(const std::vector<std::string>& given) {
  std::vector<transport::Address> addresses;
  for (const std::string& text : given) {
    const Result<transport::Address> address = transport::ParseAddress(text);
    if (!address) return address.error();
    const bool again = std::any_of(
        addresses.begin(), addresses.end(),
        [&](const transport::Address& other) { return other.Text() == address->Text(); });
    if (again)
      return UsageError("--connect " + text + " is named twice: each message would be, too");
    addresses.push_back(*address);
  }
  if (addresses.empty()) {
    addresses = {transport::DefaultAddress("sensor"), transport::DefaultAddress("simulation")};
  }
  return addresses;
}

Result<std::unique_ptr<Recording>> Recording::Create(boost::asio::io_context& io,
                                                     const RecordOptions& options,
                                                     std::function<void()> on_end) {
  for (const std::string& query : options.lsl) {
    if (const auto sound = lsl::CheckQuery(query); !sound) {
      return UsageError("--lsl \"" + query + "\": " + sound.error().message);
    }
  }
  recording::WriterSettings settings;
  settings.library = "footing-log " + options.version;
  settings.replace = options.replace;
  settings.chunks.compress = options.compress;
  Result<recording::RecordingWriter> writer =
      recording::RecordingWriter::Create(options.out, settings);
  if (!writer) return writer.error();
  return std::unique_ptr<Recording>(
      new Recording(io, std::move(*writer), options, std::move(on_end)));
}

Recording::Recording(boost::asio::io_context& io, recording::RecordingWriter writer,
                     const RecordOptions& options, std::function<void()> on_end)
    : io_(io),
      options_(options),
      on_end_(std::move(on_end)),
      writer_(std::move(writer)),
      foxglove_([this](const auto& topic, const auto& message, const auto& stamp) {
        return writer_.Write(topic, message, stamp);
      }),
      flush_(io),
      progress_(io),
      catch_up_(io) {}

Result<void> Recording::Start() {
  const auto described =
      recording::DescribeRecording(writer_, "footing-log", options_.version, options_.addresses);
  if (!described) return described;
  for (const std::string& path : options_.attachments) {
    if (const auto attached = Attach(path); !attached) return attached;
  }
  for (const transport::Address& address : options_.addresses) Link(address);
  for (const auto& link : links_) link->Start();
  if (!options_.lsl.empty()) {
    lsl_ = std::make_unique<lsl::StreamsRecorder>(
        io_, writer_, options_.lsl, [this](Result<void> written) { Keep(std::move(written)); });
    if (const auto started = lsl_->Start(); !started) return started;
  }
  FlushLater();
  ProgressLater();
  return {};
}

Result<void> Recording::Attach(const std::string& path) {
  const Result<std::string> bytes = config::ReadTextFile(path, kMostAttachmentBytes);
  if (!bytes) return bytes.error();
  const std::filesystem::path name(path);
  const bool json = name.extension() == ".json";
  return writer_.Attach(name.filename().string(),
                        json ? "application/json" : "application/octet-stream", *bytes,
                        clock::MonotonicNs());
}

void Recording::Link(const transport::Address& address) {
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
  if (options_.foxglove) {
    server.on_tick = [this](const std::string& name, const v1::Tick& tick, std::int64_t now_ns) {
      return foxglove_.OnTick(
          name, tick, {tick.host_ns(), now_ns, static_cast<std::uint32_t>(tick.sequence())});
    };
  }
  links_.push_back(
      std::make_unique<recording::ServerRecorder>(io_, writer_, names_, std::move(server)));
}

/// Remembers the first failure of the file, and ends.
void Recording::Keep(Result<void> written) {
  if (!written && written_) {
    written_ = std::move(written);
    End();
  }
}

void Recording::FlushLater() {
  flush_.After(kFlushPeriod, [this] {
    const std::int64_t now_ns = clock::MonotonicNs();
    if (!writer_.pending()) written_down_ns_ = now_ns;
    if (now_ns - written_down_ns_ >= recording::kLongestUnwrittenNs) {
      Keep(writer_.Flush());
      written_down_ns_ = now_ns;
    }
    if (on_end_) FlushLater();
  });
}

void Recording::ProgressLater() {
  progress_.After(kProgressPeriod, [this] {
    std::cerr << writer_.path() << ": " << writer_.statistics().message_count << " messages";
    for (const auto& link : links_) {
      const recording::StreamRecorder& recorder = link->recorder();
      std::cerr << ", " << recorder.address() << " " << recorder.ticks() << " ticks";
      if (recorder.missing_ticks() > 0) {
        std::cerr << " (" << recorder.missing_ticks() << " missing)";
      }
    }
    if (lsl_) {
      std::cerr << ", LSL " << lsl_->streams() << " streams, " << lsl_->samples() << " samples";
    }
    std::cerr << std::endl;
    ProgressLater();
  });
}

void Recording::CatchUp(std::int64_t until_ns) {
  const bool has_all = std::all_of(links_.begin(), links_.end(),
                                   [&](const auto& link) { return link->HasAllUntil(until_ns); });
  if (has_all || clock::MonotonicNs() - until_ns > kLongestCatchUpNs) return End();
  catch_up_.After(kCatchUpPeriod, [this, until_ns] { CatchUp(until_ns); });
}

void Recording::End() {
  if (!on_end_) return;
  for (const auto& link : links_) link->Stop();
  if (lsl_) lsl_->Stop();
  flush_.cancel();
  progress_.cancel();
  catch_up_.cancel();
  // Whoever is called lets go of this, which a link may be calling.
  boost::asio::post(io_, std::exchange(on_end_, nullptr));
}

Result<RecordReport> Recording::Finish() {
  if (!written_) {
    return Failure(written_.error().message +
                   (writer_.empty() ? "; nothing was recorded"
                                    : "; what was written before is kept: footing-log repair " +
                                          writer_.path() + " --out NEW.mcap"));
  }
  std::string waited_for;
  for (const auto& link : links_) {
    if (const Result<void> ended = link->End(); !ended) return ended.error();
    const recording::StreamRecorder& recorder = link->recorder();
    waited_for +=
        (waited_for.empty() ? "" : ", ") + recorder.address() + " (" + recorder.link() + ")";
  }
  if (lsl_) waited_for += (waited_for.empty() ? "" : ", ") + lsl_->Waited();
  if (writer_.statistics().message_count == 0) {
    const std::string why =
        "nothing came to record from " + waited_for + "; " + writer_.path() + " was not written";
    return reached() > 0 ? Failure(why)
                         : NoDevice(why + "; start the server, or name it with --connect");
  }
  if (const Result<void> finished = writer_.Finish(); !finished) return finished.error();
  return Progress();
}

std::size_t Recording::reached() const {
  return static_cast<std::size_t>(std::count_if(
      links_.begin(), links_.end(), [](const auto& link) { return link->recorder().reached(); }));
}

std::size_t Recording::begun() const {
  return static_cast<std::size_t>(std::count_if(
      links_.begin(), links_.end(), [](const auto& link) { return link->recorder().ticks() > 0; }));
}

RecordReport Recording::Progress() const {
  RecordReport report;
  for (const auto& link : links_) {
    report.ticks += link->recorder().ticks();
    report.missing_ticks += link->recorder().missing_ticks();
  }
  if (lsl_) {
    report.lsl_streams = lsl_->streams();
    report.lsl_samples = lsl_->samples();
  }
  const mcap::Statistics& statistics = writer_.statistics();
  report.messages = statistics.message_count;
  report.duration_s =
      1e-9 * static_cast<double>(statistics.message_end_time_ns - statistics.message_start_time_ns);
  return report;
}

Result<RecordReport> Record(const RecordOptions& options) {
  boost::asio::io_context io;
  const auto recording = Recording::Create(io, options, [&io] { io.stop(); });
  if (!recording) return recording.error();
  service_manager::ProgramEnd end(io, [&] { (*recording)->Stop(); });
  end.After(options.seconds, [&] { (*recording)->Stop(); });
  if (const auto started = (*recording)->Start(); !started) return started.error();
  io.run();
  return (*recording)->Finish();
}

}  // namespace footing::log_client
