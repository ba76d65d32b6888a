#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "footing/v1/session.pb.h"

namespace footing::eval {

/// The ticks of one server out of a recording, in their order, without snapshots.
struct Recorded {
  std::vector<v1::Tick> sensor;      ///< Of footingd: status, raw and features.
  std::vector<v1::Tick> simulation;  ///< Of footing-sim: characters, inputs, tracks and tables.
};

/// Reads the topics that a replay needs. Of a tick that is there twice (the recorder reconnected)
/// the first is taken.
Result<Recorded> ReadRecorded(const std::string& path);

}  // namespace footing::eval
