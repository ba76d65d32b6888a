#include "clients/log/xdf.h"

#include <bit>
#include <cstdio>

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

/// <name>text</name>, with what XML does not allow in a text replaced.
std::string Element(const std::string& name, std::string_view text) {
  std::string xml = "<" + name + ">";
  for (const char c : text) {
    switch (c) {
      case '&':
        xml += "&amp;";
        break;
      case '<':
        xml += "&lt;";
        break;
      case '>':
        xml += "&gt;";
        break;
      default:
        xml += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return xml + "</" + name + ">";
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
              "<?xml version=\"1.0\"?><info>" + Element("version", "1.0") + "</info>", out);
  return out;
}

void AppendHeader(const Stream& stream, std::string& out) {
  std::string xml = "<?xml version=\"1.0\"?><info>";
  xml += Element("name", stream.name) + Element("type", stream.type);
  xml += Element("channel_count", std::to_string(stream.channels.size()));
  xml += Element("nominal_srate", "0");  // Every sample has its time.
  xml += Element("channel_format", stream.is_text ? "string" : "double64");
  xml += Element("source_id", stream.source_id);
  xml += "<desc>";
  if (!stream.note.empty()) xml += Element("note", stream.note);
  xml += "<channels>";
  for (const std::string& channel : stream.channels) {
    xml += "<channel>" + Element("label", channel) + "</channel>";
  }
  xml += "</channels></desc></info>";
  AppendStreamChunk(Tag::kStreamHeader, stream.id, xml, out);
}

void AppendClockOffset(const Stream& stream, double time_s, std::string& out) {
  std::string content;
  AppendDouble(time_s, content);
  AppendDouble(0, content);
  AppendStreamChunk(Tag::kClockOffset, stream.id, content, out);
}

void AppendFooter(const Stream& stream, const Extent& extent, std::string& out) {
  const std::string xml = "<?xml version=\"1.0\"?><info>" +
                          Element("first_timestamp", Seconds(extent.first_s)) +
                          Element("last_timestamp", Seconds(extent.last_s)) +
                          Element("sample_count", std::to_string(extent.samples)) +
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
  ++count_;
  content_ += kTimeFollows;
  AppendDouble(time_s, content_);
  AppendLength(text.size(), content_);
  content_ += text;
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
