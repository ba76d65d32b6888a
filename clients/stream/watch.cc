#include "clients/stream/watch.h"

#include <string>
#include <utility>

#include "common/runtime/log.h"

namespace footing::stream_client {

std::unique_ptr<transport::Client> Watch(boost::asio::io_context& io,
                                         const transport::Address& server,
                                         std::vector<std::string> channels,
                                         std::function<void(const v1::Tick&)> see) {
  transport::ClientOptions options;
  options.address = server;
  options.client_name = "footing-stream";
  options.channels = std::move(channels);
  transport::ClientHandlers handlers;
  handlers.on_tick = std::move(see);
  handlers.on_state = [](transport::LinkState, const std::string& why) {
    log::Info("watching the server: " + why);
  };
  handlers.on_notice = [](const v1::Notice& notice) {
    log::Warning("watching the server: " + notice.text());
  };
  auto client = std::make_unique<transport::Client>(io, options, std::move(handlers));
  client->Start();
  return client;
}

}  // namespace footing::stream_client
