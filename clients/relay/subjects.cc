#include "clients/relay/subjects.h"

#include <array>

#include "common/net/framing.h"
#include "common/net/tick.h"

namespace footing::relay {

std::string TickSubject(const std::string& site, const std::string& server) {
  return "footing." + site + "." + server + ".tick";
}

std::string AskSubject(const std::string& site, const std::string& server) {
  return "footing." + site + "." + server + ".ask";
}

std::string ChannelTopic(const std::string& site, const std::string& server,
                         const std::string& channel) {
  return "footing/" + site + "/" + server + "/" + channel;
}

std::string TickMessage(std::uint64_t epoch, const transport::TickNumber& number,
                        const std::vector<transport::ChannelBytes>& channels) {
  transport::Tick tick;
  for (const transport::ChannelBytes& channel : channels) {
    transport::AppendField(channel.field, channel.bytes, tick);
  }
  transport::TickHead head;
  head.epoch = epoch;
  head.sequence = number.sequence;
  head.host_ns = number.host_ns;
  std::array<char, transport::kMaxTickHeadBytes> bytes;
  const std::size_t size = transport::EncodeTickHead(head, tick.bytes.size(), bytes.data());
  // Without the length in front: a message of a broker has its own.
  return std::string(bytes.data() + transport::kLengthBytes, size - transport::kLengthBytes) +
         tick.bytes;
}

}  // namespace footing::relay
