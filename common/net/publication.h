#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "common/net/server.h"
#include "common/net/tick.h"
#include "common/net/tick_ring.h"

namespace footing::transport {

/// What has been published: the ring of the last ticks and the last value of every retained
/// channel. All sessions read it.
class Publication {
 public:
  explicit Publication(const ServerOptions& options);

  /// Of the heads of ticks from now on.
  void set_epoch(std::uint64_t epoch) { epoch_ = epoch; }

  /// Serialises a tick once. Channels that would make it longer than max_message_out_bytes are left
  /// out, and so are fields that are not a channel. Its sequence is above the last one's. Keep() it
  /// once it is on its way.
  SharedTick Publish(const TickNumber& number, const std::vector<ChannelBytes>& channels);
  /// From now on it is part of the ring, and its retained channels of every snapshot.
  void Keep(const SharedTick& tick);

  /// The number of the next tick of the owner's rhythm; LeaveOut() makes a hole in front of it.
  TickNumber Next(std::int64_t host_ns) const;
  void LeaveOut(std::uint64_t ticks) { left_out_next_ += ticks; }

  /// See Server::BeginAt().
  void BeginAt(const TickNumber& number, const std::vector<ChannelBytes>& retained);

  /// The last values of the retained channels, as one tick with the given sequence.
  SharedTick Snapshot(std::uint64_t sequence, std::int64_t host_ns) const;

  const TickRing& ring() const { return ring_; }
  const std::set<std::uint32_t>& retained() const { return retained_; }
  std::uint64_t last_sequence() const { return last_sequence_; }
  std::uint64_t channels_left_out() const { return channels_left_out_; }
  /// The field of the newest channel that was left out.
  std::uint32_t left_out_field() const { return left_out_field_; }

 private:
  std::shared_ptr<Tick> Serialise(const TickNumber& number,
                                  const std::vector<ChannelBytes>& channels);
  std::size_t Fit(const std::vector<ChannelBytes>& channels);
  void KeepRetained(const SharedTick& tick);

  std::vector<std::uint32_t> fields_;  ///< Side by side: a tick finds a tree's nodes cold.
  std::set<std::uint32_t> retained_;
  std::vector<const ChannelBytes*> fitting_;  ///< Of the tick being made.
  std::size_t max_tick_bytes_;
  TickRing ring_;
  std::map<std::uint32_t, SharedTick> last_values_;
  std::uint64_t last_sequence_ = 0;
  std::uint64_t epoch_ = 0;
  std::uint64_t left_out_next_ = 0;
  std::uint64_t channels_left_out_ = 0;
  std::uint32_t left_out_field_ = 0;
};

}  // namespace footing::transport
