#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "clients/log/lsl_in.h"
#include "common/base/result.h"
#include "common/foxglove/scene.h"
#include "common/net/address.h"
#include "common/recording/recording_writer.h"
#include "common/recording/stream_recorder.h"
#include "common/runtime/clock.h"
#include "common/runtime/timer.h"

namespace footing::log_client {

/// Options of a recording.
struct RecordOptions {
  std::vector<transport::Address> addresses;
  std::string out;
  double seconds = 0;      ///< From the start; 0: until SIGINT or SIGTERM.
  bool from_ring = false;  ///< First what the servers' rings still hold, up to 30 s.
  bool replace = false;
  bool compress = true;                  ///< Chunks, by zstd.
  bool foxglove = false;                 ///< The topics of foxglove_scene::Scene, too.
  std::vector<std::string> lsl;          ///< Queries for streams of LSL that are recorded, too.
  std::vector<std::string> attachments;  ///< Files: config, calibrations, track, survey.
  std::string version;
};

/// Addresses of the servers to record; those of this user where none is given. Usage error for one
/// that is not an address, or is given twice.
Result<std::vector<transport::Address>> RecordedAddresses(const std::vector<std::string>& given);

/// Counts of a finished recording.
struct RecordReport {
  std::uint64_t messages = 0;
  std::uint64_t ticks = 0;
  std::uint64_t missing_ticks = 0;
  std::uint64_t lsl_streams = 0, lsl_samples = 0;
  double duration_s = 0;  ///< Between the first and the last message.
};

/// One recording: the file, the links to its servers, and the timers. Progress goes to standard
/// error. Everything runs on the io_context's one thread.
class Recording {
 public:
  /// `on_end` is called once, on the io_context, when nothing more comes: after Stop(), or when the
  /// file has failed. Then Finish().
  static Result<std::unique_ptr<Recording>> Create(boost::asio::io_context& io,
                                                   const RecordOptions& options,
                                                   std::function<void()> on_end);
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  /// Connects to the servers, once the attachments are in the file.
  Result<void> Start();
  /// Ends once everything has come that was sent up to now, or soon.
  void Stop() { CatchUp(clock::MonotonicNs()); }
  /// Writes the end of the file. A recording into which nothing came is a failure that says what
  /// was waited for, and leaves no file, or the existing one as it was; a disk that is full is a
  /// failure, and the file stays repairable.
  Result<RecordReport> Finish();

  /// Servers that have answered, and those of which ticks have come.
  std::size_t reached() const;
  std::size_t begun() const;
  /// As it stands now.
  RecordReport Progress() const;
  const std::string& path() const { return writer_.path(); }

 private:
  Recording(boost::asio::io_context& io, recording::RecordingWriter writer,
            const RecordOptions& options, std::function<void()> on_end);

  Result<void> Attach(const std::string& path);
  void Link(const transport::Address& address);
  void Keep(Result<void> written);
  void FlushLater();
  void ProgressLater();
  void CatchUp(std::int64_t until_ns);
  void End();

  boost::asio::io_context& io_;
  RecordOptions options_;
  std::function<void()> on_end_;  ///< Empty: it has ended.
  recording::RecordingWriter writer_;
  recording::ServerNames names_;
  foxglove_scene::Scene foxglove_;
  std::vector<std::unique_ptr<recording::ServerRecorder>> links_;
  std::unique_ptr<lsl::StreamsRecorder> lsl_;  ///< Null: none is asked for.
  Result<void> written_;
  std::int64_t written_down_ns_ = clock::MonotonicNs();
  timer::Timer flush_;
  timer::Timer progress_;
  timer::Timer catch_up_;
};

/// Records until the time is up or SIGINT or SIGTERM comes, then ends the file properly.
Result<RecordReport> Record(const RecordOptions& options);

}  // namespace footing::log_client
