#include "daemon/offline/learning/recorded_session.h"

#include <algorithm>
#include <cmath>

namespace footing::learning {
namespace {

constexpr double kTPoseRateHz = 60;

/// The readings around a time, and how far it is from the first to the second; nothing when they
/// are further apart than `silence_s`.
template <typename Reading>
struct Around {
  const Reading* before = nullptr;
  const Reading* after = nullptr;
  double share = 0;
};

template <typename Reading>
std::optional<Around<Reading>> Find(const std::vector<Reading>& readings, double time_s,
                                    double silence_s) {
  const auto after =
      std::lower_bound(readings.begin(), readings.end(), time_s,
                       [](const Reading& reading, double at_s) { return reading.time_s < at_s; });
  if (after == readings.end()) return std::nullopt;
  if (after->time_s == time_s) return Around<Reading>{&*after, &*after, 0};
  if (after == readings.begin()) return std::nullopt;
  const auto before = after - 1;
  const double step_s = after->time_s - before->time_s;
  if (step_s > silence_s) return std::nullopt;
  return Around<Reading>{&*before, &*after, (time_s - before->time_s) / step_s};
}

}  // namespace

momentum::ContactLoads LoadsAt(const RecordedSession& session, double time_s) {
  momentum::ContactLoads loads;
  loads.time_s = time_s;
  for (std::size_t side = 0; side < momentum::kFeet; ++side) {
    momentum::FootLoads& foot = loads.feet[side];
    const auto& cells_W_m = session.cells_W_m[side];
    foot.count = cells_W_m.size();
    for (std::size_t k = 0; k < foot.count; ++k) {
      foot.cells[k].p_WS_m = {cells_W_m[k].x(), cells_W_m[k].y(), 0};
    }
    const auto around = Find(session.boards[side], time_s, kBoardSilenceS);
    if (!around) continue;
    foot.valid = true;
    for (std::size_t k = 0; k < foot.count; ++k) {
      foot.cells[k].load_n = (1 - around->share) * around->before->corners_n[k] +
                             around->share * around->after->corners_n[k];
    }
  }
  return loads;
}

std::optional<HandReading> HandAt(const RecordedSession& session, std::size_t side, double time_s) {
  const auto around = Find(session.hands[side], time_s, kHandSilenceS);
  if (!around) return std::nullopt;
  return HandReading{
      time_s, (1 - around->share) * around->before->p_W_m + around->share * around->after->p_W_m,
      (1 - around->share) * around->before->sd_m + around->share * around->after->sd_m};
}

std::optional<momentum::TPose> FindTPose(const RecordedSession& session) {
  momentum::TPoseCalibration calibration;
  const auto frames = static_cast<std::size_t>(session.duration_s * kTPoseRateHz);
  for (std::size_t i = 0; i < frames; ++i) {
    const double time_s = static_cast<double>(i) / kTPoseRateHz;
    if (calibration.Advance(LoadsAt(session, time_s), 1 / kTPoseRateHz))
      return calibration.result();
  }
  return std::nullopt;
}

ForceTrace TraceOf(const RecordedSession& session, double weight_n) {
  ForceTrace trace;
  trace.name = session.name;
  trace.weight_n = weight_n;
  const auto columns = static_cast<Eigen::Index>(session.duration_s * trace.rate_hz) + 1;
  trace.load_n.setZero(2, columns);
  trace.valid.assign(static_cast<std::size_t>(columns), false);
  for (Eigen::Index i = 0; i < columns; ++i) {
    const auto loads = LoadsAt(session, static_cast<double>(i) / trace.rate_hz);
    const bool valid = loads.feet[0].valid && loads.feet[1].valid;
    trace.valid[static_cast<std::size_t>(i)] = valid;
    if (i > 0) trace.load_n.col(i) = trace.load_n.col(i - 1);
    if (!valid) continue;
    for (std::size_t side = 0; side < momentum::kFeet; ++side) {
      trace.load_n(static_cast<Eigen::Index>(side), i) =
          momentum::PressureOf(loads.feet[side], 1).total_n;
    }
  }
  return trace;
}

}  // namespace footing::learning
