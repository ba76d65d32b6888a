#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "common/base/result.h"
#include "common/net/address.h"
#include "common/net/client.h"
#include "common/recording/recording_writer.h"
#include "footing/v1/session.pb.h"

namespace footing::recording {

/// The latest that a message waits in memory before it is written down.
inline constexpr std::int64_t kLongestUnwrittenNs = 800'000'000;

/// Writes what one server sends to a recording that several may share: every channel of a tick on
/// the topic /SERVER/CHANNEL, gaps on /SERVER/gaps, sessions and the link as metadata. Calls of one
/// recording come from one thread; the local time is an argument.
class StreamRecorder {
 public:
  /// `name_of` gives servers of the same id different names, such as ServerNames::Of.
  StreamRecorder(RecordingWriter& writer, std::string address,
                 std::function<std::string(const std::string& server_id)> name_of);

  Result<void> OnWelcome(const v1::Welcome& welcome, std::int64_t now_ns);
  Result<void> OnTick(const v1::Tick& tick, std::int64_t now_ns);
  Result<void> OnGap(const v1::Gap& gap, std::int64_t now_ns);
  Result<void> OnState(transport::LinkState state, const std::string& why, std::int64_t now_ns);
  Result<void> OnNotice(const v1::Notice& notice, std::int64_t now_ns);
  /// Last: how the server's clock stood to ours.
  Result<void> OnEnd(const transport::ClockOffset& clock, std::int64_t now_ns);

  std::uint64_t ticks() const { return ticks_; }
  std::uint64_t missing_ticks() const { return missing_ticks_; }
  /// Time of the newest tick, on the server's clock; 0: none.
  std::int64_t last_host_ns() const { return last_host_ns_; }
  /// Notice of what slows the server or this session, in the server's words.
  const std::string& notice() const { return notice_; }
  /// The last state of the link, for a person.
  const std::string& link() const { return link_; }
  const std::string& address() const { return address_; }
  /// Name of its topics; empty before its welcome.
  const std::string& server() const { return server_; }
  /// A server has answered there: it took this client in, or refused it.
  bool reached() const { return reached_; }

 private:
  RecordingWriter& writer_;
  std::string address_;
  std::function<std::string(const std::string&)> name_of_;
  std::string server_;
  std::string link_ = "not connected yet";
  std::string notice_;
  std::int64_t last_host_ns_ = 0;
  std::uint64_t last_sequence_ = 0;
  std::uint64_t ticks_ = 0;
  std::uint64_t missing_ticks_ = 0;
  bool reached_ = false;
};

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

/// Server to record, and the calls that its recorder makes.
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
  /// Called with each tick once it is written, and the time at which it came; may be empty.
  std::function<Result<void>(const std::string& server, const v1::Tick& tick, std::int64_t now_ns)>
      on_tick = {};
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
