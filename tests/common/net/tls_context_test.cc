#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "common/net/tls_context.h"
#include "tests/common/temporary_folder.h"

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

TEST(Identity, IsMadeOnceWithItsFoldersAndForItsOwnerAlone) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("state/footing/identity.pem");
  EXPECT_FALSE(Identity::Load(path).ok());
  const auto made = Identity::LoadOrMake(path, "Footing");
  ASSERT_TRUE(made.ok()) << made.error().message;
  EXPECT_EQ(ParseFingerprint(made->fingerprint()), made->fingerprint());
  struct stat status {};
  ASSERT_EQ(stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0600u);
  ASSERT_EQ(stat(folder.Path("state/footing").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0700u);
  const auto again = Identity::LoadOrMake(path, "Footing");
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(again->fingerprint(), made->fingerprint());
  const auto files = std::filesystem::directory_iterator(folder.Path("state/footing"));
  EXPECT_EQ(std::distance(begin(files), end(files)), 1) << "nothing is left beside it";
}

TEST(Identity, TwoAreDifferent) {
  const test::TemporaryFolder folder;
  const auto one = Identity::LoadOrMake(folder.Path("one.pem"), "Footing");
  const auto other = Identity::LoadOrMake(folder.Path("other.pem"), "Footing");
  ASSERT_TRUE(one.ok() && other.ok());
  EXPECT_NE(one->fingerprint(), other->fingerprint());
}

TEST(Identity, AFileThatOthersMayReadIsRefused) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("identity.pem");
  ASSERT_TRUE(Identity::LoadOrMake(path, "Footing").ok());
  ASSERT_EQ(chmod(path.c_str(), 0640), 0);
  const auto refused = Identity::LoadOrMake(path, "Footing");
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("chmod 600 " + path), std::string::npos);
}

TEST(Identity, AKeyWithoutItsCertificateIsRefusedAndLeftAlone) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("identity.pem");
  ASSERT_TRUE(Identity::LoadOrMake(path, "Footing").ok());
  std::ifstream file(path);
  std::string text(std::istreambuf_iterator<char>(file), {});
  text.resize(text.find("-----BEGIN CERTIFICATE"));
  std::ofstream(path) << text;
  const auto refused = Identity::LoadOrMake(path, "Footing");
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::kInvalidData);
  EXPECT_EQ(std::filesystem::file_size(path), text.size());
}

/// A key with a certificate for 192.0.2.5 and lab.example, from 2026-01-01 to 2027-01-01, made with
/// openssl ca -selfsign; nobody uses it.
constexpr const char* kForLab = R"(-----BEGIN PRIVATE KEY-----
MIGHAgEAMBMGByqGSM49AgEGCCqGSM49AwEHBG0wawIBAQQgE7kezY61WFZzf3qh
YHEzIMik7E1Aje9ydaEYMM3YWxGhRANCAATkZ4MMFu8khhe1xjP+uykTXFdHehGi
drqvGJPNyQrkFeitDfmPqGKsOOa9yttkJRP+GlUeER/5zyKxTYrvYP53
-----END PRIVATE KEY-----
-----BEGIN CERTIFICATE-----
MIIBWjCCAQCgAwIBAgIBATAKBggqhkjOPQQDAjAWMRQwEgYDVQQDDAtsYWIuZXhh
bXBsZTAeFw0yNjAxMDEwMDAwMDBaFw0yNzAxMDEwMDAwMDBaMBYxFDASBgNVBAMM
C2xhYi5leGFtcGxlMFkwEwYHKoZIzj0CAQYIKoZIzj0DAQcDQgAE5GeDDBbvJIYX
tcYz/rspE1xXR3oRona6rxiTzckK5BXorQ35j6hirDjmvcrbZCUT/hpVHhEf+c8i
sU2K72D+d6M/MD0wHAYDVR0RBBUwE4cEwAACBYILbGFiLmV4YW1wbGUwHQYDVR0O
BBYEFG6r75eHpLAQ5t1gPbogLi4mZgx+MAoGCCqGSM49BAMCA0gAMEUCIQChC8cu
9N8Mlp6O0gOHCdk8RFJ7CkGML7ZE9FGjgeo/5gIgQDOTOW2HkrnC3JmzgWBLIH/v
7FcJcvYqMmEv+Ey7wbE=
-----END CERTIFICATE-----
)";

TEST(Identity, SaysWhyBrowsersRefuseIt) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("lab.pem");
  std::ofstream(path) << kForLab;
  ASSERT_EQ(chmod(path.c_str(), 0600), 0);
  const auto lab = Identity::Load(path);
  ASSERT_TRUE(lab.ok()) << lab.error().message;
  constexpr std::int64_t k2025 = 1'750'000'000, k2026 = 1'780'000'000, k2027 = 1'800'000'000;
  EXPECT_EQ(lab->FaultFor("192.0.2.5", k2026), "");
  EXPECT_EQ(lab->FaultFor("lab.example", k2026), "");
  EXPECT_EQ(lab->FaultFor("192.0.2.6", k2026), "is not for 192.0.2.6");
  EXPECT_EQ(lab->FaultFor("lab", k2026), "is not for lab");
  EXPECT_EQ(lab->FaultFor("lab.example", k2027), "has expired on Jan  1 00:00:00 2027 GMT");
  EXPECT_EQ(lab->FaultFor("lab.example", k2025), "is not valid before Jan  1 00:00:00 2026 GMT");
  EXPECT_EQ(std::string(kForLab).find(lab->CertificatePem()) != std::string::npos, true);
  const auto own = Identity::LoadOrMake(folder.Path("own.pem"), "Footing");
  ASSERT_TRUE(own.ok());
  EXPECT_EQ(own->FaultFor("192.0.2.5", k2026), "") << "it is known by its fingerprint alone";
}

TEST(Identity, AFolderThatCannotBeWrittenIsNamed) {
  const auto refused = Identity::LoadOrMake("/proc/none/identity.pem", "Footing");
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("/proc/none"), std::string::npos);
}

}  // namespace
}  // namespace footing::tls
