#include "daemon/offline/eval/insoles.h"

#include <algorithm>
#include <cmath>

#include "daemon/offline/analysis/pose_metrics.h"

namespace footing::eval {

using nlohmann::ordered_json;

Result<ordered_json> ScoreInsoles(const pose_run::InsoleRun& run,
                                  const reconstruction::Models& models,
                                  const reconstruction::Options& options) {
  auto made = reconstruction::InsoleWalk::Create(run.body, models, options);
  if (!made) return made.error();
  const auto start = static_cast<std::size_t>(pose_run::kStandS * run.rate_hz);
  constexpr double kContactN = 40;
  PoseScore score(run.body), still(run.body);
  Spread root_cm;
  double both = 0, one = 0, walked_m = 0;
  bool finite = true;
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    const pose_run::InsoleFrame& frame = run.frames[i];
    const reconstruction::Output& output = made->Advance(frame.inputs);
    if (i < start) continue;
    if (!output.calibrated) {
      return InvalidData("the T-pose never stood still on both insoles: no calibration");
    }
    finite = finite && output.q.allFinite();
    score.Add(output.q, frame.q);
    still.Add(models.basis.mean, frame.q);
    root_cm.Add(100 * (output.q - frame.q).head<2>().norm());
    walked_m += (frame.q - run.frames[i - 1].q).head<2>().norm();
    for (std::size_t f = 0; f < momentum::kFeet; ++f) {
      const bool truth = frame.load_n[f] > kContactN;
      both += truth && made->contact(f) ? 1 : 0;
      one += truth != made->contact(f) ? 1 : 0;
    }
  }
  ordered_json json = {{"frames", score.Json().value("frames", run.frames.size() - start)},
                       {"rate_hz", run.rate_hz},
                       {"boards", "insoles"},
                       {"walked_m", walked_m}};
  json.update(score.Json());
  json["root_p50_cm"] = root_cm.Quantile(0.5);
  json["root_p95_cm"] = root_cm.Quantile(0.95);
  json["contact_f1"] = both > 0 ? 2 * both / (2 * both + one) : 0;
  json["finite"] = finite;
  json["baselines"]["mean_pose"]["mpjpe_root_relative_cm"] = still.Json()["mpjpe_root_relative_cm"];
  return json;
}

}  // namespace footing::eval
