#include "clients/log/export_xdf.h"

#include <algorithm>
#include <bit>
#include <compare>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <google/protobuf/descriptor.h>

#include "clients/log/contents.h"
#include "clients/log/lsl.h"
#include "common/base/text.h"
#include "common/recording/event_text.h"
#include "common/recording/recording_writer.h"
#include "common/stream/device.h"
#include "common/stream/hand_frames.h"
#include "footing/v1/character.pb.h"
#include "footing/v1/lsl.pb.h"

namespace footing::log_client {
namespace {

namespace pb = google::protobuf;

constexpr std::size_t kChunkBytes = 1u << 16;
/// Numbers of other programs' streams, above those of our own.
constexpr std::uint32_t kFirstForeign = 1'000'000;
constexpr std::uint64_t kBoundaryNs = 10'000'000'000;

/// The field of this name, where it is one value of this kind; else null.
const pb::FieldDescriptor* FieldOf(const pb::Message& message, const char* name,
                                   pb::FieldDescriptor::CppType kind) {
  const pb::FieldDescriptor* field = message.GetDescriptor()->FindFieldByName(name);
  const bool fits = field != nullptr && !field->is_repeated() && field->cpp_type() == kind;
  return fits ? field : nullptr;
}

/// The number of the device that a row is about; 0 where it is about none.
std::uint32_t DeviceOf(const pb::Message& row) {
  const auto* field = FieldOf(row, "device", pb::FieldDescriptor::CPPTYPE_UINT32);
  return field == nullptr ? 0 : row.GetReflection()->GetUInt32(row, field);
}

bool IsEvent(const pb::Message& row) {
  return row.GetDescriptor()->full_name() == "footing.v1.Event";
}

std::string TextOf(const pb::Message& row, const char* name) {
  const auto* field = FieldOf(row, name, pb::FieldDescriptor::CPPTYPE_STRING);
  return field == nullptr ? "" : row.GetReflection()->GetString(row, field);
}

}  // namespace

std::int64_t TimeOf(const mcap::Message& record, const pb::Message* row) {
  std::int64_t time_ns = 0;
  for (const char* name : {"sampled_ns", "host_ns"}) {
    if (row == nullptr || time_ns != 0) break;
    const auto* field = FieldOf(*row, name, pb::FieldDescriptor::CPPTYPE_INT64);
    if (field != nullptr) time_ns = row->GetReflection()->GetInt64(*row, field);
  }
  if (time_ns == 0) time_ns = static_cast<std::int64_t>(record.log_time_ns);
  return time_ns;
}

namespace {

/// A channel of a server as XDF's tools name what is in it; others keep their own names.
std::string TypeOf(const std::string& channel) {
  constexpr std::pair<std::string_view, std::string_view> kTypes[] = {
      {"motion", "Accelerometer"}, {"boards", "Force"},      {"contacts", "Force"},
      {"hands", "MoCap"},          {"reference", "MoCap"},   {"characters", "MoCap"},
      {"nunchuk", "Controller"},   {"gamepad", "Controller"}};
  for (const auto& [name, type] : kTypes) {
    if (channel == name) return std::string(type);
  }
  return channel;
}

/// One stream on its way into the file.
struct Outgoing {
  xdf::Stream stream;
  xdf::Extent extent;
  xdf::Samples samples;
  RisingTimes times;
  /// Times, ns, and texts of a stream of texts: a marker may be earlier than an event of the tick
  /// before, and the times in a file rise.
  std::vector<std::pair<std::int64_t, std::string>> texts = {};
};

class XdfExporter {
 public:
  XdfExporter(std::string_view bytes, const std::string& path) : tables_(bytes, path) {}

  Result<ExportedXdf> Run(const std::string& folder, const std::string& name, bool replace) {
    if (const Result<void> learned = tables_.Learn(); !learned) return learned.error();
    if (const Result<void> made = MakeFolder(folder); !made) return made.error();
    ExportedXdf exported{folder + "/" + name + ".xdf", {}};
    Result<recording::OutputFile> file = recording::OutputFile::Create(exported.path, replace);
    if (!file) return file.error();
    out_ = xdf::FileStart();
    const Result<void> walked = tables_.Walk([&](std::uint16_t channel, const mcap::Message& record,
                                                 const pb::Message& message) -> Result<void> {
      Take(channel, record, message);
      if (out_.size() < kChunkBytes) return {};
      return file->Write(std::exchange(out_, {}));
    });
    if (!walked) return walked.error();
    for (auto& [key, outgoing] : streams_) {
      if (outgoing.stream.channels.empty()) continue;  // Only texts, and no event.
      OrderTexts(outgoing);
      outgoing.samples.AppendTo(outgoing.stream, out_);
      if (outgoing.extent.samples > 1) {
        xdf::AppendClockOffset(outgoing.stream, outgoing.extent.last_s, 0, out_);
      }
      End(outgoing, exported);
    }
    for (auto& [topic, foreign] : foreign_) {
      if (!foreign.info) continue;
      foreign.out.samples.AppendTo(foreign.out.stream, out_);
      End(foreign.out, exported);
    }
    if (const Result<void> end = file->Write(out_); !end) return end.error();
    return exported;
  }

