#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <string_view>
#include <utility>

#include "common/net/framing.h"
#include "common/net/write_batch.h"

namespace footing::transport {

/// Frames that wait to be written, oldest first.
class Outbox {
 public:
  void Add(std::string_view payload) {
    bytes_ += payload.size();
    frames_.push_back(Frame(payload));
  }

  /// As many as the batch has space for.
  void MoveTo(WriteBatch& batch) {
    while (!frames_.empty() && batch.free_buffers() > 0) {
      bytes_ -= frames_.front().size() - kLengthBytes;
      batch.AddOwned(std::move(frames_.front()));
      frames_.pop_front();
    }
  }

  bool empty() const { return frames_.empty(); }
  std::size_t frames() const { return frames_.size(); }
  /// Of their payloads.
  std::size_t bytes() const { return bytes_; }

 private:
  std::deque<std::string> frames_;
  std::size_t bytes_ = 0;
};

}  // namespace footing::transport
