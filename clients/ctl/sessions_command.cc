#include <algorithm>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "clients/ctl/commands.h"
#include "clients/ctl/report/format.h"
#include "common/cli/cli.h"
#include "common/runtime/clock.h"
#include "common/net/address_or_default.h"
#include "common/base/units.h"

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

Result<std::unique_ptr<Session>> Connect(const SessionsOptions& options, v1::Role role,
                                         const Shared& shared) {
  SessionOptions dialled;
  dialled.channels = {"stats"};
  dialled.role = role;
  const bool simulation = options.of == "footing-sim" && shared.connect.empty();
  const auto address = simulation
                           ? Result<transport::Address>(transport::DefaultAddress("simulation"))
                           : transport::AddressOrDefault(shared.connect, "sensor");
  if (!address) return address.error();
  dialled.address = *address;
  return Session::Open(std::move(dialled));
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

}  // namespace footing::ctl
