#include "daemon/offline/eval/calibration.h"

#include <cmath>
#include <iostream>
#include <memory>
#include <optional>

#include <Eigen/Dense>
#include <nlohmann/json.hpp>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/board/layout.h"
#include "common/camera/camera_pose.h"
#include "common/camera/find.h"
#include "common/runtime/clock.h"
#include "common/virtual/camera/render.h"
#include "common/virtual/devices/noise.h"
#include "daemon/offline/eval/report.h"
#include "daemon/offline/eval/sphere.h"

namespace footing::eval {
namespace {

using Eigen::Vector3d;
using nlohmann::ordered_json;

const Vector3d kHand(0, 0, 1.2);
/// From the tail of a PS Move to the middle of its sphere. The fit does not use it.
constexpr double kControllerM = 0.178;
/// How far from upright a person holds a controller that shows its own inclination, and what a PS
/// Move's calibrated accelerometer is off.
constexpr double kUprightSdRad = DegreesToRadians(0.5);
constexpr double kHeightM = 1.75;  // Height of who holds the poses.
constexpr double kRaisedM = 0.45;  // How much higher a camera looks that has to see the arms.

Vector3d Scatter(double sd, noise::Random& random) {
  return sd * Vector3d(random.Normal(), random.Normal(), random.Normal());
}

/// In front of the person, at about a table's height, and nearly level. It looks at the boards, or
/// `raised_m` above them at a person whose hands it has to see.
Eigen::Isometry3d PlaceCamera(double distance_m, double raised_m, noise::Random& random) {
  const double bearing = DegreesToRadians(random.Uniform(-20, 20));
  const Vector3d place(distance_m * std::cos(bearing), distance_m * std::sin(bearing),
                       random.Uniform(0.8, 1.4));
  const Vector3d target(random.Uniform(-0.1, 0.1), random.Uniform(-0.1, 0.1),
                        raised_m + random.Uniform(0.55, 0.75));
  const Vector3d forward = (target - place).normalized();
  const Vector3d right = forward.cross(Vector3d::UnitZ()).normalized();
  Eigen::Isometry3d X_WC = Eigen::Isometry3d::Identity();
  X_WC.linear() << right, forward.cross(right), forward;
  X_WC.linear() =
      X_WC.linear() *
      Eigen::AngleAxisd(DegreesToRadians(3 * random.Normal()), Vector3d::UnitZ()).matrix();
  X_WC.translation() = place;
  return X_WC;
}

/// Makes the camera see only the part of its image around the ball, which takes a tenth of the
/// time.
bool CutOut(virtual_camera::Scene& scene) {
  constexpr int kSidePx = 160;
  const Eigen::Vector2d at = virtual_camera::Project(scene.lens, scene.balls[0].p_C_m);
  // Even, so that the mosaic's colours stay where they were.
  const int u0 = 2 * static_cast<int>((at.x() - kSidePx / 2) / 2);
  const int v0 = 2 * static_cast<int>((at.y() - kSidePx / 2) / 2);
  virtual_camera::Lens& lens = scene.lens;
  if (at.x() < 0 || at.y() < 0 || at.x() > lens.width || at.y() > lens.height) return false;
  lens.width = lens.height = kSidePx;
  lens.cx_px -= u0;
  lens.cy_px -= v0;
  return true;
}

/// A person with a sphere in front of a rendered camera.
class Person {
 public:
  Person(const CalibrationTrial& trial, const frames::CameraFile& file, noise::Random& random)
      : trial_(trial),
        random_(random),
        X_WC_(PlaceCamera(trial.distance_m, trial.method == "poses" ? kRaisedM : 0, random)),
        radius_m_(file.spheres[0].target.radius_m),
        file_(file) {}

  const Eigen::Isometry3d& X_WC() const { return X_WC_; }

