#pragma once

#include <cstdint>
#include <string>

#include "clients/view/render/hud_layout.h"
#include "clients/view/scene/model.h"
#include "clients/view/scene/stage.h"

namespace footing::render {

/// The panels at both sides that are shown, where they have something to show.
struct PanelChoice {
  bool character = true, strips = true, devices = true, interface = true, boards = true;
};

/// What the user has switched on.
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
  bool columns = true;        ///< The panels at both sides.
  PanelChoice panels;         ///< Which of them.
  bool has_subjects = false;  ///< There are subject files for the key N.
  bool calibrates = false;    ///< There is a camera file for the key C.
  bool camera = false;        ///< The preview of footing-camera in a corner.
  bool camera_alone = false;  ///< And nothing else.
  std::string title;          ///< Above all else; empty: none.
  std::string over;           ///< A word below it: "ended"; empty: none.
};

/// What the panels show.
struct HudContent {
  const scene::Picture& picture;
  const scene::Model& model;
  const scene::WorldFrame& frame;
  std::int64_t now_ns = 0;
  /// What slides with time (strips, traces, phase bands): the model and the time at which the
  /// scene was frozen, else those of now.
  const scene::Model& past;
  std::int64_t past_ns = 0;
};

/// Where the panels go that this content has.
HudBoxes BoxesOf(const HudContent& content, const HudOptions& options, ImVec2 size, float scale);

/// All panels over the picture.
void DrawHud(const Paint& paint, const HudContent& content, const HudOptions& options, ImVec2 size);

}  // namespace footing::render
