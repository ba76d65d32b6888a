#include "clients/view/app/pictures.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <system_error>
#include <vector>

#include "common/base/number.h"

namespace footing::view {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 7> kFilms{".mp4", ".mkv",  ".webm", ".mov",
                                                 ".avi", ".webp", ".gif"};

/// The ending of a file's name in small letters: ".png".
std::string EndingOf(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
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
    // What common players show: an even number of pixels each way, and colours at half their size.
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

}  // namespace footing::view
