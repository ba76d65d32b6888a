#pragma once

#include <string>

#include "common/result/result.h"

namespace footing::view {

/// A folder for numbered pictures, made where it is missing.
Result<void> MakePictureFolder(const std::string& folder);
/// "folder/000042.png".
std::string NumberedPicture(const std::string& folder, int number);

}  // namespace footing::view
