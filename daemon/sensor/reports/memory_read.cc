#include "daemon/sensor/reports/memory_read.h"

namespace footing::reports {

OutputReport MemoryRead::Request() const {
  return ReadMemory(space_, address_ + static_cast<std::uint32_t>(bytes_.size()),
                    static_cast<std::uint16_t>(size_ - bytes_.size()));
}

MemoryRead::Progress MemoryRead::Take(const MemoryData& reply) {
  const std::size_t missing = size_ - bytes_.size();
  const auto due = static_cast<std::uint16_t>(address_ + bytes_.size());
  if (missing == 0 || reply.offset != due) return Progress::kForeign;
  if (reply.error != 0) {
    error_ = reply.error;
    return Progress::kRefused;
  }
  if (reply.size > missing) return Progress::kForeign;
  bytes_.insert(bytes_.end(), reply.data.begin(), reply.data.begin() + reply.size);
  return bytes_.size() == size_ ? Progress::kDone : Progress::kMore;
}

}  // namespace footing::reports