  /// The camera's measurement of the sphere held still at a place.
  Result<camera_pose::SeenPoint> Hold(const Vector3d& p_W_m) {
    virtual_camera::Scene scene;
    virtual_camera::Ball ball;
    ball.radius_m = radius_m_;
    ball.p_C_m = X_WC_.inverse() * p_W_m;
    scene.balls = {ball};
    if (!CutOut(scene)) return InvalidData("the sphere is not in the image");
    sphere::Lens lens = file_.lens;
    lens.width = scene.lens.width;
    lens.height = scene.lens.height;
    lens.cx_px = scene.lens.cx_px;
    lens.cy_px = scene.lens.cy_px;
    sphere::Finder finder(lens, {file_.spheres[0].target}, file_.settings);
    std::vector<camera_pose::SeenPoint> frames;
    for (const auto& mosaic : virtual_camera::RenderStill(scene, trial_.frames, random_)) {
      const auto found =
          finder.Find({sphere::PixelFormat::kSgrbg8, mosaic.width, mosaic.height, mosaic.bytes});
      if (found[0]) frames.push_back({found[0]->p_C_m, found[0]->covariance_m2});
    }
    return camera_pose::MeanAtRest(frames);
  }

  Result<camera_pose::CameraPose> CalibrateByMarks() {
    const auto layout = *board::LayoutNamed(trial_.boards == 1 ? "single" : "one_foot_each", 20);
    camera_pose::Observations observations;
    observations.placement_sd_m = trial_.placement_sd_m;
    const auto marks = camera_pose::BoardMarks(layout, radius_m_);
    for (std::size_t i = 0; i < marks.size(); ++i) {
      const Vector3d place = marks[i].p_W_m + Scatter(trial_.placement_sd_m, random_);
      const auto seen = Hold(place);
      if (!seen) return seen.error();
      observations.marks.push_back({marks[i], *seen});
      if (trial_.method != "gravity" || i % 4 != 0) continue;
      const auto plumb = StandUpright(marks[i].p_W_m, *seen);
      if (!plumb) return plumb.error();
      observations.plumbs.push_back(*plumb);
    }
    return camera_pose::Calibrate(observations);
  }

  Result<camera_pose::CameraPose> CalibrateByPoses() {
    camera_pose::Observations observations;
    observations.in_poses = true;
    observations.placement_sd_m = trial_.placement_sd_m;
    // A person who differs from the expected one.
    Eigen::Matrix<double, camera_pose::kBodyMeasures, 1> body;
    for (double& measure : body) measure = random_.Normal();
    for (const auto& mark : camera_pose::PoseMarks(kHeightM, camera_pose::kFistToSphereM)) {
      const auto seen =
          Hold(mark.p_W_m + mark.per_sd * body + Scatter(trial_.placement_sd_m, random_));
      if (!seen) return seen.error();
      observations.marks.push_back({mark, *seen});
    }
    return camera_pose::Calibrate(observations);
  }

 private:
  Result<camera_pose::SeenPlumb> StandUpright(const Vector3d& mark_W_m,
                                              const camera_pose::SeenPoint& low) {
    const Vector3d lean(kControllerM * kUprightSdRad * random_.Normal(),
                        kControllerM * kUprightSdRad * random_.Normal(), kControllerM - radius_m_);
    const auto high = Hold(mark_W_m + lean + Scatter(trial_.placement_sd_m, random_));
    if (!high) return high.error();
    return camera_pose::SeenPlumb{low, *high, std::sqrt(2.0) * kUprightSdRad};
  }

  const CalibrationTrial& trial_;
  noise::Random& random_;
  const Eigen::Isometry3d X_WC_;
  const double radius_m_;
  const frames::CameraFile& file_;
};

/// Errors of many calibrations.
struct Errors {
  std::vector<double> turn_deg, hand_mm;
  double nees = 0, misfit = 0, residual_mm = 0;
  std::string refusal;

