#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/recording/walk.h"
#include "common/base/result.h"

namespace footing::log_client {

struct Topic {
  std::string name;
  std::string schema;
  std::uint64_t messages = 0;
  std::uint64_t first_ns = 0;
  std::uint64_t last_ns = 0;

  /// Between the first and the last message; 0 for fewer than two.
  double RateHz() const;
};

struct AttachmentNote {
  std::string name;
  std::string media_type;
  std::uint64_t bytes = 0;
};

/// What a recording holds.
struct Contents {
  std::string path;
  std::uint64_t bytes = 0;
  std::string library;
  std::vector<Topic> topics;  ///< By name.
  std::vector<AttachmentNote> attachments;
  std::vector<mcap::Metadata> metadata;
  std::uint64_t messages = 0;
  std::uint64_t start_ns = 0;
  std::uint64_t end_ns = 0;
  /// Some device or input of a character was simulated; nothing when no message says.
  std::optional<bool> simulated;
  /// What each footing-sim ran with, as it said last: its EffectiveConfig, JSON.
  std::vector<std::string> configs;
  std::uint64_t gaps = 0;
  std::uint64_t missing_ticks = 0;
  /// Gaps over a restart of a server: nobody knows how many ticks are missing there.
  std::uint64_t restarts = 0;
  double missing_s = 0;  ///< Time of the missing ticks.
  double restart_s = 0;  ///< From the last tick before each restart to the first one after it.
  mcap::WalkEnd end;
};

/// Reads a whole recording, cut ones as far as they go. InvalidData only when it is none at all.
Result<Contents> ReadContents(const std::string& path);

/// What is wrong with a recording that is not complete; nothing when it is.
std::optional<Error> Incomplete(const std::string& path, const mcap::WalkEnd& end);

}  // namespace footing::log_client
