#pragma once

#include <string>

#include "common/model/model.h"
#include "common/base/result.h"
#include "daemon/offline/learning/recorded_session.h"

namespace footing::train {

struct Recording {
  learning::RecordedSession session;
  model::DataFile file;
  bool has_layout = false;  ///< Else the boards are taken to lie as board::DefaultLayout.
};

/// The boards and hands of one rig in a recording of footingd, on the devices' own clock. `rig`
/// empty: the only one with two boards. InvalidData: no such boards, two people's, a board without
/// its calibration. A recording that was cut is read as far as it goes.
Result<Recording> ReadRecording(const std::string& path, const std::string& rig);

}  // namespace footing::train
