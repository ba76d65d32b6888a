#include "common/guide/camera_step.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "common/base/units.h"
#include "common/board/layout.h"
#include "common/camera/camera_pose.h"
#include "common/guide/set_up.h"
#include "tests/common/camera/boards.h"

namespace footing::guide {
namespace {

using Eigen::Vector3d;
using testing::ElementsAre;
using testing::HasSubstr;

const Eigen::Isometry3d kTrue = camera_pose::LookingAtTheBoards({2.1, 0.4, 1.3});

/// Somebody with a PS Move who brings its sphere wherever the prompt says, in half a second, in
/// front of a camera that is not calibrated, at 60 Hz.
class Holder {
 public:
  virtual ~Holder() = default;
  Holder() {
    options.camera_file = "eye.json";
    options.camera_role = stream::DeviceRole::kLeftHand;
    options.camera_radius_m = camera_pose::kRadiusM;
    options.patience_s = 20;
    options.tries = 1;
    for (const auto& mark : camera_pose::BoardMarks(board::DefaultLayout(), camera_pose::kRadiusM))
      marks_.push_back(mark);
  }

  void HoldAMove() {
    stream::DeviceStatus status;
    status.device = 9;
    status.kind = stream::DeviceKind::kPsMove;
    status.state = stream::DeviceState::kLive;
    status.role = stream::DeviceRole::kLeftHand;
    status.rig = "main";
    recent_.SetDevices({status});
  }

  std::vector<stream::SetupItem> Do() {
    SetUp set_up(options, {Item::kCamera});
    for (int i = 0; i < 60 * 300; ++i) {
      now_ns_ += SecondsToNanoseconds(1.0 / 60);
      See();
      Situation now;
      now.now_ns = now_ns_;
      now.recent = &recent_;
      now.setup = &setup_;
      now.answers = std::exchange(answers_, {});
      const Progress progress = set_up.Advance(now);
      if (progress.marks) shown.push_back(*progress.marks);
      feedback = progress.feedback.empty() ? feedback : progress.feedback;
      Hear(progress.prompt);
      for (const Action& action : progress.actions) {
        stored.push_back(action);
        answers_.push_back({action.key, true, action.remark, 0, ""});
      }
      if (progress.finished) return set_up.results();
    }
    ADD_FAILURE() << "the step did not end; it asked: " << heard_;
    return {};
  }

  SetUpOptions options;
  bool mirrored = false;  ///< The camera mirrors its image.
  bool deaf = false;      ///< Never moves the sphere.
  std::string lazy;       ///< Stays where it is when asked for this mark.
  std::string feedback;   ///< The last one.
  std::vector<Action> stored;
  std::vector<std::string> prompts;
  std::vector<MarksState> shown;

 private:
  virtual void Hear(const std::string& prompt) {
    if (prompt == heard_ || prompt.empty()) return;
    heard_ = prompt;
    heard_ns_ = now_ns_;
    prompts.push_back(prompt);
    from_ = to_;
    for (const auto& mark : marks_) {
      if (prompt.find(mark.name) == std::string::npos || deaf) continue;
      if (!lazy.empty() && mark.name == lazy) continue;
      const bool is_upright = prompt.find("sphere up") != std::string::npos;
      to_ = mark.p_W_m + Vector3d(0, 0, is_upright ? 0.16 : 0);
    }
  }

  virtual void See() {
    const double share = std::min(1.0, 2 * NanosecondsToSeconds(now_ns_ - heard_ns_));
    See(stream::DeviceRole::kLeftHand, from_ + share * (to_ - from_));
    stream::MotionSample motion;
    motion.device = 9;
    motion.received_ns = now_ns_ - 1;
    motion.specific_force_mps2 = {0, 9.8, 0.1};
    recent_.Add(motion);
  }

