// The screen of the camera's calibration.
#include <gtest/gtest.h>

#include "common/board/layout.h"
#include "common/camera/camera_pose.h"
#include "tests/clients/view/made_preview.h"
#include "tests/clients/view/made_stream.h"
#include "tests/clients/view/picture_fixture.h"
#include "tests/common/camera/boards.h"

namespace footing::render {
namespace {

using guide::MarkState;

const Is kAmber = [](int r, int g, int b) { return r > 190 && g > 110 && g < 200 && b < 110; };
const Is kGreen = [](int r, int g, int b) { return g > r + 60 && g > b + 40; };

/// After three marks of eight.
scene::Calibration AfterThree() {
  scene::Calibration calibration;
  calibration.rig = "main";
  calibration.prompt = "Hold the sphere on the mark at the rear left, left board, and keep still.";
  calibration.feedback = "seen";
  guide::MarksState& state = calibration.marks.emplace();
  for (const auto& mark : camera_pose::BoardMarks(board::DefaultLayout(), camera_pose::kRadiusM))
    state.marks.push_back({mark.name, mark.p_W_m, MarkState::Stage::kToCome});
  for (std::size_t i = 0; i < 3; ++i) state.marks[i].stage = MarkState::Stage::kTaken;
  state.marks[3].stage = MarkState::Stage::kNext;
  state.done = 3;
  state.all = 8;
  state.rest_share = 0.6;
  return calibration;
}

class CalibrationPictureTest : public PictureFixture {
 protected:
  static Image ShowCalibration(const scene::Calibration& calibration, const std::string& name,
                               bool camera = false) {
    scene::Model model;
    model.newest_host_ns[0] = kNowNs;
    model.observed.calibration = calibration;
    if (camera) model.observed.camera = scene::made::Preview(kNowNs - 50'000'000);
    scene::Stage stage;
    const scene::Picture picture = stage.Advance(model, {}, kNowNs, 0.01, {});
    HudOptions hud;
    hud.camera = camera;
    return Show(picture, model, {}, kNowNs, hud, name);
  }
  static constexpr std::int64_t kNowNs = 20'250'000'000;  // The pulse is at its largest.
};

constexpr Region kScene{0.25, 0.75, 0.05, 0.7};

TEST_F(CalibrationPictureTest, TheNextMarkIsAmberAndTheTakenOnesAreGreen) {
  scene::Calibration calibration = AfterThree();
  const Image three = ShowCalibration(calibration, "calibration_three", true);
  EXPECT_GT(ShareOf(three, kAmber, kScene), 2e-4);
  const double green = ShareOf(three, kGreen, kScene);
  EXPECT_GT(green, 5e-4);
  for (auto& mark : calibration.marks->marks) mark.stage = MarkState::Stage::kToCome;
  const Image none = ShowCalibration(calibration, "calibration_none");
  EXPECT_LT(ShareOf(none, kGreen, kScene), green / 4);
}

TEST_F(CalibrationPictureTest, AControllerStandsOnTheMarkThatWantsItUpright) {
  scene::Calibration calibration = AfterThree();
  const Image on = ShowCalibration(calibration, "calibration_on");
  calibration.marks->upright = true;
  const Image above = ShowCalibration(calibration, "calibration_upright");
  int differ = 0;
  for (std::size_t i = 0; i < on.rgb.size(); ++i) differ += on.rgb[i] != above.rgb[i];
  EXPECT_GT(differ, 1500);
}

TEST_F(CalibrationPictureTest, TheEndShowsTheCameraAndTheResiduals) {
  scene::Calibration calibration = AfterThree();
  for (auto& mark : calibration.marks->marks) {
    mark.stage = MarkState::Stage::kTaken;
    mark.residual_m = 0.0013;
  }
  calibration.marks->X_WC = camera_pose::kTrue;
  stream::SetupItem& result = calibration.result.emplace();
  result.passed = true;
  result.note = "8 marks, residual 1.3 mm, direction to 0.12 degrees; stored in camera.json";
  const Image image = ShowCalibration(calibration, "calibration_end");
  // Colour of the camera's lines; the panel has a few letters of that colour.
  const Is blue = [](int r, int g, int b) { return b > 150 && b > r + 60 && g > r + 20; };
  const double with_camera = ShareOf(image, blue, kScene);
  calibration.result->passed = false;
  calibration.result->note =
      "the mark at the rear left, left board is 38 mm off: hold the sphere on that mark again";
  calibration.marks->X_WC.reset();
  const Image refused = ShowCalibration(calibration, "calibration_refused");
  EXPECT_GT(with_camera, ShareOf(refused, blue, kScene) + 2e-4);
}

}  // namespace
}  // namespace footing::render
