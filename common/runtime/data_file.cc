#include "common/runtime/data_file.h"

#include <filesystem>
#include <set>
#include <utility>
#include <vector>

#include "common/runtime/regular_file.h"
#include "common/base/joined.h"
#include "common/base/number.h"

namespace footing::config {
namespace {

/// The data folder that was installed with this program, wherever that is now; empty when it runs
/// where it was built.
std::string InstalledFolder() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return "";
  const auto folder = program.parent_path() / FOOTING_DATA_DIR_FROM_BIN;
  return std::filesystem::is_directory(folder, error) ? folder.lexically_normal().string() : "";
}

std::vector<std::string> DataFolders(const std::string& folder) {
  if (!folder.empty()) return {folder};
  if (std::string installed = InstalledFolder(); !installed.empty()) return {std::move(installed)};
  return {FOOTING_INSTALL_DATA_DIR, FOOTING_SOURCE_DATA_DIR};
}

/// Names of the JSON files of `folder` in the first data folder that has it, "1, 2, straight".
std::string BuiltInNames(const std::string& folder, const std::string& data_folder) {
  std::set<std::string> names;
  for (const std::string& place : DataFolders(data_folder)) {
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(place + "/" + folder, error)) {
      if (entry.path().extension() == ".json") names.insert(entry.path().stem().string());
    }
    if (!names.empty()) break;
  }
  return text::Joined(names);
}

Error TooLarge(const std::string& path, std::size_t bytes, std::size_t max_bytes) {
  constexpr double kBytesPerMb = 1e6;
  const double mb = static_cast<double>(bytes) / kBytesPerMb;
  const double max_mb = static_cast<double>(max_bytes) / kBytesPerMb;
  const int decimals = mb - max_mb < 0.1 ? 6 : 1;  // A file just above the limit, to the byte.
  return InvalidData(path + " is too large: it has " + text::Fixed(mb, decimals) +
                     " MB, and at most " + text::Fixed(max_mb, decimals) +
                     " MB are read; check that this is the right file, or shorten or split it");
}

}  // namespace

Result<std::string> FindDataFile(const std::string& name, const std::string& folder) {
  const std::vector<std::string> places = DataFolders(folder);
  for (const std::string& place : places) {
    const std::string path = place + "/" + name;
    std::error_code error;
    if (std::filesystem::exists(path, error)) return path;
  }
  return Failure("cannot find " + name + " (looked in " + text::Joined(places) +
                 "); name its folder on the command line");
}

Result<std::string> ReadTextFile(const std::string& path, std::size_t max_bytes) {
  const auto file = RegularFile::Open(path);
  if (!file) return Failure("cannot open " + path + ": " + file.error().message);
  if (file->size() > max_bytes) return TooLarge(path, file->size(), max_bytes);
  auto text = file->Read(max_bytes);
  if (!text) return Failure("cannot read " + path + ": " + text.error().message);
  return text;
}

Result<std::string> ReadDataFile(const std::string& name, const std::string& folder) {
  const Result<std::string> path = FindDataFile(name, folder);
  if (!path) return path.error();
  return ReadTextFile(*path);
}

Result<std::string> ReadNamed(const std::string& name, const std::string& folder,
                              const std::string& data_folder) {
  const std::string file = folder + "/" + name + ".json";
  const std::string names = BuiltInNames(folder, data_folder);
  if (!FindDataFile(file, data_folder) && !names.empty()) {
    return UsageError("\"" + name + "\" is not built in (no " + file + "); there are: " + names);
  }
  return ReadDataFile(file, data_folder);
}

Result<std::string> ReadNamedOrPath(const std::string& name_or_path, const std::string& folder,
                                    const std::string& data_folder) {
  const bool is_path = name_or_path.find('/') != std::string::npos ||
                       name_or_path.find(".json") != std::string::npos;
  if (is_path) return ReadTextFile(name_or_path);
  auto read = ReadNamed(name_or_path, folder, data_folder);
  if (read) return read;
  std::error_code unknown;
  if (std::filesystem::is_regular_file(name_or_path, unknown)) return ReadTextFile(name_or_path);
  return Error{read.error().kind, read.error().message + "; or give the path of a JSON file"};
}

}  // namespace footing::config
