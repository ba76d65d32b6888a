#include "clients/view/render/timeline_bar.h"

#include <algorithm>
#include <array>

#include "clients/view/scene/timeline_text.h"

namespace footing::render {
namespace {

// In units.
constexpr float kEdge = 18;
constexpr float kRow = 22;
constexpr float kLane = 16, kLaneGap = 4;
constexpr float kNarrow = 900;  // The legend has a row of its own there.
constexpr float kLegendGap = 14;

constexpr ImU32 kJumpColour = IM_COL32(178, 140, 255, 255);
constexpr ImU32 kTransitionColour = IM_COL32(244, 130, 206, 255);
constexpr ImU32 kTaskColour = IM_COL32(84, 226, 214, 255);

float LanesHeight(std::size_t lanes) {
  const auto count = static_cast<float>(std::max<std::size_t>(1, lanes));
  return count * kLane + (count - 1) * kLaneGap;
}

/// A sign of the legend and what it stands for.
struct Sign {
  ImU32 colour = 0;
  std::string text;
};

std::vector<Sign> LegendOf(const timeline::Timeline& line) {
  std::vector<Sign> signs;
  for (const stream::FailureCause cause : stream::kFailureCauses) {
    const auto count = std::count_if(
        line.failures.begin(), line.failures.end(),
        [cause](const auto& failure) { return failure.cause == cause && !failure.withdrawn; });
    if (count == 0) continue;
    signs.push_back(
        {ColourOf(cause), std::string(stream::Name(cause)) + " " + std::to_string(count)});
  }
  const bool withdrawn = std::any_of(line.failures.begin(), line.failures.end(),
                                     [](const auto& failure) { return failure.withdrawn; });
  if (withdrawn) signs.push_back({colour::kFaint, "withdrawn"});
  if (!line.trials.empty()) {
    signs.push_back({colour::kGood, "start"});
    signs.push_back({colour::kText, "finish"});
  }
  if (!line.tasks.empty()) signs.push_back({kTaskColour, "task done"});
  return signs;
}

float WidthOf(const Paint& p, const std::vector<Sign>& signs) {
  float width = 0;
  for (const Sign& sign : signs) {
    width += p.WidthOf(p.fonts.small, sign.text) + (12 + kLegendGap) * p.scale;
  }
  return width;
}

void DrawLegend(const Paint& p, ImVec2 at, const std::vector<Sign>& signs) {
  const float s = p.scale;
  for (const Sign& sign : signs) {
    p.list->AddRectFilled({at.x, at.y + 3 * s}, {at.x + 7 * s, at.y + 13 * s}, sign.colour, 2 * s);
    at.x += 12 * s;
    at.x += p.Write(p.fonts.small, at, colour::kFaint, sign.text) + kLegendGap * s;
  }
}

/// A triangle on the lane's upper edge.
void DrawTask(const Paint& p, const Box& lane, float x) {
  const float s = p.scale;
  p.list->AddTriangleFilled({x - 4 * s, lane.low.y - 3 * s}, {x + 4 * s, lane.low.y - 3 * s},
                            {x, lane.low.y + 5 * s}, kTaskColour);
}

void DrawTrial(const Paint& p, const Box& lane, const Box& groove, const timeline::Timeline& whole,
               const timeline::TrialMark& trial, double until_s) {
  const float s = p.scale;
  const auto column = [&](double at_s) { return ColumnOf(groove, whole, at_s); };
  const float from = column(trial.begin_s), to = column(until_s);
  p.list->AddRectFilled({from, lane.low.y}, {to, lane.high.y}, Faded(colour::kText, 0.14f));
  if (trial.start_s) {
    const float running_to = trial.end_s ? column(*trial.end_s) : to;
    p.list->AddRectFilled({column(*trial.start_s), lane.low.y}, {running_to, lane.high.y},
                          Faded(colour::kText, 0.26f));
    p.list->AddRectFilled({column(*trial.start_s) - s, lane.low.y - 2 * s},
                          {column(*trial.start_s) + s, lane.high.y + 2 * s}, colour::kGood);
  }
  if (trial.end_s) {
    p.list->AddRectFilled({column(*trial.end_s) - s, lane.low.y - 2 * s},
                          {column(*trial.end_s) + s, lane.high.y + 2 * s}, colour::kText);
  }
  const std::string name = timeline::NameOf(trial);
  const float left = std::max(from, groove.low.x) + 5 * s;
  if (left + p.WidthOf(p.fonts.tiny, name) + 4 * s > to) return;
  p.Write(p.fonts.tiny, {left, lane.low.y + 1.5f * s}, colour::kText, name);
}

void DrawLane(const Paint& p, const Box& lane, const Box& groove, const timeline::Timeline& whole,
              const timeline::Timeline& line) {
  const float s = p.scale;
  p.list->AddRectFilled({ColumnOf(groove, whole, line.begin_s), lane.low.y},
                        {ColumnOf(groove, whole, line.end_s), lane.high.y}, colour::kGroove, 3 * s);
  for (std::size_t i = 0; i < line.trials.size(); ++i) {
    const bool last = i + 1 == line.trials.size();
    DrawTrial(p, lane, groove, whole, line.trials[i],
              last ? line.end_s : line.trials[i + 1].begin_s);
  }
  for (const timeline::FailureMark& failure : line.failures) {
    const float x = ColumnOf(groove, whole, failure.at_s);
    p.list->AddRectFilled({x - 1.5f * s, lane.low.y}, {x + 1.5f * s, lane.high.y},
                          failure.withdrawn ? colour::kFaint : ColourOf(failure.cause));
  }
  for (const timeline::TaskMark& task : line.tasks) {
    DrawTask(p, lane, ColumnOf(groove, whole, task.at_s));
  }
}

}  // namespace

ImU32 ColourOf(stream::FailureCause cause) {
  switch (cause) {
    case stream::FailureCause::kSimulation:
      return colour::kBad;
    case stream::FailureCause::kCurve:
      return colour::kSecond;
    case stream::FailureCause::kJump:
      return kJumpColour;
    case stream::FailureCause::kStraightness:
      return colour::kAccent;
    case stream::FailureCause::kTransition:
      return kTransitionColour;
    case stream::FailureCause::kUnspecified:
      break;
  }
  return colour::kFaint;
}

TimelineBoxes LayOutTimeline(ImVec2 size, float scale, std::size_t lanes) {
  const bool narrow = size.x / scale < kNarrow;
  const float height = (narrow ? 2 : 1) * kRow + LanesHeight(lanes) + 22;
  TimelineBoxes boxes;
  boxes.bar = {{0, size.y - height * scale}, size};
  const float low = size.y - (LanesHeight(lanes) + 10) * scale;
  boxes.groove = {{kEdge * scale, low}, {size.x - kEdge * scale, size.y - 10 * scale}};
  return boxes;
}

float ColumnOf(const Box& groove, const timeline::Timeline& whole, double at_s) {
  const double length_s = whole.length_s();
  const double share = length_s > 0 ? (at_s - whole.begin_s) / length_s : 0;
  return groove.low.x + static_cast<float>(std::clamp(share, 0.0, 1.0)) * groove.width();
}

double PositionAt(const Box& groove, const timeline::Timeline& whole, float column) {
  const float share = groove.width() > 0 ? (column - groove.low.x) / groove.width() : 0;
  return whole.begin_s + whole.length_s() * static_cast<double>(std::clamp(share, 0.0f, 1.0f));
}

void DrawTimeline(const Paint& p, const TimelineBoxes& boxes, const TimelineContent& content) {
  const float s = p.scale;
  const Box& groove = boxes.groove;
  // Nothing was drawn below it.
  p.list->AddRectFilled(boxes.bar.low, boxes.bar.high, IM_COL32(16, 22, 30, 255));
  const std::vector<Sign> legend = LegendOf(content.whole);
  const bool narrow = boxes.bar.width() / s < kNarrow;
  const float top = boxes.bar.low.y + 5 * s;
  const float legend_width = WidthOf(p, legend);
  if (narrow) {
    DrawLegend(p, {groove.low.x, top + kRow * s}, legend);
  } else {
    DrawLegend(p, {groove.high.x - legend_width + kLegendGap * s, top}, legend);
  }
  const float position_width = p.Write(p.fonts.strong, {groove.low.x, top - s}, colour::kText,
                                       timeline::PositionText(content.head));
  const float left = groove.low.x + position_width + 24 * s;
  const float space = groove.high.x - left - (narrow ? 0 : legend_width + 10 * s);
  if (space > 60 * s) {
    p.Write(p.fonts.small, {left, top + s}, colour::kFaint,
            p.Fitting(p.fonts.small, content.trial, space));
  }
  float y = groove.low.y;
  for (const timeline::Timeline* const line : content.lanes) {
    DrawLane(p, {{groove.low.x, y}, {groove.high.x, y + kLane * s}}, groove, content.whole, *line);
    y += (kLane + kLaneGap) * s;
  }
  const float x = ColumnOf(groove, content.whole, content.head.at_s);
  p.list->AddRectFilled({x - s, groove.low.y - 4 * s}, {x + s, groove.high.y + 4 * s},
                        colour::kText);
  p.list->AddCircleFilled({x, groove.low.y - 4 * s}, 5 * s, colour::kText);
}

}  // namespace footing::render
