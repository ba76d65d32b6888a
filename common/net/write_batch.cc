#include "common/net/write_batch.h"

#include <algorithm>
#include <utility>

#include "common/base/result.h"

namespace footing::transport {

void WriteBatch::AddOwned(std::string bytes) {
  FOOTING_CHECK(free_buffers() > 0);
  if (bytes.size() <= kHeadBytes) {
    AddHead(bytes.data(), bytes.size());
    return;
  }
  owned_.push_back(std::make_unique<const std::string>(std::move(bytes)));
  buffers_.emplace_back(owned_.back()->data(), owned_.back()->size());
}

void WriteBatch::AddHead(const char* bytes, std::size_t size) {
  FOOTING_CHECK(free_buffers() > 0 && size <= kHeadBytes);
  auto& head = heads_[heads_used_++];
  std::copy(bytes, bytes + size, head.begin());
  buffers_.emplace_back(head.data(), size);
}

void WriteBatch::AddShared(std::shared_ptr<const void> owner, const char* bytes, std::size_t size) {
  FOOTING_CHECK(free_buffers() > 0);
  if (shared_.empty() || shared_.back() != owner) shared_.push_back(std::move(owner));
  buffers_.emplace_back(bytes, size);
}

void WriteBatch::Consume(std::size_t bytes) {
  while (first_ < buffers_.size() && bytes >= buffers_[first_].size()) {
    bytes -= buffers_[first_].size();
    ++first_;
  }
  if (first_ < buffers_.size()) {
    buffers_[first_] += bytes;
    return;
  }
  buffers_.clear();
  first_ = 0;
  heads_used_ = 0;
  owned_.clear();
  shared_.clear();
}

std::unique_ptr<WriteBatch> BatchPool::Take() {
  if (free_.empty()) return std::make_unique<WriteBatch>();
  std::unique_ptr<WriteBatch> batch = std::move(free_.back());
  free_.pop_back();
  return batch;
}

void BatchPool::Give(std::unique_ptr<WriteBatch> batch) {
  constexpr std::size_t kMaxFree = 16;
  FOOTING_CHECK(batch->empty());
  if (free_.size() < kMaxFree) free_.push_back(std::move(batch));
}

}  // namespace footing::transport
