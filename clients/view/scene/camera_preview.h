#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/camera/preview.h"

/// What footing-camera sees, as it is shown in a corner.
namespace footing::scene {

struct CameraPreview {
  enum class State {
    kNone,     ///< It is not asked for.
    kAbsent,   ///< Nobody answers at its socket.
    kWaiting,  ///< footing-camera answers, and has sent nothing yet.
    kShown,    ///< There was a picture; its age says whether it still is one.
    kRefused,  ///< It has no picture for this viewer.
  };
  State state = State::kNone;
  std::string address;
  std::string why;  ///< Of kAbsent and kRefused.
  /// The last one; null before it. Whoever draws it uses its number to see that it is another one.
  std::shared_ptr<const preview::Picture> picture;
};

/// From this age on a picture is not called live: five pictures were missed.
inline constexpr double kPreviewStaleS = 0.5;

/// Seconds since the camera saw the picture; 0 without one.
double PreviewAgeS(const CameraPreview& preview, std::int64_t now_ns);

/// Why the picture is not live, and what to do; empty when it is.
std::string PreviewTrouble(const CameraPreview& preview, std::int64_t now_ns);

/// How a sphere fares, in one line.
struct PreviewLine {
  std::string text;
  bool is_good = false;  ///< Seen, and well.
};
/// One for each sphere, then one for the pose if the camera has none.
std::vector<PreviewLine> PreviewLines(const preview::Picture& picture);

/// All of it for a terminal, below "Camera"; nothing where it is not asked for.
void AddPreviewLines(const CameraPreview& preview, std::int64_t now_ns,
                     std::vector<std::string>& lines);
/// The same in one line.
std::string PreviewStatus(const CameraPreview& preview, std::int64_t now_ns);

}  // namespace footing::scene
