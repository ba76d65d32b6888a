#include "clients/log/tables.h"

#include "clients/log/contents.h"

namespace footing::log_client {

Result<void> Tables::Learn() {
  mcap::Visitor visitor;
  visitor.schema = [this](const mcap::Schema& schema) {
    if (const Result<void> added = pool_.Add(schema); !added) {
      Fail(InvalidData(path_ + ": " + added.error().message));
    }
  };
  visitor.channel = [this](const mcap::Channel& channel) {
    TopicTable& topic = topics_[channel.id];
    topic.topic = channel.topic;
    topic.schema_id = channel.schema_id;
  };
  visitor.metadata = [this](const mcap::Metadata& metadata) {
    if (metadata.name == "session") notes_.TakeSession(metadata.values);
  };
  visitor.message = [this](const mcap::Message& record) {
    TopicTable& topic = topics_[record.channel_id];
    const google::protobuf::Message* parsed = Parse(topic, record);
    if (parsed == nullptr) return;
    notes_.TakeTime(record.log_time_ns);
    notes_.Take(topic.topic, record.data);
    if (!topic.table) topic.table.emplace(*parsed->GetDescriptor());
    Fail(topic.table->Learn(*parsed));
  };
  const mcap::WalkEnd end = mcap::Walk(bytes_, visitor, mcap::WalkMode::kStrict);
  if (!first_failure_) return first_failure_.error();
  if (const std::optional<Error> incomplete = Incomplete(path_, end)) return *incomplete;
  return {};
}

Result<void> Tables::Walk(const Visit& visit) {
  mcap::Visitor visitor;
  visitor.message = [&](const mcap::Message& record) {
    if (!first_failure_) return;
    const TopicTable& topic = topics_[record.channel_id];
    const google::protobuf::Message* parsed = Parse(topic, record);
    if (parsed == nullptr) return;
    notes_.Take(topic.topic, record.data);
    Fail(visit(record.channel_id, record, *parsed));
  };
  mcap::Walk(bytes_, visitor, mcap::WalkMode::kStrict);
  return first_failure_;
}

const google::protobuf::Message* Tables::Parse(const TopicTable& topic,
                                               const mcap::Message& record) {
  const google::protobuf::Message* parsed = pool_.Parse(topic.schema_id, record.data);
  if (parsed == nullptr) {
    Fail(InvalidData(path_ + ": a message on " + topic.topic + " does not fit its schema"));
  }
  return parsed;
}

}  // namespace footing::log_client
