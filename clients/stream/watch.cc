#include "clients/stream/watch.h"

#include <string>
#include <utility>

#include "common/log/log.h"

namespace footing::stream_client {

std::unique_ptr<transport::Client> WatchSimulation(boost::asio::io_context& io,
                                                   const transport::Address& simulation,
                                                   std::function<void(const v1::Tick&)> see) {
  transport::ClientOptions options;
  options.address = simulation;
  options.client_name = "footing-stream";
  options.channels = {"characters", "track"};
  transport::ClientHandlers handlers;
  handlers.on_tick = std::move(see);
  handlers.on_state = [](transport::LinkState, const std::string& why) {
    log::Info("watching the simulation: " + why);
  };
  handlers.on_notice = [](const v1::Notice& notice) {
    log::Warning("watching the simulation: " + notice.text());
  };
  auto client = std::make_unique<transport::Client>(io, options, std::move(handlers));
  client->Start();
  return client;
}

}  // namespace footing::stream_client
