#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/result.h"

/// Bytes of the Lab Streaming Layer, protocol 1.10, as liblsl speaks it (github.com/sccn/liblsl):
/// queries and times over UDP, descriptions and samples over TCP. All times are seconds of
/// CLOCK_MONOTONIC, which is liblsl's local_clock() on Linux. No socket is here.
namespace footing::log_client::lsl {

/// Port of the queries for streams, and the first of the 32 that outlets take before any other.
inline constexpr std::uint16_t kQueryPort = 16571;
inline constexpr std::uint16_t kFirstPort = 16572;
inline constexpr std::uint16_t kPorts = 32;
/// Groups that liblsl's queries go to within a site, over IPv4.
inline constexpr const char* kGroups[] = {"224.0.0.1", "224.0.0.183", "239.255.172.215"};

// Bounds, so that no peer takes more memory than these.
inline constexpr std::size_t kMostRequestBytes = 16'384;
inline constexpr std::size_t kMostInfoBytes = 1u << 20;
inline constexpr std::size_t kMostChannels = 2048;
inline constexpr std::size_t kMostTextBytes = 1u << 16;

/// Type of all values of a stream.
enum class Format { kFloat32, kDouble64, kString, kInt32, kInt16, kInt8, kInt64 };

/// Bytes of a value; 0: a text, which brings its length.
std::size_t BytesOf(Format format);

/// One channel, as the description names it.
struct Channel {
  std::string label;
  std::string unit;  ///< Such as "m/s^2"; empty: a number without one.
};

/// Description of a stream.
struct Info {
  std::string name;
  std::string type;       ///< Such as "Accelerometer", "MoCap", "Markers".
  std::string source_id;  ///< The same in the next run: by it an inlet finds the stream again.
  Format format = Format::kDouble64;
  std::size_t channels = 1;
  double nominal_hz = 0;  ///< 0: irregular.
  double created_s = 0;
  std::string uid;  ///< Other in each run.
  std::string session_id = "default";
  std::string hostname;
  std::string v4address;  ///< Empty: the address that an answer comes from.
  std::uint16_t data_port = 0;
  std::uint16_t service_port = 0;
  std::string description;  ///< Contents of the element desc, XML.
};

/// An element of XML, with what XML does not allow in a text replaced.
std::string Element(std::string_view name, std::string_view text);
/// Contents of the element desc: the channels, and in front of them `notes` as elements.
std::string Describe(const std::vector<Channel>& channels, const std::string& type,
                     const std::vector<std::pair<std::string, std::string>>& notes);

/// The stream as XML, without and with its description.
std::string ShortInfo(const Info& info);
std::string FullInfo(const Info& info);
/// InvalidData for XML that is none, a field that is missing or makes no sense, or one beyond the
/// bounds above.
Result<Info> ParseInfo(std::string_view xml);

/// Whether the stream is one that a query asks for: an XPath predicate on the fields of a stream,
/// as clients of LSL write them. There are the fields, texts, numbers, = != < <= > >=, and, or,
/// not(), starts-with(), contains() and brackets. A query of anything else matches nothing; an
/// empty one matches all.
bool Matches(const Info& info, std::string_view query);
/// Error that says what Matches() does not know in a query.
Result<void> CheckQuery(std::string_view query);

/// A query for streams: "LSL:shortinfo", over UDP.
struct ShortInfoRequest {
  std::string query;
  std::uint16_t return_port = 0;
  std::string query_id;  ///< The answer begins with it.
};
std::optional<ShortInfoRequest> ParseShortInfoRequest(std::string_view datagram);
std::string Encode(const ShortInfoRequest& request);
std::string ShortInfoAnswer(const std::string& query_id, const Info& info);

/// One exchange of times, "LSL:timedata": sent t0 and arrived t3 by the asker's clock, arrived t1
/// and answered t2 by the other one's, s.
struct TimeExchange {
  std::int32_t wave = 0;
  double t0 = 0, t1 = 0, t2 = 0, t3 = 0;

  double round_trip_s() const { return (t3 - t0) - (t2 - t1); }
  /// To be added to a time of the other one's clock. Half the round trip bounds its error.
  double correction_s() const { return -((t1 - t0) + (t2 - t3)) / 2; }
};
std::optional<TimeExchange> ParseTimeRequest(std::string_view datagram);  ///< Wave and t0.
std::string EncodeTimeRequest(const TimeExchange& exchange);
std::optional<TimeExchange> ParseTimeAnswer(std::string_view datagram);  ///< All but t3.
std::string EncodeTimeAnswer(const TimeExchange& exchange);

/// The first bytes of a connection to a stream's data port.
struct Request {
  enum class Kind { kIncomplete, kShortInfo, kFullInfo, kStreamFeed, kRefused };
  Kind kind = Kind::kIncomplete;
  std::string refusal{};  ///< With its status line, such as "LSL/110 404 Not found ...".
};
/// A query over TCP that the stream does not match is refused, as is a feed of another uid, another
/// protocol than 1.10, or of values of other sizes than the stream has.
Request ParseRequest(std::string_view bytes, const Info& info);

/// The request of a client that wants the feed of a stream.
std::string FeedRequest(const Info& info);
/// The answer to it, up to the first sample: a header and two test samples.
std::string FeedStart(const Info& info);
/// The second part of FeedStart(): samples with known values, by which both see that they agree.
std::string TestSamples(Format format, std::size_t channels);

/// Appends one sample of numbers, or of texts.
void AppendSample(double time_s, std::span<const double> values, std::string& out);
void AppendSample(double time_s, std::string_view text, std::string& out);

/// One sample as it came.
struct Sample {
  std::optional<double> time_s;  ///< Nothing: one period after the sample before.
  std::vector<double> values;    ///< Integers of 64 bits are the nearest double.
  std::vector<std::string> texts;
};

/// The receiving end of a feed: bytes as they come, into samples. A plain value.
class FeedReader {
 public:
  explicit FeedReader(const Info& info) : info_(info) {}

  /// InvalidData for a refusal, in the other one's words, wrong test samples, a uid or protocol
  /// that was not asked for, or a text of more than kMostTextBytes; nothing is read afterwards.
  Result<void> Take(std::string_view bytes, std::vector<Sample>& samples);

 private:
  Result<bool> TakeHeader();
  Result<bool> TakeTests();
  Result<std::size_t> ReadSample(std::string_view bytes, Sample& sample) const;

  Info info_;
  std::string bytes_;
  enum class State { kHeader, kTests, kSamples } state_ = State::kHeader;
};

}  // namespace footing::log_client::lsl
