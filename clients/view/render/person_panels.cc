#include "clients/view/render/person_panels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "clients/view/scene/text.h"
#include "common/base/units.h"

namespace footing::render {
namespace {

constexpr float kLeastBodyHeight = 276;
constexpr float kRemarkRow = 20;   // Height of a remark, which only a high panel shows.
constexpr double kSureM = 0.03;    // Two standard deviations of a standing foot.
constexpr double kUnsureM = 0.15;  // The same of a foot that no sensor sees.
constexpr ImU32 kDark = IM_COL32(14, 20, 26, 255);

void DrawNumbers(const Paint& p, const Box& box, const scene::BodyState& body) {
  const float s = p.scale, third = box.width() / 3;
  const auto write = [&](int column, int row, const char* name, const std::string& value,
                         ImU32 ink) {
    const ImVec2 at(box.low.x + static_cast<float>(column) * third,
                    box.low.y + static_cast<float>(row) * 38 * s);
    p.Write(p.fonts.small, at, colour::kFaint, name);
    p.Write(p.fonts.strong, {at.x, at.y + 15 * s}, ink, value);
  };
  write(0, 0, "weight", body.calibrated ? scene::Fixed(body.mass_kg, 1) + " kg" : "-",
        colour::kText);
  write(1, 0, "height", scene::Fixed(body.height_m, 2) + " m", colour::kText);
  write(2, 0, "lag", scene::Fixed(1e3 * body.lag_s, 0) + " ms",
        body.lag_s > 0 ? colour::kSecond : colour::kText);
  write(0, 1, "resets", std::to_string(body.resets),
        body.resets > 0 ? colour::kWarning : colour::kText);
  write(1, 1, "restarts", std::to_string(body.calibration_restarts), colour::kText);
  write(2, 1, "solved in", scene::Fixed(1e-3 * body.solve_us, 2) + " ms", colour::kText);
}

/// One foot: load as a bar, and the standard deviation of its position.
void DrawFoot(const Paint& p, const Box& box, const scene::BodyFoot& foot, const char* name,
              ImU32 ink, double weight_n) {
  const float s = p.scale;
  p.Write(p.fonts.small, box.low, ink, name);
  const double spread_m = 2 * std::sqrt(std::max(0.0, foot.variance_m2.head<2>().maxCoeff()));
  std::string state = scene::Fixed(foot.load_n, 0) + " N";
  if (!foot.valid) {
    state = "place unknown";
  } else if (!foot.contact) {
    state = "off " + scene::Fixed(foot.airborne_s, 1) + " s";
  }
  p.Write(p.fonts.small, {box.low.x + 74 * s, box.low.y},
          foot.contact ? colour::kText : colour::kWarning, state);
  const ImU32 sure = spread_m < kSureM     ? colour::kGood
                     : spread_m < kUnsureM ? colour::kWarning
                                           : colour::kBad;
  if (foot.valid) {
    p.WriteRight(p.fonts.small, {box.high.x, box.low.y}, sure,
                 "\xc2\xb1" + scene::Fixed(100 * spread_m, 1) + " cm");
  }
  const Box bar{{box.low.x, box.low.y + 18 * s}, {box.high.x, box.low.y + 24 * s}};
  p.Bar(bar, static_cast<float>(foot.load_n / std::max(weight_n, 1.0)), ink);
}

void DrawHands(const Paint& p, const Box& box, const scene::BodyState& body) {
  const float s = p.scale;
  p.Write(p.fonts.small, {box.low.x, box.low.y + 3 * s}, colour::kFaint, "hands");
  float x = box.low.x + std::min(74 * s, box.width() - 186 * s);
  for (std::size_t side = 0; side < 2; ++side) {
    const bool seen = body.hands_seen[side];
    const std::string text =
        std::string(side == 0 ? "left " : "right ") + (seen ? "seen" : "not seen");
    x += p.Label({x, box.low.y}, seen ? colour::kGood : colour::kGroove,
                 seen ? kDark : colour::kWarning, text) +
         6 * s;
  }
}

/// A line and its colour.
struct Remark {
  ImU32 ink = 0;
  std::string text;
};

bool HasReference(const scene::CharacterPose& pose, const scene::Picture& picture) {
  return !picture.ghosts.balls.empty() && pose.body->calibrated;
}

std::vector<Remark> RemarksOf(const scene::CharacterPose& pose, const scene::Picture& picture) {
  std::vector<Remark> remarks{
      {colour::kFaint, "?  keys"},
      {IM_COL32(199, 125, 255, 255),
       "angular momentum " + scene::Fixed(pose.body->angular_momentum_kgm2ps.norm(), 1) +
           " kg m\xc2\xb2/s"}};
  if (HasReference(pose, picture)) {
    remarks.push_back({IM_COL32(255, 200, 97, 255), "yellow: the simulated body's true pose"});
  }
  return remarks;
}

void DrawHeading(const Paint& p, const Box& in, const scene::CharacterPose& pose) {
  const float s = p.scale;
  const scene::BodyState& body = *pose.body;
  const std::string who = body.subject.empty() ? "no subject file" : body.subject;
  p.Write(p.fonts.heading, {in.low.x, in.low.y - 2 * s},
          body.subject.empty() ? colour::kFaint : colour::kText,
          p.Fitting(p.fonts.heading, who, in.width()));
  float x = in.low.x;
  const float row = in.low.y + 30 * s;
  x += p.Label({x, row}, body.mode == "best" ? colour::kAccent : colour::kSecond, kDark,
               scene::ModeText(body)) +
       6 * s;
  x += p.Label({x, row}, body.calibrated ? colour::kGood : colour::kWarning, kDark,
               body.calibrated ? "T-pose taken" : "awaiting the T-pose") +
       6 * s;
  if (!pose.valid && body.calibrated) p.Label({x, row}, colour::kBad, kDark, "coasting");
}

}  // namespace

PanelHeight BodyPanelHeight(const scene::CharacterPose& pose, const scene::Picture& picture) {
  return {kLeastBodyHeight, kLeastBodyHeight + kRemarkRow * (HasReference(pose, picture) ? 3 : 2)};
}

void DrawBodyPanel(const Paint& p, const Box& box, const scene::CharacterPose& pose,
                   const scene::Picture& picture) {
  const float s = p.scale;
  const scene::BodyState& body = *pose.body;
  const Box in = p.Panel(box);
  DrawHeading(p, in, pose);
  DrawNumbers(p, {{in.low.x, in.low.y + 62 * s}, in.high}, body);
  const double weight_n = KilogramsToNewtons(std::max(body.mass_kg, 30.0));
  DrawFoot(p, {{in.low.x, in.low.y + 148 * s}, in.high}, body.feet[0], "left foot", colour::kAccent,
           weight_n);
  DrawFoot(p, {{in.low.x, in.low.y + 184 * s}, in.high}, body.feet[1], "right foot",
           colour::kSecond, weight_n);
  DrawHands(p, {{in.low.x, in.low.y + 224 * s}, in.high}, body);
  float y = in.low.y + 252 * s;
  for (const Remark& remark : RemarksOf(pose, picture)) {
    if (y + 14 * s > in.high.y) break;
    p.Write(p.fonts.small, {in.low.x, y}, remark.ink,
            p.Fitting(p.fonts.small, remark.text, in.width()));
    y += kRemarkRow * s;
  }
}

namespace {

constexpr float kCharacterPanelHeight = 196;
constexpr float kCharacterPhaseHeight = 70;
constexpr double kFullSpeedMps = 4;
constexpr double kFullTurnRad = DegreesToRadians(15);
constexpr std::int64_t kPhaseStripNs = 4'000'000'000;

/// An arc like a steering wheel's: the needle is the commanded turn a step, left to the left.
void DrawTurn(const Paint& p, ImVec2 centre, float radius, double turn_rad) {
  const auto angle_at = [](double turn) {
    const double share = std::clamp(turn / kFullTurnRad, -1.0, 1.0);
    return static_cast<float>(-kPi / 2 - share * 1.1);
  };
  p.list->PathArcTo(centre, radius, static_cast<float>(-kPi / 2 - 1.1),
                    static_cast<float>(-kPi / 2 + 1.1), 24);
  p.list->PathStroke(colour::kGroove, 0, 4 * p.scale);
  const float needle = angle_at(turn_rad);
  if (std::abs(turn_rad) > 1e-3) {
    const float straight = angle_at(0);
    p.list->PathArcTo(centre, radius, std::min(needle, straight), std::max(needle, straight), 16);
    p.list->PathStroke(colour::kSecond, 0, 4 * p.scale);
  }
  const ImVec2 tip(centre.x + radius * std::cos(needle), centre.y + radius * std::sin(needle));
  p.Dot(tip, 5, colour::kText);
  const std::string text = scene::Fixed(std::abs(RadiansToDegrees(turn_rad)), 0) + "\xc2\xb0/step";
  p.WriteCentred(p.fonts.small, {centre.x, centre.y - 12 * p.scale}, colour::kFaint, text);
}

void DrawSpeed(const Paint& p, const Box& box, const stream::GaitState& gait, ImU32 ink) {
  const float s = p.scale;
  p.Write(p.fonts.strong, box.low, colour::kText, scene::Fixed(gait.speed_mps, 2) + " m/s");
  p.WriteRight(p.fonts.small, {box.high.x, box.low.y + 2 * s}, colour::kFaint,
               "commanded " + scene::Fixed(gait.commanded_speed_mps, 2));
  const Box bar{{box.low.x, box.low.y + 22 * s}, {box.high.x, box.low.y + 29 * s}};
  p.Bar(bar, static_cast<float>(gait.speed_mps / kFullSpeedMps), ink);
  const auto share =
      static_cast<float>(std::clamp(gait.commanded_speed_mps / kFullSpeedMps, 0.0, 1.0));
  const float mark = bar.low.x + share * bar.width();
  p.list->AddRectFilled({mark - 1.5f * s, bar.low.y - 4 * s}, {mark + 1.5f * s, bar.high.y + 4 * s},
                        colour::kText, 1.5f * s);
}

void DrawCounts(const Paint& p, const Box& box, const stream::GaitState& gait) {
  const float s = p.scale;
  const float third = box.width() / 3;
  const ImU32 fall_ink = gait.falls > 0 ? colour::kWarning : colour::kText;
  const auto write = [&](int column, const char* name, const std::string& value, ImU32 ink) {
    const float x = box.low.x + static_cast<float>(column) * third;
    p.Write(p.fonts.small, {x, box.low.y}, colour::kFaint, name);
    p.Write(p.fonts.strong, {x, box.low.y + 15 * s}, ink, value);
  };
  write(0, "distance", scene::Fixed(gait.distance_m, 1) + " m", colour::kText);
  write(1, "falls", std::to_string(gait.falls), fall_ink);
  if (gait.gait == stream::Gait::kJump || gait.commanded_gait == stream::Gait::kJump) {
    write(2, "jump height", scene::Fixed(100 * gait.commanded_height_m, 0) + " cm", colour::kText);
  } else {
    write(2, "steps", std::to_string(gait.steps), colour::kText);
  }
}

/// The states of the gait controller: labels, the present one lit, and their last 4 s as a band.
void DrawPhases(const Paint& p, const Box& box, const scene::Model& model,
                const scene::CharacterPose& pose, std::int64_t now_ns) {
  static constexpr std::array<ImU32, 4> kInks{colour::kAccent, colour::kGood, colour::kSecond,
                                              colour::kThird};
  const float s = p.scale;
  const auto ink_of = [&model](const std::string& phase) {
    const auto at = std::find(model.phases.begin(), model.phases.end(), phase);
    return kInks[static_cast<std::size_t>(at - model.phases.begin()) % kInks.size()];
  };
  float x = box.low.x, y = box.low.y;
  for (const std::string& phase : model.phases) {
    const bool now = phase == pose.phase;
    const ImU32 ink = now ? IM_COL32(14, 20, 26, 255) : colour::kFaint;
    const std::string name = phase.empty() ? "-" : scene::PhaseTitle(phase);
    if (x + p.WidthOf(p.fonts.small, name) + 14 * s > box.high.x) {
      x = box.low.x;
      y += 22 * s;
    }
    if (y > box.low.y + 22 * s) break;  // Two rows hold every gait's states.
    x += p.Label({x, y}, now ? ink_of(phase) : colour::kGroove, ink, name) + 5 * s;
  }
  const float top = box.low.y + 47 * s, bottom = box.low.y + 55 * s;
  const std::int64_t shown_ns = scene::ShownTime(model.playout.newest_ns(), now_ns);
  const auto x_at = [&](std::int64_t time_ns) {
    const double age = static_cast<double>(shown_ns - time_ns) / static_cast<double>(kPhaseStripNs);
    return box.high.x - static_cast<float>(std::clamp(age, 0.0, 1.0)) * box.width();
  };
  for (std::size_t i = 0; i < model.phase_spans.size(); ++i) {
    const scene::PhaseSpan& span = model.phase_spans[i];
    const bool last = i + 1 == model.phase_spans.size();
    const float from = x_at(span.start_ns);
    const float to = last ? box.high.x : x_at(model.phase_spans[i + 1].start_ns);
    if (to - from < 0.5f) continue;
    p.list->AddRectFilled({from, top}, {to - 1, bottom}, Faded(ink_of(span.phase), 0.85f));
  }
}

}  // namespace

PanelHeight CharacterPanelHeight(bool phases) {
  return {kCharacterPanelHeight, kCharacterPanelHeight + (phases ? kCharacterPhaseHeight : 0)};
}

void DrawCharacterPanel(const Paint& p, const Box& box, const scene::Model& model,
                        const scene::CharacterPose& pose, std::int64_t now_ns) {
  const float s = p.scale;
  const stream::GaitState& gait = pose.gait;
  const bool phases = box.height() > (kCharacterPanelHeight + kCharacterPhaseHeight - 1) * s;
  const float height = (kCharacterPanelHeight + (phases ? kCharacterPhaseHeight : 0)) * s;
  const Box in = p.Panel({box.low, {box.high.x, box.low.y + height}});
  const ImU32 ink = ColourOf(gait.gait);
  p.Write(p.fonts.title, {in.low.x, in.low.y - 8 * s}, ink, scene::GaitTitle(gait.gait));
  DrawTurn(p, {in.high.x - 44 * s, in.low.y + 42 * s}, 38 * s, gait.commanded_turn_rad);

  const float row = in.low.y + 46 * s;
  if (gait.pending) {
    p.Label({in.low.x, row}, colour::kWarning, IM_COL32(30, 20, 0, 255),
            "next: " + scene::GaitTitle(gait.commanded_gait) + ", waiting for its moment");
  } else if (!gait.commanded_by_stream) {
    p.Label({in.low.x, row}, colour::kGroove, colour::kWarning, "no sensor input");
  } else {
    const bool missing = pose.interface.activity == stream::Activity::kAbsent;
    p.Label({in.low.x, row}, colour::kGroove, missing ? colour::kWarning : colour::kFaint,
            missing ? "devices are missing" : "follows the person");
  }
  DrawSpeed(p, {{in.low.x, in.low.y + 78 * s}, {in.high.x, in.low.y + 110 * s}}, gait, ink);
  DrawCounts(p, {{in.low.x, in.low.y + 128 * s}, {in.high.x, in.high.y}}, gait);
  if (phases) {
    DrawPhases(p, {{in.low.x, in.low.y + 178 * s}, {in.high.x, in.high.y}}, model, pose, now_ns);
  }
}

namespace {

constexpr float kWidestText = 560, kMarginOfBoth = 28, kGapOfLines = 4, kRestBar = 16;

struct InkedLine {
  ImFont* font = nullptr;
  ImU32 ink = 0;
  std::string text;
};

ImU32 TitleInk(const scene::Calibration& calibration) {
  if (!calibration.result) return colour::kText;
  return calibration.result->passed ? colour::kGood : colour::kBad;
}

std::vector<InkedLine> CalibrationLines(const Paint& p, const scene::Calibration& calibration,
                                        float width) {
  std::vector<InkedLine> lines;
  const auto add = [&](ImFont* font, ImU32 ink, const std::string& text) {
    for (std::string& line : p.Wrapped(font, text, width))
      lines.push_back({font, ink, std::move(line)});
  };
  add(p.fonts.small, colour::kAccent, scene::CalibrationProgress(calibration));
  add(p.fonts.strong, TitleInk(calibration), scene::CalibrationTitle(calibration));
  const bool is_bad = calibration.result && !calibration.result->passed;
  add(p.fonts.small, is_bad ? colour::kWarning : colour::kText,
      scene::CalibrationDetail(calibration));
  add(p.fonts.small, colour::kFaint,
      calibration.result ? "C begins again, X closes this screen" : "X ends it; nothing is stored");
  return lines;
}

}  // namespace

void DrawCalibrationPanel(const Paint& p, const scene::Calibration& calibration, const Box& space) {
  const float s = p.scale;
  const float width = std::min(space.width(), kWidestText * s);
  const auto lines = CalibrationLines(p, calibration, width - kMarginOfBoth * s);
  float height = kMarginOfBoth * s + (calibration.result ? 0 : kRestBar * s);
  for (const InkedLine& line : lines) height += line.font->FontSize + kGapOfLines * s;
  const float middle = (space.low.x + space.high.x) / 2;
  const float top = std::max(space.low.y, space.high.y - height);
  const Box in = p.Panel({{middle - width / 2, top}, {middle + width / 2, space.high.y}});
  float y = in.low.y;
  for (const InkedLine& line : lines) {
    p.Write(line.font, {in.low.x, y}, line.ink, line.text);
    y += line.font->FontSize + kGapOfLines * s;
  }
  const double share = calibration.marks && !calibration.result ? calibration.marks->rest_share : 0;
  if (!calibration.result)
    p.Bar({{in.low.x, in.high.y - 8 * s}, {in.high.x, in.high.y}}, static_cast<float>(share),
          colour::kGood);
}

namespace {

constexpr double kTPoseS = 5;

void DrawRing(const Paint& p, ImVec2 centre, float radius, double progress) {
  const float s = p.scale;
  const auto start = static_cast<float>(-kPi / 2);
  const auto end = start + static_cast<float>(2 * kPi * std::clamp(progress, 0.0, 1.0));
  p.list->AddCircle(centre, radius, colour::kGroove, 48, 7 * s);
  if (progress > 0.002) {
    p.list->PathArcTo(centre, radius, start, end, 48);
    p.list->PathStroke(colour::kGood, 0, 7 * s);
  }
  const std::string left = scene::Fixed(std::ceil(kTPoseS * (1 - progress)), 0);
  p.WriteCentred(p.fonts.heading, {centre.x, centre.y - 13 * s}, colour::kText, left);
}

/// Lines of one font and colour.
struct Paragraph {
  ImFont* font = nullptr;
  ImU32 ink = 0;
  std::vector<std::string> lines;
};

float ParagraphHeight(const Paragraph& paragraph, float scale) {
  return static_cast<float>(paragraph.lines.size()) * (paragraph.font->FontSize + 4 * scale);
}

std::vector<Paragraph> TextOf(const Paint& p, const scene::Model& model,
                              const scene::BodyState& body, float width) {
  const bool wide = width > 300 * p.scale;
  const scene::Stance stance = scene::StanceOf(model);
  std::string who = body.subject.empty() ? "T-pose" : "T-pose of " + body.subject;
  if (stance.valid) who += "   " + scene::Fixed(NewtonsToKilograms(stance.total_n), 1) + " kg";
  const auto paragraph = [&](ImFont* font, ImU32 ink, const std::string& text) {
    return Paragraph{font, ink, p.Wrapped(font, text, width)};
  };
  return {
      paragraph(p.fonts.small, stance.valid ? colour::kGood : colour::kFaint, who),
      paragraph(wide ? p.fonts.heading : p.fonts.strong, colour::kText, body.note),
      paragraph(p.fonts.small, colour::kFaint, "Stand as the blue figure does, for five seconds.")};
}

void DrawWizard(const Paint& p, const scene::Model& model, const scene::BodyState& body,
                const Box& space) {
  const float s = p.scale, ring = 84 * s, margins = 28 * s;
  const bool beside = space.width() > 380 * s;  // The ring beside the text, else above it.
  const float most = space.width() - margins - (beside ? ring : 0);
  const auto text = TextOf(p, model, body, most);
  float text_width = beside ? 330 * s : 0, text_height = 0;
  for (const Paragraph& paragraph : text) {
    text_height += ParagraphHeight(paragraph, s);
    for (const std::string& line : paragraph.lines) {
      text_width = std::max(text_width, p.WidthOf(paragraph.font, line));
    }
  }
  text_width = std::min(text_width, most);
  const float width = margins + text_width + (beside ? ring : 0);
  const float height = margins + (beside ? std::max(text_height, 68 * s) : text_height + 76 * s);
  const float middle = (space.low.x + space.high.x) / 2;
  const Box in =
      p.Panel({{middle - width / 2, space.high.y - height}, {middle + width / 2, space.high.y}});
  DrawRing(p, {beside ? in.low.x + 34 * s : middle, in.low.y + 34 * s}, 30 * s,
           body.calibration_progress);
  const float x = beside ? in.low.x + ring : in.low.x;
  float y = beside ? in.low.y : in.low.y + 76 * s;
  for (const Paragraph& paragraph : text) {
    for (const std::string& line : paragraph.lines) {
      p.Write(paragraph.font, {x, y}, paragraph.ink, line);
      y += paragraph.font->FontSize + 4 * s;
    }
  }
}

}  // namespace

void DrawTPosePanel(const Paint& p, const scene::Model& model, const scene::CharacterPose& pose,
                    const Box& space) {
  const scene::BodyState& body = *pose.body;
  if (!body.calibrated) return DrawWizard(p, model, body, space);
  if (body.note.empty()) return;
  const float s = p.scale, line_height = 19 * s;
  const auto lines = p.Wrapped(p.fonts.text, body.note, space.width() - 32 * s);
  float width = 0;
  for (const std::string& line : lines) width = std::max(width, p.WidthOf(p.fonts.text, line));
  const float middle = (space.low.x + space.high.x) / 2;
  const float height = line_height * static_cast<float>(lines.size()) + 12 * s;
  float y = space.high.y - height;
  p.list->AddRectFilled({middle - width / 2 - 16 * s, y}, {middle + width / 2 + 16 * s, y + height},
                        colour::kPanel, 16 * s);
  y += 6 * s;
  for (const std::string& line : lines) {
    p.WriteCentred(p.fonts.text, {middle, y}, colour::kWarning, line);
    y += line_height;
  }
}

}  // namespace footing::render
