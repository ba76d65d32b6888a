#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>

#include "common/transport/address.h"
#include "common/transport/client.h"
#include "footing/v1/session.pb.h"

namespace footing::stream_client {

/// The eyes of a synthetic user or player: calls `see` with what footing-sim publishes of the
/// character and its track. Everything runs on the io_context's one thread.
std::unique_ptr<transport::Client> WatchSimulation(boost::asio::io_context& io,
                                                   const transport::Address& simulation,
                                                   std::function<void(const v1::Tick&)> see);

}  // namespace footing::stream_client
