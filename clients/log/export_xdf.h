#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"

namespace footing::log_client {

/// One stream of an exported file.
struct ExportedStream {
  std::string name;
  std::uint64_t channels = 0;
  std::uint64_t samples = 0;
  std::uint64_t mended_times = 0;  ///< Samples that were given a later time (RisingTimes).
};

/// Result of an export to XDF.
struct ExportedXdf {
  std::string path;
  std::vector<ExportedStream> streams;
};

/// Writes `folder`/NAME.xdf of the recording NAME.mcap, for readers of the Lab Streaming Layer: a
/// stream for each topic and each device (or entry of a list) in it, with the columns of CsvTable
/// that hold numbers, flags and enums; of the topic "events" a stream of texts. A sample's time is
/// when the device took it, else that of its tick: seconds of the server host's monotonic clock.
/// The times of each stream rise strictly. Errors as of ExportCsv().
Result<ExportedXdf> ExportXdf(const std::string& recording, const std::string& folder,
                              bool replace);

}  // namespace footing::log_client

/// Chunks of XDF 1.0, the file format of the Lab Streaming Layer (github.com/sccn/xdf, wiki
/// "Specifications"). All numbers are little-endian.
namespace footing::log_client::xdf {

/// One stream, as its header describes it. Its channels hold doubles, or it has one channel of
/// text.
struct Stream {
  std::uint32_t id = 0;  ///< From 1.
  std::string name;
  std::string type;       ///< The content in XDF's words ("MoCap", "Markers", ...), or our own.
  std::string source_id;  ///< The same for the same source in every recording.
  std::vector<std::string> channels;  ///< Their units stand in their names (UnitOf).
  bool is_text = false;
  std::string note{};  ///< Remark in the stream's header; may be empty.
  std::string xml{};   ///< The whole header, as another program described its stream; may be empty.
};

/// Contents of a stream's footer: first and last time, s, and sample count.
struct Extent {
  double first_s = 0, last_s = 0;
  std::uint64_t samples = 0;
};

/// The first bytes of a file: its mark and the file header chunk.
std::string FileStart();

/// Appends the chunk with the stream's header.
void AppendHeader(const Stream& stream, std::string& out);
/// Says what is to be added to the stream's times, at this one of them, for those of the file's
/// common clock. Readers expect one at the stream's begin and one at its end.
void AppendClockOffset(const Stream& stream, double time_s, double offset_s, std::string& out);
/// Appends the chunk with the stream's footer.
void AppendFooter(const Stream& stream, const Extent& extent, std::string& out);
/// A place at which a reader of a damaged file can start again; at least one in ten seconds.
void AppendBoundary(std::string& out);

/// Samples of one stream on their way into a chunk.
class Samples {
 public:
  /// Times are seconds of the streams' common clock; a row of numbers has one for each channel.
  void Add(double time_s, std::span<const double> numbers);
  void Add(double time_s, std::string_view text);
  void Add(double time_s, std::span<const std::string> texts);
  std::size_t bytes() const { return content_.size(); }
  /// Appends the chunk and becomes empty. Without samples it appends nothing.
  void AppendTo(const Stream& stream, std::string& out);

 private:
  std::string content_;
  std::uint64_t count_ = 0;
};

}  // namespace footing::log_client::xdf
