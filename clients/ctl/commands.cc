#include "clients/ctl/commands.h"

#include <iostream>
#include <utility>

#include "common/cli/cli.h"
#include "common/base/json_text.h"
#include "common/net/address_or_default.h"
#include "common/net/run_folder.h"

namespace footing::ctl {

Result<std::unique_ptr<Session>> Open(const Shared& shared, std::vector<std::string> channels) {
  SessionOptions options;
  options.channels = std::move(channels);
  const auto address = transport::AddressOrDefault(shared.connect, "sensor");
  if (!address) return address.error();
  options.address = *address;
  return Session::Open(std::move(options));
}

void Print(const nlohmann::ordered_json& out, const std::string& text, const Shared& shared) {
  using nlohmann::ordered_json;
  std::cout << (shared.json ? text::ToText(out) : text) << std::endl;
}

void AddRemark(const v1::CommandResult& result, nlohmann::ordered_json& out, std::string& text) {
  if (result.message().empty()) return;
  out["message"] = result.message();
  text += "; " + result.message();
}

void WithSession(Shared& shared, const std::vector<std::string>& channels,
                 const std::function<Result<void>(Session&)>& body) {
  const auto session = Open(shared, channels);
  if (!session) {
    shared.exit_code = cli::Report(session.error());
    return;
  }
  if (const Result<void> done = body(**session); !done) {
    shared.exit_code = cli::Report(done.error());
  }
}

Result<std::unique_ptr<Session>> OpenSimulation(const Shared& shared,
                                                std::vector<std::string> channels,
                                                const std::string& start_with) {
  Shared simulation = shared;
  if (simulation.connect.empty()) {
    simulation.connect = transport::DefaultAddress("simulation").Text();
  }
  auto session = Open(simulation, std::move(channels));
  if (!session && session.error().kind != ErrorKind::kNoDevice) return session.error();
  if (!session) {
    // Its own remedy is about footingd.
    const std::string& message = session.error().message;
    const std::string why = message.substr(0, message.find("; "));
    const std::string start = "start it with: " + start_with + ", or name it with --connect";
    return NoDevice("no footing-sim on " + simulation.connect + transport::RemedyFor(why, start));
  }
  return session;
}

Result<void> SendToSimulation(const Shared& shared, v1::Command command,
                              const std::string& start_with) {
  // The skeletons are published to whoever comes.
  const auto session = OpenSimulation(shared, {"skeletons"}, start_with);
  if (!session) return session.error();
  if (const auto done = (*session)->Call(std::move(command)); !done) return done.error();
  return {};
}

}  // namespace footing::ctl
