#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/recording/bids_tables.h"
#include "common/recording/recorded_session.h"

namespace footing::bids {

/// Parts of a recording that become a run of a data set.
struct Choice {
  /// The frames of this trial, and from its first one on all samples and events; empty: everything.
  std::string trial = {};
  std::set<std::uint64_t> undone = {};  ///< Failures that do not count.
  bool with_role = false;               ///< Only devices that have a role.
  /// The markers of clients, too. Their texts are free, so they may name people.
  bool markers = false;
};

/// A recording as the tables of a data set.
struct RecordedMotion {
  std::vector<MotionTable> tables;  ///< The table of footing-sim first, then one a sending device.
  /// In order for each server's start; with markers, of all servers by time.
  std::vector<Event> events;
  /// The last EffectiveConfig of footing-sim, and of footingd; empty: the recording has none.
  std::string config, sensor_config;
};

/// A recording as tables. Time counts from the first frame of the trial, else from the recording's
/// first tick, in seconds on the wall clock of the recorder's host, for all servers. InvalidData
/// when no frame is of the trial.
Result<RecordedMotion> ReadMotion(const recording::RecordedSession& session, const Choice& choice);

}  // namespace footing::bids
