#include <algorithm>

#include "clients/view/app/options.h"
#include "clients/view/app/pictures.h"
#include "clients/view/app/play_session.h"
#include "clients/view/app/window.h"
#include "common/base/units.h"
#include "common/cli/cli.h"
#include "common/net/address.h"
#include "common/runtime/log.h"

namespace {

using footing::view::Options;

/// Arguments of playback alone, as written.
struct PlayArguments {
  std::string align = "start";
  std::optional<double> from_s;
};

/// Where the preview of footing-camera comes from.
footing::Result<void> TakeCamera(const std::string& text, Options& options) {
  namespace transport = footing::transport;
  const auto address = transport::AddressOrDefault(text, "camera");
  if (!address) return address.error();
  if (address->kind != transport::Address::Kind::kUnix)
    return footing::UsageError("--camera-address " + text +
                               ": the preview is for the camera's own host alone; use unix:PATH");
  options.camera.address = *address;
  options.camera.corner = options.camera.corner || !options.camera.calibration_file.empty();
  return {};
}

void AddCameraOptions(CLI::App& app, Options& options, std::string& address) {
  app.add_flag("--camera", options.camera.corner,
               "Show the preview of footing-camera in a corner (key V)")
      ->excludes("--recording");
  app.add_flag("--camera-preview", options.camera.alone,
               "Show the preview of footing-camera and nothing else")
      ->excludes("--recording")
      ->excludes("--connect");
  app.add_option("--calibrate-camera", options.camera.calibration_file,
                 "Camera file of the running footing-camera: its pose is measured on the boards, "
                 "guided, and stored there")
      ->excludes("--recording")
      ->excludes("--camera-preview");
  app.add_option("--camera-address", address,
                 "Address of the preview, unix:PATH (default: camera.sock beside footingd's "
                 "sockets)");
}

footing::Result<void> Resolve(const std::vector<std::string>& connect, const std::string& camera,
                              const PlayArguments& arguments, Options& options) {
  namespace transport = footing::transport;
  if (auto taken = TakeCamera(camera, options); !taken) return taken;
  if (!options.screenshot.empty()) {
    if (auto checked = footing::view::CheckPictureName(options.screenshot); !checked)
      return checked;
  } else if (!options.record.empty()) {
    if (auto checked = footing::view::CheckRecordName(options.record); !checked) return checked;
  }
  if (!options.play.recording.empty()) {
    const auto alignment = footing::view::AlignmentNamed(arguments.align);
    if (!alignment) return alignment.error();
    options.play.alignment = *alignment;
    options.play.from_s = options.at_s ? options.at_s : arguments.from_s;
    return {};
  }
  if (options.at_s && *options.at_s < 0)
    return footing::UsageError("--at: a live view has no past");
  for (const std::string& text : connect) {
    auto address = transport::ParseAddress(text);
    if (!address) return address.error();
    options.addresses.push_back(*address);
  }
  if (connect.empty() && !options.camera.alone) {
    options.addresses = {transport::DefaultAddress("simulation"),
                         transport::DefaultAddress("sensor")};
  }
  return {};
}

footing::Result<void> Run(const Options& options) {
  if (!options.play.recording.empty()) return RunPlayback(options);
  if (options.off_screen()) return RunOffScreen(options);
  if (!options.camera.calibration_file.empty() && (options.text || !footing::view::HasDisplay()))
    return footing::UsageError(
        "--calibrate-camera needs a window; in a terminal use footing-ctl setup --only camera "
        "--camera " +
        options.camera.calibration_file);
  if (options.text) return RunTextView(options);
  if (footing::view::HasDisplay()) return RunWindow(options, std::nullopt);
  footing::log::Info("no display: showing the state as text (--screenshot draws without one)");
  return RunTextView(options);
}

void AddPlayOptions(CLI::App& app, Options& options, PlayArguments& arguments) {
  CLI::Option* const recording = app.add_option(
      "--recording", options.play.recording, "Recording to play instead of connecting, MCAP file");
  recording->excludes("--connect");
  app.add_option("--trial", options.play.trial,
                 "Play this trial only: its id, or #NUMBER; 0 s is its start line")
      ->needs(recording);
  app.add_option("--beside", options.play.beside,
                 "Second recording beside the first, FILE or FILE:TRIAL (default: first trials)")
      ->needs(recording);
  app.add_option("--align", arguments.align,
                 "What is at 0 s of both: start, finish or wall (time of day)")
      ->needs("--beside");
  app.add_flag("--no-timeline{false}", options.look.timeline,
               "Play without the timeline under the picture (key L)")
      ->needs(recording);
  app.add_option("--speed", options.play.speed, "Speed of playback, 0.1 to 8 (default 1)")
      ->needs(recording)
      ->check(CLI::Range(0.1, 8.0));
  app.add_option("--from", arguments.from_s, "Position to begin at, s (default: the beginning)")
      ->needs(recording);
}

/// The panels of --panels, by their names.
void ChoosePanels(const std::vector<std::string>& names, footing::render::PanelChoice& panels) {
  const auto named = [&](const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  panels = {named("character"), named("strips"), named("devices"), named("interface"),
            named("boards")};
}

void AddPictureOptions(CLI::App& app, Options& options) {
  app.add_option("--screenshot", options.screenshot,
                 "File to draw one picture into, PNG or JPEG; then end");
  app.add_option("--at", options.at_s,
                 "Time of the screenshot: after connecting, or position in the recording, s "
                 "(default 1)")
      ->check(CLI::Range(-86400.0, 1e6));
  app.add_option(
      "--record", options.record,
      "Folder to draw numbered PNG files into, or a film: NAME.mp4, .webm or .gif (by ffmpeg or "
      "GStreamer; without either a folder NAME)");
  app.add_option("--record-hz", options.record_hz, "Rate of the pictures of --record, Hz")
      ->check(CLI::Range(0.1, 60.0));
  app.add_option("--seconds", options.seconds, "Duration, s (0: until the window is closed)")
      ->check(CLI::Range(0.0, 1e6));
  app.add_option("--msaa", options.samples,
                 "Samples per pixel for smooth edges: 0, 2, 4 or 8 (default: 4; in a "
                 "window 0 where no graphics processor draws it)")
      ->check(CLI::IsMember({0, 2, 4, 8}));
  app.add_option("--width", options.width, "Width of the window or picture, pixels")
      ->check(CLI::Range(320, 8192));
  app.add_option("--height", options.height, "Height of the window or picture, pixels")
      ->check(CLI::Range(180, 8192));
  app.add_option("--ui-scale", options.look.ui_scale,
                 "Size of panels and letters, 0.5 to 3 times the usual one (default 1)")
      ->check(CLI::Range(0.5, 3.0));
  app.add_option_function<std::vector<std::string>>(
         "--panels",
         [&options](const std::vector<std::string>& names) {
           ChoosePanels(names, options.look.panels);
         },
         "Panels to show, with commas between: character, strips, devices, interface, boards "
         "(default: all)")
      ->delimiter(',')
      ->check(CLI::IsMember({"character", "strips", "devices", "interface", "boards"}));
  app.add_option_function<double>(
         "--view-angle",
         [&options](double degrees) {
           options.look.orbit.azimuth_rad = footing::DegreesToRadians(degrees);
         },
         "Turn of the view, degrees: 90 shows the biped from its right side (default 0)")
      ->check(CLI::Range(-180.0, 180.0));
  app.add_option("--view-distance", options.look.orbit.distance,
                 "Distance of the view, 0.3 to 3 times the usual one (default 1)")
      ->check(CLI::Range(0.3, 3.0));
}

}  // namespace

int main(int argc, char** argv) {
  auto app = footing::cli::NewApp(
      "footing-view",
      "Viewer: shows the biped on its track, or the reconstructed body, live or from a recording.",
      "  footing-view\n"
      "  footing-view --connect tcp:127.0.0.1:4711 --subject\n"
      "  footing-view --sound\n"
      "  footing-view --recording walk.mcap\n"
      "  footing-view --recording study.mcap --trial p07-1 --beside study.mcap:p07-2\n"
      "  footing-view --screenshot bird.png --at 5\n"
      "  footing-view --recording walk.mcap --record walk.mp4 --record-hz 30\n"
      "  footing-view --screenshot side.png --at 5 --view-angle 90\n"
      "  footing-view --camera-preview\n"
      "  footing-view --next-subject p08.json --next-subject p09.json\n"
      "  footing-view --text --seconds 30 --json");
  Options options;
  std::vector<std::string> connect, subjects;
  app->add_option("--connect", connect,
                  "Address of a server, unix:PATH, tcp:HOST:PORT or tls:HOST:PORT; may be repeated "
                  "(default: footing-sim and footingd of this user)");
  PlayArguments play;
  AddPlayOptions(*app, options, play);
  std::string camera;
  AddCameraOptions(*app, options, camera);
  AddPictureOptions(*app, options);
  app->add_flag("--subject", options.subject,
                "Show the world without panels, as for the subject's screen");
  app->add_flag("--overlay-reference", options.overlay_reference,
                "Draw the true pose of a simulated body over the estimate, not beside it");
  app->add_option("--next-subject", subjects, "Subject file for the key N, JSON; may be repeated");
  app->add_flag("--forces", options.forces, "Draw force arrows at the feet");
  app->add_flag("--replay-falls", options.replay_falls,
                "Replay the last 5 s before each fall in slow motion");
  app->add_flag("--text", options.text, "Show the state as text in the terminal");
  for (CLI::Option* const in_window :
       {app->add_flag("--sound", options.feedback.sound,
                      "Play steps, landings and wings on the machine's sound; in a window"),
        app->add_flag("--rumble", options.feedback.rumble,
                      "Shake the remote on the side of each foot that touches down; live, in a "
                      "window")
            ->excludes("--recording")}) {
    in_window->excludes("--screenshot")->excludes("--record")->excludes("--text");
  }
  app->add_flag("--json", options.json, "Print one JSON object on standard output at the end");
  if (const auto code = footing::cli::Parse(*app, argc, argv)) return *code;

  footing::log::Start("footing-view", false);
  if (const auto resolved = Resolve(connect, camera, play, options); !resolved) {
    return footing::cli::Report(resolved.error());
  }
  auto commands = footing::view::SubjectCommands(subjects);
  if (!commands) return footing::cli::Report(commands.error());
  options.next_subjects = std::move(commands).value();
  const auto done = Run(options);
  return done ? 0 : footing::cli::Report(done.error());
}
