#include "clients/view/render/overlay.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "clients/view/scene/words.h"
#include "common/base/units.h"

namespace footing::render {
namespace {

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

/// What each connection waits for, in lines of at most that width, the first one apart.
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
  const float s = p.scale, first = 104 * s, edge = 10 * s;
  float width = 340 * s;
  for (const scene::KeyLine& line : keys) {
    width = std::max(width, first + p.WidthOf(p.fonts.text, line.what) + 40 * s);
  }
  const float height = (70 + 26 * static_cast<float>(keys.size())) * s;
  const ImVec2 low(std::max(0.0f, size.x - width - edge), std::max(0.0f, (size.y - height) / 2));
  const Box box{low, {low.x + width, low.y + height}};
  p.list->AddRectFilled(box.low, box.high, colour::kBehindKeys, 10 * s);
  const Box in = p.Panel(box);
  p.Write(p.fonts.strong, {in.low.x + 8 * s, in.low.y + 2 * s}, colour::kText, "Keys");
  float y = in.low.y + 36 * s;
  for (const auto& [key, what] : keys) {
    p.Write(p.fonts.strong, {in.low.x + 8 * s, y}, colour::kSecond, key);
    p.Write(p.fonts.text, {in.low.x + first, y}, colour::kText, what);
    y += 26 * s;
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

}  // namespace footing::render
