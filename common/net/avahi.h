#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

/// Servers in the local network by mDNS, which avahi-daemon speaks: sugar, beside addresses that
/// are named. Without avahi-daemon nothing else changes.
namespace footing::discovery {

/// DNS-SD's type of service.
inline constexpr const char* kServiceType = "_footing._tcp";

/// Avahi on the bus, and what it calls every interface, any protocol, and IPv4.
inline constexpr const char* kAvahi = "org.freedesktop.Avahi";
inline constexpr int kAnyInterface = -1, kAnyProtocol = -1, kIpv4 = 0;

/// What a server says of one of its ports.
struct Service {
  std::string name;     ///< Of the server, unique in the network: at most 63 bytes.
  std::string program;  ///< "footingd" or "footing-sim".
  std::uint16_t port = 0;
  bool tls = false;
  std::string fingerprint;  ///< Of its certificate: a hint to compare, no proof.
};

/// The TXT record: "program=...", "tls=1" and "fingerprint=sha256:...".
std::vector<std::string> TextRecord(const Service& service);
/// Reads one that anybody in the network may have sent; unknown keys are left out, and text is made
/// printable.
void ReadTextRecord(const std::vector<std::string>& record, Service& service);

/// Printable ASCII, at most `most_bytes` of it: for a screen, of text that came over the network.
std::string Printable(const std::string& text, std::size_t most_bytes);

}  // namespace footing::discovery
