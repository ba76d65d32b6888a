#include "daemon/sensor/kinds/decoded.h"

#include <algorithm>

namespace footing::decode {
namespace {

struct ButtonPair {
  std::uint16_t classic;
  std::uint32_t gamepad;
};

constexpr ButtonPair kButtonPairs[] = {
    {reports::kClassicA, stream::kGamepadA},
    {reports::kClassicB, stream::kGamepadB},
    {reports::kClassicX, stream::kGamepadX},
    {reports::kClassicY, stream::kGamepadY},
    {reports::kClassicLeftTrigger, stream::kGamepadL},
    {reports::kClassicRightTrigger, stream::kGamepadR},
    {reports::kClassicZl, stream::kGamepadZl},
    {reports::kClassicZr, stream::kGamepadZr},
    {reports::kClassicMinus, stream::kGamepadMinus},
    {reports::kClassicPlus, stream::kGamepadPlus},
    {reports::kClassicHome, stream::kGamepadHome},
    {reports::kClassicUp, stream::kGamepadUp},
    {reports::kClassicDown, stream::kGamepadDown},
    {reports::kClassicLeft, stream::kGamepadLeft},
    {reports::kClassicRight, stream::kGamepadRight},
};

/// -1 to 1, with `middle` counts at 0 and 2 * middle - 1 at 1.
double Stick(int counts, int middle) {
  return std::clamp(static_cast<double>(counts - middle) / (middle - 1), -1.0, 1.0);
}

}  // namespace

std::uint32_t GamepadButtons(std::uint16_t classic_buttons) {
  std::uint32_t buttons = 0;
  for (const ButtonPair& pair : kButtonPairs) {
    if ((classic_buttons & pair.classic) != 0) buttons |= pair.gamepad;
  }
  return buttons;
}

stream::GamepadSample ToGamepad(const reports::ClassicCounts& counts) {
  constexpr int kLeftMiddle = 32;
  constexpr int kRightMiddle = 16;
  constexpr double kTriggerFull = 31;
  stream::GamepadSample sample;
  sample.left_x = Stick(counts.left_x, kLeftMiddle);
  sample.left_y = Stick(counts.left_y, kLeftMiddle);
  sample.right_x = Stick(counts.right_x, kRightMiddle);
  sample.right_y = Stick(counts.right_y, kRightMiddle);
  sample.left_trigger = counts.left_trigger / kTriggerFull;
  sample.right_trigger = counts.right_trigger / kTriggerFull;
  sample.buttons = GamepadButtons(counts.buttons);
  sample.uncalibrated = true;
  return sample;
}

bool SameReading(const stream::GamepadSample& a, const stream::GamepadSample& b) {
  return a.left_x == b.left_x && a.left_y == b.left_y && a.right_x == b.right_x &&
         a.right_y == b.right_y && a.left_trigger == b.left_trigger &&
         a.right_trigger == b.right_trigger && a.buttons == b.buttons;
}

}  // namespace footing::decode
