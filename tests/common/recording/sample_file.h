#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/recording/mcap_reader.h"
#include "common/recording/mcap_writer.h"

namespace footing::mcap {

/// Message k of topic k % 2, at k * 100 ms; its bytes are "message k" and k % 7 dots.
std::string SampleText(int k);

/// A small recording of every kind of record: two topics, `messages` messages in chunks of 500 ms,
/// one attachment and one metadata record before them.
std::string SampleFile(int messages);

/// Contents that a walk shows.
struct Seen {
  std::vector<std::string> messages;
  std::vector<std::uint64_t> log_times_ns;
  std::vector<std::string> topics;
  std::vector<std::string> attachments;
  std::vector<std::string> metadata;
  WalkEnd end;
};
Seen WalkAll(const std::string& file, WalkMode mode);

}  // namespace footing::mcap
