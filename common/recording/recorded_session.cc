#include "common/recording/recorded_session.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <utility>

#include <google/protobuf/descriptor.h>

#include "common/base/units.h"
#include "common/net/tick.h"
#include "common/recording/mcap_reader.h"
#include "common/stream/product_ids.h"

namespace footing::recording {
namespace {

namespace pb = google::protobuf;

/// The value of a metadata entry as a number; what was there before when it is none.
template <typename Number>
void ReadNumber(const mcap::TextMap& values, const std::string& key, Number& number) {
  const auto found = values.find(key);
  if (found == values.end()) return;
  Number read{};
  const char* const end = found->second.data() + found->second.size();
  if (std::from_chars(found->second.data(), end, read).ptr == end) number = read;
}

/// The field of v1::Tick that a topic's messages are; 0 for other topics and for channels of a
/// later version.
std::uint32_t FieldOf(const std::string& channel) {
  const pb::FieldDescriptor* field = v1::Tick::descriptor()->FindFieldByName(channel);
  const bool is_channel = field != nullptr && field->message_type() != nullptr;
  return is_channel ? static_cast<std::uint32_t>(field->number()) : 0;
}

/// Puts messages into the ticks of their servers, in the order of the file.
class TickCollector {
 public:
  explicit TickCollector(std::vector<RecordedServer>& servers) : servers_(servers) {}

  void OnChannel(const mcap::Channel& channel) {
    const std::size_t slash = channel.topic.rfind('/');
    if (slash == std::string::npos || slash == 0 || channel.topic[0] != '/') return;
    topics_[channel.id] = {channel.topic.substr(1, slash - 1),
                           FieldOf(channel.topic.substr(slash + 1))};
  }

  void OnSession(const mcap::TextMap& values) {
    std::uint64_t epoch = 0;
    ReadNumber(values, "epoch", epoch);
    RecordedServer& server = At(mcap::TextOf(values, "server"), epoch);
    server.server_id = mcap::TextOf(values, "server_id");
    server.version = mcap::TextOf(values, "server_version");
    server.epoch = epoch;
    double rate_hz = 0;
    ReadNumber(values, "tick_rate_hz", rate_hz);
    if (transport::IsTickRate(rate_hz)) server.tick_rate_hz = rate_hz;
    ReadNumber(values, "server_host_ns", server.host_ns);
    ReadNumber(values, "server_wall_time_ns", server.wall_time_ns);
  }

  void OnMessage(const mcap::Message& message) {
    const Topic& topic = topics_[message.channel_id];
    if (topic.field == 0) return;
    if (!IsInstant(message.log_time_ns)) {
      no_instant_ns_ = message.log_time_ns;
      return;
    }
    const std::size_t server = Latest(topic.server);
    RecordedTick& tick = ticks_[server][message.sequence];
    const auto host_ns = static_cast<std::int64_t>(message.log_time_ns);
    if (tick.channels.empty()) {
      tick.host_ns = host_ns;
      tick.sequence = message.sequence;
    }
    // The snapshot of a new connection shares the sequence of another tick, and what a resume sends
    // again is here already.
    if (tick.host_ns != host_ns) return;
    for (const RecordedChannel& channel : tick.channels) {
      if (channel.field == topic.field) return;
    }
    tick.channels.push_back({topic.field, message.data});
  }

  Result<void> Finish() {
    if (no_instant_ns_) {
      return InvalidData("a message has the time " + std::to_string(*no_instant_ns_) +
                         " ns, which no clock of a host can show");
    }
    for (auto& [server, ticks] : ticks_) {
      for (auto& [sequence, tick] : ticks) servers_[server].ticks.push_back(std::move(tick));
    }
    return {};
  }

 private:
  struct Topic {
    std::string server;
    std::uint32_t field = 0;
  };

  std::size_t Latest(const std::string& name) {
    const auto [found, fresh] = latest_.emplace(name, servers_.size());
    if (fresh) {
      servers_.emplace_back();
      servers_.back().name = name;
      servers_.back().server_id = name;
    }
    return found->second;
  }

  /// The entry of this start of the server; a new one when the epoch is another than the latest's.
  RecordedServer& At(const std::string& name, std::uint64_t epoch) {
    const std::size_t latest = Latest(name);
    if (servers_[latest].epoch == 0 || servers_[latest].epoch == epoch) return servers_[latest];
    latest_.erase(name);
    return servers_[Latest(name)];
  }

