// The finder against the methods of other trackers, in the same rendered frames.
//
// FOOTING_PEER_FRAMES=100 compares that many frames at seven distances and prints the table of
// docs/evaluation/camera.md; otherwise two frames at three distances.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <iostream>
#include <numbers>
#include <string>
#include <vector>

#include "common/camera/find.h"
#include "common/virtual/camera/render.h"
#include "common/virtual/camera/scene.h"
#include "tests/common/camera/rendered.h"
#include "tests/common/sphere_peers/peers.h"

namespace footing::sphere_peers {
namespace {

namespace camera = virtual_camera;

/// Root mean square errors, mm.
class Errors {
 public:
  void Add(const std::optional<Eigen::Vector3d>& found_m, const Eigen::Vector3d& truth_m) {
    if (!found_m) return;
    const Eigen::Vector3d error = 1000 * (*found_m - truth_m), along = truth_m.normalized();
    const double depth = error.dot(along);
    depth2_ += depth * depth;
    lateral2_ += (error - depth * along).squaredNorm();
    ++found_;
  }
  double lateral() const { return std::sqrt(lateral2_ / std::max(1, found_)); }
  double depth() const { return std::sqrt(depth2_ / std::max(1, found_)); }
  int found() const { return found_; }

 private:
  double lateral2_ = 0, depth2_ = 0;
  int found_ = 0;
};

struct Cell {
  std::string condition;
  double distance_m = 2;
};

camera::Scene SceneOf(const Cell& cell, noise::Random& random) {
  camera::Scene scene;
  scene.balls.resize(1);
  scene.balls[0].p_C_m = camera::PlaceInView(scene.lens, cell.distance_m, 0.8, random);
  const double angle = random.Uniform(0, 2 * std::numbers::pi);
  if (cell.condition == "moving")
    scene.balls[0].v_C_mps = {2 * std::cos(angle), 2 * std::sin(angle), 0.3};
  const double hidden = cell.condition == "quarter_hidden" ? 0.25
                        : cell.condition == "half_hidden"  ? 0.5
                                                           : 0;
  if (hidden > 0) scene.occluders = {camera::Hide(scene, scene.balls[0], hidden, random)};
  return scene;
}

/// Ours, the hull's cone, the enclosing circle.
std::array<Errors, 3> Compare(const Cell& cell, int frames) {
  noise::Random random(4001 + static_cast<std::uint64_t>(10 * cell.distance_m));
  sphere::Finder finder(sphere::Lens(), {sphere::Target()}, sphere::Settings());
  std::array<Errors, 3> errors;
  for (int i = 0; i < frames; ++i) {
    const camera::Scene scene = SceneOf(cell, random);
    const camera::Mosaic mosaic = camera::Render(scene, random);
    const Eigen::Vector3d truth = camera::Truth(scene, scene.balls[0])->p_C_m;
    finder.Forget();
    const auto found = finder.Find(sphere::View(mosaic)).front();
    errors[0].Add(found ? std::optional(found->p_C_m) : std::nullopt, truth);
    errors[1].Add(HullCone(mosaic, Setup()), truth);
    errors[2].Add(EnclosingCircle(mosaic, Setup()), truth);
  }
  return errors;
}

TEST(SpherePeers, OursIsBetterInEveryCell) {
  const char* const wanted = std::getenv("FOOTING_PEER_FRAMES");
  const int frames = wanted != nullptr ? std::max(1, std::atoi(wanted)) : 2;
  const std::vector<double> distances = wanted != nullptr
                                            ? std::vector<double>{0.5, 1, 1.5, 2, 2.5, 3, 4}
                                            : std::vector<double>{1, 2, 3};
  std::cout << "condition,distance_m,frames,method,found,lateral_rms_mm,depth_rms_mm\n";
  for (const char* const condition : {"nominal", "quarter_hidden", "half_hidden", "moving"}) {
    for (const double distance_m : distances) {
      const auto errors = Compare({condition, distance_m}, frames);
      const char* const names[] = {"ours", "hull_cone", "enclosing_circle"};
      for (std::size_t i = 0; i < 3; ++i) {
        std::cout << condition << ',' << distance_m << ',' << frames << ',' << names[i] << ','
                  << errors[i].found() << ',' << std::setprecision(3) << errors[i].lateral() << ','
                  << errors[i].depth() << '\n';
        if (i == 0) continue;
        EXPECT_LT(errors[0].lateral(), errors[i].lateral()) << condition << " " << distance_m;
        EXPECT_LT(errors[0].depth(), errors[i].depth()) << condition << " " << distance_m;
        EXPECT_GE(errors[0].found(), errors[i].found()) << condition << " " << distance_m;
      }
    }
  }
}

}  // namespace
}  // namespace footing::sphere_peers
