#pragma once

#include <google/protobuf/arena.h>

#include <cstddef>
#include <string_view>
#include <vector>

#include "footing/v1/session.pb.h"

namespace footing::transport {

/// Every message is parsed into one block, again and again: a tick has dozens of small parts, and
/// fetching them from all over the heap takes longer than parsing them.
class MessageParser {
 public:
  MessageParser() : arena_(block_.data(), block_.size()) {}

  /// Valid until the next one or Discard(); null for bytes that are not a message.
  const v1::Envelope* Parse(std::string_view payload) {
    if (parsed_) Discard();
    parsed_ = true;
    const bool good = message_->ParseFromArray(payload.data(), static_cast<int>(payload.size()));
    return good ? message_ : nullptr;
  }

  /// Drops the message. Whoever calls this once the message is handled gets the next one sooner,
  /// which then finds the block empty.
  void Discard() {
    arena_.Reset();
    message_ = NewMessage();
    parsed_ = false;
  }

 private:
  v1::Envelope* NewMessage() {
    return google::protobuf::Arena::CreateMessage<v1::Envelope>(&arena_);
  }

  /// Enough for a tick of eight devices; a longer message takes more from the heap.
  static constexpr std::size_t kArenaBytes = 32 << 10;

  std::vector<char> block_ = std::vector<char>(kArenaBytes);
  google::protobuf::Arena arena_;
  v1::Envelope* message_ = NewMessage();
  bool parsed_ = false;
};

}  // namespace footing::transport
