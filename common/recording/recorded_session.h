#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/recording/mcap_records.h"
#include "common/recording/recording_writer.h"
#include "footing/v1/device.pb.h"
#include "footing/v1/session.pb.h"

namespace footing::recording {

/// A channel's message as it was published, borrowed from the recording.
struct RecordedChannel {
  std::uint32_t field = 0;  ///< Field of v1::Tick.
  std::string_view bytes;   ///< The serialised message.
};

/// One tick with the channels that were recorded of it.
struct RecordedTick {
  std::int64_t host_ns = 0;    ///< CLOCK_MONOTONIC of the server: when the tick was made.
  std::uint32_t sequence = 0;  ///< The tick's, lowest 32 bits.
  std::vector<RecordedChannel> channels;
};

/// Everything that one server published from its start to its end.
struct RecordedServer {
  std::string name;       ///< Name of its topics: the server's id, numbered if there are several.
  std::string server_id;  ///< "footingd" or "footing-sim".
  std::string version;
  std::uint64_t epoch = 0;  ///< 0 when the recording does not say.
  double tick_rate_hz = 100;
  std::int64_t host_ns = 0;       ///< An instant of the server's clock,
  std::int64_t wall_time_ns = 0;  ///< and the UNIX time then; both 0 when the recording is silent.
  std::vector<RecordedTick> ticks;  ///< By sequence.
};

/// A whole recording as ticks. The first tick may be the snapshot that the recorder began with:
/// retained channels only, and later than the tick behind it.
class RecordedSession {
 public:
  /// InvalidData when the file is not a complete recording; the message names the repair.
  static Result<RecordedSession> Open(const std::string& path);

  /// In the order in which the recorder met them: one entry for each start of each server.
  const std::vector<RecordedServer>& servers() const { return servers_; }
  /// The first start of the server whose topics have this name; null when there is none.
  const RecordedServer* Find(std::string_view name) const;
  const std::vector<mcap::Metadata>& metadata() const { return metadata_; }
  const std::string& path() const { return path_; }

 private:
  RecordedSession(std::string path, MappedFile file)
      : path_(std::move(path)), file_(std::move(file)) {}

  std::string path_;
  MappedFile file_;
  std::deque<std::string> unpacked_;  ///< Records of compressed chunks, which ticks borrow.
  std::vector<RecordedServer> servers_;
  std::vector<mcap::Metadata> metadata_;
};

/// The tick with those of its channels that are among `fields`; all of them when that is empty.
/// InvalidData that names the channel when a message does not parse.
Result<v1::Tick> ReadTick(const RecordedTick& recorded,
                          const std::vector<std::uint32_t>& fields = {});

/// Every tick of a server, in order.
Result<std::vector<v1::Tick>> ReadTicks(const RecordedServer& server,
                                        const std::vector<std::uint32_t>& fields = {});

/// How a recorded device presented itself to its host.
struct RecordedIdentity {
  std::uint32_t bus = 0;  ///< As in the kernel's input.h.
  std::uint32_t vendor = 0;
  std::uint32_t product = 0;
  std::string name;
  std::string serial;
};

/// As the status says; recordings of before 2026-11 say no bus, vendor and product: what devices of
/// its kind and name have then.
RecordedIdentity IdentityOf(const v1::DeviceStatus& status);

/// A feature report. Recordings of before 2026-11 do not flag those of a PS Move, which have ids of
/// their own.
bool IsFeature(const v1::RawReport& report, const v1::DeviceStatus& status);

}  // namespace footing::recording
