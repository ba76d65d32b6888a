#include "common/config/data_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

namespace footing::config {

Result<std::string> FindDataFile(const std::string& name, const std::string& folder) {
  const std::vector<std::string> places =
      folder.empty() ? std::vector<std::string>{FOOTING_INSTALL_DATA_DIR, FOOTING_SOURCE_DATA_DIR}
                     : std::vector<std::string>{folder};
  std::string tried;
  for (const std::string& place : places) {
    const std::string path = place + "/" + name;
    std::error_code error;
    if (std::filesystem::exists(path, error)) return path;
    tried += (tried.empty() ? "" : ", ") + place;
  }
  return Failure("cannot find " + name + " (looked in " + tried +
                 "); name its folder on the command line");
}

Result<std::string> ReadTextFile(const std::string& path, std::size_t max_bytes) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) return Failure("cannot open " + path + ": " + std::strerror(errno));
  const std::streamoff size = file.tellg();
  if (size < 0) return Failure("cannot read " + path + ": not a regular file");
  if (static_cast<std::size_t>(size) > max_bytes) {
    return InvalidData(path + " has " + std::to_string(size) + " bytes, more than the " +
                       std::to_string(max_bytes) + " it may have");
  }
  std::string text(static_cast<std::size_t>(size), '\0');
  file.seekg(0);
  file.read(text.data(), size);
  if (!file) return Failure("cannot read " + path + " to its end");
  return text;
}

Result<std::string> ReadDataFile(const std::string& name, const std::string& folder) {
  const Result<std::string> path = FindDataFile(name, folder);
  if (!path) return path.error();
  return ReadTextFile(*path);
}

Result<std::string> ReadNamedOrPath(const std::string& name_or_path, const std::string& folder,
                                    const std::string& data_folder) {
  const bool is_path = name_or_path.find('/') != std::string::npos ||
                       name_or_path.find(".json") != std::string::npos;
  return is_path ? ReadTextFile(name_or_path)
                 : ReadDataFile(folder + "/" + name_or_path + ".json", data_folder);
}

}  // namespace footing::config
