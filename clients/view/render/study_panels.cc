#include "clients/view/render/study_panels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "clients/view/scene/stage.h"
#include "clients/view/scene/text.h"
#include "common/base/units.h"

namespace footing::render {
namespace {

constexpr float kWidestPanel = 460;
constexpr float kBothMargins = 28;  // Margins of a panel, both sides together.
constexpr float kBetweenLines = 3;

struct Line {
  ImFont* font = nullptr;
  ImU32 ink = 0;
  std::string text;
};

}  // namespace

void DrawStudyPanel(const Paint& p, const scene::Model& model, std::int64_t now_ns, Box& space) {
  const stream::StudyState& study = model.study.state;
  if (!scene::ShowsStudy(study)) return;
  const float s = p.scale;
  const float width = std::min(space.width(), kWidestPanel * s);
  const float inner = width - kBothMargins * s;
  const std::string clock =
      scene::StudyClock(study, NanosecondsToSeconds(now_ns - model.study.received_ns));
  const float clock_width = clock.empty() ? 0 : p.WidthOf(p.fonts.heading, clock) + 8 * s;
  std::vector<Line> lines;
  const auto add = [&](ImFont* font, ImU32 ink, const std::string& text, float wrap) {
    for (std::string& line : p.Wrapped(font, text, wrap))
      lines.push_back({font, ink, std::move(line)});
  };
  add(p.fonts.strong, colour::kText, scene::StudyTitle(study), inner - clock_width);
  add(p.fonts.strong, colour::kAccent, study.doing, inner - clock_width);
  add(p.fonts.small, colour::kText, scene::StudyKeys(study), inner);
  add(p.fonts.small, colour::kFaint, scene::StudyNext(study), inner);
  float height = kBothMargins * s;
  for (const Line& line : lines) height += line.font->FontSize + kBetweenLines * s;
  if (height > space.height()) return;
  const float middle = (space.low.x + space.high.x) / 2;
  const Box in =
      p.Panel({{middle - width / 2, space.low.y}, {middle + width / 2, space.low.y + height}});
  p.WriteRight(p.fonts.heading, {in.high.x, in.low.y}, colour::kText, clock);
  float y = in.low.y;
  for (const Line& line : lines) {
    p.Write(line.font, {in.low.x, y}, line.ink, line.text);
    y += line.font->FontSize + kBetweenLines * s;
  }
  space.low.y += height + 6 * s;
}

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

void DrawParticipantPanel(const Paint& p, const scene::ParticipantText& text, Box& space) {
  const float s = p.scale;
  const std::vector<ParticipantLine> lines =
      ParticipantLines(p, text, space.width() - 2 * kParticipantSide * s);
  const float height = HeightOfParticipant(lines, s);
  // A fault of the devices is shown above it, and comes first.
  if (height > space.height()) return;
  float width = text.aside || text.headline.empty() ? 0 : kLeastParticipantWidth * s;
  for (const ParticipantLine& line : lines) {
    width = std::max(width, p.WidthOf(line.font, line.text) + 2 * kParticipantSide * s);
  }
  width = std::min(width, space.width());
  const float middle = (space.low.x + space.high.x) / 2;
  const float low = text.aside ? space.low.y : space.low.y + (space.height() - height) / 5;
  p.list->AddRectFilled({middle - width / 2, low}, {middle + width / 2, low + height},
                        kBehindParticipant, 14 * s);
  float y = low + (kParticipantTop + kParticipantLineGap / 2) * s;
  for (const ParticipantLine& line : lines) {
    p.WriteCentred(line.font, {middle, y}, line.ink, line.text);
    y += line.font->FontSize + kParticipantLineGap * s;
  }
  if (text.aside) space.low.y += height + 6 * s;
}

namespace {

constexpr std::array<ImU32, 2> kInks{colour::kAccent, colour::kSecond};
constexpr ImU32 kTotal = IM_COL32(255, 93, 115, 255);
constexpr double kMarginM = 0.03;

/// W from above: x up, y to the left.
struct Plan {
  ImVec2 centre{0, 0};
  Eigen::Vector2d middle_m = Eigen::Vector2d::Zero();
  double pixels_per_m = 1;

