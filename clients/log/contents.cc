#include "clients/log/contents.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <algorithm>
#include <utility>

#include "common/recording/mapped_file.h"
#include "common/recording/schema.h"
#include "common/base/units.h"

namespace footing::log_client {
namespace {

namespace pb = google::protobuf;

bool EndsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// The value of the flags named `simulated` or `simulated_input` in the list of the message:
/// nothing without such a flag, true if any is set.
std::optional<bool> FindSimulated(const pb::Message& message) {
  std::optional<bool> found;
  const pb::Descriptor& type = *message.GetDescriptor();
  const pb::Reflection& fields = *message.GetReflection();
  for (int i = 0; i < type.field_count(); ++i) {
    const pb::FieldDescriptor* list = type.field(i);
    if (!list->is_repeated() || list->message_type() == nullptr) continue;
    for (int k = 0; k < fields.FieldSize(message, list); ++k) {
      const pb::Message& entry = fields.GetRepeatedMessage(message, list, k);
      for (const char* name : {"simulated", "simulated_input"}) {
        const pb::FieldDescriptor* flag = entry.GetDescriptor()->FindFieldByName(name);
        if (flag == nullptr || flag->is_repeated() ||
            flag->cpp_type() != pb::FieldDescriptor::CPPTYPE_BOOL) {
          continue;
        }
        found = found.value_or(false) || entry.GetReflection()->GetBool(entry, flag);
      }
    }
  }
  return found;
}

std::uint64_t Unsigned(const pb::Message& message, const char* name) {
  const pb::FieldDescriptor* field = message.GetDescriptor()->FindFieldByName(name);
  if (field == nullptr || field->is_repeated() ||
      field->cpp_type() != pb::FieldDescriptor::CPPTYPE_UINT64) {
    return 0;
  }
  return message.GetReflection()->GetUInt64(message, field);
}

std::string Text(const pb::Message& message, const char* name) {
  const pb::FieldDescriptor* field = message.GetDescriptor()->FindFieldByName(name);
  if (field == nullptr || field->is_repeated() ||
      field->cpp_type() != pb::FieldDescriptor::CPPTYPE_STRING) {
    return "";
  }
  return message.GetReflection()->GetString(message, field);
}

/// How long the gaps of one server are, from the ticks around them, in the order of the file.
class Losses {
 public:
  void OnMessage(std::uint64_t time_ns, std::uint32_t sequence) {
    if (time_ns == newest_.time_ns && sequence == newest_.sequence) return;
    previous_ = std::exchange(newest_, {time_ns, sequence});
    // Behind a snapshot of the present come the ticks of the ring, which are older.
    if (open_ && time_ns > before_ns_ && (after_ns_ == 0 || time_ns < after_ns_)) {
      after_ns_ = time_ns;
    }
  }

  void OnGap(std::uint64_t time_ns, std::uint64_t from, std::uint64_t to) {
    Close();
    // The last tick before it has the sequence before the first missing one; a snapshot may have
    // come in between, which is then the first tick after it.
    const auto last = static_cast<std::uint32_t>(from - 1);
    const Tick& before =
        newest_.sequence != last && previous_.sequence == last ? previous_ : newest_;
    before_ns_ = before.time_ns;
    after_ns_ = time_ns > before_ns_ ? time_ns : 0;
    missing_ = to >= from ? to - from + 1 : 0;
    open_ = before_ns_ > 0;
  }

  /// Adds the last gap to the sums.
  void Close() {
    if (!std::exchange(open_, false) || after_ns_ <= before_ns_) return;
    const double between_s =
        NanosecondsToSeconds(static_cast<std::int64_t>(after_ns_ - before_ns_));
    if (missing_ == 0) {
      restart_s_ += between_s;
    } else {
      missing_s_ += between_s * static_cast<double>(missing_) / static_cast<double>(missing_ + 1);
    }
  }

  double missing_s() const { return missing_s_; }
  double restart_s() const { return restart_s_; }

 private:
  struct Tick {
    std::uint64_t time_ns = 0;
    std::uint32_t sequence = 0;
  };

  Tick newest_, previous_;
  bool open_ = false;
  std::uint64_t before_ns_ = 0, after_ns_ = 0, missing_ = 0;
  double missing_s_ = 0, restart_s_ = 0;
};

/// The beginning of a topic: "/footingd" for "/footingd/motion".
std::string BeforeChannel(const std::string& topic) { return topic.substr(0, topic.find('/', 1)); }

/// Fills Contents as the walk shows it.
class Collector {
 public:
  explicit Collector(Contents& contents) : contents_(contents) {}