 protected:
  void See(stream::DeviceRole role, const Vector3d& place) {
    const auto at = camera_pose::SeenAt(kTrue, place);
    const Eigen::LLT<Eigen::Matrix3d> root(at.covariance_m2);
    const Vector3d noise = root.matrixL() * camera_pose::Normal3(random_);
    stream::HandSample sample;
    sample.rig = "main";
    sample.role = role;
    sample.received_ns = sample.sampled_ns = now_ns_ - 1;
    sample.position_m = at.p_C_m + noise;
    sample.sd_m = at.covariance_m2.diagonal().cwiseSqrt();
    sample.covariance_m2 = {at.covariance_m2(0, 1), at.covariance_m2(0, 2), at.covariance_m2(1, 2)};
    if (mirrored) {
      sample.position_m.x() *= -1;
      sample.covariance_m2.head<2>() *= -1;  // Covariances of x with y and with z.
    }
    sample.confidence = 0.9;
    sample.tracker_pose = stream::TrackerPose{};
    recent_.Add(sample);
  }

  std::vector<camera_pose::Mark> marks_;
  std::int64_t now_ns_ = 100'000'000'000, heard_ns_ = 0;
  Vector3d from_{0.3, 0.2, 1.1}, to_{0.3, 0.2, 1.1};
  std::string heard_;
  Recent recent_;
  std::vector<stream::RigSetup> setup_;
  std::vector<Answer> answers_;
  noise::Random random_{3};
};

/// Somebody who stands on two boards and holds what is asked for, with both spheres, trembling.
class Poser final : public Holder {
 public:
  Poser() {
    options.poses_height_m = 1.74;
    std::vector<stream::DeviceStatus> boards(2);
    for (std::uint32_t i = 0; i < 2; ++i) {
      boards[i].device = i + 1;
      boards[i].kind = stream::DeviceKind::kBalanceBoard;
      boards[i].state = stream::DeviceState::kLive;
      boards[i].role = i == 0 ? stream::DeviceRole::kLeftBoard : stream::DeviceRole::kRightBoard;
      boards[i].rig = "main";
    }
    recent_.SetDevices(boards);
    poses_ = camera_pose::PoseMarks(1.74, camera_pose::kFistToSphereM);
  }

  bool exchanged = false;          ///< Each controller is in the other hand.
  bool stands = true;              ///< On the boards.
  double moving_m = 0;             ///< How far the left hand goes to and fro.
  int every = 1;                   ///< Frames of 60 a second from one that is seen to the next.
  std::vector<int> right_holds{};  ///< The right hand's pose in each one; empty: as asked.

 private:
  void Hear(const std::string& prompt) override {
    if (prompt == heard_ || prompt.empty()) return;
    heard_ = prompt;
    prompts.push_back(prompt);
    pose_ = prompt.find("ahead") != std::string::npos   ? 1
            : prompt.find("sides") != std::string::npos ? 2
                                                        : 0;
  }
  void See() override {
    const std::size_t right_pose =
        right_holds.empty() ? pose_ : static_cast<std::size_t>(right_holds[pose_]);
    // Over the middle of the feet, 3 cm ahead of the origin.
    const Vector3d over(0.03, 0, 0);
    const double moved_m = moving_m * std::sin(3 * NanosecondsToSeconds(now_ns_));
    const Vector3d left = poses_[2 * pose_].p_W_m + over + Vector3d(0, moved_m, 0) + Trembling();
    const Vector3d right = poses_[2 * right_pose + 1].p_W_m + over + Trembling();
    if (frame_++ % every == 0) {
      Holder::See(stream::DeviceRole::kLeftHand, exchanged ? right : left);
      Holder::See(stream::DeviceRole::kRightHand, exchanged ? left : right);
    }
    for (std::uint32_t i = 0; i < 2; ++i) {
      stream::BoardSample board;
      board.device = i + 1;
      board.received_ns = now_ns_ - 1;
      board.total_n = stands ? 340 : 2;
      board.cop_valid = stands;
      // 3 cm ahead of the plate's middle; in its frame x is to the right and y to the front.
      const auto layout = board::DefaultLayout();
      const double yaw_rad = i == 0 ? layout.left.yaw_rad : layout.right.yaw_rad;
      const Eigen::Vector2d ahead = Eigen::Rotation2Dd(-yaw_rad) * Eigen::Vector2d(0.03, 0);
      board.cop_x_m = -ahead.y();
      board.cop_y_m = ahead.x();
      recent_.Add(board);
    }
  }
  Vector3d Trembling() { return 0.003 * camera_pose::Normal3(random_); }

