#include <cerrno>
#include <filesystem>
#include <fstream>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <boost/asio/steady_timer.hpp>

#include "clients/camera/video_port.h"
#include "common/frames/camera_file.h"
#include "common/virtual/camera/scene.h"
#include "tests/common/temporary_folder.h"

namespace footing::camera {
namespace {

TEST(FolderSource, DeliversNothingOnceItIsStoppedHoweverLateItsFramesAre) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("folder_source_test." + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  frames::Frame frame{
      sphere::PixelFormat::kSgrbg8, 640, 480, std::vector<std::uint8_t>(640 * 480, 20), {}};
  std::ofstream(folder / "0.pgm", std::ios::binary) << frames::ToPgm(frame);
  boost::asio::io_context io;
  auto source = OpenFolder(io, folder.string(), {}, true);
  ASSERT_TRUE(source) << source.error().message;
  // Both timers are over before the loop looks: the first one's handler runs first.
  boost::asio::steady_timer limit(io, std::chrono::seconds(-1));
  limit.async_wait([&](boost::system::error_code) { (*source)->Stop(); });
  int frames = 0;
  (*source)->Start(
      [&](const frames::Frame&, std::int64_t) {
        if (++frames > 3) io.stop();
      },
      [](const Result<void>&) {});
  io.run();
  EXPECT_EQ(frames, 0);
  std::filesystem::remove_all(folder);
}

}  // namespace

// The whole command on a folder of rendered frames.
namespace {

namespace rendered = virtual_camera;
using ::testing::HasSubstr;

void WriteFrame(const std::string& path, const rendered::Lens& lens, int number,
                noise::Random& random) {
  rendered::Scene scene;
  scene.lens = lens;
  rendered::DotSheet sheet;
  const Eigen::Vector3d ray =
      rendered::RayThrough(lens, {160 + 160 * (number % 3), 130 + 110 * (number / 3 % 3)});
  sheet.X_CS.translation() = ray * (random.Uniform(0.35, 0.45) / ray.z());
  sheet.X_CS.linear() = (Eigen::AngleAxisd(random.Uniform(-0.6, 0.6), Eigen::Vector3d::UnitX()) *
                         Eigen::AngleAxisd(random.Uniform(-0.6, 0.6), Eigen::Vector3d::UnitY()))
                            .toRotationMatrix();
  const auto mosaic = rendered::RenderSheet(scene, sheet, random);
  std::ofstream(path, std::ios::binary) << frames::ToPgm(
      {sphere::PixelFormat::kSgrbg8, mosaic.width, mosaic.height, mosaic.bytes, {}});
}

TEST(MeasureLens, OfFramesOfASheetIsTheTrueLens) {
  const test::TemporaryFolder folder;
  const rendered::Lens truth{640, 480, 612, 608, 330, 236, -0.1, 0.02, 0, 0.0005, 0};
  noise::Random random(12);
  LensOptions options;
  options.camera.rate_hz = 1000;
  options.frames.folder = folder.Path("");
  for (int i = 0; i < 9; ++i)
    WriteFrame(folder.Path("frame" + std::to_string(i) + ".pgm"), truth, i, random);
  const auto report = MeasureLens(options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->views, 9u);
  EXPECT_LT(report->fit.rms_px, 0.3);
  EXPECT_NEAR(report->fit.lens.fx_px, truth.fx_px, 3);
  EXPECT_NEAR(report->fit.lens.cy_px, truth.cy_px, 3);
}

TEST(CheckSize, NamesBothSizes) {
  frames::CameraFile camera;
  camera.lens.width = 1280;
  camera.lens.height = 720;
  frames::Frame frame;
  frame.width = 640;
  frame.height = 480;
  const auto checked = CheckSize(frame, camera);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().kind, ErrorKind::kInvalidData);
  EXPECT_THAT(checked.error().message, HasSubstr("640x480"));
  EXPECT_THAT(checked.error().message, HasSubstr("1280x720"));
  frame.width = 1280;
  frame.height = 720;
  EXPECT_TRUE(CheckSize(frame, camera));
}

TEST(MeasureLens, RefusesTheSameViewAgainAndAgain) {
  const test::TemporaryFolder folder;
  noise::Random random(13);
  LensOptions options;
  options.camera.rate_hz = 1000;
  options.frames.folder = folder.Path("");
  WriteFrame(folder.Path("a.pgm"), {}, 4, random);
  for (const char* name : {"b.pgm", "c.pgm", "d.pgm", "e.pgm", "f.pgm"})
    std::ofstream(folder.Path(name), std::ios::binary)
        << std::ifstream(folder.Path("a.pgm"), std::ios::binary).rdbuf();
  const auto report = MeasureLens(options);
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error().message, HasSubstr("seen in 1 places"));
}

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
  buffer.flags = 0;  // Timestamp of another clock.
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
