#pragma once

#include <string>
#include <utility>
#include <vector>

#include <sys/types.h>

#include "clients/view/app/options.h"
#include "clients/view/render/target.h"
#include "common/base/result.h"

namespace footing::view {

/// UsageError unless a picture can have that name: NAME.png, NAME.jpg, or a name without an ending.
Result<void> CheckPictureName(const std::string& path);

/// Whether the name is that of a film, by its ending: "walk.mp4".
bool IsFilm(const std::string& path);

/// UsageError where --record cannot go: into a folder that has pictures, or over a film that is
/// there.
Result<void> CheckRecordName(const std::string& path);

/// "folder/000042.png".
std::string NumberedPicture(const std::string& folder, int number);

/// Where the pictures of --record go: into a folder as numbered PNG files, or into a film through
/// ffmpeg or GStreamer, which run as a child. Where neither is installed, a film's pictures go into
/// a folder of its name without the ending, with a warning. Nothing that is there already is
/// overwritten.
class PictureSink {
 public:
  /// `hz` is the rate of the pictures. Makes the folder where it is missing.
  static Result<PictureSink> Open(const std::string& path, double hz);
  PictureSink(PictureSink&& other) noexcept;
  PictureSink& operator=(PictureSink&&) = delete;
  PictureSink(const PictureSink&) = delete;
  ~PictureSink();

  /// All pictures have the size of the first one.
  Result<void> Add(const render::Image& image);
  /// Completes the film; the error names the program that failed.
  Result<void> Finish();
  /// How many pictures went where, as a line for the log.
  std::string Written() const;

 private:
  PictureSink(std::string path, double hz) : path_(std::move(path)), hz_(hz) {}
  Result<void> StartFilm(const render::Image& first);
  void CloseFilm();

  /// The encoder's arguments for pictures of that size.
  using MakeCommand = std::vector<std::string> (*)(const std::string& program,
                                                   const std::string& path, double hz,
                                                   const render::Image& first);

  std::string path_;
  std::string encoder_;  ///< Program of a film; empty: numbered pictures.
  MakeCommand make_command_ = nullptr;
  double hz_ = 0;
  int count_ = 0;
  int to_film_ = -1;  ///< The socket that the encoder reads.
  pid_t film_ = -1;   ///< Its process.
};

/// Draws without any display: one picture options.at_s seconds after the first data (or after the
/// start, while no server answers: then it shows what the viewer waits for), or a folder of
/// numbered ones.
Result<void> RunOffScreen(const Options& options);

}  // namespace footing::view
