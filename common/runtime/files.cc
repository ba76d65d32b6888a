#include "common/runtime/files.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/base/text.h"

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

namespace {

const char* KindOf(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

Error NotRegular(mode_t mode) {
  return Failure(std::string("it is ") + KindOf(mode) + ", not a regular file");
}

}  // namespace

Result<RegularFile> RegularFile::Open(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return Failure(std::strerror(errno));
  if (!S_ISREG(status.st_mode)) return NotRegular(status.st_mode);
  // It may have been replaced since: without O_NONBLOCK a pipe would wait for its writer.
  FileDescriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  if (!file.is_open()) return Failure(std::strerror(errno));
  const bool known = fstat(file.number(), &status) == 0;
  if (!known || !S_ISREG(status.st_mode)) return NotRegular(status.st_mode);
  return RegularFile(std::move(file), status.st_mode, static_cast<std::size_t>(status.st_size));
}

FileDescriptor::~FileDescriptor() {
  if (number_ >= 0) close(number_);
}

Result<std::string> RegularFile::Read(std::size_t bytes) const {
  std::string text(std::min(bytes, size_), '\0');
  std::size_t have = 0;
  while (have < text.size()) {
    const ssize_t got =
        pread(file_.number(), text.data() + have, text.size() - have, static_cast<off_t>(have));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return Failure(std::strerror(errno));
    if (got == 0) return Failure("it was cut short while it was read");
    have += static_cast<std::size_t>(got);
  }
  return text;
}

namespace {

/// Zero, or the error.
int WriteAndSync(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t wrote = write(file, text.data(), text.size());
    if (wrote < 0 && errno != EINTR) return errno;
    if (wrote > 0) text.remove_prefix(static_cast<std::size_t>(wrote));
  }
  return fsync(file) == 0 ? 0 : errno;
}

/// Mode and owner of the file at `path`, if there is one.
int CopyRights(const std::string& path, int file) {
  struct stat old {};
  if (stat(path.c_str(), &old) != 0) return 0;
  // Only root may give a file away; another user's copy is that user's.
  [[maybe_unused]] const int owned = fchown(file, old.st_uid, old.st_gid);
  constexpr mode_t kRights = S_IRWXU | S_IRWXG | S_IRWXO;
  return fchmod(file, old.st_mode & kRights) == 0 ? 0 : errno;
}

}  // namespace

void SyncFolderOf(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path();
  const FileDescriptor directory(
      open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory.is_open()) fsync(directory.number());
}

Result<void> MakeFoldersAbove(const std::string& path) {
  for (std::size_t slash = path.find('/', 1); slash != std::string::npos;
       slash = path.find('/', slash + 1)) {
    const std::string folder = path.substr(0, slash);
    if (mkdir(folder.c_str(), S_IRWXU) == 0) continue;
    const int error = errno;
    // A folder that is there may stand in one that is not to be written.
    if (struct stat there{}; stat(folder.c_str(), &there) == 0 && S_ISDIR(there.st_mode)) continue;
    return Failure("cannot make the folder " + folder + ": " + std::strerror(error));
  }
  return {};
}

Result<void> ReplaceFile(const std::string& path, const std::string& text) {
  std::error_code not_there;
  const std::string target = std::filesystem::canonical(path, not_there);
  const std::string& final_path = not_there ? path : target;
  const std::string beside = final_path + ".new";
  unlink(beside.c_str());  // Left by a program that was ended in the middle.
  const int file = open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (file < 0) return Failure(std::strerror(errno));
  int error = CopyRights(final_path, file);
  if (error == 0) error = WriteAndSync(file, text);
  if (close(file) != 0 && error == 0) error = errno;
  if (error == 0 && std::rename(beside.c_str(), final_path.c_str()) != 0) error = errno;
  if (error != 0) {
    unlink(beside.c_str());
    return Failure(std::strerror(error));
  }
  SyncFolderOf(final_path);
  return {};
}

}  // namespace footing::config
