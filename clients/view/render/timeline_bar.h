#pragma once

#include <string>
#include <vector>

#include "clients/view/render/paint.h"
#include "clients/view/scene/play_head.h"
#include "clients/view/scene/timeline.h"

namespace footing::render {

/// What the timeline at the bottom of the picture shows.
struct TimelineContent {
  const timeline::Timeline& whole;               ///< Of all recordings.
  std::vector<const timeline::Timeline*> lanes;  ///< One a recording.
  timeline::PlayHead head;
  std::string trial;  ///< What goes on at the head.
};

/// Where it lies, in pixels.
struct TimelineBoxes {
  Box bar;
  Box groove;  ///< From the timeline's beginning to its end.
};
TimelineBoxes LayOutTimeline(ImVec2 size, float scale, std::size_t lanes);

/// The column of pixels of a position, within the groove, and back.
float ColumnOf(const Box& groove, const timeline::Timeline& whole, double at_s);
double PositionAt(const Box& groove, const timeline::Timeline& whole, float column);

ImU32 ColourOf(stream::FailureCause cause);

/// Position, trials with start and finish, failures coloured by kind with a legend, tasks.
void DrawTimeline(const Paint& paint, const TimelineBoxes& boxes, const TimelineContent& content);

}  // namespace footing::render
