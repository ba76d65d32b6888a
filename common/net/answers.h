#pragma once

#include <cstdint>
#include <deque>
#include <unordered_map>
#include <utility>

#include "footing/v1/session.pb.h"

namespace footing::transport {

/// Of a command that states none.
inline constexpr std::uint32_t kDefaultDeadlineMs = 1000;

/// The answers to a session's last commands, so that a repeated id gets its first answer again.
class Answers {
 public:
  explicit Answers(std::size_t capacity) : capacity_(capacity) {}

  /// Null when that id was not answered, or too long ago.
  const v1::CommandResult* Find(std::uint64_t id) const {
    const auto found = by_id_.find(id);
    return found == by_id_.end() ? nullptr : &found->second;
  }

  void Remember(const v1::CommandResult& answer) {
    if (!by_id_.emplace(answer.id(), answer).second) return;
    order_.push_back(answer.id());
    if (order_.size() <= capacity_) return;
    by_id_.erase(order_.front());
    order_.pop_front();
  }

 private:
  std::size_t capacity_;
  std::deque<std::uint64_t> order_;
  std::unordered_map<std::uint64_t, v1::CommandResult> by_id_;
};

}  // namespace footing::transport
