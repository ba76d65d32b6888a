#pragma once

#include <string>

#include "common/base/result.h"

namespace footing::config {

/// The folders above a file, made where they are missing (mode 0700). An error names the folder.
Result<void> MakeFoldersAbove(const std::string& path);

/// Replaces the content of a file, on the disk before this returns: written beside, synced, then
/// renamed, so that a reader finds the old content or the new one, never half of it. An existing
/// file keeps its mode and, where this user may give it away, its owner; of a symbolic link the
/// target is replaced. A new file has mode 0600. An error is the system's reason alone.
Result<void> ReplaceFile(const std::string& path, const std::string& text);

}  // namespace footing::config
