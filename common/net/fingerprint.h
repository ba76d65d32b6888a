#pragma once

#include <optional>
#include <string>
#include <string_view>

/// The SHA-256 of a certificate (of its DER bytes), by which people and programs know it again.
namespace footing::tls {

/// "sha256:" and 64 hexadecimal digits in lower case.
std::string FingerprintOf(std::string_view der);

/// The same form from what people write: the prefix may be missing, colons may stand between the
/// bytes (as `openssl x509 -fingerprint -sha256` prints them), and the case does not matter. None
/// when it is not a SHA-256.
std::optional<std::string> ParseFingerprint(std::string_view text);

}  // namespace footing::tls
