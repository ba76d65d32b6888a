#pragma once

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "clients/view/app/options.h"
#include "clients/view/app/play_summary.h"
#include "clients/view/app/view_mouse.h"
#include "clients/view/render/hud.h"
#include "common/base/result.h"

namespace footing::view {

/// GLFW's process-wide state.
struct GlfwLibrary {
  GlfwLibrary() : ready(glfwInit() == GLFW_TRUE) {}
  ~GlfwLibrary() { glfwTerminate(); }
  GlfwLibrary(const GlfwLibrary&) = delete;
  GlfwLibrary& operator=(const GlfwLibrary&) = delete;
  bool ready;
};

/// Deleter of a GLFW window.
struct CloseWindow {
  void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
};
using GlfwWindow = std::unique_ptr<GLFWwindow, CloseWindow>;

/// A window with OpenGL 3.3, current on this thread; `library` must outlive it. The error says what
/// to do without a display.
Result<GlfwWindow> OpenWindow(const GlfwLibrary& library, const Options& options);

/// How many pixels of the picture stand for one of a common monitor.
float DisplayScale(GLFWwindow* window);

/// A window takes the whole of a screen, and goes back to its place.
class FullScreen {
 public:
  void Toggle(GLFWwindow* window);

 private:
  bool full_ = false;
  int left_ = 0, top_ = 0, width_ = 0, height_ = 0;  ///< Window before full screen.
};

/// State that the callbacks of a window change, live or in playback.
struct WindowControls {
  render::HudOptions hud;
  ViewMouse mouse = {};
  FullScreen full_screen = {};
  std::optional<render::TimelineBoxes> timeline = {};  ///< Boxes in the picture drawn last.
  std::function<void(float column)> seek = {};         ///< A press or drag on the timeline.
  bool seeking = false;
  std::vector<std::string> dropped = {};   ///< Files, until the loop looks at them.
  std::optional<scene::Push> pushed = {};  ///< A push that the loop has yet to send.
  std::int64_t notice_until_ns = 0;

  /// Text for a person, over the picture for some seconds.
  void Say(const std::string& text);
  /// Puts the mouse and the notice into the options of the next picture.
  void Refresh(GLFWwindow* window);
};

/// Sets all callbacks of the window; `on_key` for the keys that live view and playback do not
/// share. `controls` must outlive the next call.
void Listen(GLFWwindow* window, WindowControls& controls, GLFWkeyfun on_key);
/// The controls of the last Listen.
WindowControls& ControlsOf(GLFWwindow* window);
/// Keys of both: panels, list of keys, full screen, first view, end.
void OnSharedKey(GLFWwindow* window, int key);

/// Size of a picture, pixels.
struct PixelSize {
  int width = 0;
  int height = 0;
};
PixelSize PictureSize(GLFWwindow* window);
/// Binds the window's own framebuffer; returns its size.
PixelSize BeginPicture(GLFWwindow* window);
/// Shows the picture that was begun at `begun_ns`; waits where the display does not, so that the
/// loop does not spin.
void EndPicture(GLFWwindow* window, std::int64_t begun_ns, PictureTimes& times);

}  // namespace footing::view
