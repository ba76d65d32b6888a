#include <unistd.h>

#include <memory>
#include <string>

#include "clients/ctl/commands.h"
#include "clients/ctl/report/qr_code.h"
#include "common/cli/cli.h"
#include "common/net/fingerprint.h"
#include "common/net/identity.h"
#include "common/net/known_servers.h"
#include "common/net/places.h"
#include "common/net/address.h"
#include "common/net/server_trust.h"

namespace footing::ctl {
namespace {

constexpr char kServiceState[] = "/var/lib/footing";  // As in systemd/footingd.service.
constexpr char kServiceIdentity[] = "/var/lib/footing/identity.pem";

struct TrustOptions {
  std::string address, fingerprint, identity;
  bool client = false;
};

std::string Drawn(const std::string& fingerprint) {
  return isatty(STDOUT_FILENO) == 1 ? "\n" + display::QrCode(fingerprint) : "";
}

bool IsThere(const std::string& path) { return access(path.c_str(), F_OK) == 0; }

/// The service has a certificate of its own.
std::string OfService(const std::string& shown) {
  if (shown == kServiceIdentity || !IsThere(kServiceState)) return "";
  return std::string("\nFor the certificate of the service: sudo footing-ctl trust --identity ") +
         kServiceIdentity;
}

/// The certificate in a file; only a server makes it.
Result<tls::Identity> LoadServers(const std::string& file) {
  auto identity = tls::Identity::Load(file);
  if (identity || identity.error().kind != ErrorKind::kFailure) return identity;
  return Failure(identity.error().message +
                 "; a server makes it when it first listens on tls:, and only its user and root "
                 "can read it (sudo footing-ctl trust --identity " +
                 file + ")");
}

/// The certificate of a server: of the named file, else of the servers that this user runs, else of
/// the service.
Result<void> ShowServer(const TrustOptions& options, const Shared& shared) {
  std::string file = options.identity.empty() ? tls::DefaultIdentityFile() : options.identity;
  const bool has_own = !file.empty() && IsThere(file);
  if (options.identity.empty() && !has_own && IsThere(kServiceState)) file = kServiceIdentity;
  const bool may_make = options.identity.empty() && !has_own && file != kServiceIdentity;
  const auto identity = may_make ? tls::Identity::LoadOrMake(file, "Footing") : LoadServers(file);
  if (!identity) return identity.error();
  Print({{"fingerprint", identity->fingerprint()}, {"file", file}},
        identity->fingerprint() + "\n\nThis is the certificate of servers that have " + file +
            ".\nOn the client's machine, compare it with what the first connection prints, or "
            "trust it beforehand:\n  footing-ctl trust tls:HOST:PORT " +
            identity->fingerprint() + OfService(file) + Drawn(identity->fingerprint()),
        shared);
  return {};
}

/// The user's own certificate, for a server's clients_file.
Result<void> ShowClient(const Shared& shared) {
  const std::string file = tls::ClientIdentityFile();
  const auto identity = tls::Identity::LoadOrMake(file, "Footing client");
  if (!identity) return identity.error();
  const std::string line = identity->fingerprint() + " view " + cli::UserAtHost();
  Print({{"fingerprint", identity->fingerprint()}, {"file", file}, {"line", line}},
        line +
            "\n\nAdd this line to a server's clients_file and reload the server: it gives this "
            "user the "
            "role view (or log, or control).\nThis user's programs show the certificate to every "
            "tls: "
            "server.",
        shared);
  return {};
}

/// Trusts a server's certificate, in place of whatever was trusted at this address.
Result<void> TrustServer(const TrustOptions& options, const Shared& shared) {
  const auto address = transport::ParseAddress(options.address);
  if (!address) return address.error();
  if (address->kind != transport::Address::Kind::kTls) {
    return UsageError(options.address + " has no certificate; write tls:HOST:PORT");
  }
  const auto fingerprint = tls::ParseFingerprint(options.fingerprint);
  if (!fingerprint) {
    return UsageError("\"" + options.fingerprint +
                      "\" is not a fingerprint; write what footing-ctl trust prints on the server, "
                      "sha256: and 64 hexadecimal digits");
  }
  const tls::KnownServers known(tls::KnownServersFile());
  const std::string server = transport::KnownName(*address);
  if (const auto added = known.Add(server, *fingerprint); !added) return added;
  Print({{"server", server}, {"fingerprint", *fingerprint}, {"file", known.path()}},
        "trusting tls:" + server + " with " + *fingerprint, shared);
  return {};
}

Result<void> RunTrust(const TrustOptions& options, const Shared& shared) {
  if (!shared.connect.empty()) {
    return UsageError("trust connects to no server; name the server as ADDRESS, without --connect");
  }
  if (options.client) return ShowClient(shared);
  if (options.address.empty()) return ShowServer(options, shared);
  return TrustServer(options, shared);
}

}  // namespace

void AddTrustCommand(CLI::App& app, Shared& shared) {
  const auto options = std::make_shared<TrustOptions>();
  CLI::App* command =
      app.add_subcommand("trust", "Print this server's certificate, or trust another server's");
  CLI::Option* const address =
      command->add_option("ADDRESS", options->address, "Server to trust, tls:HOST:PORT");
  CLI::Option* const fingerprint = command->add_option(
      "FINGERPRINT", options->fingerprint, "Fingerprint of its certificate, sha256:...");
  address->needs(fingerprint);
  CLI::Option* const identity =
      command
          ->add_option("--identity", options->identity,
                       "Identity file of a server (default: that of this user's servers, else of "
                       "the service)")
          ->excludes(address);
  command
      ->add_flag("--client", options->client,
                 "Print this user's own certificate, made if there is none, for a clients_file")
      ->excludes(address)
      ->excludes(identity);
  command->footer(
      "Examples:\n"
      "  footing-ctl trust                           # on the server: print its fingerprint\n"
      "  sudo footing-ctl trust --identity /var/lib/footing/identity.pem\n"
      "  footing-ctl trust tls:192.168.1.5:7450 sha256:...   # on the client: trust it\n"
      "  footing-ctl trust --client                  # on the client: print its own certificate");
  command->callback([options, &shared] {
    if (const auto done = RunTrust(*options, shared); !done) {
      shared.exit_code = cli::Report(done.error());
    }
  });
}

}  // namespace footing::ctl
