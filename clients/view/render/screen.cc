#include "clients/view/render/screen.h"

#include <array>
#include <cmath>
#include <utility>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "clients/view/render/gl.h"
#include "clients/view/render/hud.h"
#include "clients/view/scene/model.h"
#include "clients/view/scene/timeline.h"

namespace footing::render {

ImTextureID PreviewTexture::Take(const std::shared_ptr<const preview::Picture>& picture) {
  if (!picture) return nullptr;
  if (picture != shown_) {
    shown_ = picture;
    glBindTexture(GL_TEXTURE_2D, texture_.name());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, picture->width, picture->height, 0, GL_RGB,
                 GL_UNSIGNED_BYTE, picture->rgb.data());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  }
  return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture_.name()));
}

namespace {

// The panels move by themselves: ImGui's own clock only has to run.
constexpr float kNominalFrameS = 1.0f / 60;
// A smaller change of the scale is not worth drawing the letters again.
constexpr float kLeastChange = 0.01f;

}  // namespace

Result<std::unique_ptr<Screen>> Screen::Create() {
  auto world = World::Create();
  if (!world) return world.error();
  std::unique_ptr<Screen> screen(new Screen(std::move(*world)));
  if (!ImGui_ImplOpenGL3_Init("#version 330 core")) {
    return Failure("the panels cannot use this graphics driver's OpenGL");
  }
  return screen;
}

Screen::Screen(World world) {
  worlds_.push_back(std::move(world));
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // The viewer leaves no files behind.
}

Screen::~Screen() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext();
}

void Screen::LoadFontsAt(float scale) {
  if (std::abs(scale - scale_) < kLeastChange) return;
  const bool uploaded = scale_ > 0;  // The first upload is the backend's own.
  scale_ = scale;
  ImGui::GetIO().Fonts->Clear();
  fonts_ = LoadFonts(scale);
  if (!uploaded) return;
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImGui_ImplOpenGL3_CreateFontsTexture();
}

Result<void> Screen::AddWorld() {
  auto world = World::Create();
  if (!world) return world.error();
  worlds_.push_back(std::move(*world));
  return {};
}

Paint Screen::BeginPanels(int width, int height) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = ImVec2(static_cast<float>(width), static_cast<float>(height));
  io.DeltaTime = kNominalFrameS;
  LoadFontsAt(ScaleOf(io.DisplaySize));
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
  return {ImGui::GetBackgroundDrawList(), fonts_, scale_};
}

void Screen::EndPanels() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Screen::Draw(const HudContent& content, const HudOptions& options, int width, int height) {
  const scene::Model& model = content.model;
  if (options.camera_alone) {
    glViewport(0, 0, width, height);
    glClearColor(0.06f, 0.08f, 0.1f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
  } else {
    world().Draw(content.picture, model.track, model.track_version, width, height);
  }
  Paint paint = BeginPanels(width, height);
  paint.camera_picture = preview_.Take(model.observed.camera.picture);
  paint.window = options.window;
  paint.pointer = options.pointer;
  DrawHud(paint, content, options, ImGui::GetIO().DisplaySize);
  EndPanels();
}

namespace {

Error NoContext(const std::string& what) {
  return Failure(what + " (EGL error " + std::to_string(eglGetError()) +
                 "): drawing without a display needs Mesa; try: apt install libegl1 "
                 "libgl1-mesa-dri");
}

}  // namespace

Result<OffScreen> OffScreen::Create() {
  EGLDisplay display =
      eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE) {
    return NoContext("no EGL display without a screen");
  }
  if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) return NoContext("EGL has no OpenGL");
  const std::array<EGLint, 5> wanted{EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0,
                                     EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (eglChooseConfig(display, wanted.data(), &config, 1, &count) != EGL_TRUE || count == 0) {
    return NoContext("EGL has no fitting configuration");
  }
  const std::array<EGLint, 7> version{EGL_CONTEXT_MAJOR_VERSION,
                                      3,
                                      EGL_CONTEXT_MINOR_VERSION,
                                      3,
                                      EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                      EGL_NONE};
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, version.data());
  if (context == EGL_NO_CONTEXT) return NoContext("no OpenGL 3.3 context");
  if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) != EGL_TRUE) {
    eglDestroyContext(display, context);
    return NoContext("the OpenGL context cannot be used");
  }
  return OffScreen(display, context);
}

