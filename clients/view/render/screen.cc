#include "clients/view/render/screen.h"

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <utility>

namespace footing::render {
namespace {

// The panels move by themselves: ImGui's own clock only has to run.
constexpr float kNominalFrameS = 1.0f / 60;

}  // namespace

Result<std::unique_ptr<Screen>> Screen::Create(float scale) {
  auto world = World::Create();
  if (!world) return world.error();
  std::unique_ptr<Screen> screen(new Screen(std::move(*world), scale));
  if (!ImGui_ImplOpenGL3_Init("#version 330 core")) {
    return Failure("the panels cannot use this graphics driver's OpenGL");
  }
  return screen;
}

Screen::Screen(World world, float scale) : world_(std::move(world)), scale_(scale) {
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // The viewer leaves no files behind.
  fonts_ = LoadFonts(scale);
}

Screen::~Screen() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext();
}

void Screen::Draw(const scene::Picture& picture, const scene::Model& model,
                  const scene::WorldFrame& frame, std::int64_t now_ns, const HudOptions& options,
                  int width, int height) {
  world_.Draw(picture, model.track, model.track_version, width, height);
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = ImVec2(static_cast<float>(width), static_cast<float>(height));
  io.DeltaTime = kNominalFrameS;
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
  const Paint paint{ImGui::GetBackgroundDrawList(), fonts_, scale_};
  DrawHud(paint, picture, model, frame, now_ns, options, io.DisplaySize);
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace footing::render
