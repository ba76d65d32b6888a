#pragma once

#include <cstdint>
#include <string>

#include "clients/study/plan/phases.h"
#include "common/base/result.h"

namespace footing::study::simulate {

/// One session of a study without people, devices or waiting.
struct SimulatedSession {
  std::string protocol_path;
  std::string study_folder;  ///< Of this session alone; must not exist.
  plan::Session session;
  std::uint64_t seed = 1;        ///< Of the participant's style and answers.
  bool real_time = false;        ///< On the host's time, as a live session: its latencies are real.
  std::string turn_by = "head";  ///< What turns with the interface leg: head, feet or trunk.
};

/// Runs footingd, footing-sim, footing-stream and `footing-study run --unattended` as processes of
/// their own on simulated time: one of them works at a time, and where all wait the time goes on at
/// once. The participant is a synthetic user who changes the devices whenever the session comes to
/// another interface. Equal seeds give equal journals, but for the date. In real time they wait as
/// ever. Failure with what the session said last; then its files are still there.
Result<void> Simulate(const SimulatedSession& simulated);

}  // namespace footing::study::simulate
