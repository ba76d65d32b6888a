#include "clients/view/render/hud.h"

#include <algorithm>

#include "clients/view/render/board_panel.h"
#include "clients/view/render/body_panel.h"
#include "clients/view/render/calibration_panel.h"
#include "clients/view/render/camera_panel.h"
#include "clients/view/render/character_panel.h"
#include "clients/view/render/device_panel.h"
#include "clients/view/render/game_panel.h"
#include "clients/view/render/hud_layout.h"
#include "clients/view/render/interface_panel.h"
#include "clients/view/render/labels.h"
#include "clients/view/render/layout_panel.h"
#include "clients/view/render/lost_panel.h"
#include "clients/view/render/overlay.h"
#include "clients/view/render/participant_panel.h"
#include "clients/view/render/strip_panel.h"
#include "clients/view/render/study_panel.h"
#include "clients/view/render/t_pose_panel.h"
#include "clients/view/render/trial_panel.h"
#include "clients/view/scene/game_text.h"
#include "clients/view/scene/live_keys.h"

namespace footing::render {
namespace {

constexpr PanelHeight kBoardPanelHeight{150, 236};
constexpr float kAloneEdge = 10;
constexpr float kFigureTop = 0.42f;  // Of the picture's height: the biped's head is lower.

const scene::CharacterPose* FirstCharacter(const HudContent& content) {
  return content.frame.characters.empty() ? nullptr : &content.frame.characters.front();
}

bool IsPerson(const scene::CharacterPose* pose) { return pose != nullptr && pose->body; }

HudNeeds NeedsOf(const HudContent& content, const HudOptions& options) {
  HudNeeds needs;
  if (options.hidden || !options.columns) return needs;
  if (options.camera) needs.camera = CameraPanelHeight(content.model.observed.camera);
  if (scene::IsWaiting(content.model)) return needs;
  needs.devices = DevicePanelHeight(content.model);
  if (content.model.observed.calibration) return needs;
  const scene::CharacterPose* pose = FirstCharacter(content);
  const bool person = IsPerson(pose);
  if (person) {
    needs.character = BodyPanelHeight(*pose, content.picture);
  } else if (pose != nullptr) {
    needs.character = CharacterPanelHeight(options.phases);
    needs.interface = InterfacePanelHeight(pose->interface);
  }
  if (!person) needs.strips = StripPanelHeight(content.past.strips);
  if (person || !content.model.boards.empty()) needs.boards = kBoardPanelHeight;
  const PanelChoice& shown = options.panels;
  if (!shown.character) needs.character = {};
  if (!shown.strips) needs.strips = {};
  if (!shown.devices) needs.devices = {};
  if (!shown.interface) needs.interface = {};
  if (!shown.boards) needs.boards = {};
  return needs;
}

void DrawColumns(const Paint& p, const HudContent& content, const HudBoxes& boxes) {
  const scene::CharacterPose* pose = FirstCharacter(content);
  if (boxes.character && IsPerson(pose)) {
    DrawBodyPanel(p, *boxes.character, *pose, content.picture);
  } else if (boxes.character && pose != nullptr) {
    DrawCharacterPanel(p, *boxes.character, content.past, *pose, content.past_ns);
  }
  if (boxes.camera)
    DrawCameraPanel(p, *boxes.camera, content.model.observed.camera, content.now_ns);
  if (boxes.strips) DrawStripPanel(p, *boxes.strips, content.past.strips, content.past_ns);
  if (boxes.devices) DrawDevicePanel(p, *boxes.devices, content.model, content.now_ns);
  if (boxes.interface && pose != nullptr) {
    DrawInterfacePanel(p, *boxes.interface, pose->interface);
  }
  if (boxes.boards && IsPerson(pose)) {
    DrawLayoutPanel(p, *boxes.boards, content.past, *pose, content.past_ns);
  } else if (boxes.boards) {
    DrawBoardPanel(p, *boxes.boards, content.past, content.past_ns);
  }
}

void DrawLiveKeys(const Paint& p, const HudContent& content, const HudOptions& options,
                  ImVec2 size) {
  if (!options.keys) return;
  DrawKeys(p, size,
           scene::LiveKeyLines(
               scene::ContextOf(content.model, options.has_subjects, options.calibrates)));
}

/// In place of all that belongs to a character.
void DrawCalibration(const Paint& p, const HudContent& content, const HudBoxes& boxes,
                     ImVec2 size) {
  DrawLabels(p, content.picture, boxes, size);
  DrawColumns(p, content, boxes);
  Box space = boxes.middle;
  DrawNote(p, content.model, content.now_ns, space);
  const auto& links = content.model.links;
  const bool has_sensors = std::any_of(links.begin(), links.end(), [](const auto& link) {
    return link.server_id == "footingd" && link.state == scene::LinkState::kLive;
  });
  if (!has_sensors) DrawWaitingLines(p, content.model, space);  // No other server is needed.
  DrawCalibrationPanel(p, *content.model.observed.calibration, space);
}

}  // namespace

HudBoxes BoxesOf(const HudContent& content, const HudOptions& options, ImVec2 size, float scale) {
  return LayOut(size, scale, NeedsOf(content, options));
}

void DrawHud(const Paint& p, const HudContent& content, const HudOptions& options, ImVec2 size) {
  const scene::Model& model = content.model;
  if (options.camera_alone) {
    const float edge = kAloneEdge * p.scale;
    DrawCameraPanel(p, {{edge, edge}, {size.x - edge, size.y - edge}}, model.observed.camera,
                    content.now_ns);
    DrawLiveKeys(p, content, options, size);
    return;
  }
  const HudBoxes boxes = BoxesOf(content, options, size, p.scale);
  // Simulated input is stamped at all times, in subject mode too.
  if (scene::IsSimulated(model)) DrawSimulated(p, boxes.stamp);
  if (model.observed.calibration) {
    DrawCalibration(p, content, boxes, size);
    DrawLiveKeys(p, content, options, size);
    return;
  }
  Box notes = boxes.middle;
  if (!options.title.empty()) DrawTitle(p, options.title, options.over, notes);
  DrawReplay(p, model, content.now_ns, notes);
  if (!options.hidden) DrawStudyPanel(p, model, content.now_ns, notes);
  const scene::CharacterPose* pose = FirstCharacter(content);
  // The person must know why the character stops, and see it.
  if (pose != nullptr) {
    Box above{notes.low, {notes.high.x, std::max(notes.low.y, kFigureTop * size.y)}};
    DrawLostPanel(p, *pose, above);
    notes.low.y = above.low.y;
  }
  if (options.hidden) DrawParticipantPanel(p, model, pose, content.now_ns, notes);
  // A round is a trial: its panel would say the same again.
  if (scene::ShowsGame(model.game, pose != nullptr && pose->trial ? &*pose->trial : nullptr)) {
    DrawGamePanel(p, model.game, notes);
  } else if (pose != nullptr) {
    DrawTrialPanel(p, model, *pose, options.hidden, notes);
  }
  if (options.hidden) return DrawLiveKeys(p, content, options, size);
  if (scene::IsWaiting(model)) {
    DrawWaiting(p, model, boxes.middle);
    DrawColumns(p, content, boxes);
  } else {
    if (IsPerson(pose)) DrawLabels(p, content.picture, boxes, size);
    DrawColumns(p, content, boxes);
    DrawNote(p, model, content.now_ns, notes);
    Box messages = boxes.middle;
    DrawWaitingLines(p, model, messages);
    if (IsPerson(pose)) DrawTPosePanel(p, model, *pose, messages);
  }
  if (options.frozen) DrawFrozen(p, notes);
  DrawLiveKeys(p, content, options, size);
}

}  // namespace footing::render
