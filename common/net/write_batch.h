#pragma once

#include <array>
#include <boost/asio/buffer.hpp>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace footing::transport {

/// What one gather-write sends: small pieces of its own beside bytes that many sessions share.
/// It keeps all of them alive until they are written.
class WriteBatch {
 public:
  /// As many buffers as one writev(2) of Asio takes.
  static constexpr std::size_t kMaxBuffers = 64;
  static constexpr std::size_t kHeadBytes = 64;

  WriteBatch() { buffers_.reserve(kMaxBuffers); }
  WriteBatch(const WriteBatch&) = delete;
  WriteBatch& operator=(const WriteBatch&) = delete;

  bool empty() const { return first_ == buffers_.size(); }
  std::size_t free_buffers() const { return kMaxBuffers - buffers_.size(); }

  /// Bytes that belong to this batch alone.
  void AddOwned(std::string bytes);
  /// At most kHeadBytes, copied.
  void AddHead(const char* bytes, std::size_t size);
  /// A part of shared bytes. `owner` is kept until the batch is written.
  void AddShared(std::shared_ptr<const void> owner, const char* bytes, std::size_t size);

  std::span<const boost::asio::const_buffer> buffers() const {
    return std::span(buffers_).subspan(first_);
  }
  /// `bytes` more are written. The batch is empty again once all are.
  void Consume(std::size_t bytes);

 private:
  std::vector<boost::asio::const_buffer> buffers_;
  std::size_t first_ = 0;
  std::array<std::array<char, kHeadBytes>, kMaxBuffers> heads_;
  std::size_t heads_used_ = 0;
  std::vector<std::unique_ptr<const std::string>> owned_;
  std::vector<std::shared_ptr<const void>> shared_;
};

/// Empty batches for the connections of one thread. The one given back last is taken first: with
/// many sessions served one after the other it is still in the processor's cache, which a batch of
/// each session's own would not be.
class BatchPool {
 public:
  std::unique_ptr<WriteBatch> Take();
  void Give(std::unique_ptr<WriteBatch> batch);

 private:
  std::vector<std::unique_ptr<WriteBatch>> free_;
};

}  // namespace footing::transport
