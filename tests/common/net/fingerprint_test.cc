#include "common/net/fingerprint.h"

#include <gtest/gtest.h>

namespace footing::tls {
namespace {

// FIPS 180-2, appendix B.1: the SHA-256 of "abc".
constexpr char kOfAbc[] = "sha256:ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";

TEST(Fingerprint, IsTheSha256InLowerCase) { EXPECT_EQ(FingerprintOf("abc"), kOfAbc); }

TEST(Fingerprint, IsReadAsPeopleWriteIt) {
  const std::string digits = std::string(kOfAbc).substr(7);
  std::string colons;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    colons += (i == 0 ? "" : ":") + digits.substr(i, 2);
  }
  for (char& c : colons) c = static_cast<char>(std::toupper(c));
  EXPECT_EQ(ParseFingerprint(kOfAbc), kOfAbc);
  EXPECT_EQ(ParseFingerprint(digits), kOfAbc);
  EXPECT_EQ(ParseFingerprint(colons), kOfAbc);
  EXPECT_EQ(ParseFingerprint("SHA256:" + colons), kOfAbc);
}

TEST(Fingerprint, AnythingElseIsNone) {
  for (const std::string text : {"", "sha256:", "sha256:ba78", "token"}) {
    EXPECT_FALSE(ParseFingerprint(text)) << text;
  }
  EXPECT_FALSE(ParseFingerprint(std::string(kOfAbc) + "0"));
  EXPECT_FALSE(ParseFingerprint(std::string(64, 'g')));
}

}  // namespace
}  // namespace footing::tls
