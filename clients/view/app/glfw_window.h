#pragma once

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <Eigen/Core>
#include <cstdint>
#include <memory>

#include "clients/view/app/options.h"
#include "clients/view/scene/camera.h"
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

/// A mouse that turns the view. Presses are at the place of the move before them: a slow picture
/// handles many events at once, when the mouse itself is already further on.
struct WindowMouse {
  scene::MouseOrbit orbit;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< In heights of the window; y runs down.

  /// The arguments of GLFW's callbacks.
  void Move(GLFWwindow* window, double x, double y);
  void Button(int action);
};

/// Size of a picture, pixels.
struct PixelSize {
  int width = 0;
  int height = 0;
};
PixelSize PictureSize(GLFWwindow* window);
/// Binds the window's own framebuffer; returns its size.
PixelSize BeginPicture(GLFWwindow* window);
/// Shows the picture; waits where the display does not, so that the loop does not spin.
void EndPicture(GLFWwindow* window, std::int64_t begun_ns);

}  // namespace footing::view
