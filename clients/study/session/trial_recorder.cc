#include "clients/study/session/trial_recorder.h"

#include <algorithm>
#include <chrono>

#include "common/runtime/clock.h"
#include "common/recording/recording_writer.h"
#include "common/recording/server_recorder.h"
#include "common/runtime/timer.h"

namespace footing::study {
namespace {

namespace asio = boost::asio;

constexpr auto kFlushPeriod = std::chrono::milliseconds(400);  // Half of kLongestUnwrittenNs.
constexpr double kFirstTickS = 5;
constexpr double kCaughtUpS = 1;

}  // namespace

class TrialRecorder::Implementation {
 public:
  Implementation(Console& console, recording::RecordingWriter writer)
      : writer_(std::move(writer)), flush_(console.io()), io_(console.io()) {}

  ~Implementation() {
    for (const auto& server : servers_) server->Stop();
  }

  Result<void> Describe(const Options& options, const mcap::TextMap& marks) {
    if (const auto done = writer_.AddMetadata("trial", marks); !done) return done;
    for (const auto& [name, text] : options.attachments) {
      const auto done = writer_.Attach(name, "application/json", text, clock::MonotonicNs());
      if (!done) return done;
    }
    return recording::DescribeRecording(writer_, "footing-study", options.version,
                                        options.addresses);
  }

  void Link(const transport::Address& address) {
    recording::ServerRecorderOptions server;
    server.address = address;
    server.client_name = "footing-study";
    server.on_written = [this](Result<void> written) { Keep(std::move(written)); };
    servers_.push_back(
        std::make_unique<recording::ServerRecorder>(io_, writer_, names_, std::move(server)));
  }

  void Start() {
    for (const auto& server : servers_) server->Start();
    FlushLater();
  }

  bool Flowing() const {
    return !written_ || std::all_of(servers_.begin(), servers_.end(), [](const auto& server) {
      return server->recorder().ticks() > 1;
    });
  }

  bool Has(std::int64_t host_ns) const {
    return !written_ || std::all_of(servers_.begin(), servers_.end(), [&](const auto& server) {
      return server->recorder().last_host_ns() >= host_ns;
    });
  }

  void Keep(Result<void> written) {
    if (!written && written_) written_ = std::move(written);
  }

  void FlushLater() {
    flush_.expires_after(kFlushPeriod);
    flush_.async_wait([this](const boost::system::error_code& error) {
      if (error) return;
      if (writer_.pending() && written_) Keep(writer_.Flush());
      FlushLater();
    });
  }

  Result<void> Finish(const mcap::TextMap& outcome) {
    flush_.cancel();
    for (const auto& server : servers_) {
      server->Stop();
      Keep(server->End());
    }
    if (!written_) return written_;
    if (const auto done = writer_.AddMetadata("trial_outcome", outcome); !done) return done;
    return writer_.Finish();
  }

  recording::RecordingWriter writer_;
  recording::ServerNames names_;
  std::vector<std::unique_ptr<recording::ServerRecorder>> servers_;
  Result<void> written_;
  timer::Timer flush_;
  asio::io_context& io_;
};

TrialRecorder::TrialRecorder(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
TrialRecorder::~TrialRecorder() = default;

Result<std::unique_ptr<TrialRecorder>> TrialRecorder::Begin(Console& console, Options options,
                                                            const mcap::TextMap& marks) {
  recording::WriterSettings settings;
  settings.library = "footing-study " + options.version;
  auto writer = recording::RecordingWriter::Create(options.path, settings);
  if (!writer) return writer.error();
  auto own = std::make_unique<Implementation>(console, std::move(*writer));
  if (const auto done = own->Describe(options, marks); !done) return done.error();
  for (const transport::Address& address : options.addresses) own->Link(address);
  own->Start();
  return std::unique_ptr<TrialRecorder>(new TrialRecorder(std::move(own)));
}

Result<void> TrialRecorder::AwaitFirst(Console& console) const {
  const Implementation& own = *implementation_;
  const Waited waited = console.RunUntil([&] { return own.Flowing(); }, kFirstTickS);
  if (waited == Waited::kInterrupted) return Interrupted();
  if (waited == Waited::kTimeUp) {
    return NoDevice("nothing comes to record in " + own.writer_.path() +
                    "; are both servers running?");
  }
  return own.written_;
}

const Result<void>& TrialRecorder::written() const { return implementation_->written_; }

Waited TrialRecorder::CatchUp(Console& console, std::int64_t host_ns) const {
  return console.RunUntil([&] { return implementation_->Has(host_ns); }, kCaughtUpS);
}

Result<void> TrialRecorder::Finish(const mcap::TextMap& outcome) {
  return implementation_->Finish(outcome);
}

}  // namespace footing::study
