#include "common/net/tick_writer.h"

#include <string>

namespace footing::transport {
namespace {

/// A stretch of one tick's bytes.
struct Piece {
  const SharedTick* tick = nullptr;
  std::size_t begin = 0;
  std::size_t size = 0;
};

void Add(const SharedTick& tick, const Slice& slice, std::vector<Piece>& pieces) {
  if (!pieces.empty()) {
    Piece& last = pieces.back();
    if (last.tick->get() == tick.get() && last.begin + last.size == slice.begin) {
      last.size += slice.size;  // Neighbours go out as one.
      return;
    }
  }
  pieces.push_back({&tick, slice.begin, slice.size});
}

std::vector<Piece> PiecesOf(const TickQueue::Entry& entry, const Subscription& subscription) {
  std::vector<Piece> pieces;
  for (const Slice& slice : entry.tick->slices) {
    if (subscription.fields.count(slice.field) > 0) Add(entry.tick, slice, pieces);
  }
  std::size_t size = entry.tick->fields().size();
  for (const RetainedField& retained : entry.retained) {
    const bool wanted = subscription.fields.count(retained.field) > 0;
    if (!wanted || entry.tick->Find(retained.field) != nullptr) continue;
    const Slice& slice = *retained.tick->Find(retained.field);
    if (size + slice.size > subscription.max_channel_bytes) continue;
    size += slice.size;
    Add(retained.tick, slice, pieces);
  }
  return pieces;
}

void AddHead(const TickHead& head, std::size_t channel_bytes, WriteBatch& batch) {
  char bytes[kMaxTickHeadBytes];
  batch.AddHead(bytes, EncodeTickHead(head, channel_bytes, bytes));
}

}  // namespace

void AddTick(const TickQueue::Entry& entry, const Subscription& subscription, TickHead head,
             WriteBatch& batch) {
  static_assert(kMaxTickHeadBytes <= WriteBatch::kHeadBytes);
  head.sequence = entry.tick->sequence;
  head.host_ns = entry.tick->host_ns;
  if (subscription.all && entry.retained.empty()) {  // The usual case.
    const std::string& bytes = entry.tick->bytes;
    if (!head.refilled) return batch.AddShared(entry.tick, bytes.data(), bytes.size());
    const std::string_view fields = entry.tick->fields();
    AddHead(head, fields.size(), batch);
    if (!fields.empty()) batch.AddShared(entry.tick, fields.data(), fields.size());
    return;
  }
  const std::vector<Piece> pieces = PiecesOf(entry, subscription);
  std::size_t size = 0;
  for (const Piece& piece : pieces) size += piece.size;
  AddHead(head, size, batch);
  if (pieces.size() < kBuffersPerTick) {
    for (const Piece& piece : pieces) {
      batch.AddShared(*piece.tick, (*piece.tick)->bytes.data() + piece.begin, piece.size);
    }
    return;
  }
  std::string copied;
  copied.reserve(size);
  for (const Piece& piece : pieces) copied.append((*piece.tick)->bytes, piece.begin, piece.size);
  batch.AddOwned(std::move(copied));
}

}  // namespace footing::transport
