// The calibration's screen, driven by the ticks of a footingd whose camera is not calibrated.
#include "clients/view/app/window.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "common/frames/camera_file.h"
#include "tests/common/camera/boards.h"

namespace footing::view {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

class PoseCalibrationTest : public ::testing::Test {
 protected:
  void SetUp() override {
    path_ = (std::filesystem::temp_directory_path() /
             ("pose_calibration." + std::to_string(getpid()) + ".json"))
                .string();
    frames::CameraFile camera;
    camera.spheres = {{stream::DeviceRole::kLeftHand, {}}};
    std::ofstream(path_) << frames::ToJson(camera);
    auto opened = PoseCalibration::OfOptions(path_);
    ASSERT_TRUE(opened && *opened);
    calibration_ = std::move(*opened).value();
  }
  void TearDown() override { std::filesystem::remove(path_); }

  /// One tick of a camera with 60 frames a second: the person brings the sphere wherever the next
  /// mark is, within half a second.
  void Tick() {
    now_ns_ += 16'666'667;
    scene::Update update;
    update.host_ns = now_ns_;
    const Vector3d& goal_m = goal_m_;
    at_m_ += std::min(1.0, 0.1 / std::max(1e-9, (goal_m - at_m_).norm())) * (goal_m - at_m_);
    const auto seen = camera_pose::SeenAt(camera_pose::kTrue, at_m_);
    const Eigen::LLT<Eigen::Matrix3d> root(seen.covariance_m2);
    stream::HandSample sample;
    sample.rig = "main";
    sample.role = stream::DeviceRole::kLeftHand;
    sample.received_ns = sample.sampled_ns = now_ns_ - 1;
    sample.position_m = seen.p_C_m + root.matrixL() * camera_pose::Normal3(random_);
    if (mirrored_) sample.position_m.x() *= -1;
    sample.sd_m = seen.covariance_m2.diagonal().cwiseSqrt();
    sample.covariance_m2 = {seen.covariance_m2(0, 1), seen.covariance_m2(0, 2),
                            seen.covariance_m2(1, 2)};
    if (mirrored_) sample.covariance_m2.head<2>() *= -1;
    sample.confidence = 0.9;
    sample.tracker_pose = stream::TrackerPose{};
    update.hands = {sample};
    calibration_->Take(update);
    calibration_->Advance(model_, [this](v1::Command command) { recorded_.push_back(command); });
    if (!model_.observed.calibration || !model_.observed.calibration->marks) return;
    for (const guide::MarkState& mark : model_.observed.calibration->marks->marks)
      if (mark.stage == guide::MarkState::Stage::kNext) goal_m_ = mark.p_W_m;
  }
  void TickUntilResult() {
    for (int i = 0; i < 60 * 120 && !model_.observed.calibration->result; ++i) Tick();
    ASSERT_TRUE(model_.observed.calibration->result) << model_.observed.calibration->feedback;
  }
  std::optional<Eigen::Isometry3d> StoredPose() const {
    const auto camera = frames::ReadCameraFile(path_);
    EXPECT_TRUE(camera);
    return camera->X_WC;
  }

  std::string path_;
  std::optional<PoseCalibration> calibration_;
  scene::Model model_;
  std::vector<v1::Command> recorded_;
  std::int64_t now_ns_ = 100'000'000'000;
  Vector3d at_m_{0.3, 0.2, 1.1}, goal_m_{0.3, 0.2, 1.1};
  bool mirrored_ = false;
  noise::Random random_{3};
};

TEST_F(PoseCalibrationTest, LeadsFromMarkToMarkAndStoresThePoseInTheFile) {
  Tick();
  ASSERT_TRUE(model_.observed.calibration);
  EXPECT_THAT(scene::CalibrationTitle(*model_.observed.calibration),
              HasSubstr("front left, left board"));
  EXPECT_EQ(scene::CalibrationProgress(*model_.observed.calibration),
            "Where the camera stands, 1 of 8");
  TickUntilResult();
  const stream::SetupItem& result = *model_.observed.calibration->result;
  EXPECT_TRUE(result.passed) << result.note;
  EXPECT_THAT(scene::CalibrationDetail(*model_.observed.calibration),
              HasSubstr("stored in " + path_));
  ASSERT_TRUE(StoredPose());
  EXPECT_LT((StoredPose()->translation() - camera_pose::kTrue.translation()).norm(), 0.02);
  ASSERT_EQ(recorded_.size(), 1u);
  EXPECT_EQ(recorded_[0].record_setup().item().name(), "camera");
  EXPECT_TRUE(recorded_[0].record_setup().item().passed());
  for (int i = 0; i < 10; ++i) Tick();  // The result stays, and is recorded once.
  EXPECT_EQ(recorded_.size(), 1u);
}

TEST_F(PoseCalibrationTest, ARefusalNamesCauseAndRemedyStoresNothingAndCanBeRepeated) {
  Tick();
  mirrored_ = true;
  TickUntilResult();
  EXPECT_FALSE(model_.observed.calibration->result->passed);
  EXPECT_EQ(scene::CalibrationTitle(*model_.observed.calibration), "Refused.");
  EXPECT_THAT(scene::CalibrationDetail(*model_.observed.calibration), HasSubstr("as in a mirror"));
  EXPECT_FALSE(StoredPose());
  mirrored_ = false;
  at_m_ = {0.3, 0.2, 1.1};
  calibration_->Begin();
  Tick();
  EXPECT_FALSE(model_.observed.calibration->result);
  TickUntilResult();
  EXPECT_TRUE(model_.observed.calibration->result->passed)
      << model_.observed.calibration->result->note;
  EXPECT_TRUE(StoredPose());
}

TEST_F(PoseCalibrationTest, WithoutTicksItWaitsAndEndedItsScreenGoesAway) {
  calibration_->Advance(model_, [](const v1::Command&) {});
  ASSERT_TRUE(model_.observed.calibration);
  EXPECT_THAT(scene::CalibrationTitle(*model_.observed.calibration),
              HasSubstr("Waiting for footingd"));
  calibration_->End();
  calibration_->Advance(model_, [](const v1::Command&) {});
  EXPECT_FALSE(model_.observed.calibration);
}

TEST(PoseCalibration, AFileThatIsNoCamerasIsRefusedBeforeAnythingIsShown) {
  EXPECT_FALSE(PoseCalibration::OfOptions("/nowhere/camera.json"));
  const auto none = PoseCalibration::OfOptions("");
  EXPECT_TRUE(none && !*none);
}

}  // namespace
}  // namespace footing::view
