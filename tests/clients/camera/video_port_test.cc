#include "clients/camera/video_port.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <map>

namespace footing::camera {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A camera's driver: which controls it has, which it ignores, and which format it gives.
class FakePort : public VideoPort {
 public:
  FakePort() {
    for (const std::uint32_t id :
         {V4L2_CID_EXPOSURE_AUTO, V4L2_CID_AUTOGAIN, V4L2_CID_AUTO_WHITE_BALANCE,
          V4L2_CID_EXPOSURE_ABSOLUTE, V4L2_CID_GAIN})
      controls[id] = 77;
  }

  int Control(unsigned long request, void* argument) override {
    if (request == VIDIOC_S_FMT) {
      auto& pixels = static_cast<v4l2_format*>(argument)->fmt.pix;
      if (only_format != 0) pixels.pixelformat = only_format;
      pixels.bytesperline =
          pixels.width * (pixels.pixelformat == V4L2_PIX_FMT_YUYV ? 2 : 1) + padding;
      return format_error;
    }
    if (request != VIDIOC_S_CTRL && request != VIDIOC_G_CTRL) return EINVAL;
    auto& control = *static_cast<v4l2_control*>(argument);
    const auto found = controls.find(control.id);
    if (found == controls.end()) return EINVAL;
    if (request == VIDIOC_G_CTRL) {
      control.value = found->second;
    } else if (control.id != ignored) {
      found->second = control.value;
    }
    return 0;
  }

  std::map<std::uint32_t, std::int32_t> controls;
  std::uint32_t ignored = 0, only_format = 0, padding = 0;
  int format_error = 0;
};

TEST(Video, LocksExposureGainAndWhiteBalance) {
  FakePort port;
  EXPECT_THAT(LockControls(port, {0.004, 20}), IsEmpty());
  EXPECT_EQ(port.controls[V4L2_CID_EXPOSURE_AUTO], V4L2_EXPOSURE_MANUAL);
  EXPECT_EQ(port.controls[V4L2_CID_EXPOSURE_ABSOLUTE], 40);  // 100 us each.
  EXPECT_EQ(port.controls[V4L2_CID_GAIN], 20);
  EXPECT_EQ(port.controls[V4L2_CID_AUTO_WHITE_BALANCE], 0);
}

TEST(Video, AlarmsWhenTheCameraIgnoresOrLacksAControl) {
  FakePort port;
  port.ignored = V4L2_CID_EXPOSURE_AUTO;
  port.controls.erase(V4L2_CID_AUTOGAIN);
  EXPECT_THAT(LockControls(port, {0.004, -1}),
              ElementsAre(HasSubstr("automatic exposure is 77 in spite of 1"),
                          HasSubstr("automatic gain cannot be set to 0")));
  EXPECT_EQ(port.controls[V4L2_CID_GAIN], 77);  // Not asked for.
}

TEST(Video, SetsAControlAgainThatChangesWhileFramesArrive) {
  FakePort port;
  const VideoSettings settings{0.004, 20};
  EXPECT_THAT(LockControls(port, settings), IsEmpty());
  LockedControls controls(port, settings);
  EXPECT_THAT(controls.Check(), IsEmpty());
  port.controls[V4L2_CID_EXPOSURE_AUTO] = V4L2_EXPOSURE_APERTURE_PRIORITY;
  EXPECT_THAT(controls.Check(),
              ElementsAre("camera: automatic exposure has changed to 3 and was set to 1 again"));
  EXPECT_EQ(port.controls[V4L2_CID_EXPOSURE_AUTO], V4L2_EXPOSURE_MANUAL);
  EXPECT_THAT(controls.Check(), IsEmpty());
  port.ignored = V4L2_CID_GAIN;
  port.controls[V4L2_CID_GAIN] = 63;
  EXPECT_THAT(controls.Check(),
              ElementsAre(HasSubstr("gain has changed to 63 and cannot be set again: the sphere")));
  EXPECT_THAT(controls.Check(), IsEmpty());  // Named once.
}

TEST(Video, WatchesOnlyWhatCouldBeLocked) {
  FakePort port;
  port.ignored = V4L2_CID_AUTOGAIN;
  EXPECT_EQ(LockControls(port, {0.004, -1}).size(), 1u);
  EXPECT_THAT(LockedControls(port, {0.004, -1}).Check(), IsEmpty());
}

TEST(Video, TakesTheFormatOfTheCameraFileAndNoOther) {
  FakePort port;
  frames::CameraFile camera;
  EXPECT_TRUE(Negotiate(port, camera));
  port.only_format = V4L2_PIX_FMT_YUYV;
  const auto refused = Negotiate(port, camera);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("it gives YUYV 640x480, not GRBG 640x480"));
  camera.format = sphere::PixelFormat::kYuyv;
  EXPECT_TRUE(Negotiate(port, camera));
  port.padding = 64;
  EXPECT_FALSE(Negotiate(port, camera));
  port.padding = 0;
  port.format_error = EBUSY;
  EXPECT_FALSE(Negotiate(port, camera));
}

TEST(Video, DatesAFrameToItsMiddle) {
  const frames::CameraFile camera;
  v4l2_buffer buffer{};
  buffer.flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  buffer.timestamp = {100, 20'000};
  // Readout 15.5 ms and exposure 4 ms, half of both.
  EXPECT_EQ(ExposedNs(buffer, camera, 0.004, 0), 100'020'000'000 - 9'750'000);
  buffer.flags |= V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  EXPECT_EQ(ExposedNs(buffer, camera, 0.004, 0), 100'020'000'000 + 9'750'000);
  buffer.flags = 0;  // Of another clock.
  EXPECT_EQ(ExposedNs(buffer, camera, 0.004, 50'000'000), 50'000'000 - 9'750'000);
}

TEST(Video, AFileIsNoCamera) {
  boost::asio::io_context io;
  const auto none = OpenVideo(io, "/nowhere/video0", {}, {}, [](const std::string&) {});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, ErrorKind::kNoDevice);
  const auto file = OpenVideo(io, "/dev/null", {}, {}, [](const std::string&) {});
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().kind, ErrorKind::kNoDevice);
}

}  // namespace
}  // namespace footing::camera