  void Add(const camera_pose::CameraPose& pose, const Eigen::Isometry3d& X_WC) {
    const Eigen::Isometry3d change = pose.X_WC * X_WC.inverse();
    turn_deg.push_back(RadiansToDegrees(Eigen::AngleAxisd(change.rotation()).angle()));
    const Vector3d error = change * kHand - kHand;
    hand_mm.push_back(1e3 * error.norm());
    nees += error.dot(pose.CovarianceAt(kHand).ldlt().solve(error)) / 3;
    misfit += pose.misfit;
    residual_mm += 1e3 * pose.residual_rms_m;
  }
};

}  // namespace

const std::vector<std::string>& CalibrationMethods() {
  static const std::vector<std::string> kMethods = {"marks", "gravity", "poses"};
  return kMethods;
}

Result<ordered_json> RunCalibrationTrial(const CalibrationTrial& trial,
                                         const std::function<void(int done)>& on_done) {
  noise::Random random(trial.seed);
  Errors errors;
  for (int i = 0; i < trial.trials; ++i) {
    // Each its own: what is wrong with a camera's blur is common to all that it sees.
    const auto file = CalibratedCamera("nominal", trial.seed * 1000 + static_cast<unsigned>(i));
    if (!file) return file.error();
    Person person(trial, *file, random);
    const auto pose =
        trial.method == "poses" ? person.CalibrateByPoses() : person.CalibrateByMarks();
    if (pose) {
      errors.Add(*pose, person.X_WC());
    } else if (errors.refusal.empty()) {
      errors.refusal = pose.error().message;
    }
    on_done(i + 1);
  }
  const double count = std::max<double>(1, static_cast<double>(errors.turn_deg.size()));
  ordered_json row = {{"method", trial.method},
                      {"boards", trial.method == "poses" ? 0 : trial.boards},
                      {"distance_m", trial.distance_m},
                      {"placement_sd_m", trial.placement_sd_m},
                      {"trials", trial.trials},
                      {"refused", trial.trials - static_cast<int>(errors.turn_deg.size())},
                      {"turn_p50_deg", text::Quantile(errors.turn_deg, 0.5)},
                      {"turn_p95_deg", text::Quantile(errors.turn_deg, 0.95)},
                      {"hand_p50_mm", text::Quantile(errors.hand_mm, 0.5)},
                      {"hand_p95_mm", text::Quantile(errors.hand_mm, 0.95)},
                      {"residual_rms_mm", errors.residual_mm / count},
                      {"misfit", errors.misfit / count},
                      {"nees", errors.nees / count}};
  if (!errors.refusal.empty()) row["first_refusal"] = errors.refusal;
  return row;
}

void AddCalibrationCommand(CLI::App& app, Shared& shared) {
  auto* command = app.add_subcommand(
      "calibration", "Errors of a camera's calibration on rendered frames, over random places");
  const auto trial = std::make_shared<CalibrationTrial>();
  command
      ->add_option("--method", trial->method,
                   "marks of the boards, marks and gravity, or poses: three, with both hands")
      ->check(CLI::IsMember(CalibrationMethods()));
  command->add_option("--boards", trial->boards, "Boards with marks (default 2)")
      ->check(CLI::Range(1, 2));
  const auto* placement =
      command
          ->add_option("--placement-sd-m", trial->placement_sd_m,
                       "Standard deviation of the sphere's place on a mark, m, per axis (default "
                       "0.001; poses: 0.025)")
          ->check(CLI::Range(0.0001, 0.1));
  command
      ->add_option("--distance-m", trial->distance_m,
                   "From the camera to the origin along the floor, m (default 2)")
      ->check(CLI::Range(1.0, 4.0));
  command->add_option("--frames", trial->frames, "Frames per mark (default 30)")
      ->check(CLI::Range(30, 1000));
  command->add_option("--trials", trial->trials, "Calibrations (default 20)")
      ->check(CLI::Range(1, 100000));
  command->add_option("--seed", trial->seed, "Seed of places and noise");
  command->callback([trial, placement, &shared] {
    if (trial->method == "poses" && placement->count() == 0)
      trial->placement_sd_m = camera_pose::kPoseSdM;
    Progress progress("calibration", "trials", trial->trials, clock::MonotonicNs());
    const auto on_done = [&](int done) { progress.Done(done, clock::MonotonicNs(), std::cerr); };
    shared.exit_code = PrintResult(RunCalibrationTrial(*trial, on_done), shared.json);
  });
}

}  // namespace footing::eval
