#include <unistd.h>

#include <memory>
#include <string>

#include "clients/ctl/commands.h"
#include "clients/ctl/display/qr_code.h"
#include "common/cli/cli.h"
#include "common/tls/fingerprint.h"
#include "common/tls/identity.h"
#include "common/tls/known_servers.h"
#include "common/tls/places.h"
#include "common/transport/address.h"
#include "common/transport/server_trust.h"

namespace footing::ctl {
namespace {

struct TrustOptions {
  std::string address, fingerprint, identity;
  bool client = false;
};

std::string Drawn(const std::string& fingerprint) {
  return isatty(STDOUT_FILENO) == 1 ? "\n" + display::QrCode(fingerprint) : "";
}

/// The certificate of the servers that this user runs.
Result<void> ShowServer(const TrustOptions& options, const Shared& shared) {
  const bool named = !options.identity.empty();
  const std::string file = named ? options.identity : tls::DefaultIdentityFile();
  const auto identity = tls::Identity::LoadOrMake(file, "Footing");
  if (!identity) return identity.error();
  Print({{"fingerprint", identity->fingerprint()}, {"file", file}},
        identity->fingerprint() + "\n\nThis is the certificate of servers that have " + file +
            ".\nOn the viewer's machine compare it with what the first connection prints, or "
            "enter it before:\n  footing-ctl trust tls:HOST:PORT " +
            identity->fingerprint() + Drawn(identity->fingerprint()),
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
            "\n\nThis line in a server's clients_file lets this user in (view, log or control).\n"
            "The certificate is shown to every tls: server that asks for one.",
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
  if (options.client) return ShowClient(shared);
  if (options.address.empty()) return ShowServer(options, shared);
  return TrustServer(options, shared);
}

}  // namespace

void AddTrustCommand(CLI::App& app, Shared& shared) {
  const auto options = std::make_shared<TrustOptions>();
  CLI::App* command =
      app.add_subcommand("trust", "Certificates of tls: addresses: print, or trust one");
  CLI::Option* const address =
      command->add_option("ADDRESS", options->address, "Server to trust, tls:HOST:PORT");
  CLI::Option* const fingerprint = command->add_option(
      "FINGERPRINT", options->fingerprint, "Fingerprint of its certificate, sha256:...");
  address->needs(fingerprint);
  command
      ->add_option("--identity", options->identity,
                   "Identity file of the server (default: that of this user's servers)")
      ->excludes(address);
  command
      ->add_flag("--client", options->client,
                 "Print this user's own certificate, made where there is none, for a clients_file")
      ->excludes(address);
  command->footer(
      "Examples:\n"
      "  footing-ctl trust                           # on the server: its fingerprint\n"
      "  sudo footing-ctl trust --identity /var/lib/footing/identity.pem\n"
      "  footing-ctl trust tls:192.168.1.5:7450 sha256:...   # on the viewer's machine\n"
      "  footing-ctl trust --client                  # a viewer's certificate");
  command->callback([options, &shared] {
    if (const auto done = RunTrust(*options, shared); !done) {
      shared.exit_code = cli::Report(done.error());
    }
  });
}

}  // namespace footing::ctl
