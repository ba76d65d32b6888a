#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/result.h"
#include "common/camera/find.h"
#include "common/camera/image.h"
#include "common/stream/device.h"

namespace footing::frames {

/// Hands and the head: what else a person moves is not followed by its sphere.
constexpr bool CanHoldSphere(stream::DeviceRole role) {
  return role == stream::DeviceRole::kLeftHand || role == stream::DeviceRole::kRightHand ||
         role == stream::DeviceRole::kHead;
}

/// A sphere that is looked for, and whose hand holds it.
struct HeldSphere {
  stream::DeviceRole role = stream::DeviceRole::kUnspecified;
  sphere::Target target;
  std::optional<std::uint32_t> led_rgb = {};  ///< Light of the controller that looks so, 0xRRGGBB.
};

/// A camera file, JSON (docs/camera.md): lens, sensor, spheres, and where the camera stands.
struct CameraFile {
  sphere::Lens lens;
  sphere::Settings settings;
  sphere::PixelFormat format = sphere::PixelFormat::kSgrbg8;
  double rate_hz = 60;
  double readout_s = 0.0155;  ///< From the first to the last row.
  std::vector<HeldSphere> spheres;
  std::optional<Eigen::Isometry3d> X_WC;  ///< Camera frame in W; nothing: not calibrated.
  std::string calibrated;                 ///< When and how well, for people; may be empty.

  std::vector<sphere::Target> Targets() const;
  /// Mid-exposure of a row after that of the middle row, s.
  double RowTime(double row_px) const;
};

/// Every error names file, key and what is allowed; unknown keys are errors.
Result<CameraFile> ReadCameraFile(const std::string& path);
Result<CameraFile> ParseCameraFile(const std::string& text, const std::string& origin);
/// The same, but `spheres` may be missing; the defaults where there is no file.
Result<CameraFile> ReadUncalibratedCamera(const std::string& path);
std::string ToJson(const CameraFile& camera);

/// Writes pose and remark into a camera file, in place of those that it has; its other keys stay.
/// The file is whole at every instant.
Result<void> StorePose(const std::string& path, const Eigen::Isometry3d& X_WC,
                       const std::string& calibrated);

/// Writes spheres, blur and limb darkening alike; a file that is not there begins as `camera`.
Result<void> StoreSpheres(const std::string& path, const CameraFile& camera);

/// Writes the lens alike.
Result<void> StoreLens(const std::string& path, const CameraFile& camera);

/// "#ff00c8", as footing-ctl led takes it.
std::string ColourText(std::uint32_t rgb);
/// The same in the other direction; nothing for any other text.
std::optional<std::uint32_t> ParseColour(const std::string& text);

/// A frame and when its middle row was exposed.
struct Frame {
  sphere::PixelFormat format = sphere::PixelFormat::kSgrbg8;
  int width = 0, height = 0;
  std::vector<std::uint8_t> bytes;
  std::optional<std::int64_t> time_ns;  ///< As the frame says, on whatever clock.

  sphere::Image View() const { return {format, width, height, bytes}; }
};

/// Reads PGM (P5: a mosaic G R / B G) and PPM (P6: of its colours those are taken that a mosaic
/// has), one image after the other as a FIFO delivers them. A comment "# time_ns N" in the header
/// is the time of exposure. Sizes: even, 32 to 4096; 8 bits.
class NetpbmReader {
 public:
  void Add(std::string_view bytes) { pending_.append(bytes); }
  /// The next whole image; nothing when more bytes are needed; an error when they hold no image,
  /// after which the reader is of no more use.
  Result<std::optional<Frame>> Next();
  bool empty() const { return pending_.empty(); }

 private:
  std::string pending_;
};

/// A mosaic as a PGM, with its time where it has one.
std::string ToPgm(const Frame& frame);

/// The .pgm, .ppm and .yuyv files of a folder in the order of their names; an error when there is
/// none.
Result<std::vector<std::string>> FramesOf(const std::string& folder);

/// One frame. A .yuyv file has no header: its size must be that of width and height.
Result<Frame> ReadFrame(const std::string& path, int width, int height);

}  // namespace footing::frames
