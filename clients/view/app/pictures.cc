#include "clients/view/app/pictures.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace footing::view {

Result<void> MakePictureFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return Failure("cannot make the folder " + folder + ": " + error.message());
  return {};
}

std::string NumberedPicture(const std::string& folder, int number) {
  std::string digits = std::to_string(number);
  digits.insert(0, 6 - std::min<std::size_t>(6, digits.size()), '0');
  return folder + "/" + digits + ".png";
}

}  // namespace footing::view
