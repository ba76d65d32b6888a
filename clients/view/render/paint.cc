#include "clients/view/render/paint.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace footing::render {
namespace {

constexpr const char* kPlain = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr const char* kBold = "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf";
constexpr double kAmberMs = 50;
constexpr double kRedMs = 150;

// Latin letters and the few signs that the screens use.
constexpr ImWchar kSigns[] = {0x20, 0xff, 0x2013, 0x2026, 0x2190, 0x2193, 0};
constexpr ImWchar kCountSigns[] = {' ', '!', '0', ':', 'G', 'G', 'o', 'o', 0};

/// `signs` outlives the font's atlas.
ImFont* Load(const char* path, float pixels, const ImWchar* signs = kSigns) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  std::error_code none;
  if (std::filesystem::exists(path, none)) {
    if (ImFont* font = atlas.AddFontFromFileTTF(path, pixels, nullptr, signs)) return font;
  }
  ImFontConfig config;
  config.SizePixels = pixels;
  return atlas.AddFontDefault(&config);
}

}  // namespace

Fonts LoadFonts(float scale) {
  return {Load(kPlain, 10.5f * scale),
          Load(kPlain, 12.5f * scale),
          Load(kPlain, 15 * scale),
          Load(kBold, 15 * scale),
          Load(kBold, 21 * scale),
          Load(kBold, 40 * scale),
          Load(kBold, 110 * scale, kCountSigns)};
}

ImU32 ColourOf(stream::Gait gait) {
  switch (gait) {
    case stream::Gait::kStep:
      return colour::kAccent;
    case stream::Gait::kWalk:
      return colour::kGood;
    case stream::Gait::kRun:
      return colour::kSecond;
    case stream::Gait::kJump:
      return colour::kThird;
    case stream::Gait::kUnspecified:
      break;
  }
  return colour::kFaint;
}

ImU32 ColourOf(stream::DeviceState state) {
  switch (state) {
    case stream::DeviceState::kLive:
      return colour::kGood;
    case stream::DeviceState::kConnecting:
      return colour::kAccent;
    case stream::DeviceState::kStale:
      return colour::kWarning;
    case stream::DeviceState::kLost:
      return colour::kBad;
    case stream::DeviceState::kUnspecified:
      break;
  }
  return colour::kFaint;
}

ImU32 ColourOf(scene::LinkState state) {
  switch (state) {
    case scene::LinkState::kLive:
      return colour::kGood;
    case scene::LinkState::kConnecting:
      return colour::kAccent;
    case scene::LinkState::kStale:
      return colour::kWarning;
    case scene::LinkState::kRefused:
      return colour::kBad;
  }
  return colour::kFaint;
}

ImU32 ColourOfAge(double age_ms) {
  if (age_ms > kRedMs) return colour::kBad;
  return age_ms > kAmberMs ? colour::kWarning : colour::kGood;
}

namespace {

constexpr float kMargin = 14;
constexpr float kRounding = 10;

}  // namespace

Box Paint::Panel(const Box& box) const {
  list->AddRectFilled(box.low, box.high, colour::kPanel, kRounding * scale);
  list->AddRect(box.low, box.high, colour::kPanelEdge, kRounding * scale, 0, scale);
  const float margin = kMargin * scale;
  return {{box.low.x + margin, box.low.y + margin}, {box.high.x - margin, box.high.y - margin}};
}

float Paint::WidthOf(ImFont* font, std::string_view text) const {
  return font->CalcTextSizeA(font->FontSize, 1e9f, 0, text.data(), text.data() + text.size()).x;
}

float Paint::Write(ImFont* font, ImVec2 at, ImU32 ink, std::string_view text) const {
  list->AddText(font, font->FontSize, at, ink, text.data(), text.data() + text.size());
  return WidthOf(font, text);
}

float Paint::WriteRight(ImFont* font, ImVec2 at, ImU32 ink, std::string_view text) const {
  return Write(font, {at.x - WidthOf(font, text), at.y}, ink, text);
}

float Paint::WriteCentred(ImFont* font, ImVec2 at, ImU32 ink, std::string_view text) const {
  return Write(font, {at.x - WidthOf(font, text) / 2, at.y}, ink, text);
}

std::string Paint::Fitting(ImFont* font, const std::string& text, float width) const {
  if (WidthOf(font, text) <= width) return text;
  std::string cut = text;
  while (!cut.empty() && WidthOf(font, cut + "...") > width) cut.pop_back();
  return cut + "...";
}

std::vector<std::string> Paint::Wrapped(ImFont* font, const std::string& text, float width) const {
  std::vector<std::string> lines;
  std::string line;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    at = end + 1;
    if (word.empty()) continue;
    const std::string longer = line.empty() ? word : line + " " + word;
    if (line.empty() || WidthOf(font, longer) <= width) {
      line = longer;
      continue;
    }
    lines.push_back(Fitting(font, line, width));
    line = word;
  }
  if (!line.empty()) lines.push_back(Fitting(font, line, width));
  return lines;
}

float Paint::Label(ImVec2 at, ImU32 fill, ImU32 letters, std::string_view text) const {
  const float side = 7 * scale, above = 2.5f * scale;
  const float width = WidthOf(fonts.small, text) + 2 * side;
  const float height = fonts.small->FontSize + 2 * above;
  list->AddRectFilled(at, {at.x + width, at.y + height}, fill, height / 2);
  Write(fonts.small, {at.x + side, at.y + above}, letters, text);
  return width;
}

void Paint::Bar(const Box& box, float share, ImU32 ink) const {
  const float round = box.height() / 2;
  list->AddRectFilled(box.low, box.high, colour::kGroove, round);
  const float filled = std::clamp(share, 0.0f, 1.0f) * box.width();
  if (filled < 1) return;
  list->AddRectFilled(box.low, {box.low.x + std::max(filled, 2 * round), box.high.y}, ink, round);
}

void Paint::Dot(ImVec2 centre, float radius, ImU32 ink) const {
  list->AddCircleFilled(centre, radius * scale, ink, 20);
}

ImU32 Faded(ImU32 ink, float opacity) {
  const auto alpha = static_cast<ImU32>(255 * std::clamp(opacity, 0.0f, 1.0f));
  return (ink & ~IM_COL32_A_MASK) | (alpha << IM_COL32_A_SHIFT);
}

}  // namespace footing::render