  mcap::Visitor Visitor() {
    mcap::Visitor visitor;
    visitor.header = [this](const mcap::Header& h) { contents_.library = h.library; };
    visitor.schema = [this](const mcap::Schema& schema) {
      names_[schema.id] = schema.name;
      // A schema that makes no sense is export's matter: its messages are only counted here.
      if (!pool_.Add(schema)) names_[schema.id] += " (unreadable)";
    };
    visitor.channel = [this](const mcap::Channel& channel) {
      Topic topic;
      topic.name = channel.topic;
      topic.schema = names_[channel.schema_id];
      topics_[channel.id] = {topic, channel.schema_id};
    };
    visitor.message = [this](const mcap::Message& message) { Count(message); };
    visitor.attachment = [this](const mcap::Attachment& a) {
      contents_.attachments.push_back({a.name, a.media_type, a.data.size()});
    };
    visitor.metadata = [this](const mcap::Metadata& m) { contents_.metadata.push_back(m); };
    return visitor;
  }

  void Finish() {
    for (auto& [server, losses] : losses_) {
      losses.Close();
      contents_.missing_s += losses.missing_s();
      contents_.restart_s += losses.restart_s();
    }
    for (auto& [topic, config] : configs_) contents_.configs.push_back(std::move(config));
    for (const auto& [id, entry] : topics_) contents_.topics.push_back(entry.topic);
    std::sort(contents_.topics.begin(), contents_.topics.end(),
              [](const Topic& a, const Topic& b) { return a.name < b.name; });
  }

 private:
  struct Entry {
    Topic topic;
    std::uint16_t schema_id = 0;
    Losses* losses = nullptr;  ///< Those of its server.
  };

  void Count(const mcap::Message& message) {
    Entry& entry = topics_[message.channel_id];
    Topic& topic = entry.topic;
    const std::uint64_t time = message.log_time_ns;
    topic.first_ns = topic.messages == 0 ? time : std::min(topic.first_ns, time);
    topic.last_ns = std::max(topic.last_ns, time);
    ++topic.messages;
    contents_.start_ns = contents_.messages == 0 ? time : std::min(contents_.start_ns, time);
    contents_.end_ns = std::max(contents_.end_ns, time);
    ++contents_.messages;
    if (entry.losses == nullptr) entry.losses = &losses_[BeforeChannel(topic.name)];
    const bool is_gap = EndsWith(topic.name, "/gaps");
    if (!is_gap) entry.losses->OnMessage(time, message.sequence);
    if (EndsWith(topic.name, "/status") || EndsWith(topic.name, "/characters")) {
      if (const pb::Message* parsed = Parse(entry, message)) {
        const std::optional<bool> simulated = FindSimulated(*parsed);
        if (simulated) contents_.simulated = contents_.simulated.value_or(false) || *simulated;
      }
    } else if (EndsWith(topic.name, "/config")) {
      if (const pb::Message* parsed = Parse(entry, message)) {
        configs_[topic.name] = Text(*parsed, "json");
      }
    } else if (is_gap) {
      ++contents_.gaps;
      if (const pb::Message* parsed = Parse(entry, message)) {
        const std::uint64_t from = Unsigned(*parsed, "from_sequence");
        const std::uint64_t to = Unsigned(*parsed, "to_sequence");
        entry.losses->OnGap(time, from, to);
        if (to >= from)
          contents_.missing_ticks += to - from + 1;
        else
          ++contents_.restarts;
      }
    }
  }

  const pb::Message* Parse(const Entry& entry, const mcap::Message& message) {
    return pool_.Parse(entry.schema_id, message.data);
  }

  Contents& contents_;
  recording::SchemaPool pool_;
  std::map<std::uint16_t, std::string> names_;
  std::map<std::uint16_t, Entry> topics_;
  std::map<std::string, std::string> configs_;  ///< By topic.
  std::map<std::string, Losses> losses_;        ///< By server.
};

}  // namespace

double Topic::RateHz() const {
  if (messages < 2 || last_ns <= first_ns) return 0;
  return 1e9 * static_cast<double>(messages - 1) / static_cast<double>(last_ns - first_ns);
}

std::optional<Error> Incomplete(const std::string& path, const mcap::WalkEnd& end) {
  if (end.complete) return std::nullopt;
  const std::string what = end.cut ? " is cut short" : " is damaged";
  return InvalidData(path + what + " at byte " + std::to_string(end.problem_offset) + " (" +
                     end.problem + "); 'footing-log repair " + path +
                     " --out NEW.mcap' keeps every complete message");
}

Result<Contents> ReadContents(const std::string& path) {
  Result<recording::MappedFile> file = recording::OpenRecording(path);
  if (!file) return file.error();
  Contents contents;
  contents.path = path;
  contents.bytes = file->bytes().size();
  Collector collector(contents);
  contents.end = mcap::Walk(file->bytes(), collector.Visitor(), mcap::WalkMode::kSalvage);
  collector.Finish();
  return contents;
}

}  // namespace footing::log_client
