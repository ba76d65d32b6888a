#include "clients/view/scene/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clients/view/scene/model.h"
#include "clients/view/scene/text.h"
#include "tests/clients/view/made_preview.h"

namespace footing::scene {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::int64_t kOneSecondNs = 1'000'000'000;

TEST(CameraPreview, APictureIsLiveForHalfASecondAndThenItsAgeIsSaid) {
  const CameraPreview preview = made::Preview(10 * kOneSecondNs);
  EXPECT_EQ(PreviewTrouble(preview, 10 * kOneSecondNs + kOneSecondNs / 10), "");
  EXPECT_THAT(PreviewTrouble(preview, 13 * kOneSecondNs),
              AllOf(HasSubstr("stopped"), HasSubstr("3.0 s old")));
}

TEST(CameraPreview, EveryReasonWithoutAPictureIsSaid) {
  CameraPreview preview;
  EXPECT_EQ(PreviewTrouble(preview, 0), "");  // Nobody asked for it.
  preview.state = CameraPreview::State::kAbsent;
  preview.why = "unix:/run/x/camera.sock: no such file";
  EXPECT_THAT(PreviewTrouble(preview, 0),
              AllOf(HasSubstr("footing-camera is not running"), HasSubstr("camera.sock")));
  preview.state = CameraPreview::State::kWaiting;
  EXPECT_THAT(PreviewTrouble(preview, 0), HasSubstr("no frame yet"));
  preview.state = CameraPreview::State::kRefused;
  preview.why = "footing-camera already has 4 viewers";
  EXPECT_THAT(PreviewTrouble(preview, 0), HasSubstr("4 viewers"));
  // Ended after it showed something: nothing of that is live, however young it is.
  preview = made::Preview(kOneSecondNs);
  preview.state = CameraPreview::State::kAbsent;
  EXPECT_THAT(PreviewTrouble(preview, kOneSecondNs + 1000), HasSubstr("0.0 s old"));
}

TEST(CameraPreview, EachSphereSaysHowItFares) {
  preview::Picture picture = *made::Preview(0).picture;
  auto lines = PreviewLines(picture);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].text, "left hand: 1.52 m, confidence 0.97");
  EXPECT_TRUE(lines[0].is_good);
  EXPECT_THAT(lines[1].text, HasSubstr("right hand: being checked"));
  EXPECT_FALSE(lines[1].is_good);
  picture.spheres[0].is_saturated = true;
  picture.spheres[1].sight = preview::Sight::kOther;
  picture.has_pose = false;
  lines = PreviewLines(picture);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_THAT(lines[0].text, HasSubstr("lower the exposure"));
  EXPECT_THAT(lines[1].text, HasSubstr("not round"));
  EXPECT_THAT(lines[2].text, HasSubstr("not calibrated"));
  picture.spheres[0].is_saturated = false;
  picture.spheres[0].is_occluded = true;
  picture.spheres[1].sight = preview::Sight::kNothing;
  lines = PreviewLines(picture);
  EXPECT_THAT(lines[0].text, HasSubstr("partly hidden"));
  EXPECT_THAT(lines[1].text, HasSubstr("nothing of its colour"));
}

TEST(CameraPreview, TheTextViewHasItToo) {
  Model model;
  EXPECT_THAT(StatusScreen(model, 0), testing::Not(Contains("Camera")));
  model.observed.camera = made::Preview(0);
  const auto lines = StatusScreen(model, kOneSecondNs / 10);
  EXPECT_THAT(lines, Contains("Camera"));
  EXPECT_THAT(lines, Contains("  frame 42, 100 ms old"));
  EXPECT_THAT(lines, Contains(HasSubstr("refused for the right hand at 520, 90 px")));
  EXPECT_THAT(PreviewStatus(model.observed.camera, 2 * kOneSecondNs), HasSubstr("stopped"));
}

}  // namespace
}  // namespace footing::scene
