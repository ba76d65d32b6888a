#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "clients/study/report/event.h"
#include "common/base/result.h"

namespace footing::study::journal {

/// The journal of one participant, one event a line. An event is on the disk when Append returns,
/// so a program that is killed loses nothing but what it was about to append.
class Journal {
 public:
  /// A new file; an existing one is a usage error.
  static Result<Journal> Create(const std::string& path);
  /// An existing file, to go on with it. A torn last line is cut off: see torn_bytes().
  static Result<Journal> Resume(const std::string& path);

  Journal(Journal&& other) noexcept;
  Journal& operator=(Journal&& other) noexcept;
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;
  ~Journal();

  /// When the disk refuses, what was written of the line is cut off again, and every later call
  /// returns the same failure: the file stays readable, and Resume goes on with it.
  Result<void> Append(records::EventKind kind, nlohmann::ordered_json fields);

  /// Those of the file and those appended.
  const std::vector<records::Event>& events() const { return events_; }
  std::size_t torn_bytes() const { return torn_bytes_; }
  const std::string& path() const { return path_; }

 private:
  Journal(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}
  /// `what` failed with errno: cuts the file behind its last whole line.
  Result<void> Refuse(const std::string& what);

  std::string path_;
  int descriptor_ = -1;
  std::vector<records::Event> events_;
  std::size_t torn_bytes_ = 0;
  std::size_t whole_bytes_ = 0;  ///< Of all lines that are on the disk.
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

}  // namespace footing::study::journal
