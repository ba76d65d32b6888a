#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

#include "clients/ctl/commands.h"
#include "clients/ctl/report/live_screen.h"
#include "common/base/units.h"
#include "common/cli/cli.h"
#include "common/net/address.h"
#include "common/net/client.h"
#include "common/net/known_servers.h"
#include "common/net/server.h"
#include "common/net/tls_context.h"
#include "common/qr/qr_code.h"
#include "common/runtime/clock.h"

namespace footing::ctl {
namespace {

using nlohmann::ordered_json;

struct SessionsOptions {
  std::string of = "footingd";
  std::vector<std::uint64_t> numbers;
  std::string reason;
};

std::string Origin(const v1::ConnectedSession& one) {
  return one.has_user() ? "user " + std::to_string(one.user()) : one.host();
}

/// By what it came in; a fingerprint with its first digits only.
std::string Granted(const v1::ConnectedSession& one) {
  constexpr std::size_t kShownBytes = 19;  // "sha256:" and 12 digits.
  if (one.certificate().empty()) return one.granted_by();
  return one.certificate().substr(0, kShownBytes) + "...";
}

/// By this host's clock: the server's may be set differently.
std::int64_t SinceNs(const v1::ConnectedSession& one) {
  return clock::WallNs() - SecondsToNanoseconds(one.stats().connected_s());
}

ordered_json ToJson(const v1::ConnectedSession& one) {
  const v1::SessionStats& stats = one.stats();
  return {{"session", stats.session()},
          {"client", stats.client_name()},
          {"role", stats.role()},
          {"local", stats.local()},
          {"user", one.has_user() ? ordered_json(one.user()) : ordered_json(nullptr)},
          {"host", one.host()},
          {"granted_by", one.granted_by()},
          {"certificate", one.certificate()},
          {"own", one.own()},
          {"since", display::Date(SinceNs(one))},
          {"connected_s", stats.connected_s()},
          {"policy", stats.policy()},
          {"queue_ticks", stats.queue_ticks()},
          {"queue_capacity", stats.queue_capacity()},
          {"ticks_sent", stats.ticks_sent()},
          {"ticks_dropped", stats.ticks_dropped()}};
}

std::string TableOf(const std::vector<v1::ConnectedSession>& sessions) {
  std::vector<std::vector<std::string>> rows = {
      {"session", "client", "role", "from", "granted by", "since", "queue", "dropped"}};
  for (const v1::ConnectedSession& one : sessions) {
    const v1::SessionStats& stats = one.stats();
    rows.push_back(
        {std::to_string(stats.session()) + (one.own() ? " (this one)" : ""), stats.client_name(),
         stats.role(), Origin(one), Granted(one), display::Date(SinceNs(one)),
         std::to_string(stats.queue_ticks()) + "/" + std::to_string(stats.queue_capacity()),
         std::to_string(stats.ticks_dropped())});
  }
  return display::Table(rows);
}

ordered_json ArrayOf(const std::vector<v1::ConnectedSession>& sessions) {
  ordered_json array = ordered_json::array();
  for (const v1::ConnectedSession& one : sessions) array.push_back(ToJson(one));
  return array;
}

Result<std::unique_ptr<Connection>> Connect(const SessionsOptions& options, v1::Role role,
                                            const Shared& shared) {
  ConnectionOptions dialled;
  dialled.channels = {"stats"};
  dialled.role = role;
  const bool simulation = options.of == "footing-sim" && shared.connect.empty();
  const auto address = simulation
                           ? Result<transport::Address>(transport::DefaultAddress("simulation"))
                           : transport::AddressOrDefault(shared.connect, "sensor");
  if (!address) return address.error();
  dialled.address = *address;
  return Connection::Open(std::move(dialled));
}

Result<void> List(const SessionsOptions& options, const Shared& shared) {
  const auto session = Connect(options, v1::ROLE_CONTROL, shared);
  if (!session) return session.error();
  std::vector<v1::ConnectedSession> sessions;
  for (bool more = true; more;) {
    v1::Command list;
    list.mutable_list_sessions()->set_after(sessions.empty() ? 0
                                                             : sessions.back().stats().session());
    const auto answer = (*session)->Call(std::move(list));
    if (!answer) return answer.error();
    sessions.insert(sessions.end(), answer->sessions().begin(), answer->sessions().end());
    more = answer->more_sessions() && answer->sessions_size() > 0;
  }
  std::string text = TableOf(sessions);
  text.pop_back();  // Print ends the line.
  Print({{"server", (*session)->welcome().server_id()}, {"sessions", ArrayOf(sessions)}}, text,
        shared);
  return {};
}

Result<void> End(const SessionsOptions& options, const Shared& shared) {
  const auto session = Connect(options, v1::ROLE_ADMIN, shared);
  if (!session) return session.error();
  v1::Command end;
  end.mutable_end_sessions()->mutable_sessions()->Add(options.numbers.begin(),
                                                      options.numbers.end());
  end.mutable_end_sessions()->set_reason(options.reason);
  const auto answer = (*session)->Call(std::move(end));
  if (!answer) return answer.error();
  const std::vector<v1::ConnectedSession> ended(answer->sessions().begin(),
                                                answer->sessions().end());
  std::set<std::uint64_t> missing(options.numbers.begin(), options.numbers.end());
  for (const v1::ConnectedSession& one : ended) missing.erase(one.stats().session());
  std::string text;
  for (const v1::ConnectedSession& one : ended) {
    text += (text.empty() ? "ended session " : "\nended session ") +
            std::to_string(one.stats().session()) + " (" + one.stats().client_name() + ", " +
            Origin(one) + ")";
  }
  if (shared.json || !ended.empty()) {
    Print({{"ended", ArrayOf(ended)}, {"missing", missing}}, text, shared);
  }
  if (missing.empty()) return {};
  std::string numbers;
  for (const std::uint64_t number : missing) numbers += " " + std::to_string(number);
  return Failure("no session" + numbers + "; list them with: footing-ctl sessions");
}

}  // namespace

void AddSessionsCommand(CLI::App& app, Shared& shared) {
  const auto options = std::make_shared<SessionsOptions>();
  const auto add_of = [options](CLI::App& command) {
    command.add_option("--of", options->of, "Server, at its default address")
        ->check(CLI::IsMember({"footingd", "footing-sim"}))
        ->capture_default_str();
  };
  CLI::App* command = app.add_subcommand(
      "sessions", "List a server's sessions, with where they come from; end some of them");
  add_of(*command);
  command->require_subcommand(0, 1);
  CLI::App* end = command->add_subcommand(
      "end", "End sessions by their numbers; for the server's own user and root");
  end->add_option("NUMBER", options->numbers, "Numbers of the sessions, as listed")->required();
  end->add_option("--reason", options->reason, "Text that their clients show");
  add_of(*end);
  const std::string examples =
      "Examples:\n"
      "  footing-ctl sessions\n"
      "  footing-ctl sessions --of footing-sim --json\n"
      "  sudo footing-ctl sessions end 7 12 --reason \"the lab closes\"";
  command->footer(examples +
                  "\nA client that was ended connects again. To keep it out, remove its "
                  "certificate from the clients_file\nor replace the token, then reload "
                  "the server: that ends its sessions, too.");
  end->footer(examples);
  command->callback([options, end, &shared] {
    const auto done = end->parsed() ? End(*options, shared) : List(*options, shared);
    if (!done) shared.exit_code = cli::Report(done.error());
  });
}

namespace {

struct MarkOptions {
  std::string of = "footingd";
  std::string text;
  std::optional<double> value;
};

Result<void> Mark(const MarkOptions& options, std::int64_t called_ns, const Shared& shared) {
  if (options.text.size() > transport::MarkerQueue::kMostBytes) {
    return UsageError("mark: the text has " + std::to_string(options.text.size()) +
                      " bytes; it may have at most " +
                      std::to_string(transport::MarkerQueue::kMostBytes));
  }
  SessionsOptions at;
  at.of = options.of;
  const auto session = Connect(at, v1::ROLE_LOG, shared);
  if (!session) return session.error();
  const std::int64_t host_ns = (*session)->OnServersClock(called_ns);
  v1::Command command;
  command.mutable_marker()->set_text(options.text);
  if (options.value) command.mutable_marker()->set_value(*options.value);
  command.mutable_marker()->set_host_ns(host_ns);
  if (const auto done = (*session)->Call(std::move(command)); !done) return done.error();
  const std::string server = (*session)->welcome().server_id();
  ordered_json out{{"server", server}, {"text", options.text}};
  if (options.value) out["value"] = *options.value;
  out["host_ns"] = host_ns;
  Print(out, "marked in " + server + ": " + options.text, shared);
  return {};
}

}  // namespace

void AddMarkCommand(CLI::App& app, Shared& shared) {
  const auto options = std::make_shared<MarkOptions>();
  CLI::App* command =
      app.add_subcommand("mark", "Mark this instant: an event in every recording of a server");
  command->add_option("TEXT", options->text, "Text of the marker, 1 to 1024 bytes")->required();
  command->add_option("--value", options->value, "Number that belongs to it, such as a trigger's");
  command->add_option("--of", options->of, "Server, at its default address")
      ->check(CLI::IsMember({"footingd", "footing-sim"}))
      ->capture_default_str();
  command->footer(
      "Examples:\n"
      "  footing-ctl mark \"stimulus on\" --value 3\n"
      "  footing-ctl mark \"begin p07-eyes-closed\"   # a trial, until the next line\n"
      "  footing-ctl mark \"end p07-eyes-closed\"\n"
      "The marker has the time at which the command was started.");
  command->callback([options, &shared] {
    if (const auto done = Mark(*options, clock::MonotonicNs(), shared); !done) {
      shared.exit_code = cli::Report(done.error());
    }
  });
}

namespace {

constexpr char kServiceState[] = "/var/lib/footing";  // As in systemd/footingd.service.
constexpr char kServiceIdentity[] = "/var/lib/footing/identity.pem";

struct TrustOptions {
  std::string address, fingerprint, identity;
  bool client = false;
};

std::string Drawn(const std::string& fingerprint) {
  return isatty(STDOUT_FILENO) == 1 ? "\n" + qr::QrCode(fingerprint) : "";
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
