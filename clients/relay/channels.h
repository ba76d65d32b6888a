#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/net/server.h"
#include "common/net/session.h"
#include "footing/v1/session.pb.h"

/// Channels as a relay sees them: their kinds, and how they are thinned to a rate.
namespace footing::relay {

/// How a channel is relayed at a reduced rate.
enum class ChannelKind {
  kRetained,  ///< A state: its last value is kept for those who come later.
  kSampled,   ///< Samples or poses: a newer one takes an older one's place.
  kWhole,     ///< Everything else, such as events: none may be left out.
};

/// Kind of a field of v1::Tick. A field that this version does not know is relayed whole.
ChannelKind KindOf(std::uint32_t field);

/// The name of a channel; empty for a field that is none.
std::string ChannelName(std::uint32_t field);

/// The channels of these names, each once, as a server publishes them; names that nobody knows are
/// left out.
std::vector<transport::Channel> ChannelsNamed(
    const google::protobuf::RepeatedPtrField<std::string>& names);

/// Usage error that lists the channels there are when one of `names` is none of them.
Result<void> CheckChannels(const std::vector<std::string>& names);

/// True for a number and time from which ticks can be counted on: what comes from a broker may be
/// anything.
bool IsSound(const transport::TickNumber& number);

/// Takes the ticks of one epoch and gives those that viewers get: of each channel of samples or
/// poses at most `rate_hz` a second, the newest; retained channels and events whole, at once.
///
/// All sampled channels go out at the same instants, so that viewers get `rate_hz` frames a second
/// however many devices there are. What waits for them goes with the next tick that comes when it
/// is due, so that the last value before a pause is not lost. The tick behind a hole in the
/// sequence is always given, with the hole. A plain value.
class Thinner {
 public:
  struct Thinned {
    transport::TickNumber number;
    std::vector<transport::ChannelBytes> channels;
  };

  /// `rate_hz` 0: every tick. `last_sequence` has been had already.
  Thinner(double rate_hz, double tick_rate_hz, std::uint64_t last_sequence);

  /// Nothing for a tick that is left out, was had already, or is not sound. missing_from of
  /// `number` is ignored.
  std::optional<Thinned> Take(const transport::TickNumber& number,
                              std::vector<transport::ChannelBytes> channels);

  /// Retained channels of a snapshot, as of a sequence: they go with the next tick. Those that a
  /// later tick has brought meanwhile are left alone; all, when the snapshot is older than the
  /// `last_sequence` of the beginning.
  void TakeRetained(std::uint64_t sequence, std::vector<transport::ChannelBytes> channels);

  std::uint64_t last_sequence() const { return last_sequence_; }
  std::uint64_t missing() const { return missing_; }    ///< Ticks that never came.
  std::uint64_t left_out() const { return left_out_; }  ///< Ticks of which nothing went on.

 private:
  double rate_hz_;
  std::uint64_t begin_;  ///< Older retained channels are of no use.
  std::uint64_t last_sequence_;
  std::map<std::uint32_t, std::string> waiting_;  ///< Newest samples of each channel, by field.
  std::map<std::uint32_t, std::string> retained_;
  std::map<std::uint32_t, std::uint64_t> came_;  ///< Sequence of a retained channel's last value.
  transport::Decimator decimator_;
  std::uint64_t missing_ = 0;
  std::uint64_t left_out_ = 0;
};

// Where the messages of one server of one site go in NATS and MQTT. A message is an Envelope of
// our protocol, as it is within a frame.

/// footing.SITE.SERVER.tick: every tick of the server.
std::string TickSubject(const std::string& site, const std::string& server);
/// footing.SITE.SERVER.ask: a Hello is answered by a Welcome and a snapshot, a Ping by a Pong.
std::string AskSubject(const std::string& site, const std::string& server);
/// footing/SITE/SERVER/CHANNEL: the ticks of one channel.
std::string ChannelTopic(const std::string& site, const std::string& server,
                         const std::string& channel);

/// One tick of these channels.
std::string TickMessage(std::uint64_t epoch, const transport::TickNumber& number,
                        const std::vector<transport::ChannelBytes>& channels);

}  // namespace footing::relay
