#include "common/net/fingerprint.h"

#include <openssl/sha.h>

#include <array>
#include <cctype>

namespace footing::tls {
namespace {

constexpr std::string_view kPrefix = "sha256:";

}  // namespace

std::string FingerprintOf(std::string_view der) {
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest;
  SHA256(reinterpret_cast<const unsigned char*>(der.data()), der.size(), digest.data());
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text(kPrefix);
  for (const unsigned byte : digest) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 0xfu];
  }
  return text;
}

std::optional<std::string> ParseFingerprint(std::string_view text) {
  std::string lower;
  for (const char c : text) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (lower.starts_with(kPrefix)) lower.erase(0, kPrefix.size());
  std::string digits;
  for (const char c : lower) {
    if (c == ':') continue;
    if (std::isxdigit(static_cast<unsigned char>(c)) == 0) return std::nullopt;
    digits += c;
  }
  if (digits.size() != 2 * SHA256_DIGEST_LENGTH) return std::nullopt;
  return std::string(kPrefix) + digits;
}

}  // namespace footing::tls
