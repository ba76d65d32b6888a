#include "clients/log/lsl.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>

#include "common/base/text.h"

namespace footing::log_client::lsl {
namespace {

constexpr double kTestTime = 123456.789;
constexpr char kTimeDeduced = 1, kTimeFollows = 2;
constexpr std::string_view kFormats[] = {"float32", "double64", "string", "int32",
                                         "int16",   "int8",     "int64"};

/// Sixteen digits, as liblsl writes times: nanoseconds for 100 days.
std::string Digits(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.16g", value);
  return text;
}

/// Takes a line off the front, without its end; nothing when there is no end.
std::optional<std::string_view> PopLine(std::string_view& text) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end + 1);
  return text::Trim(line);
}

/// The fields of <info> in front of <desc>, in liblsl's order.
std::vector<std::pair<std::string_view, std::string>> FieldsOf(const Info& info) {
  const auto port = [](std::uint16_t number) { return std::to_string(number); };
  return {{"name", info.name},
          {"type", info.type},
          {"channel_count", std::to_string(info.channels)},
          {"channel_format", std::string(kFormats[static_cast<std::size_t>(info.format)])},
          {"source_id", info.source_id},
          {"nominal_srate", Digits(info.nominal_hz)},
          {"version", "1.1"},
          {"created_at", Digits(info.created_s)},
          {"uid", info.uid},
          {"session_id", info.session_id},
          {"hostname", info.hostname},
          {"v4address", info.v4address},
          {"v4data_port", port(info.data_port)},
          {"v4service_port", port(info.service_port)},
          {"v6address", ""},
          {"v6data_port", "0"},
          {"v6service_port", "0"}};
}

std::string ToXml(const Info& info, const std::string& description) {
  std::string xml = "<?xml version=\"1.0\"?>\n<info>\n";
  for (const auto& [name, text] : FieldsOf(info)) xml += "\t" + Element(name, text) + "\n";
  return xml + "\t<desc>" + description + "</desc>\n</info>\n";
}

