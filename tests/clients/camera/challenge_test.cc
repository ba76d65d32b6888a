// Whether a light is a controller's sphere: the states, then rendered frames with a lamp of its
// colour.
#include "clients/camera/light_checks.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <functional>
#include <utility>

#include "common/virtual/camera/render.h"

namespace footing::camera {
namespace {

namespace rendered = virtual_camera;
using Step = Challenge::Step;

constexpr std::int64_t kFrameNs = 50'000'000;

sphere::Estimate At(double x_m, double confidence = 0.9) {
  sphere::Estimate seen;
  seen.p_C_m = {x_m, 0, 2};
  seen.centre_px = {320 + 270 * x_m, 240};
  seen.radius_px = 6;
  seen.confidence = confidence;
  return seen;
}

bool IsLeftOut(const Challenge& challenge, const sphere::Estimate& seen) {
  for (const sphere::Circle& place : challenge.refused())
    if ((seen.centre_px - place.centre_px).norm() < place.radius_px) return true;
  return false;
}

/// Estimates of the finder for a sphere and a lamp, the lamp first.
struct Picture {
  std::optional<sphere::Estimate> lamp = {}, sphere = {};
  bool follows = true;  ///< The sphere's light does what it should.

  std::optional<sphere::Estimate> Seen(const Challenge& challenge) const {
    if (lamp && !IsLeftOut(challenge, *lamp)) return lamp;
    const bool is_lit = !challenge.is_dark() || !follows;
    if (sphere && is_lit && !IsLeftOut(challenge, *sphere)) return sphere;
    return std::nullopt;
  }
};

/// Frames with a light that is set at once. Returns the time of the next one.
std::int64_t Play(Challenge& challenge, std::int64_t from_ns, int frames, const Picture& picture) {
  for (int i = 0; i < frames; ++i, from_ns += kFrameNs) {
    const int switches = challenge.switches();
    challenge.Take(picture.Seen(challenge), from_ns);
    if (challenge.switches() != switches) challenge.LightIsSet(from_ns);
  }
  return from_ns;
}

TEST(Challenge, EndsAsTheLightSays) {
  struct Row {
    const char* name;
    Picture picture;
    Step end;
    int passed, refusals, switches;
  };
  const Row kRows[] = {
      {"nothing", {}, Step::kIdle, 0, 0, 0},
      {"too faint to be sent", {{}, At(0, 0.03)}, Step::kIdle, 0, 0, 0},
      {"a sphere", {{}, At(0)}, Step::kAccepted, 1, 0, 2},
      {"a lamp", {At(0.5), {}}, Step::kIdle, 0, 1, 2},
      {"a lamp and a sphere", {At(0.5), At(0)}, Step::kAccepted, 1, 1, 2},
      {"a light that does not follow", {{}, At(0), false}, Step::kIdle, 0, 1, 2},
  };
  for (const Row& row : kRows) {
    Challenge challenge;
    Play(challenge, 0, 100, row.picture);
    EXPECT_EQ(challenge.step(), row.end) << row.name;
    EXPECT_EQ(challenge.passed(), row.passed) << row.name;
    EXPECT_EQ(challenge.refusals(), row.refusals) << row.name;
    EXPECT_EQ(challenge.switches(), row.switches) << row.name;
    EXPECT_FALSE(challenge.is_dark()) << row.name;
  }
}

TEST(Challenge, ASphereThatWasHiddenForAMomentIsNotCheckedAgain) {
  Challenge challenge;
  std::int64_t now_ns = Play(challenge, 0, 100, {{}, At(0)});
  now_ns = Play(challenge, now_ns, 10, {});  // Half a second.
  Play(challenge, now_ns, 1, {{}, At(0.3)});
  EXPECT_TRUE(challenge.accepts());
  EXPECT_EQ(challenge.passed(), 1);
  EXPECT_EQ(challenge.switches(), 2);
}

TEST(Challenge, ASphereThatWasGoneIsCheckedAgain) {
  Challenge challenge;
  std::int64_t now_ns = Play(challenge, 0, 100, {{}, At(0)});
  now_ns = Play(challenge, now_ns, 25, {});
  now_ns = Play(challenge, now_ns, 1, {{}, At(0)});
  EXPECT_FALSE(challenge.accepts());
  Play(challenge, now_ns, 100, {{}, At(0)});
  EXPECT_EQ(challenge.passed(), 2);
}

TEST(Challenge, AJumpThatNoHandMakesIsNotAccepted) {
  Challenge challenge;
  std::int64_t now_ns = Play(challenge, 0, 100, {{}, At(-0.5)});
  ASSERT_TRUE(challenge.accepts());
  // 1.2 m in 50 ms; a lamp that is switched on covers the sphere for the finder.
  now_ns = Play(challenge, now_ns, 1, {At(0.7), At(-0.5)});
  EXPECT_FALSE(challenge.accepts());
  Play(challenge, now_ns, 100, {At(0.7), At(-0.5)});
  EXPECT_TRUE(challenge.accepts());
  EXPECT_EQ(challenge.refusals(), 1);
}

TEST(Challenge, ALightThatFollowsLateIsNotRefused) {
  Challenge challenge;
  std::int64_t now_ns = Play(challenge, 0, 2, {{}, At(0)});
  ASSERT_TRUE(challenge.is_dark());
  now_ns = Play(challenge, now_ns, 20, {{}, At(0), false});  // One second.
  Play(challenge, now_ns, 60, {{}, At(0)});
  EXPECT_TRUE(challenge.accepts());
  EXPECT_EQ(challenge.refusals(), 0);
}

TEST(Challenge, WithoutAnAnswerNothingIsChecked) {
  Challenge challenge;
  for (int i = 0; i < 120; ++i) challenge.Take(At(0), i * kFrameNs);
  EXPECT_TRUE(challenge.accepts());
  EXPECT_FALSE(challenge.is_dark());
}

TEST(Challenge, ARefusedPlaceIsFreeAgainAfterAMinute) {
  Challenge challenge;
  const std::int64_t now_ns = Play(challenge, 0, 100, {At(0.5), {}});
  ASSERT_EQ(challenge.refused().size(), 1u);
  Play(challenge, now_ns + 61'000'000'000, 1, {});
  EXPECT_TRUE(challenge.refused().empty());
}

/// A controller before a camera of eight frames a second, and a lamp of its colour nearer by. The
/// light follows 0.25 s after it was set.
class WorldWithALamp {
 public:
  WorldWithALamp() {
    scene_.balls.resize(2);
    scene_.balls[0].p_C_m = {-0.3, 0.1, 2.2};
    scene_.balls[1].p_C_m = {0.3, -0.1, 1};
    camera_.spheres.resize(1);
    camera_.spheres[0].role = stream::DeviceRole::kLeftHand;
    camera_.spheres[0].led_rgb = 0xff00c8;
    stream::DeviceStatus move;
    move.device = 5;
    move.role = stream::DeviceRole::kLeftHand;
    moves_ = {move};
  }

  /// Estimates that are sent for each frame.
  std::vector<std::optional<sphere::Estimate>> Run(bool challenges, int frames) {
    constexpr std::int64_t kSlowFrameNs = 120'000'000, kLateNs = 250'000'000;
    std::int64_t now_ns = 0, follows_ns = 0;
    std::uint32_t lit = 0, wanted = 0;
    checks_.emplace(
        camera_, challenges,
        [&](std::uint32_t device, std::uint32_t rgb, const LightChecks::Done& done) {
          EXPECT_EQ(device, 5u);
          if (std::exchange(wanted, rgb) != rgb) follows_ns = now_ns + kLateNs;
          moves_[0].sphere_rgb = rgb;
          done({});
        },
        [&] { return now_ns; });
    sphere::Finder finder(sphere::Lens(), camera_.Targets(), sphere::Settings());
    std::vector<std::optional<sphere::Estimate>> sent;
    for (int i = 0; i < frames; ++i, now_ns += kSlowFrameNs) {
      checks_->TakeMoves(moves_);
      if (now_ns >= follows_ns) lit = wanted;
      const bool is_lit = lit != 0;
      scene_.balls[0].colour_dn = is_lit ? rendered::Ball().colour_dn : Eigen::Vector3d(14, 13, 15);
      const auto image = rendered::Render(scene_, random_);
      auto found = finder.Find({sphere::PixelFormat::kSgrbg8, 640, 480, image.bytes});
      checks_->TakeFrame(now_ns, finder, found);
      sent.push_back(found[0]);
    }
    return sent;
  }

  bool IsOf(const sphere::Estimate& seen, std::size_t ball) const {
    return (seen.p_C_m - scene_.balls[ball].p_C_m).norm() < 0.05;
  }

  std::optional<LightChecks> checks_;

 private:
  frames::CameraFile camera_;
  rendered::Scene scene_;
  std::vector<stream::DeviceStatus> moves_;
  noise::Random random_{3};
};

TEST(LightChecks, OfALampAndASphereOfOneColourTheSphereIsSent) {
  WorldWithALamp world;
  int of_the_sphere = 0;
  for (const auto& one : world.Run(true, 30)) {
    if (!one) continue;
    EXPECT_TRUE(world.IsOf(*one, 0)) << one->p_C_m.transpose();
    ++of_the_sphere;
  }
  // The lamp is refused after 1.4 s, the sphere accepted 0.4 s later, and some frames.
  EXPECT_GT(of_the_sphere, 8);
  EXPECT_EQ(world.checks_->passed(), 1);
  EXPECT_EQ(world.checks_->refusals(), 1);
}

TEST(LightChecks, WithoutChallengesTheLampIsTaken) {
  WorldWithALamp world;
  for (const auto& one : world.Run(false, 3)) {
    ASSERT_TRUE(one);
    EXPECT_TRUE(world.IsOf(*one, 1)) << one->p_C_m.transpose();
  }
}

}  // namespace
}  // namespace footing::camera
