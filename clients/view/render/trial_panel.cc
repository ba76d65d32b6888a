#include "clients/view/render/trial_panel.h"

#include <algorithm>
#include <string>
#include <vector>

#include "clients/view/scene/trial_text.h"
#include "clients/view/scene/words.h"

namespace footing::render {
namespace {

constexpr float kMostWidth = 460;
constexpr float kMargins = 28;  // Of a panel, both sides.

ImU32 TaskInk(stream::TaskPhase phase) {
  switch (phase) {
    case stream::TaskPhase::kDue:
      return colour::kWarning;
    case stream::TaskPhase::kDone:
      return colour::kGood;
    case stream::TaskPhase::kAhead:
    case stream::TaskPhase::kUnspecified:
      return colour::kText;
  }
  return colour::kText;
}

/// Lines of one font and colour, and the space above them.
struct Lines {
  ImFont* font = nullptr;
  ImU32 ink = 0;
  std::vector<std::string> text;
};

std::vector<Lines> TextOf(const Paint& p, const scene::Model& model,
                          const stream::TrialState& trial, bool task_alone, float width) {
  std::vector<Lines> text;
  const std::string task = scene::TaskText(trial, model.track);
  if (!task.empty()) {
    text.push_back({p.fonts.heading, TaskInk(trial.progress.task_phase),
                    p.Wrapped(p.fonts.heading, task, width)});
  }
  if (task_alone) return text;
  const bool over = trial.progress.phase == stream::TrialPhase::kFinished;
  text.push_back({p.fonts.strong, over ? colour::kGood : colour::kText,
                  p.Wrapped(p.fonts.strong, scene::TrialTitle(trial), width)});
  const bool failed = stream::Total(trial.progress.failures) > 0;
  text.push_back({p.fonts.small, failed ? colour::kWarning : colour::kFaint,
                  p.Wrapped(p.fonts.small, scene::AttemptText(trial), width)});
  return text;
}

/// The way from the start to the finish line.
void DrawWay(const Paint& p, const Box& box, const stream::TrialState& trial) {
  const float s = p.scale;
  const double done = trial.progress.distance_m / trial.finish_m;
  p.Bar({{box.low.x, box.low.y + 3 * s}, {box.high.x - 108 * s, box.low.y + 10 * s}},
        static_cast<float>(std::clamp(done, 0.0, 1.0)), colour::kAccent);
  p.WriteRight(
      p.fonts.small, {box.high.x, box.low.y - 2 * s}, colour::kFaint,
      scene::Fixed(trial.progress.distance_m, 1) + " of " + scene::Fixed(trial.finish_m, 0) + " m");
}

}  // namespace

void DrawTrialPanel(const Paint& p, const scene::Model& model, const scene::CharacterPose& pose,
                    bool task_alone, Box& space) {
  const stream::TrialState* trial = scene::ShownTrial(pose, model.study.state);
  if (trial == nullptr) return;
  const float s = p.scale;
  const float width = std::min(space.width(), kMostWidth * s);
  const auto text = TextOf(p, model, *trial, task_alone, width - kMargins * s);
  if (text.empty()) return;
  const bool way = !task_alone && trial->finish_m > 0;
  float height = (kMargins + (way ? 18 : 0)) * s;
  for (const Lines& lines : text) {
    height += static_cast<float>(lines.text.size()) * (lines.font->FontSize + 3 * s);
  }
  if (height > space.height()) return;
  const float middle = (space.low.x + space.high.x) / 2;
  const Box in =
      p.Panel({{middle - width / 2, space.low.y}, {middle + width / 2, space.low.y + height}});
  float y = in.low.y;
  for (const Lines& lines : text) {
    for (const std::string& line : lines.text) {
      p.Write(lines.font, {in.low.x, y}, lines.ink, line);
      y += lines.font->FontSize + 3 * s;
    }
  }
  if (way) DrawWay(p, {{in.low.x, y + 4 * s}, in.high}, *trial);
  space.low.y += height + 6 * s;
}

}  // namespace footing::render
