#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "common/base/result.h"
#include "common/recording/recording_writer.h"

namespace footing::log_client::lsl {

/// Metadata record of a stream in a recording: its topic, and its description as XML.
inline constexpr char kStreamMetadata[] = "lsl_stream";

/// Records every stream of the network that one of the queries asks for, from when it appears: its
/// samples on the topic /lsl/NAME, the measurements of its clock on /lsl/NAME/clock, and its
/// description as metadata. A stream that comes back goes on in its topic. Everything runs on the
/// io_context's one thread.
class StreamsRecorder {
 public:
  static constexpr std::size_t kMostStreams = 64;

  /// The queries are sound (CheckQuery). `on_written` is called with the result of each write.
  StreamsRecorder(boost::asio::io_context& io, recording::RecordingWriter& writer,
                  std::vector<std::string> queries, std::function<void(Result<void>)> on_written);
  ~StreamsRecorder();
  StreamsRecorder(const StreamsRecorder&) = delete;
  StreamsRecorder& operator=(const StreamsRecorder&) = delete;

  Result<void> Start();
  void Stop();

  /// Streams of which samples have come, and samples in all.
  std::size_t streams() const;
  std::uint64_t samples() const;
  /// The queries, for a person who reads that nothing came.
  std::string Waited() const;

 private:
  class Implementation;
  std::shared_ptr<Implementation> implementation_;
};

}  // namespace footing::log_client::lsl
