#include <google/protobuf/text_format.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "common/net/framing.h"
#include "footing/v1/session.pb.h"

/// The examples of docs/protocol.md: fenced blocks of the language "frame" (or "device-frame") with
/// hex bytes. The comments after # are the message in protobuf's text form: two further spaces a
/// level, "name, N bytes" for a message.
namespace footing {
namespace {

struct Example {
  int line = 0;
  std::string bytes;
  std::string text;
  std::vector<std::size_t> open;  // Levels of the messages that the text has begun.
};

/// The bytes of one line of hex, without its comment.
std::string BytesOf(const std::string& line) {
  std::istringstream words(line.substr(0, line.find('#')));
  std::string bytes;
  for (std::string word; words >> word;) {
    bytes.push_back(static_cast<char>(std::stoi(word, nullptr, 16)));
  }
  return bytes;
}

/// Ends the messages at `level` and deeper.
void Close(Example& example, std::size_t level) {
  for (; !example.open.empty() && example.open.back() >= level; example.open.pop_back()) {
    example.text += "}\n";
  }
}

void AddComment(Example& example, const std::string& line) {
  const std::size_t hash = line.find('#');
  if (hash == std::string::npos) return;
  const std::size_t word = line.find_first_not_of(' ', hash + 1);
  Close(example, word - hash);
  const std::string comment = line.substr(word);
  const std::size_t comma = comment.find(", ");
  const bool begins = comment.find(':') == std::string::npos && comma != std::string::npos;
  example.text += begins ? comment.substr(0, comma) + " {\n" : comment + "\n";
  if (begins) example.open.push_back(word - hash);
}

std::vector<Example> ExamplesOf(const std::string& language) {
  std::ifstream file(FOOTING_SOURCE_DIR "/docs/protocol.md");
  std::vector<Example> examples;
  bool inside = false;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (line == "```" + language) {
      inside = true;
      examples.push_back({number, "", "", {}});
    } else if (line.rfind("```", 0) == 0) {
      if (inside) Close(examples.back(), 0);
      inside = false;
    } else if (inside) {
      const bool length =
          examples.back().bytes.empty();  // The first line is the frame's length, not a field.
      examples.back().bytes += BytesOf(line);
      if (!length) AddComment(examples.back(), line);
    }
  }
  return examples;
}

/// Checks one example: length, bytes to message, message to text, and message to bytes again.
template <typename Message>
Message Check(const Example& example) {
  SCOPED_TRACE("docs/protocol.md:" + std::to_string(example.line));
  Message decoded;
  Message expected;
  EXPECT_GT(example.bytes.size(), transport::kLengthBytes);
  const std::string payload = example.bytes.substr(transport::kLengthBytes);
  EXPECT_EQ(transport::DecodeLength(example.bytes.data()), payload.size());
  EXPECT_TRUE(decoded.ParseFromString(payload));
  EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(example.text, &expected));
  std::string difference;
  google::protobuf::util::MessageDifferencer differencer;
  differencer.ReportDifferencesToString(&difference);
  EXPECT_TRUE(differencer.Compare(expected, decoded)) << difference;
  EXPECT_EQ(decoded.SerializeAsString(), payload);
  return decoded;
}

TEST(ProtocolExamples, BytesAndCommentsOfEveryMessageAgree) {
  std::set<int> shown;
  for (const Example& example : ExamplesOf("frame")) {
    shown.insert(static_cast<int>(Check<v1::Envelope>(example).body_case()));
  }
  const auto* bodies = v1::Envelope::descriptor();
  for (int i = 0; i < bodies->field_count(); ++i) {
    EXPECT_EQ(shown.count(bodies->field(i)->number()), 1u)
        << "docs/protocol.md has no example of " << bodies->field(i)->name();
  }
}

TEST(ProtocolExamples, TheDeviceSocketsExamplesAgree) {
  const auto examples = ExamplesOf("device-frame");
  EXPECT_GE(examples.size(), 2u);
  for (const Example& example : examples) Check<v1::DeviceEnvelope>(example);
}

}  // namespace
}  // namespace footing
