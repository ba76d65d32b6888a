#include "common/frames/frame_folder.h"

#include <algorithm>
#include <filesystem>

#include "common/runtime/data_file.h"
#include "common/frames/netpbm.h"

namespace footing::frames {
namespace {

constexpr std::size_t kMostBytes = 64u << 20;

}  // namespace

Result<std::vector<std::string>> FramesOf(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string kind = entry.path().extension();
    if (kind == ".pgm" || kind == ".ppm" || kind == ".yuyv") paths.push_back(entry.path());
  }
  if (error) return Failure("cannot read folder " + folder + ": " + error.message());
  if (paths.empty())
    return InvalidData(folder + " holds no frames; it must have .pgm, .ppm or .yuyv files");
  std::sort(paths.begin(), paths.end());
  return paths;
}

Result<Frame> ReadFrame(const std::string& path, int width, int height) {
  const auto text = config::ReadTextFile(path, kMostBytes);
  if (!text) return text.error();
  if (path.ends_with(".yuyv")) {
    Frame frame{sphere::PixelFormat::kYuyv, width, height, {text->begin(), text->end()}, {}};
    const std::size_t size = 2 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (frame.bytes.size() != size)
      return InvalidData(path + ": has " + std::to_string(frame.bytes.size()) +
                         " bytes, must have " + std::to_string(size));
    return frame;
  }
  NetpbmReader reader;
  reader.Add(*text);
  auto frame = reader.Next();
  if (!frame) return InvalidData(path + ": " + frame.error().message);
  if (!*frame) return InvalidData(path + ": ends before its image does");
  if ((**frame).width != width || (**frame).height != height)
    return InvalidData(path + ": its size is not that of the camera file");
  return std::move(**frame);
}

}  // namespace footing::frames
