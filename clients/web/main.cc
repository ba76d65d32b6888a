#include <cstdint>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <boost/asio/io_context.hpp>
#include <nlohmann/json.hpp>

#include "clients/web/web_server.h"
#include "common/base/json_text.h"
#include "common/cli/cli.h"
#include "common/net/access.h"
#include "common/qr/qr_code.h"
#include "common/runtime/log.h"
#include "common/runtime/service_manager.h"
#include "common/runtime/timer.h"

namespace footing::web {
namespace {

struct ServeFlags {
  std::vector<std::string> listen, connect, host_names, origins;
  std::string devices, survey, token_file, identity_file, pose_package;
  std::uint16_t skeleton_port = WebOptions().skeleton_port;
  double seconds = 0;
  bool foxglove = false, invite = false, phones = false, webcam = false, study = false,
       json = false;

  Result<WebOptions> Options() const {
    WebOptions options;
    for (const std::string& text :
         listen.empty() ? std::vector<std::string>{"tcp:127.0.0.1:7480"} : listen) {
      const auto address = transport::ParseAddress(text);
      if (!address) return address.error();
      options.listen.push_back(*address);
    }
    for (const std::string& text : connect) {
      const auto address = transport::ParseAddress(text);
      if (!address) return address.error();
      options.servers.push_back(*address);
    }
    if (connect.empty()) {
      options.servers = {transport::DefaultAddress("simulation"),
                         transport::DefaultAddress("sensor")};
    }
    const auto to = transport::AddressOrDefault(devices, "devices");
    if (!to) return to.error();
    if (to->kind != transport::Address::Kind::kUnix) {
      return UsageError("--devices " + devices + ": must be footingd's unix:PATH on this host");
    }
    options.devices = *to;
    const auto asked = transport::AddressOrDefault(survey, "survey");
    if (!asked) return asked.error();
    options.survey = *asked;
    options.skeleton_port = skeleton_port;
    options.pose_package = pose_package;
    if (!token_file.empty()) {
      const auto token = transport::ReadTokenFile(token_file);
      if (!token) return token.error();
      options.token = *token;
    }
    options.host_names = host_names;
    options.foxglove = foxglove;
    options.origins = origins;
    options.identity_file = identity_file;
    return options;
  }
};

/// Prints the addresses for people: a code is for one browser, so the next one is shown when it is
/// used.
class Doorkeeper {
 public:
  Doorkeeper(boost::asio::io_context& io, WebServer& server, const ServeFlags& flags)
      : timer_(io), server_(server), flags_(flags) {}

  void Greet() {
    if (flags_.json) return;
    for (const transport::Address& address : server_.addresses()) {
      std::cout << "serving " << address.Text() << "\n";
    }
    if (const std::string fingerprint = server_.fingerprint(); !fingerprint.empty()) {
      std::cout << "certificate " << fingerprint
                << "\nThe browser warns of it once, because no authority has signed it: compare, "
                   "then proceed.\n";
    }
    Show();
  }

 private:
  void Show() {
    const bool some = flags_.phones || flags_.webcam || flags_.study;
    if (flags_.invite || !some) Print("Live page", "/");
    if (flags_.study) {
      Print("The participant's screen", "/participant");
      if (!flags_.invite) Print("The experimenter's screen", "/");
    }
    if (flags_.phones) Print("A phone as a controller", "/phone");
    if (flags_.webcam) Print("A webcam", "/webcam");
    if (flags_.invite || some) Wait();
  }

  void Print(const std::string& title, std::string_view page) {
    const std::string address = server_.Invite(page);
    std::cout << title << ": " << address << "\n" << qr::QrCode(address) << std::flush;
  }

  void Wait() {
    timer_.After(0.25, [this] {
      const bool used = server_.counts().codes_used > used_;
      used_ = server_.counts().codes_used;
      if (!used) return Wait();
      std::cout << "A browser has entered; the next one needs a new code.\n";
      Show();
    });
  }

