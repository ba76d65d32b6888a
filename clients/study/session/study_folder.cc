#include "clients/study/session/study_folder.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/runtime/data_file.h"

namespace footing::study::journal {
namespace {

using nlohmann::ordered_json;

constexpr double kBytesPerMb = 1e6;

std::string Megabytes(double bytes) {
  return std::to_string(static_cast<long long>(std::floor(bytes / kBytesPerMb))) + " MB";
}

ordered_json Parsed(const std::string& text) {
  return ordered_json::parse(text, nullptr, /*allow_exceptions=*/false, /*ignore_comments=*/true);
}

/// The orders of participants follow from their places: only new ones at the end leave the others'.
bool OnlyAddsParticipants(ordered_json before, ordered_json now) {
  const ordered_json old_codes = before.value("participants", ordered_json::array());
  const ordered_json new_codes = now.value("participants", ordered_json::array());
  if (!old_codes.is_array() || !new_codes.is_array() || new_codes.size() < old_codes.size()) {
    return false;
  }
  for (std::size_t i = 0; i < old_codes.size(); ++i) {
    if (old_codes[i] != new_codes[i]) return false;
  }
  before.erase("participants");
  now.erase("participants");
  return nlohmann::json(before) == nlohmann::json(now);  // In whatever order of keys.
}

}  // namespace

std::string FolderOf(const std::string& protocol_path) {
  std::filesystem::path path(protocol_path);
  if (path.extension() == ".json") path.replace_extension();
  return path.string() + ".study";
}

std::string ParticipantFolder(const std::string& study_folder, const std::string& participant) {
  return study_folder + "/" + participant;
}

std::string JournalPath(const std::string& study_folder, const std::string& participant) {
  return ParticipantFolder(study_folder, participant) + "/journal.jsonl";
}

Result<void> ReplaceFile(const std::string& path, const std::string& text) {
  const std::string draft = path + ".new";
  const int descriptor = ::open(draft.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (descriptor < 0) return Failure("cannot create " + draft + ": " + std::strerror(errno));
  const bool written =
      ::write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
      ::fsync(descriptor) == 0;
  const int error = errno;
  ::close(descriptor);
  if (!written) {
    ::unlink(draft.c_str());
    return Failure("cannot write " + draft + ": " + std::strerror(error));
  }
  if (::rename(draft.c_str(), path.c_str()) != 0) {
    return Failure("cannot rename " + draft + ": " + std::strerror(errno));
  }
  return {};
}

Result<void> MakeFolder(const std::string& path) {
  if (::mkdir(path.c_str(), 0700) == 0 || errno == EEXIST) return {};
  return Failure("cannot create " + path + ": " + std::strerror(errno));
}

bool Exists(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

Result<std::uint64_t> FreeBytes(const std::string& folder) {
  struct statvfs disk {};
  if (::statvfs(folder.c_str(), &disk) != 0) {
    return Failure("cannot look at the disk of " + folder + ": " + std::strerror(errno));
  }
  return static_cast<std::uint64_t>(disk.f_bavail) * disk.f_frsize;
}

Result<void> RequireSpace(const std::string& folder, double needed_mb) {
  const auto free_bytes = FreeBytes(folder);
  if (!free_bytes) return free_bytes.error();
  const auto free_space = static_cast<double>(*free_bytes);
  if (free_space >= needed_mb * kBytesPerMb) return {};
  return Failure(folder + ": " + Megabytes(free_space) + " free on the disk, and a session needs " +
                 Megabytes(needed_mb * kBytesPerMb) +
                 "; delete something, or set disk_mb in the protocol");
}

std::vector<std::string> Participants(const std::string& study_folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(study_folder, error)) {
    const std::string name = entry.path().filename().string();
    if (Exists(JournalPath(study_folder, name))) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool HasRecordings(const std::string& study_folder, const std::string& participant) {
  std::error_code error;
  for (const auto& entry :
       std::filesystem::directory_iterator(ParticipantFolder(study_folder, participant), error)) {
    if (entry.path().extension() == ".mcap") return true;
  }
  return false;
}

Result<void> CheckProtocol(const std::string& study_folder, const std::string& text) {
  const std::string path = study_folder + "/protocol.json";
  if (!Exists(path)) return {};
  const auto before = config::ReadTextFile(path);
  if (!before) return before.error();
  if (*before == text || OnlyAddsParticipants(Parsed(*before), Parsed(text))) return {};
  return InvalidData("the protocol differs from " + path +
                     ", with which the study began; only participants may be added, at the end of "
                     "their list. Copy the protocol to a new name for a new study");
}

Result<void> KeepProtocol(const std::string& study_folder, const std::string& text) {
  if (const auto done = CheckProtocol(study_folder, text); !done) return done;
  const std::string path = study_folder + "/protocol.json";
  if (const auto before = config::ReadTextFile(path); before && *before == text) return {};
  return ReplaceFile(path, text);
}

}  // namespace footing::study::journal