  std::vector<camera_pose::Mark> poses_;
  std::size_t pose_ = 0;
  int frame_ = 0;
};

double TurnDeg(const Eigen::Isometry3d& X_WC) {
  return Eigen::AngleAxisd((X_WC * kTrue.inverse()).rotation()).angle() * 180 / kPi;
}

TEST(CameraStep, LeadsOverAllMarksToAStoredPose) {
  Holder holder;
  const auto results = holder.Do();
  ASSERT_EQ(results.size(), 1u);
  EXPECT_TRUE(results[0].passed) << results[0].note;
  EXPECT_EQ(results[0].name, "camera");
  EXPECT_THAT(results[0].note, HasSubstr("8 marks, residual"));
  ASSERT_EQ(holder.stored.size(), 1u);
  EXPECT_LT(TurnDeg(holder.stored[0].X_WC), 0.3);
  EXPECT_EQ(holder.prompts.size(), 8u);
  EXPECT_EQ(holder.prompts[0],
            "Hold the sphere on the mark at the front left, left board, and keep still.");
}

TEST(CameraStep, TakesGravityFromAMoveThatStandsUpright) {
  Holder holder;
  holder.HoldAMove();
  const auto results = holder.Do();
  ASSERT_EQ(results.size(), 1u);
  EXPECT_TRUE(results[0].passed) << results[0].note;
  EXPECT_THAT(results[0].note, HasSubstr("with gravity"));
  EXPECT_EQ(holder.prompts.size(), 10u);
  EXPECT_THAT(holder.prompts[1], HasSubstr("Stand the controller on the mark"));
}

TEST(CameraStep, ShowsEachMarkAsItStandsAndItsResidualAtTheEnd) {
  Holder holder;
  holder.HoldAMove();
  holder.Do();
  std::size_t done = 0;
  double most_share = 0;
  for (const MarksState& state : holder.shown) {
    ASSERT_EQ(state.marks.size(), 8u);
    EXPECT_EQ(state.all, 10u);  // One upright place for each board.
    EXPECT_TRUE(state.done == done || state.done == done + 1);
    if (state.done != done) {
      EXPECT_GT(most_share, 0.9) << done;  // The rest was seen to grow before.
    }
    most_share = state.done == done ? std::max(most_share, state.rest_share) : 0;
    done = state.done;
    const auto next = std::count_if(state.marks.begin(), state.marks.end(), [](const auto& mark) {
      return mark.stage == MarkState::Stage::kNext;
    });
    EXPECT_EQ(next, done < 10 ? 1 : 0);
    EXPECT_EQ(state.upright, done == 1 || done == 6);
  }
  const MarksState& last = holder.shown.back();
  EXPECT_EQ(last.done, 10u);
  ASSERT_TRUE(last.X_WC);
  EXPECT_LT(TurnDeg(*last.X_WC), 0.3);
  for (const MarkState& mark : last.marks) {
    EXPECT_EQ(mark.stage, MarkState::Stage::kTaken);
    ASSERT_TRUE(mark.residual_m) << mark.name;
    EXPECT_LT(*mark.residual_m, 0.02);
  }
}

TEST(CameraStep, SaysThatTheImageIsMirroredAndStoresNothing) {
  Holder holder;
  holder.mirrored = true;
  const auto results = holder.Do();
  ASSERT_EQ(results.size(), 1u);
  EXPECT_FALSE(results[0].passed);
  EXPECT_THAT(results[0].note, HasSubstr("as in a mirror"));
  EXPECT_TRUE(holder.stored.empty());
}

TEST(CameraStep, DoesNotTakeASphereThatRestsElsewhereForOneOnTheMark) {
  Holder still;
  still.deaf = true;
  const auto results = still.Do();
  EXPECT_FALSE(results.at(0).passed);
  EXPECT_THAT(results[0].note, HasSubstr("bring the sphere to the mark"));
  Holder lazy;
  lazy.lazy = "rear right, left board";
  EXPECT_THAT(lazy.Do().at(0).note,
              HasSubstr("24 cm from the mark at the front left, left board, should be 49 cm"));
}

TEST(CameraStep, LeadsThroughThreePosesToAStoredPose) {
  Poser poser;
  const auto results = poser.Do();
  ASSERT_EQ(results.size(), 1u);
  EXPECT_TRUE(results[0].passed) << results[0].note;
  EXPECT_THAT(results[0].note, HasSubstr("three poses, residual"));
  ASSERT_EQ(poser.prompts.size(), 3u);
  EXPECT_THAT(poser.prompts[1], HasSubstr("both arms straight ahead"));
  ASSERT_EQ(poser.stored.size(), 1u);
  EXPECT_LT(TurnDeg(poser.stored[0].X_WC), 0.5);
  // The person stands 3 cm ahead of the origin, and the boards say so.
  EXPECT_LT((poser.stored[0].X_WC.translation() - kTrue.translation()).norm(), 0.015);
  EXPECT_EQ(poser.shown.back().marks.size(), 6u);
  EXPECT_TRUE(poser.shown.back().marks[5].residual_m);
}

TEST(CameraStep, WaitsForTheFramesOfASlowCamera) {
  Poser poser;
  poser.every = 12;
  const auto results = poser.Do();
  ASSERT_EQ(results.size(), 1u);
  EXPECT_TRUE(results[0].passed) << results[0].note;
  EXPECT_LT(TurnDeg(poser.stored.at(0).X_WC), 0.5);
  Poser moving;
  moving.every = 12;
  moving.moving_m = 0.05;
  EXPECT_THAT(moving.Do().at(0).note, HasSubstr("left hand: the sphere moved by"));
  Poser rare;  // Fewer than 30 frames in ten seconds.
  rare.every = 24;
  EXPECT_THAT(rare.Do().at(0).note, HasSubstr("30 are needed"));
}

TEST(CameraStep, DoesNotTakeAPoseOfAWrongArmOrOfAHandThatMoves) {
  Poser one_arm;
  one_arm.right_holds = {0, 0, 2};  // The right arm hangs on while the left one is ahead.
  const std::string note = one_arm.Do().at(0).note;
  EXPECT_THAT(note, HasSubstr("right hand, arms ahead: "));
  EXPECT_THAT(note, HasSubstr("from the left hand, arms down, should be about"));
  Poser moving;
  moving.moving_m = 0.05;
  EXPECT_THAT(moving.Do().at(0).note, HasSubstr("left hand: the sphere moved by"));
  EXPECT_TRUE(one_arm.stored.empty() && moving.stored.empty());
}

TEST(CameraStep, RefusesPosesWithExchangedControllersOrBesideTheBoards) {
  Poser exchanged;
  exchanged.exchanged = true;
  EXPECT_THAT(exchanged.Do().at(0).note, HasSubstr("each controller is in the other hand"));
  Poser beside;
  beside.stands = false;
  EXPECT_THAT(beside.Do().at(0).note, HasSubstr("nobody stands on the boards"));
  EXPECT_TRUE(exchanged.stored.empty() && beside.stored.empty());
}

TEST(CameraStep, WithoutACameraFileAsksNothing) {
  Holder holder;
  holder.options.camera_file.clear();
  EXPECT_TRUE(holder.Do().empty());
  EXPECT_TRUE(holder.prompts.empty());
}

}  // namespace
}  // namespace footing::guide
