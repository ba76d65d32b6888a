#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "clients/study/report/trials.h"
#include "clients/study/study_tables.h"
#include "common/base/result.h"

namespace footing::study::bundle {

/// Options of a bundle of a study for publication.
struct BundleOptions {
  std::string study_name;
  std::string study_folder;  ///< Has a folder for each participant.
  std::string out;           ///< Must not exist.
  bool with_text = false;    ///< Free-text answers, too: they may say who somebody is.
  std::string version;
};

/// Contents of a written bundle.
struct BundleReport {
  std::size_t participants = 0;
  std::size_t trials = 0;            ///< Trials with motion files.
  std::vector<std::string> remarks;  ///< Recordings that could not be read.
};

/// Writes an anonymised data set in the form of BIDS-motion: numbers in place of codes, instants
/// that count from 1900, devices by their roles. Participants who have withdrawn are left out, and
/// so are attempts that never ended. A trial whose recording is missing has a row in the table of
/// trials only.
Result<BundleReport> WriteBundle(const std::vector<records::Records>& people,
                                 const ParticipantKey& key, const BundleOptions& options);

}  // namespace footing::study::bundle
