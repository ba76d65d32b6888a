#include "clients/view/render/participant_panel.h"

#include <algorithm>
#include <string>
#include <vector>

#include "clients/view/scene/study_text.h"
#include "clients/view/scene/trial_text.h"
#include "common/base/units.h"

namespace footing::render {
namespace {

constexpr float kParticipantSide = 40, kParticipantTop = 22, kParticipantLineGap = 8;
constexpr float kLeastParticipantWidth = 320;
constexpr ImU32 kBehindParticipant = IM_COL32(16, 22, 30, 226);

struct ParticipantLine {
  ImFont* font = nullptr;
  ImU32 ink = 0;
  std::string text;
};

float HeightOfParticipant(const std::vector<ParticipantLine>& lines, float scale) {
  float height = 2 * kParticipantTop * scale;
  for (const ParticipantLine& line : lines)
    height += line.font->FontSize + kParticipantLineGap * scale;
  return height;
}

std::vector<ParticipantLine> ParticipantLines(const Paint& p, const scene::ParticipantText& text,
                                              float width) {
  std::vector<ParticipantLine> lines;
  const auto add = [&](ImFont* font, ImU32 ink, const std::string& words) {
    for (std::string& line : p.Wrapped(font, words, width)) {
      lines.push_back({font, ink, std::move(line)});
    }
  };
  add(text.aside ? p.fonts.heading : p.fonts.title, colour::kText, text.headline);
  add(text.aside ? p.fonts.heading : p.fonts.count, colour::kAccent, text.count);
  add(p.fonts.heading, colour::kText, text.detail);
  return lines;
}

}  // namespace

void DrawParticipantPanel(const Paint& p, const scene::Model& model,
                          const scene::CharacterPose* pose, std::int64_t now_ns, Box& space) {
  const stream::StudyState& study = model.study.state;
  const stream::TrialState* trial = pose == nullptr ? nullptr : scene::ShownTrial(*pose, study);
  const bool started = trial != nullptr && trial->progress.phase != stream::TrialPhase::kReady;
  const auto text = scene::ParticipantTextOf(
      study, NanosecondsToSeconds(now_ns - model.study.received_ns), started);
  if (!text) return;
  const float s = p.scale;
  const std::vector<ParticipantLine> lines =
      ParticipantLines(p, *text, space.width() - 2 * kParticipantSide * s);
  const float height = HeightOfParticipant(lines, s);
  // What is wrong with the devices is said above it, and comes first.
  if (height > space.height()) return;
  float width = text->aside || text->headline.empty() ? 0 : kLeastParticipantWidth * s;
  for (const ParticipantLine& line : lines) {
    width = std::max(width, p.WidthOf(line.font, line.text) + 2 * kParticipantSide * s);
  }
  width = std::min(width, space.width());
  const float middle = (space.low.x + space.high.x) / 2;
  const float low = text->aside ? space.low.y : space.low.y + (space.height() - height) / 5;
  p.list->AddRectFilled({middle - width / 2, low}, {middle + width / 2, low + height},
                        kBehindParticipant, 14 * s);
  float y = low + (kParticipantTop + kParticipantLineGap / 2) * s;
  for (const ParticipantLine& line : lines) {
    p.WriteCentred(line.font, {middle, y}, line.ink, line.text);
    y += line.font->FontSize + kParticipantLineGap * s;
  }
  if (text->aside) space.low.y += height + 6 * s;
}

}  // namespace footing::render
