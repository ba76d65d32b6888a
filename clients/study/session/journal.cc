#include "clients/study/session/journal.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include "common/runtime/clock.h"
#include "common/runtime/files.h"

namespace footing::study::journal {
namespace {

constexpr std::size_t kMostBytes = 64u << 20;

Error Fault(const std::string& what, const std::string& path) {
  return Failure("cannot " + what + " " + path + ": " + std::strerror(errno));
}

}  // namespace

Result<records::JournalText> ReadJournal(const std::string& path) {
  const auto text = config::ReadTextFile(path, kMostBytes);
  if (!text) return text.error();
  return records::ParseJournal(*text, path);
}

Result<void> RequireParticipant(const std::vector<records::Event>& events,
                                const std::string& participant, const std::string& path) {
  for (const records::Event& event : events) {
    if (event.kind != records::EventKind::kSessionStarted) continue;
    const std::string own = event.Text("participant");
    if (own == participant) return {};
    return InvalidData(path + " is the journal of participant " + own + ", not of " + participant +
                       "; move it to the folder of that code");
  }
  return {};
}

Result<void> RequireNoPerson(const std::string& study_folder) {
  for (const std::string& participant : Participants(study_folder)) {
    const std::string path = JournalPath(study_folder, participant);
    const auto text = ReadJournal(path);
    if (!text) return text.error();
    for (const records::Event& event : text->events) {
      const bool session = event.kind == records::EventKind::kSessionStarted ||
                           event.kind == records::EventKind::kSessionResumed;
      if (!session || event.Flag("synthetic")) continue;
      return UsageError(path + " is of a person; name a --folder for simulated sessions");
    }
  }
  return {};
}

Result<Journal> Journal::Create(const std::string& path) {
  config::FileDescriptor file(
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0600));
  if (!file.is_open()) {
    if (errno == EEXIST) return UsageError(path + " exists and is never overwritten");
    return Fault("create", path);
  }
  config::SyncFolderOf(path);
  return Journal(path, std::move(file));
}

Result<Journal> Journal::Resume(const std::string& path) {
  auto text = ReadJournal(path);
  if (!text) return text.error();
  config::FileDescriptor file(::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
  if (!file.is_open()) return Fault("open", path);
  if (text->torn_bytes > 0) {
    if (::ftruncate(file.number(), static_cast<off_t>(text->whole_bytes)) != 0) {
      return Fault("cut the torn line of", path);
    }
    if (::fsync(file.number()) != 0) return Fault("write", path);
  }
  Journal journal(path, std::move(file));
  journal.events_ = std::move(text->events);
  journal.torn_bytes_ = text->torn_bytes;
  journal.whole_bytes_ = text->whole_bytes;
  return journal;
}

Result<void> Journal::Refuse(const std::string& what) {
  refused_ = Fault(what, path_);
  if (::ftruncate(file_.number(), static_cast<off_t>(whole_bytes_)) == 0) ::fsync(file_.number());
  return refused_;
}

Result<void> Journal::Append(records::EventKind kind, nlohmann::ordered_json fields) {
  if (!refused_) return refused_;
  records::Event event;
  event.kind = kind;
  event.number = events_.size() + 1;
  event.wall_ns = clock::WallNs();
  event.fields = std::move(fields);
  const std::string line = ToLine(event) + "\n";
  std::string_view left = line;
  while (!left.empty()) {
    const ssize_t written = ::write(file_.number(), left.data(), left.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return Refuse("write");
    left.remove_prefix(static_cast<std::size_t>(written));
  }
  if (::fsync(file_.number()) != 0) return Refuse("write");
  whole_bytes_ += line.size();
  events_.push_back(std::move(event));
  return {};
}

namespace {

std::string Holder(int descriptor) {
  std::array<char, 256> text{};
  const ssize_t bytes = ::pread(descriptor, text.data(), text.size(), 0);
  std::string holder(text.data(), bytes > 0 ? static_cast<std::size_t>(bytes) : 0);
  while (!holder.empty() && holder.back() == '\n') holder.pop_back();
  return holder.empty() ? "another process" : holder;
}

}  // namespace

Result<Lock> Lock::Take(const std::string& path, const std::string& what,
                        const std::string& holder) {
  Lock lock(config::FileDescriptor(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)));
  const int descriptor = lock.file_.number();
  if (descriptor < 0) return Failure("cannot open " + path + ": " + std::strerror(errno));
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) return Failure("cannot lock " + path + ": " + std::strerror(errno));
    return Failure(what + " is in use by " + Holder(descriptor) +
                   "; end that session first (lock file " + path + ")");
  }
  const std::string text = holder + "\n";
  const bool written =
      ::ftruncate(descriptor, 0) == 0 &&
      ::pwrite(descriptor, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size());
  if (!written) return Failure("cannot write " + path + ": " + std::strerror(errno));
  return lock;
}

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
  const auto done = config::ReplaceFile(path, text);
  return done ? done : Failure("cannot write " + path + ": " + done.error().message);
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
