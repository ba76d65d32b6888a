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

/// The program ffmpeg on the PATH; empty where it is not installed.
std::string FindEncoder() {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string program = folder + "/ffmpeg";
    if (!folder.empty() && access(program.c_str(), X_OK) == 0) return program;
  }
  return "";
}

bool IsNumberedPicture(const fs::path& file) {
  const std::string stem = file.stem().string();
  return file.extension() == ".png" && stem.size() >= 6 &&
         std::all_of(stem.begin(), stem.end(), [](char c) { return c >= '0' && c <= '9'; });
}

std::vector<std::string> EncoderArguments(const std::string& program, const std::string& path,
                                          double hz, const render::Image& first) {
  std::vector<std::string> arguments{
      program,
      "-loglevel",
      "error",
      "-n",
      "-f",
      "rawvideo",
      "-pixel_format",
      "rgb24",
      "-video_size",
      std::to_string(first.width) + "x" + std::to_string(first.height),
      "-framerate",
      text::Fixed(hz, 3),
      "-i",
      "pipe:0"};
  const std::string ending = EndingOf(path);
  if (ending == ".gif" || ending == ".webp") {
    arguments.insert(arguments.end(), {"-loop", "0"});
  } else {
    // Common players need an even number of pixels each way, and colours at half their size.
    arguments.insert(arguments.end(),
                     {"-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"});
  }
  // A name that begins with a minus must not be an option.
  arguments.push_back(path.front() == '-' ? "./" + path : path);
  return arguments;
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
  if (IsFilm(path) && !fs::is_directory(path, none)) {
    if (fs::exists(path, none)) {
      return UsageError("--record " + path +
                        ": there is such a file already; remove it, or name another one");
    }
    if (FindEncoder().empty()) {
      return UsageError("--record " + path +
                        ": ffmpeg, which makes the film, is not installed; apt install ffmpeg, "
                        "or name a folder for numbered pictures");
    }
    return {};
  }
  for (fs::directory_iterator at(path, none), end; !none && at != end; at.increment(none)) {
    if (!IsNumberedPicture(at->path())) continue;
    return UsageError("--record " + path + ": the folder has pictures already (" +
                      at->path().filename().string() + "); remove them, or name another folder");
  }
  return {};
}

std::string NumberedPicture(const std::string& folder, int number) {
  std::string digits = std::to_string(number);
  digits.insert(0, 6 - std::min<std::size_t>(6, digits.size()), '0');
  return folder + "/" + digits + ".png";
}

Result<PictureSink> PictureSink::Open(const std::string& path, double hz) {
  std::error_code error;
  if (!IsFilm(path)) fs::create_directories(path, error);
  if (error) return Failure("cannot make the folder " + path + ": " + error.message());
  // With the folder there: "new/../old" names one only then.
  if (auto checked = CheckRecordName(path); !checked) return checked.error();
  return PictureSink(path, hz);
}

PictureSink::PictureSink(PictureSink&& other) noexcept
    : path_(std::move(other.path_)),
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
  const std::string program = FindEncoder();
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return Failure("cannot make the film " + path_ + ": " + std::strerror(errno));
  }
  std::vector<std::string> arguments = EncoderArguments(program, path_, hz_, first);
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  const int failed =
      posix_spawn(&film_, program.c_str(), &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  to_film_ = ends[0];
  if (failed == 0) return {};
  film_ = -1;
  return Failure("cannot start ffmpeg for " + path_ + ": " + std::strerror(failed));
}

Result<void> PictureSink::Add(const render::Image& image) {
  if (!IsFilm(path_)) return render::WritePicture(image, NumberedPicture(path_, count_++));
  if (count_++ == 0) {
    if (auto started = StartFilm(image); !started) return started;
  }
  for (std::size_t sent = 0; sent < image.rgb.size();) {
    const ssize_t got =
        send(to_film_, image.rgb.data() + sent, image.rgb.size() - sent, MSG_NOSIGNAL);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {
      return Failure("cannot write the film " + path_ +
                     ": ffmpeg has ended; what it wrote above says why");
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
  return Failure("cannot write the film " + path_ +
                 ": ffmpeg failed; what it wrote above says why");
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
  log::Info((IsFilm(options.record) ? "wrote " : "wrote pictures to ") + options.record);
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
