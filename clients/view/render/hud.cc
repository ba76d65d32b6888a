#include "clients/view/render/hud.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "clients/view/render/device_panels.h"
#include "clients/view/render/game_panels.h"
#include "clients/view/render/hud_layout.h"
#include "clients/view/render/person_panels.h"
#include "clients/view/render/strip_panel.h"
#include "clients/view/render/study_panels.h"
#include "clients/view/scene/model.h"
#include "clients/view/scene/text.h"
#include "clients/view/scene/timeline.h"
#include "common/base/units.h"

namespace footing::render {
namespace {

constexpr PanelHeight kBoardPanelHeight{150, 236};
constexpr float kAloneEdge = 10;
constexpr float kFigureTop = 0.42f;  // Share of the picture's height: the biped's head is lower.

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

namespace {

const stream::TrialState* TrialOf(const scene::CharacterPose* pose) {
  return pose != nullptr && pose->trial ? &*pose->trial : nullptr;
}

/// Large text for whoever plays or takes part. A study's participant reads the study's alone, its
/// experimenter none.
std::optional<scene::ParticipantText> StageOf(const HudContent& content,
                                              const scene::CharacterPose* pose, bool subject) {
  const scene::Model& model = content.model;
  const stream::StudyState& study = model.study.state;
  if (scene::ShowsStudy(study)) {
    if (!subject) return std::nullopt;
    const stream::TrialState* trial = pose == nullptr ? nullptr : scene::ShownTrial(*pose, study);
    const bool started = trial != nullptr && trial->progress.phase != stream::TrialPhase::kReady;
    return scene::ParticipantTextOf(
        study, NanosecondsToSeconds(content.now_ns - model.study.received_ns), started);
  }
  if (scene::ShowsGame(model.game, TrialOf(pose))) return scene::GameStage(model.game);
  if (subject || TrialOf(pose) == nullptr) return std::nullopt;
  return scene::TrialStage(*pose->trial);
}

}  // namespace

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
  if (!options.notice.empty()) DrawTitle(p, options.notice, "", notes);
  DrawReplay(p, model, content.now_ns, notes);
  if (!options.hidden) DrawStudyPanel(p, model, content.now_ns, notes);
  const scene::CharacterPose* pose = FirstCharacter(content);
  // The person must know why the character stops, and see it.
  if (pose != nullptr) {
    Box above{notes.low, {notes.high.x, std::max(notes.low.y, kFigureTop * size.y)}};
    DrawLostPanel(p, *pose, above);
    notes.low.y = above.low.y;
  }
  const bool game = scene::ShowsGame(model.game, TrialOf(pose));
  const auto stage = StageOf(content, pose, options.hidden);
  // Before and after a round its stage says all, and the biped is still to be seen below it.
  if (game && (!stage || model.game.phase == stream::GamePhase::kRound))
    DrawGamePanel(p, model.game, notes);
  if (stage) DrawParticipantPanel(p, *stage, notes);
  // A round is a trial: its panel would say the same again.
  if (!game && pose != nullptr) DrawTrialPanel(p, model, *pose, options.hidden, notes);
  if (options.hidden) return DrawLiveKeys(p, content, options, size);
  if (scene::IsWaiting(model)) {
    DrawWaiting(p, model, boxes.middle);
    DrawColumns(p, content, boxes);
  } else {
    DrawLabels(p, content.picture, boxes, size);
    DrawColumns(p, content, boxes);
    DrawNote(p, model, content.now_ns, notes);
    Box messages = boxes.middle;
    DrawWaitingLines(p, model, messages);
    if (IsPerson(pose)) DrawTPosePanel(p, model, *pose, messages);
  }
  if (options.frozen) DrawFrozen(p, notes);
  DrawLiveKeys(p, content, options, size);
}

namespace {

constexpr float kKeyWidth = 104, kKeyGap = 18;  // In the list of keys, in units.
constexpr float kKeysAround = 70;               // Its title and margins.
constexpr double kNoteS = 3;
constexpr double kNoteFadeS = 1;

/// A rounded banner of as many lines as the text needs, from the top of `space`.
void DrawBanner(const Paint& p, Box& space, const std::string& text, ImFont* font, ImU32 fill,
                ImU32 ink) {
  const float s = p.scale, side = 16 * s, line_height = font->FontSize + 3 * s;
  const auto lines = p.Wrapped(font, text, space.width() - 2 * side);
  float width = 0;
  for (const std::string& line : lines) width = std::max(width, p.WidthOf(font, line));
  const float middle = (space.low.x + space.high.x) / 2;
  const float height = line_height * static_cast<float>(lines.size()) + 10 * s;
  const ImVec2 low(middle - width / 2 - side, space.low.y);
  p.list->AddRectFilled(low, {middle + width / 2 + side, low.y + height}, fill, 14 * s);
  float y = low.y + 5 * s;
  for (const std::string& line : lines) {
    p.WriteCentred(font, {middle, y}, ink, line);
    y += line_height;
  }
  space.low.y += height + 6 * s;
}

/// Servers that the connections wait for, in lines of at most `width` pixels, the first one apart.
std::vector<std::vector<std::string>> WaitingTexts(const Paint& p, const scene::Model& model,
                                                   ImFont* font, float width) {
  std::vector<std::vector<std::string>> texts;
  for (const scene::LinkReport& link : model.links) {
    std::vector<std::string> lines;
    for (const std::string& line : scene::WaitingLines(link)) {
      for (std::string& part : p.Wrapped(font, line, width)) lines.push_back(std::move(part));
    }
    if (!lines.empty()) texts.push_back(std::move(lines));
  }
  return texts;
}

}  // namespace

void DrawWaiting(const Paint& p, const scene::Model& model, const Box& box) {
  const float s = p.scale, side = 26 * s;
  const auto texts = WaitingTexts(p, model, p.fonts.text, box.width() - 2 * side);
  float width = std::min(380 * s, box.width()), height = 70 * s;
  for (const auto& lines : texts) {
    for (const std::string& line : lines) {
      width = std::max(width, p.WidthOf(p.fonts.text, line) + 2 * side);
    }
    height += (14 + 22 * static_cast<float>(lines.size())) * s;
  }
  const ImVec2 low((box.low.x + box.high.x - width) / 2,
                   std::max(box.low.y, box.low.y + 0.38f * (box.height() - height)));
  const Box in = p.Panel({low, {low.x + width, low.y + height}});
  const float left = low.x + side;
  p.Write(p.fonts.heading, {left, in.low.y + 6 * s}, colour::kText, "Nothing to show yet");
  float y = in.low.y + 48 * s;
  for (const auto& lines : texts) {
    for (std::size_t i = 0; i < lines.size(); ++i) {
      p.Write(p.fonts.text, {left, y}, i == 0 ? colour::kText : colour::kAccent, lines[i]);
      y += 22 * s;
    }
    y += 14 * s;
  }
}

void DrawWaitingLines(const Paint& p, const scene::Model& model, Box& space) {
  const float s = p.scale, line_height = 17 * s;
  for (const auto& lines : WaitingTexts(p, model, p.fonts.small, space.width() - 20 * s)) {
    float width = 0;
    for (const std::string& line : lines) width = std::max(width, p.WidthOf(p.fonts.small, line));
    const float height = line_height * static_cast<float>(lines.size()) + 6 * s;
    const ImVec2 low(space.low.x, space.high.y - height);
    p.list->AddRectFilled(low, {low.x + width + 20 * s, space.high.y}, colour::kPanel, 8 * s);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      p.Write(p.fonts.small, {low.x + 10 * s, low.y + 3 * s + line_height * static_cast<float>(i)},
              colour::kWarning, lines[i]);
    }
    space.high.y -= height + 6 * s;
  }
}

