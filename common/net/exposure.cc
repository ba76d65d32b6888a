#include "common/net/exposure.h"

#include "common/net/socket.h"

namespace footing::transport {

Result<void> CheckKeys(const Address& address, bool has_keys, const ListenSettings& settings) {
  if (has_keys) return {};
  return UsageError("will not listen on " + address.Text() +
                    ": anyone who reaches the port could come in; " + settings.keys);
}

Result<void> CheckEncrypted(const Address& address, bool in_clear, const ListenSettings& settings) {
  if (address.kind != Address::Kind::kTcp || StaysOnThisHost(address) || in_clear) return {};
  return UsageError("will not listen on " + address.Text() +
                    ": beyond this host a connection must be encrypted; use tls:HOST:PORT, or, in "
                    "a network that you trust wholly, " +
                    settings.in_clear);
}

}  // namespace footing::transport