 private:
  void End(const Outgoing& outgoing, ExportedXdf& exported) {
    xdf::AppendFooter(outgoing.stream, outgoing.extent, out_);
    exported.streams.push_back({outgoing.stream.name, outgoing.stream.channels.size(),
                                outgoing.extent.samples, outgoing.times.mended()});
  }

  /// Key that the rows of one stream share. A device may get another number, and a number another
  /// role.
  struct Key {
    std::uint16_t channel = 0;
    std::uint32_t device = 0;
    std::string about;    ///< "/left_board", "/main/left_hand", "/main/head"; may be empty.
    std::string tracker;  ///< Name of what saw it; may be empty.
    auto operator<=>(const Key&) const = default;
  };

  void Take(std::uint16_t channel, const mcap::Message& record, const pb::Message& message) {
    const TopicTable& topic = tables_.topics().at(channel);
    if (TakeForeign(topic.topic, record)) return;
    for (const pb::Message* row : topic.table->Rows(message)) {
      Outgoing& to = StreamOf(KeyOf(channel, topic, row), topic, row);
      if (!to.stream.channels.empty()) Add(to, record, message, row, *topic.table);
    }
    if (record.log_time_ns < boundary_ns_ + kBoundaryNs) return;
    if (boundary_ns_ != 0) xdf::AppendBoundary(out_);
    boundary_ns_ = record.log_time_ns;
  }

  Key KeyOf(std::uint16_t channel, const TopicTable& topic, const pb::Message* row) const {
    Key key{channel, 0, "", ""};
    if (row == nullptr || IsEvent(*row)) return key;
    key.device = DeviceOf(*row);
    if (const auto* number = FieldOf(*row, "character", pb::FieldDescriptor::CPPTYPE_UINT32)) {
      // Its rig is known only after a while.
      key.about = "/" + std::to_string(row->GetReflection()->GetUInt32(*row, number));
      return key;
    }
    const std::string rig = TextOf(*row, "rig");
    std::string role = tables_.notes().Role(topic.topic, topic.table->row_type(), row);
    const auto* own_role = FieldOf(*row, "role", pb::FieldDescriptor::CPPTYPE_ENUM);
    if (own_role != nullptr) {
      const int number = row->GetReflection()->GetEnumValue(*row, own_role);
      role = number == 0 ? "" : stream::Name(static_cast<stream::DeviceRole>(number));
    }
    if (role.empty() && key.device != 0) role = std::to_string(key.device);
    if (const auto* joint = FieldOf(*row, "joint", pb::FieldDescriptor::CPPTYPE_ENUM);
        role.empty() && joint != nullptr) {
      const int number = row->GetReflection()->GetEnumValue(*row, joint);
      if (number != 0) role = stream::Name(static_cast<stream::BodyJoint>(number));
    }
    if (!rig.empty()) key.about += "/" + rig;
    if (!role.empty()) key.about += "/" + role;
    // Two trackers may see one hand, each in its own time.
    key.tracker = TextOf(*row, "tracker");
    return key;
  }

  Outgoing& StreamOf(const Key& key, const TopicTable& topic, const pb::Message* row) {
    const auto [at, is_new] = streams_.try_emplace(key);
    xdf::Stream& stream = at->second.stream;
    if (!is_new) return at->second;
    stream.id = static_cast<std::uint32_t>(streams_.size());
    stream.is_text = row != nullptr && IsEvent(*row);
    stream.type =
        stream.is_text ? "Markers" : TypeOf(topic.topic.substr(topic.topic.rfind('/') + 1));
    stream.channels = topic.table->NumberNames();
    if (stream.is_text) stream.channels = {"event"};
    stream.name = topic.topic.substr(topic.topic.starts_with('/') ? 1 : 0) + key.about;
    // Two rigs have devices of one role, and two trackers see one hand.
    if (!names_.insert(stream.name).second) {
      stream.name += "_" + (key.tracker.empty() ? std::to_string(key.device) : key.tracker);
    }
    stream.source_id = stream.name;
    stream.note = tables_.notes().DeviationNote(topic.topic, topic.table->row_type());
    if (!stream.channels.empty()) xdf::AppendHeader(stream, out_);
    return at->second;
  }

