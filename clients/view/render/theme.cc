#include "clients/view/render/theme.h"

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

}  // namespace footing::render
