#include "clients/camera/video_port.h"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

namespace footing::camera {
namespace {

std::string FourLetters(std::uint32_t format) {
  std::string letters;
  for (int i = 0; i < 4; ++i) letters += static_cast<char>((format >> (8 * i)) & 0x7f);
  return letters;
}

/// Nothing when the camera does not have the control.
std::optional<std::int32_t> Get(VideoPort& port, std::uint32_t id) {
  v4l2_control control{id, -1};
  if (port.Control(VIDIOC_G_CTRL, &control) != 0) return std::nullopt;
  return control.value;
}

/// One control: set, and read back. Nothing when the camera does not have it.
std::optional<std::int32_t> Set(VideoPort& port, std::uint32_t id, std::int32_t value) {
  v4l2_control control{id, value};
  if (port.Control(VIDIOC_S_CTRL, &control) != 0) return std::nullopt;
  return Get(port, id);
}

struct Lock {
  std::uint32_t id;
  std::int32_t value;
  const char* name;
  const char* harm;
};

constexpr char kBrightness[] =
    "the sphere's light changes by itself, and with it where its edge is";
constexpr char kHue[] = "the sphere's hue changes by itself, and it may be lost";

std::vector<Lock> LocksOf(const VideoSettings& settings) {
  std::vector<Lock> locks = {
      {V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL, "automatic exposure", kBrightness},
      {V4L2_CID_AUTOGAIN, 0, "automatic gain", kBrightness},
      {V4L2_CID_AUTO_WHITE_BALANCE, 0, "automatic white balance", kHue},
      // In units of 100 microseconds.
      {V4L2_CID_EXPOSURE_ABSOLUTE,
       static_cast<std::int32_t>(std::lround(1e4 * settings.exposure_s)), "exposure time",
       kBrightness}};
  if (settings.gain >= 0) locks.push_back({V4L2_CID_GAIN, settings.gain, "gain", kBrightness});
  return locks;
}

}  // namespace

Result<void> Negotiate(VideoPort& port, const frames::CameraFile& camera) {
  const bool is_yuyv = camera.format == sphere::PixelFormat::kYuyv;
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  format.fmt.pix.width = static_cast<std::uint32_t>(camera.lens.width);
  format.fmt.pix.height = static_cast<std::uint32_t>(camera.lens.height);
  format.fmt.pix.pixelformat = is_yuyv ? V4L2_PIX_FMT_YUYV : V4L2_PIX_FMT_SGRBG8;
  format.fmt.pix.field = V4L2_FIELD_NONE;
  const v4l2_pix_format wanted = format.fmt.pix;
  if (const int error = port.Control(VIDIOC_S_FMT, &format); error != 0)
    return Failure("camera: its format cannot be set: " + std::string(std::strerror(error)));
  const v4l2_pix_format& given = format.fmt.pix;
  const std::uint32_t row = wanted.width * (is_yuyv ? 2 : 1);
  if (given.pixelformat != wanted.pixelformat || given.width != wanted.width ||
      given.height != wanted.height || (given.bytesperline != 0 && given.bytesperline != row)) {
    return InvalidData("camera: it gives " + FourLetters(given.pixelformat) + " " +
                       std::to_string(given.width) + "x" + std::to_string(given.height) + ", not " +
                       FourLetters(wanted.pixelformat) + " " + std::to_string(wanted.width) + "x" +
                       std::to_string(wanted.height) +
                       "; change format, width or height of the camera file");
  }
  v4l2_streamparm rate{};
  rate.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  rate.parm.capture.timeperframe = {1000, static_cast<std::uint32_t>(1000 * camera.rate_hz)};
  port.Control(VIDIOC_S_PARM, &rate);  // Many drivers have one rate only; a frame has its own time.
  return {};
}

std::vector<std::string> LockControls(VideoPort& port, const VideoSettings& settings) {
  std::vector<std::string> alarms;
  for (const Lock& lock : LocksOf(settings)) {
    const auto read = Set(port, lock.id, lock.value);
    const std::string wanted = std::to_string(lock.value);
    if (!read) {
      alarms.push_back(std::string("camera: ") + lock.name + " cannot be set to " + wanted + ": " +
                       lock.harm);
    } else if (*read != lock.value) {
      alarms.push_back(std::string("camera: ") + lock.name + " is " + std::to_string(*read) +
                       " in spite of " + wanted + ": " + lock.harm);
    }
  }
  return alarms;
}

LockedControls::LockedControls(VideoPort& port, const VideoSettings& settings) : port_(port) {
  for (const Lock& lock : LocksOf(settings))
    if (Get(port, lock.id) == lock.value)
      watched_.push_back({lock.id, lock.value, lock.name, lock.harm, true});
}

std::vector<std::string> LockedControls::Check() {
  std::vector<std::string> lines;
  for (Watched& one : watched_) {
    const auto now = Get(port_, one.id);
    const bool held = std::exchange(one.holds, now == one.value);
    if (one.holds) continue;
    one.holds = Set(port_, one.id, one.value) == one.value;
    // One that cannot be set again is named once.
    if (!held) continue;
    const std::string what =
        "camera: " + one.name + " has changed to " + (now ? std::to_string(*now) : "nothing");
    lines.push_back(one.holds ? what + " and was set to " + std::to_string(one.value) + " again"
                              : what + " and cannot be set again: " + one.harm);
  }
  return lines;
}

std::int64_t ExposedNs(const v4l2_buffer& buffer, const frames::CameraFile& camera,
                       double exposure_s, std::int64_t now_ns) {
  const double half_s = 0.5 * (camera.readout_s + exposure_s);
  const auto half_ns = static_cast<std::int64_t>(std::llround(1e9 * half_s));
  if ((buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) != V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC)
    return now_ns - half_ns;
  const std::int64_t stamp_ns = static_cast<std::int64_t>(buffer.timestamp.tv_sec) * 1'000'000'000 +
                                static_cast<std::int64_t>(buffer.timestamp.tv_usec) * 1000;
  const bool at_start =
      (buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  return at_start ? stamp_ns + half_ns : stamp_ns - half_ns;
}

}  // namespace footing::camera
