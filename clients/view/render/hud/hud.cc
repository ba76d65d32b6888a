#include "clients/view/render/hud/hud.h"

#include "clients/view/render/hud/board_panel.h"
#include "clients/view/render/hud/body_panel.h"
#include "clients/view/render/hud/character_panel.h"
#include "clients/view/render/hud/device_panel.h"
#include "clients/view/render/hud/game_panel.h"
#include "clients/view/render/hud/hud_layout.h"
#include "clients/view/render/hud/interface_panel.h"
#include "clients/view/render/hud/labels.h"
#include "clients/view/render/hud/layout_panel.h"
#include "clients/view/render/hud/lost_panel.h"
#include "clients/view/render/hud/overlay.h"
#include "clients/view/render/hud/strip_panel.h"
#include "clients/view/render/hud/study_panel.h"
#include "clients/view/render/hud/t_pose_panel.h"
#include "clients/view/render/hud/trial_panel.h"
#include "clients/view/scene/game_text.h"

namespace footing::render {
namespace {

constexpr PanelHeight kBoardPanelHeight{150, 236};

const scene::CharacterPose* FirstCharacter(const HudContent& content) {
  return content.frame.characters.empty() ? nullptr : &content.frame.characters.front();
}

bool IsPerson(const scene::CharacterPose* pose) { return pose != nullptr && pose->body; }

HudNeeds NeedsOf(const HudContent& content, const HudOptions& options) {
  HudNeeds needs;
  if (options.hidden || !options.columns || scene::IsWaiting(content.model)) return needs;
  const scene::CharacterPose* pose = FirstCharacter(content);
  const bool person = IsPerson(pose);
  if (person) {
    needs.character = BodyPanelHeight(*pose, content.picture);
  } else if (pose != nullptr) {
    needs.character = CharacterPanelHeight(options.phases);
    needs.interface = InterfacePanelHeight(pose->interface);
  }
  if (!person) needs.strips = StripPanelHeight(content.past.strips);
  needs.devices = DevicePanelHeight(content.model);
  if (person || !content.model.boards.empty()) needs.boards = kBoardPanelHeight;
  return needs;
}

void DrawColumns(const Paint& p, const HudContent& content, const HudBoxes& boxes) {
  const scene::CharacterPose* pose = FirstCharacter(content);
  if (boxes.character && IsPerson(pose)) {
    DrawBodyPanel(p, *boxes.character, *pose, content.picture);
  } else if (boxes.character && pose != nullptr) {
    DrawCharacterPanel(p, *boxes.character, content.past, *pose, content.past_ns);
  }
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

}  // namespace

HudBoxes BoxesOf(const HudContent& content, const HudOptions& options, ImVec2 size, float scale) {
  return LayOut(size, scale, NeedsOf(content, options));
}

void DrawHud(const Paint& p, const HudContent& content, const HudOptions& options, ImVec2 size) {
  const scene::Model& model = content.model;
  const HudBoxes boxes = BoxesOf(content, options, size, p.scale);
  // Simulated input is stamped at all times, in subject mode too.
  if (scene::IsSimulated(model)) DrawSimulated(p, boxes.stamp);
  Box notes = boxes.middle;
  if (!options.title.empty()) DrawTitle(p, options.title, options.over, notes);
  DrawReplay(p, model, content.now_ns, notes);
  if (!options.hidden) DrawStudyPanel(p, model, content.now_ns, notes);
  const scene::CharacterPose* pose = FirstCharacter(content);
  // The person must know why the character stops.
  if (pose != nullptr) DrawLostPanel(p, *pose, notes);
  // A round is a trial: its panel would say the same again.
  if (scene::ShowsGame(model.game, pose != nullptr && pose->trial ? &*pose->trial : nullptr)) {
    DrawGamePanel(p, model.game, notes);
  } else if (pose != nullptr) {
    DrawTrialPanel(p, model, *pose, options.hidden, notes);
  }
  if (options.hidden) return;
  if (scene::IsWaiting(model)) {
    DrawWaiting(p, model, boxes.middle);
  } else {
    if (IsPerson(pose)) DrawLabels(p, content.picture, boxes, size);
    DrawColumns(p, content, boxes);
    DrawNote(p, model, content.now_ns, notes);
    Box messages = boxes.middle;
    DrawWaitingLines(p, model, messages);
    if (IsPerson(pose)) DrawTPosePanel(p, model, *pose, messages);
  }
  if (options.frozen) DrawFrozen(p, notes);
  if (options.keys) DrawKeys(p, size, false);
}

}  // namespace footing::render