  std::vector<RecordedServer>& servers_;
  std::map<std::uint16_t, Topic> topics_;
  std::map<std::string, std::size_t> latest_;
  std::map<std::size_t, std::map<std::uint32_t, RecordedTick>> ticks_;
  std::optional<std::uint64_t> no_instant_ns_;  ///< Time of a message that no clock can show.
};

}  // namespace

Result<RecordedSession> RecordedSession::Open(const std::string& path) {
  Result<MappedFile> file = OpenRecording(path);
  if (!file) return file.error();
  RecordedSession session(path, std::move(*file));
  TickCollector collector(session.servers_);
  mcap::Visitor visitor;
  visitor.unpacked = &session.unpacked_;
  visitor.channel = [&](const mcap::Channel& channel) { collector.OnChannel(channel); };
  visitor.message = [&](const mcap::Message& message) { collector.OnMessage(message); };
  visitor.metadata = [&](const mcap::Metadata& metadata) {
    if (metadata.name == "session") collector.OnSession(metadata.values);
    session.metadata_.push_back(metadata);
  };
  const mcap::WalkEnd end = mcap::Walk(session.file_.bytes(), visitor, mcap::WalkMode::kStrict);
  if (!end.complete) {
    return InvalidData(path + ": " + end.problem + " (byte " + std::to_string(end.problem_offset) +
                       "); repair it with: footing-log repair " + path + " --out FILE");
  }
  if (const auto finished = collector.Finish(); !finished) {
    return InvalidData(path + ": " + finished.error().message);
  }
  return session;
}

const RecordedServer* RecordedSession::Find(std::string_view name) const {
  const auto found = std::find_if(servers_.begin(), servers_.end(), [&](const auto& server) {
    return server.name == name && !server.ticks.empty();
  });
  return found == servers_.end() ? nullptr : &*found;
}

Result<v1::Tick> ReadTick(const RecordedTick& recorded, const std::vector<std::uint32_t>& fields) {
  v1::Tick tick;
  tick.set_host_ns(recorded.host_ns);
  tick.set_sequence(recorded.sequence);
  for (const RecordedChannel& channel : recorded.channels) {
    if (!fields.empty() && std::find(fields.begin(), fields.end(), channel.field) == fields.end()) {
      continue;
    }
    const pb::FieldDescriptor* field =
        v1::Tick::descriptor()->FindFieldByNumber(static_cast<int>(channel.field));
    pb::Message* message = tick.GetReflection()->MutableMessage(&tick, field);
    if (!message->ParseFromArray(channel.bytes.data(), static_cast<int>(channel.bytes.size()))) {
      return InvalidData("a message of " + field->name() + " does not parse, sequence " +
                         std::to_string(recorded.sequence));
    }
  }
  return tick;
}

Result<std::vector<v1::Tick>> ReadTicks(const RecordedServer& server,
                                        const std::vector<std::uint32_t>& fields) {
  std::vector<v1::Tick> ticks;
  ticks.reserve(server.ticks.size());
  for (const RecordedTick& recorded : server.ticks) {
    Result<v1::Tick> tick = ReadTick(recorded, fields);
    if (!tick) return InvalidData("/" + server.name + ": " + tick.error().message);
    ticks.push_back(std::move(*tick));
  }
  return ticks;
}

namespace {

constexpr char kMoveData = 0x01;

}  // namespace

RecordedIdentity IdentityOf(const v1::DeviceStatus& status) {
  RecordedIdentity identity{status.bus(), status.vendor(), status.product(), status.name(),
                            status.serial()};
  if (identity.vendor != 0) return identity;
  const bool move = status.kind() == v1::DEVICE_KIND_PS_MOVE;
  const bool inside = status.name().ends_with("-TR");
  identity.bus = static_cast<std::uint32_t>(stream::Bus::kBluetooth);
  identity.vendor = move ? stream::kVendorSony : stream::kVendorNintendo;
  // A PS Move of the second type was never recorded without its product.
  identity.product = move     ? stream::kProductZcm1
                     : inside ? stream::kProductTr
                              : stream::kProductFirst;
  return identity;
}

bool IsFeature(const v1::RawReport& report, const v1::DeviceStatus& status) {
  if (report.feature()) return true;
  const bool move = status.kind() == v1::DEVICE_KIND_PS_MOVE;
  return move && !report.to_device() &&
         (report.report().empty() || report.report()[0] != kMoveData);
}

}  // namespace footing::recording
