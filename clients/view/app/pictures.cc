#include "clients/view/app/pictures.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <string_view>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "clients/view/app/feed.h"
#include "clients/view/app/play_summary.h"
#include "clients/view/app/window.h"
#include "clients/view/render/screen.h"
#include "clients/view/render/target.h"
#include "clients/view/scene/clear_view.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/net/address.h"
#include "common/runtime/clock.h"
#include "common/runtime/log.h"

namespace footing::view {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 7> kFilms{".mp4", ".mkv",  ".webm", ".mov",
                                                 ".avi", ".webp", ".gif"};

/// The ending of a file's name in small letters: ".png".
std::string EndingOf(const std::string& path) {
  return text::Lower(fs::path(path).extension().string());
}

/// A program on the PATH; empty where it is not installed.
std::string FindProgram(const std::string& name) {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string program = folder + "/" + name;
    if (!folder.empty() && access(program.c_str(), X_OK) == 0) return program;
  }
  return "";
}

/// Starts a program that reads `input`, with its standard output thrown away; an errno, or 0.
int Spawn(std::vector<std::string> arguments, int input, pid_t& child) {
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  const int failed =
      posix_spawn(&child, pointers.front(), &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return failed;
}

bool Succeeds(const std::vector<std::string>& arguments) {
  pid_t child = -1;
  int status = 0;
  return Spawn(arguments, STDIN_FILENO, child) == 0 && waitpid(child, &status, 0) == child &&
         WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

bool IsNumberedPicture(const fs::path& file) {
  const std::string stem = file.stem().string();
  return file.extension() == ".png" && stem.size() >= 6 &&
         std::all_of(stem.begin(), stem.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// Elements of GStreamer that write a film of one ending; null where it has none.
struct GstreamerFilm {
  const char* encoder = nullptr;
  const char* container = nullptr;
};

GstreamerFilm GstreamerFilmOf(const std::string& ending) {
  if (ending == ".webm") return {"vp8enc", "webmmux"};
  if (ending == ".mp4") return {"x264enc", "mp4mux"};
  if (ending == ".mov") return {"x264enc", "qtmux"};
  if (ending == ".mkv") return {"x264enc", "matroskamux"};
  return {};
}

/// The command that GStreamer makes a film with; its program alone is empty where the program or a
/// plug-in is missing.
std::string FindGstreamer(const std::string& path) {
  const GstreamerFilm film = GstreamerFilmOf(EndingOf(path));
  const std::string inspect = FindProgram("gst-inspect-1.0");
  if (film.encoder == nullptr || inspect.empty()) return "";
  for (const char* element : {film.encoder, film.container, "rawvideoparse", "videoconvert"}) {
    if (!Succeeds({inspect, "--exists", element})) return "";
  }
  return FindProgram("gst-launch-1.0");
}

/// A name that begins with a minus must not be an option.
std::string AsArgument(const std::string& path) { return path.front() == '-' ? "./" + path : path; }

std::vector<std::string> FfmpegCommand(const std::string& program, const std::string& path,
                                       double hz, const render::Image& first) {
  const std::string size = std::to_string(first.width) + "x" + std::to_string(first.height);
  std::vector<std::string> command{program,      "-loglevel",        "error", "-n",          "-f",
                                   "rawvideo",   "-pixel_format",    "rgb24", "-video_size", size,
                                   "-framerate", text::Fixed(hz, 3), "-i",    "pipe:0"};
  const std::string ending = EndingOf(path);
  if (ending == ".gif" || ending == ".webp") {
    command.insert(command.end(), {"-loop", "0"});
  } else {
    // Common players need an even number of pixels each way, and colours at half their size.
    command.insert(command.end(), {"-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"});
  }
  command.push_back(AsArgument(path));
  return command;
}

std::vector<std::string> GstreamerCommand(const std::string& program, const std::string& path,
                                          double hz, const render::Image& first) {
  const GstreamerFilm film = GstreamerFilmOf(EndingOf(path));
  const auto milli_hz = std::to_string(static_cast<int>(1e3 * hz + 0.5));
  // As for ffmpeg: an even number of pixels.
  return {program,
          "-q",
          "fdsrc",
          "fd=0",
          "!",
          "rawvideoparse",
          "format=rgb",
          "width=" + std::to_string(first.width),
          "height=" + std::to_string(first.height),
          "framerate=" + milli_hz + "/1000",
          "!",
          "videobox",
          "right=-" + std::to_string(first.width % 2),
          "bottom=-" + std::to_string(first.height % 2),
          "!",
          "videoconvert",
          "!",
          "video/x-raw,format=I420",
          "!",
          film.encoder,
          "!",
          film.container,
          "!",
          "filesink",
          "location=" + AsArgument(path)};
}

/// The folder of numbered pictures that takes a film's place.
std::string FolderOf(const std::string& film) {
  return fs::path(film).replace_extension().string();
}

Result<void> CheckFolder(const std::string& folder) {
  std::error_code none;
  for (fs::directory_iterator at(folder, none), end; !none && at != end; at.increment(none)) {
    if (!IsNumberedPicture(at->path())) continue;
    return UsageError("--record " + folder + ": the folder has pictures already (" +
                      at->path().filename().string() + "); remove them, or name another folder");
  }
  return {};
}

}  // namespace

Result<void> CheckPictureName(const std::string& path) {
  const std::string ending = EndingOf(path);
  if (ending.empty() || ending == ".png" || ending == ".jpg" || ending == ".jpeg") return {};
  return UsageError("--screenshot " + path + ": pictures are PNG or JPEG files; name it " +
                    fs::path(path).replace_extension(".png").string());
}

bool IsFilm(const std::string& path) {
  return std::find(kFilms.begin(), kFilms.end(), EndingOf(path)) != kFilms.end();
}

Result<void> CheckRecordName(const std::string& path) {
  std::error_code none;
  if (!IsFilm(path) || fs::is_directory(path, none)) return CheckFolder(path);
  if (!fs::exists(path, none)) return {};
  return UsageError("--record " + path +
                    ": there is such a file already; remove it, or name another one");
}

std::string NumberedPicture(const std::string& folder, int number) {
  std::string digits = std::to_string(number);
  digits.insert(0, 6 - std::min<std::size_t>(6, digits.size()), '0');
  return folder + "/" + digits + ".png";
}

Result<PictureSink> PictureSink::Open(const std::string& path, double hz) {
  std::error_code error;
  if (auto checked = CheckRecordName(path); !checked) return checked.error();
  PictureSink sink(path, hz);
  if (IsFilm(path) && !fs::is_directory(path, error)) {
    sink.encoder_ = FindProgram("ffmpeg");
    sink.make_command_ = FfmpegCommand;
    if (!sink.encoder_.empty()) return sink;
    sink.encoder_ = FindGstreamer(path);
    sink.make_command_ = GstreamerCommand;
    if (!sink.encoder_.empty()) return sink;
    sink.path_ = FolderOf(path);
    log::Warning("no ffmpeg or GStreamer for " + path + ": writing numbered pictures into " +
                 sink.path_ + "/ (a film needs: apt install ffmpeg)");
  }
  fs::create_directories(sink.path_, error);
  if (error) return Failure("cannot make the folder " + sink.path_ + ": " + error.message());
  // With the folder there: "new/../old" names one only then.
  if (auto checked = CheckFolder(sink.path_); !checked) return checked.error();
  return sink;
}

PictureSink::PictureSink(PictureSink&& other) noexcept
    : path_(std::move(other.path_)),
      encoder_(std::move(other.encoder_)),
      make_command_(other.make_command_),
      hz_(other.hz_),
      count_(other.count_),
      to_film_(std::exchange(other.to_film_, -1)),
      film_(std::exchange(other.film_, -1)) {}

PictureSink::~PictureSink() { CloseFilm(); }

void PictureSink::CloseFilm() {
  if (to_film_ >= 0) close(std::exchange(to_film_, -1));
  if (film_ > 0) waitpid(std::exchange(film_, -1), nullptr, 0);
}

// A socket in place of a pipe: an encoder that has ended is an error here, and not a signal.
Result<void> PictureSink::StartFilm(const render::Image& first) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return Failure("cannot make the film " + path_ + ": " + std::strerror(errno));
  }
  const int failed = Spawn(make_command_(encoder_, path_, hz_, first), ends[1], film_);
  close(ends[1]);
  to_film_ = ends[0];
  if (failed == 0) return {};
  film_ = -1;
  return Failure("cannot start " + encoder_ + " for " + path_ + ": " + std::strerror(failed));
}

Result<void> PictureSink::Add(const render::Image& image) {
  if (encoder_.empty()) return render::WritePicture(image, NumberedPicture(path_, count_++));
  if (count_++ == 0) {
    if (auto started = StartFilm(image); !started) return started;
  }
  for (std::size_t sent = 0; sent < image.rgb.size();) {
    const ssize_t got =
        send(to_film_, image.rgb.data() + sent, image.rgb.size() - sent, MSG_NOSIGNAL);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {
      return Failure("cannot write the film " + path_ + ": " + encoder_ +
                     " has ended; what it wrote above says why");
    }
    sent += static_cast<std::size_t>(got);
  }
  return {};
}

Result<void> PictureSink::Finish() {
  if (film_ <= 0) return {};
  close(std::exchange(to_film_, -1));
  int status = 0;
  const pid_t ended = waitpid(std::exchange(film_, -1), &status, 0);
  if (ended > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  return Failure("cannot write the film " + path_ + ": " + encoder_ +
                 " failed; what it wrote above says why");
}

std::string PictureSink::Written() const {
  return "wrote " + std::to_string(count_) + " pictures to " + path_;
}

namespace {

constexpr double kStepS = 1.0 / 60;
constexpr double kAtS = 1;         // Without --at.
constexpr double kRecordS = 10;    // Without --seconds.
constexpr double kAnnouncedS = 2;  // A longer wait for a picture is announced.

/// The chain of one off-screen run; its members' order is their order of construction.
struct Studio {
  const Options& options;
  render::Target& target;
  render::Screen& screen;
  Background& background;
  PoseCalibration* calibration = nullptr;
  scene::Show show = {};
  std::int64_t started_ns = clock::MonotonicNs();

  double PassedS() const { return NanosecondsToSeconds(clock::MonotonicNs() - started_ns); }

  double AtS() const { return options.at_s.value_or(kAtS); }

  /// Lets the camera and the head follow until that instant of the viewer's clock.
  scene::Show::Shot FollowUntil(std::int64_t until_ns) {
    for (;;) {
      background.Drain(show, calibration);
      const std::int64_t now_ns = clock::MonotonicNs();
      scene::Show::Shot shot = show.At(now_ns, false, {options.forces, options.overlay_reference});
      shot.picture.camera = scene::ClearView(shot.picture, show.model().track, options.look.orbit);
      if (now_ns >= until_ns || background.stop_asked()) return shot;
      clock::SleepUntil(std::min(until_ns, now_ns + SecondsToNanoseconds(kStepS)));
    }
  }

  render::Image Draw(const scene::Show::Shot& shot) {
    target.Bind();
    render::HudOptions hud;
    hud.hidden = options.subject;
    hud.panels = options.look.panels;
    hud.camera = options.camera.corner;
    hud.camera_alone = options.camera.alone;
    screen.Draw(
        {shot.picture, show.model(), shot.frame, clock::MonotonicNs(), shot.past, shot.past_ns},
        hud, target.width(), target.height());
    return target.Read();
  }

  /// Until the first tick, or until the time is over without one.
  std::int64_t WaitForData() {
    const std::int64_t given_up_ns = started_ns + SecondsToNanoseconds(AtS());
    while (scene::IsWaiting(show.model()) && clock::MonotonicNs() < given_up_ns &&
           !background.stop_asked()) {
      FollowUntil(clock::MonotonicNs() + SecondsToNanoseconds(kStepS));
    }
    return scene::IsWaiting(show.model()) ? started_ns : clock::MonotonicNs();
  }
};

Result<void> TakeScreenshot(Studio& studio) {
  if (studio.AtS() >= kAnnouncedS) {
    log::Info("drawing " + studio.options.screenshot + " in " + text::Fixed(studio.AtS(), 0) +
              " s");
  }
  const std::int64_t from_ns = studio.WaitForData();
  if (scene::IsWaiting(studio.show.model()) && !studio.options.camera.alone) {
    std::string why = "no server has sent anything yet";
    for (const scene::LinkReport& link : studio.show.model().links) {
      if (!link.why.empty()) why += "; " + link.why;
    }
    log::Warning(why + transport::RemedyFor(why, "start footing-sim, or name it with --connect"));
  }
  const auto shot = studio.FollowUntil(from_ns + SecondsToNanoseconds(studio.AtS()));
  const auto written = render::WritePicture(studio.Draw(shot), studio.options.screenshot);
  if (written) log::Info("wrote " + studio.options.screenshot);
  return written;
}

Result<void> Record(Studio& studio) {
  const Options& options = studio.options;
  auto sink = PictureSink::Open(options.record, options.record_hz);
  if (!sink) return sink.error();
  const double seconds = options.seconds > 0 ? options.seconds : kRecordS;
  const auto count = static_cast<int>(seconds * options.record_hz);
  int late = 0;
  for (int i = 0; i < count && !studio.background.stop_asked(); ++i) {
    const std::int64_t due_ns =
        studio.started_ns + SecondsToNanoseconds((i + 1) / options.record_hz);
    if (clock::MonotonicNs() > due_ns + SecondsToNanoseconds(1 / options.record_hz)) ++late;
    const auto written = sink->Add(studio.Draw(studio.FollowUntil(due_ns)));
    if (!written) return written;
  }
  if (const auto finished = sink->Finish(); !finished) return finished;
  log::Info(sink->Written());
  if (late > 0) {
    log::Warning(std::to_string(late) + " of " + std::to_string(count) +
                 " pictures are late: this machine needs a lower --record-hz");
  }
  return {};
}

}  // namespace

Result<void> RunOffScreen(const Options& options) {
  auto context = render::OffScreen::Create();
  if (!context) return context.error();
  auto target = render::Target::Create(options.width, options.height, options.samples);
  if (!target) return target.error();
  auto screen = render::Screen::Create();
  if (!screen) return screen.error();
  (*screen)->set_ui_scale(static_cast<float>(options.look.ui_scale));
  auto calibration = PoseCalibration::OfOptions(options.camera.calibration_file);
  if (!calibration) return calibration.error();
  Background background(options);
  Studio studio{options, *target, **screen, background, *calibration ? &**calibration : nullptr};
  if (options.replay_falls) studio.show.ReplayFalls();
  auto done = options.screenshot.empty() ? Record(studio) : TakeScreenshot(studio);
  if (done && options.json) {
    std::cout << Summary(studio.show.model(), studio.PassedS()) << std::endl;
  }
  return done;
}

}  // namespace footing::view
