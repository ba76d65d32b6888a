#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "clients/view/render/hud.h"
#include "clients/view/render/paint.h"
#include "clients/view/render/screen.h"
#include "clients/view/scene/camera.h"
#include "clients/view/scene/pointer.h"
#include "clients/view/scene/update.h"

namespace footing::view {

/// A world in the window as it was drawn last; pixels of the picture.
struct DrawnView {
  render::Box world;
  std::optional<render::Box> strips;  ///< Panel of the strips.
  float scale = 1;                    ///< Pixels per unit of the panels.
  scene::Camera camera;
  scene::WorldFrame frame;
};

/// The view of what was drawn into that rectangle.
DrawnView ViewOf(const render::Screen& screen, const render::HudContent& content,
                 const render::HudOptions& options, const render::Box& world);

/// Actions of a mouse over the pictures of a window: turns, shifts and zooms the view, follows a
/// character, pushes it, zooms the strips. Places are in pixels of the picture, y down. Presses are
/// at the place of the move before them: a slow picture handles many events at once, when the mouse
/// itself is already further on.
class ViewMouse {
 public:
  enum class Button { kLeft, kOther };

  /// Pictures that the next events are about. `may_push`: a drag on a character pushes it.
  void SetViews(std::vector<DrawnView> views, bool may_push);

  void Move(ImVec2 at);
  /// The left button turns, pushes or follows; every other one shifts the view. A second press of
  /// the left one within 0.3 s at one place follows the character there; beside all, it resets the
  /// view, and over the strips their time.
  void Press(Button button, double time_s);
  /// Ends a drag; returns the push that it asked for.
  std::optional<scene::Push> Release();
  /// Ends a drag without a push; false: nothing was pushed.
  bool Cancel();
  /// Notches of the wheel, positive away from the person.
  void Scroll(double notches);
  /// Turns the view as a drag by that many heights of the picture.
  void Turn(const Eigen::Vector2d& by) { orbit_.Turn(by); }
  void ZoomView(double notches) { orbit_.Scroll(notches); }
  /// A view to begin with.
  void SetView(const scene::Orbit& orbit) { orbit_.Set(orbit); }
  /// The first view again.
  void Reset();

  ImVec2 at() const { return at_; }
  const scene::Orbit& orbit() const { return orbit_.orbit(); }
  const scene::TimeWindow& window() const { return window_; }
  /// Character that was double-clicked last; 0: none.
  std::uint32_t followed() const { return followed_; }
  /// The push that a release would send now.
  std::optional<scene::Push> push() const;

 private:
  enum class Drag { kNone, kView, kStrips, kPush };

  const DrawnView* ViewAt(ImVec2 at) const;
  /// In heights of the view, from its upper left corner.
  static Eigen::Vector2d PlaceIn(const DrawnView& view, ImVec2 at);
  const scene::CharacterPose* CharacterUnder(const DrawnView& view) const;
  void BeginDrag(const DrawnView& view, Button button);
  void DoubleClick(const DrawnView& view);

  std::vector<DrawnView> views_;
  bool may_push_ = false;
  scene::MouseOrbit orbit_;
  scene::TimeWindow window_;
  std::uint32_t followed_ = 0, pushed_ = 0;
  Drag drag_ = Drag::kNone;
  ImVec2 at_{0, 0}, begun_{0, 0};
  std::optional<double> pressed_s_;
};

}  // namespace footing::view
