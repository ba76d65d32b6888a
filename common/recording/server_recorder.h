#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "common/recording/recording_writer.h"
#include "common/recording/stream_recorder.h"
#include "common/base/result.h"
#include "common/net/address.h"
#include "common/net/client.h"

namespace footing::recording {

/// The metadata record "recording": what wrote it, of which servers, and its clocks.
Result<void> DescribeRecording(RecordingWriter& writer, const std::string& program,
                               const std::string& version,
                               const std::vector<transport::Address>& addresses);

/// Different names for the servers of a recording: the second one of an id is ID_2.
class ServerNames {
 public:
  /// The same for the same id and address.
  std::string Of(const std::string& id, const std::string& address);

 private:
  std::map<std::string, std::string> address_of_;
};

struct ServerRecorderOptions {
  transport::Address address;
  std::string client_name;
  bool from_ring_start = false;  ///< First everything that the server's ring still holds.
  /// Called with the result of each write.
  std::function<void(Result<void>)> on_written;
  /// Called when the link changes; may be empty.
  std::function<void(const StreamRecorder&)> on_link;
  /// Called when the server said what slows it; may be empty.
  std::function<void(const StreamRecorder&)> on_notice = {};
};

/// A connection with the role log, all of whose messages go to a recording. It is reliable: when
/// its queue is full the session ends, and resumes out of the server's ring. Everything runs on the
/// thread of the io_context.
class ServerRecorder {
 public:
  /// The writer and the names may be shared by several servers.
  ServerRecorder(boost::asio::io_context& io, RecordingWriter& writer, ServerNames& names,
                 ServerRecorderOptions options);

  void Start() { client_.Start(); }
  void Stop() { client_.Stop(); }
  /// Whether everything up to an instant of our clock has come, ns. Without a connection nothing
  /// more comes.
  bool HasAllUntil(std::int64_t our_ns) const;
  /// Last, before the recording is finished: how the server's clock stood to ours.
  Result<void> End();

  const StreamRecorder& recorder() const { return recorder_; }

 private:
  transport::ClientHandlers Handlers();

  ServerRecorderOptions options_;
  StreamRecorder recorder_;
  transport::Client client_;
};

}  // namespace footing::recording
