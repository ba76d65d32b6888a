#include "daemon/simulation/engine/foresight.h"

#include <algorithm>
#include <cmath>

#include "common/base/text.h"
#include "common/stream/gait.h"
#include "daemon/simulation/biped/track.h"
#include "daemon/simulation/engine/engine.h"
#include "daemon/simulation/gait/controller.h"

namespace footing::engine {
namespace {

using stream::Gait;
using text::Quoted;

/// Factors beyond these are a slip of the pen.
constexpr double kLeastFactor = 0.1, kLargestFactor = 10;

struct ChoiceRow {
  Gait gait = Gait::kUnspecified;
  std::string_view name;
  const gait::GainField* gain = nullptr;
  double factor = 1;
};

Result<ChoiceRow> ReadRow(const text::Lines& lines, const std::vector<std::string_view>& cells) {
  if (cells.size() != 4) return lines.Fault("needs gait,choice,gain,factor");
  const ChoiceRow row{stream::GaitNamed(std::string(cells[0])), cells[1], gait::FindGain(cells[2]),
                      text::ToNumber(cells[3]).value_or(0)};
  if (row.gait == Gait::kUnspecified) {
    return lines.Fault("gait is " + Quoted(cells[0]) + ", must be one of " + stream::GaitNames());
  }
  if (row.name.empty()) return lines.Fault("the choice has no name");
  if (row.gain == nullptr) {
    return lines.Fault("unknown gain " + Quoted(cells[2]) + "; gains.h has them all");
  }
  if (!(row.factor >= kLeastFactor && row.factor <= kLargestFactor)) {
    return lines.Fault("factor is " + Quoted(cells[3]) + ", allowed is 0.1 to 10");
  }
  return row;
}

}  // namespace

Result<GainChoices> ReadChoices(std::string_view text, const std::string& origin) {
  text::Lines lines(text, origin);
  const auto names = lines.NextRow();
  if (!names || *names != "gait,choice,gain,factor") {
    return lines.Fault("the columns must be gait,choice,gain,factor");
  }
  GainChoices choices;
  for (auto line = lines.NextRow(); line; line = lines.NextRow()) {
    const Result<ChoiceRow> row = ReadRow(lines, text::Cells(*line));
    if (!row) return row.error();
    std::vector<GainChoice>& of_gait = choices[stream::IndexOf(row->gait)];
    if (of_gait.empty() || of_gait.back().name != row->name) {
      of_gait.push_back({std::string(row->name), {}});
    }
    of_gait.back().factors.emplace_back(row->gain, row->factor);
  }
  return choices;
}

Gait GaitOf(const gait::GaitMemory& memory) {
  return memory.transition.thrusting ? Gait::kRun : memory.gait;
}

const gait::Gains& GainsInForce::At(const GainTables& tables, const ChosenGains& chosen,
                                    gait::GaitMemory& memory) {
  const Gait gait = GaitOf(memory);
  const double speed_mps = memory.speed.desired_mps;
  memory.style.there = !tables.style.SetsOf(gait).empty();
  const double style = memory.style.there ? memory.style.share : 0;
  if (gait == gait_ && speed_mps == speed_mps_ && style == style_ && chosen == chosen_) {
    return gains_;
  }
  gains_ = tables.plain.At(gait, speed_mps);
  if (style > 0) gains_ = gait::Between(gains_, tables.style.At(gait, speed_mps), style);
  const auto& choices = tables.choices[stream::IndexOf(gait)];
  if (chosen.gait == gait && chosen.number > 0 &&
      chosen.number <= static_cast<int>(choices.size())) {
    for (const auto& [field, factor] : choices[static_cast<std::size_t>(chosen.number - 1)].factors)
      field->of(gains_) = std::clamp(field->Of(gains_) * factor, field->min, field->max);
  }
  gait_ = gait;
  speed_mps_ = speed_mps;
  style_ = style;
  chosen_ = chosen;
  return gains_;
}

int PhaseOf(const gait::GaitMemory& memory) {
  constexpr int kHopping = 100;  // Beyond the phases of walking.
  return gait::IsHopping(GaitOf(memory)) ? kHopping + static_cast<int>(memory.running)
                                         : static_cast<int>(memory.walking);
}

namespace {

/// A failure is looked for once in so many steps.
constexpr std::uint64_t kLooksEvery = 10;

/// One step of the copy. False when it has failed.
bool StepAhead(const Stage& stage, const ChosenGains& chosen, Outlook& ahead) {
  const double time_s = static_cast<double>(ahead.step) * stage.step_s;
  const biped::BodyState body = biped::Read(stage.biped, stage.twin.Observe(), time_s);
  const gait::Gains& gains = stage.gains.At(stage.tables, chosen, ahead.gait);
  stage.twin.Step(
      gait::Advance(body, stage.biped, gains, stage.command, stage.sight, stage.step_s, ahead.gait),
      stage.tow_W_n);
  ++ahead.step;
  if (ahead.step % kLooksEvery != 0) return true;
  const biped::BodyState now =
      biped::Read(stage.biped, stage.twin.Observe(), time_s + stage.step_s);
  const terrain::TrackPlace place = terrain::Locate(stage.track, now.p_WB.head<2>());
  return FindFailure(stage.track, place, now, stage.twin.Observe()).why == nullptr;
}

/// Steps for which it stands, at most `most`.
int StepsThatStand(const Outlook& now, const ChosenGains& chosen, int most, const Stage& stage) {
  Outlook ahead = now;
  stage.twin.Restore(now.world);
  for (int i = 0; i < most; ++i) {
    if (!StepAhead(stage, chosen, ahead)) return i;
  }
  return most;
}

}  // namespace

Foresight ChooseAhead(const Outlook& now, const Stage& stage) {
  const Gait gait = GaitOf(now.gait);
  const int horizon = static_cast<int>(std::lround(kHorizonS / stage.step_s));
  const int choices = static_cast<int>(stage.tables.choices[stream::IndexOf(gait)].size());
  ChosenGains best;
  int longest = -1, left = kMostSteps;
  for (int i = 0; i <= choices && left > longest && longest < horizon; ++i) {
    const int stands = StepsThatStand(now, {gait, i}, std::min(horizon, left), stage);
    left -= stands;
    if (stands > longest) best = {gait, i};
    longest = std::max(longest, stands);
  }
  return {best, now.step + static_cast<std::uint64_t>(std::max(0, longest))};
}

}  // namespace footing::engine
