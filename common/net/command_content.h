#pragma once

#include "common/base/result.h"
#include "footing/v1/command.pb.h"

namespace footing::transport {

/// What holds for every command: its texts are printable (text::IsPrintable), since they go to
/// screens, logs and files, and its numbers are finite. A usage error names the field. A mapping
/// table (SetInterface.table) is a document: its reader checks it.
Result<void> CheckContent(const v1::Command& command);

}  // namespace footing::transport
