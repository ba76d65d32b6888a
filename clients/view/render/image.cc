#include "clients/view/render/image.h"

#include <stb_image_write.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>

namespace footing::render {

namespace {

constexpr int kJpegQuality = 92;  // Of 100: edges of letters stay clean.

Result<void> Written(int written, const std::string& path) {
  if (written != 0) return {};
  return Failure("cannot write the picture " + path + ": " + std::strerror(errno));
}

}  // namespace

Result<void> WritePng(const Image& image, const std::string& path) {
  errno = 0;
  return Written(
      stbi_write_png(path.c_str(), image.width, image.height, 3, image.rgb.data(), 3 * image.width),
      path);
}

Result<void> WritePicture(const Image& image, const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending != ".jpg" && ending != ".jpeg") return WritePng(image, path);
  errno = 0;
  return Written(
      stbi_write_jpg(path.c_str(), image.width, image.height, 3, image.rgb.data(), kJpegQuality),
      path);
}

}  // namespace footing::render
