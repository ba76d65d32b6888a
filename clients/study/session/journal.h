#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "clients/study/report/event.h"
#include "common/base/result.h"
#include "common/runtime/files.h"

namespace footing::study::journal {

/// The journal of one participant, one event a line. An event is on the disk when Append returns,
/// so a program that is killed loses nothing but what it was about to append.
class Journal {
 public:
  /// A new file; an existing one is a usage error.
  static Result<Journal> Create(const std::string& path);
  /// An existing file, to go on with it. A torn last line is cut off: see torn_bytes().
  static Result<Journal> Resume(const std::string& path);

  /// Appends an event. When the disk refuses, the written part of the line is cut off again, and
  /// every later call returns the same failure: the file stays readable, and Resume goes on with
  /// it.
  Result<void> Append(records::EventKind kind, nlohmann::ordered_json fields);

  /// Events of the file and those appended.
  const std::vector<records::Event>& events() const { return events_; }
  std::size_t torn_bytes() const { return torn_bytes_; }
  const std::string& path() const { return path_; }

 private:
  Journal(std::string path, config::FileDescriptor file)
      : path_(std::move(path)), file_(std::move(file)) {}
  /// `what` failed with errno: cuts the file behind its last whole line.
  Result<void> Refuse(const std::string& what);

  std::string path_;
  config::FileDescriptor file_;
  std::vector<records::Event> events_;
  std::size_t torn_bytes_ = 0;
  std::size_t whole_bytes_ = 0;  ///< Size of all lines on the disk.
  Result<void> refused_;
};

/// InvalidData when the journal at `path` is of another participant, such as after a copy.
Result<void> RequireParticipant(const std::vector<records::Event>& events,
                                const std::string& participant, const std::string& path);

/// Usage error when a journal in the study's folder is of a person, who may have taken part in any
/// session of it: random answers and simulated devices must not get among real ones.
Result<void> RequireNoPerson(const std::string& study_folder);

/// The events of a journal, without changing the file. Failure when it cannot be read.
Result<records::JournalText> ReadJournal(const std::string& path);

/// Held by the one study program that runs sessions of a study, or writes into the journal of a
/// participant; gone with the process, however it ends. The file says who holds it.
class Lock {
 public:
  /// A failure that names `what` it is for and the holder, when another process has it.
  static Result<Lock> Take(const std::string& path, const std::string& what,
                           const std::string& holder);

 private:
  explicit Lock(config::FileDescriptor file) : file_(std::move(file)) {}

  config::FileDescriptor file_;
};

// Where a study's files are: beside its protocol NAME.json the folder NAME, in it a folder for
// each participant with journal.jsonl and the recordings. All of it is readable by its owner only.

/// The folder of a protocol file: its path without .json, with ".study" at the end.
std::string FolderOf(const std::string& protocol_path);
std::string ParticipantFolder(const std::string& study_folder, const std::string& participant);
std::string JournalPath(const std::string& study_folder, const std::string& participant);

/// Replaces a file as a whole, readable by its owner alone: after a crash it is the old or the new.
Result<void> ReplaceFile(const std::string& path, const std::string& text);

/// Makes a folder that only its owner can read; it may exist.
Result<void> MakeFolder(const std::string& path);
bool Exists(const std::string& path);

/// Names of the participants who have a journal in the folder, in order.
std::vector<std::string> Participants(const std::string& study_folder);
/// Whether a participant's folder has a recording.
bool HasRecordings(const std::string& study_folder, const std::string& participant);

/// Bytes free for this user on the disk of an existing folder.
Result<std::uint64_t> FreeBytes(const std::string& folder);
/// Failure that says how much is free and how much is needed.
Result<void> RequireSpace(const std::string& folder, double needed_mb);

/// The protocol of a study must not change once a session began: the first call stores its text in
/// the folder as protocol.json, later ones compare. Participants may be added at the end.
Result<void> KeepProtocol(const std::string& study_folder, const std::string& text);
/// The comparison alone, for those who only read.
Result<void> CheckProtocol(const std::string& study_folder, const std::string& text);

}  // namespace footing::study::journal
