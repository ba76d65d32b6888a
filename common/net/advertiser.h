#pragma once

#include <boost/asio/io_context.hpp>
#include <memory>
#include <string>
#include <vector>

#include "common/net/avahi.h"
#include "common/net/server.h"

namespace footing::discovery {

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

}  // namespace footing::discovery
