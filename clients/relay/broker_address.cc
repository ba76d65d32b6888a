#include "clients/relay/broker_address.h"

#include "common/net/socket.h"

namespace footing::relay {

Result<transport::Address> ParseBrokerAddress(const std::string& text, const std::string& instead) {
  const bool named = text.starts_with("tcp:") || text.starts_with("tls:") ||
                     text.starts_with("unix:") || text.starts_with("fd:");
  auto address = transport::ParseAddress(named ? text : "tcp:" + text);
  if (!address) return UsageError("\"" + text + "\" is not a broker's address, [tcp:]HOST:PORT");
  if (address->kind != transport::Address::Kind::kTcp) {
    return UsageError(text + ": a broker is dialled at tcp:HOST:PORT");
  }
  if (const auto endpoint = transport::EndpointOf(*address); !endpoint) return endpoint.error();
  if (!transport::StaysOnThisHost(*address)) {
    return UsageError(text + ": would leave this host unencrypted; " + instead);
  }
  return address;
}

}  // namespace footing::relay
