#include "daemon/offline/eval/replay/recorded.h"

#include <map>

#include "common/mcap/walk.h"
#include "common/recording/mapped_file.h"

namespace footing::eval {
namespace {

using Ticks = std::map<std::uint32_t, v1::Tick>;  // By sequence.

/// Parses a channel's message into its place in the tick.
bool ParseInto(v1::Tick& tick, const std::string& channel, std::string_view data) {
  const auto parse = [data](google::protobuf::MessageLite& message) {
    return message.ParseFromArray(data.data(), static_cast<int>(data.size()));
  };
  if (channel == "status") return parse(*tick.mutable_status());
  if (channel == "raw") return parse(*tick.mutable_raw());
  if (channel == "features") return parse(*tick.mutable_features());
  if (channel == "characters") return parse(*tick.mutable_characters());
  if (channel == "setup") return parse(*tick.mutable_setup());
  if (channel == "inputs") return parse(*tick.mutable_inputs());
  return true;
}

std::vector<v1::Tick> InOrder(Ticks ticks) {
  std::vector<v1::Tick> list;
  for (auto& [sequence, tick] : ticks) list.push_back(std::move(tick));
  return list;
}

}  // namespace

Result<Recorded> ReadRecorded(const std::string& path) {
  auto file = recording::MappedFile::Open(path);
  if (!file) return file.error();
  std::map<std::uint16_t, std::string> topics;
  Ticks sensor;
  Ticks simulation;
  std::string wrong;
  mcap::Visitor visitor;
  visitor.channel = [&topics](const mcap::Channel& channel) { topics[channel.id] = channel.topic; };
  visitor.message = [&](const mcap::Message& message) {
    const std::string& topic = topics[message.channel_id];
    const bool is_sensor = topic.starts_with("/footingd/");
    if (!is_sensor && !topic.starts_with("/footing-sim/")) return;
    const std::string channel = topic.substr(topic.rfind('/') + 1);
    v1::Tick& tick = (is_sensor ? sensor : simulation)[message.sequence];
    if (tick.sequence() != 0 && tick.host_ns() != static_cast<std::int64_t>(message.log_time_ns)) {
      return;  // A snapshot shares the sequence of another tick.
    }
    tick.set_sequence(message.sequence);
    tick.set_host_ns(static_cast<std::int64_t>(message.log_time_ns));
    if (!ParseInto(tick, channel, message.data)) {
      wrong = topic + ", sequence " + std::to_string(message.sequence);
    }
  };
  const mcap::WalkEnd end = mcap::Walk(file->bytes(), visitor, mcap::WalkMode::kStrict);
  if (!end.complete) {
    return InvalidData(path + ": " + end.problem + " (byte " + std::to_string(end.problem_offset) +
                       "); mend it with: footing-log repair " + path + " --out FILE");
  }
  if (!wrong.empty()) return InvalidData(path + ": a message that does not parse: " + wrong);
  return Recorded{InOrder(std::move(sensor)), InOrder(std::move(simulation))};
}

}  // namespace footing::eval
