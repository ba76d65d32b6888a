#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "clients/view/app/options.h"
#include "clients/view/scene/update.h"
#include "common/net/address.h"
#include "common/net/client.h"

namespace footing::view {

/// Listens to any number of servers. Everything runs on the io_context's one thread.
class Feed {
 public:
  struct Handlers {
    std::function<void(scene::Update)> on_update;
    std::function<void(int source, const scene::LinkReport&)> on_link;
  };

  Feed(boost::asio::io_context& io, const Options& options, Handlers handlers);

  void Start();
  void Stop();
  /// Sends a command to every live server of that name; a refusal comes back as a note.
  void SendTo(const std::string& server_id, const v1::Command& command);

  /// The sources as they stand before anything has arrived.
  static std::vector<scene::LinkReport> InitialReports(const Options& options);

 private:
  struct Source {
    scene::LinkReport report;
    bool same_host = true;
    std::unique_ptr<transport::Client> client;
  };
  std::unique_ptr<transport::Client> Connect(boost::asio::io_context& io, int source,
                                             const transport::Address& address);
  std::int64_t OffsetOf(const Source& source) const;

  Handlers handlers_;
  std::vector<Source> sources_;
};

}  // namespace footing::view
