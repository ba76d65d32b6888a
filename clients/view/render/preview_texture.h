#pragma once

#include <imgui.h>

#include <memory>

#include "clients/view/render/handles.h"
#include "common/camera/preview.h"

namespace footing::render {

/// The camera's picture on the graphics card.
class PreviewTexture {
 public:
  /// Uploads it unless it is the one that is there. Null: there is none.
  ImTextureID Take(const std::shared_ptr<const preview::Picture>& picture);

 private:
  Texture texture_;
  std::shared_ptr<const preview::Picture> shown_;
};

}  // namespace footing::render
