#include <iostream>
#include <memory>

#include <nlohmann/json.hpp>

#include "clients/relay/channels.h"
#include "clients/relay/edge.h"
#include "clients/relay/login.h"
#include "clients/relay/options.h"
#include "clients/relay/publisher.h"
#include "common/base/json_text.h"
#include "common/cli/cli.h"
#include "common/net/address.h"

namespace footing::relay {
namespace {

struct PublishFlags {
  SiteFlags site;
  std::vector<std::string> servers, channels;
  std::string nats, nats_login, mqtt, mqtt_login, mqtt_ca;
  double mqtt_rate_hz = 20;
};

Result<MqttOptions> MqttOf(const PublishFlags& flags, const std::string& site) {
  MqttOptions options;
  options.client_id = "footing-relay-" + site;
  auto login = ReadLoginFile(flags.mqtt_login);
  if (!login) return login.error();
  options.login = std::move(login).value();
  options.ca_file = flags.mqtt_ca;
  if (!options.ca_file.empty()) {  // Encrypted, and by name: its certificate has one.
    const std::size_t colon = flags.mqtt.rfind(':');
    const auto address = transport::ParseAddress("tcp:" + flags.mqtt);
    if (!address) return UsageError("--mqtt: " + flags.mqtt + " is not HOST:PORT");
    options.host = flags.mqtt.substr(0, colon);
    options.port = address->port;
    return options;
  }
  const auto address = ParseBrokerAddress(flags.mqtt, "give the broker's --mqtt-ca");
  if (!address) return address.error();
  options.host = address->host;
  options.port = address->port;
  return options;
}

Result<PublisherOptions> PublisherOptionsOf(const PublishFlags& flags) {
  if (flags.nats.empty() && flags.mqtt.empty()) return UsageError("give --nats or --mqtt");
  PublisherOptions options;
  const auto site = flags.site.Site();
  if (!site) return site.error();
  options.site = *site;
  if (const auto known = CheckChannels(flags.channels); !known) return known.error();
  options.channels = flags.channels;
  options.mqtt_rate_hz = flags.mqtt_rate_hz;
  for (const std::string& text : flags.servers) {
    const auto address = transport::ParseAddress(text);
    if (!address) return address.error();
    options.servers.push_back(*address);
  }
  if (options.servers.empty()) options.servers.push_back(transport::DefaultAddress("sensor"));
  if (!flags.nats.empty()) {
    const auto nats = NatsOf(flags.nats, flags.nats_login);
    if (!nats) return nats.error();
    options.nats = *nats;
  }
  if (!flags.mqtt.empty()) {
    const auto mqtt = MqttOf(flags, *site);
    if (!mqtt) return mqtt.error();
    options.mqtt = *mqtt;
  }
  return options;
}

Result<PublisherReport> RunPublish(const PublishFlags& flags) {
  const auto options = PublisherOptionsOf(flags);
  if (!options) return options.error();
  boost::asio::io_context io(1);
  Publisher publisher(io, *options);
  const auto metrics =
      ServeMetrics(io, flags.site, [&] { return MetricsText(publisher.report(), cli::Version()); });
  if (!metrics) return metrics.error();
  if (const auto started = publisher.Start(); !started) return started.error();
  const RunEnd end =
      RunUntilStopped(io, flags.site.seconds, [&](const std::function<void()>& done) {
        publisher.Stop();
        done();
      });
  if (end == RunEnd::kTimeUp) {
    if (const auto useful = publisher.CheckUseful(); !useful) return useful.error();
  }
  return publisher.report();
}

}  // namespace

void AddPublishCommand(CLI::App& app, Shared& shared) {
  CLI::App* command =
      app.add_subcommand("publish", "Publish the ticks of servers in NATS, MQTT, or both");
  const auto flags = std::make_shared<PublishFlags>();
  command->add_option("--connect", flags->servers,
                      "Address of a server, unix:PATH, tcp:HOST:PORT or tls:HOST:PORT; may be "
                      "repeated (default: footingd's on this host)");
  command->add_option("--channel", flags->channels,
                      "Channel to publish; may be repeated (default: all)");
  command->add_option("--nats", flags->nats, "NATS server on this host, tcp:HOST:PORT");
  command->add_option("--nats-login", flags->nats_login,
                      "File (mode 0600) with a token, or with a user and a password on two lines");
  command->add_option("--mqtt", flags->mqtt,
                      "MQTT broker, HOST:PORT; on this host without --mqtt-ca");
  command->add_option("--mqtt-login", flags->mqtt_login, "The same file for the MQTT broker");
  command->add_option("--mqtt-ca", flags->mqtt_ca,
                      "Certificate that has signed the broker's, PEM; turns TLS on");
  command
      ->add_option("--mqtt-rate-hz", flags->mqtt_rate_hz,
                   "Highest rate of samples and poses in MQTT, Hz (0: every tick)")
      ->check(CLI::Range(0.0, 1000.0));
  flags->site.Add(*command);
  command->callback([flags, &shared] {
    const auto report = RunPublish(*flags);
    if (!report) {
      shared.exit_code = cli::Report(report.error());
      return;
    }
    const nlohmann::ordered_json json = {{"ticks", report->ticks},
                                         {"missing", report->missing},
                                         {"published", report->published},
                                         {"dropped", report->dropped}};
    if (shared.json) std::cout << text::ToText(json) << std::endl;
  });
}

namespace {

struct ServeFlags {
  SiteFlags site;
  std::string nats, nats_login, server = "footingd";
  std::vector<std::string> listen;
  double rate_hz = 30;
  std::int64_t max_sessions = 6000;
  transport::AccessSettings access;
};

/// Refuses at once what the listener would refuse when the server's ticks come.
Result<void> CheckSafe(const transport::Address& address, const transport::AccessSettings& access) {
  const transport::ListenSettings settings{"give --token-file or --clients-file",
                                           "--insecure-lan with a --token-file"};
  const bool has_keys = !access.token_file.empty() || !access.clients_file.empty();
  if (address.kind == transport::Address::Kind::kTls) return CheckKeys(address, has_keys, settings);
  return CheckEncrypted(address, access.insecure_lan, settings);
}

Result<EdgeOptions> EdgeOptionsOf(const ServeFlags& flags) {
  EdgeOptions options;
  const auto site = flags.site.Site();
  if (!site) return site.error();
  options.site = *site;
  if (!nats::IsPart(flags.server)) {
    return UsageError("--server: \"" + flags.server +
                      "\" must be the name of a server, such as "
                      "footingd or footing-sim");
  }
  options.server = flags.server;
  const auto nats = NatsOf(flags.nats, flags.nats_login);
  if (!nats) return nats.error();
  options.nats = *nats;
  for (const std::string& text : flags.listen) {
    const auto address = transport::ParseAddress(text);
    if (!address) return address.error();
    if (const auto safe = CheckSafe(*address, flags.access); !safe) return safe.error();
    options.listen.push_back(*address);
  }
  options.rate_hz = flags.rate_hz;
  options.sessions.max_sessions = flags.max_sessions;
  options.sessions.max_sessions_per_user = flags.max_sessions;
  // Many viewers come from one address, and nobody controls a relay.
  options.sessions.max_sessions_per_host = flags.max_sessions;
  options.sessions.max_sessions_per_certificate = flags.max_sessions;
  options.sessions.control_places = 0;
  options.access = flags.access;
  if (const auto checked = options.access.Check(); !checked) {
    return UsageError("--insecure-lan needs a --token-file");
  }
  return options;
}

Result<EdgeReport> RunServe(const ServeFlags& flags) {
  const auto options = EdgeOptionsOf(flags);
  if (!options) return options.error();
  boost::asio::io_context io(1);
  std::optional<Error> broken;
  Edge edge(io, *options, [&](const Error& error) {
    broken = error;
    io.stop();
  });
  const auto metrics =
      ServeMetrics(io, flags.site, [&] { return MetricsText(edge.report(), cli::Version()); });
  if (!metrics) return metrics.error();
  edge.Start();
  bool was_up = false;
  const RunEnd end = RunUntilStopped(io, flags.site.seconds, [&](std::function<void()> done) {
    was_up = edge.report().nats_up;
    edge.Drain("footing-relay is being stopped", std::move(done));
  });
  edge.Stop();
  if (broken) return *broken;
  if (end == RunEnd::kTimeUp && edge.report().ticks == 0) {
    const std::string why = "nothing came to serve: " + edge.state();
    return was_up ? NoDevice(why) : Failure(why);
  }
  return edge.report();
}

void AddAccess(CLI::App& command, transport::AccessSettings& access) {
  command.add_option("--token-file", access.token_file,
                     "File (mode 0600) with the token of viewers over TLS");
  command.add_option("--clients-file", access.clients_file,
                     "File with the certificates of viewers, lines \"sha256:... ROLE NAME\"");
  command.add_option(
      "--identity-file", access.identity_file,
      "File with this relay's key and certificate for tls: (default: as footingd's)");
  command.add_flag("--insecure-lan", access.insecure_lan,
                   "Listen on tcp: beyond this host WITHOUT ENCRYPTION; needs --token-file");
}

}  // namespace

void AddServeCommand(CLI::App& app, Shared& shared) {
  CLI::App* command = app.add_subcommand(
      "serve", "Serve viewers what another footing-relay publishes in NATS, in the server's place");
  const auto flags = std::make_shared<ServeFlags>();
  command->add_option("--nats", flags->nats, "NATS server on this host, tcp:HOST:PORT")->required();
  command->add_option("--nats-login", flags->nats_login,
                      "File (mode 0600) with a token, or with a user and a password on two lines");
  command->add_option("--server", flags->server, "Server to serve: footingd or footing-sim");
  command
      ->add_option(
          "--listen", flags->listen,
          "Address to listen on, unix:PATH, tcp:HOST:PORT or tls:HOST:PORT; may be repeated")
      ->required();
  command
      ->add_option("--rate-hz", flags->rate_hz,
                   "Highest rate of samples and poses, Hz (0: every tick)")
      ->check(CLI::Range(0.0, 1000.0));
  command->add_option("--max-sessions", flags->max_sessions, "Maximum number of viewers")
      ->check(CLI::Range(1, 100'000));
  AddAccess(*command, flags->access);
  flags->site.Add(*command);
  command->callback([flags, &shared] {
    const auto report = RunServe(*flags);
    if (!report) {
      shared.exit_code = cli::Report(report.error());
      return;
    }
    const nlohmann::ordered_json json = {{"ticks", report->ticks},
                                         {"missing", report->missing},
                                         {"left_out", report->left_out},
                                         {"dropped", report->dropped},
                                         {"accepted", report->accepted}};
    if (shared.json) std::cout << text::ToText(json) << std::endl;
  });
}

}  // namespace footing::relay
