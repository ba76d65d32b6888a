#include "clients/view/render/image.h"

#include <stb_image_write.h>

#include <cerrno>
#include <cstring>

namespace footing::render {

Result<void> WritePng(const Image& image, const std::string& path) {
  errno = 0;
  const int written =
      stbi_write_png(path.c_str(), image.width, image.height, 3, image.rgb.data(), 3 * image.width);
  if (written != 0) return {};
  return Failure("cannot write the picture " + path + ": " + std::strerror(errno));
}

}  // namespace footing::render
