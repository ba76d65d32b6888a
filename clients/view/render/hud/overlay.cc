#include "clients/view/render/hud/overlay.h"

#include <algorithm>
#include <array>

#include "clients/view/scene/words.h"
#include "common/units/units.h"

namespace footing::render {
namespace {

constexpr double kNoteS = 3;
constexpr double kNoteFadeS = 1;

}  // namespace

void DrawWaiting(const Paint& p, const scene::Model& model, ImVec2 size) {
  const float s = p.scale;
  std::vector<std::vector<std::string>> texts;
  float width = 380 * s;
  for (const scene::LinkReport& link : model.links) {
    texts.push_back(scene::WaitingLines(link));
    for (const std::string& line : texts.back()) {
      width = std::max(width, p.WidthOf(p.fonts.text, line) + 60 * s);
    }
  }
  const float height = (84 + 58 * static_cast<float>(texts.size())) * s;
  const ImVec2 low((size.x - width) / 2, size.y * 0.40f - height / 2);
  const Box in = p.Panel({low, {low.x + width, low.y + height}});
  const float left = in.low.x + 12 * s;
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

void DrawWaitingLines(const Paint& p, const scene::Model& model, ImVec2 at) {
  float y = at.y - 22 * p.scale;
  for (const scene::LinkReport& link : model.links) {
    const auto lines = scene::WaitingLines(link);
    if (lines.empty()) continue;
    const std::string text = lines[0] + "   " + lines[1];
    const float s = p.scale, width = p.WidthOf(p.fonts.small, text) + 20 * s;
    p.list->AddRectFilled({at.x, y}, {at.x + width, y + 22 * s}, colour::kPanel, 8 * s);
    p.Write(p.fonts.small, {at.x + 10 * s, y + 4 * s}, colour::kWarning, text);
    y -= 26 * s;
  }
}

void DrawKeys(const Paint& p, ImVec2 size) {
  static constexpr std::array<std::array<const char*, 2>, 9> kKeys{{
      {"?", "show or hide this list"},
      {"F", "force arrows at the feet"},
      {"P", "states of the gait controller"},
      {"R", "the last fall again, in slow motion"},
      {"T", "take the T-pose anew"},
      {"N", "the next subject"},
      {"O", "the reference beside the body, or over it"},
      {"space", "freeze the picture"},
      {"Esc, Q", "leave"},
  }};
  const float s = p.scale, width = 340 * s;
  const float height = (70 + 26 * static_cast<float>(kKeys.size())) * s;
  const ImVec2 low((size.x - width) / 2, (size.y - height) / 2);
  const Box in = p.Panel({low, {low.x + width, low.y + height}});
  p.Write(p.fonts.strong, {in.low.x + 8 * s, in.low.y + 2 * s}, colour::kText, "Keys");
  float y = in.low.y + 36 * s;
  for (const auto& [key, what] : kKeys) {
    p.Write(p.fonts.strong, {in.low.x + 8 * s, y}, colour::kSecond, key);
    p.Write(p.fonts.text, {in.low.x + 92 * s, y}, colour::kText, what);
    y += 26 * s;
  }
}

void DrawSimulated(const Paint& p, ImVec2 size) {
  const float s = p.scale;
  const char* text = "SIMULATED INPUT";
  const float width = p.WidthOf(p.fonts.strong, text) + 32 * s;
  const ImVec2 low((size.x - width) / 2, 20 * s), high((size.x + width) / 2, 48 * s);
  p.list->AddRectFilled(low, high, colour::kSecond, 14 * s);
  p.WriteCentred(p.fonts.strong, {size.x / 2, low.y + 5 * s}, IM_COL32(40, 26, 0, 255), text);
}

void DrawReplay(const Paint& p, const scene::Model& model, std::int64_t now_ns, ImVec2 size) {
  if (!model.replay.At(now_ns)) return;
  const float s = p.scale;
  const std::string text = scene::ReplayLine(model.replay.FromFallS(now_ns));
  const float width = p.WidthOf(p.fonts.strong, text) + 32 * s;
  const ImVec2 low((size.x - width) / 2, 92 * s), high((size.x + width) / 2, 120 * s);
  p.list->AddRectFilled(low, high, colour::kAccent, 14 * s);
  p.WriteCentred(p.fonts.strong, {size.x / 2, low.y + 5 * s}, IM_COL32(20, 20, 20, 255), text);
}

void DrawNote(const Paint& p, const scene::Model& model, std::int64_t now_ns, ImVec2 size) {
  if (!model.last_note) return;
  const double age_s = NanosecondsToSeconds(now_ns - model.last_note_ns);
  if (age_s > kNoteS) return;
  const auto opacity = static_cast<float>(std::clamp((kNoteS - age_s) / kNoteFadeS, 0.0, 1.0));
  const float s = p.scale;
  const std::string& text = model.last_note->text;
  const float width = p.WidthOf(p.fonts.text, text) + 32 * s;
  const ImVec2 low((size.x - width) / 2, 58 * s), high((size.x + width) / 2, 86 * s);
  p.list->AddRectFilled(low, high, Faded(colour::kPanel, 0.7f * opacity), 14 * s);
  const bool fall = model.last_note->kind == scene::NoteKind::kFall;
  p.WriteCentred(p.fonts.text, {size.x / 2, low.y + 5 * s},
                 Faded(fall ? colour::kBad : colour::kText, opacity), text);
}

}  // namespace footing::render
