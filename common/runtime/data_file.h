#pragma once

#include <string>

#include "common/base/result.h"

namespace footing::config {

/// Where a built-in file is: `folder` if given, then the install folder
/// (PREFIX/share/footing), then the source tree (daemon/simulation/data). An error names all
/// places.
Result<std::string> FindDataFile(const std::string& name, const std::string& folder = "");

/// The whole text of a regular file of at most `max_bytes` (RegularFile).
Result<std::string> ReadTextFile(const std::string& path, std::size_t max_bytes = 4u << 20);

/// The file at a path (it has a / or ends in .json), otherwise the built-in file
/// "FOLDER/NAME.json". The error for an unknown name lists the names that there are.
Result<std::string> ReadNamedOrPath(const std::string& name_or_path, const std::string& folder,
                                    const std::string& data_folder = "");
/// The built-in file "FOLDER/NAME.json" alone; the same error.
Result<std::string> ReadNamed(const std::string& name, const std::string& folder,
                              const std::string& data_folder = "");

/// FindDataFile, then ReadTextFile.
Result<std::string> ReadDataFile(const std::string& name, const std::string& folder = "");

}  // namespace footing::config