  ImVec2 At(const Eigen::Vector2d& p_m) const {
    return {centre.x - static_cast<float>((p_m.y() - middle_m.y()) * pixels_per_m),
            centre.y - static_cast<float>((p_m.x() - middle_m.x()) * pixels_per_m)};
  }
};

std::array<Eigen::Vector2d, 4> CornersOf(const scene::PlacedBoard& board) {
  const double x = board.geometry.plate_x_m / 2, y = board.geometry.plate_y_m / 2;
  return {board.InWorld(-x, -y), board.InWorld(x, -y), board.InWorld(x, y), board.InWorld(-x, y)};
}

Plan FitPlan(const std::array<scene::PlacedBoard, 2>& boards, const Box& space) {
  Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
  for (const scene::PlacedBoard& board : boards) {
    for (const Eigen::Vector2d& corner : CornersOf(board)) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  }
  Plan plan;
  plan.centre = {(space.low.x + space.high.x) / 2, (space.low.y + space.high.y) / 2};
  plan.middle_m = 0.5 * (low + high);
  const Eigen::Vector2d span = high - low + Eigen::Vector2d::Constant(kMarginM);
  plan.pixels_per_m = std::min(static_cast<double>(space.width()) / std::max(span.y(), 0.1),
                               static_cast<double>(space.height()) / std::max(span.x(), 0.1));
  return plan;
}

void DrawPlate(const Paint& p, const Plan& plan, const scene::PlacedBoard& board, ImU32 ink) {
  const auto corners = CornersOf(board);
  std::array<ImVec2, 4> at;
  for (std::size_t i = 0; i < 4; ++i) at[i] = plan.At(corners[i]);
  p.list->AddConvexPolyFilled(at.data(), 4, IM_COL32(255, 255, 255, board.live ? 26 : 10));
  p.list->AddPolyline(at.data(), 4, Faded(ink, board.live ? 0.8f : 0.3f), ImDrawFlags_Closed,
                      1.5f * p.scale);
  // The edge with the power button.
  const ImVec2 a = plan.At(board.InWorld(-0.06, -0.5 * board.geometry.plate_y_m));
  const ImVec2 b = plan.At(board.InWorld(0.06, -0.5 * board.geometry.plate_y_m));
  p.list->AddLine(a, b, ink, 4 * p.scale);
}

void DrawCells(const Paint& p, const Plan& plan, const scene::PlacedBoard& board, ImU32 ink) {
  const float s = p.scale;
  const auto sensors = board.Sensors();
  const auto loads = board.Loads();
  for (std::size_t i = 0; i < 4; ++i) {
    const double kg = NewtonsToKilograms(loads[i]);
    // The number stands inside of its cell, towards the board's middle.
    const Eigen::Vector2d inside =
        sensors[i] + 0.22 * (Eigen::Vector2d(board.pose.x_m, board.pose.y_m) - sensors[i]);
    const ImVec2 at = plan.At(inside), cell = plan.At(sensors[i]);
    p.list->AddCircleFilled(cell, (2 + 0.16f * static_cast<float>(std::clamp(kg, 0.0, 40.0))) * s,
                            Faded(ink, 0.85f), 20);
    p.WriteCentred(p.fonts.small, {at.x, at.y - 7 * s}, board.live ? colour::kText : colour::kFaint,
                   board.live ? scene::Fixed(kg, 1) : "-");
  }
}

void DrawTrace(const Paint& p, const Plan& plan, const scene::Model& model,
               const scene::PlacedBoard& board, ImU32 ink, std::int64_t now_ns) {
  for (const auto& [key, trace] : model.boards) {
    if (trace.newest.device != board.sample.device || !board.live) continue;
    for (std::size_t i = 1; i < trace.points.size(); ++i) {
      const auto& from = trace.points[i - 1];
      const auto& to = trace.points[i];
      if (!to.joined) continue;
      const double age =
          static_cast<double>(now_ns - to.time_ns) / static_cast<double>(scene::kStripNs);
      p.list->AddLine(
          plan.At(board.InWorld(from.x_m, from.y_m)), plan.At(board.InWorld(to.x_m, to.y_m)),
          Faded(ink, static_cast<float>(std::clamp(0.8 - age, 0.04, 0.8))), 1.2f * p.scale);
    }
  }
}

void DrawPoints(const Paint& p, const Plan& plan, const scene::CharacterPose& pose) {
  Eigen::Vector2d moment(0, 0);
  double total_n = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    const scene::BodyFoot& foot = pose.body->feet[side];
    if (!foot.cop_valid) continue;
    moment += foot.load_n * foot.cop_m.head<2>();
    total_n += foot.load_n;
    p.Dot(plan.At(foot.cop_m.head<2>()), 4, kInks[side]);
  }
  if (total_n > 1) p.Dot(plan.At(moment / total_n), 4.5f, kTotal);
  if (!pose.body->momentum_valid) return;
  const ImVec2 com = plan.At(pose.com_m.head<2>());
  p.list->AddCircle(com, 7 * p.scale, colour::kText, 24, 1.8f * p.scale);
}

void DrawLegend(const Paint& p, const Box& in) {
  const float s = p.scale, y = in.high.y - 13 * s;
  float x = in.low.x;
  x += p.Write(p.fonts.small, {x, y}, colour::kFaint, "centre of") + 11 * s;
  p.Dot({x, y + 7 * s}, 4.5f, kTotal);
  x += 8 * s;
  x += p.Write(p.fonts.small, {x, y}, colour::kFaint, "pressure") + 13 * s;
  p.list->AddCircle({x, y + 7 * s}, 5 * s, colour::kText, 20, 1.5f * s);
  x += 9 * s;
  p.Write(p.fonts.small, {x, y}, colour::kFaint, "mass");
  p.WriteRight(p.fonts.small, {in.high.x, y}, colour::kFaint, "front is up");
}

}  // namespace

void DrawLayoutPanel(const Paint& p, const Box& box, const scene::Model& model,
                     const scene::CharacterPose& pose, std::int64_t now_ns) {
  const float s = p.scale;
  const Box in = p.Panel(box);
  const auto boards = scene::BoardsOf(model, pose.rig, now_ns);
  double total_n = 0;
  for (const auto& board : boards) {
    for (const double load_n : board.Loads()) total_n += load_n;
  }
  p.Write(p.fonts.strong, in.low, colour::kText, "boards, kg");
  p.WriteRight(p.fonts.strong, {in.high.x, in.low.y}, colour::kText,
               scene::Fixed(NewtonsToKilograms(total_n), 1) + " kg");
  const Plan plan =
      FitPlan(boards, {{in.low.x, in.low.y + 24 * s}, {in.high.x, in.high.y - 20 * s}});
  for (std::size_t side = 0; side < 2; ++side) DrawPlate(p, plan, boards[side], kInks[side]);
  for (std::size_t side = 0; side < 2; ++side) {
    DrawTrace(p, plan, model, boards[side], kInks[side], now_ns);
    DrawCells(p, plan, boards[side], kInks[side]);
  }
  DrawPoints(p, plan, pose);
  DrawLegend(p, in);
}

}  // namespace footing::render