std::string Unescaped(std::string_view xml) {
  constexpr std::pair<std::string_view, char> kNames[] = {
      {"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}};
  std::string text;
  for (std::size_t i = 0; i < xml.size(); ++i) {
    const std::size_t end = xml[i] == '&' ? xml.find(';', i) : std::string_view::npos;
    if (end == std::string_view::npos) {
      text += xml[i];
      continue;
    }
    const std::string_view word = xml.substr(i + 1, end - i - 1);
    for (const auto& [name, sign] : kNames) {
      if (word == name) text += sign;
    }
    if (word.starts_with('#')) text += '?';
    i = end;
  }
  return text;
}

}  // namespace

std::size_t BytesOf(Format format) {
  constexpr std::size_t kBytes[] = {4, 8, 0, 4, 2, 1, 8};
  return kBytes[static_cast<std::size_t>(format)];
}

std::string Element(std::string_view name, std::string_view text) {
  std::string xml = "<" + std::string(name) + ">";
  for (const char c : text) {
    if (c == '&') {
      xml += "&amp;";
    } else if (c == '<') {
      xml += "&lt;";
    } else if (c == '>') {
      xml += "&gt;";
    } else {
      xml += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return xml + "</" + std::string(name) + ">";
}

std::string Describe(const std::vector<Channel>& channels, const std::string& type,
                     const std::vector<std::pair<std::string, std::string>>& notes) {
  std::string xml;
  for (const auto& [name, text] : notes) xml += Element(name, text);
  xml += "<channels>";
  for (const Channel& channel : channels) {
    xml += "<channel>" + Element("label", channel.label);
    if (!channel.unit.empty()) xml += Element("unit", channel.unit);
    xml += Element("type", type) + "</channel>";
  }
  return xml + "</channels>";
}

std::string ShortInfo(const Info& info) { return ToXml(info, ""); }
std::string FullInfo(const Info& info) { return ToXml(info, info.description); }

namespace {

Error WrongInfo(const std::string& what) {
  return InvalidData("the description of an LSL stream " + what);
}

using Fields = std::vector<std::pair<std::string, std::string>>;

/// The elements within info and their texts, that of desc as XML.
Result<Fields> ReadFields(std::string_view xml) {
  if (xml.size() > kMostInfoBytes) return WrongInfo("is longer than 1 MiB");
  std::size_t at = xml.find("<info>");
  if (at == std::string_view::npos) return WrongInfo("has no <info>");
  at += 6;
  Fields fields;
  while (true) {
    at = xml.find_first_not_of(" \t\r\n", at);
    if (at == std::string_view::npos || xml[at] != '<') return WrongInfo("is not XML");
    if (xml.substr(at).starts_with("</info>")) break;
    const std::size_t close = xml.find('>', at);
    if (close == std::string_view::npos) return WrongInfo("ends too early");
    std::string name(xml.substr(at + 1, close - at - 1));
    const bool empty = name.ends_with('/');
    if (empty) name = std::string(text::Trim(name.substr(0, name.size() - 1)));
    at = close + 1;
    if (empty) {
      fields.emplace_back(name, "");
      continue;
    }
    const std::string end_tag = "</" + name + ">";
    // Whoever described the channels may have put a <desc> of theirs into it.
    const std::size_t end = name == "desc" ? xml.rfind(end_tag) : xml.find(end_tag, at);
    if (end == std::string_view::npos || end < at) return WrongInfo("has no end of " + name);
    const std::string_view inside = xml.substr(at, end - at);
    fields.emplace_back(name, name == "desc" ? std::string(inside) : Unescaped(inside));
    at = end + end_tag.size();
    if (fields.size() > 64) return WrongInfo("has too many fields");
  }
  return fields;
}

}  // namespace

Result<Info> ParseInfo(std::string_view xml) {
  const auto fields = ReadFields(xml);
  if (!fields) return fields.error();
  const auto field = [&fields](std::string_view name) {
    for (const auto& [one, text] : *fields) {
      if (one == name) return text;
    }
    return std::string();
  };
  Info info;
  info.name = field("name");
  info.type = field("type");
  info.source_id = field("source_id");
  info.uid = field("uid");
  info.session_id = field("session_id");
  info.hostname = field("hostname");
  info.v4address = field("v4address");
  info.description = field("desc");
  const auto* format = std::find(std::begin(kFormats), std::end(kFormats), field("channel_format"));
  const auto channels = text::ToCount(field("channel_count"));
  const auto nominal_hz = text::ToNumber(field("nominal_srate"));
  const auto version = text::ToNumber(field("version"));
  const auto data_port = text::As<std::uint16_t>(field("v4data_port"));
  const auto service_port = text::As<std::uint16_t>(field("v4service_port"));
  if (info.name.empty()) return WrongInfo("has no name");
  if (info.uid.empty()) return WrongInfo(info.name + " has no uid");
  if (format == std::end(kFormats)) return WrongInfo(info.name + " has an unknown channel_format");
  if (!channels || *channels < 1 || *channels > kMostChannels)
    return WrongInfo(info.name + " does not have 1 to 2048 channels");
  if (!nominal_hz || *nominal_hz < 0 || *nominal_hz > 1e6)
    return WrongInfo(info.name + " has no nominal_srate from 0 to 1e6 Hz");
  if (!version || *version < 1.1 - 1e-6 || *version >= 2)
    return WrongInfo(info.name + " is of another protocol than 1.10");
  if (!data_port || !service_port) return WrongInfo(info.name + " has no port over IPv4");
  info.format = static_cast<Format>(format - std::begin(kFormats));
  info.channels = *channels;
  info.nominal_hz = *nominal_hz;
  info.created_s = text::ToNumber(field("created_at")).value_or(0);
  info.data_port = *data_port;
  info.service_port = *service_port;
  return info;
}

namespace {

/// Value of a part of a query: a field that is not there is equal to nothing.
struct Value {
  enum class Kind { kNone, kBool, kNumber, kText };
  Kind kind = Kind::kNone;
  bool truth = false;
  double number = 0;
  std::string text{};

  bool IsTrue() const {
    switch (kind) {
      case Kind::kNone:
        return false;
      case Kind::kBool:
        return truth;
      case Kind::kNumber:
        return number != 0 && !std::isnan(number);
      case Kind::kText:
        return !text.empty() || truth;  // A field that is there is true, even when it is empty.
    }
    return false;
  }
  double Number() const {
    if (kind == Kind::kNumber) return number;
    if (kind == Kind::kBool) return truth ? 1 : 0;
    return text::ToNumber(text::Trim(text)).value_or(std::numeric_limits<double>::quiet_NaN());
  }
};

Value Truth(bool truth) { return {Value::Kind::kBool, truth}; }

/// Evaluates a query from left to right, as XPath 1.0 does with one node for each field.
class Query {
 public:
  Query(const Info& info, std::string_view text) : fields_(FieldsOf(info)), text_(text) {}

  Result<bool> Evaluate() {
    if (text_.size() > kMostRequestBytes) return Wrong("is too long");
    const Value value = Or();
    if (problem_.empty() && !Next().empty()) Fail(Next());
    if (!problem_.empty()) return Wrong(problem_);
    return value.IsTrue();
  }

 private:
  static constexpr int kMostDepth = 32;

  static Error Wrong(const std::string& what) {
    return UsageError("the query " + what +
                      "; it may have the fields of a stream, texts in quotes, numbers, = != < <= > "
                      ">=, and, or, not(), starts-with(), contains() and brackets, such as: "
                      "name='BioSemi' and type='EEG'");
  }

  void Fail(std::string_view at) {
    if (problem_.empty()) {
      problem_ = at.empty() ? "ends too early" : "has something unknown at " + text::Quoted(at);
    }
    text_ = {};
  }

  std::string_view Next() {
    while (!text_.empty() && (text_[0] == ' ' || text_[0] == '\t')) text_.remove_prefix(1);
    return text_;
  }
  bool Take(std::string_view sign) {
    if (!Next().starts_with(sign)) return false;
    text_.remove_prefix(sign.size());
    return true;
  }
  void Demand(std::string_view sign) {
    if (!Take(sign)) Fail(Next());
  }
  static bool IsNameSign(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  }
  std::string_view Name() {
    const std::string_view all = Next();
    std::size_t end = 0;
    while (end < all.size() && IsNameSign(all[end])) ++end;
    return all.substr(0, end);
  }
  bool TakeWord(std::string_view word) { return Name() == word && Take(word); }

  Value Or() {
    if (++depth_ > kMostDepth) Fail(Next());
    Value value = And();
    while (TakeWord("or")) {
      const Value right = And();
      value = Truth(value.IsTrue() || right.IsTrue());
    }
    --depth_;
    return value;
  }
  Value And() {
    Value value = Comparison();
    while (TakeWord("and")) {
      const Value right = Comparison();
      value = Truth(value.IsTrue() && right.IsTrue());
    }
    return value;
  }
  Value Comparison() {
    const Value left = Part();
    for (const char* sign : {"!=", "<=", ">=", "=", "<", ">"}) {
      if (!Take(sign)) continue;
      const Value right = Part();
      return Truth(Compare(left, sign, right));
    }
    return left;
  }
  static bool Compare(const Value& left, std::string_view sign, const Value& right) {
    using Kind = Value::Kind;
    const auto is = [&](Kind kind) { return left.kind == kind || right.kind == kind; };
    if (sign == "=" || sign == "!=") {
      bool same = left.text == right.text;
      if (is(Kind::kBool)) {
        same = left.IsTrue() == right.IsTrue();
      } else if (is(Kind::kNone)) {
        return false;
      } else if (is(Kind::kNumber)) {
        same = left.Number() == right.Number();
      }
      return same == (sign == "=");
    }
    if (is(Kind::kNone)) return false;
    const double a = left.Number(), b = right.Number();
    if (sign == "<") return a < b;
    if (sign == "<=") return a <= b;
    return sign == ">" ? a > b : a >= b;
  }

  Value Part() {
    if (Take("(")) {
      Value value = Or();
      Demand(")");
      return value;
    }
    for (const char quote : {'\'', '"'}) {
      if (!Take(std::string_view(&quote, 1))) continue;
      const std::size_t end = text_.find(quote);
      if (end == std::string_view::npos) {
        Fail("");
        return {};
      }
      Value value{Value::Kind::kText};
      value.text = std::string(text_.substr(0, end));
      text_.remove_prefix(end + 1);
      return value;
    }
    const std::string name(Name());
    if (name.empty()) {
      Fail(Next());
      return {};
    }
    if (const auto number = text::ToNumber(NumberWord())) {
      text_.remove_prefix(NumberWord().size());
      return {Value::Kind::kNumber, false, *number};
    }
    Take(name);
    if (Take("(")) return Function(name);
    for (const auto& [field, text] : fields_) {
      if (field == name) return {Value::Kind::kText, true, 0, text};
    }
    return {};
  }

  std::string_view NumberWord() {
    const std::string_view all = Next();
    return all.substr(0, std::min(all.size(), all.find_first_not_of("0123456789.")));
  }

  Value Function(const std::string& name) {
    const Value first = Or();
    Value value;
    if (name == "not") {
      value = Truth(!first.IsTrue());
    } else if (name == "starts-with" || name == "contains") {
      Demand(",");
      const Value second = Or();
      const std::size_t at = first.text.find(second.text);
      value = Truth(name == "contains" ? at != std::string::npos : at == 0);
    } else {
      Fail(name);
    }
    Demand(")");
    return value;
  }

  std::vector<std::pair<std::string_view, std::string>> fields_;
  std::string_view text_;
  std::string problem_;
  int depth_ = 0;
};

}  // namespace

bool Matches(const Info& info, std::string_view query) {
  if (text::Trim(query).empty()) return true;
  const auto matches = Query(info, query).Evaluate();
  return matches && *matches;
}

Result<void> CheckQuery(std::string_view query) {
  if (text::Trim(query).empty()) return UsageError("the query for LSL streams is empty");
  const auto matches = Query(Info{}, query).Evaluate();
  return matches ? Result<void>() : matches.error();
}

std::optional<ShortInfoRequest> ParseShortInfoRequest(std::string_view datagram) {
  if (PopLine(datagram) != "LSL:shortinfo") return std::nullopt;
  const auto query = PopLine(datagram);
  if (!query) return std::nullopt;
  std::string_view last = text::Trim(datagram.substr(0, datagram.find('\n')));
  const auto port = text::As<std::uint16_t>(text::PopWord(last));
  const std::string_view id = text::PopWord(last);
  if (!port || *port == 0 || id.empty() || id.size() > 64) return std::nullopt;
  return ShortInfoRequest{std::string(*query), *port, std::string(id)};
}

std::string Encode(const ShortInfoRequest& request) {
  return "LSL:shortinfo\r\n" + request.query + "\r\n" + std::to_string(request.return_port) + " " +
         request.query_id + "\r\n";
}

std::string ShortInfoAnswer(const std::string& query_id, const Info& info) {
  return query_id + "\r\n" + ShortInfo(info);
}

std::optional<TimeExchange> ParseTimeRequest(std::string_view datagram) {
  if (PopLine(datagram) != "LSL:timedata") return std::nullopt;
  std::string_view words = text::Trim(datagram.substr(0, datagram.find('\n')));
  const auto wave = text::As<std::int32_t>(text::PopWord(words));
  const auto t0 = text::ToNumber(text::PopWord(words));
  if (!wave || !t0) return std::nullopt;
  return TimeExchange{*wave, *t0};
}

std::string EncodeTimeRequest(const TimeExchange& exchange) {
  return "LSL:timedata\r\n" + std::to_string(exchange.wave) + " " + Digits(exchange.t0) + "\r\n";
}

std::optional<TimeExchange> ParseTimeAnswer(std::string_view datagram) {
  const auto words = text::SplitAtBlanks(datagram);
  if (words.size() != 4) return std::nullopt;
  const auto wave = text::As<std::int32_t>(words[0]);
  const auto t0 = text::ToNumber(words[1]), t1 = text::ToNumber(words[2]),
             t2 = text::ToNumber(words[3]);
  if (!wave || !t0 || !t1 || !t2) return std::nullopt;
  return TimeExchange{*wave, *t0, *t1, *t2};
}

std::string EncodeTimeAnswer(const TimeExchange& exchange) {
  return " " + std::to_string(exchange.wave) + " " + Digits(exchange.t0) + " " +
         Digits(exchange.t1) + " " + Digits(exchange.t2);
}

namespace {

Request Refused(const std::string& why) {
  return {Request::Kind::kRefused, "LSL/110 " + why + "\r\n\r\n"};
}

}  // namespace

Request ParseRequest(std::string_view bytes, const Info& info) {
  const Request too_long = Refused("413 Request too long");
  const Request incomplete = bytes.size() < kMostRequestBytes ? Request{} : too_long;
  std::string_view rest = bytes;
  const auto line = PopLine(rest);
  if (!line) return incomplete;
  if (*line == "LSL:fullinfo") return {Request::Kind::kFullInfo};
  if (*line == "LSL:shortinfo") {
    const auto query = PopLine(rest);
    if (!query) return incomplete;
    if (Matches(info, *query)) return {Request::Kind::kShortInfo};
    return Refused("404 Not found: this stream does not match the query");
  }
  if (*line == "LSL:streamfeed")
    return Refused("505 Version not supported: this outlet speaks 1.10, not 1.00");
  if (!line->starts_with("LSL:streamfeed/")) {
    return Refused("400 Bad request: there are LSL:shortinfo, LSL:fullinfo and LSL:streamfeed/110");
  }
  std::string_view words = line->substr(15);
  const auto version = text::As<int>(text::PopWord(words));
  const std::string_view uid = text::PopWord(words);
  if (!version) return Refused("400 Bad request: no version behind LSL:streamfeed/");
  if (*version < 110 || *version >= 200)
    return Refused("505 Version not supported: this outlet speaks 1.10");
  if (!uid.empty() && uid != info.uid)
    return Refused("404 Not found: the stream here has another uid; look for it again");
  while (true) {
    auto header = PopLine(rest);
    if (!header) return incomplete;
    if (header->empty()) break;
    const std::size_t colon = header->find(':');
    if (colon == std::string_view::npos) continue;
    const std::string name = text::Lower(std::string(text::Trim(header->substr(0, colon))));
    std::string_view rest_of_line = header->substr(colon + 1);
    const auto number = text::As<int>(text::Trim(rest_of_line.substr(0, rest_of_line.find(';'))));
    if (name == "value-size" && info.format != Format::kString &&
        number != static_cast<int>(BytesOf(info.format)))
      return Refused("415 Value-Size must be " + std::to_string(BytesOf(info.format)));
    if (name == "has-ieee754-floats" && number == 0)
      return Refused("415 Has-IEEE754-Floats must be 1");
    if (name == "data-protocol-version" && number.value_or(0) < 110)
      return Refused("505 Data-Protocol-Version must be 110");
  }
  return {Request::Kind::kStreamFeed};
}

std::string FeedRequest(const Info& info) {
  return "LSL:streamfeed/110 " + info.uid +
         "\r\nNative-Byte-Order: 1234\r\nEndian-Performance: 0\r\n"
         "Has-IEEE754-Floats: 1\r\nSupports-Subnormals: 1\r\nValue-Size: " +
         std::to_string(BytesOf(info.format)) +
         "\r\nData-Protocol-Version: 110\r\nMax-Buffer-Length: 360\r\nMax-Chunk-Length: 0\r\n"
         "Hostname: " +
         info.hostname + "\r\nSource-Id: " + info.source_id + "\r\nSession-Id: " + info.session_id +
         "\r\n\r\n";
}

std::string FeedStart(const Info& info) {
  return "LSL/110 200 OK\r\nUID: " + info.uid +
         "\r\nByte-Order: 1234\r\nSuppress-Subnormals: 0\r\nData-Protocol-Version: 110\r\n\r\n" +
         TestSamples(info.format, info.channels);
}

namespace {

template <typename T>
void AppendValue(T value, std::string& out) {
  static_assert(std::endian::native == std::endian::little);
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof value);
}

void AppendTime(double time_s, std::string& out) {
  out += kTimeFollows;
  AppendValue(time_s, out);
}

void AppendText(std::string_view text, std::string& out) {
  if (text.size() <= 0xFF) {
    out += '\1';
    AppendValue(static_cast<std::uint8_t>(text.size()), out);
  } else {
    out += '\4';
    AppendValue(static_cast<std::uint32_t>(text.size()), out);
  }
  out += text;
}

/// The value of a channel in a test sample: liblsl adds a number that the type only just holds.
template <typename T>
void AppendTest(std::size_t channel, std::size_t offset, std::string& out) {
  std::size_t value = channel + offset;
  if constexpr (sizeof(T) < 8 && std::is_integral_v<T>)
    value %= static_cast<std::size_t>(std::numeric_limits<T>::max());
  const T number = static_cast<T>(value);
  AppendValue(channel % 2 == 0 ? number : static_cast<T>(-number), out);
}

template <typename T>
T ValueAt(std::string_view bytes) {
  T value{};
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

double NumberAt(Format format, std::string_view bytes) {
  switch (format) {
    case Format::kFloat32:
      return ValueAt<float>(bytes);
    case Format::kDouble64:
      return ValueAt<double>(bytes);
    case Format::kString:
      break;
    case Format::kInt32:
      return ValueAt<std::int32_t>(bytes);
    case Format::kInt16:
      return ValueAt<std::int16_t>(bytes);
    case Format::kInt8:
      return ValueAt<std::int8_t>(bytes);
    case Format::kInt64:
      return static_cast<double>(ValueAt<std::int64_t>(bytes));
  }
  return 0;
}

}  // namespace

std::string TestSamples(Format format, std::size_t channels) {
  std::string out;
  for (const std::size_t offset : {4u, 2u}) {
    AppendTime(kTestTime, out);
    for (std::size_t k = 0; k < channels; ++k) {
      switch (format) {
        case Format::kFloat32:
          AppendTest<float>(k, offset, out);
          break;
        case Format::kDouble64:
          AppendTest<double>(k, offset + 16'777'217, out);
          break;
        case Format::kString:
          AppendText((k % 2 == 0 ? "" : "-") + std::to_string(k + 10), out);
          break;
        case Format::kInt32:
          AppendTest<std::int32_t>(k, offset + 65'537, out);
          break;
        case Format::kInt16:
          AppendTest<std::int16_t>(k, offset + 257, out);
          break;
        case Format::kInt8:
          AppendTest<std::int8_t>(k, offset + 1, out);
          break;
        case Format::kInt64:
          AppendTest<std::int64_t>(k, offset + 2'147'483'649, out);
          break;
      }
    }
  }
  return out;
}

void AppendSample(double time_s, std::span<const double> values, std::string& out) {
  AppendTime(time_s, out);
  for (const double value : values) AppendValue(value, out);
}

void AppendSample(double time_s, std::string_view text, std::string& out) {
  AppendTime(time_s, out);
  AppendText(text, out);
}

Result<void> FeedReader::Take(std::string_view bytes, std::vector<Sample>& samples) {
  bytes_ += bytes;
  if (state_ == State::kHeader) {
    const auto taken = TakeHeader();
    if (!taken) return taken.error();
    if (!*taken) return {};
    state_ = State::kTests;
  }
  if (state_ == State::kTests) {
    const auto taken = TakeTests();
    if (!taken) return taken.error();
    if (!*taken) return {};
    state_ = State::kSamples;
  }
  std::string_view rest = bytes_;
  while (true) {
    Sample sample;
    const auto count = ReadSample(rest, sample);
    if (!count) return count.error();
    if (*count == 0) break;
    rest.remove_prefix(*count);
    samples.push_back(std::move(sample));
  }
  bytes_.erase(0, bytes_.size() - rest.size());
  return {};
}

Result<bool> FeedReader::TakeHeader() {
  const std::string shown = info_.name + ": ";
  std::string_view rest = bytes_;
  const auto status = PopLine(rest);
  if (!status) {
    if (bytes_.size() > kMostRequestBytes) return InvalidData(shown + "its answer has no end");
    return false;
  }
  std::string_view words = *status;
  const std::string_view version = text::PopWord(words);
  if (!version.starts_with("LSL/") || words.empty())
    return InvalidData(shown + "its answer is none of LSL: " + text::Quoted(*status));
  if (text::PopWord(words) != "200")
    return InvalidData(shown + "it refuses: " + text::Quoted(*status));
  while (true) {
    const auto header = PopLine(rest);
    if (!header) {
      if (bytes_.size() > kMostRequestBytes) return InvalidData(shown + "its answer has no end");
      return false;
    }
    if (header->empty()) break;
    const std::size_t colon = header->find(':');
    if (colon == std::string_view::npos) continue;
    const std::string name = text::Lower(std::string(header->substr(0, colon)));
    const std::string_view value = text::Trim(header->substr(colon + 1));
    const bool fits = name == "uid"                     ? value == info_.uid
                      : name == "byte-order"            ? value == "1234" || value == "0"
                      : name == "data-protocol-version" ? value == "110"
                                                        : true;
    if (!fits) return InvalidData(shown + "it answers with another " + std::string(*header));
  }
  bytes_.erase(0, bytes_.size() - rest.size());
  return true;
}

Result<bool> FeedReader::TakeTests() {
  const std::string expected = TestSamples(info_.format, info_.channels);
  const std::size_t count = std::min(bytes_.size(), expected.size());
  if (bytes_.compare(0, count, expected, 0, count) != 0)
    return InvalidData(info_.name + ": its test samples are not those of protocol 1.10");
  if (count < expected.size()) return false;
  bytes_.erase(0, count);
  return true;
}

/// How many bytes it took; 0: more have to come.
Result<std::size_t> FeedReader::ReadSample(std::string_view bytes, Sample& sample) const {
  if (bytes.empty()) return std::size_t{0};
  if (bytes[0] != kTimeDeduced && bytes[0] != kTimeFollows)
    return InvalidData(info_.name + ": a sample begins with neither 1 nor 2");
  std::size_t at = 1;
  if (bytes[0] == kTimeFollows) {
    if (bytes.size() < at + 8) return std::size_t{0};
    sample.time_s = ValueAt<double>(bytes.substr(at));
    if (!std::isfinite(*sample.time_s) || std::abs(*sample.time_s) > 1e9)
      return InvalidData(info_.name + ": a sample's time makes no sense");
    at += 8;
  }
  if (info_.format != Format::kString) {
    const std::size_t size = BytesOf(info_.format);
    if (bytes.size() < at + size * info_.channels) return std::size_t{0};
    for (std::size_t k = 0; k < info_.channels; ++k, at += size)
      sample.values.push_back(NumberAt(info_.format, bytes.substr(at)));
    return at;
  }
  for (std::size_t k = 0; k < info_.channels; ++k) {
    if (bytes.size() < at + 1) return std::size_t{0};
    const auto size = static_cast<std::size_t>(bytes[at++]);
    if (size != 1 && size != 2 && size != 4 && size != 8)
      return InvalidData(info_.name + ": a text's length has neither 1, 2, 4 nor 8 bytes");
    if (bytes.size() < at + size) return std::size_t{0};
    std::uint64_t length = 0;
    std::memcpy(&length, bytes.data() + at, size);
    at += size;
    if (length > kMostTextBytes || at + length > kMostInfoBytes)
      return InvalidData(info_.name + ": a text of " + std::to_string(length) +
                         " bytes; at most 65536 are taken");
    if (bytes.size() < at + length) return std::size_t{0};
    sample.texts.emplace_back(bytes.substr(at, length));
    at += length;
  }
  return at;
}

}  // namespace footing::log_client::lsl
