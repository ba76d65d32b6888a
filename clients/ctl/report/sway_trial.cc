#include "clients/ctl/report/sway_trial.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "common/base/text.h"
#include "common/base/units.h"

namespace footing::sway {
namespace {

using posturography::Loads;

/// A board without samples for this long is lost. Bluetooth pauses of up to 0.2 s are usual.
constexpr double kLostAfterS = 1;
/// A load that differs from the weight by a quarter is not quiet standing, whose load stays within
/// a few per cent: somebody stepped off, or holds on to something.
constexpr double kLoadTolerance = 0.25;
/// Below this share of the load nobody stands on one of two boards.
constexpr double kUnloadedShare = 0.1;
constexpr double kDisturbedS = 0.25;  // A shorter one is not a step.
/// At least this share of the time has to be measured.
constexpr double kLeastShare = 0.95;

bool OnOneLeg(const Condition& condition) { return condition.feet.ends_with("_leg"); }

std::string FeetText(const std::string& feet) {
  static const std::map<std::string, std::string> texts = {{"together", "feet together"},
                                                           {"shoulder", "feet at shoulder width"},
                                                           {"tandem", "one foot before the other"},
                                                           {"left_leg", "left leg"},
                                                           {"right_leg", "right leg"}};
  return texts.at(feet);
}

double TotalN(std::span<const BoardNow> now) {
  double total_n = 0;
  for (const BoardNow& board : now) total_n += board.load_n;
  return total_n;
}

/// Corners in seconds since the trial's begin. Samples that came late, or again after a break of
/// the link, are put in their places.
std::vector<posturography::CornerSample> Within(std::vector<stream::BoardSample> samples,
                                                Trial& trial) {
  std::erase_if(samples, [&](const stream::BoardSample& sample) {
    return sample.sampled_ns < trial.from_ns || sample.sampled_ns > trial.to_ns;
  });
  std::stable_sort(samples.begin(), samples.end(),
                   [](const auto& a, const auto& b) { return a.sampled_ns < b.sampled_ns; });
  samples.erase(std::unique(samples.begin(), samples.end()), samples.end());
  std::vector<posturography::CornerSample> within;
  for (const stream::BoardSample& sample : samples) {
    trial.simulated = trial.simulated || sample.simulated;
    trial.tared = trial.tared && sample.tared;
    trial.calibrated = trial.calibrated && !sample.uncalibrated;
    within.push_back(
        {NanosecondsToSeconds(sample.sampled_ns - trial.from_ns),
         {sample.top_left_n, sample.top_right_n, sample.bottom_left_n, sample.bottom_right_n}});
  }
  return within;
}

double MeanLoad(const Loads& loads) {
  double sum_n = 0;
  for (const auto& load : loads) sum_n += load.load_n;
  return loads.empty() ? 0 : sum_n / static_cast<double>(loads.size());
}

/// The load of all boards together. The COP is not resampled yet where there is one board.
Loads LoadsOf(const std::vector<Board>& boards, const Tracks& tracks,
              const posturography::CopFilter& filter, Trial& trial) {
  std::vector<Loads> loads;
  double slowest_s = 0;
  for (std::size_t i = 0; i < boards.size(); ++i) {
    const auto corners = Within(tracks[i], trial);
    loads.push_back(posturography::LoadsOn(corners, boards[i].pose, boards[i].geometry));
    slowest_s = std::max(slowest_s, posturography::MedianInterval(loads.back()));
  }
  trial.recorded_rate_hz = slowest_s > 0 ? 1 / slowest_s : 0;
  if (boards.size() == 1) return std::move(loads[0]);
  const double total_n = MeanLoad(loads[0]) + MeanLoad(loads[1]);
  if (total_n > 0) {
    const std::size_t left = boards[0].role == stream::DeviceRole::kLeftBoard ? 0 : 1;
    trial.left_share = MeanLoad(loads[left]) / total_n;
  }
  return posturography::Merged(loads[0], loads[1], filter.rate_hz, filter.WindowS(slowest_s));
}

}  // namespace

std::string Title(const Condition& condition) {
  return "eyes " + condition.eyes + ", " + condition.surface + ", " + FeetText(condition.feet);
}

std::string Instruction(const Condition& condition, std::size_t boards) {
  std::string text =
      condition.surface == "foam" ? "Stand on the foam on the board" : "Stand on the board";
  if (boards > 1) text += "s";
  text += OnOneLeg(condition) ? " on the " + FeetText(condition.feet) + " alone"
                              : ", " + FeetText(condition.feet);
  return text + (condition.eyes == "open" ? ", arms hanging, eyes on a mark."
                                          : ", arms hanging, and close the eyes.");
}

std::string Name(const Board& board) {
  std::string name = stream::Name(board.role);
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

void MeasureTrial(const std::vector<Board>& boards, const Tracks& tracks,
                  const posturography::CopFilter& filter, Trial& trial) {
  const Loads loads = LoadsOf(boards, tracks, filter, trial);
  posturography::Standing standing = posturography::FindStanding(loads, {});
  trial.weight_n = standing.weight_n;
  trial.gaps = standing.gaps;
  if (standing.weight_n <= 0) {
    trial.rejected = "nobody stood on the boards";
    return;
  }
  const double wanted_s = NanosecondsToSeconds(trial.to_ns - trial.from_ns);
  const double stood_s = posturography::DurationS(standing.stretches);
  if (stood_s < kLeastShare * wanted_s) {
    trial.rejected = "only " + text::Fixed(stood_s, 1) + " of " + text::Shortest(wanted_s) +
                     " s have samples of a standing person";
    if (standing.gaps.count > 0) {
      trial.rejected +=
          "; samples are missing for up to " + text::Fixed(standing.gaps.longest_s, 1) + " s";
    }
    return;
  }
  if (boards.size() == 1) {
    if (const auto done = posturography::ResampleAll(filter, standing.stretches); !done) {
      trial.rejected = done.error().message;
      return;
    }
  }
  posturography::LowPassAll(filter, standing.stretches);
  trial.cop = std::move(standing.stretches);
  std::size_t samples = 0;
  for (const auto& stretch : trial.cop) samples += stretch.size();
  constexpr std::size_t kLeastSamples = 3;
  if (samples < kLeastSamples) {
    trial.rejected = "it has only " + std::to_string(samples) + " values";
    return;
  }
  trial.measures = posturography::Measure(trial.cop, filter.rate_hz);
}

void TrialGuide::Interrupt(const std::string& reason) {
  if (phase_ == Phase::kMeasuring) {
    phase_ = Phase::kRejected;
    rejected_ = reason;
  } else if (phase_ == Phase::kSettling) {
    phase_ = Phase::kWaiting;
  }
  prompt_ = reason;
  left_s_ = 0;
}

void TrialGuide::Advance(std::int64_t now_ns, std::span<const BoardNow> now, bool start) {
  std::string lost;
  for (std::size_t i = 0; i < boards_.size(); ++i) {
    if (now[i].sampled_ns == 0 || NanosecondsToSeconds(now_ns - now[i].sampled_ns) > kLostAfterS) {
      lost = Name(boards_[i]);
    }
  }
  switch (phase_) {
    case Phase::kWaiting:
      return Wait(now, lost, start, now_ns);
    case Phase::kSettling:
      return Settle(now_ns, now, lost);
    case Phase::kMeasuring:
      return Watch(now_ns, now, lost);
    case Phase::kDone:
    case Phase::kRejected:
      return;
  }
}

void TrialGuide::Wait(std::span<const BoardNow> now, const std::string& lost, bool start,
                      std::int64_t now_ns) {
  left_s_ = 0;
  if (!lost.empty()) {
    prompt_ = "The " + lost + " sends nothing: press its button.";
    return;
  }
  prompt_ = Instruction(condition_, boards_.size());
  if (TotalN(now) < board::kContactOnN) return;
  if (settings_.wait_for_start && !start) {
    prompt_ += " Then press Enter.";
    return;
  }
  phase_ = Phase::kSettling;
  from_ns_ = now_ns + SecondsToNanoseconds(settings_.settle_s);
  Settle(now_ns, now, lost);
}

void TrialGuide::Settle(std::int64_t now_ns, std::span<const BoardNow> now,
                        const std::string& lost) {
  if (!lost.empty() || TotalN(now) < board::kContactOnN) {
    phase_ = Phase::kWaiting;
    return Wait(now, lost, false, now_ns);
  }
  left_s_ = NanosecondsToSeconds(from_ns_ - now_ns);
  prompt_ = "Stand still.";
  if (now_ns < from_ns_) return;
  phase_ = Phase::kMeasuring;
  from_ns_ = now_ns;
  to_ns_ = now_ns + SecondsToNanoseconds(settings_.seconds);
  left_s_ = settings_.seconds;
  weight_n_ = TotalN(now);
  disturbed_ns_ = 0;
  loaded_.clear();
  for (const BoardNow& board : now) loaded_.push_back(board.load_n > kUnloadedShare * weight_n_);
}

void TrialGuide::Watch(std::int64_t now_ns, std::span<const BoardNow> now,
                       const std::string& lost) {
  left_s_ = std::max(0.0, NanosecondsToSeconds(to_ns_ - now_ns));
  if (!lost.empty()) return Interrupt("the " + lost + " sent nothing for 1 s");
  const bool complete = std::all_of(
      now.begin(), now.end(), [this](const BoardNow& board) { return board.sampled_ns >= to_ns_; });
  if (complete) {
    phase_ = Phase::kDone;
    return;
  }
  if (now_ns >= to_ns_) return;  // The last samples are under way.
  const std::string disturbance = Disturbance(now);
  if (disturbance.empty()) {
    disturbed_ns_ = 0;
  } else if (disturbed_ns_ == 0) {
    disturbed_ns_ = now_ns;
  } else if (NanosecondsToSeconds(now_ns - disturbed_ns_) >= kDisturbedS) {
    Interrupt(disturbance);
  }
}

std::string TrialGuide::Disturbance(std::span<const BoardNow> now) const {
  const double total_n = TotalN(now);
  if (total_n < board::kContactOffN) return "the subject stepped off";
  if (std::abs(total_n - weight_n_) > kLoadTolerance * weight_n_) {
    return "the load changed by more than a quarter: the subject stepped aside, or held on to "
           "something";
  }
  for (std::size_t i = 0; i < boards_.size(); ++i) {
    const bool loaded = now[i].load_n > kUnloadedShare * weight_n_;
    if (loaded != loaded_[i]) {
      return std::string("a foot ") + (loaded ? "came onto" : "left") + " the " + Name(boards_[i]);
    }
  }
  return "";
}

std::vector<Summary> Summaries(const std::vector<Trial>& trials) {
  std::vector<Summary> summaries;
  std::vector<std::map<std::string, std::vector<double>>> values;
  for (const Trial& trial : trials) {
    if (!trial.measures || !trial.rejected.empty()) continue;
    auto at = std::find_if(summaries.begin(), summaries.end(),
                           [&](const Summary& one) { return one.condition == trial.condition; });
    if (at == summaries.end()) {
      at = summaries.insert(at, Summary{trial.condition, 0, {}});
      values.emplace_back();
      for (const auto& measure : posturography::Named(*trial.measures)) {
        if (!std::string_view(measure.key).ends_with("_deg")) {
          at->measures.push_back({measure.key, 0, {}, {}});
        }
      }
    }
    ++at->trials;
    for (const auto& measure : posturography::Named(*trial.measures)) {
      if (!measure.value) continue;
      values[static_cast<std::size_t>(at - summaries.begin())][measure.key].push_back(
          *measure.value);
    }
  }
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    for (Averaged& one : summaries[i].measures) {
      const std::vector<double>& all = values[i][one.key];
      one.trials = all.size();
      if (all.empty()) continue;
      double sum = 0, squares = 0;
      for (const double value : all) sum += value;
      const auto count = static_cast<double>(all.size());
      one.mean = sum / count;
      for (const double value : all) squares += (value - *one.mean) * (value - *one.mean);
      if (all.size() > 1) one.sd = std::sqrt(squares / (count - 1));
    }
  }
  return summaries;
}

std::vector<Romberg> RombergRatios(const std::vector<Summary>& summaries) {
  const auto mean = [](const Summary& summary, const std::string& key) {
    for (const Averaged& one : summary.measures) {
      if (one.key == key) return one.mean.value_or(0);
    }
    return 0.0;
  };
  std::vector<Romberg> ratios;
  for (const Summary& open : summaries) {
    if (open.condition.eyes != "open") continue;
    for (const Summary& closed : summaries) {
      const Condition& c = closed.condition;
      if (c.eyes != "closed" || c.surface != open.condition.surface ||
          c.feet != open.condition.feet) {
        continue;
      }
      const double path_mm = mean(open, "path_length_mm");
      const double area_mm2 = mean(open, "ellipse95_area_mm2");
      if (path_mm <= 0 || area_mm2 <= 0) continue;
      ratios.push_back({c.surface, c.feet, mean(closed, "path_length_mm") / path_mm,
                        mean(closed, "ellipse95_area_mm2") / area_mm2});
    }
  }
  return ratios;
}

}  // namespace footing::sway
