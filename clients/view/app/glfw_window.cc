#include "clients/view/app/glfw_window.h"

#include <algorithm>
#include <string>
#include <utility>

#include "clients/view/render/gl.h"
#include "common/clock/clock.h"
#include "common/units/units.h"

namespace footing::view {
namespace {

Error NoWindow(const std::string& what) {
  const char* words = nullptr;
  glfwGetError(&words);
  return Failure(what + ": " + (words != nullptr ? words : "GLFW gives no reason") +
                 "; --text shows the state in the terminal, --screenshot draws without a display");
}

}  // namespace

Result<GlfwWindow> OpenWindow(const GlfwLibrary& library, const Options& options) {
  if (!library.ready) return NoWindow("no display can be opened");
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_SAMPLES, options.samples);
  GlfwWindow window(glfwCreateWindow(options.width, options.height, "Footing", nullptr, nullptr));
  if (window == nullptr) return NoWindow("no window with OpenGL 3.3 can be opened");
  glfwMakeContextCurrent(window.get());
  glfwSwapInterval(1);
  return window;
}

float DisplayScale(GLFWwindow* window) {
  float across = 1, up = 1;
  glfwGetWindowContentScale(window, &across, &up);
  return std::max(across, up);
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
