#pragma once

#include <cstdint>
#include <string>

#include "common/base/result.h"
#include "common/recording/mcap_reader.h"

namespace footing::recording {

/// Contents that a repair kept, and its findings.
struct RepairReport {
  std::uint64_t messages = 0;
  std::uint64_t attachments = 0;
  std::uint64_t metadata = 0;
  std::uint64_t missing_ticks = 0;  ///< Between what is kept, where damage was left out.
  std::uint64_t input_bytes = 0;
  mcap::WalkEnd found;  ///< Complete when nothing was wrong with the input.
};

/// Writes a complete file with every complete record of `input`: of a file cut at any byte, all
/// before the cut; of a damaged one, all but the chunks and records whose CRC or form is wrong,
/// with a v1::Gap on the channel "/SERVER/gaps" for the ticks whose numbers are missing there.
/// InvalidData when the input is not an MCAP file; a usage error when `output` exists, unless
/// `replace`, or is the input.
Result<RepairReport> Repair(const std::string& input, const std::string& output,
                            const std::string& library, bool replace);

}  // namespace footing::recording
