#pragma once

#include <string>

namespace footing::qr {

/// The text as a QR code for a terminal with UTF-8, two rows of squares a line, dark on light with
/// the light border that cameras need. Empty when the text is too long for one.
std::string QrCode(const std::string& text);

}  // namespace footing::qr