OffScreen::~OffScreen() {
  if (display_ == nullptr) return;
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
  eglTerminate(display_);
}

namespace {

/// Moves everything that was drawn since the list had `from` corners.
void MoveDrawn(ImDrawList& list, int from, ImVec2 by) {
  for (int i = from; i < list.VtxBuffer.Size; ++i) {
    list.VtxBuffer[i].pos.x += by.x;
    list.VtxBuffer[i].pos.y += by.y;
  }
}

/// The keys of playback, with those of what is played.
std::vector<scene::KeyLine> PlayKeyLines(const std::vector<PlayedView>& views) {
  std::vector<scene::KeyLine> lines{{"?, F1", "show or hide this list"},
                                    {"H", "hide or show the panels"},
                                    {"F11", "full screen, or a window again"}};
  const bool person =
      !views.empty() && scene::EngineOf(views.front().content.model) == scene::Engine::kPerson;
  if (person) {
    lines.push_back({"O", "the true pose beside the body, or over it"});
  } else {
    lines.push_back({"F", "force arrows at the feet"});
  }
  for (const auto& [key, what] : timeline::kPlayKeyHelp) lines.push_back({key, what});
  lines.push_back({"Esc, Q", "quit"});
  for (scene::KeyLine& line : scene::MouseLines()) lines.push_back(std::move(line));
  return lines;
}

}  // namespace

TimelineBoxes TimelineBoxesOf(const Screen& screen, int width, int height, std::size_t lanes) {
  const ImVec2 size(static_cast<float>(width), static_cast<float>(height));
  return LayOutTimeline(size, screen.ScaleOf(size), lanes);
}

std::vector<Box> PlaybackBoxesOf(const Screen& screen, int width, int height, std::size_t count,
                                 bool with_timeline) {
  int bar_height = 0;
  if (with_timeline) {
    const Box bar = TimelineBoxesOf(screen, width, height, count).bar;
    bar_height = static_cast<int>(std::ceil(bar.height()));
  }
  const auto high = static_cast<float>(std::max(1, height - bar_height));
  const auto left_of = [&](std::size_t i) {
    return static_cast<float>(static_cast<int>(i) * width / static_cast<int>(count));
  };
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < count; ++i)
    boxes.push_back({{left_of(i), 0}, {left_of(i + 1), high}});
  return boxes;
}

void DrawPlayback(Screen& screen, const std::vector<PlayedView>& views, const HudOptions& options,
                  const TimelineContent* line, int width, int height) {
  const std::vector<Box> boxes =
      PlaybackBoxesOf(screen, width, height, views.size(), line != nullptr);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const HudContent& content = views[i].content;
    const auto high = static_cast<int>(boxes[i].height());
    screen.world(i).Draw(content.picture, content.model.track, content.model.track_version,
                         static_cast<int>(boxes[i].width()), high, static_cast<int>(boxes[i].low.x),
                         height - high);
  }
  Paint paint = screen.BeginPanels(width, height);
  paint.window = options.window;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const PlayedView& view = views[i];
    const float x = boxes[i].low.x;
    const int before = paint.list->VtxBuffer.Size;
    HudOptions shown = options;
    shown.title = view.title;
    shown.over = view.note;
    shown.keys = false;
    paint.pointer = options.pointer;
    if (paint.pointer) paint.pointer->x -= x;
    DrawHud(paint, view.content, shown, {boxes[i].width(), boxes[i].height()});
    MoveDrawn(*paint.list, before, {x, 0});
    if (i == 0) continue;
    paint.list->AddRectFilled({x - paint.scale, 0}, {x + paint.scale, boxes[i].high.y},
                              IM_COL32(16, 22, 30, 255));
  }
  paint.pointer = options.pointer;
  if (line != nullptr) {
    DrawTimeline(paint, TimelineBoxesOf(screen, width, height, line->lanes.size()), *line);
  }
  if (options.keys) {
    DrawKeys(paint, {static_cast<float>(width), boxes.front().height()}, PlayKeyLines(views));
  }
  screen.EndPanels();
}

}  // namespace footing::render
