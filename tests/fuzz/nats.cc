#include <string>
#include <string_view>

#include "clients/relay/nats_protocol.h"
#include "tests/fuzz/input.h"
#include "tests/fuzz/pieces.h"

/// Bytes of a broker: in pieces of any length they come to the same messages as at once, none is
/// longer than what the client takes, and no more is buffered than one line or message.
namespace footing::fuzz {
namespace {

namespace nats = relay::nats;

constexpr std::size_t kMaxPayload = 512;
constexpr std::size_t kMostHeld = nats::Parser::kMaxLineBytes + kMaxPayload + 2;

nats::Handlers Into(Decoded& taken) {
  nats::Handlers handlers;
  handlers.on_info = [&taken](const nats::ServerInfo& info) {
    taken.messages.push_back("INFO " + info.version + " " + std::to_string(info.max_payload));
  };
  handlers.on_message = [&taken](const nats::Message& message) {
    Expect(message.payload.size() <= kMaxPayload && !message.subject.empty());
    Expect(message.subject.find(' ') == std::string_view::npos);
    taken.messages.push_back("MSG " + std::string(message.subject) + " " +
                             std::to_string(message.subscription) + " " +
                             std::string(message.reply) + (message.no_responders ? " 503 " : " ") +
                             std::string(message.payload));
  };
  handlers.on_ping = [&taken] { taken.messages.push_back("PING"); };
  handlers.on_pong = [&taken] { taken.messages.push_back("PONG"); };
  handlers.on_error = [&taken](std::string_view text) {
    taken.messages.push_back("ERR " + std::string(text));
  };
  return handlers;
}

Decoded InPieces(std::string_view bytes, Input pieces) {
  nats::Parser parser(kMaxPayload);
  Decoded taken;
  const nats::Handlers handlers = Into(taken);
  while (!bytes.empty() && !taken.refused) {
    const std::string_view piece = bytes.substr(0, std::size_t{1} + pieces.Byte());
    taken.refused = !parser.Take(piece, handlers).ok();
    Expect(taken.refused || parser.buffered() <= kMostHeld);
    bytes.remove_prefix(piece.size());
  }
  return taken;
}

Decoded AtOnce(std::string_view bytes) {
  nats::Parser parser(kMaxPayload);
  Decoded taken;
  taken.refused = !parser.Take(bytes, Into(taken)).ok();
  return taken;
}

}  // namespace
}  // namespace footing::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace footing;
  (void)fuzz::CheckPieces(data, size, fuzz::AtOnce, fuzz::InPieces);
  return 0;
}