void DrawKeys(const Paint& p, ImVec2 size, const std::vector<scene::KeyLine>& keys) {
  const float s = p.scale, edge = 10 * s, line_height = 26 * s;
  const float first = kKeyWidth * s, most_high = size.y - 2 * edge - kKeysAround * s;
  const auto rows = static_cast<std::size_t>(std::max(1.0f, most_high / line_height));
  const std::size_t columns = (keys.size() + rows - 1) / rows;
  const std::size_t each = (keys.size() + columns - 1) / columns;
  float text = 0;
  for (const scene::KeyLine& line : keys) {
    text = std::max(text, p.WidthOf(p.fonts.text, line.what));
  }
  const float column = first + text + kKeyGap * s;
  const float width = static_cast<float>(columns) * column + 26 * s;
  const float height = kKeysAround * s + line_height * static_cast<float>(each);
  const ImVec2 low(std::max(0.0f, size.x - width - edge), std::max(0.0f, (size.y - height) / 2));
  const Box box{low, {low.x + width, low.y + height}};
  p.list->AddRectFilled(box.low, box.high, colour::kBehindKeys, 10 * s);
  const Box in = p.Panel(box);
  p.Write(p.fonts.strong, {in.low.x + 8 * s, in.low.y + 2 * s}, colour::kText, "Keys and mouse");
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const float x = in.low.x + static_cast<float>(i / each) * column;
    const float y = in.low.y + 36 * s + static_cast<float>(i % each) * line_height;
    p.Write(p.fonts.strong, {x + 8 * s, y}, colour::kSecond, keys[i].key);
    p.Write(p.fonts.text, {x + first, y}, colour::kText, keys[i].what);
  }
}