  void Add(Outgoing& to, const mcap::Message& record, const pb::Message& message,
           const pb::Message* row, const CsvTable& table) {
    const std::int64_t time_ns = TimeOf(record, row);
    if (to.stream.is_text) {
      v1::Event event;
      event.ParseFromString(row->SerializeAsString());
      to.texts.emplace_back(time_ns, recording::EventText(event));
      return;
    }
    const double time_s = Extend(to, time_ns);
    to.samples.Add(time_s, table.Numbers(message, row));
    if (to.samples.bytes() >= kChunkBytes) to.samples.AppendTo(to.stream, out_);
  }

  /// A stream of LSL as another program sent it: its own description, times and clock.
  struct Foreign {
    std::optional<lsl::Info> info;  ///< Nothing: its description makes no sense.
    Outgoing out;
  };

  bool TakeForeign(const std::string& topic, const mcap::Message& record) {
    if (tables_.lsl().empty()) return false;
    constexpr std::string_view kClock = "/clock";
    const bool is_clock = topic.ends_with(kClock);
    const std::string of = is_clock ? topic.substr(0, topic.size() - kClock.size()) : topic;
    const auto description = tables_.lsl().find(of);
    if (description == tables_.lsl().end()) return false;
    Foreign& foreign = ForeignOf(of, description->second);
    if (!foreign.info) return true;
    const auto size = static_cast<int>(record.data.size());
    if (v1::LslClock clock; is_clock && clock.ParseFromArray(record.data.data(), size)) {
      xdf::AppendClockOffset(foreign.out.stream, clock.time_s(), clock.correction_s(), out_);
    } else if (v1::LslSamples samples;
               !is_clock && samples.ParseFromArray(record.data.data(), size)) {
      for (const v1::LslSample& sample : samples.samples()) AddForeign(foreign, sample);
    }
    return true;
  }

  Foreign& ForeignOf(const std::string& topic, const std::string& description) {
    const auto [at, is_new] = foreign_.try_emplace(topic);
    Foreign& foreign = at->second;
    if (!is_new) return foreign;
    auto info = lsl::ParseInfo(description);
    if (!info) return foreign;
    xdf::Stream& stream = foreign.out.stream;
    stream.id = kFirstForeign + static_cast<std::uint32_t>(foreign_.size());
    stream.name = info->name;
    stream.is_text = info->format == lsl::Format::kString;
    stream.channels.resize(info->channels);
    // All numbers are doubles in a recording.
    if (!stream.is_text) info->format = lsl::Format::kDouble64;
    stream.xml = lsl::FullInfo(*info);
    foreign.info = std::move(*info);
    xdf::AppendHeader(stream, out_);
    return foreign;
  }

  void AddForeign(Foreign& foreign, const v1::LslSample& sample) {
    Outgoing& to = foreign.out;
    const int count = to.stream.is_text ? sample.texts_size() : sample.values_size();
    if (count != static_cast<int>(foreign.info->channels)) return;
    if (to.extent.samples++ == 0) to.extent.first_s = sample.time_s();
    to.extent.last_s = sample.time_s();
    if (to.stream.is_text) {
      const std::vector<std::string> texts(sample.texts().begin(), sample.texts().end());
      to.samples.Add(sample.time_s(), texts);
    } else {
      to.samples.Add(sample.time_s(),
                     std::span<const double>(sample.values().data(), foreign.info->channels));
    }
    if (to.samples.bytes() >= kChunkBytes) to.samples.AppendTo(to.stream, out_);
  }

  /// The sample's time in the file, s.
  double Extend(Outgoing& to, std::int64_t time_ns) {
    const double time_s = 1e-9 * static_cast<double>(to.times.Next(time_ns));
    if (to.extent.samples++ == 0) {
      to.extent.first_s = time_s;
      xdf::AppendClockOffset(to.stream, time_s, 0, out_);
    }
    to.extent.last_s = time_s;
    return time_s;
  }

  void OrderTexts(Outgoing& to) {
    std::stable_sort(to.texts.begin(), to.texts.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [time_ns, words] : to.texts) to.samples.Add(Extend(to, time_ns), words);
  }

  Tables tables_;
  std::map<Key, Outgoing> streams_;
  std::set<std::string> names_;
  std::map<std::string, Foreign> foreign_;  ///< By topic.
  std::uint64_t boundary_ns_ = 0;
  std::string out_;
};

}  // namespace

Result<ExportedXdf> ExportXdf(const std::string& recording, const std::string& folder,
                              bool replace) {
  Result<recording::MappedFile> file = recording::OpenRecording(recording);
  if (!file) return file.error();
  const std::string name = std::filesystem::path(recording).stem().string();
  return XdfExporter(file->bytes(), recording).Run(folder, name, replace);
}

}  // namespace footing::log_client

