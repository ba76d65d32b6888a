#include "clients/log/foxglove.h"

#include <filesystem>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include <google/protobuf/message.h>

#include "clients/log/contents.h"
#include "common/foxglove/scene.h"
#include "common/recording/mcap_reader.h"
#include "common/recording/mcap_writer.h"
#include "common/recording/recording_writer.h"
#include "footing/v1/session.pb.h"

namespace footing::log_client {
namespace {

/// Copies a recording message by message and adds Foxglove's behind those that they are made of.
class FoxgloveCopier {
 public:
  FoxgloveCopier(recording::OutputFile& file, const std::string& library, std::string path)
      : file_(file),
        path_(std::move(path)),
        writer_({"", library}, {}),
        scene_([this](const auto& topic, const auto& message, const auto& stamp) {
          return Add(topic, message, stamp);
        }) {}

  /// The first pass: ids of our topics are above those of the recording.
  mcap::Visitor Learner() {
    mcap::Visitor visitor;
    visitor.schema = [this](const mcap::Schema& schema) {
      if (!schema.name.starts_with("foxglove.")) writer_.CopySchema(schema);
    };
    visitor.channel = [this](const mcap::Channel& channel) {
      if (channel.topic.starts_with(foxglove_scene::kTopics)) {
        dropped_.insert(channel.id);
        return;
      }
      writer_.CopyChannel(channel);
      const std::size_t slash = channel.topic.rfind('/');
      if (slash == std::string::npos || slash == 0) return;
      const auto* field = v1::Tick::descriptor()->FindFieldByName(channel.topic.substr(slash + 1));
      if (field == nullptr || field->message_type() == nullptr) return;
      sources_[channel.id] = {channel.topic.substr(1, slash - 1), field};
    };
    return visitor;
  }

  mcap::Visitor Copier() {
    mcap::Visitor visitor;
    visitor.message = [this](const mcap::Message& message) { Copy(message); };
    visitor.attachment = [this](const mcap::Attachment& attachment) { writer_.Add(attachment); };
    visitor.metadata = [this](const mcap::Metadata& metadata) { writer_.Add(metadata); };
    visitor.chunk = [this](const mcap::Chunk& chunk) {
      writer_.SetCompress(chunk.compression == mcap::kZstd);
    };
    return visitor;
  }

  Result<std::vector<FoxgloveTopic>> Finish() {
    writer_.Finish();
    WriteDown();
    if (!done_) return done_.error();
    if (const auto synced = file_.Sync(); !synced) return synced.error();
    std::vector<FoxgloveTopic> topics;
    for (const auto& [name, added] : added_) topics.push_back(added.topic);
    return topics;
  }

 private:
  /// Where a topic's messages belong in a tick.
  struct Source {
    std::string server;
    const google::protobuf::FieldDescriptor* field = nullptr;
  };
  struct Added {
    std::uint16_t channel = 0;
    FoxgloveTopic topic;
  };

  void Copy(const mcap::Message& message) {
    if (dropped_.contains(message.channel_id)) return;
    writer_.Add(message);
    const auto source = sources_.find(message.channel_id);
    if (done_ && source != sources_.end()) {
      v1::Tick tick;
      google::protobuf::Message* part =
          tick.GetReflection()->MutableMessage(&tick, source->second.field);
      const recording::Stamp stamp{static_cast<std::int64_t>(message.log_time_ns),
                                   static_cast<std::int64_t>(message.publish_time_ns),
                                   message.sequence};
      if (part->ParseFromArray(message.data.data(), static_cast<int>(message.data.size()))) {
        done_ = scene_.OnTick(source->second.server, tick, stamp);
      } else {
        done_ = InvalidData(path_ + ": a message on /" + source->second.server + "/" +
                            source->second.field->name() + " cannot be read");
      }
    }
    WriteDown();
  }

  Result<void> Add(const std::string& topic, const google::protobuf::Message& message,
                   const recording::Stamp& stamp) {
    Added& added = added_[topic];
    if (added.channel == 0) {
      const std::string& type = message.GetDescriptor()->full_name();
      auto& schema = schemas_[type];
      if (schema == 0) {
        schema = writer_.AddSchema(type, "protobuf",
                                   recording::DescribeWithImports(*message.GetDescriptor()));
      }
      added.channel = writer_.AddChannel(schema, topic, "protobuf", {});
      added.topic = {topic, type, 0};
    }
    ++added.topic.messages;
    const std::string bytes = message.SerializeAsString();
    mcap::Message record;
    record.channel_id = added.channel;
    record.sequence = stamp.sequence;
    record.log_time_ns = static_cast<std::uint64_t>(stamp.log_ns);
    record.publish_time_ns = static_cast<std::uint64_t>(stamp.publish_ns);
    record.data = bytes;
    writer_.Add(record);
    return {};
  }

  void WriteDown() {
    const std::string bytes = writer_.Take();
    if (done_ && !bytes.empty()) done_ = file_.Write(bytes);
  }

  recording::OutputFile& file_;
  const std::string path_;  ///< Path of the recording, for errors.
  mcap::Writer writer_;
  foxglove_scene::Scene scene_;
  std::set<std::uint16_t> dropped_;  ///< Channels of an earlier export.
  std::map<std::uint16_t, Source> sources_;
  std::map<std::string, std::uint16_t> schemas_;
  std::map<std::string, Added> added_;
  Result<void> done_;
};

}  // namespace

Result<ExportedFoxglove> ExportFoxglove(const std::string& recording, const std::string& folder,
                                        const std::string& library, bool replace) {
  const auto in = recording::OpenRecording(recording);
  if (!in) return in.error();
  const std::string path =
      folder + "/" + std::filesystem::path(recording).stem().string() + "_foxglove.mcap";
  if (const Result<void> made = MakeFolder(folder); !made) return made.error();
  auto out = recording::OutputFile::Create(path, replace);
  if (!out) return out.error();
  FoxgloveCopier copier(*out, library, recording);
  const auto learned = mcap::Walk(in->bytes(), copier.Learner(), mcap::WalkMode::kStrict);
  if (const auto incomplete = Incomplete(recording, learned)) return *incomplete;
  mcap::Walk(in->bytes(), copier.Copier(), mcap::WalkMode::kStrict);
  auto topics = copier.Finish();
  if (topics && topics->empty()) {
    topics = InvalidData(recording + " has no character, board or event that can be drawn");
  }
  if (topics) return ExportedFoxglove{path, *std::move(topics)};
  std::filesystem::remove(path);
  return topics.error();
}

}  // namespace footing::log_client