void DrawTitle(const Paint& p, const std::string& title, const std::string& over, Box& space) {
  DrawBanner(p, space, title, p.fonts.strong, colour::kPanel, colour::kText);
  if (!over.empty()) {
    DrawBanner(p, space, over, p.fonts.strong, colour::kText, IM_COL32(20, 20, 20, 255));
  }
}

void DrawSimulated(const Paint& p, const Box& row) {
  Box space = row;
  DrawBanner(p, space, "SIMULATED INPUT", p.fonts.strong, colour::kSecond,
             IM_COL32(40, 26, 0, 255));
}

void DrawReplay(const Paint& p, const scene::Model& model, std::int64_t now_ns, Box& space) {
  if (!model.replay.At(now_ns)) return;
  DrawBanner(p, space, scene::ReplayLine(model.replay.FromFallS(now_ns)), p.fonts.strong,
             colour::kAccent, IM_COL32(20, 20, 20, 255));
}

void DrawNote(const Paint& p, const scene::Model& model, std::int64_t now_ns, Box& space) {
  if (!model.last.note) return;
  const double age_s = NanosecondsToSeconds(now_ns - model.last.note->received_ns);
  if (age_s > kNoteS) return;
  const auto opacity = static_cast<float>(std::clamp((kNoteS - age_s) / kNoteFadeS, 0.0, 1.0));
  const scene::NoteKind kind = model.last.note->kind;
  const auto ink = kind == scene::NoteKind::kFall     ? colour::kBad
                   : kind == scene::NoteKind::kServer ? colour::kWarning
                                                      : colour::kText;
  DrawBanner(p, space, model.last.note->text, p.fonts.text, Faded(colour::kPanel, 0.7f * opacity),
             Faded(ink, opacity));
}

void DrawFrozen(const Paint& p, Box& space) {
  DrawBanner(p, space, "frozen", p.fonts.small, colour::kText, IM_COL32(20, 20, 20, 255));
}

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
constexpr ImU32 kMarkerColour = IM_COL32(120, 180, 255, 255);
constexpr ImU32 kEventColour = IM_COL32(214, 224, 150, 255);
constexpr float kNearMark = 5;  // So near the mouse points at a mark.

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
  if (!line.markers.empty()) {
    signs.push_back({kMarkerColour, "marker " + std::to_string(line.markers.size())});
  }
  if (!line.events.empty()) {
    signs.push_back({kEventColour, "event " + std::to_string(line.events.size())});
  }
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
  for (const timeline::MarkerMark& marker : line.markers) {
    const float x = ColumnOf(groove, whole, marker.at_s);
    p.list->AddRectFilled({x - 0.75f * s, lane.low.y - 3 * s}, {x + 0.75f * s, lane.high.y + 3 * s},
                          kMarkerColour);
  }
  const float middle = (lane.low.y + lane.high.y) / 2;
  for (const timeline::EventMark& event : line.events) {
    const float x = ColumnOf(groove, whole, event.at_s);
    p.list->AddQuadFilled({x, middle - 5 * s}, {x + 4 * s, middle}, {x, middle + 5 * s},
                          {x - 4 * s, middle}, kEventColour);
  }
}

/// Text of what the mouse points at, over the bar.
void DrawPointed(const Paint& p, const TimelineBoxes& boxes, const TimelineContent& content) {
  const Box& groove = boxes.groove;
  if (!p.pointer || p.pointer->y < groove.low.y - kRow * p.scale) return;
  const float s = p.scale, x = std::clamp(p.pointer->x, groove.low.x, groove.high.x);
  const double at_s = PositionAt(groove, content.whole, x);
  const double within_s = PositionAt(groove, content.whole, x + kNearMark * s) - at_s;
  const std::string text = timeline::TextAt(content.whole, at_s, within_s);
  const float half = p.WidthOf(p.fonts.small, text) / 2 + 8 * s, height = 20 * s;
  const float middle = std::clamp(x, half, std::max(half, boxes.bar.high.x - half));
  const float top = boxes.bar.low.y - height - 4 * s;
  p.list->AddLine({x, groove.low.y - 3 * s}, {x, groove.high.y + 3 * s}, colour::kFaint, s);
  p.list->AddRectFilled({middle - half, top}, {middle + half, top + height},
                        IM_COL32(16, 22, 30, 225), 6 * s);
  p.WriteCentred(p.fonts.small, {middle, top + 2.5f * s}, colour::kText, text);
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
  DrawPointed(p, boxes, content);
}

}  // namespace footing::render
