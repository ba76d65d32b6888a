#include "tests/common/recording/sample_file.h"

namespace footing::mcap {

std::string SampleText(int k) {
  return "message " + std::to_string(k) + std::string(static_cast<std::size_t>(k % 7), '.');
}

std::string SampleFile(int messages) {
  Writer writer({"", "test 1"}, WriterOptions{768 * 1024, 500'000'000});
  const std::uint16_t schema = writer.AddSchema("test.Text", "protobuf", "schema bytes");
  const std::uint16_t first = writer.AddChannel(schema, "/a", "protobuf", {{"clock", "server"}});
  const std::uint16_t second = writer.AddChannel(schema, "/b", "protobuf", {});
  writer.Add(Metadata{"session", {{"server", "footingd"}, {"epoch", "7"}}});
  writer.Add(Attachment{1, 1, "config.json", "application/json", "{\"a\": 1}"});
  for (int k = 0; k < messages; ++k) {
    const std::string text = SampleText(k);
    const std::uint64_t time = static_cast<std::uint64_t>(k) * 100'000'000;
    writer.Add(
        Message{k % 2 == 0 ? first : second, static_cast<std::uint32_t>(k), time, time + 5, text});
  }
  writer.Finish();
  return writer.Take();
}

Seen WalkAll(const std::string& file, WalkMode mode) {
  Seen seen;
  Visitor visitor;
  visitor.channel = [&](const Channel& channel) { seen.topics.push_back(channel.topic); };
  visitor.message = [&](const Message& message) {
    seen.messages.emplace_back(message.data);
    seen.log_times_ns.push_back(message.log_time_ns);
  };
  visitor.attachment = [&](const Attachment& attachment) {
    seen.attachments.push_back(attachment.name + "=" + std::string(attachment.data));
  };
  visitor.metadata = [&](const Metadata& metadata) { seen.metadata.push_back(metadata.name); };
  seen.end = Walk(file, visitor, mode);
  return seen;
}

}  // namespace footing::mcap
