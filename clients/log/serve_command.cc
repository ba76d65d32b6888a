#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <csignal>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "clients/log/commands.h"
#include "common/cli/cli.h"
#include "common/recording/recording_server.h"
#include "common/net/address.h"

namespace footing::log_client {
namespace {

struct ServeOptions {
  std::string file;
  std::string server;
  std::vector<std::string> addresses;
};

/// The server whose place is taken: the one asked for, else footingd, else the only one.
Result<std::string> ChooseServer(const recording::RecordedSession& session,
                                 const std::string& wanted) {
  std::string names;
  std::string first;
  for (const recording::RecordedServer& server : session.servers()) {
    if (server.ticks.empty()) continue;
    if (server.name == wanted || (wanted.empty() && server.name == "footingd")) return server.name;
    if (first.empty()) first = server.name;
    names += (names.empty() ? "" : ", ") + server.name;
  }
  if (first.empty()) return InvalidData(session.path() + " holds no ticks of a server");
  if (wanted.empty()) return first;
  return UsageError(session.path() + " has no messages of " + wanted + "; there are: " + names);
}

Result<nlohmann::ordered_json> RunServe(const ServeOptions& options) {
  const auto session = recording::RecordedSession::Open(options.file);
  if (!session) return session.error();
  const auto name = ChooseServer(*session, options.server);
  if (!name) return name.error();
  boost::asio::io_context io(1);
  playback::RecordingServer server(io, *session, *name, cli::Version());
  std::vector<transport::Address> addresses;
  for (const std::string& text : options.addresses) {
    const auto address = transport::ParseAddress(text);
    if (!address) return address.error();
    addresses.push_back(*address);
  }
  if (addresses.empty()) {
    const bool simulation = name->starts_with("footing-sim");
    addresses.push_back(transport::DefaultAddress(simulation ? "simulation" : "sensor", true));
  }
  for (std::size_t i = 0; i < addresses.size(); ++i) {
    if (const auto listening = server.Listen(addresses[i]); !listening) return listening.error();
    std::cerr << "serving " << *name << " of " << options.file << ", " << server.duration_s()
              << " s, on " << server.ListeningOn(i).Text() << " once a client connects"
              << std::endl;
  }
  boost::asio::signal_set signals(io, SIGINT, SIGTERM);
  Result<void> ended;
  bool complete = false;
  const auto end = [&](const std::string& reason) {
    server.Stop(reason);
    signals.cancel();
  };
  signals.async_wait([&](const boost::system::error_code& error, int) {
    if (!error) end("footing-log is being stopped");
  });
  server.Start([&](const Result<void>& result) {
    ended = result;
    complete = result.ok();
    end(result ? "the recording has ended" : result.error().message);
  });
  io.run();
  if (!ended) return InvalidData(options.file + ": " + ended.error().message);
  return nlohmann::ordered_json{{"file", options.file},
                                {"server", *name},
                                {"ticks", server.published()},
                                {"duration_s", server.duration_s()},
                                {"complete", complete}};
}

}  // namespace

void AddServeCommand(CLI::App& app, Shared& shared) {
  CLI::App* command = app.add_subcommand(
      "serve", "Serve a recording in place of the recorded server, at its recorded times");
  const auto options = std::make_shared<ServeOptions>();
  command->add_option("FILE", options->file, "Recording, MCAP file")->required();
  command->add_option("--listen", options->addresses,
                      "Address to listen on, unix:PATH or tcp:HOST:PORT; may be repeated (default: "
                      "that of the server)");
  command->add_option("--server", options->server,
                      "Server of the recording: footingd or footing-sim (default: footingd)");
  command->callback([options, &shared] { Finish(RunServe(*options), shared); });
}

}  // namespace footing::log_client
