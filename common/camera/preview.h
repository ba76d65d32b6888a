#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/base/result.h"
#include "common/stream/device.h"

/// Preview of footing-camera for a person: reduced pictures with what was found in them. Its bytes
/// are in docs/camera.md.
namespace footing::preview {

/// How a sphere fares in a picture.
enum class Sight : std::uint8_t {
  kNothing = 0,   ///< Nothing of its colour.
  kOther = 1,     ///< A light of its colour that is not measured: too small, cut off, not round.
  kChecking = 2,  ///< Its light is switched to make sure that it is the sphere.
  kSeen = 3,      ///< It is sent to footingd.
};

/// In pixels of the camera.
struct Circle {
  float u_px = 0, v_px = 0, radius_px = 0;
};

/// One sphere in a picture, seen or not.
struct Sphere {
  stream::DeviceRole role = stream::DeviceRole::kUnspecified;
  Sight sight = Sight::kNothing;
  bool is_saturated = false, is_occluded = false;
  float confidence = 0;  ///< 0 to 1.
  float range_m = 0;     ///< From the camera.
  Circle circle;         ///< Radius 0: nothing to be drawn.
};

/// A light that did not follow when the sphere's was switched.
struct RefusedLight {
  stream::DeviceRole role = stream::DeviceRole::kUnspecified;  ///< Whose sphere it looked like.
  Circle circle;
};

/// One reduced frame with what was found in it.
struct Picture {
  std::uint64_t number = 0;     ///< Number of the frame since the program's start.
  std::int64_t exposed_ns = 0;  ///< The host's monotonic clock.
  int camera_width = 0, camera_height = 0;
  bool has_pose = false;   ///< The camera file says where the camera stands.
  bool simulated = false;  ///< The frames are not of a camera.
  std::vector<Sphere> spheres;
  std::vector<RefusedLight> refused;
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  ///< Rows from the top, three bytes a pixel.
};

inline constexpr int kMaxSide = 1024;  ///< Longest side of a picture, pixels.
inline constexpr std::size_t kMaxSpheres = 16, kMaxRefused = 64;
inline constexpr std::size_t kMaxText = 512;
inline constexpr std::size_t kHeaderBytes = 12;

/// A picture as one message, within the limits above: what is more of spheres and lights is left
/// out.
std::string Encode(const Picture& picture);
/// A message that says why there are no pictures.
std::string EncodeRefusal(const std::string& why);

/// Why there are no pictures.
struct Refusal {
  std::string why;
};
using Message = std::variant<Picture, Refusal>;

/// Messages out of a stream of bytes. It holds one message at most, of a length within the limits;
/// every number in it is checked.
class PreviewReader {
 public:
  void Add(std::string_view bytes) { pending_.append(bytes); }
  /// The next whole message; nothing when more bytes are needed; an error when they hold none,
  /// after which the reader is of no more use.
  Result<std::optional<Message>> Next();

 private:
  std::string pending_;
};

// The layout, for both directions (docs/camera.md).
enum class Kind : std::uint32_t { kPicture = 1, kRefusal = 2 };
inline constexpr std::string_view kMagic = "FCP1";
inline constexpr std::size_t kFixedBytes = 28, kSphereBytes = 24, kRefusedBytes = 16;
inline constexpr unsigned kHasPose = 1, kSimulated = 2;
inline constexpr unsigned kSaturated = 1, kOccluded = 2;
inline constexpr std::size_t kMaxBodyBytes = kFixedBytes + kSphereBytes * kMaxSpheres +
                                             kRefusedBytes * kMaxRefused +
                                             std::size_t{3} * kMaxSide * kMaxSide;

}  // namespace footing::preview
