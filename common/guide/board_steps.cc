#include "common/guide/board_steps.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/board/layout.h"
#include "common/guide/device_steps.h"

namespace footing::guide {
namespace {

constexpr double kStandForS = 1.0;
constexpr double kLeanForS = 0.8;
constexpr double kSteady = 0.05;  // Standard deviation of a steady load, share of its mean.
constexpr double kSteadyLeastN = 10;
constexpr double kSteadyCopM = 0.012;
constexpr double kEmptyForS = 2.5;  // Half a second more than the tare takes.
constexpr double kTareWindowS = 2;
constexpr double kEmptyMostN = 60;  // An untared board shows up to some kilograms.
constexpr double kEmptyQuietN = 5;

bool Steady(const Load& load) {
  return load.samples > 0 && load.sd_n < std::max(kSteadyLeastN, kSteady * load.mean_n);
}

bool StoodOn(const Load& load) { return Steady(load) && load.mean_n > kStoodOnN; }

bool Upright(const Load& load) {
  return StoodOn(load) && load.cop_valid && load.cop_sd_m < kSteadyCopM;
}

double Moved_m(const Load& from, const Load& to) {
  return std::hypot(to.cop_x_m - from.cop_x_m, to.cop_y_m - from.cop_y_m);
}

std::string Newtons(const Load& load) {
  return load.samples == 0 ? "no samples" : std::to_string(std::lround(load.mean_n)) + " N";
}

std::string Loads(const Stance& stance, bool two) {
  return two ? "left " + Newtons(stance.left) + ", right " + Newtons(stance.right)
             : Newtons(stance.left);
}

}  // namespace

Stance LayoutStep::Stand(const Situation& now, const SetUpOptions& options, double window_s) const {
  const std::int64_t from_ns = now.now_ns - SecondsToNanoseconds(window_s);
  const auto boards = now.recent->Boards(options.rig);
  Stance stance;
  // In the order of their roles: left before right. A lone board stands in the left one's place.
  if (!boards.empty()) {
    stance.left = now.recent->BoardLoad(boards.front().device, from_ns, now.now_ns);
  }
  if (boards.size() > 1) {
    stance.right = now.recent->BoardLoad(boards[1].device, from_ns, now.now_ns);
  }
  return stance;
}

void LayoutStep::Begin(const Situation& now, const SetUpOptions& options) {
  const auto boards = now.recent->Boards(options.rig);
  if (boards.empty()) {
    phase_ = Phase::kEnd;
    return;
  }
  two_ = boards.size() > 1;
  const double gap_mm =
      options.gap_mm == SetUpOptions::kNoGapMm ? board::kUsualGapMm : options.gap_mm;
  const auto usual = board::LayoutNamed(two_ ? "one_foot_each" : "single", gap_mm);
  layout_ = *usual;
  if (!options.preset.empty()) {
    layout_ = board::LayoutNamed(options.preset, gap_mm).value_or(*usual);
  } else if (two_) {
    for (const auto& rig : *now.setup) {
      const std::string& preset = rig.layout.preset;
      if (rig.rig == options.rig && !preset.empty() && preset != "single") layout_ = rig.layout;
    }
  }
  layout_.rig = options.rig;
  phase_ = Phase::kSetting;
}

Progress LayoutStep::Set() {
  Progress progress;
  Action set;
  set.kind = Action::Kind::kLayout;
  set.key = "layout";
  set.layout = layout_;
  progress.actions = {set};
  return progress;
}

Progress LayoutStep::One(const Situation& now, const SetUpOptions& options) {
  Progress progress;
  const bool left = phase_ == Phase::kLeft;
  progress.prompt = std::string("Stand on the ") + (left ? "left" : "right") +
                    " board alone, with both feet, and keep still.";
  progress.gesture = stream::Gesture::kStepOn;
  progress.role = left ? stream::DeviceRole::kLeftBoard : stream::DeviceRole::kRightBoard;
  if (left) progress.picture = LayoutPicture(layout_.preset);
  const Stance stance = Stand(now, options, kStandForS);
  progress.feedback = Loads(stance, true);
  const bool on_left = StoodOn(stance.left) && stance.right.samples > 0 &&
                       stance.right.mean_n < kFreeN && Steady(stance.right);
  const bool on_right = StoodOn(stance.right) && stance.left.samples > 0 &&
                        stance.left.mean_n < kFreeN && Steady(stance.left);
  if (!on_left && !on_right) return progress;
  if (left) {
    observed_.left_alone = stance;
    phase_ = Phase::kRight;
    return progress;
  }
  // The person has not changed boards yet.
  const bool was_left = observed_.left_alone->left.mean_n > observed_.left_alone->right.mean_n;
  if (was_left == on_left) return progress;
  observed_.right_alone = stance;
  phase_ = Phase::kUpright;
  return progress;
}

Progress LayoutStep::Both(const Situation& now, const SetUpOptions& options) {
  Progress progress;
  const bool upright = phase_ == Phase::kUpright;
  const Stance stance = Stand(now, options, upright ? kStandForS : kLeanForS);
  progress.feedback = Loads(stance, two_);
  const bool steady = Upright(stance.left) && (!two_ || Upright(stance.right));
  progress.gesture = upright ? stream::Gesture::kStand : stream::Gesture::kLean;
  if (upright) {
    progress.prompt = two_ ? "Stand upright, one foot on each board, and keep still."
                           : "Stand upright in the middle of the board and keep still.";
    if (!two_) progress.picture = LayoutPicture(layout_.preset);
    if (!steady) return progress;
    observed_.upright = stance;
    phase_ = Phase::kForward;
    return progress;
  }
  progress.prompt = "Lean forward from the ankles, heels down, and hold it.";
  const double left_m = Moved_m(observed_.upright.left, stance.left);
  const double right_m = two_ ? Moved_m(observed_.upright.right, stance.right) : left_m;
  progress.feedback += ", moved by " + std::to_string(std::lround(left_m * 1e3)) + " mm";
  if (two_) progress.feedback += " and " + std::to_string(std::lround(right_m * 1e3)) + " mm";
  if (!steady || std::min(left_m, right_m) < kLeastLeanM) return progress;
  observed_.forward = stance;
  const LayoutVerdict verdict = CheckLayout(layout_, observed_);
  results_ = {Outcome(Item::kLayout, "", verdict.passed(), verdict.residual_mm, "mm",
                      layout_.preset + ": " + verdict.note)};
  phase_ = Phase::kEnd;
  return progress;
}

Progress LayoutStep::Advance(const Situation& now, const SetUpOptions& options) {
  if (phase_ == Phase::kBegin) {
    Begin(now, options);
    if (phase_ == Phase::kSetting) return Set();
  }
  if (phase_ == Phase::kSetting) {
    for (const Answer& answer : now.answers) {
      if (answer.key != "layout") continue;
      phase_ = answer.ok ? (two_ ? Phase::kLeft : Phase::kUpright) : Phase::kEnd;
      if (!answer.ok) results_ = {Outcome(Item::kLayout, "", false, 0, "mm", answer.message)};
    }
    if (phase_ == Phase::kSetting) return {};
  }
  if (phase_ == Phase::kLeft || phase_ == Phase::kRight) return One(now, options);
  if (phase_ != Phase::kEnd) return Both(now, options);
  Progress progress;
  progress.results = results_;
  progress.finished = true;
  return progress;
}

Progress TareStep::Advance(const Situation& now, const SetUpOptions& options) {
  Progress progress;
  const auto boards = now.recent->Boards(options.rig);
  progress.finished = boards.empty();
  if (boards.empty()) return progress;
  progress.prompt = "Step off the boards and leave them empty.";
  progress.gesture = stream::Gesture::kStepOff;
  for (const Answer& answer : now.answers) {
    if (!asked_ || !answer.key.starts_with("tare ")) continue;
    results_.push_back(Outcome(Item::kTare, answer.key.substr(5), answer.ok, answer.residual,
                               answer.unit.empty() ? "N" : answer.unit, answer.message));
    if (--waiting_ == 0) {
      progress.results = results_;
      progress.finished = true;
      return progress;
    }
  }
  if (asked_) return progress;
  const std::int64_t from_ns = now.now_ns - SecondsToNanoseconds(kEmptyForS);
  for (const auto& board : boards) {
    const Load load = now.recent->BoardLoad(board.device, from_ns, now.now_ns);
    progress.feedback += (progress.feedback.empty() ? "" : ", ") + Newtons(load);
    if (load.samples == 0 || load.mean_n > kEmptyMostN || load.sd_n > kEmptyQuietN) {
      return progress;
    }
  }
  for (const auto& board : boards) {
    Action tare;
    tare.kind = Action::Kind::kTare;
    tare.key = "tare " + board.serial;
    tare.serial = board.serial;
    tare.window_s = kTareWindowS;
    progress.actions.push_back(tare);
  }
  asked_ = true;
  waiting_ = boards.size();
  return progress;
}

Progress WeighStep::Advance(const Situation& now, const SetUpOptions& options) {
  Progress progress;
  const auto boards = now.recent->Boards(options.rig);
  progress.finished = boards.empty();
  if (boards.empty()) return progress;
  progress.prompt =
      boards.size() > 1 ? "Stand still, one foot on each board." : "Stand still on the board.";
  progress.gesture = stream::Gesture::kStand;
  const std::int64_t from_ns = now.now_ns - SecondsToNanoseconds(kWeighForS);
  std::vector<Load> loads;
  for (const auto& board : boards) {
    loads.push_back(now.recent->BoardLoad(board.device, from_ns, now.now_ns));
  }
  const Weight weight = Weigh(loads, options.mass_kg);
  progress.feedback = weight.note;
  if (!weight.done) return progress;
  const std::string note = boards.size() > 1 ? weight.note : weight.note + " on one board alone";
  progress.results = {Outcome(Item::kWeigh, "", weight.passed, weight.sd_kg, "kg", note)};
  progress.finished = true;
  return progress;
}

namespace {

constexpr double kQuiet = 0.015;
constexpr double kAgree = 0.03;
constexpr double kAgreeLeastKg = 2;

std::string Kilograms(double mass_kg) {
  const long tenths = std::lround(mass_kg * 10);
  return std::to_string(tenths / 10) + "." + std::to_string(std::abs(tenths % 10)) + " kg";
}

}  // namespace

Weight Weigh(const std::vector<Load>& boards, std::optional<double> given_kg) {
  Weight weight;
  double total_n = 0;
  double worst_n = 0;  // Boards' swings may be opposite; their sum is the most there can be.
  for (const Load& load : boards) {
    if (load.samples == 0) {
      weight.note = "a board sends no data";
      return weight;
    }
    total_n += load.mean_n;
    worst_n += load.sd_n;
  }
  weight.mass_kg = NewtonsToKilograms(total_n);
  weight.sd_kg = NewtonsToKilograms(worst_n);
  if (weight.mass_kg < kLeastMassKg) {
    weight.note = "nobody is on the boards";
    return weight;
  }
  if (weight.sd_kg > kQuiet * weight.mass_kg) {
    weight.note = "not quiet yet: +-" + Kilograms(weight.sd_kg);
    return weight;
  }
  weight.done = true;
  if (weight.mass_kg > kMostMassKg) {
    weight.note = Kilograms(weight.mass_kg) + " is more than a person: tare the empty boards again";
    return weight;
  }
  weight.passed = true;
  weight.note = Kilograms(weight.mass_kg);
  if (given_kg &&
      std::abs(weight.mass_kg - *given_kg) > std::max(kAgreeLeastKg, kAgree * *given_kg)) {
    weight.passed = false;
    weight.note += " measured, " + Kilograms(*given_kg) +
                   " given: tare the empty boards again, stand with both feet on them";
  }
  return weight;
}

}  // namespace footing::guide
