#include "clients/view/app/off_screen_view.h"
#include "clients/view/app/options.h"
#include "clients/view/app/subjects.h"
#include "clients/view/app/text_view.h"
#include "clients/view/app/window.h"
#include "common/cli/cli.h"
#include "common/log/log.h"

namespace {

using footing::view::Options;

footing::Result<void> Resolve(const std::vector<std::string>& connect, const std::string& recording,
                              Options& options) {
  namespace transport = footing::transport;
  if (!recording.empty()) {
    auto session = footing::recording::RecordedSession::Open(recording);
    if (!session) return session.error();
    if (session->Find("footing-sim") == nullptr && session->Find("footingd") == nullptr) {
      return footing::InvalidData(recording + " holds no ticks of footing-sim or footingd");
    }
    options.recording =
        std::make_shared<footing::recording::RecordedSession>(std::move(session).value());
    return {};
  }
  for (const std::string& text : connect) {
    auto address = transport::ParseAddress(text);
    if (!address) return address.error();
    options.addresses.push_back(*address);
  }
  if (connect.empty()) {
    options.addresses = {transport::DefaultAddress("simulation"),
                         transport::DefaultAddress("sensor")};
  }
  return {};
}

footing::Result<void> Run(const Options& options) {
  if (options.off_screen()) return RunOffScreen(options);
  if (options.text) return RunTextView(options);
  if (footing::view::HasDisplay()) return RunWindow(options);
  footing::log::Info("no display: showing the state as text (--screenshot draws without one)");
  return RunTextView(options);
}

}  // namespace

int main(int argc, char** argv) {
  auto app = footing::cli::NewApp("footing-view",
                                  "Shows the bird and its track, or the reconstructed body, live.",
                                  "  footing-view\n"
                                  "  footing-view --connect tcp:127.0.0.1:4711 --subject\n"
                                  "  footing-view --recording walk.mcap\n"
                                  "  footing-view --screenshot bird.png --at 5\n"
                                  "  footing-view --next-subject p08.json --next-subject p09.json\n"
                                  "  footing-view --text --seconds 30 --json");
  Options options;
  std::vector<std::string> connect, subjects;
  std::string recording;
  app->add_option("--connect", connect,
                  "unix:PATH or tcp:HOST:PORT, as often as wanted; default "
                  "are this user's simulation and sensor servers");
  app->add_option("--recording", recording, "Recording to play in place of servers, MCAP file")
      ->excludes("--connect");
  app->add_option("--screenshot", options.screenshot, "Draw one picture to this PNG and end");
  app->add_option("--at", options.at_s, "Seconds after connecting (screenshot)")
      ->check(CLI::Range(0.0, 86400.0));
  app->add_option("--record", options.record_folder, "Draw numbered PNGs into this folder");
  app->add_option("--record-hz", options.record_hz, "Pictures a second (record)")
      ->check(CLI::Range(0.1, 60.0));
  app->add_option("--seconds", options.seconds, "End by itself")->check(CLI::Range(0.0, 1e6));
  app->add_option("--msaa", options.samples, "Smooth edges with 2, 4 or 8 samples a pixel")
      ->check(CLI::IsMember({0, 2, 4, 8}));
  app->add_option("--width", options.width, "Pixels")->check(CLI::Range(320, 8192));
  app->add_option("--height", options.height, "Pixels")->check(CLI::Range(180, 8192));
  app->add_flag("--subject", options.subject, "The world alone, without panels");
  app->add_flag("--overlay-reference", options.overlay_reference,
                "Show a simulated body's true pose over the estimate, not beside it");
  app->add_option("--next-subject", subjects,
                  "Subject file (JSON) for the key N; as often as wanted");
  app->add_flag("--forces", options.forces, "Force arrows at the feet");
  app->add_flag("--replay-falls", options.replay_falls,
                "Show every fall's last 5 s again in slow motion");
  app->add_flag("--text", options.text, "Show the state in the terminal");
  app->add_flag("--json", options.json, "At the end one JSON object on standard output");
  if (const auto code = footing::cli::Parse(*app, argc, argv)) return *code;

  footing::log::Start("footing-view", false);
  if (const auto resolved = Resolve(connect, recording, options); !resolved) {
    return footing::cli::Report(resolved.error());
  }
  auto commands = footing::view::SubjectCommands(subjects);
  if (!commands) return footing::cli::Report(commands.error());
  options.next_subjects = std::move(commands).value();
  const auto done = Run(options);
  return done ? 0 : footing::cli::Report(done.error());
}
