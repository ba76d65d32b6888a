#pragma once

#include <string>
#include <vector>

#include "common/result/result.h"
#include "daemon/offline/posturography/board.h"

namespace footing::eval {

/// The file is the boards' CSV of `footing-log export`, by its header.
bool IsBoardExport(const std::string& path);

/// One board's samples out of such a file, in seconds since its first one. `board` is a role
/// (left_board), a device number, or empty when the file holds one board only; a usage error lists
/// the boards when it holds several or not that one.
Result<std::vector<posturography::CornerSample>> ReadBoardExport(const std::string& path,
                                                                 const std::string& board);

}  // namespace footing::eval
