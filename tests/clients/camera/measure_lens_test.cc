// The whole command on a folder of rendered frames.
#include "clients/camera/measure_lens.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "common/frames/netpbm.h"
#include "common/virtual/camera/sheet.h"
#include "tests/common/temporary_folder.h"

namespace footing::camera {
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

}  // namespace
}  // namespace footing::camera
