#include "daemon/offline/eval/offline.h"

#include "daemon/offline/analysis/contact_score.h"
#include "daemon/offline/analysis/pose_metrics.h"
#include "daemon/simulation/momentum/best_estimator.h"

namespace footing::eval {

using nlohmann::ordered_json;

ordered_json OfflineJson(const MomentumScene& scene, const momentum::TPose& pose, std::size_t start,
                         std::size_t judged) {
  const double step_s = 1 / scene.rate_hz;
  std::vector<momentum::VerticalInput> vertical;
  for (std::size_t i = start; i < scene.frames.size(); ++i)
    vertical.push_back(momentum::ToVerticalInput(scene.frames[i].loads, kContactN));
  const auto height = momentum::SmoothVertical(
      momentum::DoubtfulVertical(scene.subject.arms_hang_m, pose.cell_noise_n), pose.mass_kg,
      step_s, pose.mean_loads, vertical);
  const std::array<momentum::HorizontalPrior, 2> priors{momentum::ForwardPrior(),
                                                        momentum::LateralPrior()};
  ordered_json out;
  Spread z;
  for (std::size_t i = judged - start; i < height.size(); ++i)
    z.Add(100 * (height[i].mean + scene.subject.com_height_m - scene.frames[start + i].com_m.z()));
  out["com_vertical_rms_cm"] = z.rms();
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<momentum::HorizontalInput> inputs;
    for (std::size_t i = 0; i < vertical.size(); ++i) {
      momentum::HorizontalInput input;
      input.cop_valid = vertical[i].cop_valid;
      input.cop_m = vertical[i].cop_m(axis);
      for (const double load : vertical[i].load_n) input.load_n += load;
      input.com_height_m = scene.subject.com_height_m + height[i].mean;
      input.centre_m = pose.cop_m(axis);
      inputs.push_back(input);
    }
    const auto smooth = momentum::SmoothHorizontal(priors[static_cast<std::size_t>(axis)],
                                                   pose.mass_kg, step_s, pose.cop_m(axis), inputs);
    Spread rms;
    for (std::size_t i = judged - start; i < smooth.size(); ++i)
      rms.Add(100 * (smooth[i].mean - scene.frames[start + i].com_m(axis)));
    out[axis == 0 ? "com_forward_rms_cm" : "com_lateral_rms_cm"] = rms.rms();
  }
  return out;
}

}  // namespace footing::eval
