#pragma once

#include <filesystem>
#include <string>
#include <system_error>

#include "common/base/result.h"

namespace footing::log_client {

/// Makes the folder of an export, and those above it, where they are not there. Failure says why.
inline Result<void> MakeFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return Failure("cannot make the folder " + folder + ": " + error.message());
  return {};
}

/// The folder as a shell's completion leaves it, without the slashes at its end.
inline std::string WithoutEndSlashes(std::string folder) {
  while (folder.size() > 1 && folder.back() == '/') folder.pop_back();
  return folder;
}

}  // namespace footing::log_client
