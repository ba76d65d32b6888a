#include "clients/study/session/journal.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <utility>

#include "clients/study/session/study_folder.h"
#include "common/runtime/clock.h"
#include "common/runtime/data_file.h"

namespace footing::study::journal {
namespace {

constexpr std::size_t kMostBytes = 64u << 20;

Error Fault(const std::string& what, const std::string& path) {
  return Failure("cannot " + what + " " + path + ": " + std::strerror(errno));
}

/// So that the file's name survives the loss of power, too.
void SyncFolder(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const int descriptor =
      ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
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
  const int descriptor =
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0600);
  if (descriptor < 0) {
    if (errno == EEXIST) return UsageError(path + " exists and is never overwritten");
    return Fault("create", path);
  }
  SyncFolder(path);
  return Journal(path, descriptor);
}

Result<Journal> Journal::Resume(const std::string& path) {
  auto text = ReadJournal(path);
  if (!text) return text.error();
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (descriptor < 0) return Fault("open", path);
  Journal journal(path, descriptor);
  if (text->torn_bytes > 0) {
    if (::ftruncate(descriptor, static_cast<off_t>(text->whole_bytes)) != 0) {
      return Fault("cut the torn line of", path);
    }
    if (::fsync(descriptor) != 0) return Fault("write", path);
  }
  journal.events_ = std::move(text->events);
  journal.torn_bytes_ = text->torn_bytes;
  journal.whole_bytes_ = text->whole_bytes;
  return journal;
}

Journal::Journal(Journal&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      events_(std::move(other.events_)),
      torn_bytes_(other.torn_bytes_),
      whole_bytes_(other.whole_bytes_),
      refused_(std::move(other.refused_)) {}

Journal& Journal::operator=(Journal&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(events_, other.events_);
  std::swap(torn_bytes_, other.torn_bytes_);
  std::swap(whole_bytes_, other.whole_bytes_);
  std::swap(refused_, other.refused_);
  return *this;
}

Journal::~Journal() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<void> Journal::Refuse(const std::string& what) {
  refused_ = Fault(what, path_);
  if (::ftruncate(descriptor_, static_cast<off_t>(whole_bytes_)) == 0) ::fsync(descriptor_);
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
    const ssize_t written = ::write(descriptor_, left.data(), left.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return Refuse("write");
    left.remove_prefix(static_cast<std::size_t>(written));
  }
  if (::fsync(descriptor_) != 0) return Refuse("write");
  whole_bytes_ += line.size();
  events_.push_back(std::move(event));
  return {};
}

}  // namespace footing::study::journal
