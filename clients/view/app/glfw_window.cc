#include "clients/view/app/glfw_window.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "clients/view/render/gl.h"
#include "clients/view/render/target.h"
#include "common/base/units.h"
#include "common/runtime/clock.h"

namespace footing::view {
namespace {

Error NoWindow(const std::string& what) {
  const char* words = nullptr;
  glfwGetError(&words);
  return Failure(what + ": " + (words != nullptr ? words : "GLFW gives no reason") +
                 "; --text shows the state in the terminal, --screenshot draws without a display");
}

GlfwWindow NewWindow(const Options& options) {
  return GlfwWindow(glfwCreateWindow(options.width, options.height, "Footing", nullptr, nullptr));
}

/// Mesa's drivers for machines without a graphics processor.
bool IsDrawnByProcessor(GLFWwindow* window) {
  glfwMakeContextCurrent(window);
  const auto* const name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const std::string_view renderer(name != nullptr ? name : "");
  return renderer.find("llvmpipe") != renderer.npos || renderer.find("softpipe") != renderer.npos;
}

}  // namespace

Result<GlfwWindow> OpenWindow(const GlfwLibrary& library, const Options& options) {
  if (!library.ready) return NoWindow("no display can be opened");
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  // Fewer samples where the driver has no more: a window is opened in any case. It is shown once it
  // is known whether a processor draws it, which has no time for them.
  glfwWindowHint(GLFW_SAMPLES, options.samples.value_or(render::Target::kSamples));
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  GlfwWindow window = NewWindow(options);
  if (window != nullptr && !options.samples && IsDrawnByProcessor(window.get())) {
    window.reset();
    glfwWindowHint(GLFW_SAMPLES, 0);
    window = NewWindow(options);
  }
  if (window == nullptr) return NoWindow("no window with OpenGL 3.3 can be opened");
  glfwShowWindow(window.get());
  glfwMakeContextCurrent(window.get());
  glfwSwapInterval(1);
  return window;
}

float DisplayScale(GLFWwindow* window) {
  float across = 1, up = 1;
  glfwGetWindowContentScale(window, &across, &up);
  return std::max(across, up);
}

void FullScreen::Toggle(GLFWwindow* window) {
  if (full_) {
    glfwSetWindowMonitor(window, nullptr, left_, top_, width_, height_, GLFW_DONT_CARE);
    full_ = false;
    return;
  }
  GLFWmonitor* const monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* const mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
  if (mode == nullptr) return;
  glfwGetWindowPos(window, &left_, &top_);
  glfwGetWindowSize(window, &width_, &height_);
  glfwSetWindowMonitor(window, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
  full_ = true;
}

void WindowMouse::Move(GLFWwindow* window, double x, double y) {
  int width = 0, height = 0;
  glfwGetWindowSize(window, &width, &height);
  at = Eigen::Vector2d(x, y) / std::max(1, height);
  orbit.Move(at);
}

void WindowMouse::Button(int action) {
  if (action == GLFW_PRESS) {
    orbit.Press(at, NanosecondsToSeconds(clock::MonotonicNs()));
  } else {
    orbit.Release();
  }
}

PixelSize PictureSize(GLFWwindow* window) {
  PixelSize size;
  glfwGetFramebufferSize(window, &size.width, &size.height);
  return size;
}

PixelSize BeginPicture(GLFWwindow* window) {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return PictureSize(window);
}

void EndPicture(GLFWwindow* window, std::int64_t begun_ns) {
  glfwSwapBuffers(window);
  // Minimised, or on a display without vertical sync, the loop must not spin.
  clock::SleepUntil(begun_ns + SecondsToNanoseconds(1.0 / 125));
}

}  // namespace footing::view
