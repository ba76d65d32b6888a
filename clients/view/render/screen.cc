#include "clients/view/render/screen.h"

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <cmath>
#include <utility>

#include "clients/view/render/gl.h"

namespace footing::render {
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
  DrawHud(paint, content, options, ImGui::GetIO().DisplaySize);
  EndPanels();
}

}  // namespace footing::render
