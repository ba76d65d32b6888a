#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/base/result.h"
#include "common/recording/mcap_reader.h"
#include "common/recording/recording_server.h"
#include "common/recording/recording_writer.h"
#include "footing/v1/session.pb.h"

namespace footing::playback {

/// A tick at its place in a recording.
struct PlacedTick {
  std::int64_t time_ns = 0;    ///< When it was made, on the recorder's clock.
  std::size_t server = 0;      ///< Counts in the names given to Open.
  bool live = false;           ///< It came as it was made: neither a snapshot nor a refill.
  std::int64_t offset_ns = 0;  ///< Server's clock minus the recorder's.
  std::int64_t delay_ns = 0;   ///< From when it was made until it was recorded; 0 unless live.
  v1::Tick tick;
};

/// A recording that is read from any place, without being loaded: its index stays in memory, some
/// 0.7 kB for each second recorded, and messages are read where they are needed.
///
/// All instants are CLOCK_MONOTONIC of the recorder's host, in nanoseconds. A file without an index
/// (its recorder was killed) is read once from end to end when it is opened.
class SeekableRecording {
 public:
  /// `names` are servers of the topics ("footing-sim"), `channels` fields of v1::Tick; others are
  /// not read. InvalidData when there is nothing to play.
  static Result<SeekableRecording> Open(const std::string& path,
                                        const std::vector<std::string>& names,
                                        const std::set<std::string>& channels);

  /// Times of the first and last message of these servers.
  std::int64_t first_ns() const { return first_ns_; }
  std::int64_t last_ns() const { return last_ns_; }
  bool Has(std::size_t server) const { return !servers_[server].channels.empty(); }
  /// Parts of a cut or damaged file that cannot be played, and the repair; empty when all can.
  std::string Limits() const;
  /// UNIX time less the recorder's clock; nothing when the recording does not say.
  std::optional<std::int64_t> wall_minus_clock_ns() const { return wall_minus_clock_ns_; }
  const std::string& path() const { return path_; }

  /// The ticks with from_ns <= time < to_ns, by time.
  std::vector<PlacedTick> Ticks(std::int64_t from_ns, std::int64_t to_ns);

  /// The last tick at or before `at_ns` that has this channel, with that channel alone; the first
  /// one behind it when `or_next` and there is none. Nothing when there is no such message.
  std::optional<PlacedTick> LastOf(std::size_t server, const std::string& channel,
                                   std::int64_t at_ns, bool or_next = false);

  /// Every tick of one channel of one server, with that channel alone, in the order of the file;
  /// what a resume sent again comes once.
  void Visit(std::size_t server, const std::string& channel,
             const std::function<void(const PlacedTick&)>& handler);

 private:
  struct ChannelPlace {
    std::size_t server = 0;
    std::uint32_t field = 0;  ///< Field of v1::Tick.
  };

  SeekableRecording(std::string path, recording::MappedFile file)
      : path_(std::move(path)), file_(std::move(file)) {}
  Result<void> ReadIndex();
  Result<void> FindIndex();
  void PlaceChannels(const std::set<std::string>& channels);
  void ReadMetadata();
  void TakeMetadata(const mcap::Metadata& metadata);
  void FindEnds();
  std::int64_t TimeOf(const mcap::Message& message) const;
  PlacedTick Place(const mcap::Message& message) const;
  /// The chunk's CRC and records are right, and its messages within the limits of size and time;
  /// checked at its first use.
  bool IsUsable(const mcap::ChunkIndex& chunk);
  void ReadChannel(const mcap::ChunkIndex& chunk, std::uint16_t channel,
                   const std::function<void(const mcap::Message&)>& handler);

  std::string path_;
  recording::MappedFile file_;
  mcap::Summary summary_;
  std::string problem_;  ///< Problem of a file without an index.
  std::vector<RecordedServer> servers_;
  std::map<std::uint16_t, ChannelPlace> channels_;
  std::map<std::uint64_t, bool> usable_chunks_;  ///< Those checked, by offset.
  std::optional<std::int64_t> wall_minus_clock_ns_;
  std::int64_t first_ns_ = 0;
  std::int64_t last_ns_ = 0;
};

}  // namespace footing::playback
