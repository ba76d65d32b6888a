#include "clients/view/scene/digits.h"

#include <array>

namespace footing::scene {
namespace {

constexpr float kWidth = 0.55f;
constexpr float kPen = 0.13f;
constexpr float kAdvance = 0.75f;

// Bits 0 to 6: top, upper right, lower right, bottom, lower left, upper left, middle.
constexpr std::array<unsigned, 10> kSegments{0x3f, 0x06, 0x5b, 0x4f, 0x66,
                                             0x6d, 0x7d, 0x07, 0x7f, 0x6f};

Stroke Segment(int index) {
  const float right = kWidth - kPen;
  const float middle = 0.5f - kPen / 2;
  switch (index) {
    case 0:
      return {{0, 1 - kPen}, {kWidth, 1}};
    case 1:
      return {{right, 0.5f}, {kWidth, 1}};
    case 2:
      return {{right, 0}, {kWidth, 0.5f}};
    case 3:
      return {{0, 0}, {kWidth, kPen}};
    case 4:
      return {{0, 0}, {kPen, 0.5f}};
    case 5:
      return {{0, 0.5f}, {kPen, 1}};
    default:
      return {{0, middle}, {kWidth, middle + kPen}};
  }
}

}  // namespace

std::vector<Stroke> PaintNumber(const std::string& digits) {
  std::vector<Stroke> strokes;
  const float width = kAdvance * static_cast<float>(digits.size()) - (kAdvance - kWidth);
  Eigen::Vector2f origin(-width / 2, -0.5f);
  for (const char digit : digits) {
    if (digit >= '0' && digit <= '9') {
      for (int segment = 0; segment < 7; ++segment) {
        if ((kSegments[static_cast<std::size_t>(digit - '0')] >> segment & 1) == 0) continue;
        const Stroke stroke = Segment(segment);
        strokes.push_back({origin + stroke.low, origin + stroke.high});
      }
    }
    origin.x() += kAdvance;
  }
  return strokes;
}

}  // namespace footing::scene
