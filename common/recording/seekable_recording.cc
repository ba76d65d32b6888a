#include "common/recording/seekable_recording.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "common/base/units.h"
#include "common/recording/mcap_reader.h"
#include "common/recording/mcap_records.h"

namespace footing::playback {
namespace {

namespace pb = google::protobuf;

/// Limit for one file, 36 hours: what is kept of them takes some 90 MB.
constexpr std::size_t kMostChunks = 131'072;
constexpr std::uint64_t kMostIndexBytes = 64ull << 20;
/// Limits for all sessions and clocks, and for one message.
constexpr std::uint64_t kMostMetadataBytes = 64ull << 20;
constexpr std::size_t kMostMessageBytes = std::size_t{64} << 20;

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

/// Parses the message into its field of the tick; false when it makes no sense.
bool Parse(std::uint32_t field, std::string_view bytes, v1::Tick& tick) {
  const pb::FieldDescriptor* descriptor =
      v1::Tick::descriptor()->FindFieldByNumber(static_cast<int>(field));
  pb::Message* message = tick.GetReflection()->MutableMessage(&tick, descriptor);
  return message->ParseFromArray(bytes.data(), static_cast<int>(bytes.size()));
}

}  // namespace

Result<SeekableRecording> SeekableRecording::Open(const std::string& path,
                                                  const std::vector<std::string>& names,
                                                  const std::set<std::string>& channels) {
  Result<recording::MappedFile> file = recording::MappedFile::Open(path);
  if (!file) return file.error();
  SeekableRecording opened(path, std::move(*file));
  for (const std::string& name : names) opened.servers_.emplace_back().name = name;
  if (const Result<void> read = opened.ReadIndex(); !read) {
    return InvalidData(path + ": " + read.error().message);
  }
  opened.PlaceChannels(channels);
  opened.ReadMetadata();
  opened.FindEnds();
  if (opened.first_ns_ > opened.last_ns_) {
    std::string of;
    for (const std::string& name : names) of += (of.empty() ? "" : " or ") + name;
    const std::string limits = opened.Limits();
    return InvalidData(path + " holds no ticks of " + of + (limits.empty() ? "" : "; " + limits));
  }
  return opened;
}

Result<void> SeekableRecording::ReadIndex() {
  const Result<void> found = FindIndex();
  std::erase_if(summary_.chunks, [this](const mcap::ChunkIndex& chunk) {
    const bool refused = !IsInstant(chunk.start_time_ns) || !IsInstant(chunk.end_time_ns);
    if (refused) usable_chunks_[chunk.chunk_offset] = false;
    return refused;
  });
  return found;
}

Result<void> SeekableRecording::FindIndex() {
  Result<mcap::Summary> summary = mcap::ReadSummary(file_.bytes(), kMostIndexBytes);
  if (summary && summary->chunks.size() <= kMostChunks &&
      (!summary->chunks.empty() || summary->statistics.message_count == 0)) {
    summary_ = std::move(*summary);
    return {};
  }
  Result<mcap::RebuiltIndex> rebuilt =
      mcap::RebuildIndex(file_.bytes(), kMostChunks, kMostIndexBytes);
  if (!rebuilt) return rebuilt.error();
  summary_ = std::move(rebuilt->summary);
  problem_ = rebuilt->problem.empty() ? "it has no index" : rebuilt->problem;
  return {};
}

void SeekableRecording::PlaceChannels(const std::set<std::string>& channels) {
  for (const auto& [id, channel] : summary_.channels) {
    const std::size_t slash = channel.topic.rfind('/');
    if (slash == std::string::npos || slash == 0 || channel.topic[0] != '/') continue;
    const std::string name = channel.topic.substr(slash + 1);
    const pb::FieldDescriptor* field = v1::Tick::descriptor()->FindFieldByName(name);
    if (field == nullptr || field->message_type() == nullptr || channels.count(name) == 0) continue;
    for (std::size_t i = 0; i < servers_.size(); ++i) {
      if (servers_[i].name != channel.topic.substr(1, slash - 1)) continue;
      channels_[id] = {i, static_cast<std::uint32_t>(field->number())};
      servers_[i].channels[name] = id;
    }
  }
}

void SeekableRecording::ReadMetadata() {
  std::uint64_t bytes = 0;
  for (const mcap::MetadataIndex& index : summary_.metadata) {
    if (index.name != "session" && index.name != "clock") continue;
    if (index.offset > file_.bytes().size()) continue;
    mcap::Cursor head(file_.bytes().substr(index.offset));
    const auto opcode = static_cast<mcap::Opcode>(head.U8());
    const std::string_view body = head.Bytes(head.U64());
    if (!head.ok() || opcode != mcap::Opcode::kMetadata) continue;
    bytes += body.size();
    if (bytes > kMostMetadataBytes) return;
    if (const auto metadata = mcap::DecodeMetadata(body)) TakeMetadata(*metadata);
  }
}

void SeekableRecording::TakeMetadata(const mcap::Metadata& metadata) {
  const auto named = metadata.values.find("server");
  if (named == metadata.values.end()) return;
  const auto server = std::find_if(servers_.begin(), servers_.end(),
                                   [&named](const auto& one) { return one.name == named->second; });
  if (server == servers_.end()) return;
  if (metadata.name == "clock") {
    TakeClock(metadata.values, *server);
    return;
  }
  const std::optional<std::int64_t> wall_ns = TakeSession(metadata.values, *server);
  if (!wall_minus_clock_ns_) wall_minus_clock_ns_ = wall_ns;
}

void SeekableRecording::FindEnds() {
  first_ns_ = kNever;
  last_ns_ = std::numeric_limits<std::int64_t>::min();
  const auto take = [this](const mcap::Message& message) {
    first_ns_ = std::min(first_ns_, TimeOf(message));
    last_ns_ = std::max(last_ns_, TimeOf(message));
  };
  // Inwards from both ends, to the first chunk that yields a message of the channel.
  const auto search = [&](auto from, auto to) {
    std::set<std::uint16_t> found;
    for (auto chunk = from; chunk != to && found.size() < channels_.size(); ++chunk) {
      for (const auto& [id, offset] : chunk->message_index_offsets) {
        if (channels_.count(id) == 0 || found.count(id) > 0) continue;
        ReadChannel(*chunk, id, [&](const mcap::Message& message) {
          take(message);
          found.insert(message.channel_id);
        });
      }
    }
  };
  search(summary_.chunks.begin(), summary_.chunks.end());
  search(summary_.chunks.rbegin(), summary_.chunks.rend());
}

std::string SeekableRecording::Limits() const {
  std::string limits = problem_;
  const auto damaged = std::count_if(usable_chunks_.begin(), usable_chunks_.end(),
                                     [](const auto& chunk) { return !chunk.second; });
  if (damaged > 0) {
    limits +=
        (limits.empty() ? "" : ", ") + std::to_string(damaged) + " damaged chunks are left out";
  }
  if (limits.empty()) return "";
  return "the recording is not whole: " + limits + "; repair it with: footing-log repair " + path_ +
         " --out FILE";
}

std::int64_t SeekableRecording::TimeOf(const mcap::Message& message) const {
  const RecordedServer& server = servers_[channels_.at(message.channel_id).server];
  return static_cast<std::int64_t>(message.log_time_ns) - server.offset_ns;
}

PlacedTick SeekableRecording::Place(const mcap::Message& message) const {
  PlacedTick placed;
  placed.server = channels_.at(message.channel_id).server;
  const RecordedServer& server = servers_[placed.server];
  const auto host_ns = static_cast<std::int64_t>(message.log_time_ns);
  const auto recorded_ns = static_cast<std::int64_t>(message.publish_time_ns);
  placed.offset_ns = server.offset_ns;
  placed.time_ns = host_ns - server.offset_ns;
  placed.live = IsLive(server, host_ns, recorded_ns);
  if (placed.live) placed.delay_ns = std::max<std::int64_t>(0, recorded_ns - placed.time_ns);
  placed.tick.set_host_ns(host_ns);
  placed.tick.set_sequence(message.sequence);
  return placed;
}

void SeekableRecording::ReadChannel(const mcap::ChunkIndex& chunk, std::uint16_t channel,
                                    const std::function<void(const mcap::Message&)>& handler) {
  if (!IsUsable(chunk)) return;
  // It was checked: there is no other way to fail.
  (void)mcap::VisitChannel(file_.bytes(), chunk, channel, handler).ok();
}

bool SeekableRecording::IsUsable(const mcap::ChunkIndex& chunk) {
  const auto [known, fresh] = usable_chunks_.emplace(chunk.chunk_offset, false);
  if (!fresh || !mcap::CheckChunk(file_.bytes(), chunk)) return known->second;
  bool within = true;
  const auto check = [&](const mcap::Message& message) {
    if (channels_.count(message.channel_id) == 0) return;
    within = within && message.data.size() <= kMostMessageBytes && IsInstant(message.log_time_ns) &&
             IsInstant(message.publish_time_ns);
  };
  known->second = mcap::VisitChunk(file_.bytes(), chunk, check).ok() && within;
  return known->second;
}

std::vector<PlacedTick> SeekableRecording::Ticks(std::int64_t from_ns, std::int64_t to_ns) {
  std::vector<PlacedTick> ticks;
  std::map<std::pair<std::int64_t, std::pair<std::size_t, std::uint64_t>>, std::size_t> places;
  const auto take = [&](const mcap::Message& message) {
    const auto channel = channels_.find(message.channel_id);
    if (channel == channels_.end()) return;
    const std::int64_t time_ns = TimeOf(message);
    if (time_ns < from_ns || time_ns >= to_ns) return;
    const auto [place, fresh] = places.emplace(
        std::pair{time_ns, std::pair{channel->second.server, message.sequence}}, ticks.size());
    if (fresh) ticks.push_back(Place(message));
    v1::Tick& tick = ticks[place->second].tick;
    const pb::FieldDescriptor* field =
        v1::Tick::descriptor()->FindFieldByNumber(static_cast<int>(channel->second.field));
    // A channel that a resume sends again is here already.
    if (tick.GetReflection()->HasField(tick, field)) return;
    if (!Parse(channel->second.field, message.data, tick)) {
      tick.GetReflection()->ClearField(&tick, field);
    }
  };
  for (const mcap::ChunkIndex& chunk : summary_.chunks) {
    const bool meets = std::any_of(servers_.begin(), servers_.end(), [&](const auto& server) {
      return static_cast<std::int64_t>(chunk.end_time_ns) - server.offset_ns >= from_ns &&
             static_cast<std::int64_t>(chunk.start_time_ns) - server.offset_ns < to_ns;
    });
    if (meets && IsUsable(chunk)) (void)mcap::VisitChunk(file_.bytes(), chunk, take).ok();
  }
  std::stable_sort(ticks.begin(), ticks.end(),
                   [](const PlacedTick& a, const PlacedTick& b) { return a.time_ns < b.time_ns; });
  return ticks;
}

std::optional<PlacedTick> SeekableRecording::LastOf(std::size_t server, const std::string& channel,
                                                    std::int64_t at_ns, bool or_next) {
  const auto id = servers_[server].channels.find(channel);
  if (id == servers_[server].channels.end()) return std::nullopt;
  std::optional<mcap::Message> last, next;
  std::string last_data, next_data;  // A message is valid only while it is shown.
  const auto time_of = [this](const std::optional<mcap::Message>& message) {
    return message ? TimeOf(*message) : kNever;
  };
  const auto take = [&](const mcap::Message& message) {
    const std::int64_t time_ns = TimeOf(message);
    if (time_ns <= at_ns && (!last || time_ns > time_of(last))) {
      last = message;
      last_data = message.data;
    }
    if (time_ns > at_ns && time_ns < time_of(next)) {
      next = message;
      next_data = message.data;
    }
  };
  const std::int64_t offset_ns = servers_[server].offset_ns;
  for (auto chunk = summary_.chunks.rbegin(); chunk != summary_.chunks.rend(); ++chunk) {
    if (chunk->message_index_offsets.count(id->second) == 0) continue;
    const std::int64_t start_ns = static_cast<std::int64_t>(chunk->start_time_ns) - offset_ns;
    const std::int64_t end_ns = static_cast<std::int64_t>(chunk->end_time_ns) - offset_ns;
    if (start_ns <= at_ns && (!last || end_ns > time_of(last))) {
      ReadChannel(*chunk, id->second, take);
    }
  }
  for (auto chunk = summary_.chunks.begin(); or_next && !last && chunk != summary_.chunks.end();
       ++chunk) {
    if (chunk->message_index_offsets.count(id->second) == 0) continue;
    const std::int64_t start_ns = static_cast<std::int64_t>(chunk->start_time_ns) - offset_ns;
    if (start_ns < time_of(next)) ReadChannel(*chunk, id->second, take);
  }
  const std::optional<mcap::Message>& found = last ? last : next;
  if (!found || (!last && !or_next)) return std::nullopt;
  PlacedTick placed = Place(*found);
  if (!Parse(channels_.at(id->second).field, last ? last_data : next_data, placed.tick)) {
    return std::nullopt;
  }
  return placed;
}

void SeekableRecording::Visit(std::size_t server, const std::string& channel,
                              const std::function<void(const PlacedTick&)>& handler) {
  const auto id = servers_[server].channels.find(channel);
  if (id == servers_[server].channels.end()) return;
  std::set<std::pair<std::int64_t, std::uint64_t>> seen;
  for (const mcap::ChunkIndex& chunk : summary_.chunks) {
    if (chunk.message_index_offsets.count(id->second) == 0) continue;
    ReadChannel(chunk, id->second, [&](const mcap::Message& message) {
      PlacedTick placed = Place(message);
      if (!Parse(channels_.at(id->second).field, message.data, placed.tick)) return;
      if (seen.emplace(placed.time_ns, placed.tick.sequence()).second) handler(placed);
    });
  }
}

}  // namespace footing::playback
