#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/base/result.h"

namespace footing::log_client {

struct BidsOptions {
  std::string subject;  ///< Letters and digits; empty: "01".
  std::string task;     ///< Letters and digits; empty: those of the recording's name.
  bool replace = false;
  std::string version;
};

/// What one tracking system measured.
struct ExportedTable {
  std::string path;  ///< Of the file with the motion.
  std::string tracking_system;
  std::size_t channels = 0;
  std::size_t samples = 0;
};

struct ExportedBids {
  std::vector<ExportedTable> tables;
  std::size_t events = 0;
};

/// Adds a recording to the data set `folder`, in the form of BIDS-motion, as one task of one
/// subject: samples of the devices, frames of footing-sim, events. Makes the data set where there
/// is none; other subjects and tasks in it stay. A label that has other signs than letters and
/// digits is a usage error, and so is a file that exists, unless `replace`. InvalidData where the
/// recording has nothing of this.
Result<ExportedBids> ExportBids(const std::string& recording, const std::string& folder,
                                const BidsOptions& options);

}  // namespace footing::log_client
