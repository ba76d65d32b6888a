#include "clients/view/render/game_panels.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "clients/view/scene/text.h"
#include "common/base/units.h"
#include "common/stream/trial.h"

namespace footing::render {
namespace {

constexpr float kWidest = 460;
constexpr float kBothSides = 28;  // Margins of a panel, both sides together.
constexpr float kBetweenRows = 4;

ImU32 InkOf(std::size_t player) { return player == 0 ? colour::kAccent : colour::kSecond; }

float RowHeight(const Paint& p, ImFont* font) { return font->FontSize + kBetweenRows * p.scale; }

/// Name, part and points on one side of the panel.
void DrawPlayer(const Paint& p, const Box& box, const stream::GameState& game, std::size_t player) {
  const bool left = player == 0;
  const std::string points = scene::Fixed(game.players[player].points, 0);
  const std::string part = scene::PartText(game, player);
  const float edge = left ? box.low.x : box.high.x;
  const auto write = [&](ImFont* font, float y, ImU32 ink, const std::string& text) {
    const std::string fitting = p.Fitting(font, text, box.width());
    if (left) {
      p.Write(font, {edge, y}, ink, fitting);
    } else {
      p.WriteRight(font, {edge, y}, ink, fitting);
    }
  };
  write(p.fonts.heading, box.low.y, InkOf(player), points);
  write(p.fonts.small, box.low.y + RowHeight(p, p.fonts.heading), colour::kText,
        game.players[player].name + (part.empty() ? "" : " " + part));
}

void DrawTitle(const Paint& p, const Box& box, const stream::GameState& game) {
  const std::string clock = scene::GameClock(game);
  const float clock_width = clock.empty() ? 0 : p.WidthOf(p.fonts.heading, clock) + 8 * p.scale;
  p.Write(p.fonts.heading, box.low, colour::kText,
          p.Fitting(p.fonts.heading, scene::GameTitle(game), box.width() - clock_width));
  const bool soon = game.left_s < 5.5;
  p.WriteRight(p.fonts.heading, {box.high.x, box.low.y}, soon ? colour::kWarning : colour::kText,
               clock);
}

}  // namespace

void DrawGamePanel(const Paint& p, const stream::GameState& game, Box& space) {
  const float s = p.scale;
  const float width = std::min(space.width(), kWidest * s);
  const float inner = width - kBothSides * s;
  std::vector<std::string> lines;
  for (const std::string& text : {scene::RoundText(game), scene::GhostText(game), game.note}) {
    for (std::string& line : p.Wrapped(p.fonts.small, text, inner))
      lines.push_back(std::move(line));
  }
  const float title = RowHeight(p, p.fonts.heading);
  const float players = title + RowHeight(p, p.fonts.small);
  const float row = RowHeight(p, p.fonts.small);
  const float least = kBothSides * s + title + players;
  if (least > space.height()) return;
  const auto fitting = static_cast<std::size_t>((space.height() - least) / row);
  lines.resize(std::min(lines.size(), fitting));
  const float height = least + static_cast<float>(lines.size()) * row;
  const float middle = (space.low.x + space.high.x) / 2;
  const Box in =
      p.Panel({{middle - width / 2, space.low.y}, {middle + width / 2, space.low.y + height}});
  DrawTitle(p, in, game);
  const float centre = (in.low.x + in.high.x) / 2;
  float y = in.low.y + title;
  DrawPlayer(p, {{in.low.x, y}, {centre - 4 * s, in.high.y}}, game, 0);
  DrawPlayer(p, {{centre + 4 * s, y}, {in.high.x, in.high.y}}, game, 1);
  y += players;
  for (const std::string& line : lines) {
    p.Write(p.fonts.small, {in.low.x, y}, colour::kFaint, line);
    y += row;
  }
  space.low.y += height + 6 * s;
}

namespace {

constexpr float kMostWidth = 460;
constexpr float kMargins = 28;  // Margins of a panel, both sides together.

ImU32 TaskInk(stream::TaskPhase phase) {
  switch (phase) {
    case stream::TaskPhase::kDue:
      return colour::kWarning;
    case stream::TaskPhase::kDone:
      return colour::kGood;
    case stream::TaskPhase::kAhead:
    case stream::TaskPhase::kUnspecified:
      return colour::kText;
  }
  return colour::kText;
}

/// Lines of one font and colour, and the space above them.
struct Lines {
  ImFont* font = nullptr;
  ImU32 ink = 0;
  std::vector<std::string> text;
};

std::vector<Lines> TextOf(const Paint& p, const scene::Model& model,
                          const stream::TrialState& trial, bool task_alone, float width) {
  std::vector<Lines> text;
  const std::string task = scene::TaskText(trial, model.track);
  if (!task.empty()) {
    text.push_back({p.fonts.heading, TaskInk(trial.progress.task_phase),
                    p.Wrapped(p.fonts.heading, task, width)});
  }
  if (task_alone) return text;
  const bool over = trial.progress.phase == stream::TrialPhase::kFinished;
  text.push_back({p.fonts.strong, over ? colour::kGood : colour::kText,
                  p.Wrapped(p.fonts.strong, scene::TrialTitle(trial), width)});
  const bool failed = stream::Total(trial.progress.failures) > 0;
  text.push_back({p.fonts.small, failed ? colour::kWarning : colour::kFaint,
                  p.Wrapped(p.fonts.small, scene::AttemptText(trial), width)});
  return text;
}

/// The way from the start to the finish line.
void DrawWay(const Paint& p, const Box& box, const stream::TrialState& trial) {
  const float s = p.scale;
  const double done = trial.progress.distance_m / trial.finish_m;
  p.Bar({{box.low.x, box.low.y + 3 * s}, {box.high.x - 108 * s, box.low.y + 10 * s}},
        static_cast<float>(std::clamp(done, 0.0, 1.0)), colour::kAccent);
  p.WriteRight(
      p.fonts.small, {box.high.x, box.low.y - 2 * s}, colour::kFaint,
      scene::Fixed(trial.progress.distance_m, 1) + " of " + scene::Fixed(trial.finish_m, 0) + " m");
}

}  // namespace

void DrawTrialPanel(const Paint& p, const scene::Model& model, const scene::CharacterPose& pose,
                    bool task_alone, Box& space) {
  const stream::TrialState* trial = scene::ShownTrial(pose, model.study.state);
  if (trial == nullptr) return;
  const float s = p.scale;
  const float width = std::min(space.width(), kMostWidth * s);
  const auto text = TextOf(p, model, *trial, task_alone, width - kMargins * s);
  if (text.empty()) return;
  const bool way = !task_alone && trial->finish_m > 0;
  float height = (kMargins + (way ? 18 : 0)) * s;
  for (const Lines& lines : text) {
    height += static_cast<float>(lines.text.size()) * (lines.font->FontSize + 3 * s);
  }
  if (height > space.height()) return;
  const float middle = (space.low.x + space.high.x) / 2;
  const Box in =
      p.Panel({{middle - width / 2, space.low.y}, {middle + width / 2, space.low.y + height}});
  float y = in.low.y;
  for (const Lines& lines : text) {
    for (const std::string& line : lines.text) {
      p.Write(lines.font, {in.low.x, y}, lines.ink, line);
      y += lines.font->FontSize + 3 * s;
    }
  }
  if (way) DrawWay(p, {{in.low.x, y + 4 * s}, in.high}, *trial);
  space.low.y += height + 6 * s;
}

namespace {

using stream::Gait;
using stream::UserInterface;

constexpr float kInterfacePanelHeight = 152;
constexpr float kGaugesTop = 22, kGaugesHeight = 76;
constexpr float kGaugeGap = 12;
constexpr float kCommandRow = 24, kProblemRow = 17, kAboveProblem = 8;
constexpr float kBelowText = 4;       // Space of a row under its letters.
constexpr float kLettersOfLine = 34;  // Letters that fit into the narrowest panel.
constexpr ImU32 kLetters = IM_COL32(14, 20, 26, 255);

/// The gauge of the motion, and that of its pace; one over both columns where it says both.
void DrawMotion(const Paint& p, const Box& left, const Box& middle,
                const stream::InterfaceState& state) {
  switch (state.interface) {
    case UserInterface::kUnspecified:
      return;
    case UserInterface::kWrist:
    case UserInterface::kLeg:
      DrawPhaseGauge(p, left, state);
      DrawFrequencyGauge(p, middle, state);
      return;
    case UserInterface::kArm:
      DrawPhaseGauge(p, left, state);
      DrawForearmGauge(p, middle, state);
      return;
    case UserInterface::kJoystick:
      DrawStickGauge(p, left, state);
      DrawButtonGauge(p, middle, state);
      return;
    case UserInterface::kBoards:
      DrawLoadGauge(p, left, state);
      DrawFrequencyGauge(p, middle, state);
      return;
  }
}

/// The commanded gait, and one that is seen and has not lasted long enough, filling up.
void DrawCommand(const Paint& p, ImVec2 at, const Box& in, const stream::InterfaceState& state) {
  const float s = p.scale;
  float x = at.x + p.Label(at, ColourOf(state.gait), kLetters, scene::GaitTitle(state.gait));
  if (state.next_gait != Gait::kUnspecified) {
    const std::string title = scene::GaitTitle(state.next_gait);
    x += 8 * s;
    const float from = x;
    x += p.Label({x, at.y}, colour::kGroove, ColourOf(state.next_gait), title);
    p.Bar({{from, at.y + 20 * s}, {x, at.y + 23 * s}}, static_cast<float>(state.next_share),
          ColourOf(state.next_gait));
  }
  const std::string problem = scene::ProblemText(state);
  if (problem.empty()) return;
  // Under the command in as many lines as it needs; where the panel is too low, beside it.
  const auto lines = p.Wrapped(p.fonts.small, problem, in.high.x - at.x);
  const float first = at.y + kCommandRow * s, row = kProblemRow * s;
  if (first + row * static_cast<float>(lines.size()) > in.high.y + kBelowText * s) {
    p.Write(p.fonts.small, {x + 10 * s, at.y + 2.5f * s}, colour::kWarning,
            p.Fitting(p.fonts.small, problem, in.high.x - x - 10 * s));
    return;
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    p.Write(p.fonts.small, {at.x, first + row * static_cast<float>(i)}, colour::kWarning, lines[i]);
  }
}

}  // namespace

PanelHeight InterfacePanelHeight(const stream::InterfaceState& state) {
  if (state.interface == UserInterface::kUnspecified) return {};
  const auto letters = static_cast<float>(scene::ProblemText(state).size());
  const float lines = std::ceil(letters / kLettersOfLine);
  return {kInterfacePanelHeight,
          kInterfacePanelHeight + (lines > 0 ? kAboveProblem : 0) + kProblemRow * lines};
}

void DrawInterfacePanel(const Paint& p, const Box& box, const stream::InterfaceState& state) {
  const float s = p.scale;
  const Box in = p.Panel(box);
  const float name = p.Write(p.fonts.strong, in.low, colour::kText, stream::Name(state.interface));
  const float space = in.width() - name - 10 * s;
  p.WriteRight(p.fonts.small, {in.high.x, in.low.y + 2 * s}, colour::kFaint,
               p.Fitting(p.fonts.small, scene::ActivityText(state), space));
  const float width = (in.width() - 2 * kGaugeGap * s) / 3;
  const auto column = [&](int number) {
    const float x = in.low.x + static_cast<float>(number) * (width + kGaugeGap * s);
    const float top = in.low.y + kGaugesTop * s;
    return Box{{x, top}, {x + width, top + kGaugesHeight * s}};
  };
  DrawMotion(p, column(0), column(1), state);
  DrawTurnGauge(p, column(2), state);
  DrawCommand(p, {in.low.x, in.low.y + (kGaugesTop + kGaugesHeight + 9) * s}, in, state);
}

namespace {

constexpr float kCaption = 14;
constexpr float kTint = 0.30f, kLit = 0.75f;
constexpr double kMostHz = 5, kMostFootHz = 2.5;
/// Zones of figure 11 as in the built-in table, shares of the stick's way and degrees from the
/// front. A person's own table may have other radii: the lit zone is the estimate of the interface.
constexpr float kCentreRadius = 0.25f, kRunRadius = 0.6f;
constexpr double kStraightDeg = 30, kForwardDeg = 75, kRearDeg = 135;
constexpr double kGapRad = 0.03;

float Pi(double share) { return static_cast<float>(share * kPi); }

/// Writes the centred caption in the lowest row; returns the box above it.
Box Above(const Paint& p, const Box& box, const std::string& caption) {
  const float y = box.high.y - p.fonts.small->FontSize;
  p.WriteCentred(p.fonts.small, {(box.low.x + box.high.x) / 2, y}, colour::kFaint, caption);
  return {box.low, {box.high.x, box.high.y - kCaption * p.scale}};
}

ImVec2 MiddleOf(const Box& box) {
  return {(box.low.x + box.high.x) / 2, (box.low.y + box.high.y) / 2};
}

/// A ring's piece between two angles, clockwise from the top.
void Arc(const Paint& p, ImVec2 centre, float radius, double from_rad, double to_rad, float width,
         ImU32 ink) {
  p.list->PathArcTo(centre, radius, static_cast<float>(from_rad - kPi / 2),
                    static_cast<float>(to_rad - kPi / 2), 32);
  p.list->PathStroke(ink, 0, width * p.scale);
}

/// A filled sector between two radii, clockwise from the top.
void Sector(const Paint& p, ImVec2 centre, float inner, float outer, double from_rad, double to_rad,
            ImU32 ink) {
  const float from = static_cast<float>(from_rad) - Pi(0.5),
              to = static_cast<float>(to_rad) - Pi(0.5);
  p.list->PathArcTo(centre, (inner + outer) / 2, from, to, 32);
  p.list->PathStroke(ink, 0, outer - inner);
}

/// The half circle in three sectors, and beside it where the character turns in place.
void DrawStickRegions(const Paint& p, ImVec2 centre, float radius,
                      const stream::InterfaceState& state) {
  const float s = p.scale;
  const int believed = state.turn.share >= 1 ? 1 : state.turn.share <= -1 ? -1 : 0;
  const auto tint = [&](Gait gait, int side) {
    return Faded(ColourOf(gait), state.gait == gait && believed == side ? kLit : kTint);
  };
  for (const int side : {-1, 0, 1}) {
    const double from_deg = side == 0 ? -kStraightDeg : side < 0 ? -kForwardDeg : kStraightDeg;
    const double to_deg = side == 0 ? kStraightDeg : side < 0 ? -kStraightDeg : kForwardDeg;
    const double from = DegreesToRadians(from_deg) + kGapRad;
    const double to = DegreesToRadians(to_deg) - kGapRad;
    Sector(p, centre, kCentreRadius * radius, kRunRadius * radius - s, from, to,
           tint(Gait::kWalk, side));
    Sector(p, centre, kRunRadius * radius + s, radius, from, to, tint(Gait::kRun, side));
    if (side == 0) continue;
    const double near = DegreesToRadians(kForwardDeg), far = DegreesToRadians(kRearDeg);
    Sector(p, centre, kCentreRadius * radius, radius, (side > 0 ? near : -far) + kGapRad,
           (side > 0 ? far : -near) - kGapRad, tint(Gait::kStep, side));
  }
}

}  // namespace

void DrawPhaseGauge(const Paint& p, const Box& box, const stream::InterfaceState& state) {
  const float s = p.scale;
  const bool known = state.phase_valid;
  const Box in = Above(
      p, box,
      known ? "phase " + scene::Fixed(RadiansToDegrees(std::fabs(state.phase_rad)), 0) + "\xc2\xb0"
            : std::string("phase"));
  const ImVec2 centre = MiddleOf(in);
  const float radius = std::min(in.width(), in.height()) / 2 - 4 * s;
  const double border = state.together_rad;
  const bool together = known && std::fabs(state.phase_rad) < border;
  Arc(p, centre, radius, -border, border, 5, Faded(ColourOf(Gait::kJump), together ? kLit : kTint));
  Arc(p, centre, radius, border, 2 * kPi - border, 5,
      Faded(ColourOf(Gait::kWalk), known && !together ? kLit : kTint));
  p.WriteCentred(p.fonts.tiny, {centre.x, in.low.y + 10 * s}, colour::kFaint, "jump");
  p.WriteCentred(p.fonts.tiny, {centre.x, in.high.y - 23 * s}, colour::kFaint, "walk");
  if (!known) return;
  const auto angle = static_cast<float>(state.phase_rad);
  const ImVec2 tip(centre.x + radius * std::sin(angle), centre.y - radius * std::cos(angle));
  p.Dot(tip, 4.5f, colour::kText);
}

void DrawFrequencyGauge(const Paint& p, const Box& box, const stream::InterfaceState& state) {
  const float s = p.scale;
  const Box in = Above(p, box, "frequency");
  const bool boards = state.interface == stream::UserInterface::kBoards;
  const double most_hz = boards ? kMostFootHz : kMostHz;
  const auto x_at = [&](double frequency_hz) {
    const double share = std::clamp(frequency_hz / most_hz, 0.0, 1.0);
    return in.low.x + static_cast<float>(share) * in.width();
  };
  const float top = in.low.y + 34 * s, bottom = top + 8 * s, border = x_at(state.border_hz);
  const bool run = state.gait == Gait::kRun, walk = state.gait == Gait::kWalk;
  p.list->AddRectFilled({in.low.x, top}, {border - s, bottom},
                        Faded(ColourOf(Gait::kWalk), walk ? kLit : kTint), 4 * s,
                        ImDrawFlags_RoundCornersLeft);
  p.list->AddRectFilled({border + s, top}, {in.high.x, bottom},
                        Faded(ColourOf(Gait::kRun), run ? kLit : kTint), 4 * s,
                        ImDrawFlags_RoundCornersRight);
  p.WriteCentred(p.fonts.tiny, {(in.low.x + border) / 2, bottom + 3 * s}, colour::kFaint, "walk");
  p.WriteCentred(p.fonts.tiny, {(border + in.high.x) / 2, bottom + 3 * s}, colour::kFaint, "run");
  const std::string value =
      state.frequency_valid ? scene::Fixed(state.frequency_hz, 2) + " Hz" : std::string("-");
  p.WriteCentred(p.fonts.strong, {(in.low.x + in.high.x) / 2, in.low.y + 4 * s}, colour::kText,
                 value);
  if (!state.frequency_valid) return;
  const float x = x_at(state.frequency_hz);
  p.list->AddRectFilled({x - 1.5f * s, top - 4 * s}, {x + 1.5f * s, bottom + 4 * s}, colour::kText,
                        1.5f * s);
}

void DrawForearmGauge(const Paint& p, const Box& box, const stream::InterfaceState& state) {
  const float s = p.scale;
  const Box in = Above(p, box,
                       state.frequency_valid ? "arms " + scene::Fixed(state.frequency_hz, 2) + " Hz"
                                             : std::string("arms"));
  const ImVec2 elbow(in.low.x + 0.34f * in.width(), in.low.y + 24 * s);
  const float length = 34 * s;
  const bool known = state.forearms.valid;
  const bool bent = known && state.forearms.elevation_rad > state.forearms.bent_rad;
  // Clockwise from the top, the front is at a right angle and a hanging forearm at two.
  const double border = kPi / 2 - state.forearms.bent_rad;
  Arc(p, elbow, length + 4 * s, kPi / 2 - 0.35, border, 5,
      Faded(ColourOf(Gait::kRun), bent ? kLit : kTint));
  Arc(p, elbow, length + 4 * s, border, kPi, 5,
      Faded(ColourOf(Gait::kWalk), known && !bent ? kLit : kTint));
  p.Write(p.fonts.tiny, {elbow.x + length - 2 * s, in.low.y}, colour::kFaint, "run");
  p.WriteRight(p.fonts.tiny, {elbow.x - 6 * s, in.high.y - 14 * s}, colour::kFaint, "walk");
  p.list->AddLine({elbow.x, in.low.y - 2 * s}, elbow, Faded(colour::kText, 0.6f), 5 * s);
  p.Dot(elbow, 3.5f, colour::kText);
  if (!known) return;
  const auto elevation = static_cast<float>(state.forearms.elevation_rad);
  const ImVec2 hand(elbow.x + length * std::cos(elevation), elbow.y - length * std::sin(elevation));
  p.list->AddLine(elbow, hand, colour::kText, 4 * s);
  p.Dot(hand, 4.5f, colour::kText);
}

void DrawStickGauge(const Paint& p, const Box& box, const stream::InterfaceState& state) {
  const float s = p.scale;
  const Box in = Above(p, box, "stick");
  const ImVec2 centre = MiddleOf(in);
  const float radius = std::min(in.width(), in.height()) / 2 - 2 * s;
  DrawStickRegions(p, centre, radius, state);
  p.list->AddCircle(centre, radius, colour::kGroove, 48, s);
  p.list->AddCircleFilled(centre, kCentreRadius * radius, colour::kGroove, 24);
  if (!state.stick.valid) return;
  const double reach = std::max(1.0, std::hypot(state.stick.x, state.stick.y));
  const ImVec2 tip(centre.x + radius * static_cast<float>(state.stick.x / reach),
                   centre.y - radius * static_cast<float>(state.stick.y / reach));
  p.list->AddLine(centre, tip, Faded(colour::kText, 0.5f), 2 * s);
  p.Dot(tip, 5, colour::kText);
}

void DrawButtonGauge(const Paint& p, const Box& box, const stream::InterfaceState& state) {
  const float s = p.scale;
  const Box in = Above(p, box, "jump");
  const bool pressed = state.activity == stream::Activity::kButton;
  const ImVec2 centre = MiddleOf(in);
  const ImU32 ink = ColourOf(Gait::kJump);
  p.list->AddCircleFilled(centre, 17 * s, pressed ? ink : Faded(ink, kTint), 32);
  p.WriteCentred(p.fonts.heading, {centre.x, centre.y - p.fonts.heading->FontSize / 2},
                 pressed ? IM_COL32(14, 20, 26, 255) : colour::kText, "A");
}

void DrawLoadGauge(const Paint& p, const Box& box, const stream::InterfaceState& state) {
  const float s = p.scale;
  const Box in = Above(p, box, "heels up: jump");
  const float foot = 20 * s, gap = 8 * s, middle = (in.low.x + in.high.x) / 2;
  for (const int side : {-1, 1}) {
    const float from = side < 0 ? middle - gap / 2 - foot : middle + gap / 2;
    const Box sole{{from, in.low.y + 2 * s}, {from + foot, in.high.y - 4 * s}};
    p.list->AddRectFilled(sole.low, sole.high, colour::kGroove, 9 * s);
    if (!state.load_valid) continue;
    const double share = side < 0 ? state.left_share : 1 - state.left_share;
    const float top = sole.high.y - static_cast<float>(std::clamp(share, 0.0, 1.0)) * sole.height();
    p.list->PushClipRect({sole.low.x, top}, sole.high, true);
    p.list->AddRectFilled(sole.low, sole.high, side < 0 ? colour::kAccent : colour::kSecond, 9 * s);
    p.list->PopClipRect();
  }
}

void DrawTurnGauge(const Paint& p, const Box& box, const stream::InterfaceState& state) {
  const float s = p.scale;
  const Box in = Above(p, box, std::string("turn by ") + stream::Name(state.turn.source));
  const float top = in.low.y + 34 * s, bottom = top + 8 * s, middle = (in.low.x + in.high.x) / 2;
  const float half = in.width() / 2, border = half / 2;
  const bool left = state.turn.share <= -1, right = state.turn.share >= 1;
  p.list->AddRectFilled({middle - border + s, top}, {middle + border - s, bottom}, colour::kGroove);
  p.list->AddRectFilled({in.low.x, top}, {middle - border - s, bottom},
                        Faded(colour::kSecond, left ? kLit : kTint), 4 * s,
                        ImDrawFlags_RoundCornersLeft);
  p.list->AddRectFilled({middle + border + s, top}, {in.high.x, bottom},
                        Faded(colour::kSecond, right ? kLit : kTint), 4 * s,
                        ImDrawFlags_RoundCornersRight);
  p.Write(p.fonts.tiny, {in.low.x, bottom + 3 * s}, colour::kFaint, "left");
  p.WriteRight(p.fonts.tiny, {in.high.x, bottom + 3 * s}, colour::kFaint, "right");
  p.WriteCentred(p.fonts.strong, {middle, in.low.y + 4 * s}, colour::kText,
                 left    ? "left"
                 : right ? "right"
                         : "straight");
  if (!state.turn.valid) return;
  const auto share = static_cast<float>(std::clamp(state.turn.share, -2.0, 2.0) / 2);
  p.Dot({middle + share * half, (top + bottom) / 2}, 5, colour::kText);
}

}  // namespace footing::render