namespace footing::log_client::xdf {
namespace {

enum class Tag : std::uint16_t {
  kFileHeader = 1,
  kStreamHeader = 2,
  kSamples = 3,
  kClockOffset = 4,
  kBoundary = 5,
  kStreamFooter = 6,
};

constexpr char kTimeFollows = 8;  // Before a sample: its time, eight bytes.
constexpr unsigned char kBoundary[16] = {0x43, 0xA5, 0x46, 0xDC, 0xCB, 0xF5, 0x41, 0x0F,
                                         0xB3, 0x0E, 0xD5, 0x46, 0x73, 0x83, 0xCB, 0xE4};

void AppendInteger(std::uint64_t value, int bytes, std::string& out) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 0xFF);
}

void AppendDouble(double value, std::string& out) {
  AppendInteger(std::bit_cast<std::uint64_t>(value), 8, out);
}

/// The number of its bytes, then the number.
void AppendLength(std::uint64_t length, std::string& out) {
  const int bytes = length < 1u << 8 ? 1 : length < std::uint64_t{1} << 32 ? 4 : 8;
  out += static_cast<char>(bytes);
  AppendInteger(length, bytes, out);
}

void AppendChunk(Tag tag, std::string_view content, std::string& out) {
  AppendLength(2 + content.size(), out);
  AppendInteger(static_cast<std::uint64_t>(tag), 2, out);
  out += content;
}

void AppendStreamChunk(Tag tag, std::uint32_t id, std::string_view content, std::string& out) {
  std::string whole;
  AppendInteger(id, 4, whole);
  whole += content;
  AppendChunk(tag, whole, out);
}

std::string Seconds(double time_s) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9f", time_s);
  return text;
}

}  // namespace

std::string FileStart() {
  std::string out = "XDF:";
  AppendChunk(Tag::kFileHeader,
              "<?xml version=\"1.0\"?><info>" + lsl::Element("version", "1.0") + "</info>", out);
  return out;
}

void AppendHeader(const Stream& stream, std::string& out) {
  if (!stream.xml.empty()) {
    AppendStreamChunk(Tag::kStreamHeader, stream.id, stream.xml, out);
    return;
  }
  std::string xml = "<?xml version=\"1.0\"?><info>";
  xml += lsl::Element("name", stream.name) + lsl::Element("type", stream.type);
  xml += lsl::Element("channel_count", std::to_string(stream.channels.size()));
  xml += lsl::Element("nominal_srate", "0");  // Every sample has its time.
  xml += lsl::Element("channel_format", stream.is_text ? "string" : "double64");
  xml += lsl::Element("source_id", stream.source_id);
  std::vector<lsl::Channel> channels;
  for (const std::string& channel : stream.channels) channels.push_back({channel, UnitOf(channel)});
  std::vector<std::pair<std::string, std::string>> notes;
  if (!stream.note.empty()) notes.emplace_back("note", stream.note);
  xml += "<desc>" + lsl::Describe(channels, stream.type, notes) + "</desc></info>";
  AppendStreamChunk(Tag::kStreamHeader, stream.id, xml, out);
}

void AppendClockOffset(const Stream& stream, double time_s, double offset_s, std::string& out) {
  std::string content;
  AppendDouble(time_s, content);
  AppendDouble(offset_s, content);
  AppendStreamChunk(Tag::kClockOffset, stream.id, content, out);
}

void AppendFooter(const Stream& stream, const Extent& extent, std::string& out) {
  const std::string xml = "<?xml version=\"1.0\"?><info>" +
                          lsl::Element("first_timestamp", Seconds(extent.first_s)) +
                          lsl::Element("last_timestamp", Seconds(extent.last_s)) +
                          lsl::Element("sample_count", std::to_string(extent.samples)) +
                          "<clock_offsets></clock_offsets></info>";
  AppendStreamChunk(Tag::kStreamFooter, stream.id, xml, out);
}

void AppendBoundary(std::string& out) {
  AppendChunk(Tag::kBoundary,
              std::string_view(reinterpret_cast<const char*>(kBoundary), sizeof kBoundary), out);
}

void Samples::Add(double time_s, std::span<const double> numbers) {
  ++count_;
  content_ += kTimeFollows;
  AppendDouble(time_s, content_);
  for (const double number : numbers) AppendDouble(number, content_);
}

void Samples::Add(double time_s, std::string_view text) {
  const std::string texts[] = {std::string(text)};
  Add(time_s, texts);
}

void Samples::Add(double time_s, std::span<const std::string> texts) {
  ++count_;
  content_ += kTimeFollows;
  AppendDouble(time_s, content_);
  for (const std::string& text : texts) {
    AppendLength(text.size(), content_);
    content_ += text;
  }
}

void Samples::AppendTo(const Stream& stream, std::string& out) {
  if (count_ == 0) return;
  std::string content;
  AppendLength(count_, content);
  content += content_;
  AppendStreamChunk(Tag::kSamples, stream.id, content, out);
  *this = {};
}

}  // namespace footing::log_client::xdf
