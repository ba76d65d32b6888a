#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/result.h"

/// Remote control of a recorder by the commands of LabRecorder (App-LabRecorder, "Remote Control"):
/// lines over TCP, each answered with "OK" or an error.
namespace footing::log_client {

/// The name of the next recording, as LabRecorder makes it from a template: %p is the participant,
/// %s the session, %b the task, %a the acquisition, %m the modality, %r and %n the run. A part in
/// brackets is left out when its field is empty. The file is an MCAP file within the root folder
/// that this program was started with, whatever a client asks for.
class RecordingName {
 public:
  /// `root` is the folder of all recordings; it need not exist yet.
  explicit RecordingName(const std::filesystem::path& root);

  /// Takes "{option:value} {option:value}": root, template, participant, session, task, run,
  /// acquisition, modality. A usage error changes nothing: an option that there is not, an open
  /// brace, a value with control characters, or a folder outside of the root.
  Result<void> Set(std::string_view options);

  /// Path of the next recording. Without a run that a client gave, it is the first run that has no
  /// file yet.
  std::filesystem::path Path() const;

  const std::filesystem::path& root() const { return fields_.root; }

 private:
  struct Fields {
    std::filesystem::path root;
    std::string name_template = "sub-%p/ses-%s/%m/sub-%p_ses-%s_task-%b[_acq-%a]_run-%r_%m.mcap";
    std::string participant = "P001", session = "S001", task = "Default", acquisition,
                modality = "motion";
    std::optional<int> run;
  };

  Result<void> SetOne(const std::string& option, const std::string& value, Fields& fields) const;
  Result<void> Check(const Fields& fields) const;

  std::filesystem::path outermost_;  ///< Absolute, without symbolic links.
  Fields fields_;
};

/// A marker as a line has it: text, then "{value:3.5}" and "{time_ns:123}" in any order.
struct MarkerLine {
  std::string text;
  std::optional<double> value;
  std::optional<std::int64_t> time_ns;  ///< On this host's CLOCK_MONOTONIC.
};
/// Usage error: an option's value is not a number. Other braces are part of the text.
Result<MarkerLine> ParseMarker(std::string_view line);

/// Cuts a stream of bytes into lines, without more memory than one line may have. Blanks at the end
/// of a line are dropped.
class LineReader {
 public:
  static constexpr std::size_t kMostBytes = 4096;

  /// Calls `on_line` for each line that is complete; nothing: it was longer than kMostBytes, and
  /// its rest is dropped.
  template <typename OnLine>
  void Take(std::string_view bytes, const OnLine& on_line) {
    for (const char byte : bytes) {
      if (byte == '\n') {
        End(on_line);
      } else if (line_.size() < kMostBytes) {
        line_ += byte;
      } else {
        too_long_ = true;
      }
    }
  }
  /// The stream has ended; a line without an end counts, too.
  template <typename OnLine>
  void Finish(const OnLine& on_line) {
    if (!line_.empty()) End(on_line);
  }

 private:
  template <typename OnLine>
  void End(const OnLine& on_line) {
    while (!line_.empty() && (line_.back() == '\r' || line_.back() == ' ' || line_.back() == '\t'))
      line_.pop_back();
    on_line(too_long_ ? std::optional<std::string>() : std::optional(line_));
    line_.clear();
    too_long_ = false;
  }

  std::string line_;
  bool too_long_ = false;
};

}  // namespace footing::log_client
