#include <algorithm>
#include <cmath>
#include <optional>

#include "clients/study/session/run_session.h"
#include "common/runtime/clock.h"
#include "common/base/number.h"
#include "common/base/units.h"

namespace footing::study {
namespace {

using records::EventKind;

constexpr double kReminderS = 60;

}  // namespace

Result<void> SessionRun::CountDown(stream::StudyActivity activity, const std::string& what,
                                   double duration_s, bool may_end_early) {
  if (context_.options.unattended) return {};
  Console& console = context_.console;
  const std::int64_t begin_ns = clock::MonotonicNs();
  const auto passed_s = [&] { return NanosecondsToSeconds(clock::MonotonicNs() - begin_ns); };
  console.ReadKeys(true);
  bool early = false;
  const auto ended = [&] {
    const std::optional<char> key = console.TakeKey();
    return early = may_end_early && key == '\n';
  };
  while (!early && !console.interrupted() && passed_s() < duration_s) {
    Show(activity, what + ".", may_end_early ? "Enter ends it early" : "", duration_s - passed_s());
    console.Print(what + ": " + text::Fixed(std::ceil(duration_s - passed_s()), 0) + " s left." +
                  (may_end_early ? " Press Enter to end it early." : ""));
    console.RunUntil(ended, std::min(kReminderS, duration_s - passed_s()));
  }
  console.ReadKeys(false);
  if (console.interrupted()) return Interrupted();
  if (!early) return {};
  return context_.journal.Append(
      EventKind::kNote,
      {{"text", what + " ended early"}, {"planned_s", duration_s}, {"took_s", passed_s()}});
}

double SessionRun::ActiveS() const { return progress_.active_s + active_.seconds(); }

double SessionRun::UnrestedMin() const {
  return (ActiveS() - progress_.rested_at_s) / kSecondsPerMinute;
}

bool SessionRun::NeedsRest() const {
  return UnrestedMin() >= context_.protocol.rests.active_limit_min;
}

Result<void> SessionRun::RestWhereDue(const plan::Phase& next) {
  if (next.track.empty() || !NeedsRest()) return {};
  return Rest("Rest after " + text::Fixed(UnrestedMin(), 0) + " min in motion",
              context_.protocol.rests.after_limit_s);
}

Result<void> SessionRun::Rest(const std::string& what, double duration_s) {
  rests_ = true;
  const auto done =
      CountDown(stream::StudyActivity::kRest, what, duration_s, /*may_end_early=*/false);
  rests_ = false;
  if (!done || duration_s < context_.protocol.rests.after_limit_s) return done;
  progress_.rested_at_s = ActiveS();
  warned_.erase(kRestWarning);
  return context_.journal.Append(EventKind::kNote, {{"text", what},
                                                    {"took_s", duration_s},
                                                    {records::kRestedAt, progress_.rested_at_s},
                                                    {"synthetic", context_.options.unattended}});
}

std::string SessionRun::RestWarning() const {
  if (rests_ || !NeedsRest()) return "";
  return "The participant has moved for " + text::Fixed(UnrestedMin(), 0) + " min: a rest of " +
         text::Fixed(context_.protocol.rests.after_limit_s / kSecondsPerMinute, 0) +
         " min comes next.";
}

}  // namespace footing::study
