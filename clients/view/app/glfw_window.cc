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

namespace {

constexpr double kNoticeS = 4;

void OnLetter(GLFWwindow* window, unsigned int letter) {
  // The question mark is a letter, on whichever key the layout has it.
  render::HudOptions& hud = ControlsOf(window).hud;
  if (letter == '?') hud.keys = !hud.keys;
}

void OnButton(GLFWwindow* window, int button, int action, int) {
  WindowControls& controls = ControlsOf(window);
  const ImVec2 at = controls.mouse.at();
  const bool is_left = button == GLFW_MOUSE_BUTTON_LEFT;
  if (action == GLFW_PRESS && is_left && controls.timeline &&
      at.y >= controls.timeline->bar.low.y) {
    controls.seeking = true;
    return controls.seek(at.x);
  }
  if (action == GLFW_PRESS) {
    controls.mouse.Press(is_left ? ViewMouse::Button::kLeft : ViewMouse::Button::kOther,
                         NanosecondsToSeconds(clock::MonotonicNs()));
    return;
  }
  controls.seeking = false;
  if (const auto push = controls.mouse.Release()) controls.pushed = push;
}

/// A window may count in larger units than the picture's pixels.
void OnMove(GLFWwindow* window, double x, double y) {
  WindowControls& controls = ControlsOf(window);
  int width = 0, height = 0;
  glfwGetWindowSize(window, &width, &height);
  const PixelSize size = PictureSize(window);
  const double across = width > 0 ? static_cast<double>(size.width) / width : 1;
  const double up = height > 0 ? static_cast<double>(size.height) / height : 1;
  controls.mouse.Move({static_cast<float>(x * across), static_cast<float>(y * up)});
  if (controls.seeking) controls.seek(controls.mouse.at().x);
}

void OnScroll(GLFWwindow* window, double, double notches) {
  ControlsOf(window).mouse.Scroll(notches);
}

void OnDrop(GLFWwindow* window, int count, const char** paths) {
  ControlsOf(window).dropped.assign(paths, paths + count);
}

}  // namespace

WindowControls& ControlsOf(GLFWwindow* window) {
  return *static_cast<WindowControls*>(glfwGetWindowUserPointer(window));
}

void Listen(GLFWwindow* window, WindowControls& controls, GLFWkeyfun on_key) {
  glfwSetWindowUserPointer(window, &controls);
  glfwSetKeyCallback(window, on_key);
  glfwSetCharCallback(window, OnLetter);
  glfwSetMouseButtonCallback(window, OnButton);
  glfwSetCursorPosCallback(window, OnMove);
  glfwSetScrollCallback(window, OnScroll);
  glfwSetDropCallback(window, OnDrop);
}

void OnSharedKey(GLFWwindow* window, int key) {
  WindowControls& controls = ControlsOf(window);
  render::HudOptions& hud = controls.hud;
  if (key == GLFW_KEY_F) hud.forces = !hud.forces;
  if (key == GLFW_KEY_O) hud.overlay_reference = !hud.overlay_reference;
  if (key == GLFW_KEY_H) hud.hidden = !hud.hidden;
  if (key == GLFW_KEY_F1) hud.keys = !hud.keys;
  if (key == GLFW_KEY_Z) controls.mouse.Reset();
  if (key == GLFW_KEY_F11) controls.full_screen.Toggle(window);
  if (key == GLFW_KEY_Q || (key == GLFW_KEY_ESCAPE && !controls.mouse.Cancel()))
    glfwSetWindowShouldClose(window, GLFW_TRUE);
}

void WindowControls::Say(const std::string& text) {
  hud.notice = text;
  notice_until_ns = clock::MonotonicNs() + SecondsToNanoseconds(kNoticeS);
}

void WindowControls::Refresh(GLFWwindow* window) {
  if (clock::MonotonicNs() > notice_until_ns) hud.notice.clear();
  hud.window = mouse.window();
  hud.pointer.reset();
  if (glfwGetWindowAttrib(window, GLFW_HOVERED) == GLFW_TRUE) hud.pointer = mouse.at();
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

void EndPicture(GLFWwindow* window, std::int64_t begun_ns, PictureTimes& times) {
  glfwSwapBuffers(window);
  times.Add(begun_ns, clock::MonotonicNs());
  // Minimised, or on a display without vertical sync, the loop must not spin.
  clock::SleepUntil(begun_ns + SecondsToNanoseconds(1.0 / 125));
}

}  // namespace footing::view
