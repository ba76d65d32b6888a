#include "daemon/offline/eval/breakdown.h"

#include "common/body/landmarks.h"

namespace footing::eval {
namespace {

using body::Landmark;
using nlohmann::ordered_json;
using pose_run::LegScore;
using pose_run::LiftOffs;

ordered_json LegJson(const LegScore& score) {
  return {
      {"count", score.count()},       {"hip_cm", score.error_cm(0)}, {"knee_cm", score.error_cm(1)},
      {"foot_cm", score.error_cm(2)}, {"hip_sd_cm", score.sd_cm(0)}, {"knee_sd_cm", score.sd_cm(1)},
      {"foot_sd_cm", score.sd_cm(2)}, {"hip_nees", score.nees(0)},   {"knee_nees", score.nees(1)},
      {"foot_nees", score.nees(2)},   {"nees", score.nees()}};
}

}  // namespace

PoseBreakdown::PoseBreakdown(const pose_run::PoseRun& run)
    : run_(run), lift_offs_(1 / run.rate_hz), activities_(run.activities.names.size()) {
  constexpr std::array kLeft{Landmark::kLeftHip, Landmark::kLeftKnee, Landmark::kLeftAnkle};
  for (std::size_t k = 0; k < kLeft.size(); ++k) {
    legs_[0][k] = run.body.landmarks[kLeft[k]];
    legs_[1][k] = run.body.landmarks[body::Mirrored(kLeft[k])];
  }
}

void PoseBreakdown::Add(const reconstruction::Output& estimate, const PoseScore& score,
                        std::size_t i) {
  const pose_run::Frame& frame = run_.frames[i];
  for (std::size_t f = 0; f < legs_.size(); ++f) {
    pose_run::LegError leg;
    for (std::size_t k = 0; k < legs_[f].size(); ++k) {
      const auto joint = static_cast<std::size_t>(legs_[f][k]);
      leg.error_m[k] = score.errors_m()[joint];
      leg.sd_m[k] = estimate.joint_sd_m[joint];
    }
    lift_offs_.Add(f, frame.feet[f].load_n, frame.feet[f].ankle_m, leg);
  }
  if (i >= run_.activities.of_frame.size()) return;
  const int activity = run_.activities.of_frame[i];
  if (activity < 0) return;
  Activity& one = activities_[static_cast<std::size_t>(activity)];
  one.mpjpe_cm.Add(score.last_mpjpe_cm());
  one.com_vertical_cm.Add(100 * (estimate.com_W_m.z() - frame.com_m.z()));
}

ordered_json PoseBreakdown::Json() const {
  ordered_json json;
  json["lift_offs"] = lift_offs_.count();
  json["lift_off"] = ordered_json::array();
  for (std::size_t i = 0; i < LiftOffs::kAfterS.size(); ++i) {
    ordered_json row = {{"after_s", LiftOffs::kAfterS[i]}};
    row.update(LegJson(lift_offs_.after(i)));
    json["lift_off"].push_back(row);
  }
  json["aloft"] = LegJson(lift_offs_.aloft());
  json["kick"] = {{"faster_than_mps", LiftOffs::kKickMps}, {"kicks", lift_offs_.kicks()}};
  json["kick"].update(LegJson(lift_offs_.kick()));
  if (activities_.empty()) return json;
  json["by_activity"] = ordered_json::array();
  for (std::size_t k = 0; k < activities_.size(); ++k) {
    const Activity& one = activities_[k];
    if (one.mpjpe_cm.size() == 0) continue;
    json["by_activity"].push_back({{"activity", run_.activities.names[k]},
                                   {"frames", one.mpjpe_cm.size()},
                                   {"mpjpe_cm", one.mpjpe_cm.mean()},
                                   {"mpjpe_p95_cm", one.mpjpe_cm.Quantile(0.95)},
                                   {"com_vertical_rms_cm", one.com_vertical_cm.rms()}});
  }
  return json;
}

}  // namespace footing::eval
