#include "clients/view/render/preview_texture.h"

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

}  // namespace footing::render