  timer::Timer timer_;
  WebServer& server_;
  const ServeFlags& flags_;
  std::uint64_t used_ = 0;
};

int Serve(const ServeFlags& flags) {
  auto options = flags.Options();
  if (!options) return cli::Report(options.error());
  boost::asio::io_context io(1);
  auto server = WebServer::Open(io, std::move(options).value());
  if (!server) return cli::Report(server.error());
  if (flags.json) {
    nlohmann::ordered_json listening = nlohmann::ordered_json::array();
    for (const auto& address : (*server)->addresses()) listening.push_back(address.Text());
    std::cout << nlohmann::ordered_json{{"listening_on", listening},
                                        {"page", (*server)->Invite("/")},
                                        {"phone", (*server)->Invite("/phone")},
                                        {"webcam", (*server)->Invite("/webcam")},
                                        {"participant", (*server)->Invite("/participant")}}
              << std::endl;
  }
  Doorkeeper doorkeeper(io, **server, flags);
  doorkeeper.Greet();
  service_manager::ProgramEnd end(io, [&io] { io.stop(); });
  end.After(flags.seconds, [&io] { io.stop(); });
  io.run();
  return 0;
}

/// Adds the options; the result serves until the program is stopped, and returns its exit code.
std::function<int()> AddServe(CLI::App& app) {
  const auto flags = std::make_shared<ServeFlags>();
  app.add_option(
      "--listen", flags->listen,
      "Address for browsers, tcp:127.0.0.1:PORT, or tls:HOST:PORT for other devices; may "
      "be repeated (default: tcp:127.0.0.1:7480)");
  app.add_option(
      "--connect", flags->connect,
      "Address of footingd or footing-sim; may be repeated (default: both of this host)");
  app.add_option("--devices", flags->devices,
                 "Device socket of footingd, for phones, unix:PATH (default: that of this host)");
  app.add_option(
      "--token-file", flags->token_file,
      "File (mode 0600) whose token gives a page the role control (default: pages view)");
  app.add_option("--identity-file", flags->identity_file,
                 "File with the key and certificate for tls: (default: as footingd's)");
  app.add_option("--host-name", flags->host_names,
                 "Name by which browsers may call this host, besides its numeric addresses; may be "
                 "repeated");
  app.add_flag("--foxglove", flags->foxglove,
               "Serve the scene to Foxglove and Lichtblick, too: ws://127.0.0.1:PORT");
  app.add_option("--origin", flags->origins,
                 "Origin of a page of others that may read by --foxglove, such as "
                 "https://app.foxglove.dev; may be repeated");
  app.add_flag("--invite", flags->invite, "Show a QR code of the live page for each browser");
  app.add_flag("--phones", flags->phones, "Show a QR code for each phone that is a controller");
  app.add_flag("--study", flags->study,
               "Show QR codes of the participant's and the experimenter's screens of a study");
  app.add_option("--survey", flags->survey,
                 "Address of footing-study run --survey (default: that of this user)");
  app.add_flag("--webcam", flags->webcam,
               "Show a QR code of the page that tracks a person with a webcam");
  app.add_option("--skeleton-port", flags->skeleton_port,
                 "UDP port of footing-skeleton on this host, which takes a webcam's joints");
  flags->pose_package = DefaultPosePackage();
  app.add_option("--pose-package", flags->pose_package,
                 "Folder of npm's @mediapipe/pose, for webcams (scripts/fetch-pose-model)");
  app.add_option("--seconds", flags->seconds, "Duration, s (0: until SIGINT or SIGTERM)")
      ->check(CLI::Range(0.0, 1e9));
  app.add_flag("--json", flags->json, "Print the addresses as one JSON object");
  return [flags] { return Serve(*flags); };
}

}  // namespace
}  // namespace footing::web

int main(int argc, char** argv) {
  auto app = footing::cli::NewApp(
      "footing-web",
      "Shows footing-sim and footingd in a browser, without anything to install there, and takes "
      "phones as controllers.",
      "  footing-web                                   # http://127.0.0.1:7480/ on this host\n"
      "  footing-web --listen tls:192.168.1.5:7480 --invite    # a QR code for other devices\n"
      "  footing-web --listen tls:192.168.1.5:7480 --phones    # a QR code for each phone\n"
      "  footing-web --listen tls:192.168.1.5:7480 --study     # screens for a user study\n"
      "  footing-skeleton & footing-web                # http://127.0.0.1:7480/webcam: a webcam\n"
      "  footing-web --foxglove                        # in Foxglove open ws://127.0.0.1:7480\n"
      "  footing-web --connect unix:/run/footing/simulation.sock --json");
  const auto serve = footing::web::AddServe(*app);
  app->parse_complete_callback([] { footing::log::Start("footing-web", false); });
  if (const auto code = footing::cli::Parse(*app, argc, argv)) return *code;
  return serve();
}
