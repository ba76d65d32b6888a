#include "clients/view/app/play_window.h"

#include <array>
#include <iostream>
#include <utility>

#include "clients/view/app/glfw_window.h"
#include "clients/view/app/play_pictures.h"
#include "clients/view/app/play_summary.h"
#include "clients/view/app/stop_signal.h"
#include "clients/view/render/play_picture.h"
#include "clients/view/scene/play_keys.h"
#include "common/runtime/clock.h"
#include "common/base/units.h"

namespace footing::view {
namespace {

/// footing-sim publishes a hundred frames a second.
constexpr double kFrameS = 0.01;

/// GLFW's keys by the names of kPlayKeys.
constexpr std::array<std::pair<int, const char*>, 17> kKeyNames{{
    {GLFW_KEY_SPACE, "space"},
    {GLFW_KEY_LEFT, "left"},
    {GLFW_KEY_RIGHT, "right"},
    {GLFW_KEY_COMMA, ","},
    {GLFW_KEY_PERIOD, "."},
    {GLFW_KEY_UP, "up"},
    {GLFW_KEY_DOWN, "down"},
    {GLFW_KEY_EQUAL, "="},
    {GLFW_KEY_KP_ADD, "+"},
    {GLFW_KEY_MINUS, "-"},
    {GLFW_KEY_KP_SUBTRACT, "-"},
    {GLFW_KEY_N, "N"},
    {GLFW_KEY_P, "P"},
    {GLFW_KEY_T, "T"},
    {GLFW_KEY_HOME, "home"},
    {GLFW_KEY_END, "end"},
    {GLFW_KEY_KP_DECIMAL, "."},
}};

/// What the callbacks of one window work on.
struct Controls {
  PlaySession& session;
  PlayPicture picture;
  render::TimelineBoxes boxes;  ///< Of the picture drawn last.
  bool dragging = false;
  WindowMouse mouse = {};
  FullScreen full_screen = {};
};

Controls& ControlsOf(GLFWwindow* window) {
  return *static_cast<Controls*>(glfwGetWindowUserPointer(window));
}

void OnPlayKey(GLFWwindow* window, int key, int, int action, int) {
  if (action != GLFW_PRESS && action != GLFW_REPEAT) return;
  Controls& controls = ControlsOf(window);
  PlaySession& session = controls.session;
  for (const auto& [code, name] : kKeyNames) {
    if (code != key) continue;
    const auto asked = timeline::ActionOf(name);
    if (!asked || (action == GLFW_REPEAT && *asked == timeline::PlayAction::kPause)) continue;
    session.head() = timeline::Act(session.head(), *asked, session.timeline(), kFrameS);
  }
  if (action != GLFW_PRESS) return;
  render::HudOptions& hud = controls.picture.hud;
  if (key == GLFW_KEY_F) hud.forces = !hud.forces;
  if (key == GLFW_KEY_O) hud.overlay_reference = !hud.overlay_reference;
  if (key == GLFW_KEY_H) hud.hidden = !hud.hidden;
  if (key == GLFW_KEY_Z) controls.mouse.orbit.Reset();
  if (key == GLFW_KEY_F11) controls.full_screen.Toggle(window);
  if (key == GLFW_KEY_L) controls.picture.timeline = !controls.picture.timeline;
  if (key == GLFW_KEY_ESCAPE || key == GLFW_KEY_Q) glfwSetWindowShouldClose(window, GLFW_TRUE);
}

// The question mark is a letter, on whichever key the layout has it.
void OnPlayLetter(GLFWwindow* window, unsigned int letter) {
  render::HudOptions& hud = ControlsOf(window).picture.hud;
  if (letter == '?') hud.keys = !hud.keys;
}

/// The mouse in pixels of the picture: a window may count in larger units.
ImVec2 MouseOf(GLFWwindow* window) {
  double x = 0, y = 0;
  int width = 0, height = 0;
  glfwGetCursorPos(window, &x, &y);
  glfwGetWindowSize(window, &width, &height);
  const PixelSize size = PictureSize(window);
  const double across = width > 0 ? static_cast<double>(size.width) / width : 1;
  const double up = height > 0 ? static_cast<double>(size.height) / height : 1;
  return {static_cast<float>(x * across), static_cast<float>(y * up)};
}

void SeekToMouse(GLFWwindow* window, Controls& controls) {
  PlaySession& session = controls.session;
  const double at_s =
      render::PositionAt(controls.boxes.groove, session.timeline(), MouseOf(window).x);
  session.head() = timeline::Sought(session.head(), at_s);
}

void OnButton(GLFWwindow* window, int button, int action, int) {
  if (button != GLFW_MOUSE_BUTTON_LEFT) return;
  Controls& controls = ControlsOf(window);
  const bool on_bar = controls.picture.timeline && MouseOf(window).y >= controls.boxes.bar.low.y;
  controls.dragging = action == GLFW_PRESS && on_bar;
  if (controls.dragging) SeekToMouse(window, controls);
  if (!on_bar || action != GLFW_PRESS) controls.mouse.Button(action);
}

void OnScroll(GLFWwindow* window, double, double notches) {
  ControlsOf(window).mouse.orbit.Scroll(notches);
}

void OnMove(GLFWwindow* window, double x, double y) {
  Controls& controls = ControlsOf(window);
  if (controls.dragging) SeekToMouse(window, controls);
  controls.mouse.Move(window, x, y);
}

void PlayLoop(GLFWwindow* window, const Options& options, render::Screen& screen,
              Controls& controls) {
  StopSignal stop;
  PlaySession& session = controls.session;
  const std::int64_t started_ns = clock::MonotonicNs();
  std::int64_t last_ns = started_ns;
  double passed_s = 0;
  while (glfwWindowShouldClose(window) == GLFW_FALSE && !stop.asked() &&
         (options.seconds <= 0 || passed_s < options.seconds)) {
    glfwPollEvents();
    const std::int64_t now_ns = clock::MonotonicNs();
    if (!controls.dragging) {
      session.head() = timeline::Advanced(session.head(), NanosecondsToSeconds(now_ns - last_ns));
    }
    last_ns = now_ns;
    screen.set_display_scale(DisplayScale(window));
    const PixelSize size = BeginPicture(window);
    controls.picture.orbit = controls.mouse.orbit.orbit();
    DrawSession(screen, session, controls.picture, size.width, size.height);
    controls.boxes =
        render::TimelineBoxesOf(screen, size.width, size.height, session.sides().size());
    EndPicture(window, now_ns);
    passed_s = NanosecondsToSeconds(clock::MonotonicNs() - started_ns);
  }
  if (options.json) std::cout << PlaySummary(session, passed_s) << std::endl;
}

}  // namespace

Result<void> RunPlayWindow(const Options& options, PlaySession& session) {
  const GlfwLibrary library;
  const auto opened = OpenWindow(library, options);
  if (!opened) return opened.error();
  GLFWwindow* const window = opened->get();
  auto screen = ScreenFor(options, session);
  if (!screen) return screen.error();
  Controls controls{session, PictureFor(options, session), {}};
  glfwSetWindowUserPointer(window, &controls);
  glfwSetKeyCallback(window, OnPlayKey);
  glfwSetCharCallback(window, OnPlayLetter);
  glfwSetMouseButtonCallback(window, OnButton);
  glfwSetCursorPosCallback(window, OnMove);
  glfwSetScrollCallback(window, OnScroll);
  PlayLoop(window, options, **screen, controls);
  return {};
}

}  // namespace footing::view
