#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "clients/view/render/hud_layout.h"
#include "clients/view/render/paint.h"
#include "clients/view/scene/model.h"
#include "clients/view/scene/stage.h"
#include "clients/view/scene/timeline.h"

namespace footing::render {

/// The panels at both sides that are shown, where they have something to show.
struct PanelChoice {
  bool character = true, strips = true, devices = true, interface = true, boards = true;
};

/// Options that the user has switched on.
struct HudOptions {
  bool hidden = false;  ///< Subject mode: the world alone.
  bool keys = false;
  bool phases = true;
  bool forces = false;
  bool overlay_reference = false;
  bool frozen = false;
  bool replay_asked = false;  ///< Key presses that wait for their action.
  bool calibration_asked = false;
  bool calibration_end_asked = false;
  bool columns = true;            ///< The panels at both sides.
  PanelChoice panels;             ///< Panels shown.
  bool has_subjects = false;      ///< There are subject files for the key N.
  bool calibrates = false;        ///< There is a camera file for the key C.
  bool camera = false;            ///< The preview of footing-camera in a corner.
  bool camera_alone = false;      ///< Shows the preview and nothing else.
  std::string title;              ///< Above all else; empty: none.
  std::string over;               ///< A word below it: "ended"; empty: none.
  std::string notice;             ///< A line for the person at the viewer; empty: none.
  scene::TimeWindow window;       ///< Time that the strips show.
  std::optional<ImVec2> pointer;  ///< The mouse, pixels of the picture.
};

/// Content of the panels.
struct HudContent {
  const scene::Picture& picture;
  const scene::Model& model;
  const scene::WorldFrame& frame;
  std::int64_t now_ns = 0;
  /// Model and time of all that slides with time (strips, traces, phase bands): those at which the
  /// scene was frozen, else the present ones.
  const scene::Model& past;
  std::int64_t past_ns = 0;
};

/// Places of the panels that this content has.
HudBoxes BoxesOf(const HudContent& content, const HudOptions& options, ImVec2 size, float scale);

/// All panels over the picture.
void DrawHud(const Paint& paint, const HudContent& content, const HudOptions& options, ImVec2 size);

/// Servers that the viewer waits for and how to start them; shown until data come.
void DrawWaiting(const Paint& paint, const scene::Model& model, const Box& box);
/// A few small lines for each connection that is not live, from the bottom of `space` upwards;
/// takes away from `space` what they fill.
void DrawWaitingLines(const Paint& paint, const scene::Model& model, Box& space);
/// The list of keys, at the right: the figure in the middle stays in sight. In two columns where
/// one is too high for the picture.
void DrawKeys(const Paint& paint, ImVec2 size, const std::vector<scene::KeyLine>& keys);
/// Title of several recordings shown together, and their state. A banner as those below.
void DrawTitle(const Paint& paint, const std::string& title, const std::string& over, Box& space);
/// "SIMULATED INPUT" in the middle of a row.
void DrawSimulated(const Paint& paint, const Box& row);
/// Moment of the last fall that is shown again; nothing while none is. This and what follows is a
/// banner from the top of `space`, and takes away from `space` what it fills.
void DrawReplay(const Paint& paint, const scene::Model& model, std::int64_t now_ns, Box& space);
/// The last event, fading after 3 s.
void DrawNote(const Paint& paint, const scene::Model& model, std::int64_t now_ns, Box& space);
/// Notice that the picture is frozen.
void DrawFrozen(const Paint& paint, Box& space);

/// Content of the timeline at the bottom of the picture.
struct TimelineContent {
  const timeline::Timeline& whole;               ///< Timeline of all recordings.
  std::vector<const timeline::Timeline*> lanes;  ///< One a recording.
  timeline::PlayHead head;
  std::string trial;  ///< Trial at the head, as text.
};

/// Place of the timeline, pixels.
struct TimelineBoxes {
  Box bar;
  Box groove;  ///< From the timeline's beginning to its end.
};
/// Place of a timeline with that many lanes in a picture of that size.
TimelineBoxes LayOutTimeline(ImVec2 size, float scale, std::size_t lanes);

/// The column of pixels of a position, within the groove, and back.
float ColumnOf(const Box& groove, const timeline::Timeline& whole, double at_s);
double PositionAt(const Box& groove, const timeline::Timeline& whole, float column);

/// Colour of a failure's mark.
ImU32 ColourOf(stream::FailureCause cause);

/// Position, trials with start and finish, failures coloured by kind with a legend, tasks, markers
/// and other events; over it the text of what the mouse points at.
void DrawTimeline(const Paint& paint, const TimelineBoxes& boxes, const TimelineContent& content);

}  // namespace footing::render
