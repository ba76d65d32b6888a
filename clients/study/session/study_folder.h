#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"

/// Where a study's files are: beside its protocol NAME.json the folder NAME, in it a folder for
/// each participant with journal.jsonl and the recordings. All of it is readable by its owner only.
namespace footing::study::journal {

/// The folder of a protocol file: its path without .json, with ".study" at the end.
std::string FolderOf(const std::string& protocol_path);
std::string ParticipantFolder(const std::string& study_folder, const std::string& participant);
std::string JournalPath(const std::string& study_folder, const std::string& participant);

/// Replaces a file as a whole, readable by its owner alone: after a crash it is the old or the new.
Result<void> ReplaceFile(const std::string& path, const std::string& text);

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
