#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "common/base/result.h"
#include "common/net/address.h"
#include "common/net/server.h"

/// Servers in the local network by mDNS, which avahi-daemon speaks: sugar, beside addresses that
/// are named. Without avahi-daemon nothing else changes.
namespace footing::discovery {

/// DNS-SD's type of service.
inline constexpr const char* kServiceType = "_footing._tcp";

/// Avahi on the bus, and what it calls every interface, any protocol, and IPv4.
inline constexpr const char* kAvahi = "org.freedesktop.Avahi";
inline constexpr int kAnyInterface = -1, kAnyProtocol = -1, kIpv4 = 0;

/// Announcement of one of a server's ports.
struct Service {
  std::string name;     ///< Name of the server, unique in the network: at most 63 bytes.
  std::string program;  ///< "footingd" or "footing-sim".
  std::uint16_t port = 0;
  bool tls = false;
  std::string fingerprint;  ///< Fingerprint of its certificate: a hint to compare, no proof.
};

/// The TXT record: "program=...", "tls=1" and "fingerprint=sha256:...".
std::vector<std::string> TextRecord(const Service& service);
/// Reads one that anybody in the network may have sent; unknown keys are left out, and text is made
/// printable.
void ReadTextRecord(const std::vector<std::string>& record, Service& service);

/// Printable ASCII, at most `most_bytes` of it: for a screen, of text that came over the network.
std::string Printable(const std::string& text, std::size_t most_bytes);

/// Keeps services in the local network's mDNS while it lives, also after avahi-daemon was
/// restarted. Nothing blocks: everything runs on the io_context's one thread.
class Advertiser {
 public:
  /// One line in the log says that the services are advertised, or why they are not.
  Advertiser(boost::asio::io_context& io, std::vector<Service> services);
  ~Advertiser();
  Advertiser(const Advertiser&) = delete;
  Advertiser& operator=(const Advertiser&) = delete;

 private:
  class Implementation;
  std::shared_ptr<Implementation> implementation_;
};

/// The ports of a server's first `listeners` addresses that others than this host can reach, under
/// `name`; none without a name.
std::vector<Service> ServicesOf(const transport::Server& server, std::size_t listeners,
                                const std::string& name, const std::string& program);

/// A server that answers mDNS; whoever sits in the network may claim to be one.
struct Found {
  Service service;
  transport::Address address;
};

/// Asks avahi-daemon who is there, by name, and waits at most `within_s` for the answers. An error
/// when there is no system bus or no avahi-daemon.
Result<std::vector<Found>> Browse(double within_s);

}  // namespace footing::discovery
