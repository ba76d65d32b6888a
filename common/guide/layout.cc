#include "common/guide/layout.h"

#include <algorithm>
#include <cmath>

#include "common/board/geometry.h"
#include "common/guide/pick.h"
#include "common/base/units.h"

namespace footing::guide {
namespace {

constexpr const char* kOneFootEach = R"(
          == screen ==
        .------. .------.     long sides along the walk,
        |      | |      |     power buttons [] outwards
       [| left | | right|]
        |      | |      |
        '------' '------'
)";

constexpr const char* kSideBySide = R"(
               == screen ==
        .----------. .----------.     long sides across the walk,
        |   left   | |   right  |     power buttons [] towards you
        '----[]----' '----[]----'
)";

constexpr const char* kSingle = R"(
        == screen ==
        .----------.     both feet on it,
        |          |     power button [] towards you
        '----[]----'
)";

/// Movement of a board's COP in W between two stances; nothing when it was not stood on.
std::optional<Eigen::Vector2d> Moved(const stream::BoardPose& pose, const Load& from,
                                     const Load& to) {
  if (!from.cop_valid || !to.cop_valid) return std::nullopt;
  stream::BoardPose turned;  // A difference: the place drops out.
  turned.yaw_rad = pose.yaw_rad;
  return board::InWorld(turned, to.cop_x_m - from.cop_x_m, to.cop_y_m - from.cop_y_m);
}

/// Stood the wrong way: the other board had the load that this one should have had.
bool Swapped(const LayoutObserved& observed) {
  if (!observed.left_alone || !observed.right_alone) return false;
  return observed.left_alone->right.mean_n > observed.left_alone->left.mean_n &&
         observed.right_alone->left.mean_n > observed.right_alone->right.mean_n;
}

std::string Text(double value) { return std::to_string(std::lround(value)); }

std::string Turn(const Eigen::Vector2d& moved) {
  const bool about = moved.x() < 0 && std::abs(moved.x()) >= std::abs(moved.y());
  return about ? "by half a turn" : "by a quarter turn";
}

LayoutVerdict NoContact(const std::string& note) {
  LayoutVerdict verdict;
  verdict.fault = LayoutFault::kNoContact;
  verdict.note = note;
  return verdict;
}

}  // namespace

std::string LayoutPicture(const std::string& preset) {
  if (preset == "one_foot_each") return kOneFootEach;
  if (preset == "side_by_side") return kSideBySide;
  return preset == "single" ? kSingle : "";
}

LayoutVerdict CheckLayout(const stream::BoardLayout& layout, const LayoutObserved& observed) {
  LayoutVerdict verdict;
  verdict.degraded = observed.forward.left.samples == 0 || observed.forward.right.samples == 0;
  if (observed.left_alone && observed.right_alone) {
    const Stance& left = *observed.left_alone;
    const Stance& right = *observed.right_alone;
    verdict.rest_n = std::max(std::min(left.left.mean_n, left.right.mean_n),
                              std::min(right.left.mean_n, right.right.mean_n));
    if (Swapped(observed)) {
      verdict.fault = LayoutFault::kSwapped;
      verdict.note =
          "the boards are swapped: standing left loads the right one; exchange them, or do the "
          "roles again: footing-ctl setup --only roles";
      return verdict;
    }
    if (left.left.mean_n < kStoodOnN || right.right.mean_n < kStoodOnN) {
      return NoContact("a board had no load on it: stand on it alone, then on the other");
    }
  }
  const auto left = Moved(layout.left, observed.upright.left, observed.forward.left);
  const auto right = Moved(layout.right, observed.upright.right, observed.forward.right);
  if ((!left && !right) || (!verdict.degraded && (!left || !right))) {
    return NoContact("a board had no centre of pressure while leaning: stand on all boards");
  }
  const auto wrong = [](const std::optional<Eigen::Vector2d>& moved) {
    return moved && moved->x() < std::max(kLeastLeanM, std::abs(moved->y()));
  };
  for (const auto& moved : {left, right}) {
    if (moved && std::hypot(moved->x(), moved->y()) < kLeastLeanM) {
      return NoContact("the centre of pressure moved by less than " + Text(kLeastLeanM * 1e3) +
                       " mm: lean further forward, heels down");
    }
    if (moved) verdict.residual_mm = std::max(verdict.residual_mm, std::abs(moved->y()) * 1e3);
  }
  if (wrong(left) && wrong(right)) {
    verdict.fault = LayoutFault::kBothTurned;
    verdict.note = "both boards are turned " + Turn(*left) + ": check the power buttons' side";
  } else if (wrong(left)) {
    verdict.fault = LayoutFault::kLeftTurned;
    verdict.note = "the left board is turned " + Turn(*left) + ": check its power button's side";
  } else if (wrong(right)) {
    verdict.fault = LayoutFault::kRightTurned;
    verdict.note = "the right board is turned " + Turn(*right) + ": check its power button's side";
  } else {
    verdict.note = "sideways while leaning forward " + Text(verdict.residual_mm) +
                   " mm, on the free board " + Text(verdict.rest_n) + " N";
    if (verdict.degraded) verdict.note += "; one board alone: weight beside it is not seen";
  }
  return verdict;
}

}  // namespace footing::guide
