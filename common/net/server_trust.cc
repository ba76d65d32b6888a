#include "common/net/server_trust.h"

#include <unistd.h>

#include <optional>
#include <utility>

#include "common/runtime/log.h"
#include "common/net/identity.h"
#include "common/net/places.h"

namespace footing::transport {

std::shared_ptr<ServerTrust> ServerTrust::Of(const Address& address) {
  return std::make_shared<ServerTrust>(KnownName(address),
                                       tls::KnownServers(tls::KnownServersFile()));
}

std::string ServerTrust::WhyRefused(const std::string& fingerprint) {
  const auto known = known_.Find(server_);
  if (!known) return "not connected to tls:" + server_ + ": " + known.error().message;
  if (*known) {
    if (**known == fingerprint) return "";
    return "tls:" + server_ + ": THE CERTIFICATE HAS CHANGED: it is " + fingerprint + ", and " +
           known_.path() + " has " + **known +
           "; either the server made a new one, or somebody else answers in its place. Compare it "
           "with what footing-ctl trust prints on the server; if it is the same, run: footing-ctl "
           "trust tls:" +
           server_ + " " + fingerprint;
  }
  is_new_ = true;
  return "";
}

std::string ServerTrust::OnProved(const std::string& fingerprint) {
  if (!is_new_) return "";
  // Who cannot remember it would trust anybody, each time.
  if (const auto added = known_.Add(server_, fingerprint); !added) {
    return "not connected to tls:" + server_ + ": its certificate " + fingerprint +
           " cannot be remembered: " + added.error().message;
  }
  is_new_ = false;
  log::Warning("trusting tls:" + server_ + " from now on: its certificate is " + fingerprint +
               "; compare it with what footing-ctl trust prints on the server");
  return "";
}

std::string KnownName(const Address& address) { return address.Text().substr(sizeof("tls:") - 1); }

namespace {

/// Keeps the context of a loop's clients.
class ClientTls : public boost::asio::execution_context::service {
 public:
  using key_type = ClientTls;
  inline static boost::asio::execution_context::id id;

  explicit ClientTls(boost::asio::execution_context& owner) : service(owner) {}

  std::optional<tls::Context> context;
  bool shows_own = false;  ///< The user's own certificate.

 private:
  void shutdown() override {}
};

Result<tls::Context> NewClientContext(const std::string& path, bool shows_own) {
  if (!shows_own) return tls::Context::ForClient(nullptr);
  const auto own = tls::Identity::Load(path);
  if (!own) return own.error();
  return tls::Context::ForClient(&*own);
}

}  // namespace

Result<tls::Context> ClientContext(boost::asio::io_context& io) {
  auto& kept = boost::asio::use_service<ClientTls>(io);
  const std::string path = tls::ClientIdentityFile();
  const bool shows_own = !path.empty() && access(path.c_str(), F_OK) == 0;
  // A certificate that was made while this client ran is shown from the next connection on.
  if (!kept.context || (shows_own && !kept.shows_own)) {
    auto made = NewClientContext(path, shows_own);
    if (!made) return made;
    kept.context = std::move(made).value();
    kept.shows_own = shows_own;
  }
  return *kept.context;
}

}  // namespace footing::transport
