#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "clients/view/render/screen.h"
#include "clients/view/render/target.h"
#include "clients/view/scene/model.h"
#include "clients/view/scene/stage.h"

// Mesa's software driver keeps some memory to its end in modules that are unloaded by then: under
// AddressSanitizer leaks are not looked for in pictures.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() { return "detect_leaks=0"; }

namespace footing::render {

using Is = std::function<bool(int red, int green, int blue)>;

/// A part of a picture, in shares of its width and height.
struct Region {
  double left = 0, right = 1, top = 0, bottom = 1;
};

/// The share of a part of the picture that is of a colour.
inline double ShareOf(const Image& image, const Is& is, const Region& region = {}) {
  std::size_t count = 0, all = 0;
  for (int y = static_cast<int>(region.top * image.height); y < region.bottom * image.height; ++y) {
    for (int x = static_cast<int>(region.left * image.width); x < region.right * image.width; ++x) {
      const auto i = static_cast<std::size_t>(3 * (y * image.width + x));
      ++all;
      if (is(image.rgb[i], image.rgb[i + 1], image.rgb[i + 2])) ++count;
    }
  }
  return static_cast<double>(count) / static_cast<double>(all);
}

/// Pictures off screen. One context for all cases, as one process has one screen.
class PictureFixture : public ::testing::Test {
 protected:
  static constexpr int kWidth = 1280;
  static constexpr int kHeight = 720;

  static void SetUpTestSuite() {
    auto context = OffScreen::Create();
    if (!context) {
      why_ = context.error().message;
      return;
    }
    context_ = std::make_unique<OffScreen>(std::move(*context));
    auto screen = Screen::Create();
    if (!screen) {
      why_ = screen.error().message;
      return;
    }
    screen_ = std::move(*screen);
    Resize(kWidth, kHeight);
  }
  static void TearDownTestSuite() {
    screen_.reset();
    target_.reset();
    context_.reset();
  }
  void SetUp() override { ASSERT_NE(screen_, nullptr) << why_; }

  /// The next pictures have that size.
  static void Resize(int width, int height) {
    auto target = Target::Create(width, height, 0);
    ASSERT_TRUE(target) << target.error().message;
    target_ = std::make_unique<Target>(std::move(*target));
  }

  /// FOOTING_PICTURES=FOLDER keeps the picture as NAME.png, to look at.
  static Image Show(const scene::Picture& picture, const scene::Model& model,
                    const scene::WorldFrame& frame, std::int64_t now_ns, const HudOptions& hud,
                    const std::string& name) {
    target_->Bind();
    screen_->Draw({picture, model, frame, now_ns, model, now_ns}, hud, target_->width(),
                  target_->height());
    Image image = target_->Read();
    if (const char* folder = std::getenv("FOOTING_PICTURES")) {
      EXPECT_TRUE(WritePng(image, std::string(folder) + "/" + name + ".png"));
    }
    return image;
  }

  inline static std::string why_;
  inline static std::unique_ptr<OffScreen> context_;
  inline static std::unique_ptr<Target> target_;
  inline static std::unique_ptr<Screen> screen_;
};

}  // namespace footing::render
