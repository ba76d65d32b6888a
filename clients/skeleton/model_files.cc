#include "clients/skeleton/model_files.h"

#include <algorithm>
#include <cstdlib>

namespace footing::skeleton {

std::filesystem::path DefaultPosePackage() {
  const char* const data = std::getenv("XDG_DATA_HOME");
  const char* const home = std::getenv("HOME");
  const std::filesystem::path base =
      data != nullptr && *data != '\0'
          ? std::filesystem::path(data)
          : std::filesystem::path(home != nullptr ? home : "/") / ".local/share";
  return base / "footing/mediapipe-pose";
}

std::optional<std::filesystem::path> ModelFile(const std::filesystem::path& package,
                                               std::string_view name) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '.' || c == '-';
  };
  if (name.empty() || name[0] == '.' || !std::all_of(name.begin(), name.end(), is_plain))
    return std::nullopt;
  const std::filesystem::path path = package / name;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
  return path;
}

bool IsOwnHost(std::string_view host) {
  const std::string_view name = host.substr(0, host.rfind(':'));
  return name == "127.0.0.1" || name == "localhost" || name == "[::1]";
}

}  // namespace footing::skeleton
