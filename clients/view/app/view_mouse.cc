#include "clients/view/app/view_mouse.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "clients/view/render/strip_panel.h"

namespace footing::view {
namespace {

constexpr double kDoubleClickS = 0.3;
constexpr float kDoubleClickPixels = 6;

bool Holds(const render::Box& box, ImVec2 at) {
  return at.x >= box.low.x && at.x < box.high.x && at.y >= box.low.y && at.y < box.high.y;
}

bool IsOnStrips(const DrawnView& view, ImVec2 at) { return view.strips && Holds(*view.strips, at); }

}  // namespace

DrawnView ViewOf(const render::Screen& screen, const render::HudContent& content,
                 const render::HudOptions& options, const render::Box& world) {
  DrawnView view{world, {}, screen.scale(), content.picture.camera, content.frame};
  const ImVec2 size(world.width(), world.height());
  view.strips = render::BoxesOf(content, options, size, view.scale).strips;
  return view;
}

void ViewMouse::SetViews(std::vector<DrawnView> views, bool may_push) {
  views_ = std::move(views);
  may_push_ = may_push;
}

const DrawnView* ViewMouse::ViewAt(ImVec2 at) const {
  for (const DrawnView& view : views_) {
    if (Holds(view.world, at)) return &view;
  }
  return views_.empty() ? nullptr : &views_.front();
}

Eigen::Vector2d ViewMouse::PlaceIn(const DrawnView& view, ImVec2 at) {
  const float height = std::max(1.0f, view.world.height());
  return Eigen::Vector2f((at.x - view.world.low.x) / height, (at.y - view.world.low.y) / height)
      .cast<double>();
}

const scene::CharacterPose* ViewMouse::CharacterUnder(const DrawnView& view) const {
  if (!Holds(view.world, at_)) return nullptr;
  const double aspect =
      static_cast<double>(view.world.width() / std::max(1.0f, view.world.height()));
  return scene::CharacterAt(view.frame, scene::RayThrough(view.camera, aspect, PlaceIn(view, at_)));
}

void ViewMouse::Move(ImVec2 at) {
  const ImVec2 before = std::exchange(at_, at);
  const DrawnView* const view = ViewAt(begun_);
  if (view == nullptr || drag_ == Drag::kNone) return;
  if (drag_ == Drag::kView) orbit_.Move(PlaceIn(*view, at));
  if (drag_ == Drag::kStrips && view->strips) {
    const double share = render::ShareOfStrips(*view->strips, view->scale, at.x) -
                         render::ShareOfStrips(*view->strips, view->scale, before.x);
    window_ = scene::Dragged(window_, share);
  }
}

void ViewMouse::Press(Button button, double time_s) {
  const DrawnView* const view = ViewAt(at_);
  if (view == nullptr) return;
  const bool again = button == Button::kLeft && pressed_s_ &&
                     time_s - *pressed_s_ <= kDoubleClickS &&
                     std::hypot(at_.x - begun_.x, at_.y - begun_.y) <= kDoubleClickPixels;
  begun_ = at_;
  pressed_s_ = again || button != Button::kLeft ? std::nullopt : std::optional(time_s);
  if (again) return DoubleClick(*view);
  BeginDrag(*view, button);
}

void ViewMouse::BeginDrag(const DrawnView& view, Button button) {
  drag_ = Drag::kView;
  if (button != Button::kLeft)
    return orbit_.Begin(scene::MouseOrbit::Drag::kShift, PlaceIn(view, at_));
  if (IsOnStrips(view, at_)) {
    drag_ = Drag::kStrips;
    return;
  }
  const scene::CharacterPose* const pose = may_push_ ? CharacterUnder(view) : nullptr;
  if (pose != nullptr) {
    pushed_ = pose->character;
    drag_ = Drag::kPush;
    return;
  }
  orbit_.Begin(scene::MouseOrbit::Drag::kTurn, PlaceIn(view, at_));
}

void ViewMouse::DoubleClick(const DrawnView& view) {
  drag_ = Drag::kNone;
  if (IsOnStrips(view, at_)) {
    window_ = {};
    return;
  }
  const scene::CharacterPose* const pose = CharacterUnder(view);
  const std::uint32_t followed = pose != nullptr ? pose->character : followed_;
  Reset();
  followed_ = followed;
}

void ViewMouse::Reset() {
  orbit_.Reset();
  followed_ = 0;
}

std::optional<scene::Push> ViewMouse::push() const {
  const DrawnView* const view = ViewAt(begun_);
  if (drag_ != Drag::kPush || view == nullptr) return std::nullopt;
  for (const scene::CharacterPose& pose : view->frame.characters) {
    if (pose.character != pushed_) continue;
    return scene::PushOf(view->camera, pose, PlaceIn(*view, at_) - PlaceIn(*view, begun_));
  }
  return std::nullopt;
}

std::optional<scene::Push> ViewMouse::Release() {
  const auto asked = push();
  drag_ = Drag::kNone;
  orbit_.End();
  return asked;
}

bool ViewMouse::Cancel() { return std::exchange(drag_, Drag::kNone) == Drag::kPush; }

void ViewMouse::Scroll(double notches) {
  const DrawnView* const view = ViewAt(at_);
  if (view == nullptr || !IsOnStrips(*view, at_)) return orbit_.Scroll(notches);
  window_ =
      scene::Zoomed(window_, notches, render::ShareOfStrips(*view->strips, view->scale, at_.x));
}

}  // namespace footing::view
