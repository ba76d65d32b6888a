#include "clients/view/render/body_panel.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "clients/view/scene/words.h"
#include "common/base/units.h"

namespace footing::render {
namespace {

constexpr float kLeastBodyHeight = 276;
constexpr float kRemarkRow = 20;   // Of what only a high enough panel shows.
constexpr double kSureM = 0.03;    // Two standard deviations of a foot that stands.
constexpr double kUnsureM = 0.15;  // Of one that no sensor sees.
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
               body.mode + " mode") +
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

}  // namespace footing::render
