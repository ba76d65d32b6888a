#include <map>
#include <optional>

#include "clients/ctl/acceptance_run.h"
#include "clients/ctl/acceptance_text.h"
#include "common/mcap/walk.h"
#include "common/recording/mapped_file.h"

namespace footing::ctl {
namespace {

/// Parses a channel's message into its place in the tick.
bool ParseInto(v1::Tick& tick, const std::string& channel, std::string_view data) {
  const auto parse = [data](google::protobuf::MessageLite& message) {
    return message.ParseFromArray(data.data(), static_cast<int>(data.size()));
  };
  if (channel == "status") return parse(*tick.mutable_status());
  if (channel == "motion") return parse(*tick.mutable_motion());
  if (channel == "boards") return parse(*tick.mutable_boards());
  if (channel == "features") return parse(*tick.mutable_features());
  return true;
}

}  // namespace

Result<AcceptanceVerdict> ReplayAcceptance(const std::string& path) {
  auto file = recording::MappedFile::Open(path);
  if (!file) return file.error();
  std::map<std::uint16_t, std::string> topics;
  std::map<std::uint64_t, v1::Tick> ticks;  // By time of footingd.
  std::optional<std::map<std::string, std::string>> metadata;
  std::string wrong;
  mcap::Visitor visitor;
  visitor.channel = [&](const mcap::Channel& channel) { topics[channel.id] = channel.topic; };
  visitor.message = [&](const mcap::Message& message) {
    const std::string& topic = topics[message.channel_id];
    if (!topic.starts_with("/footingd/")) return;
    v1::Tick& tick = ticks[message.log_time_ns];
    tick.set_host_ns(static_cast<std::int64_t>(message.log_time_ns));
    if (!ParseInto(tick, topic.substr(topic.rfind('/') + 1), message.data)) {
      wrong = topic + ", sequence " + std::to_string(message.sequence);
    }
  };
  visitor.metadata = [&](const mcap::Metadata& one) {
    if (one.name == "acceptance") metadata.emplace(one.values.begin(), one.values.end());
  };
  const mcap::WalkEnd end = mcap::Walk(file->bytes(), visitor, mcap::WalkMode::kStrict);
  if (!end.complete) {
    return InvalidData(path + ": " + end.problem +
                       "; the run did not end, so there is no verdict to compute again");
  }
  if (!wrong.empty()) return InvalidData(path + ": a message that does not parse: " + wrong);
  if (!metadata) {
    return InvalidData(path +
                       " is no recording of an acceptance; make one with: footing-ctl "
                       "acceptance --out FILE.mcap");
  }
  const auto plan = ReadAcceptanceMetadata(*metadata);
  if (!plan) return InvalidData(path + ": " + plan.error().message);
  guide::Acceptance acceptance(plan->rig, plan->layout);
  auto span = plan->spans.begin();
  for (const auto& [time_ns, tick] : ticks) {
    if (span != plan->spans.end() && tick.host_ns() >= span->from_ns) {
      acceptance.Begin(span->phase, span->from_ns);
      ++span;
    }
    if (span == plan->spans.end() && !plan->spans.empty() &&
        tick.host_ns() >= plan->spans.back().to_ns) {
      acceptance.End(plan->spans.back().to_ns);
    }
    TakeTick(tick, acceptance);
  }
  return AcceptanceVerdict{acceptance.Checks(), path};
}

}  // namespace footing::ctl
