#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "clients/study/plan/phases.h"
#include "clients/study/report/event.h"
#include "common/base/result.h"

namespace footing::study::simulate {

/// One session of a study without people, devices or waiting.
struct SimulatedSession {
  std::string protocol_path;
  std::string study_folder;  ///< Folder of this session alone; must not exist.
  plan::SessionPlan session;
  std::uint64_t seed = 1;           ///< Seed of the participant's style and answers.
  bool real_time = false;           ///< Runs on the host's time, so that latencies are real.
  std::string turn_by = "head";     ///< Turn source of the interface leg: head, feet or trunk.
  std::string devices = "wiimote";  ///< Held or worn: wiimote or joycon. Boards stay boards.
};

/// Runs footingd, footing-sim, footing-stream and `footing-study run --unattended` as processes of
/// their own on simulated time: one of them works at a time, and where all wait the time goes on at
/// once. The participant is a synthetic user who changes the devices whenever the session comes to
/// another interface. Equal seeds give equal journals, but for the date. In real time they wait as
/// ever. Failure with what the session said last; then its files are still there.
Result<void> Simulate(const SimulatedSession& simulated);

/// Reader of the lines that another program appends to a journal.
class JournalTail {
 public:
  explicit JournalTail(std::string path) : path_(std::move(path)) {}

  /// The whole lines since the last call; none while there is no file.
  std::vector<records::Event> ReadNew();

 private:
  std::string path_;
  std::size_t read_bytes_ = 0;
};

/// Options of a simulated study of several sessions.
struct StudyOptions {
  std::string protocol_path;
  std::string protocol_text;
  std::string study_folder;  ///< Folder of simulated sessions alone.
  std::vector<plan::SessionPlan> sessions;
  std::uint64_t seed = 1;
  int jobs = 1;                     ///< Sessions at once, each on about one processor.
  bool real_time = false;           ///< As in SimulatedSession.
  std::string turn_by = "head";     ///< As in SimulatedSession.
  std::string devices = "wiimote";  ///< As in SimulatedSession.
};

/// One participant's session in the folder.
struct SessionTime {
  std::string participant;
  double simulated_s = 0;  ///< Time from the first event to the last one.
  bool before = false;     ///< It was there already.
};

/// Simulates the sessions that the folder does not have yet. A session comes into the folder as a
/// whole once it has ended, so a run that is interrupted can be run again. A usage error where the
/// folder has the session of a person.
Result<std::vector<SessionTime>> SimulateStudy(const StudyOptions& options);

/// Progress of a simulated study when one of its sessions has just ended.
struct StudyProgress {
  int ended = 0, all = 0;  ///< Sessions of this run.
  int at_once = 1;         ///< As many run beside each other.
  double mean_s = 0;       ///< Wall time of a session, mean of those that have ended.
};

/// ", 3 of 16 sessions; about 4 min left"; after the last one the count alone.
std::string ProgressText(const StudyProgress& progress);

}  // namespace footing::study::simulate
