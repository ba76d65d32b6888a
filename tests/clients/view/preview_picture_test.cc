// The preview of the camera in the viewer's picture.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/clients/view/made_preview.h"
#include "tests/clients/view/made_stream.h"
#include "tests/clients/view/picture_fixture.h"

namespace footing::render {
namespace {

const Is kMagenta = [](int r, int g, int b) { return r > 200 && g < 90 && b > 170; };

class PreviewPictureTest : public PictureFixture {
 protected:
  void TearDown() override { Resize(kWidth, kHeight); }

  static Image ShowBird(const scene::CameraPreview& camera, std::int64_t now_ns,
                        const HudOptions& hud, const std::string& name) {
    scene::Model model = scene::made::ModelAfter(12, {});
    model.observed.camera = camera;
    const scene::WorldFrame frame = scene::made::TickAt(12, {}).frame.value();
    scene::Stage stage;
    const scene::Picture picture = stage.Advance(model, frame, now_ns, 0.01, {});
    return Show(picture, model, frame, now_ns, hud, name);
  }

  static const std::int64_t kNowNs;
};
const std::int64_t PreviewPictureTest::kNowNs = scene::made::ClockAt(12);

HudOptions InACorner() {
  HudOptions hud;
  hud.camera = true;
  return hud;
}

TEST_F(PreviewPictureTest, IsInItsCornerAtEverySizeWithTheSpheresInIt) {
  const scene::CameraPreview camera = scene::made::Preview(kNowNs - 60'000'000);
  for (const auto& [width, height] : {std::pair(640, 480), {1280, 720}, {2560, 1440}}) {
    Resize(width, height);
    const auto size = "_" + std::to_string(width);
    const Image with = ShowBird(camera, kNowNs, InACorner(), "preview" + size);
    const Image without = ShowBird(camera, kNowNs, {}, "preview_off" + size);
    const Region corner{0, 0.45, 0.4, 1};
    EXPECT_GT(ShareOf(with, kMagenta, corner), 20 * ShareOf(without, kMagenta, corner) + 1e-4)
        << width;
    EXPECT_EQ(ShareOf(with, kMagenta, {0.5, 1, 0, 1}), ShareOf(without, kMagenta, {0.5, 1, 0, 1}))
        << width;
  }
}

TEST_F(PreviewPictureTest, APictureThatIsNotLiveIsDark) {
  const Image live =
      ShowBird(scene::made::Preview(kNowNs - 60'000'000), kNowNs, InACorner(), "preview_live");
  const Image old =
      ShowBird(scene::made::Preview(kNowNs - 4'000'000'000), kNowNs, InACorner(), "preview_old");
  const Region corner{0, 0.3, 0.5, 1};
  EXPECT_GT(ShareOf(live, kMagenta, corner), 1e-3);
  EXPECT_EQ(ShareOf(old, kMagenta, corner), 0);
}

TEST_F(PreviewPictureTest, ASubjectSeesNone) {
  HudOptions hud = InACorner();
  hud.hidden = true;
  const Image image = ShowBird(scene::made::Preview(kNowNs), kNowNs, hud, "preview_subject");
  EXPECT_EQ(ShareOf(image, kMagenta), 0);
}

TEST_F(PreviewPictureTest, AloneItFillsThePictureAndANewOneTakesItsPlace) {
  HudOptions hud;
  hud.camera_alone = true;
  const Image image = ShowBird(scene::made::Preview(kNowNs), kNowNs, hud, "preview_alone");
  // A ball of radius 12 of 240 pixels, in a picture that is 0.85 of the window's height or more.
  EXPECT_GT(ShareOf(image, kMagenta), 3.14 * 12 * 12 / (240 * 240) * 0.8 * 0.8 * 9 / 16);
  scene::CameraPreview dark = scene::made::Preview(kNowNs);
  preview::Picture picture = *dark.picture;
  std::fill(picture.rgb.begin(), picture.rgb.end(), std::uint8_t{10});
  dark.picture = std::make_shared<const preview::Picture>(std::move(picture));
  EXPECT_EQ(ShareOf(ShowBird(dark, kNowNs, hud, "preview_dark"), kMagenta), 0);
  scene::CameraPreview absent;
  absent.state = scene::CameraPreview::State::kAbsent;
  absent.why = "unix:/run/user/1000/footing/camera.sock: no such file";
  const Image words = ShowBird(absent, kNowNs, hud, "preview_absent");
  EXPECT_GT(ShareOf(words, [](int r, int g, int b) { return r > 180 && g > 120 && b < 120; }),
            2e-4);
}

}  // namespace
}  // namespace footing::render
